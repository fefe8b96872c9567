//! `summary.json`: the figures of a run, a contract that scripts may rely on.
//!
//! Keys are snake_case and name the unit where it is not plain SI or obvious (`growth_rate` σ is in 1/s). The
//! structs below *are* the contract, field by field; a change that could break a reader raises [`SCHEMA_VERSION`].
//! A number that is not finite is written as `null`, so that the file is valid JSON whatever the run produced.

use super::record::InputFile;
use super::{
    ComplexResult, MeasuredComparison, ModelSize, NamedModes, RunResults, SensitivityResult, SteadyResult,
    explored_json, transient_json, write_result,
};
use crate::error::Result;
use crate::linalg::c64;
use crate::stability::{Certificate, Confirmation, Verdict};
use serde::Serialize;
use std::f64::consts::TAU;
use std::path::Path;

/// The version of the layout of `summary.json`.
pub const SCHEMA_VERSION: u32 = 1;

#[derive(Serialize)]
struct Summary<'a> {
    schema_version: u32,
    program: &'static str,
    program_version: &'static str,
    /// Whether every analysis that was asked for is there.
    complete: bool,
    /// Why not: what the analysis that failed says.
    failed: Option<&'a str>,
    title: &'a str,
    assumptions: &'a [String],
    warnings: &'a [String],
    /// The files that the case reads.
    inputs: &'a [InputFile],
    model: Model,
    mode_sets: Vec<ModeSet<'a>>,
    modes: Vec<Mode<'a>>,
    measured: Vec<Measured<'a>>,
    comparison: serde_json::Value,
    steady_sliding: Option<Steady<'a>>,
    cea: Option<Cea<'a>>,
    sensitivity: Option<Sensitivity<'a>>,
    transient: Option<serde_json::Value>,
    frf: Vec<serde_json::Value>,
    calibration: Option<serde_json::Value>,
    sweeps: Vec<serde_json::Value>,
    maps: Vec<serde_json::Value>,
    damping_verdicts: Option<serde_json::Value>,
    timings: Vec<Timing<'a>>,
    case: serde_json::Value,
}

#[derive(Serialize)]
struct Model {
    nodes: usize,
    elements: usize,
    dofs: usize,
    stiffness_nonzeros: usize,
    contact_points: usize,
}

#[derive(Serialize)]
struct ModeSet<'a> {
    name: &'a str,
    modes: usize,
    rigid_bodies: usize,
    total_mass_kg: f64,
    certificate: Sturm,
}

#[derive(Serialize)]
struct Sturm {
    below_hz: f64,
    shifts_hz: [f64; 2],
    counted: [usize; 2],
    found: usize,
    holds: bool,
}

#[derive(Serialize)]
struct Mode<'a> {
    set: &'a str,
    /// Counts from 1 within its set.
    number: usize,
    frequency_hz: f64,
    moving_part: Option<&'a str>,
    nodal_diameters: Option<usize>,
    nodal_circles: Option<usize>,
    effective_mass_kg: Option<[f64; 3]>,
    backward_error: f64,
}

#[derive(Serialize)]
struct Measured<'a> {
    set: Option<&'a str>,
    source: &'a str,
    frequency_scale: f64,
    rows: Vec<MeasuredRow>,
}

#[derive(Serialize)]
struct MeasuredRow {
    measured_hz: f64,
    /// Number of the paired mode in its set, from 1.
    mode: Option<usize>,
    /// Its frequency times the frequency scale.
    computed_hz: Option<f64>,
    difference_percent: Option<f64>,
}

#[derive(Serialize)]
struct Steady<'a> {
    iterations: usize,
    residual: f64,
    pairs: Vec<Pair<'a>>,
}

#[derive(Serialize)]
struct Pair<'a> {
    name: &'a str,
    load_n: f64,
    sliding_velocity_m_per_s: f64,
    approach_m: Option<f64>,
    normal_force_n: f64,
    friction_force_n: [f64; 2],
    points_closed: usize,
    points_open: usize,
    largest_penetration_m: Option<f64>,
}

#[derive(Serialize)]
struct Cea<'a> {
    band_hz: [f64; 2],
    unstable: usize,
    undecided: usize,
    not_accurate: usize,
    subspace_dimension: usize,
    refinements: usize,
    eigenvalues: Vec<Eigenvalue<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    certificate: Option<Count>,
    #[serde(skip_serializing_if = "Option::is_none")]
    second_method: Option<SecondMethod>,
    measured_squeal: Vec<Squeal<'a>>,
}

/// How many eigenvalues grow, counted; a band from zero holds the conjugates too.
#[derive(Serialize)]
struct Count {
    holds: bool,
    band_hz: [f64; 2],
    growth_rate: [f64; 2],
    unstable_counted: i64,
    unstable_found: i64,
    margin: f64,
    tightest_hz: f64,
    points: usize,
    structure_poles: usize,
    dissipative: bool,
    nothing_faster: bool,
    proven: bool,
    close_calls: Vec<NearContour>,
}

/// A mode near the contour of the count.
#[derive(Serialize)]
struct NearContour {
    frequency_hz: f64,
    growth_rate: f64,
    distance: f64,
    inside: bool,
}

/// What two-level Arnoldi on the full order says.
#[derive(Serialize)]
struct SecondMethod {
    holds: bool,
    shifts: usize,
    confirmed: usize,
    largest_difference: f64,
    condition: f64,
    missed_hz: Vec<f64>,
    unconfirmed_hz: Vec<f64>,
}

#[derive(Serialize)]
struct Eigenvalue<'a> {
    number: usize,
    frequency_hz: f64,
    growth_rate: f64,
    damping_ratio: f64,
    verdict: &'static str,
    unstable: bool,
    undecided: bool,
    backward_error: f64,
    eigenvalue_error: f64,
    condition: f64,
    growth_budget: Budget,
    participation: Option<&'a str>,
}

/// The terms of the growth rate \[1/s\].
#[derive(Serialize)]
struct Budget {
    structural_damping: f64,
    falling_friction: f64,
    transverse_friction: f64,
    mode_coupling: f64,
}

#[derive(Serialize)]
struct Squeal<'a> {
    frequency_hz: f64,
    source: &'a str,
}

#[derive(Serialize)]
struct Sensitivity<'a> {
    modes: Vec<SensitiveMode<'a>>,
    left_out: Vec<LeftOut<'a>>,
}

#[derive(Serialize)]
struct SensitiveMode<'a> {
    /// Number of the complex mode, from 1.
    mode: usize,
    frequency_hz: f64,
    growth_rate: f64,
    /// The scalar that moves the growth rate most by 1 % of itself first.
    parameters: Vec<Rate<'a>>,
    best: Vec<Best<'a>>,
}

/// Per SI unit of the scalar, and per 1 % of its value.
#[derive(Serialize)]
struct Rate<'a> {
    path: &'a str,
    value: f64,
    unit: &'a str,
    dsigma_dp: f64,
    dfrequency_dp: f64,
    growth_per_percent: f64,
    frequency_per_percent: f64,
    /// Estimated |error| of dλ/dp \[1/s per unit\].
    error: f64,
    kink: bool,
}

/// A thing mounted where it lowers the growth rate most.
#[derive(Serialize)]
struct Best<'a> {
    kind: &'a str,
    amount: f64,
    unit: &'a str,
    /// Index of the node, from 0.
    node: usize,
    position_m: [f64; 3],
    direction: Option<[f64; 3]>,
    predicted: Change,
    done: Option<Change>,
    slope_error: Option<f64>,
}

#[derive(Serialize)]
struct Change {
    growth_rate: f64,
    frequency_hz: f64,
}

#[derive(Serialize)]
struct LeftOut<'a> {
    path: &'a str,
    reason: &'a str,
}

#[derive(Serialize)]
struct Timing<'a> {
    phase: &'a str,
    wall_s: f64,
}

/// Writes `summary.json` into the folder `dir`, whole or not at all.
///
/// # Errors
/// [`crate::error::Error::Io`] when the folder cannot be made or the file not be written.
pub fn write_summary(dir: &Path, results: &RunResults) -> Result<()> {
    let text = format!("{:#}\n", summary_json(results));
    write_result(dir, "summary.json", text.as_bytes())
}

/// What `summary.json` holds.
pub fn summary_json(results: &RunResults) -> serde_json::Value {
    serde_json::to_value(summary(results)).expect("strings, numbers and lists only")
}

fn summary(results: &RunResults) -> Summary<'_> {
    let ModelSize { nodes, elements, dofs, nonzeros, contact_points } = results.size;
    Summary {
        schema_version: SCHEMA_VERSION,
        program: env!("CARGO_PKG_NAME"),
        program_version: env!("CARGO_PKG_VERSION"),
        complete: results.failed.is_none(),
        failed: results.failed.as_deref(),
        title: &results.title,
        assumptions: &results.assumptions,
        warnings: &results.warnings,
        inputs: &results.inputs,
        model: Model { nodes, elements, dofs, stiffness_nonzeros: nonzeros, contact_points },
        mode_sets: results.modes.iter().map(mode_set).collect(),
        modes: results.modes.iter().flat_map(modes).collect(),
        measured: results.measured.iter().map(|m| measured(m, &results.modes)).collect(),
        comparison: super::comparison::summary(results),
        steady_sliding: results.steady.as_ref().map(steady),
        cea: results.complex.as_ref().map(cea),
        sensitivity: results.sensitivity.as_ref().map(sensitivity),
        transient: results.transient.as_ref().map(transient_json::transient),
        frf: results.frfs.iter().map(super::frf::summary).collect(),
        calibration: results.calibration.as_ref().map(super::calibration_json::summary),
        sweeps: results.sweeps.iter().map(explored_json::sweep).collect(),
        maps: results.maps.iter().map(explored_json::map).collect(),
        damping_verdicts: results.damping.as_ref().map(explored_json::damping),
        timings: results.timings.iter().map(|(phase, wall_s)| Timing { phase, wall_s: *wall_s }).collect(),
        case: case_object(&results.resolved_case),
    }
}

/// The resolved case as a JSON object; `null` where it is not TOML (its text is in `results.h5` all the same).
fn case_object(toml_text: &str) -> serde_json::Value {
    let table: Option<toml::Table> = toml_text.parse().ok();
    table.and_then(|table| serde_json::to_value(table).ok()).unwrap_or_default()
}

fn mode_set(set: &NamedModes) -> ModeSet<'_> {
    let c = &set.modes.certificate;
    ModeSet {
        name: &set.name,
        modes: set.modes.len(),
        rigid_bodies: set.modes.rigid_bodies,
        total_mass_kg: set.total_mass,
        certificate: Sturm {
            below_hz: c.below_hz,
            shifts_hz: c.shifts_hz,
            counted: c.counted,
            found: c.found,
            holds: c.holds(),
        },
    }
}

fn modes(set: &NamedModes) -> impl Iterator<Item = Mode<'_>> {
    (0..set.modes.len()).map(|k| {
        let name = set.names.get(k).copied().flatten();
        Mode {
            set: &set.name,
            number: k + 1,
            frequency_hz: set.modes.frequency_hz(k),
            moving_part: set.moving_part.get(k).and_then(Option::as_deref),
            nodal_diameters: name.map(|n| n.nodal_diameters),
            nodal_circles: name.map(|n| n.nodal_circles),
            effective_mass_kg: set.effective_mass.get(k).copied(),
            backward_error: set.modes.backward_errors[k],
        }
    })
}

fn measured<'a>(comparison: &'a MeasuredComparison, sets: &'a [NamedModes]) -> Measured<'a> {
    let set = sets.get(comparison.modes);
    let rows = comparison.compare(sets).into_iter().map(|row| MeasuredRow {
        measured_hz: row.measured_hz,
        mode: row.mode.map(|k| k + 1),
        computed_hz: row.computed_hz,
        difference_percent: row.difference_percent(),
    });
    Measured {
        set: set.map(|s| s.name.as_str()),
        source: &comparison.source,
        frequency_scale: comparison.frequency_scale,
        rows: rows.collect(),
    }
}

fn steady(result: &SteadyResult) -> Steady<'_> {
    let pairs = result.totals().into_iter().map(|t| Pair {
        name: t.name,
        load_n: t.load,
        sliding_velocity_m_per_s: t.sliding_velocity,
        approach_m: t.approach,
        normal_force_n: t.normal_force,
        friction_force_n: t.friction_force,
        points_closed: t.closed,
        points_open: t.open,
        largest_penetration_m: t.largest_penetration,
    });
    Steady { iterations: result.state.iterations, residual: result.state.residual, pairs: pairs.collect() }
}

fn cea(result: &ComplexResult) -> Cea<'_> {
    let eigenvalues = result.modes.modes.iter().enumerate().map(|(k, mode)| Eigenvalue {
        number: k + 1,
        frequency_hz: mode.frequency_hz(),
        growth_rate: mode.growth_rate(),
        damping_ratio: mode.damping_ratio(),
        verdict: mode.verdict().word(),
        unstable: mode.unstable(),
        undecided: mode.verdict() == Verdict::Undecided,
        backward_error: mode.backward_error,
        eigenvalue_error: mode.eigenvalue_error,
        condition: mode.condition,
        growth_budget: Budget {
            structural_damping: mode.growth.structural_damping,
            falling_friction: mode.growth.falling_friction,
            transverse_friction: mode.growth.transverse_friction,
            mode_coupling: mode.growth.mode_coupling,
        },
        participation: result.participation.get(k).map(String::as_str),
    });
    let squeal = result.measured_squeal_hz.iter();
    let count_of = |verdict| result.modes.modes.iter().filter(|m| m.verdict() == verdict).count();
    Cea {
        band_hz: result.band_hz,
        unstable: count_of(Verdict::Unstable),
        undecided: count_of(Verdict::Undecided),
        not_accurate: count_of(Verdict::Inaccurate),
        subspace_dimension: result.modes.subspace_dimension,
        refinements: result.modes.refinements,
        eigenvalues: eigenvalues.collect(),
        certificate: result.certificate.as_ref().map(count),
        second_method: result.confirmation.as_ref().map(second_method),
        measured_squeal: squeal.map(|(hz, source)| Squeal { frequency_hz: *hz, source }).collect(),
    }
}

fn count(certificate: &Certificate) -> Count {
    let near = certificate.close_calls.iter().map(|call| NearContour {
        frequency_hz: call.frequency_hz,
        growth_rate: call.growth_rate,
        distance: call.distance,
        inside: call.inside,
    });
    Count {
        holds: certificate.holds(),
        band_hz: certificate.band_hz,
        growth_rate: certificate.growth,
        unstable_counted: certificate.counted,
        unstable_found: certificate.found,
        margin: certificate.margin,
        tightest_hz: certificate.tightest[0],
        points: certificate.points,
        structure_poles: certificate.structure_poles,
        dissipative: certificate.dissipative,
        nothing_faster: certificate.nothing_faster,
        proven: certificate.proven,
        close_calls: near.collect(),
    }
}

fn second_method(confirmation: &Confirmation) -> SecondMethod {
    let hz = |all: &[c64]| all.iter().map(|z| z.im / TAU).collect();
    SecondMethod {
        holds: confirmation.holds(),
        shifts: confirmation.shifts,
        confirmed: confirmation.confirmed,
        largest_difference: confirmation.largest_difference,
        condition: confirmation.condition,
        missed_hz: hz(&confirmation.missed),
        unconfirmed_hz: hz(&confirmation.unconfirmed),
    }
}

fn sensitivity(result: &SensitivityResult) -> Sensitivity<'_> {
    let hz = |omega: f64| omega / std::f64::consts::TAU;
    let change = |d: c64| Change { growth_rate: d.re, frequency_hz: hz(d.im) };
    let modes = result.modes.iter().map(|mode| SensitiveMode {
        mode: mode.mode + 1,
        frequency_hz: hz(mode.eigenvalue.im),
        growth_rate: mode.eigenvalue.re,
        parameters: mode
            .parameters
            .iter()
            .map(|p| Rate {
                path: &p.path,
                value: p.value,
                unit: &p.unit,
                dsigma_dp: p.rate.re,
                dfrequency_dp: p.frequency_rate(),
                growth_per_percent: p.growth_per_percent(),
                frequency_per_percent: p.frequency_per_percent(),
                error: p.error,
                kink: p.kink,
            })
            .collect(),
        best: mode
            .best
            .iter()
            .map(|b| Best {
                kind: b.kind,
                amount: b.amount,
                unit: b.unit,
                node: b.node,
                position_m: b.position,
                direction: b.direction,
                predicted: change(b.predicted),
                done: b.done.map(change),
                slope_error: b.slope_error,
            })
            .collect(),
    });
    let left_out = result.left_out.iter().map(|(path, reason)| LeftOut { path, reason });
    Sensitivity { modes: modes.collect(), left_out: left_out.collect() }
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;
    use serde_json::Value;

    fn written(results: &RunResults) -> Value {
        let dir = tempfile::tempdir().unwrap();
        write_summary(dir.path(), results).unwrap();
        serde_json::from_slice(&std::fs::read(dir.path().join("summary.json")).unwrap()).unwrap()
    }

    #[test]
    fn the_contract_holds() {
        let results = sample::rig();
        let json = written(&results);
        assert_eq!(json["schema_version"], SCHEMA_VERSION);
        assert_eq!(json["program_version"], env!("CARGO_PKG_VERSION"));
        assert_eq!(json["modes"][0]["frequency_hz"], results.modes[0].modes.frequency_hz(0));
        assert_eq!(json["modes"][0]["nodal_diameters"], 1);
        assert_eq!(json["mode_sets"][0]["certificate"]["holds"], true);
        let complex = results.complex.as_ref().unwrap();
        let last = complex.modes.modes.len() - 1;
        assert_eq!(json["cea"]["eigenvalues"][last]["growth_rate"], complex.modes.modes[last].growth_rate());
        let unstable =
            json["cea"]["eigenvalues"].as_array().unwrap().iter().filter(|e| e["unstable"] == true);
        assert_eq!(unstable.count(), json["cea"]["unstable"].as_u64().unwrap() as usize);
        // The pairs' forces are the sums over their points: the sample is made to carry 20 N at μ = 0.4.
        let pair = &json["steady_sliding"]["pairs"][0];
        assert!((pair["normal_force_n"].as_f64().unwrap() - 20.0).abs() < 1e-12);
        assert!((pair["friction_force_n"][0].as_f64().unwrap() - 8.0).abs() < 1e-12);
        assert_eq!(json["case"]["contact"]["mu"], 0.4);
        assert_eq!(json["timings"][1]["phase"], results.timings[1].0.as_str());
    }

    #[test]
    fn scaled_frequencies_are_compared_with_the_measured_ones() {
        let results = sample::rig();
        let row = &written(&results)["measured"][0]["rows"][1];
        let k = row["mode"].as_u64().unwrap() as usize - 1;
        let computed = results.modes[0].modes.frequency_hz(k) * results.measured[0].frequency_scale;
        assert_eq!(row["computed_hz"], computed);
        let percent = row["difference_percent"].as_f64().unwrap();
        assert!((percent - 100.0 * (computed / 936.0 - 1.0)).abs() < 1e-12);
    }

    #[test]
    fn numbers_that_are_not_finite_and_empty_runs_give_valid_json() {
        let mut results = sample::rig();
        results.modes[0].modes.backward_errors[0] = f64::NAN;
        results.timings[0].1 = f64::INFINITY;
        results.resolved_case = "a = nan\nb = inf".into();
        let json = written(&results);
        assert!(json["modes"][0]["backward_error"].is_null() && json["timings"][0]["wall_s"].is_null());
        assert!(json["case"]["a"].is_null() && json["case"]["b"].is_null());
        let empty = written(&RunResults::default());
        assert!(empty["cea"].is_null() && empty["modes"].as_array().unwrap().is_empty());
    }
}
