//! Whether the intervals hold the truth as often as they say: the fit repeated on data made from its own model.

use super::knowledge::{Interval, Knowledge};
use super::nearby::QuadraticModel;
use super::problem::{CalibrationModel, CalibrationProblem, Computed, Curve, Datum, Unknown};
use super::residuals::Residuals;
use super::{Fit, Span, fit};
use crate::error::Result;
use crate::linalg::random::Random;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::sync::Arc;

/// The model is evaluated no nearer to the truth than this, in units of the unknowns.
const LEAST_STEP: f64 = 1e-2;

/// Trials with synthetic data (parametric bootstrap): the calibrated values are the truth, each frequency is the computed
/// one with the stated relative deviation, normally distributed, each shape the computed one nearest to the measured one, its
/// components with their deviation, responses line by line with theirs, and what was expected scatters about the truth likewise.
/// The fits are made to the model near the truth, quadratic in ln f and linear in the shapes; its deviation from the model itself is reported.
#[derive(Debug, Clone, PartialEq)]
pub struct Trials {
    /// Number.
    pub count: usize,
    /// Those whose fit converged.
    pub converged: usize,
    /// Of all, those whose 95 % interval with the stated deviations holds the truth, for each unknown.
    pub covered: Vec<usize>,
    /// The same for the intervals scaled by χ²/ν; `None` where ν = 0.
    pub scaled_covered: Option<Vec<usize>>,
    /// The largest difference of a residual between that model and the model itself, in standard deviations, at the estimates
    /// that are furthest from the truth.
    pub model_error: f64,
    /// Root mean square of estimate less truth, for each unknown.
    pub scatter: Vec<f64>,
}

impl Trials {
    pub(super) fn new(
        model: &dyn CalibrationModel,
        problem: &CalibrationProblem,
        assignment: &[usize],
        (truth, known): (&Fit, &Knowledge),
        count: usize,
    ) -> Result<Trials> {
        let mut normal = NormalDeviates { random: Random::new(), second: None };
        let problems: Vec<CalibrationProblem> =
            (0..count).map(|_| synthetic(problem, assignment, truth, &mut normal)).collect();
        let steps: Vec<f64> = known.deviations.iter().map(|d| d.clamp(LEAST_STEP, 1.0)).collect();
        let near = QuadraticModel::new(model, problem, (&truth.x, &truth.computed), &steps)?;
        let one = |trial: &CalibrationProblem| -> Result<(bool, Vec<f64>, Knowledge)> {
            let found = fit(&near, trial, assignment, (&truth.x, &truth.computed))?;
            let known = Knowledge::new(trial, assignment, &found);
            Ok((found.converged, found.x, known))
        };
        let done: Vec<_> = problems.par_iter().map(one).collect::<Result<_>>()?;
        let n = truth.x.len();
        let holds = |of: &[Interval], j: usize| (of[j][0]..=of[j][1]).contains(&truth.x[j]);
        let covered = |of: &dyn Fn(&Knowledge) -> Option<Vec<Interval>>| -> Option<Vec<usize>> {
            let intervals = done.iter().map(|d| of(&d.2)).collect::<Option<Vec<_>>>()?;
            Some((0..n).map(|j| intervals.iter().filter(|of| holds(of, j)).count()).collect())
        };
        let squares = |j: usize| done.iter().map(|d| (d.1[j] - truth.x[j]).powi(2)).sum::<f64>();
        Ok(Trials {
            count,
            converged: done.iter().filter(|d| d.0).count(),
            covered: covered(&|known| Some(known.intervals.clone())).unwrap_or_default(),
            scaled_covered: covered(&|known| known.scaled_intervals.clone()),
            model_error: model_error(model, &near, problem, assignment, truth, done.iter().map(|d| &d.1))?,
            scatter: (0..n).map(|j| (squares(j) / count.max(1) as f64).sqrt()).collect(),
        })
    }
}

/// |Δ ln f|/s at the estimates with the largest and the smallest value of each unknown.
fn model_error<'a>(
    model: &dyn CalibrationModel,
    near: &QuadraticModel,
    problem: &CalibrationProblem,
    assignment: &[usize],
    truth: &Fit,
    estimates: impl Iterator<Item = &'a Vec<f64>> + Clone,
) -> Result<f64> {
    let by = |j: usize| move |a: &&Vec<f64>, b: &&Vec<f64>| a[j].total_cmp(&b[j]);
    let ends = (0..truth.x.len())
        .flat_map(|j| [estimates.clone().max_by(by(j)), estimates.clone().min_by(by(j))])
        .flatten()
        .collect::<Vec<_>>();
    let error = |x: &&Vec<f64>| -> Result<f64> {
        let (own, exact) = (near.compute(x)?, problem.compute(model, x)?);
        let all = |there: &Computed| Residuals::all(problem, assignment, x, there).map(|all| all.values);
        Ok(match (all(&own), all(&exact)) {
            (Some(a), Some(b)) => a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max),
            _ => f64::INFINITY,
        })
    };
    let errors: Vec<f64> = ends.par_iter().map(error).collect::<Result<_>>()?;
    Ok(errors.into_iter().fold(0.0, f64::max))
}

fn synthetic(
    problem: &CalibrationProblem,
    assignment: &[usize],
    truth: &Fit,
    normal: &mut NormalDeviates,
) -> CalibrationProblem {
    let datum = |(datum, k): (&Datum, &usize), normal: &mut NormalDeviates| {
        let level = truth.computed.levels[*k].as_ref();
        let exact = level.map_or(datum.frequency_hz, |level| level.frequency_hz);
        let frequency_hz = exact * (datum.deviation * normal.next()).exp();
        let span = level.and_then(|level| level.span.as_ref());
        let noisy = |(shape, span): (&Arc<[f64]>, &Span)| {
            span.nearest(shape).into_iter().map(|v| v + normal.next()).collect::<Arc<[f64]>>()
        };
        let shape = datum.shape.as_ref().zip(span).map(noisy);
        Datum { frequency_hz, shape, ..*datum }
    };
    let curve = |curve: &Curve, normal: &mut NormalDeviates| {
        let exact = truth.computed.lines[curve.lines()].iter().map(|line| line.value);
        Curve { values: exact.map(|v| v + curve.deviation * normal.next()).collect(), ..curve.clone() }
    };
    let expected = |(unknown, x): (&Unknown, &f64), normal: &mut NormalDeviates| Unknown {
        expected: unknown.expected.map(|_| x + normal.next()),
        ..*unknown
    };
    CalibrationProblem {
        data: problem.data.iter().zip(assignment).map(|pair| datum(pair, normal)).collect(),
        curves: problem.curves.iter().map(|measured| curve(measured, normal)).collect(),
        unknowns: problem.unknowns.iter().zip(&truth.x).map(|pair| expected(pair, normal)).collect(),
        ..problem.clone()
    }
}

/// Normally distributed numbers, by Box and Muller's transformation (Ann. Math. Stat. 29 (1958) 610).
struct NormalDeviates {
    random: Random,
    second: Option<f64>,
}

impl NormalDeviates {
    fn next(&mut self) -> f64 {
        if let Some(second) = self.second.take() {
            return second;
        }
        // Uniform in (0, 1].
        let uniform = 0.5 * (1.0 - self.random.next());
        let (size, angle) = ((-2.0 * uniform.max(f64::MIN_POSITIVE).ln()).sqrt(), PI * self.random.next());
        self.second = Some(size * angle.sin());
        size * angle.cos()
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::{Powers, problem};
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn normal_numbers_have_their_moments() {
        let mut normal = NormalDeviates { random: Random::new(), second: None };
        let all: Vec<f64> = (0..40_000).map(|_| normal.next()).collect();
        let moment = |p: i32| all.iter().map(|x| x.powi(p)).sum::<f64>() / all.len() as f64;
        assert!(
            within(moment(1).abs(), 0.02, RandomSample)
                && within((moment(2) - 1.0).abs(), 0.03, RandomSample)
                && within((moment(4) - 3.0).abs(), 0.2, RandomSample)
        );
    }

    #[test]
    fn intervals_hold_the_truth_in_95_of_100_trials() {
        let model = Powers::new(6, 2, 1);
        let truth = [0.2, -0.3];
        let computed = model.compute(&truth).unwrap();
        let exact: Vec<f64> = computed.levels.iter().flatten().map(|level| level.frequency_hz).collect();
        let mut problem = problem(&model, &exact, 0.005);
        problem.unknowns[0].expected = Some(0.9);
        let assignment = [0, 1, 2, 3, 4, 5];
        let start = fit(&model, &problem, &assignment, (&truth, &computed)).unwrap();
        let known = Knowledge::new(&problem, &assignment, &start);
        let trials = Trials::new(&model, &problem, &assignment, (&start, &known), 1000).unwrap();
        assert!(trials.converged == 1000 && within(trials.model_error, 1e-9, Tolerance));
        // Four standard deviations of a binomial distribution about 950.
        for covered in trials.covered.iter().chain(trials.scaled_covered.iter().flatten()) {
            assert!((922..=978).contains(covered), "{trials:?}");
        }
    }
}
