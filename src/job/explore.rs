//! The sweeps and maps of a case, and what its damping decides; what all its studies start from.

use super::known::KnownAnswers;
use super::operating_point::OperatingPoint;
use super::sink::ResultStage;
use super::states::{OnFamily, RATIO, Start, States, Whole, keeps_the_structure};
use super::studies::Study;
use crate::case::{Case, MapAnalysis, SweepAnalysis};
use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::numbers::given;
use crate::progress::Observer;
use crate::results::{DampingRow, DampingVerdicts, MapResult, RunResults, SweepMethod, SweepResult};
use crate::stability::{Family, FamilyFrame, SlidingState};
use crate::sweep::{
    self, Answered, Axis, Boundary, Checked, CriticalKind, MapPoint, MeasuredProblem, SweepProblem,
    Unanswered, reasoned,
};

/// The largest |Δλ|/|λ| at full order that is accepted.
pub(super) const ACCURACY: f64 = 1e-8;
/// Relative length of the bracket of a critical value on a reduced model, and by whole analyses.
const LOCATED: [f64; 2] = [1e-10, 1e-7];
/// The same of a point of the boundary of stability.
const BOUNDARY: [f64; 2] = [1e-7, 1e-6];
/// Full-order measures that were not good enough lead to a richer family, so often at most.
pub(super) const REFINEMENTS: usize = 3;
/// Runs the studies of the case that one analysis takes, and hands each on when it is there.
pub(super) type Studies<'a> = dyn Fn(&Explorer, &mut RunResults, &mut RecordStage) -> Result<()> + 'a;
/// Takes results as they are there.
pub(super) type RecordStage<'a> = dyn FnMut(ResultStage) -> Result<()> + 'a;

/// Runs `studies` of the case whose own values are at `nominal`.
pub(super) fn explore(
    nominal: &OperatingPoint,
    studies: &Studies,
    known: &KnownAnswers,
    results: &mut RunResults,
    record: &mut RecordStage,
    observer: &dyn Observer,
) -> Result<()> {
    let start = Start::new(nominal)?;
    known.compare_by(&start.reference)?;
    let explored =
        Explorer::new(&start, known, observer).and_then(|explorer| studies(&explorer, results, record));
    // Beside their reference nothing that is found is a fault of what is known.
    explored.map_err(Error::while_computing)
}

/// The problem of a study.
#[allow(clippy::large_enum_variant, reason = "one at a time")]
pub(super) enum Problem<'s> {
    Whole(Whole<'s>),
    /// On a reduced model that is not refined yet.
    Reduced(OnFamily<'s>),
}

impl Problem<'_> {
    pub(super) fn of(&self) -> &dyn MeasuredProblem {
        match self {
            Problem::Whole(whole) => whole,
            Problem::Reduced(on) => on,
        }
    }

    /// Relative length of the bracket of what is located between the points of a grid of these axes.
    pub(super) fn tolerance(&self, axes: &[Axis]) -> f64 {
        let tolerances = if axes.len() == 1 { LOCATED } else { BOUNDARY };
        tolerances[usize::from(matches!(self, Problem::Whole(_)))]
    }

    pub(super) fn method(&self) -> SweepMethod {
        match self {
            Problem::Whole(_) => SweepMethod::Whole,
            Problem::Reduced(on) => SweepMethod::Reduced(on.family.dimension()),
        }
    }
}

pub(super) struct Explorer<'a> {
    start: &'a Start<'a>,
    /// Without its studies.
    pub(super) case: &'a Case,
    frame: FamilyFrame<'a>,
    pub(super) known: &'a KnownAnswers<'a>,
    pub(super) observer: &'a dyn Observer,
}

impl<'a> Explorer<'a> {
    pub(super) fn new(
        start: &'a Start<'a>,
        known: &'a KnownAnswers<'a>,
        observer: &'a dyn Observer,
    ) -> Result<Self> {
        let (Start { nominal, case, .. }, others) = (start, start.others.iter().collect());
        let band = case.cea.as_ref().expect("a case with complex modes").band;
        let frame = match start.closed() {
            Some((closed, real)) => FamilyFrame::closed(closed, real, others, band)?,
            None => {
                let displacement = &nominal.steady.displacement;
                FamilyFrame::new(&nominal.system, displacement, &nominal.real, others, band)?
            }
        };
        Ok(Explorer { start, case, frame, known, observer })
    }
}

impl Explorer<'_> {
    /// The case with its studies.
    pub(super) fn whole_case(&self) -> &Case {
        self.start.nominal.prepared.case
    }

    /// Every sweep and map of the case, and the verdicts of its damping.
    pub(super) fn sweeps_and_maps(&self, results: &mut RunResults, record: &mut RecordStage) -> Result<()> {
        let case = self.whole_case();
        for (name, analysis) in &case.sweep {
            record(ResultStage::StudyBegins)?;
            let (result, warning) = self.sweep(name, analysis)?;
            results.warnings.extend(warning);
            record(ResultStage::Found(&result))?;
            results.records.push(result);
        }
        for (name, analysis) in &case.map {
            let (result, warning) = self.map(name, analysis, record)?;
            results.warnings.extend(warning);
            results.records.push(result);
        }
        if let Some(verdicts) = self.damping()? {
            record(ResultStage::Found(&verdicts))?;
            results.records.push(verdicts);
        }
        Ok(())
    }

    fn keeps_the_structure(&self, paths: &[String]) -> Result<bool> {
        let each =
            paths.iter().map(|path| keeps_the_structure(self.case, path)).collect::<Result<Vec<bool>>>()?;
        Ok(each.iter().all(|keeps| *keeps))
    }

    /// A family trained on the states of the scalars at `paths` at `places`; those without an answer are left out, and where all are, the case
    /// itself is taken.
    fn family(&self, paths: &[String], places: &[Vec<f64>]) -> Result<OnFamily<'_>> {
        let states = States::new(self.start, paths)?;
        self.observer.begin("reduced model", Some(places.len() as u64));
        let mut members: Vec<SlidingState> = places.iter().filter_map(|at| states.at(at).ok()).collect();
        if members.is_empty() {
            let own: Result<Vec<f64>> =
                paths.iter().map(|path| Ok(self.case.parameter(path)?.value)).collect();
            members.push(states.at(&own?)?);
        }
        let mut family = Family::new(&self.frame, &members)?;
        for member in &members {
            family.train(member)?;
            self.observer.advance(1);
        }
        self.observer.end();
        Ok(OnFamily { states, family })
    }

    /// The problem of a study.
    pub(super) fn problem(&self, study: &Study) -> Result<Problem<'_>> {
        if self.keeps_the_structure(&study.paths)? {
            let mut on = self.family(&study.paths, &study.training())?;
            // Before the points, which would have to be solved once more.
            for at in study.inside() {
                if on.check(&at).is_ok_and(|checks| worst_alone(&checks) > ACCURACY) {
                    on.train(&at)?;
                }
            }
            return Ok(Problem::Reduced(on));
        }
        Ok(Problem::Whole(Whole::new(
            self.start.nominal.prepared,
            study.paths.clone(),
            Some(&self.start.reference.0),
        )))
    }

    /// Solves a study by whole analyses, or on a reduced model, which is trained at the places where `solve` finds that it is not good
    /// enough. `solve` gets the problem with its answers kept, the problem, and the places on which it was trained so far.
    fn refined<T>(
        &self,
        study: &Study,
        mut solve: impl FnMut(&Answered, &Problem, &[Vec<f64>]) -> Result<(T, Vec<Vec<f64>>)>,
    ) -> Result<(T, SweepMethod)> {
        let (mut problem, mut trained, mut round) = (self.problem(study)?, Vec::new(), 0);
        loop {
            let known = self.known.of(&study.name, round);
            let (found, poor) = solve(&Answered::new(problem.of(), &known), &problem, &trained)?;
            round += 1;
            match &mut problem {
                Problem::Reduced(on) if !poor.is_empty() && round < REFINEMENTS => {
                    poor.iter().try_for_each(|at| on.train(at))?;
                    trained.extend(poor);
                }
                _ => return Ok((found, problem.method())),
            }
        }
    }

    /// The points of `total` without an answer, whose values of the scalars are those `at` their numbers, for a warning.
    ///
    /// # Errors
    /// No point has an answer.
    pub(super) fn without_an_answer(
        &self,
        study: &Study,
        total: usize,
        unanswered: &Unanswered,
        at: impl Fn(usize) -> Vec<f64>,
    ) -> Result<Option<String>> {
        let Some((first, why)) = unanswered.first() else { return Ok(None) };
        let value = |(path, value): (&String, f64)| {
            let unit = self.case.parameter(path)?.unit;
            Ok(format!("`{path}` = {} {unit}", given(value)).trim_end().to_string())
        };
        let place = study.paths.iter().zip(at(*first)).map(value).collect::<Result<Vec<_>>>()?.join(", ");
        let name = &study.name;
        if unanswered.len() < total {
            let count = unanswered.len();
            let begin = format!("`{name}` leaves out {count} of {total} points without an answer; the first");
            return Ok(Some(format!("{begin}, {place}: {why}")));
        }
        let Error::Analysis { what, found, help } = why.clone().while_computing() else {
            return Err(why.clone());
        };
        let what = format!("`{name}`: none of {total} points has an answer; the first, {place}: {what}");
        Err(Error::analysis(what, found, help))
    }

    fn sweep(&self, name: &str, analysis: &SweepAnalysis) -> Result<(SweepResult, Option<String>)> {
        let study = Study::of_sweep(name, analysis);
        let axis = study.axes()[0];
        let parameter = self.case.parameter(&analysis.parameter)?;
        let ((sweep, measured), method) = self.refined(&study, |answered, problem, _| {
            let sweep = sweep::sweep(answered, &axis, problem.tolerance(study.axes()), self.observer)?;
            let ends = sweep.answered().next().zip(sweep.answered().next_back());
            let sample = match (ends, problem) {
                (None, _) => Vec::new(),
                (Some((_, to)), Problem::Whole(_)) => vec![to],
                (Some((from, to)), Problem::Reduced(_)) => {
                    [0.25, 0.75].map(|share| axis.between(from, to, share)).to_vec()
                }
            };
            let measured = measure(problem.of(), &sweep, &sample)?;
            let poor = measured.poor(&sweep).into_iter().map(|value| vec![value]).collect();
            Ok(((sweep, measured), poor))
        })?;
        let at = |k: usize| vec![sweep.values[k]];
        let warning = self.without_an_answer(&study, sweep.values.len(), &sweep.unanswered, at)?;
        let result = SweepResult {
            name: name.to_string(),
            parameter: parameter.path,
            label: parameter.label,
            unit: parameter.unit.to_string(),
            axis,
            nominal: parameter.value,
            sweep,
            verified: measured.critical,
            sample: measured.sample,
            method,
        };
        Ok((result, warning))
    }

    /// A map without points.
    fn empty_map(&self, name: &str, analysis: &MapAnalysis, study: &Study) -> Result<MapResult> {
        let [a, b] = [0, 1].map(|k| self.case.parameter(&analysis.parameters[k]));
        let (a, b) = (a?, b?);
        Ok(MapResult {
            name: name.to_string(),
            parameters: analysis.parameters.clone(),
            labels: [a.label, b.label],
            units: [a.unit.to_string(), b.unit.to_string()],
            axes: [study.axes()[0], study.axes()[1]],
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
        record: &mut RecordStage,
    ) -> Result<(MapResult, Option<String>)> {
        let study = Study::of_map(name, analysis);
        let mut result = self.empty_map(name, analysis, &study)?;
        let axes = result.axes;
        let inside: Vec<[f64; 2]> = study.inside().iter().map(|at| [at[0], at[1]]).collect();
        let (unanswered, method) = self.refined(&study, |answered, problem, trained| {
            let trained: Vec<[f64; 2]> = trained.iter().map(|at| [at[0], at[1]]).collect();
            result.points.clear();
            record(ResultStage::MapBegins(&result, &trained))?;
            let mut keep = |first: usize, points: &[MapPoint]| {
                record(ResultStage::MapPoints(&result.name, first, points))
            };
            let (points, unanswered) = sweep::map(answered, &axes, &mut keep, self.observer)?;
            result.points = points;
            let tolerance = problem.tolerance(&axes);
            result.boundary = sweep::boundary(answered, &axes, &result.points, tolerance, self.observer)?;
            let poor = match problem {
                Problem::Whole(_) => Vec::new(),
                Problem::Reduced(on) => {
                    self.check_map(on, &mut result, &inside).iter().map(|at| at.to_vec()).collect()
                }
            };
            Ok((unanswered, poor))
        })?;
        result.method = method;
        let at = |k: usize| study.place(k);
        let warning = self.without_an_answer(&study, result.points.len(), &unanswered, at)?;
        record(ResultStage::Map(&result))?;
        Ok((result, warning))
    }

    /// ζ from half to twice its value.
    fn damping(&self) -> Result<Option<DampingVerdicts>> {
        let ratio = self.case.damping.modal_ratio;
        if ratio <= 0.0 {
            return Ok(None);
        }
        let range = [0.5 * ratio, (2.0 * ratio).min(0.999)];
        let axis = Axis { from: range[0], to: range[1], points: 9, log: true };
        let on = self.family(&[RATIO.to_string()], &[vec![range[0]], vec![range[1]]])?;
        let own = on.modes(&[ratio])?;
        let sweep = sweep::sweep(&on, &axis, LOCATED[0], self.observer)?;
        if let Some((_, why)) = sweep.unanswered.into_iter().next() {
            return Err(why);
        }
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

/// Measures every critical mode and all modes at the `sample` values; a value without an answer has nothing to measure.
fn measure(problem: &dyn MeasuredProblem, sweep: &sweep::Sweep, sample: &[f64]) -> Result<FullOrderErrors> {
    let critical = |c: &sweep::Critical| -> Result<Option<Checked>> {
        Ok(reasoned(problem.check_nearest(&[c.value], c.eigenvalue))?.ok().flatten())
    };
    let worst = |value: &f64| -> Result<Option<(f64, f64)>> {
        Ok(reasoned(problem.check(&[*value]))?.ok().map(|checks| (*value, worst_alone(&checks))))
    };
    Ok(FullOrderErrors {
        critical: sweep.critical.iter().map(critical).collect::<Result<_>>()?,
        sample: sample.iter().filter_map(|value| worst(value).transpose()).collect::<Result<_>>()?,
    })
}

/// The largest estimated |Δλ|/|λ| of the modes that no other merges with.
pub(super) fn worst_alone(checks: &[Checked]) -> f64 {
    checks.iter().filter(|c| !merged(c, checks)).map(|c| c.eigenvalue_error).fold(0.0, f64::max)
}

/// Whether another mode is so near that λ says little by itself.
fn merged(mode: &Checked, all: &[Checked]) -> bool {
    all.iter().any(|other| {
        let distance = (other.eigenvalue - mode.eigenvalue).norm();
        distance > 0.0 && distance < 1e-6 * mode.eigenvalue.norm()
    })
}
