//! Nodes, elements, materials and sections.

use super::{Maker, type_name};
use crate::case;
use crate::decks::{Elastic, Element, Material, Node, Place, Profile, Section, SectionShape, Set, Weight};
use crate::structure::{self, Integration, Part, PlateTheory};

impl Maker<'_> {
    pub(super) fn parts(&mut self) {
        let place = Place::default();
        let nodes = self.model.nodes.iter().enumerate();
        self.deck.nodes = nodes.map(|(k, x)| Node { number: k as u64 + 1, position: *x, place }).collect();
        for (name, material) in &self.case.material {
            self.deck.materials.push(material_of(name, material));
        }
        for part in &self.model.parts {
            self.part(part);
        }
    }

    fn part(&mut self, part: &Part) {
        let (first, place) = (self.deck.elements.len(), Place::default());
        let reduced = part.as_solid().is_some_and(|solid| solid.integration == Integration::Reduced);
        for cell in &part.cells {
            let name = type_name(cell.kind(), reduced);
            let type_name = self.type_named(name);
            let number = self.deck.elements.len() as u64 + 1;
            let nodes = cell.nodes().to_vec();
            self.deck.elements.push(Element { number, kind: cell.kind(), type_name, nodes, place });
        }
        let elements: Vec<usize> = (first..self.deck.elements.len()).collect();
        let case = self.case;
        let (material, shape) = match part.kind.dimension() {
            3 => (&case.solid[&part.name].material, SectionShape::Solid),
            2 => {
                let shell = &case.shell[&part.name];
                self.note_plate(&part.name, shell);
                (&shell.material, SectionShape::Shell { thickness: shell.thickness })
            }
            _ => {
                let bar = &case.bar[&part.name];
                let profile = match bar.profile {
                    case::Profile::Round { diameter } => Profile::Round { diameter },
                    case::Profile::Full { section: s } => Profile::General {
                        area: s.area,
                        second_moments: [s.inertia_1, s.inertia_2],
                        torsion: s.torsion,
                    },
                };
                let first_axis = Some(bar.orientation);
                (&bar.material, SectionShape::Beam { profile, first_axis })
            }
        };
        let axes = part.kind.material().engineering().filter(|_| part.as_solid().is_some());
        let axes = axes.map(|constants| [constants.directions[0], constants.directions[1]]);
        let (name, material) = (part.name.clone(), material.clone());
        self.deck.element_sets.push(Set { name: name.clone(), members: elements.clone(), internal: false });
        self.deck.sections.push(Section { name, elements, material, axes, shape, place });
    }

    /// The index of a type's name.
    fn type_named(&mut self, name: &str) -> u32 {
        let names = &mut self.deck.type_names;
        let known = names.iter().position(|own| own == name);
        known.unwrap_or_else(|| {
            names.push(name.into());
            names.len() - 1
        }) as u32
    }

    fn note_plate(&mut self, name: &str, shell: &case::Shell) {
        let what = format!("shell.{name}");
        let theory = match shell.theory {
            PlateTheory::Kirchhoff => "thin plates (Kirchhoff) are S3 and S4, with transverse shear",
            PlateTheory::Mindlin => "plates are S3 and S4, whose frequencies differ as the mesh is coarse",
        };
        self.note(Weight::Perhaps, &what, theory);
        if shell.bending_only {
            self.note(Weight::Matters, &what, "a membrane that is held is free there: `bending_only`");
        }
        if !shell.rotary_inertia {
            self.note(Weight::Nothing, &what, "rotary inertia counts there");
        }
    }
}

fn material_of(name: &str, material: &structure::Material) -> Material {
    let elastic = match material.engineering() {
        Some(constants) => Elastic::Orthotropic {
            youngs_moduli: constants.youngs_moduli,
            poissons_ratios: constants.poissons_ratios,
            shear_moduli: constants.shear_moduli,
        },
        None => Elastic::Isotropic {
            youngs_modulus: material.youngs_modulus,
            poissons_ratio: material.poissons_ratio,
        },
    };
    Material {
        name: name.into(),
        elastic: Some(elastic),
        density: Some(material.density),
        rayleigh: [material.rayleigh.alpha, material.rayleigh.beta],
        loss_factor: material.loss_factor,
    }
}
