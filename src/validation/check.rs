//! Computes the quantities of a validation case and sets them beside their references.

use super::in_time;
use super::kirchhoff::{Edge, PlateMode, ThinPlate, circular_modes};
use super::reference::{Check, CheckQuantity, Measure, QuantityKind, Reference};
use super::resumed;
use super::run::CaseRun;
use super::two_dof::TwoDof;
use crate::case::{Case, ModelChoice, TransientAnalysis, read_case};
use crate::error::{Error, Fault, Result};
use crate::job::{ContactAs, Histories, Prepared, ResultStage, Selection, analyse, export};
use crate::linalg::c64;
use crate::progress::Observer;
use crate::results::{CheckedCase, ComplexResult, NamedModes, RunResults, TransientResult};
use serde_json::Value;
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
    let mut runs = BTreeMap::new();
    let mut rows = Vec::new();
    for check in checks {
        let mut row = check.beside(quantity(&mut runs, cases, check, &check.of, observer)?);
        if let Some(second) = &check.second {
            row.reference = quantity(&mut runs, cases, check, second, observer)?;
        }
        rows.push(row);
    }
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
    let mut runs = BTreeMap::new();
    checks.iter().map(|check| quantity(&mut runs, cases, check, &check.of, observer)).collect()
}

/// A quantity of a check; the `runs` of its case are used where they are.
fn quantity<'a>(
    runs: &mut BTreeMap<&'a str, Runs<'a>>,
    cases: &'a BTreeMap<String, Case>,
    check: &Check,
    of: &'a CheckQuantity,
    observer: &'a dyn Observer,
) -> Result<f64> {
    let new = || Runs { case: &cases[&of.case], done: BTreeMap::new(), observer };
    compute(runs.entry(&of.case).or_insert_with(new), of, &check.quantity)
}

/// The analyses of one case with scalars set to values, each done once.
struct Runs<'a> {
    case: &'a Case,
    done: BTreeMap<String, CaseRun>,
    observer: &'a dyn Observer,
}

impl Runs<'_> {
    fn case_with(&self, set: &[(String, f64)]) -> Result<Case> {
        self.case.with_parameters(set.iter().map(|(path, value)| (path, *value)))
    }

    fn with(&mut self, set: &[(String, f64)]) -> Result<&RunResults> {
        Ok(&self.run(set)?.results)
    }

    fn run(&mut self, set: &[(String, f64)]) -> Result<&CaseRun> {
        self.run_as(set, None)
    }

    /// With the motion in time of a model of this kind instead of the case's own.
    fn run_as(&mut self, set: &[(String, f64)], model: Option<ModelChoice>) -> Result<&CaseRun> {
        let mut key = set.iter().map(|(path, value)| format!("{path}={value:e} ")).collect::<String>();
        key += &model.map_or(String::new(), |model| format!("{model:?}"));
        if !self.done.contains_key(&key) {
            let mut case = self.case_with(set)?;
            if let (Some(model), Some(transient)) = (model, &mut case.transient) {
                *transient =
                    TransientAnalysis { model: Some(model), compare_steps: None, ..transient.clone() };
            }
            let prepared = Prepared::new(&case)?;
            let mut histories = Histories::default();
            let mut keep = |stage: ResultStage<'_>| {
                histories.keep(&stage);
                Ok(())
            };
            let results = analyse(&prepared, Selection::Listed, &mut keep, self.observer)?;
            self.done.insert(key.clone(), CaseRun { results, histories });
        }
        Ok(&self.done[&key])
    }
}

/// λ of every complex mode of the run.
fn eigenvalues(results: &RunResults) -> Vec<c64> {
    let complex = results.get::<ComplexResult>().into_iter();
    complex.flat_map(|c| c.modes.modes.iter().map(|m| m.eigenvalue)).collect()
}

/// λ of the unstable mode nearest to `hz`; not a number when no mode is unstable.
fn unstable_near(results: &RunResults, hz: f64) -> c64 {
    let distance = |l: &c64| (l.im / TAU - hz).abs();
    let modes = results.get::<ComplexResult>().into_iter().flat_map(|c| &c.modes.modes);
    let unstable = modes.filter(|mode| mode.unstable()).map(|mode| mode.eigenvalue);
    unstable.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(c64::new(f64::NAN, f64::NAN))
}

/// The largest σ of any mode \[1/s\].
fn growth_rate(results: &RunResults) -> f64 {
    eigenvalues(results).iter().map(|l| l.re).fold(f64::NEG_INFINITY, f64::max)
}

fn largest_growth(results: &RunResults) -> f64 {
    eigenvalues(results).iter().map(|l| l.re / l.norm()).fold(f64::NEG_INFINITY, f64::max)
}

/// The number at a JSON pointer into the summary of a run.
fn number_at(results: &RunResults, pointer: &str, name: &str) -> Result<f64> {
    let summary = crate::results::summary_json(results);
    let number = match summary.pointer(pointer) {
        Some(Value::Bool(holds)) => Some(f64::from(u8::from(*holds))),
        Some(Value::Array(list)) => Some(list.len() as f64),
        other => other.and_then(Value::as_f64),
    };
    number.ok_or_else(|| {
        let found = format!("no number at {pointer}");
        Error::input(Fault::new(format!("`{name}`"), found, "a JSON pointer into summary.json"))
    })
}

/// The largest relative change of any eigenvalue; infinite where their number changes.
fn change(before: &[c64], after: &[c64]) -> f64 {
    if before.len() != after.len() || before.is_empty() {
        return f64::INFINITY;
    }
    before.iter().zip(after).map(|(a, b)| (a - b).norm() / a.norm()).fold(0.0, f64::max)
}

/// A quantity of the check `name`.
fn compute(runs: &mut Runs, CheckQuantity { kind, set, .. }: &CheckQuantity, name: &str) -> Result<f64> {
    let missing = |found: &str| {
        Error::input(Fault::new(format!("`{name}`"), format!("\"{found}\""), "a name of the case"))
    };
    match kind {
        QuantityKind::Value(pointer) => number_at(runs.with(set)?, pointer, name),
        QuantityKind::Slope { pointer, parameter, step } => {
            let own = runs.case_with(set)?.parameter(parameter)?.value;
            let mut at = |steps: f64| {
                number_at(runs.with(&set_also(set, parameter, own + steps * step))?, pointer, name)
            };
            Ok((8.0 * (at(1.0)? - at(-1.0)?) - (at(2.0)? - at(-2.0)?)) / (12.0 * step))
        }
        QuantityKind::Exported => exported(runs, set),
        QuantityKind::Resumed => resumed::differences(&runs.case_with(set)?, runs.observer),
        QuantityKind::Faults(file) => count_faults(runs, file),
        QuantityKind::Onset { parameter, between, above } => onset(runs, set, parameter, *between, *above),
        QuantityKind::LargestGrowth { parameter, values } => {
            let mut largest = f64::NEG_INFINITY;
            for value in values {
                let results = runs.with(&set_also(set, parameter, *value))?;
                largest = largest.max(largest_growth(results));
            }
            Ok(largest)
        }
        QuantityKind::Change(to) => {
            let before = eigenvalues(runs.with(set)?);
            let changed: Vec<_> = set.iter().chain(to).cloned().collect();
            Ok(change(&before, &eigenvalues(runs.with(&changed)?)))
        }
        QuantityKind::UnstableNear(hz) => Ok(unstable_near(runs.with(set)?, *hz).im / TAU),
        QuantityKind::GrowthNear(hz) => Ok(unstable_near(runs.with(set)?, *hz).re),
        QuantityKind::Disturbance { growth } => {
            let transient = runs.with(set)?.get::<TransientResult>();
            let compared =
                transient.and_then(|t| t.growth.as_ref()).ok_or_else(|| missing("transient.disturbance"))?;
            let (sigma, omega) = (compared.eigenvalue.re, compared.eigenvalue.im);
            Ok(compared.found.map_or(f64::NAN, |found| match growth {
                true => (found.rate / sigma - 1.0).abs(),
                false => (TAU * found.frequency_hz / omega - 1.0).abs(),
            }))
        }
        QuantityKind::GrowthRate => Ok(growth_rate(runs.with(set)?)),
        QuantityKind::InTime { of: span, measure, over_full } => {
            let mut measured = |model: Option<ModelChoice>| {
                let found = in_time::measured(runs.run_as(set, model)?, span, measure);
                found.ok_or_else(|| missing(&span.channel))
            };
            let own = measured(None)?;
            Ok(if *over_full { own / measured(Some(ModelChoice::Full))? } else { own })
        }
        QuantityKind::Rises { parameter, values, of } => {
            let mut levels = Vec::new();
            for value in values {
                let run = runs.run(&set_also(set, parameter, *value))?;
                levels.push(match of {
                    None => growth_rate(&run.results),
                    Some(span) => in_time::measured(run, span, &Measure::Amplitude)
                        .ok_or_else(|| missing(&span.channel))?,
                });
            }
            Ok(levels.windows(2).filter(|pair| pair[1] > pair[0]).count() as f64)
        }
        QuantityKind::PaperEquations(span) => {
            let case = runs.case_with(set)?;
            let model = TwoDof::of(&case).ok_or_else(|| missing("belt"))?;
            let found = in_time::deviation(runs.run(set)?, span, &model);
            found.ok_or_else(|| missing(&span.channel))
        }
        QuantityKind::RoundPlate { modes, part, outer, inner } => {
            let exact =
                plate_modes(runs.case, (modes, part), (*outer, *inner)).ok_or_else(|| missing(part))?;
            let sets = runs.with(set)?.all::<NamedModes>();
            let computed = sets.into_iter().find(|set| &set.name == modes).ok_or_else(|| missing(modes))?;
            Ok(largest_error(computed, &exact))
        }
    }
}

/// The largest change of an eigenvalue when the case is exported as matrices and read again.
fn exported(runs: &mut Runs, set: &[(String, f64)]) -> Result<f64> {
    let folder = super::scratch::scratch()?;
    export(&runs.case_with(set)?, ContactAs::Points, folder.path())?;
    let again = read_case(&folder.path().join("case.toml"))?;
    let results = analyse(&Prepared::new(&again)?, Selection::Only("cea"), &mut |_| Ok(()), runs.observer)?;
    Ok(change(&eigenvalues(runs.with(set)?), &eigenvalues(&results)))
}

/// How many faults the case in `file` has.
fn count_faults(runs: &Runs, file: &str) -> Result<f64> {
    let run = |case: &Case| {
        analyse(&Prepared::new(case)?, Selection::Listed, &mut |_| Ok(()), runs.observer).map(|_| ())
    };
    match read_case(&runs.case.folder.join(file)).and_then(|case| run(&case)) {
        Ok(()) => Ok(0.0),
        Err(Error::Input(faults)) => Ok(faults.0.len() as f64),
        Err(other) => Err(other),
    }
}

/// The exact modes of a round plate below the highest frequency of a set of real modes.
fn plate_modes(
    case: &Case,
    (modes, part): (&str, &str),
    (outer, inner): ((f64, Edge), Option<(f64, Edge)>),
) -> Option<Vec<PlateMode>> {
    let shell = case.shell.get(part)?;
    let below = case.modes.get(modes)?.below?;
    let material = &case.material[&shell.material];
    let plate = ThinPlate {
        youngs_modulus: material.youngs_modulus,
        poissons_ratio: material.poissons_ratio,
        density: material.density,
        thickness: shell.thickness,
    };
    Some(circular_modes(&plate, outer.0, outer.1, inner, below))
}

/// The largest relative error of the computed modes that are no motions of a rigid body; infinite when their number is
/// another. Every exact mode with nodal diameters counts twice.
fn largest_error(computed: &NamedModes, exact: &[PlateMode]) -> f64 {
    let exact = exact.iter().flat_map(|mode| {
        let multiplicity = if mode.nodal_diameters > 0 { 2 } else { 1 };
        std::iter::repeat_n(mode.frequency_hz, multiplicity)
    });
    let exact: Vec<f64> = exact.collect();
    let rigid = computed.modes.rigid_bodies;
    if computed.modes.len() - rigid != exact.len() {
        return f64::INFINITY;
    }
    let error = |(k, f): (usize, &f64)| (computed.modes.frequency_hz(rigid + k) / f - 1.0).abs();
    exact.iter().enumerate().map(error).fold(0.0, f64::max)
}

fn set_also(set: &[(String, f64)], parameter: &str, value: f64) -> Vec<(String, f64)> {
    let mut set = set.to_vec();
    set.push((parameter.to_string(), value));
    set
}

/// Bisects until the bracket is at round-off. A mode counts as unstable when σ > `above` |λ|. Past the onset of flutter
/// without damping σ grows like the square root of the distance, so that 1e-6 is reached within 1e-12 of it; with damping
/// it grows like the distance, and the threshold must be as small as the error that is wanted.
fn onset(
    runs: &mut Runs,
    set: &[(String, f64)],
    parameter: &str,
    between: [f64; 2],
    above: f64,
) -> Result<f64> {
    let mut unstable = |value: f64| -> Result<bool> {
        Ok(largest_growth(runs.with(&set_also(set, parameter, value))?) > above)
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
