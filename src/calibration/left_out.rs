//! Each measured mode and each response predicted from all the others.

use super::knowledge::left_open;
use super::problem::{CalibrationModel, CalibrationProblem, Level};
use super::ranked::Ranked;
use super::residuals::{Residuals, misfit};
use super::{Fit, fit};
use crate::error::Result;
use crate::progress::Observer;
use rayon::prelude::*;

/// Leave-one-out predictions: each datum left out in turn, the modes and all responses but it kept in.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LeftOut {
    /// The measured modes.
    pub data: Vec<LeftOutDatum>,
    /// The measured responses.
    pub curves: Vec<LeftOutCurve>,
}

/// A datum that was left out.
#[derive(Debug, Clone, PartialEq)]
pub struct LeftOutDatum {
    /// The unknowns without it.
    pub x: Vec<f64>,
    /// Predicted frequency \[Hz\]; `None` where the level is not found, or where the uncertainty that the others leave moves it by
    /// more than the deviation of the datum.
    pub predicted_hz: Option<f64>,
    /// MAC of its shape, if it has one, with the one that they predict; likewise `None`.
    pub mac: Option<f64>,
    /// Whether the fit converged.
    pub converged: bool,
}

/// A response that was left out.
#[derive(Debug, Clone, PartialEq)]
pub struct LeftOutCurve {
    /// The unknowns without it.
    pub x: Vec<f64>,
    /// Prediction of its lines; `None` where a level of the others is not found, or where the uncertainty that the others leave
    /// moves the lines by more than their deviation, as a root mean square.
    pub predicted: Option<Vec<f64>>,
    /// Whether the fit converged.
    pub converged: bool,
}

/// Fits all but one of what was measured, each in turn, and predicts that one. Nothing where the facts are no more than the
/// unknowns: what the others leave open would stay where the fit of all put it. The assignment stays.
pub(super) fn leave_one_out(
    model: &dyn CalibrationModel,
    problem: &CalibrationProblem,
    best: &Ranked,
    observer: &dyn Observer,
) -> Result<LeftOut> {
    if problem.degrees_of_freedom(&best.assignment, &best.fit.computed) == 0 {
        return Ok(LeftOut::default());
    }
    let (data, curves) = (problem.data.len(), problem.curves.len());
    observer.begin("leaving data out", Some((data + curves) as u64));
    let fitted = |others: &CalibrationProblem, assignment: &[usize]| -> Result<Fit> {
        let found = fit(model, others, assignment, (&best.fit.x, &best.fit.computed))?;
        observer.advance(1);
        Ok(found)
    };
    let known = |others: &CalibrationProblem, assignment: &[usize], found: &Fit| {
        misfit(others, assignment, &found.x, &found.computed).is_finite()
    };
    let datum = |out: usize| -> Result<LeftOutDatum> {
        let (mut others, mut assignment) = (problem.clone(), best.assignment.clone());
        let datum = others.data.remove(out);
        let level = assignment.remove(out);
        let found = fitted(&others, &assignment)?;
        let level = found.computed.levels[level].as_ref().filter(|_| known(&others, &assignment, &found));
        let open =
            |level: &Level| left_open(&others, &assignment, &found.computed, &Residuals::of(&datum, level));
        let open = level.map_or(Vec::new(), open);
        let determined = |moved: &[f64]| mean_square(moved) <= 1.0;
        let mac = |level: &Level| Some(level.span.as_ref()?.mac(datum.shape.as_ref()?));
        Ok(LeftOutDatum {
            predicted_hz: level.filter(|_| determined(&open[..1])).map(|level| level.frequency_hz),
            mac: level.filter(|_| determined(&open[1..])).and_then(mac),
            converged: found.converged,
            x: found.x,
        })
    };
    let curve = |out: usize| -> Result<LeftOutCurve> {
        let mut others = problem.clone();
        let curve = others.curves.remove(out);
        let mut found = fitted(&others, &best.assignment)?;
        if others.curves.is_empty() {
            found.computed = model.compute(&found.x)?;
        }
        let lines = &found.computed.lines;
        let determined = known(&others, &best.assignment, &found) && {
            let own = Residuals::along(&curve, lines);
            mean_square(&left_open(&others, &best.assignment, &found.computed, &own)) <= 1.0
        };
        Ok(LeftOutCurve {
            predicted: determined.then(|| lines[curve.lines()].iter().map(|line| line.value).collect()),
            converged: found.converged,
            x: found.x,
        })
    };
    let left_out = LeftOut {
        data: (0..data).into_par_iter().map(datum).collect::<Result<_>>()?,
        curves: (0..curves).into_par_iter().map(curve).collect::<Result<_>>()?,
    };
    observer.end();
    Ok(left_out)
}

fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::super::samples::{Powers, SampledResponse, curves, problem};
    use super::super::{CalibrationOptions, Computed, Curve, calibrate};
    use super::*;
    use crate::bounds::{Origin::*, within};

    const ALONE: CalibrationOptions =
        CalibrationOptions { reach: 0.03, leave_one_out: true, chance_draws: 0, trials: 0 };

    /// Two responses: the first has the four lower levels, the second the upper four.
    fn sampled() -> Powers {
        let hz = |from: f64, to: f64| (0..60).map(|k| from + (to - from) * f64::from(k) / 59.0).collect();
        let of = |weights: [f64; 6], from: f64, to: f64| SampledResponse {
            weights: weights.to_vec(),
            frequencies_hz: hz(from, to),
        };
        let mut model = Powers::new(6, 2, 1);
        model.sampled = vec![
            of([1.0, 2.0, 1.0, 2.0, 0.0, 0.0], 250.0, 600.0),
            of([0.0, 0.0, 1.0, 1.0, 3.0, 2.0], 380.0, 900.0),
        ];
        model
    }

    /// Root mean square of a prediction less what was measured, in standard deviations.
    fn apart(values: &[f64], curve: &Curve) -> f64 {
        let each: Vec<f64> =
            values.iter().zip(&curve.values).map(|(a, b)| (a - b) / curve.deviation).collect();
        mean_square(&each).sqrt()
    }

    fn after(computed: &Computed, curve: &Curve) -> f64 {
        let values: Vec<f64> = computed.lines[curve.lines()].iter().map(|line| line.value).collect();
        apart(&values, curve)
    }

    #[test]
    fn a_response_is_predicted_by_the_right_model_and_not_by_a_wrong_one() {
        let truth = [0.4, -0.5];
        let right = sampled();
        let mut wrong = sampled();
        wrong.base[5] *= 1.04;
        let levels = right.compute(&truth).unwrap().levels;
        let data: Vec<f64> = levels.iter().flatten().take(3).map(|level| level.frequency_hz).collect();
        let mut problem = problem(&right, &data, 0.002);
        problem.curves = curves(&right, &truth, 0.1);
        for curve in &mut problem.curves {
            curve.values.iter_mut().enumerate().for_each(|(k, v)| *v += 0.1 * (7.0 * k as f64).sin());
        }
        let found = |model: &Powers| calibrate(model, &problem, &[0.0; 2], &ALONE, &()).unwrap();
        let determined = |model: &Powers| -> Vec<[f64; 2]> {
            let found = found(model);
            let each = problem.curves.iter().zip(&found.left_out.curves);
            each.map(|(curve, left)| {
                [after(&found.best().fit.computed, curve), apart(left.predicted.as_ref().unwrap(), curve)]
            })
            .collect()
        };
        for [fitted, predicted] in determined(&right) {
            // The noise is a sine of one deviation.
            assert!(
                (0.6..0.8).contains(&fitted) && predicted >= fitted && predicted < 1.0,
                "{fitted} {predicted}"
            );
        }
        let [_, [fitted, predicted]] = determined(&wrong)[..] else { unreachable!() };
        assert!(predicted > 5.0 && predicted > fitted && fitted > 2.0, "{fitted} {predicted}");
        // A mode that is left out is predicted with the responses kept in.
        problem.data.truncate(1);
        let found = calibrate(&right, &problem, &[0.0; 2], &ALONE, &()).unwrap();
        let left = found.left_out.data[0].predicted_hz.unwrap();
        assert!(within((left / data[0] - 1.0).abs(), 2e-3, RandomSample), "{left} {}", data[0]);
    }

    #[test]
    fn what_only_one_response_tells_is_not_predicted_from_the_others() {
        let mut model = sampled();
        // The second unknown moves the last level alone, which only the second response has.
        model.exponents.iter_mut().for_each(|a| a[1] = 0.0);
        model.exponents[5][1] = 0.1;
        let truth = [0.3, -0.4];
        let level = model.compute(&truth).unwrap().levels[0].clone().unwrap();
        let mut problem = problem(&model, &[level.frequency_hz], 0.002);
        problem.curves = curves(&model, &truth, 0.1);
        let found = calibrate(&model, &problem, &[0.0; 2], &ALONE, &()).unwrap();
        let determined: Vec<bool> =
            found.left_out.curves.iter().map(|left| left.predicted.is_some()).collect();
        assert!(found.left_out.data[0].predicted_hz.is_some());
        assert_eq!(determined, [true, false]);
        // Without another response nothing needs its lines to fit, but its prediction does.
        problem.curves.truncate(1);
        let found = calibrate(&model, &problem, &[0.0; 2], &ALONE, &()).unwrap();
        assert!(within(after(&found.best().fit.computed, &problem.curves[0]), 1e-3, Tolerance));
        assert_eq!(found.left_out.curves[0].predicted.as_ref().unwrap().len(), 60);
    }

    #[test]
    fn the_slopes_of_the_sample_are_those_of_differences() {
        let (model, x, h) = (sampled(), [0.2, 0.3], 1e-4);
        let here = model.compute(&x).unwrap().lines;
        for j in 0..2 {
            let at = |k: f64| {
                let mut x = x;
                x[j] += k * h;
                model.compute(&x).unwrap().lines
            };
            for ((line, up), down) in here.iter().zip(at(1.0)).zip(at(-1.0)) {
                assert!(within(
                    (line.slope[j] - (up.value - down.value) / (2.0 * h)).abs(),
                    1e-4 * (1.0 + line.slope[j].abs()),
                    Reference
                ));
            }
        }
    }
}
