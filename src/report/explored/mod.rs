//! Sweeps, maps and what damping decides: sections of the page, pictures, tables, and what was found in words.

mod axis;
mod branches;
mod finding;
mod map;
mod places;
mod sweep;
mod words;
mod zoom;

use words::{critical_proof, critical_table, damping_table, map_words, sweep_words};

use super::section::{Display, ReportSection};
use crate::results::{DampingVerdicts, MapResult, RunResults, SweepResult};

/// Sweeps, maps, and what damping decides.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    let sweeps = results.all::<SweepResult>().into_iter().map(|sweep| {
        let found = places::places_of(sweep);
        ReportSection::new(format!("Sweep: {}", sweep.name))
            .findings([finding::sweep(sweep)])
            .pictures(sweep::picture(sweep, &found))
            .pictures(zoom::picture(sweep, &found))
            .pictures(sweep::locus(sweep))
            .tables(Display::Titled, [critical_table(sweep)])
            .tables(Display::Proof, critical_proof(sweep))
            .words(sweep_words(sweep))
    });
    let maps = results.all::<MapResult>().into_iter().map(|map| {
        let section = ReportSection::new(format!("Map: {}", map.name)).findings([finding::map(map)]);
        section.words(map_words(map)).pictures(map::picture(map))
    });
    let damping = results.get::<DampingVerdicts>().map(|verdicts| {
        let section = ReportSection::new("What damping decides").findings([finding::damping(verdicts)]);
        section.tables(Display::Titled, [damping_table(verdicts)])
    });
    sweeps.chain(maps).chain(damping).collect()
}
