//! Sweeps, maps and what damping decides: sections of the page, pictures, tables, and what was found in words.

mod axis;
mod map;
mod sweep;
mod words;

use words::{critical_table, damping_table, map_words, sweep_words};

use super::section::{Display, ReportSection};
use crate::results::{DampingVerdicts, MapResult, RunResults, SweepResult};

/// Sweeps, maps, and what damping decides.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    let sweeps = results.all::<SweepResult>().into_iter().map(|sweep| {
        ReportSection::new(format!("Sweep: {}", sweep.name))
            .pictures(sweep::pictures(sweep))
            .tables(Display::Titled, [critical_table(sweep)])
            .words(sweep_words(sweep))
    });
    let maps = results.all::<MapResult>().into_iter().map(|map| {
        ReportSection::new(format!("Map: {}", map.name)).words(map_words(map)).pictures(map::picture(map))
    });
    let damping = results.get::<DampingVerdicts>().map(|verdicts| {
        ReportSection::new("What damping decides").tables(Display::Titled, [damping_table(verdicts)])
    });
    sweeps.chain(maps).chain(damping).collect()
}
