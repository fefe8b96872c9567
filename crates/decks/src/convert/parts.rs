//! Materials and parts: sections with their elements.

use super::converter::{Converter, Part};
use super::text::{number, numbers, quantity, quoted};
use super::units::{Units, plausible};
use crate::deck::{Elastic, Material, Profile, Section, SectionShape};
use crate::ledger::Weight;
use std::collections::{BTreeMap, HashSet};
use stridor_base::connected::lowest_connected;
use stridor_mesh::{CellKind, coincident};

impl Converter<'_> {
    /// All materials that sections have.
    pub fn materials(&mut self) {
        let used: HashSet<String> =
            self.deck.sections.iter().map(|section| section.material.to_uppercase()).collect();
        for material in &self.deck.materials {
            if used.contains(&material.name.to_uppercase()) {
                self.material(material);
            }
        }
    }

    fn material(&mut self, material: &Material) {
        let units = self.units;
        let stress = |value: f64| quantity(value * units.stress(), 1e9, "GPa");
        let name = &material.name;
        let Some(elastic) = material.elastic else {
            self.ledger.note(
                Weight::Matters,
                format!("material {name}"),
                "no elastic constants that are read",
                Default::default(),
            );
            return;
        };
        self.case.table("material", name);
        let density = material.density.unwrap_or(0.0);
        if density <= 0.0 {
            let why = "no density: modes need one";
            self.ledger.note(Weight::Matters, format!("material {name}"), why, Default::default());
            self.case.comment("The file has no density: give one.");
        }
        let modulus = match elastic {
            Elastic::Isotropic { youngs_modulus, poissons_ratio } => {
                self.case
                    .key("youngs_modulus", stress(youngs_modulus))
                    .key("poissons_ratio", number(poissons_ratio));
                youngs_modulus
            }
            Elastic::Orthotropic { youngs_moduli: [e1, ..], poissons_ratios: [n12, ..], .. } => {
                self.case.key("youngs_modulus", stress(e1)).key("poissons_ratio", number(n12));
                e1
            }
        };
        self.case.key("density", quantity(density * units.density(), 1.0, "kg/m^3"));
        if material.loss_factor > 0.0 {
            self.case.key("loss_factor", number(material.loss_factor));
        }
        let [alpha, beta] = material.rayleigh;
        if alpha != 0.0 || beta != 0.0 {
            let value = format!(
                "{{ alpha = {}, beta = {} }}",
                quantity(alpha / units.time, 1.0, "1/s"),
                quantity(beta * units.time, 1.0, "s")
            );
            self.case.key("rayleigh", value);
        }
        self.suspicious(name, density, modulus);
    }

    /// A density that no solid has: another unit than that which was said, or a slip of the file.
    fn suspicious(&mut self, name: &str, density: f64, modulus: f64) {
        let units = self.units;
        if density <= 0.0 || plausible(density * units.density(), modulus * units.stress()) {
            return;
        }
        let mut text = format!(
            "Material `{name}`: with the unit {} its density is {} kg/m³ and its modulus {} GPa",
            units.words,
            number(density * units.density()),
            number(modulus * units.stress() / 1e9)
        );
        let likely: Vec<&str> = Units::likelier(density, modulus).map(|units| units.name).collect();
        if likely.is_empty() {
            text += "; no system of units makes both those of a solid: the file mixes units, as lengths in mm beside a density in kg/m³";
        } else {
            text += &format!("; those of a solid with --unit {}", likely.join(" or "));
        }
        self.warnings.push(text);
    }

    /// Parts: the elements of each section, apart where their integration differs.
    pub fn parts(&mut self) {
        let mut owner: Vec<Option<usize>> = vec![None; self.deck.elements.len()];
        for (index, section) in self.deck.sections.iter().enumerate() {
            section.elements.iter().for_each(|element| owner[*element] = Some(index));
        }
        let mut groups: BTreeMap<(usize, bool), Vec<usize>> = BTreeMap::new();
        for (element, section) in owner.iter().enumerate() {
            let Some(section) = section else { continue };
            let kind = self.deck.elements[element].kind;
            let fits = match self.deck.sections[*section].shape {
                SectionShape::Solid => kind.dimension() == 3,
                SectionShape::Shell { .. } => kind.dimension() == 2,
                SectionShape::Beam { .. } | SectionShape::Truss { .. } => kind.dimension() == 1,
                SectionShape::Unstated => true,
            };
            let name = &self.deck.type_names[self.deck.elements[element].type_name as usize];
            if !fits {
                let why = "elements whose section is of another shape are not read";
                self.ledger.note(
                    Weight::Matters,
                    format!("elements of type {name}"),
                    why,
                    self.deck.elements[element].place,
                );
                continue;
            }
            let reduced = kind == CellKind::Hexahedron20 && is_reduced(name);
            groups.entry((*section, reduced)).or_default().push(element);
        }
        let without = (0..owner.len()).filter(|element| owner[*element].is_none());
        for element in without {
            let of = &self.deck.elements[element];
            let name = &self.deck.type_names[of.type_name as usize];
            let rigid = name.starts_with("R3D") || name.starts_with("RB");
            let weight = if rigid { Weight::Perhaps } else { Weight::Matters };
            self.ledger.note(
                weight,
                format!("elements of type {name}"),
                "elements without a section are not in the model",
                of.place,
            );
        }
        for ((section, reduced), elements) in groups {
            let pieces = self.pieces(&elements);
            let several = pieces.len() > 1;
            for (k, elements) in pieces.into_iter().enumerate() {
                let own = &self.deck.sections[section].name;
                let name = if several { format!("{own}_{}", k + 1) } else { own.clone() };
                self.part(section, &name, reduced, elements);
            }
        }
    }

    /// The pieces of a section that have nodes at one place but none in common, as tied bodies or bodies in contact have; all of it where
    /// there are none.
    pub fn pieces(&self, elements: &[usize]) -> Vec<Vec<usize>> {
        let deck = self.deck;
        let nodes_of = |element: &usize| deck.elements[*element].nodes.as_slice();
        let mut nodes: Vec<usize> = elements.iter().flat_map(nodes_of).copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let own = |node: &usize| nodes.partition_point(|other| other < node);
        let groups = elements.iter().map(|element| nodes_of(element).iter().map(own).collect::<Vec<_>>());
        let lowest = lowest_connected(nodes.len(), groups);
        let mut pieces: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for element in elements {
            pieces.entry(lowest[own(&nodes_of(element)[0])]).or_default().push(*element);
        }
        let places: Vec<[f64; 3]> = nodes.iter().map(|node| deck.nodes[*node].position).collect();
        let touch = || coincident(&places).iter().any(|[a, b]| lowest[*a] != lowest[*b]);
        if pieces.len() > 1 && touch() { pieces.into_values().collect() } else { vec![elements.to_vec()] }
    }

    fn part(&mut self, index: usize, name: &str, reduced: bool, elements: Vec<usize>) {
        let deck = self.deck;
        let section: &Section = &deck.sections[index];
        let material = deck.material(&section.material);
        let Some(material) = material else {
            let found = format!("material `{}` of section `{}`", section.material, section.name);
            self.fault(section.place, found, "the name of a material of the file");
            return;
        };
        let Some(name) = self.regions.part(name, &elements) else { return };
        let dimension = deck.elements[elements[0]].kind.dimension();
        let kinds: HashSet<CellKind> = elements.iter().map(|element| deck.elements[*element].kind).collect();
        let name_of_material = quoted(&material.name);
        match section.shape {
            SectionShape::Solid | SectionShape::Unstated if dimension == 3 => {
                self.case.table("solid", &name).key("material", name_of_material.clone());
                if reduced {
                    self.case.key("integration", quoted("reduced"));
                }
                let locks = [CellKind::Tetrahedron4, CellKind::Pyramid5, CellKind::Wedge6];
                if locks.iter().any(|kind| kinds.contains(kind)) {
                    self.case.comment("Linear tetrahedra, pyramids and wedges are too stiff in bending and shear: better of second order.");
                    self.case.key("allow_locking", "true");
                    let why = "linear tetrahedra, pyramids and wedges are far too stiff";
                    self.ledger.note(Weight::Perhaps, format!("part {name}"), why, section.place);
                }
                if let Some(Elastic::Orthotropic { youngs_moduli, poissons_ratios, shear_moduli }) =
                    material.elastic
                {
                    self.orthotropic(&material.name, section, youngs_moduli, poissons_ratios, shear_moduli);
                }
            }
            SectionShape::Solid | SectionShape::Unstated => {
                let (table, size) = if dimension == 2 { ("shell", "thickness") } else { ("bar", "diameter") };
                self.case.table(table, &name).comment(format!("The file has no {size}: give one."));
                self.case.key("material", name_of_material.clone());
            }
            SectionShape::Shell { thickness } => {
                let thickness = quantity(thickness * self.units.length, 1e-3, "mm");
                self.case
                    .table("shell", &name)
                    .key("material", name_of_material.clone())
                    .key("thickness", thickness);
                self.case.key("theory", quoted("mindlin"));
            }
            SectionShape::Beam { profile, first_axis } => {
                self.case.table("bar", &name).key("material", name_of_material.clone());
                if let Some(axis) = first_axis {
                    self.case.key("orientation", numbers(axis));
                }
                self.profile(profile);
            }
            SectionShape::Truss { area } => {
                self.case.table("bar", &name).key("material", name_of_material.clone());
                self.case.comment("A bar without bending, read as a round beam of the same area.");
                let diameter = 2.0 * (area / std::f64::consts::PI).sqrt();
                let why = "trusses are read as round beams of the same area";
                self.ledger.note(Weight::Perhaps, format!("part {name}"), why, section.place);
                self.profile(Profile::Round { diameter });
            }
        }
        if material.elastic.is_none() {
            let table = format!("[material.{name_of_material}]").replace('"', "");
            self.case.comment(format!("The file has no elastic constants: add {table}."));
        }
        self.note_formulations(&name, section, &elements);
        self.parts.push(Part { name, section: index, elements });
    }

    /// Formulations that are taken as others.
    fn note_formulations(&mut self, name: &str, section: &Section, elements: &[usize]) {
        let names: HashSet<&str> = elements
            .iter()
            .map(|element| self.deck.type_names[self.deck.elements[*element].type_name as usize].as_str())
            .collect();
        let mut names: Vec<&str> = names.into_iter().collect();
        names.sort_unstable();
        for type_name in names {
            let why = match type_name {
                "C3D8" | "C3D8H" | "C3D8T" => {
                    "8-node hexahedra are read with incompatible modes, which do not lock in bending"
                }
                "C3D8R" | "C3D8RH" | "C3D8RT" => {
                    "8-node hexahedra are read with incompatible modes instead of one point of integration"
                }
                "C3D10M" | "C3D10MH" | "C3D10MT" => "modified tetrahedra are read as those of second order",
                "C3D27R" | "C3D27RH" => "reduced integration of this kind is read as full",
                "S4R" | "S3R" | "S8R" | "S8R5" | "S4R5" => "reduced integration of shells is read as full",
                _ => continue,
            };
            self.ledger.note(
                Weight::Perhaps,
                format!("elements of type {type_name}"),
                format!("{why} (part {name})"),
                section.place,
            );
        }
    }

    fn profile(&mut self, profile: Profile) {
        let length = self.units.length;
        match profile {
            Profile::Round { diameter } => {
                self.case.key("diameter", quantity(diameter * length, 1e-3, "mm"));
            }
            Profile::General { area, second_moments: [first, second], torsion } => {
                let fourth = |value: f64| quantity(value * length.powi(4), 1e-12, "mm^4");
                let value = format!(
                    "{{ area = {}, inertia_1 = {}, inertia_2 = {}, torsion = {} }}",
                    quantity(area * length * length, 1e-6, "mm^2"),
                    // About an axis: the lengths across it count.
                    fourth(second),
                    fourth(first),
                    fourth(torsion)
                );
                self.case.key("section", value);
            }
        }
    }

    /// The table of an orthotropic material: once, with the axes of its first section.
    fn orthotropic(&mut self, name: &str, section: &Section, e: [f64; 3], n: [f64; 3], g: [f64; 3]) {
        let [first, second] = section.axes.unwrap_or([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        let third = stridor_mesh::quality::cross(first, second);
        match self.axes_of_materials.get(name) {
            Some(known) if *known == [first, third] => return,
            Some(_) => {
                let why = "a material in two orientations has that of its first section";
                self.ledger.note(Weight::Matters, format!("material {name}"), why, section.place);
                return;
            }
            None => self.axes_of_materials.insert(name.to_string(), [first, third]),
        };
        let stress = |value: f64| quantity(value * self.units.stress(), 1e9, "GPa");
        let keys = [
            ("axis_3", numbers(third)),
            ("axis_1", numbers(first)),
            ("youngs_modulus_2", stress(e[1])),
            ("youngs_modulus_3", stress(e[2])),
            ("poissons_ratio_13", number(n[1])),
            ("poissons_ratio_23", number(n[2])),
            ("shear_modulus_12", stress(g[0])),
            ("shear_modulus_13", stress(g[1])),
            ("shear_modulus_23", stress(g[2])),
        ];
        self.case.sub_table("material", name, "orthotropic");
        for (key, value) in keys {
            self.case.key(key, value);
        }
    }
}

/// Whether a type's name says reduced integration: `C3D20R`.
fn is_reduced(name: &str) -> bool {
    name.to_uppercase().trim_end_matches(['H', 'T']).ends_with('R')
}
