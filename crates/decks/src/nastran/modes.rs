//! Methods of modes: EIGRL, EIGR, EIGC.

use super::constraints::{Sums, taken};
use super::control::Choice;
use super::fields::Fields;
use super::model::Model;
use crate::deck::Analysis;
use crate::ledger::Weight;
use std::collections::BTreeMap;

#[derive(Debug, Default)]
pub(super) struct Methods {
    real: BTreeMap<u64, Analysis>,
    complex: BTreeMap<u64, Analysis>,
}

/// A number of modes that is written; zero is none.
fn count(fields: &mut Fields, number: usize) -> Option<Option<usize>> {
    let n = fields.id_or(number, 0)?;
    Some(usize::try_from(n).ok().filter(|n| *n > 0))
}

impl Methods {
    pub fn card(&mut self, fields: &mut Fields) -> Option<()> {
        let set = fields.id(1)?;
        let last = fields.last();
        match fields.name() {
            "EIGC" => {
                fields.unread(2, 6, Weight::Nothing, "how complex modes are found and scaled is not read");
                let mut n = count(fields, 7)?;
                for line in (8..last).step_by(8) {
                    fields.unread(
                        line + 1,
                        line + 6,
                        Weight::Nothing,
                        "where in the plane complex modes are looked for is not read",
                    );
                    if n.is_none() {
                        n = count(fields, line + 7)?;
                    }
                }
                self.complex.insert(set, Analysis::ComplexModes { count: n, band: [None; 2] });
            }
            name => {
                let first = if name == "EIGR" { 3 } else { 2 };
                let band = [fields.real_if(first)?, fields.real_if(first + 1)?];
                let n = if name == "EIGR" {
                    fields.unread(5, 5, Weight::Nothing, "how modes are found and scaled is not read");
                    count(fields, 6)?
                } else {
                    count(fields, 4)?
                };
                fields.unread(
                    if name == "EIGR" { 2 } else { 5 },
                    last,
                    Weight::Nothing,
                    "how modes are found and scaled is not read",
                );
                self.real.insert(set, Analysis::Modes { count: n, band });
            }
        }
        Some(())
    }

    pub fn resolve(&self, model: &mut Model) {
        let none = Sums::new();
        let real = taken(Choice::Method, "METHOD", &self.real, &none, model);
        model.deck.analyses.extend(real.iter().filter_map(|set| self.real.get(set).cloned()));
        let complex = taken(Choice::ComplexMethod, "CMETHOD", &self.complex, &none, model);
        model.deck.analyses.extend(complex.iter().filter_map(|set| self.complex.get(set).cloned()));
    }
}
