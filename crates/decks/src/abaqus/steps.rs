//! *HEADING, *STEP, *FREQUENCY, *COMPLEX FREQUENCY.

use super::blocks;
use super::reader::{Found, Reader};
use super::waiting::Step;
use crate::deck::Analysis;
use crate::ledger::Weight;

impl Reader {
    /// *HEADING: the first line is the title.
    pub fn heading(&mut self, _: usize, found: Found<'_>) {
        if let Some((_, line)) = found.lines().next() {
            self.deck.title = line.to_string();
        }
    }

    /// *STEP.
    pub fn begin_step(&mut self, _: usize, _: Found<'_>) {
        self.finish_step();
        self.step = Some(Step::default());
    }

    /// *END STEP.
    pub fn end_step(&mut self, _: usize, _: Found<'_>) {
        self.finish_step();
    }

    /// *FREQUENCY: number of modes, lowest and highest frequency.
    pub fn frequency(&mut self, _: usize, found: Found<'_>) {
        let (count, band) = self.wanted(found);
        self.step.get_or_insert_default().analysis = Some(Analysis::Modes { count, band });
    }

    /// *COMPLEX FREQUENCY: the same.
    pub fn complex_frequency(&mut self, _: usize, found: Found<'_>) {
        if !found.option("FRICTIONDAMPING").is_some_and(|damping| damping.eq_ignore_ascii_case("YES")) {
            let why = "damping by friction, which is left out there without FRICTION DAMPING=YES, is in the complex modes of the case";
            self.deck.ledger.note(Weight::Perhaps, "*COMPLEX FREQUENCY", why, found.place());
        }
        let (count, band) = self.wanted(found);
        self.step.get_or_insert_default().analysis = Some(Analysis::ComplexModes { count, band });
    }

    fn wanted(&mut self, found: Found<'_>) -> (Option<usize>, [Option<f64>; 2]) {
        let Some(row) = found.rows().next() else { return (None, [None; 2]) };
        let cell = row.cell(0).trim_end_matches('.');
        let count = cell.parse().ok().filter(|count| *count > 0);
        if count.is_none() && !cell.is_empty() && !cell.eq_ignore_ascii_case("ALL") {
            self.files.fault(row.place, format!("`{}`", blocks::short(cell)), "the number of modes, or none");
        }
        let mut at = |k: usize| if row.cell(k).is_empty() { None } else { self.number(&row, k) };
        (count, [at(1), at(2)])
    }

    /// Keeps what the step asked for.
    pub fn finish_step(&mut self) {
        self.deck.analyses.extend(self.step.take().and_then(|step| step.analysis));
    }
}
