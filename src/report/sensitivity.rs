//! Sensitivities of complex modes, and the additions that stabilise them.

use super::finding::{Finding, FindingClass};
use super::format::{fixed, given, hertz, power, rate, signed, significant};
use super::section::{Display, ReportSection};
use super::table::ReportTable;
use super::{advice, tornado};
use crate::linalg::c64;
use crate::results::{ModeSensitivity, Mounted, RunResults, SensitivityResult};
use std::f64::consts::TAU;

/// Sensitivities, where the run has them.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    let Some(found) = results.get::<SensitivityResult>() else { return Vec::new() };
    let places = found.modes.iter().any(|mode| !mode.best.is_empty()).then(|| advice_table(found));
    let left_out = found.left_out.iter().map(|(path, why)| format!("{path} is left out: {why}."));
    let section = ReportSection::new("Sensitivities of the modes, and additions that stabilise them")
        .findings(finding(found))
        .pictures([tornado::picture(results), advice::picture(results)].into_iter().flatten())
        .tables(Display::Closed, found.modes.iter().map(rates))
        .tables(Display::Titled, places)
        .words(left_out);
    vec![section]
}

/// What moves the mode that grows most, and what calms it.
fn finding(result: &SensitivityResult) -> Option<Finding> {
    let mode = result.modes.iter().max_by(|a, b| a.eigenvalue.re.total_cmp(&b.eigenvalue.re))?;
    let hz = hertz(mode.eigenvalue.im / TAU, 1);
    let mut words = format!(
        "Sensitivity: of the examined modes that at {hz} Hz grows most, σ = {} 1/s.",
        rate(mode.eigenvalue)
    );
    let moves = mode.parameters.iter().any(|scalar| scalar.moves_growth());
    if !moves && !mode.parameters.is_empty() {
        words += " No scalar moves its growth rate by more than rounding.";
    } else if let Some(first) = mode.parameters.iter().find(|scalar| scalar.moves_growth()) {
        let change = first.growth_per_percent();
        let sign = if change > 0.0 { "+" } else { "" };
        words += &format!(
            " `{}` moves it most: by {sign}{} 1/s when it grows by 1 %.",
            first.path,
            significant(change, 3)
        );
    }
    let calmest = |a: &&Mounted, b: &&Mounted| outcome(mode, a).0.total_cmp(&outcome(mode, b).0);
    if let Some(best) = mode.best.iter().min_by(calmest) {
        let (sigma, how) = outcome(mode, best);
        let place = best.position.map(|c| fixed(1e3 * c, 1)).join(", ");
        words += &format!(" {} at ({place}) mm: σ = {} 1/s, {how}.", mounted(best), signed(sigma, 2));
    }
    Some(Finding::new(FindingClass::Neutral, words))
}

/// σ with a thing mounted, and how that is known.
fn outcome(mode: &ModeSensitivity, thing: &Mounted) -> (f64, &'static str) {
    match thing.done {
        Some(change) => (mode.eigenvalue.re + change.re, "recomputed with it"),
        None => (mode.eigenvalue.re + thing.predicted.re, "to first order"),
    }
}

/// What is mounted, with its size.
fn mounted(thing: &Mounted) -> String {
    match thing.kind {
        "mass" => format!("A mass of {} g", given(1e3 * thing.amount)),
        kind => format!("A {kind} of {} {}", given(thing.amount), thing.unit),
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use crate::linalg::random::Random;

    /// Effects from 1e-40 to 1 of |λ|, and errors of their slopes: one is named where it is more than both roundings.
    #[test]
    fn what_is_rounding_moves_no_mode() {
        let mut random = Random::seeded(3);
        let mut results = sample::rig();
        for member in 0..60 {
            let mode = &mut results.get_mut::<SensitivityResult>().unwrap().modes[0];
            mode.eigenvalue = c64::new(50.0, 5e3);
            let (effect, error) =
                (10f64.powf(random.between(-40.0, 0.0)), 10f64.powf(random.between(-20.0, 0.0)));
            for scalar in &mut mode.parameters {
                let rate = 100.0 * effect * 5e3 / scalar.value;
                (scalar.rate, scalar.size) = (c64::new(rate, 1e-60 * rate), 5e3);
                scalar.error = if member % 2 == 0 { 0.0 } else { (error * 5e5 / scalar.value).abs() };
            }
            let named = effect > 1e-14 && (member % 2 == 0 || effect > error);
            let found = results.get::<SensitivityResult>().unwrap();
            let mut found = found.clone();
            found.modes.truncate(1);
            let words = finding(&found).unwrap().words;
            assert_eq!(words.contains("moves it most"), named, "{effect:e} {error:e}: {words}");
            assert_eq!(words.contains("No scalar moves"), !named, "{words}");
            let table = rates(&found.modes[0]);
            let cells: Vec<&String> = table.rows.iter().flat_map(|row| &row.cells).collect();
            let exponent =
                |cell: &&&String| cell.split_once("e−").and_then(|(_, power)| power.parse::<u32>().ok());
            assert!(cells.iter().filter_map(|cell| exponent(&cell)).all(|power| power < 20), "{cells:?}");
            assert_eq!(
                cells.iter().any(|cell| **cell == significant(100.0 * effect * 50.0, 3)),
                effect > 1e-14
            );
        }
    }
}
