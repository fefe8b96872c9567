//! MAT1, MAT11, PSOLID, PSHELL, PBAR, PROD, CORD2R, CONM2, CELAS2, CDAMP2, CBUSH1D.

use super::Writer;
use super::card::Field;
use crate::deck::{Elastic, Profile, SectionShape};
use crate::ledger::Weight;
use stridor_mesh::CellKind;
use stridor_mesh::quality::cross;

use Field::{Blank, Integer, Real};

impl Writer<'_> {
    fn comment(&mut self, what: &str, number: u64, name: &str) {
        let name: String = name.chars().filter(|c| !c.is_control() && *c != '"').collect();
        self.bulk.line(format!("$HMNAME {what} {number:>8}\"{name}\""));
    }

    pub(super) fn materials(&mut self) {
        let deck = self.deck;
        for (k, material) in deck.materials.iter().enumerate() {
            let number = k as u64 + 1;
            self.comment("MAT", number, &material.name);
            let density = material.density.map_or(Blank, Real);
            let loss = if material.loss_factor == 0.0 { Blank } else { Real(material.loss_factor) };
            match material.elastic {
                Some(Elastic::Isotropic { youngs_modulus, poissons_ratio }) => {
                    let elastic = [Integer(number), Real(youngs_modulus), Blank, Real(poissons_ratio)];
                    self.card("MAT1", &[&elastic[..], &[density, Blank, Blank, loss]].concat());
                }
                Some(Elastic::Orthotropic { youngs_moduli, poissons_ratios, shear_moduli }) => {
                    let nine = [youngs_moduli, poissons_ratios, shear_moduli].concat().into_iter().map(Real);
                    let mut fields: Vec<Field> = std::iter::once(Integer(number)).chain(nine).collect();
                    fields.extend([density, Blank, Blank, Blank, Blank, loss]);
                    self.card("MAT11", &fields);
                }
                None => {
                    let why = "a material without elastic constants is not written";
                    self.note(Weight::Matters, &format!("material {}", material.name), why);
                }
            }
        }
        let mut rayleigh = deck.materials.iter().map(|material| material.rayleigh);
        match rayleigh.next() {
            Some(first) if rayleigh.all(|other| other == first) => {
                for (name, value) in ["ALPHA1", "ALPHA2"].iter().zip(first).filter(|(_, value)| *value != 0.0)
                {
                    self.card("PARAM", &[Field::Word(name.to_string()), Real(value), Real(0.0)]);
                }
            }
            Some(_) => {
                let why = "Rayleigh damping that differs between materials is not written";
                self.note(Weight::Matters, "materials", why);
            }
            None => {}
        }
    }

    /// A section is the property of its number.
    pub(super) fn sections(&mut self) {
        let deck = self.deck;
        for (k, section) in deck.sections.iter().enumerate() {
            let material =
                deck.materials.iter().position(|own| own.name.eq_ignore_ascii_case(&section.material));
            let Some(material) = material else {
                let why = "its material is not there";
                self.note(Weight::Matters, &format!("section {}", section.name), why);
                continue;
            };
            let head = [Integer(k as u64 + 1), Integer(material as u64 + 1)];
            self.comment("PROP", k as u64 + 1, &section.name);
            let (name, more): (&str, Vec<Field>) = match &section.shape {
                SectionShape::Solid => {
                    let system = section.axes.map_or(Blank, |axes| self.system(axes));
                    let element = section.elements.first().map(|index| &deck.elements[*index]);
                    let quadratic = element.is_some_and(|element| element.kind == CellKind::Hexahedron20);
                    let reduced = element.is_some_and(|element| {
                        deck.type_names
                            .get(element.type_name as usize)
                            .is_some_and(|name| name.ends_with('R'))
                    });
                    // 2 × 2 × 2 points, or 3 × 3 × 3, all of them for shear, too.
                    let word = |word: &str| Field::Word(word.into());
                    let points = word(if reduced { "TWO" } else { "THREE" });
                    let integration = if quadratic { vec![points, Blank, word("FULL")] } else { Vec::new() };
                    ("PSOLID", [vec![system], integration].concat())
                }
                SectionShape::Shell { thickness } => {
                    if section.axes.is_some() {
                        let why = "directions of the materials of shells are not written";
                        self.note(Weight::Matters, &format!("section {}", section.name), why);
                    }
                    ("PSHELL", vec![Real(*thickness), head[1].clone(), Blank, head[1].clone()])
                }
                SectionShape::Unstated => {
                    let why = "its shape is not stated";
                    self.note(Weight::Matters, &format!("section {}", section.name), why);
                    continue;
                }
                SectionShape::Truss { area } => ("PROD", vec![Real(*area)]),
                SectionShape::Beam {
                    profile: Profile::General { area, second_moments: [i, k], torsion },
                    ..
                } => ("PBAR", [*area, *i, *k, *torsion].map(Real).to_vec()),
                SectionShape::Beam { profile: Profile::Round { diameter }, .. } => {
                    let mut fields = vec![Blank, Field::Word("ROD".into())];
                    fields.resize(6, Blank);
                    fields.push(Real(0.5 * diameter));
                    ("PBARL", fields)
                }
            };
            self.card(name, &[&head[..], &more].concat());
        }
    }

    /// CORD2R by its first two directions.
    fn system(&mut self, [first, second]: [[f64; 3]; 2]) -> Field {
        let number = Integer(self.next_system);
        self.next_system += 1;
        let points = [[0.0; 3], cross(first, second), first].concat().into_iter().map(Real);
        let fields: Vec<Field> = [number.clone(), Integer(0)].into_iter().chain(points).collect();
        self.card("CORD2R", &fields);
        number
    }

    pub(super) fn masses(&mut self) {
        for mass in &self.deck.masses {
            for node in &mass.nodes {
                let mut fields = vec![self.new_element(), self.node(*node), Blank, Real(mass.mass)];
                if mass.inertia != [0.0; 3] {
                    let [x, y, z] = mass.inertia.map(Real);
                    fields.resize(8, Blank);
                    fields.extend([x, Blank, y, Blank, Blank, z]);
                }
                self.card("CONM2", &fields);
            }
        }
    }

    /// CELAS2 and CDAMP2 of one degree of freedom; CBUSH1D along the line between the ends.
    pub(super) fn springs(&mut self) {
        let deck = self.deck;
        for spring in &deck.springs {
            let property = self.next_property;
            if spring.dof.is_none() {
                self.next_property += 1;
                self.card("PBUSH1D", &[Integer(property), Real(spring.stiffness), Real(spring.damping)]);
            }
            for (node, other) in &spring.ends {
                let Some(dof) = spring.dof else {
                    let ends = [Some(self.node(*node)), other.map(|other| self.node(other))];
                    let head = [self.new_element(), Integer(property)];
                    self.card(
                        "CBUSH1D",
                        &[&head[..], &ends.into_iter().flatten().collect::<Vec<_>>()].concat(),
                    );
                    continue;
                };
                for (name, value) in [("CELAS2", spring.stiffness), ("CDAMP2", spring.damping)] {
                    if value == 0.0 {
                        continue;
                    }
                    let component = Integer(u64::from(dof) + 1);
                    let mut fields =
                        vec![self.new_element(), Real(value), self.node(*node), component.clone()];
                    fields.extend(other.iter().flat_map(|other| [self.node(*other), component.clone()]));
                    self.card(name, &fields);
                }
            }
        }
    }
}
