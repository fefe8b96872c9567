//! Computes the quantities of a validation case and sets them beside their references.

use super::in_time;
use super::kirchhoff::{PlateMode, ThinPlate, circular_modes};
use super::reference::{Check, Kind, Measure, Reference};
use super::two_dof::TwoDof;
use crate::case::{Case, ModelChoice, TransientAnalysis};
use crate::error::{Error, Fault, Result};
use crate::job::{Histories, Prepared, Selection, Stage, analyse};
use crate::linalg::c64;
use crate::progress::Observer;
use crate::results::{CheckedCase, NamedModes, RunResults};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::time::Instant;

/// Computes every quantity of `reference`.
///
/// # Errors
/// A case that cannot be analysed, or a quantity that the case does not have.
pub fn run(reference: &Reference, observer: &dyn Observer) -> Result<CheckedCase> {
    let started = Instant::now();
    let Reference { name, title, source, cases, checks } = reference;
    let computed = computed(cases, checks, observer)?;
    let rows = checks.iter().zip(computed).map(|(check, computed)| check.beside(computed)).collect();
    let seconds = started.elapsed().as_secs_f64();
    Ok(CheckedCase { name: name.clone(), title: title.clone(), source: source.clone(), rows, seconds })
}

/// The quantity of every check; the analyses of a case are done once for all that ask for them.
///
/// # Errors
/// As [`run`].
///
/// # Panics
/// When the case of a check is not among the `cases`.
pub fn computed(
    cases: &BTreeMap<String, Case>,
    checks: &[Check],
    observer: &dyn Observer,
) -> Result<Vec<f64>> {
    let mut runs: BTreeMap<&str, Runs> = BTreeMap::new();
    let mut computed = Vec::new();
    for check in checks {
        let new = || Runs { case: &cases[&check.case], done: BTreeMap::new(), observer };
        computed.push(compute(runs.entry(&check.case).or_insert_with(new), check)?);
    }
    Ok(computed)
}

/// The analyses of one case with scalars set to values, each done once.
struct Runs<'a> {
    case: &'a Case,
    done: BTreeMap<String, Run>,
    observer: &'a dyn Observer,
}

/// What the analyses of a case brought.
pub(super) struct Run {
    pub(super) results: RunResults,
    pub(super) histories: Histories,
}

impl Runs<'_> {
    fn case_with(&self, set: &[(String, f64)]) -> Result<Case> {
        self.case.with_parameters(set.iter().map(|(path, value)| (path, *value)))
    }

    fn with(&mut self, set: &[(String, f64)]) -> Result<&RunResults> {
        Ok(&self.run(set)?.results)
    }

    fn run(&mut self, set: &[(String, f64)]) -> Result<&Run> {
        self.run_as(set, None)
    }

    /// With the motion in time of a model of this kind instead of the case's own.
    fn run_as(&mut self, set: &[(String, f64)], model: Option<ModelChoice>) -> Result<&Run> {
        let mut key = set.iter().map(|(path, value)| format!("{path}={value:e} ")).collect::<String>();
        key += &model.map_or(String::new(), |model| format!("{model:?}"));
        if !self.done.contains_key(&key) {
            let mut case = self.case_with(set)?;
            if let (Some(model), Some(transient)) = (model, &mut case.transient) {
                *transient = TransientAnalysis { model, compare_steps: None, ..transient.clone() };
            }
            let prepared = Prepared::new(&case)?;
            let mut histories = Histories::default();
            let mut keep = |stage: Stage<'_>| {
                histories.keep(&stage);
                Ok(())
            };
            let results = analyse(&prepared, Selection::ALL, &mut keep, self.observer)?;
            self.done.insert(key.clone(), Run { results, histories });
        }
        Ok(&self.done[&key])
    }
}

/// λ of every complex mode of the run.
fn eigenvalues(results: &RunResults) -> Vec<c64> {
    let complex = results.complex.iter();
    complex.flat_map(|c| c.modes.modes.iter().map(|m| m.eigenvalue)).collect()
}

/// λ of the unstable mode nearest to `hz`; not a number when no mode is unstable.
fn unstable_near(results: &RunResults, hz: f64) -> c64 {
    let distance = |l: &c64| (l.im / TAU - hz).abs();
    let unstable = eigenvalues(results).into_iter().filter(|l| l.re > 0.0);
    unstable.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(c64::new(f64::NAN, f64::NAN))
}

/// The largest σ of any mode \[1/s\].
fn growth_rate(results: &RunResults) -> f64 {
    eigenvalues(results).iter().map(|l| l.re).fold(f64::NEG_INFINITY, f64::max)
}

fn largest_growth(results: &RunResults) -> f64 {
    eigenvalues(results).iter().map(|l| l.re / l.norm()).fold(f64::NEG_INFINITY, f64::max)
}

fn compute(runs: &mut Runs, check: &Check) -> Result<f64> {
    match &check.kind {
        Kind::Value(pointer) => {
            let summary = crate::results::summary_json(runs.with(&check.set)?);
            summary.pointer(pointer).and_then(serde_json::Value::as_f64).ok_or_else(|| {
                Error::input(Fault::new(
                    format!("`{}`", check.quantity),
                    format!("no number at {pointer}"),
                    "a JSON pointer into summary.json",
                ))
            })
        }
        Kind::Onset { parameter, between, above } => onset(runs, check, parameter, *between, *above),
        Kind::LargestGrowth { parameter, values } => {
            let mut largest = f64::NEG_INFINITY;
            for value in values {
                let results = runs.with(&set_also(&check.set, parameter, *value))?;
                largest = largest.max(largest_growth(results));
            }
            Ok(largest)
        }
        Kind::Change(to) => {
            let before = eigenvalues(runs.with(&check.set)?);
            let changed: Vec<_> = check.set.iter().chain(to).cloned().collect();
            let after = eigenvalues(runs.with(&changed)?);
            if before.len() != after.len() || before.is_empty() {
                return Ok(f64::INFINITY);
            }
            let change = before.iter().zip(&after).map(|(a, b)| (a - b).norm() / a.norm());
            Ok(change.fold(0.0, f64::max))
        }
        Kind::UnstableNear => Ok(unstable_near(runs.with(&check.set)?, check.reference).im / TAU),
        Kind::GrowthNear(hz) => Ok(unstable_near(runs.with(&check.set)?, *hz).re),
        Kind::Disturbance { growth } => {
            let transient = runs.with(&check.set)?.transient.as_ref();
            let compared = transient
                .and_then(|t| t.growth.as_ref())
                .ok_or_else(|| missing(check, "transient.disturbance"))?;
            let (sigma, omega) = (compared.eigenvalue.re, compared.eigenvalue.im);
            Ok(compared.found.map_or(f64::NAN, |found| match growth {
                true => (found.rate / sigma - 1.0).abs(),
                false => (TAU * found.frequency_hz / omega - 1.0).abs(),
            }))
        }
        Kind::GrowthRate => Ok(growth_rate(runs.with(&check.set)?)),
        Kind::InTime { of: span, measure, over_full } => {
            let mut measured = |model: Option<ModelChoice>| {
                let found = in_time::measured(runs.run_as(&check.set, model)?, span, measure);
                found.ok_or_else(|| missing(check, &span.channel))
            };
            let own = measured(None)?;
            Ok(if *over_full { own / measured(Some(ModelChoice::Full))? } else { own })
        }
        Kind::Rises { parameter, values, of } => {
            let mut levels = Vec::new();
            for value in values {
                let run = runs.run(&set_also(&check.set, parameter, *value))?;
                levels.push(match of {
                    None => growth_rate(&run.results),
                    Some(span) => in_time::measured(run, span, &Measure::Amplitude)
                        .ok_or_else(|| missing(check, &span.channel))?,
                });
            }
            Ok(levels.windows(2).filter(|pair| pair[1] > pair[0]).count() as f64)
        }
        Kind::PaperEquations(span) => {
            let case = runs.case_with(&check.set)?;
            let model = TwoDof::of(&case).ok_or_else(|| missing(check, "belt"))?;
            let found = in_time::deviation(runs.run(&check.set)?, span, &model);
            found.ok_or_else(|| missing(check, &span.channel))
        }
        Kind::RoundPlate { modes, part, outer, inner } => {
            let case = runs.case;
            let shell = case.shell.get(part).ok_or_else(|| missing(check, part))?;
            let below = case.modes.get(modes).and_then(|m| m.below).ok_or_else(|| missing(check, modes))?;
            let results = runs.with(&check.set)?;
            let computed =
                results.modes.iter().find(|m| &m.name == modes).ok_or_else(|| missing(check, modes))?;
            let material = &case.material[&shell.material];
            let plate = ThinPlate {
                youngs_modulus: material.youngs_modulus,
                poissons_ratio: material.poissons_ratio,
                density: material.density,
                thickness: shell.thickness,
            };
            let exact = circular_modes(&plate, outer.0, outer.1, *inner, below);
            Ok(largest_error(computed, &exact))
        }
    }
}

/// The largest relative error of the computed modes that are no motions of a rigid body; infinite when their number is
/// another. Every exact mode with nodal diameters stands for two.
fn largest_error(computed: &NamedModes, exact: &[PlateMode]) -> f64 {
    let exact = exact.iter().flat_map(|mode| {
        let twins = if mode.nodal_diameters > 0 { 2 } else { 1 };
        std::iter::repeat_n(mode.frequency_hz, twins)
    });
    let exact: Vec<f64> = exact.collect();
    let rigid = computed.modes.rigid_bodies;
    if computed.modes.len() - rigid != exact.len() {
        return f64::INFINITY;
    }
    let error = |(k, f): (usize, &f64)| (computed.modes.frequency_hz(rigid + k) / f - 1.0).abs();
    exact.iter().enumerate().map(error).fold(0.0, f64::max)
}

fn missing(check: &Check, name: &str) -> Error {
    Error::input(Fault::new(format!("`{}`", check.quantity), format!("\"{name}\""), "a name of the case"))
}

fn set_also(set: &[(String, f64)], parameter: &str, value: f64) -> Vec<(String, f64)> {
    let mut set = set.to_vec();
    set.push((parameter.to_string(), value));
    set
}

/// Bisects until the bracket is at round-off. A mode counts as unstable when σ > `above` |λ|. Past the onset of flutter
/// without damping σ grows like the square root of the distance, so that 1e-6 is reached within 1e-12 of it; with damping
/// it grows like the distance, and the threshold must be as small as the error that is wanted.
fn onset(runs: &mut Runs, check: &Check, parameter: &str, between: [f64; 2], above: f64) -> Result<f64> {
    let mut unstable = |value: f64| -> Result<bool> {
        Ok(largest_growth(runs.with(&set_also(&check.set, parameter, value))?) > above)
    };
    let [mut a, mut b] = between;
    let at_a = unstable(a)?;
    if unstable(b)? == at_a {
        return Ok(f64::NAN);
    }
    while (b - a).abs() > 1e-13 * a.abs().max(b.abs()) {
        let middle = 0.5 * (a + b);
        if middle == a || middle == b {
            break;
        }
        if unstable(middle)? == at_a { a = middle } else { b = middle }
    }
    Ok(0.5 * (a + b))
}
