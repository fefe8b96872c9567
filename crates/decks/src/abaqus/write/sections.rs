//! *MATERIAL, *SOLID SECTION, *SHELL SECTION, *BEAM SECTION, *ORIENTATION, *MASS, *SPRING, *DASHPOT.

use super::{Writer, number, row};
use crate::deck::{Elastic, Material, Profile, Section, SectionShape};
use crate::ledger::Weight;

impl Writer<'_> {
    /// *MATERIAL with its constants.
    pub(super) fn materials(&mut self) {
        let deck = self.deck;
        for material in &deck.materials {
            let name = self.materials.of(&material.name);
            self.line(format!("*MATERIAL, NAME={name}"));
            match material.elastic {
                Some(Elastic::Isotropic { youngs_modulus, poissons_ratio }) => {
                    self.line("*ELASTIC");
                    self.line(row(&[youngs_modulus, poissons_ratio]));
                }
                Some(Elastic::Orthotropic { youngs_moduli, poissons_ratios, shear_moduli }) => {
                    self.line("*ELASTIC, TYPE=ENGINEERING CONSTANTS");
                    let nine = [youngs_moduli, poissons_ratios, shear_moduli].concat();
                    self.line(row(&nine[..8]));
                    self.line(row(&nine[8..]));
                }
                None => {}
            }
            if let Some(density) = material.density {
                self.line("*DENSITY");
                self.line(number(density));
            }
            let [alpha, beta] = material.rayleigh;
            let damping = [("ALPHA", alpha), ("BETA", beta), ("STRUCTURAL", material.loss_factor)];
            let damping = damping.iter().filter(|(_, value)| *value != 0.0);
            let words: String = damping.map(|(name, value)| format!(", {name}={}", number(*value))).collect();
            if !words.is_empty() {
                self.line(format!("*DAMPING{words}"));
            }
        }
    }

    /// A set of elements of just these, by the name of its section or one of its own.
    fn set_of(&mut self, section: &Section) -> String {
        let known = self.deck.element_set(&section.name).filter(|set| set.members == section.elements);
        if let Some(set) = known {
            return self.element_sets.of(&set.name);
        }
        let name = self.element_sets.free(&section.name);
        self.line(format!("*ELSET, ELSET={name}, INTERNAL"));
        self.list(&self.element_numbers_of(&section.elements));
        name
    }

    pub(super) fn sections(&mut self) {
        let deck = self.deck;
        for section in deck.sections.iter().filter(|section| !section.elements.is_empty()) {
            let set = self.set_of(section);
            let material = self.materials.of(&section.material);
            let orientation = section.axes.map_or(String::new(), |[first, second]| {
                self.orientations += 1;
                let name = format!("AXES_{}", self.orientations);
                self.line(format!("*ORIENTATION, NAME={name}"));
                self.line(row(&[first, second].concat()));
                format!(", ORIENTATION={name}")
            });
            let words = format!("ELSET={set}, MATERIAL={material}{orientation}");
            match &section.shape {
                SectionShape::Solid => self.line(format!("*SOLID SECTION, {words}")),
                SectionShape::Unstated => {
                    let what = format!("section {}", section.name);
                    self.note(Weight::Matters, &what, "its shape is not stated");
                }
                SectionShape::Truss { area } => {
                    self.line(format!("*SOLID SECTION, {words}"));
                    self.line(number(*area));
                }
                SectionShape::Shell { thickness } => {
                    self.line(format!("*SHELL SECTION, {words}"));
                    self.line(number(*thickness));
                }
                SectionShape::Beam { profile, first_axis } => {
                    self.beam(&set, deck.material(&section.material), *profile, *first_axis);
                }
            }
        }
    }

    /// *BEAM GENERAL SECTION: A, I11, I12, I22, J; the direction of the first axis; E, G.
    fn beam(&mut self, set: &str, material: Option<&Material>, profile: Profile, axis: Option<[f64; 3]>) {
        let (area, [second, first], torsion) = match profile {
            Profile::General { area, second_moments, torsion } => (area, second_moments, torsion),
            Profile::Round { diameter } => {
                let moment = std::f64::consts::PI * diameter.powi(4) / 64.0;
                (profile.area(), [moment; 2], 2.0 * moment)
            }
        };
        let why = "CalculiX does not read *BEAM GENERAL SECTION";
        self.note(Weight::Matters, "beams", why);
        let Some(Material { elastic: Some(elastic), density, rayleigh, loss_factor, .. }) = material else {
            self.note(Weight::Matters, "beams", "a beam without elastic constants is not written");
            return;
        };
        if *rayleigh != [0.0; 2] || *loss_factor != 0.0 {
            self.note(Weight::Perhaps, "beams", "damping of the materials of beams is not written");
        }
        let [e, g] = match *elastic {
            Elastic::Isotropic { youngs_modulus, poissons_ratio } => {
                [youngs_modulus, youngs_modulus / (2.0 * (1.0 + poissons_ratio))]
            }
            Elastic::Orthotropic { youngs_moduli, shear_moduli, .. } => [youngs_moduli[0], shear_moduli[0]],
        };
        let density = density.map_or(String::new(), |density| format!(", DENSITY={}", number(density)));
        self.line(format!("*BEAM GENERAL SECTION, SECTION=GENERAL, ELSET={set}{density}"));
        self.line(row(&[area, first, 0.0, second, torsion]));
        self.line(row(&axis.unwrap_or([0.0, 0.0, -1.0])));
        self.line(row(&[e, g]));
    }

    /// Elements without a shape, in a set of their own.
    fn points(&mut self, type_name: &str, name: &str, nodes: impl Iterator<Item = Vec<usize>>) -> String {
        let name = self.element_sets.free(if name.is_empty() { type_name } else { name });
        self.line(format!("*ELEMENT, TYPE={type_name}, ELSET={name}"));
        for nodes in nodes {
            let mut words = vec![self.next_element];
            words.extend(self.node_numbers_of(&nodes));
            self.next_element += 1;
            self.list(&words);
        }
        name
    }

    /// *MASS, *ROTARY INERTIA.
    pub(super) fn masses(&mut self) {
        let deck = self.deck;
        for mass in &deck.masses {
            let nodes = || mass.nodes.iter().map(|node| vec![*node]);
            if mass.mass != 0.0 {
                let set = self.points("MASS", &mass.name, nodes());
                self.line(format!("*MASS, ELSET={set}"));
                self.line(number(mass.mass));
            }
            if mass.inertia != [0.0; 3] {
                self.note(Weight::Matters, "masses", "CalculiX does not read *ROTARY INERTIA");
                let set = self.points("ROTARYI", &mass.name, nodes());
                self.line(format!("*ROTARY INERTIA, ELSET={set}"));
                self.line(row(&mass.inertia));
            }
        }
    }

    /// *SPRING, *DASHPOT: to the ground, between nodes, or along the line between them.
    pub(super) fn springs(&mut self) {
        let deck = self.deck;
        for spring in &deck.springs {
            for (kind, value) in [("SPRING", spring.stiffness), ("DASHPOT", spring.damping)] {
                for grounded in [true, false] {
                    let ends = || spring.ends.iter().filter(|(_, other)| other.is_none() == grounded);
                    if value == 0.0 || ends().next().is_none() {
                        continue;
                    }
                    let form = if spring.dof.is_none() {
                        "A"
                    } else if grounded {
                        "1"
                    } else {
                        "2"
                    };
                    if spring.dof.is_none() && grounded {
                        let why = "a spring along the line to the ground has no direction: it is not written";
                        self.note(Weight::Matters, "springs", why);
                        continue;
                    }
                    let nodes = ends().map(|(node, other)| std::iter::once(*node).chain(*other).collect());
                    let set = self.points(&format!("{kind}{form}"), &spring.name, nodes);
                    self.line(format!("*{kind}, ELSET={set}"));
                    match spring.dof {
                        Some(dof) if grounded => self.line(format!("{}", dof + 1)),
                        Some(dof) => self.line(format!("{}, {}", dof + 1, dof + 1)),
                        None => self.line(""),
                    }
                    self.line(number(value));
                }
            }
        }
    }
}
