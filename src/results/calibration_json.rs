//! A calibration in `summary.json`.

use super::{CalibratedDatum, CalibratedNumber, CalibratedResponse, CalibrationResult};
use crate::calibration::Ranked;
use serde_json::{Value, json};

/// The part of `summary.json` on a calibration.
pub(super) fn summary(result: &CalibrationResult) -> Value {
    let found = &result.calibration;
    let known = &found.knowledge;
    let number = |n: &CalibratedNumber| {
        json!({
            "name": n.name,
            "paths": n.paths,
            "unit": n.unit,
            "between": n.between,
            "expected": n.expected,
            "prior_deviation": n.deviation,
            "log": n.log,
            "before": n.before,
            "after": n.after,
            "deviation": n.deviation_after,
            "interval_95": n.interval,
            "scaled_interval_95": n.scaled_interval,
            "at_bound": n.at_bound,
        })
    };
    let datum = |d: &CalibratedDatum| {
        json!({
            "set": d.set,
            "mode": d.level,
            "measured_hz": d.measured_hz,
            "relative_deviation": d.deviation,
            "before_hz": d.before_hz,
            "after_hz": d.after_hz,
            "before_percent": d.error_percent(d.before_hz),
            "error_percent": d.error_percent(d.after_hz),
            "left_out_hz": d.left_out_hz,
            "left_out_percent": d.error_percent(d.left_out_hz),
            "growth_rate": d.growth,
            "shape": d.shape.map(|s| json!({
                "components": s.components,
                "mac_before": s.before,
                "mac_after": s.after,
                "mac_left_out": s.left_out,
            })),
        })
    };
    let response = |r: &CalibratedResponse| {
        json!({
            "set": r.set,
            "name": r.name,
            "place": r.place,
            "lines": r.frequencies_hz.len(),
            "band_hz": [r.frequencies_hz.first(), r.frequencies_hz.last()],
            "deviation": r.deviation,
            "before_db": r.apart_db(&r.before),
            "after_db": r.apart_db(&r.after),
            "left_out_db": r.left_out.as_ref().map(|sizes| r.apart_db(sizes)),
            "after_deviations": r.apart(&r.after),
            "left_out_deviations": r.left_out.as_ref().map(|sizes| r.apart(sizes)),
        })
    };
    let ranked = |r: &Ranked| {
        json!({
            "modes": r.assignment.iter().map(|k| &result.levels[*k]).collect::<Vec<_>>(),
            "chi2": r.fit.chi2,
            "linear_chi2": r.linear_chi2,
            "largest_error_percent": 100.0 * r.largest_error,
            "least_mac": r.least_likeness,
            "weight": r.weight,
            "converged": r.fit.converged,
            "iterations": r.fit.iterations,
            "evaluations": r.fit.evaluations,
            "gradient": r.fit.gradient,
        })
    };
    let chance = found.chance.map(|c| {
        json!({
            "draws": c.draws,
            "as_good_by_largest_error": c.by_error,
            "as_good_by_chi2": c.by_chi2,
            "probability_by_largest_error": c.probability(c.by_error),
            "probability_by_chi2": c.probability(c.by_chi2),
        })
    });
    let share = |covered: &Vec<usize>, of: usize| -> Vec<f64> {
        covered.iter().map(|c| *c as f64 / of as f64).collect()
    };
    let trials = found.trials.as_ref().map(|t| {
        json!({
            "count": t.count,
            "converged": t.converged,
            "model_error": t.model_error,
            "coverage": share(&t.covered, t.count),
            "least_coverage": share(&t.covered, t.count).into_iter().fold(1.0, f64::min),
            "scaled_coverage": t.scaled_covered.as_ref().map(|c| share(c, t.count)),
        })
    });
    json!({
        "parameters": result.numbers.iter().map(number).collect::<Vec<_>>(),
        "data": result.data.iter().map(datum).collect::<Vec<_>>(),
        "responses": result.responses.iter().map(response).collect::<Vec<_>>(),
        "largest_error_percent": result.largest_percent(|d| d.after_hz),
        "least_mac": result.least_mac(|s| s.after),
        "least_left_out_mac": result.least_mac(|s| s.left_out),
        "largest_left_out_percent": result.largest_percent(|d| d.left_out_hz),
        "chi2": found.best().fit.chi2,
        "degrees_of_freedom": known.freedom,
        "reduced_chi2": known.reduced_chi2,
        "chi2_probability": known.chi2_probability,
        "converged": found.best().fit.converged,
        "assignments": found.ranked.iter().map(ranked).collect::<Vec<_>>(),
        "plausible_assignments": found.plausible,
        "tried_assignments": found.tried,
        "all_assignments_counted": found.all_counted,
        "all_assignments_searched": found.all_searched,
        "levels": result.levels.len(),
        "singular_values": known.singular_values,
        "directions": known.directions,
        "condition": known.condition(),
        "determined_combinations": known.determined(),
        "correlations": known.correlations,
        "chance": chance,
        "trials": trials,
    })
}
