//! Sensitivities of complex modes, and the additions that stabilise them.

use super::format::{fixed, given, hertz, power, rate};
use super::section::{Display, ReportSection};
use super::table::ReportTable;
use super::{advice, tornado};
use crate::linalg::c64;
use crate::results::{ModeSensitivity, RunResults, SensitivityResult};
use std::f64::consts::TAU;

/// Sensitivities, where the run has them.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    let Some(found) = results.get::<SensitivityResult>() else { return Vec::new() };
    let places = found.modes.iter().any(|mode| !mode.best.is_empty()).then(|| advice_table(found));
    let left_out = found.left_out.iter().map(|(path, why)| format!("{path} is left out: {why}."));
    let section = ReportSection::new("Sensitivities of the modes, and additions that stabilise them")
        .pictures([tornado::picture(results), advice::picture(results)].into_iter().flatten())
        .tables(Display::Closed, found.modes.iter().map(rates))
        .tables(Display::Untitled, places)
        .words(left_out);
    vec![section]
}

/// Derivatives of a mode, the scalar that moves its growth rate most first. The derivatives proper are the last two
/// columns.
fn rates(mode: &ModeSensitivity) -> ReportTable {
    let hz = hertz(mode.eigenvalue.im / TAU, 1);
    let caption = format!("Sensitivities of the mode at {hz} Hz, σ = {} 1/s", rate(mode.eigenvalue));
    let mut table = ReportTable::of(caption, &mode.rates(), false);
    table.notes.push(
        "The steady state follows every scalar. Error: of dλ/dp, relative; dσ/dp, df/dp: per SI unit.".into(),
    );
    if mode.parameters.iter().any(|p| p.kink) {
        table.notes.push("†: the slopes to the two sides differ; their mean is given.".into());
    }
    table
}

/// The best places for a mass and a damper, one row each.
fn advice_table(result: &SensitivityResult) -> ReportTable {
    let headings =
        ["f [Hz]", "σ [1/s]", "<mount", "<at x, y, z [mm]", "<along", "by slope", "done", "slope error"];
    let mut table =
        ReportTable::new("Stabilising additions: σ with each one mounted at its best place", &headings);
    for mode in &result.modes {
        for addition in &mode.best {
            let amount = if addition.kind == "mass" {
                format!("{} g", given(1e3 * addition.amount))
            } else {
                format!("{} {} {}", addition.kind, given(addition.amount), addition.unit)
            };
            let sigma = |d: c64| rate(mode.eigenvalue + d);
            let cells = vec![
                hertz(mode.eigenvalue.im / TAU, 1),
                rate(mode.eigenvalue),
                amount,
                addition.position.map(|c| fixed(1e3 * c, 1)).join(", "),
                addition.direction.map_or(String::new(), axis),
                sigma(addition.predicted),
                addition.done.map_or("–".into(), sigma),
                addition.slope_error.map_or("–".into(), power),
            ];
            table.row(cells, false);
        }
    }
    table
        .notes
        .push("By slope: to first order; done: mounted on the model and everything recomputed.".into());
    table.notes.push(
        "Slope error: relative difference between the slope and the effect of a thousandth of the addition mounted on the model."
            .into(),
    );
    table
}

/// An axis by its name, any other direction as the surface's normal.
fn axis(direction: [f64; 3]) -> String {
    let named = [([1.0, 0.0, 0.0], "x"), ([0.0, 1.0, 0.0], "y"), ([0.0, 0.0, 1.0], "z")];
    named.iter().find(|(axis, _)| *axis == direction).map_or("normal", |(_, name)| name).to_string()
}
