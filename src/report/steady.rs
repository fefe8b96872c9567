//! Steady sliding.

use super::contact;
use super::finding::{Finding, FindingClass};
use super::format::{power, significant};
use super::section::{Display, ReportSection};
use super::table::{ReportTable, idle};
use crate::results::{RunResults, SteadyResult, TransientResult};

/// Steady sliding, where the run has it.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    let Some(steady) = results.get::<SteadyResult>() else { return Vec::new() };
    let section =
        ReportSection::new("Steady sliding").findings([finding(steady, results.get::<TransientResult>())]);
    let section = section.tables(Display::Titled, [table(steady)]);
    vec![
        section
            .tables(Display::Folded, contact::table(steady))
            .pictures(contact::pictures(steady, &results.geometry.nodes)),
    ]
}

/// The force in motion, in forces at rest, from which it is named.
const CHANGED: f64 = 1.1;
/// Pairs that are named one by one.
const NAMED: usize = 3;

/// Where the load is carried, and the most that it becomes in motion.
fn finding(result: &SteadyResult, motion: Option<&TransientResult>) -> Finding {
    let totals = result.totals();
    let open: Vec<&str> = totals.iter().filter(|pair| pair.closed == 0).map(|pair| pair.name).collect();
    let in_motion = |pair: &str, force: f64| {
        let name = format!("{pair}_normal_force");
        let channel = motion.and_then(|run| run.channels.iter().find(|channel| channel.name == name));
        let most = channel.map(|channel| channel.range[1]).filter(|most| *most > CHANGED * force);
        most.map_or(String::new(), |most| format!(", in motion up to {} N", significant(most, 3)))
    };
    let each = totals.iter().take(NAMED).map(|pair| {
        format!(
            "{} carries {} N on {} of {} points{}",
            pair.name,
            significant(pair.normal_force, 3),
            pair.closed,
            pair.closed + pair.open,
            in_motion(pair.name, pair.normal_force)
        )
    });
    let each: Vec<String> = each.collect();
    let more = match totals.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(", and {more} more"),
    };
    let words = format!("Steady sliding: {}{more}.", each.join("; "));
    if open.is_empty() {
        return Finding::new(FindingClass::Basis, words);
    }
    Finding::new(FindingClass::Attention, format!("{words} Nothing touches in {}.", open.join(", ")))
}

/// Steady sliding, one row a pair.
fn table(result: &SteadyResult) -> ReportTable {
    let table = ReportTable::of("Steady sliding", &result.pair_table(), false);
    let mut table = table.without_columns(idle);
    let residual = power(result.state.residual);
    table.notes.push(format!("{} Newton iterations, relative residual {residual}.", result.state.iterations));
    table
}
