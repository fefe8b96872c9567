//! Sweeps, maps and what damping decides: sections of the page, pictures, tables, and what was found in words.

mod map;
mod sweep;
mod words;

use words::{critical_table, damping_table, map_words, sweep_words};

use super::section::{Display, Section};
use crate::results::{DampingVerdicts, MapResult, RunResults, SweepResult};
use crate::sweep::Axis;

/// Sweeps, maps, and what damping decides.
pub(super) fn sections(results: &RunResults) -> Vec<Section> {
    let sweeps = results.all::<SweepResult>().into_iter().map(|sweep| {
        Section::new(format!("Sweep: {}", sweep.name))
            .pictures(sweep::pictures(sweep))
            .tables(Display::Titled, [critical_table(sweep)])
            .words(sweep_words(sweep))
    });
    let maps = results.all::<MapResult>().into_iter().map(|map| {
        Section::new(format!("Map: {}", map.name)).words(map_words(map)).pictures(map::picture(map))
    });
    let damping = results.get::<DampingVerdicts>().map(|verdicts| {
        Section::new("What damping decides").tables(Display::Titled, [damping_table(verdicts)])
    });
    sweeps.chain(maps).chain(damping).collect()
}

/// A parameter's path with its unit, for axes.
fn axis_name(path: &str, unit: &str) -> String {
    if unit.is_empty() { path.to_string() } else { format!("{path} [{unit}]") }
}

/// A value's place on an axis: itself, or its logarithm.
fn place(axis: &Axis, value: f64) -> f64 {
    if axis.log { value.abs().log10() } else { value }
}

/// The value at a place.
fn value_at(axis: &Axis, place: f64) -> f64 {
    if axis.log { axis.from.signum() * 10f64.powf(place) } else { place }
}
