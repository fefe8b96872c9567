//! *STEP: the loads, then the modes.

use super::{Writer, number, row};
use crate::deck::{Analysis, LoadOn};
use crate::ledger::Weight;

/// Modes where the deck says no number, which CalculiX wants.
const MODES: usize = 20;

impl Writer<'_> {
    pub(super) fn steps(&mut self) {
        if !self.deck.loads.is_empty() || !self.deck.motions.is_empty() {
            let sets = self.sets_that_turn();
            self.line("*STEP");
            self.line("*STATIC");
            self.loads();
            self.motions(&sets);
            self.line("*END STEP");
        }
        for analysis in &self.deck.analyses {
            let (Analysis::Modes { count, band } | Analysis::ComplexModes { count, band }) = analysis;
            let [low, high] = band.map(|hz| hz.map_or(String::new(), number));
            let data = format!("{}, {low}, {high}", count.unwrap_or(MODES));
            let data = data.trim_end_matches([',', ' ']).to_string();
            if count.is_none() {
                let why = format!("the number of modes, which CalculiX wants, is {MODES}");
                self.note(Weight::Nothing, "modes", &why);
            }
            self.step("", "*FREQUENCY", &data);
            if matches!(analysis, Analysis::ComplexModes { .. }) {
                let why = "CalculiX refuses complex modes of friction: their step is a comment, for Abaqus";
                self.note(Weight::Perhaps, "complex modes", why);
                self.step("** ", "*COMPLEX FREQUENCY", &data);
            }
        }
    }

    fn step(&mut self, before: &str, keyword: &str, data: &str) {
        for line in ["*STEP, PERTURBATION", keyword, data, "*END STEP"] {
            self.line(format!("{before}{line}"));
        }
    }

    /// *CLOAD, *DLOAD.
    fn loads(&mut self) {
        let deck = self.deck;
        for load in &deck.loads {
            match &load.on {
                LoadOn::Nodes { nodes, force } => {
                    self.line("*CLOAD");
                    for words in self.words_for_nodes(Some(&load.name), nodes) {
                        for (k, force) in force.iter().enumerate().filter(|(_, force)| **force != 0.0) {
                            self.line(format!("{words}, {}, {}", k + 1, number(*force)));
                        }
                    }
                }
                LoadOn::Shells { shells, pressure } => {
                    self.line("*DLOAD");
                    for shell in shells {
                        let own = self.element_numbers[*shell];
                        self.line(format!("{own}, P, {}", number(*pressure)));
                    }
                }
                LoadOn::Faces { faces, pressure } => {
                    self.line("*DLOAD");
                    for (element, side) in faces {
                        let element_number = self.element_numbers[*element];
                        match self.side_number(*element, *side) {
                            Some(side) => {
                                self.line(format!("{element_number}, P{side}, {}", number(*pressure)))
                            }
                            None => {
                                let why = "a pressure on sides that have no number is not written";
                                self.note(Weight::Perhaps, "loads", why);
                            }
                        }
                    }
                }
            }
        }
    }

    /// The set of nodes that each rotation turns, made where it is one of elements; none where there is no set.
    fn sets_that_turn(&mut self) -> Vec<Option<String>> {
        let deck = self.deck;
        let mut names = Vec::with_capacity(deck.motions.len());
        for motion in &deck.motions {
            names.push(match (deck.node_set(&motion.set), deck.element_set(&motion.set)) {
                (Some(set), _) => Some(self.node_sets.of(&set.name)),
                (None, Some(set)) => {
                    let own = self.node_sets.free(&set.name);
                    let elements = set.members.iter().map(|element| &deck.elements[*element]);
                    let mut nodes: Vec<usize> =
                        elements.flat_map(|element| element.nodes.iter().copied()).collect();
                    nodes.sort_unstable();
                    nodes.dedup();
                    self.line(format!("*NSET, NSET={own}"));
                    self.list(&self.node_numbers_of(&nodes));
                    Some(own)
                }
                _ => None,
            });
        }
        names
    }

    /// *MOTION, ROTATION: set, angular velocity, two points of the axis.
    fn motions(&mut self, sets: &[Option<String>]) {
        let deck = self.deck;
        for (motion, set) in deck.motions.iter().zip(sets) {
            let Some(set) = set else {
                self.note(Weight::Matters, "rotations", "a rotation of no set is not written");
                continue;
            };
            self.note(Weight::Matters, "rotations", "CalculiX does not read *MOTION");
            let end: [f64; 3] = std::array::from_fn(|k| motion.point[k] + motion.axis[k]);
            self.line("*MOTION, ROTATION");
            self.line(format!("{set}, {}, {}, {}", number(motion.speed), row(&motion.point), row(&end)));
        }
    }
}
