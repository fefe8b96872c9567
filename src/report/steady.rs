//! Steady sliding.

use super::contact;
use super::format::power;
use super::section::{Display, ReportSection};
use super::table::ReportTable;
use crate::results::{RunResults, SteadyResult};

/// Steady sliding, where the run has it.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    let steady = results.get::<SteadyResult>();
    let section = |steady| ReportSection::new("Steady sliding").tables(Display::Untitled, [table(steady)]);
    steady.map(|steady| section(steady).pictures(contact::picture(results))).into_iter().collect()
}

/// Steady sliding, one row a pair.
fn table(result: &SteadyResult) -> ReportTable {
    let mut table = ReportTable::of("Steady sliding", &result.pair_table(), false);
    let residual = power(result.state.residual);
    table.notes.push(format!("{} Newton iterations, relative residual {residual}.", result.state.iterations));
    table
}
