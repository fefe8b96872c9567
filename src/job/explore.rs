//! The sweeps and maps of a case, and what its damping decides.

use super::modes::add_modal_damping;
use super::prepared::Prepared;
use super::sink::{KnownMap, KnownMaps, ResultStage};
use super::states::{OnFamily, States, Whole, keeps_the_structure};
use crate::case::{Case, Invalidates, MapAnalysis, SweepAnalysis};
use crate::equilibrium::{Condensed, SteadySliding, tangent_stiffness};
use crate::error::Result;
use crate::linalg::c64;
use crate::linalg::sparse::times;
use crate::modal::RealModes;
use crate::progress::Observer;
use crate::results::{DampingRow, DampingVerdicts, MapResult, RunResults, SweepMethod, SweepResult};
use crate::stability::{Family, FamilyFrame, SlidingState};
use crate::sweep::{self, Axis, Boundary, Checked, CriticalKind, MapPoint, SweepProblem};
use crate::system::{Damping, System};
use faer::Mat;

/// The largest |Δλ|/|λ| at full order that is accepted.
const ACCURACY: f64 = 1e-8;
/// Relative length of the bracket of a critical value on a reduced model, and by whole analyses.
const LOCATED: [f64; 2] = [1e-10, 1e-7];
/// Full-order measures that were not good enough lead to a richer family, so often at most.
const REFINEMENTS: usize = 3;
/// The path of ζ.
const RATIO: &str = "damping.modal_ratio";

/// The case at its own values: what every sweep starts from.
pub(super) struct Nominal<'a> {
    pub(super) prepared: &'a Prepared<'a>,
    /// With the modal damping.
    pub(super) system: &'a System,
    pub(super) steady: &'a SteadySliding,
    pub(super) real: &'a RealModes,
}

/// Runs every sweep and map of the case and hands each on when it is there.
pub(super) fn explore(
    nominal: &Nominal,
    known: &KnownMaps,
    results: &mut RunResults,
    record: &mut dyn FnMut(ResultStage) -> Result<()>,
    observer: &dyn Observer,
) -> Result<()> {
    let prepared = nominal.prepared;
    let case = prepared.case.without_sweeps();
    let Some(cea) = &case.cea else { return Ok(()) };
    let dampings = dampings(prepared.case, &case)?;
    let others =
        dampings.iter().map(|d| other_damping(nominal, &case, d)).collect::<Result<Vec<Damping>>>()?;
    let k = tangent_stiffness(nominal.system, &nominal.steady.displacement)?;
    let condensed = Condensed::new(nominal.system, &k)?;
    let displacement = &nominal.steady.displacement;
    let frame =
        FamilyFrame::new(nominal.system, displacement, nominal.real, others.iter().collect(), cea.band)?;
    let reference = times(&nominal.system.structure.mass, nominal.real.shapes.as_ref());
    let explorer = Explorer { nominal, case: &case, condensed, frame, dampings, reference, observer };
    for (name, analysis) in &prepared.case.sweep {
        let result = explorer.sweep(name, analysis)?;
        record(ResultStage::Found(&result))?;
        results.records.push(result);
    }
    for (name, analysis) in &prepared.case.map {
        let start = known.get(name).cloned().unwrap_or_default();
        let (result, failure) = explorer.map(name, analysis, start, record)?;
        results.warnings.extend(failure);
        results.records.push(result);
    }
    if let Some(verdicts) = explorer.damping()? {
        record(ResultStage::Found(&verdicts))?;
        results.records.push(verdicts);
    }
    Ok(())
}

/// Every damping scalar that a sweep, a map or the verdicts vary: path, its value, another value that the case accepts.
fn dampings(whole: &Case, case: &Case) -> Result<Vec<(String, f64, f64)>> {
    let sweeps = whole.sweep.values().map(|s| (&s.parameter, [s.from, s.to]));
    let maps = whole.map.values().flat_map(|m| [0, 1].map(|k| (&m.parameters[k], [m.from[k], m.to[k]])));
    let mut found: Vec<(String, f64, f64)> = Vec::new();
    for (path, ends) in sweeps.chain(maps) {
        let parameter = case.parameter(path)?;
        let known = found.iter().any(|(other, ..)| other == path);
        if parameter.invalidates == Invalidates::Damping && keeps_the_structure(case, path)? && !known {
            let other = if ends[0] == parameter.value { ends[1] } else { ends[0] };
            found.push((path.clone(), parameter.value, other));
        }
    }
    let ratio = case.damping.modal_ratio;
    if ratio > 0.0 && !found.iter().any(|(path, ..)| path == RATIO) {
        found.push((RATIO.into(), ratio, 0.5 * ratio));
    }
    Ok(found)
}

/// The damping of the structure with one scalar at its other value.
fn other_damping(nominal: &Nominal, case: &Case, (path, _, value): &(String, f64, f64)) -> Result<Damping> {
    let case = case.with_parameter(path, *value)?;
    let prepared = Prepared::new(&case)?;
    let mut structure = prepared.system.structure.clone();
    add_modal_damping(&mut structure, nominal.real, &prepared)?;
    Ok(structure.damping)
}

struct Explorer<'a> {
    nominal: &'a Nominal<'a>,
    /// Without its sweeps.
    case: &'a Case,
    condensed: Condensed,
    frame: FamilyFrame<'a>,
    dampings: Vec<(String, f64, f64)>,
    /// M Φ.
    reference: Mat<f64>,
    observer: &'a dyn Observer,
}

impl Explorer<'_> {
    fn states(&self, paths: &[String]) -> States<'_> {
        States {
            prepared: self.nominal.prepared,
            case: self.case,
            paths: paths.to_vec(),
            condensed: &self.condensed,
            nominal: &self.nominal.steady.points,
            dampings: &self.dampings,
        }
    }

    fn keeps_the_structure(&self, paths: &[String]) -> Result<bool> {
        // Sparse skew parts are known at full order only.
        if self.nominal.system.skew().is_some() {
            return Ok(false);
        }
        let each =
            paths.iter().map(|path| keeps_the_structure(self.case, path)).collect::<Result<Vec<bool>>>()?;
        Ok(each.iter().all(|keeps| *keeps))
    }

    /// A family trained on the states at `places`; those without an answer are left out.
    fn family<'s>(&'s self, states: &'s States<'s>, places: &[Vec<f64>]) -> Result<OnFamily<'s, 's>> {
        self.observer.begin("reduced model", Some(places.len() as u64));
        let members: Vec<SlidingState> = places.iter().filter_map(|at| states.at(at).ok()).collect();
        if members.is_empty() {
            // Says what is wrong.
            states.at(&places[0])?;
        }
        let mut family = Family::new(&self.frame, &members)?;
        for member in &members {
            family.train(member)?;
            self.observer.advance(1);
        }
        self.observer.end();
        Ok(OnFamily { states, family })
    }

    fn sweep(&self, name: &str, analysis: &SweepAnalysis) -> Result<SweepResult> {
        let axis = Axis { from: analysis.from, to: analysis.to, points: analysis.points, log: analysis.log };
        let parameter = self.case.parameter(&analysis.parameter)?;
        let paths = [analysis.parameter.clone()];
        let result = |sweep: sweep::Sweep, measured: FullOrderErrors, method: SweepMethod| SweepResult {
            name: name.to_string(),
            parameter: parameter.path.clone(),
            label: parameter.label.clone(),
            unit: parameter.unit.to_string(),
            axis,
            nominal: parameter.value,
            sweep,
            verified: measured.critical,
            sample: measured.sample,
            method,
        };
        if !self.keeps_the_structure(&paths)? {
            let whole = Whole::new(self.case, paths.to_vec(), Some(&self.reference));
            let sweep = sweep::sweep(&whole, &axis, LOCATED[1], self.observer)?;
            let measured = measure(&whole, &sweep, &[axis.to])?;
            return Ok(result(sweep, measured, SweepMethod::Whole));
        }
        let states = self.states(&paths);
        let at = |t: f64| axis.between(axis.from, axis.to, t);
        let places: Vec<Vec<f64>> = [0.0, 1.0, 0.5].map(|t| vec![at(t)]).to_vec();
        let mut on = self.family(&states, &places)?;
        let sample = [0.25, 0.75].map(at);
        let mut refinement = 0;
        loop {
            let sweep = sweep::sweep(&on, &axis, LOCATED[0], self.observer)?;
            let measured = measure(&on, &sweep, &sample)?;
            refinement += 1;
            let poor = measured.poor(&sweep);
            if poor.is_empty() || refinement == REFINEMENTS {
                let dimension = on.family.dimension();
                return Ok(result(sweep, measured, SweepMethod::Reduced(dimension)));
            }
            for value in poor {
                on.family.train(&states.at(&[value])?)?;
            }
        }
    }

    /// A map without points.
    fn empty_map(&self, name: &str, analysis: &MapAnalysis) -> Result<MapResult> {
        let axes = [0, 1].map(|k| Axis {
            from: analysis.from[k],
            to: analysis.to[k],
            points: analysis.points[k],
            log: analysis.log[k],
        });
        let [a, b] = [0, 1].map(|k| self.case.parameter(&analysis.parameters[k]));
        let (a, b) = (a?, b?);
        Ok(MapResult {
            name: name.to_string(),
            parameters: analysis.parameters.clone(),
            labels: [a.label, b.label],
            units: [a.unit.to_string(), b.unit.to_string()],
            axes,
            nominal: [a.value, b.value],
            points: Vec::new(),
            boundary: Boundary::default(),
            sample: Vec::new(),
            method: SweepMethod::Whole,
        })
    }

    /// Measures all modes at the places `inside` and at some of the boundary on the full order; gives the places at which the
    /// reduced model is not good enough.
    fn check_map(&self, on: &OnFamily, result: &mut MapResult, inside: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut places = inside.to_vec();
        let line = &result.boundary.points;
        places.extend((0..line.len().min(4)).map(|k| line[k * line.len() / line.len().min(4)]));
        self.observer.begin("full-order check", Some(places.len() as u64));
        result.sample.clear();
        let mut poor = Vec::new();
        for at in places {
            // A place without an answer has nothing to measure.
            let Ok(checks) = on.check(&at) else { continue };
            let worst = worst_alone(&checks);
            result.sample.push((at, worst));
            if worst > ACCURACY {
                poor.push(at);
            }
            self.observer.advance(1);
        }
        self.observer.end();
        poor
    }

    fn map(
        &self,
        name: &str,
        analysis: &MapAnalysis,
        mut known: KnownMap,
        record: &mut dyn FnMut(ResultStage) -> Result<()>,
    ) -> Result<(MapResult, Option<String>)> {
        let mut result = self.empty_map(name, analysis)?;
        let axes = result.axes;
        let failed = |failure: Option<String>| {
            failure.map(|f| format!("Map `{name}`: points without an answer are left blank; the first: {f}"))
        };
        if !self.keeps_the_structure(&analysis.parameters)? {
            let whole = Whole::new(self.case, analysis.parameters.to_vec(), Some(&self.reference));
            let failure = self.fill(&whole, &mut result, &known, record)?;
            result.boundary = sweep::boundary(&whole, &axes, &result.points, 1e-6, self.observer)?;
            record(ResultStage::Map(&result))?;
            return Ok((result, failed(failure)));
        }
        let states = self.states(&analysis.parameters);
        let place = |u: f64, v: f64| {
            vec![axes[0].between(axes[0].from, axes[0].to, u), axes[1].between(axes[1].from, axes[1].to, v)]
        };
        let corners = [(0.0, 0.0), (1.0, 1.0), (0.0, 1.0), (1.0, 0.0), (0.5, 0.5)];
        let mut on = self.family(&states, &corners.map(|(u, v)| place(u, v)))?;
        let inside = [(0.3, 0.7), (0.75, 0.2)].map(|(u, v)| place(u, v)).map(|p| [p[0], p[1]]);
        for at in &known.trained {
            on.family.train(&states.at(at)?)?;
        }
        let mut refinement = 0;
        loop {
            let failure = self.fill(&on, &mut result, &known, record)?;
            result.boundary = sweep::boundary(&on, &axes, &result.points, 1e-7, self.observer)?;
            result.method = SweepMethod::Reduced(on.family.dimension());
            let poor = self.check_map(&on, &mut result, &inside);
            refinement += 1;
            if poor.is_empty() || refinement == REFINEMENTS {
                record(ResultStage::Map(&result))?;
                return Ok((result, failed(failure)));
            }
            for at in poor {
                on.family.train(&states.at(&at)?)?;
                known.trained.push(at);
            }
            known.points.clear();
        }
    }

    /// The points of the grid that are not known, passed on chunk by chunk.
    fn fill(
        &self,
        problem: &dyn SweepProblem,
        result: &mut MapResult,
        known: &KnownMap,
        record: &mut dyn FnMut(ResultStage) -> Result<()>,
    ) -> Result<Option<String>> {
        result.points.clear();
        record(ResultStage::MapBegins(result, known))?;
        let mut keep =
            |first: usize, points: &[MapPoint]| record(ResultStage::MapPoints(&result.name, first, points));
        let (points, failure) = sweep::map(problem, &result.axes, &known.points, &mut keep, self.observer)?;
        result.points = points;
        Ok(failure)
    }

    /// ζ from half to twice its value.
    fn damping(&self) -> Result<Option<DampingVerdicts>> {
        let ratio = self.case.damping.modal_ratio;
        if ratio <= 0.0 || self.nominal.system.skew().is_some() {
            return Ok(None);
        }
        let range = [0.5 * ratio, (2.0 * ratio).min(0.999)];
        let axis = Axis { from: range[0], to: range[1], points: 9, log: true };
        let states = self.states(&[RATIO.to_string()]);
        let on = self.family(&states, &[vec![range[0]], vec![range[1]]])?;
        let own = on.modes(&[ratio])?;
        let sweep = sweep::sweep(&on, &axis, LOCATED[0], self.observer)?;
        let middle = (0..sweep.values.len())
            .min_by(|a, b| (sweep.values[*a] - ratio).abs().total_cmp(&(sweep.values[*b] - ratio).abs()));
        let row = |z: &c64| {
            let at = |k: usize| sweep.branches[k].at(middle.unwrap_or(0));
            let near = |k: usize| at(k).map_or(f64::INFINITY, |b| (b - z).norm());
            let branch = (0..sweep.branches.len()).min_by(|a, b| near(*a).total_cmp(&near(*b)));
            let flip = sweep.critical.iter().find(|c| Some(c.branch) == branch);
            DampingRow { eigenvalue: *z, critical_ratio: flip.map(|c| c.value) }
        };
        Ok(Some(DampingVerdicts { ratio, range, rows: own.eigenvalues.iter().map(row).collect() }))
    }
}

/// Errors of a sweep at full order.
struct FullOrderErrors {
    critical: Vec<Option<Checked>>,
    sample: Vec<(f64, f64)>,
}

impl FullOrderErrors {
    /// Values at which the reduced model is not good enough. Where modes merge, the error of λ is the root of that of
    /// the matrices: there the backward error decides.
    fn poor(&self, sweep: &sweep::Sweep) -> Vec<f64> {
        let bad = |(critical, check): &(&sweep::Critical, &Option<Checked>)| {
            check.is_some_and(|c| {
                c.eigenvalue_error > ACCURACY
                    && (critical.kind != CriticalKind::Merging || c.backward_error > 1e-10)
            })
        };
        let critical = sweep.critical.iter().zip(&self.critical).filter(bad).map(|(c, _)| c.value);
        let sample = self.sample.iter().filter(|(_, worst)| *worst > ACCURACY).map(|(value, _)| *value);
        critical.chain(sample).collect()
    }
}

/// Measures every critical mode and all modes at the `sample` values.
fn measure(problem: &dyn SweepProblem, sweep: &sweep::Sweep, sample: &[f64]) -> Result<FullOrderErrors> {
    let critical =
        |c: &sweep::Critical| -> Result<Option<Checked>> { problem.check_nearest(&[c.value], c.eigenvalue) };
    let worst = |value: &f64| -> Result<(f64, f64)> {
        let checks = problem.check(&[*value])?;
        Ok((*value, worst_alone(&checks)))
    };
    Ok(FullOrderErrors {
        critical: sweep.critical.iter().map(critical).collect::<Result<_>>()?,
        sample: sample.iter().map(worst).collect::<Result<_>>()?,
    })
}

/// The largest estimated |Δλ|/|λ| of the modes that no other merges with.
fn worst_alone(checks: &[Checked]) -> f64 {
    checks.iter().filter(|c| !merged(c, checks)).map(|c| c.eigenvalue_error).fold(0.0, f64::max)
}

/// Whether another mode is so near that λ says little by itself.
fn merged(mode: &Checked, all: &[Checked]) -> bool {
    all.iter().any(|other| {
        let distance = (other.eigenvalue - mode.eigenvalue).norm();
        distance > 0.0 && distance < 1e-6 * mode.eigenvalue.norm()
    })
}
