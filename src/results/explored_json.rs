//! The parts of `summary.json` on sweeps, maps and damping.

use super::explored_hdf5::{encounter_name, kind_name};
use super::{DampingVerdicts, MapResult, Method, SweepResult};
use crate::stability::unstable;
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// `"reduced"` or `"whole"`, and the size.
fn method(method: Method) -> Value {
    match method {
        Method::Reduced(dimension) => json!({ "kind": "reduced", "dimension": dimension }),
        Method::Whole => json!({ "kind": "whole" }),
    }
}

pub(super) fn sweep(result: &SweepResult) -> Value {
    let sweep = &result.sweep;
    let branches: Vec<Value> = sweep
        .branches
        .iter()
        .map(|b| {
            let last = b.eigenvalues.last().copied().unwrap_or_default();
            let first = b.eigenvalues.first().copied().unwrap_or_default();
            let largest = b.eigenvalues.iter().map(|z| z.re).fold(f64::NEG_INFINITY, f64::max);
            json!({
                "from": sweep.values[b.first],
                "to": sweep.values[b.first + b.eigenvalues.len() - 1],
                "frequency_hz": [first.im / TAU, last.im / TAU],
                "growth_rate": [first.re, last.re],
                "largest_growth_rate": largest,
                "ever_unstable": b.eigenvalues.iter().any(|z| unstable(*z)),
                "lowest_mac": b.lowest_mac,
            })
        })
        .collect();
    let critical: Vec<Value> = sweep
        .critical
        .iter()
        .enumerate()
        .map(|(k, c)| {
            let full = result.verified.get(k).copied().flatten();
            json!({
                "value": c.value,
                "verified_error": result.value_error(k),
                "frequency_hz": c.eigenvalue.im / TAU,
                "kind": kind_name(c.kind),
                "becomes": if c.rises { "unstable" } else { "stable" },
                "branch": c.branch + 1,
                "backward_error": full.map(|f| f.backward_error),
                "eigenvalue_error": full.map(|f| f.eigenvalue_error),
            })
        })
        .collect();
    let encounters: Vec<Value> = sweep
        .encounters
        .iter()
        .map(|e| {
            json!({
                "value": e.value,
                "kind": encounter_name(e.kind),
                "frequency_hz": e.frequency_hz,
                "distance": e.distance,
                "branches": e.branches.map(|b| b + 1),
            })
        })
        .collect();
    let sample: Vec<Value> =
        result.sample.iter().map(|(v, e)| json!({ "value": v, "eigenvalue_error": e })).collect();
    json!({
        "name": result.name,
        "parameter": result.parameter,
        "unit": result.unit,
        "from": result.axis.from,
        "to": result.axis.to,
        "nominal": result.nominal,
        "values": sweep.values.len(),
        "method": method(result.method),
        "branches": branches,
        "critical": critical,
        "encounters": encounters,
        "full_order_sample": sample,
    })
}

pub(super) fn map(result: &MapResult) -> Value {
    let answered = result.points.iter().filter(|p| p.growth_rate.is_finite());
    let largest = result.points.iter().enumerate().filter(|(_, p)| p.growth_rate.is_finite());
    let largest = largest.max_by(|a, b| a.1.growth_rate.total_cmp(&b.1.growth_rate)).map(|(k, p)| {
        let n = result.axes[0].points;
        json!({
            "at": [result.axes[0].value(k % n), result.axes[1].value(k / n)],
            "growth_rate": p.growth_rate,
            "frequency_hz": p.frequency_hz,
            "unstable": p.unstable,
        })
    });
    let sample: Vec<Value> =
        result.sample.iter().map(|(at, e)| json!({ "at": at, "eigenvalue_error": e })).collect();
    json!({
        "name": result.name,
        "parameters": result.parameters,
        "units": result.units,
        "from": result.axes.map(|a| a.from),
        "to": result.axes.map(|a| a.to),
        "points": result.axes.map(|a| a.points),
        "nominal": result.nominal,
        "method": method(result.method),
        "answered": answered.clone().count(),
        "unstable_points": answered.filter(|p| p.unstable > 0).count(),
        "largest": largest,
        "boundary": result.boundary.lines.iter()
            .map(|line| line.iter().map(|p| result.boundary.points[*p]).collect::<Vec<_>>())
            .collect::<Vec<_>>(),
        "full_order_sample": sample,
    })
}

pub(super) fn damping(verdicts: &DampingVerdicts) -> Value {
    let rows: Vec<Value> = verdicts
        .rows
        .iter()
        .map(|row| {
            json!({
                "frequency_hz": row.eigenvalue.im / TAU,
                "growth_rate": row.eigenvalue.re,
                "unstable": unstable(row.eigenvalue),
                "critical_ratio": row.critical_ratio,
            })
        })
        .collect();
    json!({
        "modal_ratio": verdicts.ratio,
        "range": verdicts.range,
        "decided_by_damping": verdicts.decided().count(),
        "modes": rows,
    })
}
