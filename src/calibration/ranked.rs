//! The best assignments fitted to the model itself, and ranked by the whole χ².

use super::problem::{CalibrationModel, CalibrationProblem, Computed, Datum};
use super::residuals::misfit;
use super::{Fit, fit};
use crate::error::Result;
use crate::progress::Observer;
use rayon::prelude::*;

/// So many assignments at most are fitted to all that was measured, …
const FITTED: usize = 12;
/// … chosen among so many at most that are fitted to the modes first, where there are modes and responses, …
const TRIED: usize = 48;
/// … of those whose linearised χ² is below so many times the least and so much more: the others have no weight.
const HOPEFUL: [f64; 2] = [4.0, 100.0];

/// An assignment and its fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranked {
    /// The level of each datum.
    pub assignment: Vec<usize>,
    /// The least χ², of modes and responses.
    pub fit: Fit,
    /// The least χ² of the modes with the model linearised at the start.
    pub linear_chi2: f64,
    /// max |f/y − 1|.
    pub largest_error: f64,
    /// The least MAC of a measured shape with its level; none without shapes.
    pub least_mac: Option<f64>,
    /// exp(−Δχ²/2) beside the best.
    pub weight: f64,
}

/// Where the fit of an assignment begins.
struct Begin {
    linear_chi2: f64,
    assignment: Vec<usize>,
    x: Vec<f64>,
    computed: Computed,
    chi2: f64,
}

/// Whether assignments are fitted to the modes before they are to all.
fn modes_first(problem: &CalibrationProblem) -> bool {
    !problem.data.is_empty() && !problem.curves.is_empty()
}

/// How many of the best assignments are worth looking at.
pub(super) fn tried(problem: &CalibrationProblem) -> usize {
    if modes_first(problem) { TRIED } else { FITTED }
}

/// The fits of the assignments `found`, which have a linearised χ² of the modes, from `start`; the least χ² first, and how many
/// were tried.
///
/// A response says which way its peaks should go only where computed peaks meet measured ones. So each assignment is fitted to
/// the modes first, which takes no responses; the responses are computed once there, and what has the least whole χ² is fitted
/// to all, from there, or from the start where the whole χ² is less.
pub(super) fn ranked(
    model: &dyn CalibrationModel,
    problem: &CalibrationProblem,
    mut found: Vec<(f64, Vec<usize>)>,
    start: (&[f64], &Computed),
    observer: &dyn Observer,
) -> Result<(Vec<Ranked>, usize)> {
    let hopeful = HOPEFUL[0] * found[0].0 + HOPEFUL[1];
    found.retain(|(chi2, _)| *chi2 <= hopeful);
    let tried = found.len();
    observer.begin("fitting assignments", Some((tried + tried.min(FITTED)) as u64));
    let begin = |(linear_chi2, assignment): (f64, Vec<usize>)| -> Result<Begin> {
        let place = |x: &[f64], computed: &Computed| Begin {
            linear_chi2,
            chi2: misfit(problem, &assignment, x, computed),
            assignment: assignment.clone(),
            x: x.to_vec(),
            computed: computed.clone(),
        };
        let mut begin = place(start.0, start.1);
        if modes_first(problem) {
            let x = fit(model, &problem.modes_alone(), &assignment, start)?.x;
            let met = place(&x, &model.compute(&x)?);
            begin = if met.chi2 < begin.chi2 { met } else { begin };
        }
        observer.advance(1);
        Ok(begin)
    };
    let mut begun: Vec<Begin> = found.into_par_iter().map(begin).collect::<Result<_>>()?;
    begun.sort_by(|a, b| a.chi2.total_cmp(&b.chi2));
    begun.truncate(FITTED);
    let fitted = |begin: Begin| -> Result<Ranked> {
        let fit = fit(model, problem, &begin.assignment, (&begin.x, &begin.computed))?;
        observer.advance(1);
        Ok(Ranked {
            largest_error: largest_error(problem, &begin.assignment, &fit.computed),
            least_mac: least_mac(problem, &begin.assignment, &fit.computed),
            assignment: begin.assignment,
            linear_chi2: begin.linear_chi2,
            weight: 0.0,
            fit,
        })
    };
    let mut ranked: Vec<Ranked> = begun.into_par_iter().map(fitted).collect::<Result<_>>()?;
    observer.end();
    ranked.sort_by(|a, b| a.fit.chi2.total_cmp(&b.fit.chi2));
    let least = ranked[0].fit.chi2;
    ranked.iter_mut().for_each(|r| r.weight = (-0.5 * (r.fit.chi2 - least)).exp());
    Ok((ranked, tried))
}

/// max |f/y − 1| of an assignment; infinite where a level is not found.
fn largest_error(problem: &CalibrationProblem, assignment: &[usize], computed: &Computed) -> f64 {
    let error = |(datum, k): (&Datum, &usize)| {
        computed.levels[*k]
            .as_ref()
            .map_or(f64::INFINITY, |l| (l.frequency_hz / datum.frequency_hz - 1.0).abs())
    };
    problem.data.iter().zip(assignment).map(error).fold(0.0, f64::max)
}

/// The least MAC of a measured shape with its level; none without shapes.
fn least_mac(problem: &CalibrationProblem, assignment: &[usize], computed: &Computed) -> Option<f64> {
    let each = problem.data.iter().zip(assignment).filter_map(|(datum, k)| {
        let (shape, level) = (datum.shape.as_ref()?, computed.levels[*k].as_ref());
        Some(level.and_then(|level| level.span.as_ref()).map_or(0.0, |span| span.mac(shape)))
    });
    each.reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::super::samples::{Powers, SampledResponse, curves, problem};
    use super::super::{Calibration, CalibrationOptions, calibrate};
    use super::*;
    use crate::bounds::{Origin::*, within};

    const FITS: CalibrationOptions =
        CalibrationOptions { reach: 0.05, leave_one_out: false, chance_draws: 0, trials: 0 };

    /// Calibrated with the responses and without them.
    fn both(model: &Powers, data: &[f64], truth: &[f64]) -> [Calibration; 2] {
        let alone = problem(model, data, 0.002);
        let with = CalibrationProblem { curves: curves(model, truth, 0.1), ..alone.clone() };
        let start = vec![0.0; truth.len()];
        [with, alone].map(|problem| calibrate(model, &problem, &start, &FITS, &()).unwrap())
    }

    fn near(found: &Ranked, truth: &[f64]) -> bool {
        found.fit.converged
            && found.fit.x.iter().zip(truth).all(|(x, t)| within((x - t).abs(), 1e-4, Tolerance))
    }

    #[test]
    fn a_response_decides_what_a_frequency_leaves_open() {
        let sampled = SampledResponse {
            weights: vec![0.0, 0.0, 1.0],
            frequencies_hz: (0..40).map(|k| 450.0 + 8.0 * f64::from(k)).collect(),
        };
        let model = Powers {
            base: vec![300.0, 340.0, 600.0],
            exponents: vec![vec![0.1], vec![-0.05], vec![0.06]],
            sampled: vec![sampled],
            ..Powers::new(3, 1, 0)
        };
        let truth = [1.0];
        for (k, level) in model.compute(&truth).unwrap().levels.iter().flatten().take(2).enumerate() {
            let [with, alone] = both(&model, &[level.frequency_hz], &truth);
            assert!(alone.ranked.len() == 2 && alone.ranked[1].weight > 0.999, "{:?}", alone.ranked);
            assert!(with.best().assignment == [k] && near(with.best(), &truth), "{:?}", with.ranked);
            assert!(with.ranked[1].weight.ln() < -20.0);
        }
    }

    #[test]
    fn a_response_picks_among_more_assignments_than_are_fitted_to_it() {
        let mut model = Powers::new(9, 3, 2);
        model.base = (0..9).map(|k| 300.0 * 1.1f64.powi(k)).collect();
        let weights = (0..9).map(|k| 1.0 + f64::from(k % 3)).collect();
        let frequencies_hz = (0..90).map(|k| 250.0 + 5.0 * f64::from(k)).collect();
        model.sampled = vec![SampledResponse { weights, frequencies_hz }];
        let truth = [0.9, -0.6, 0.3];
        let levels = model.compute(&truth).unwrap().levels;
        let mut hidden = 0;
        for chosen in [[0, 4, 5], [1, 3, 6], [2, 4, 6], [3, 5, 8], [1, 4, 7], [2, 5, 7]] {
            let data = chosen.map(|k: usize| levels[k].as_ref().unwrap().frequency_hz);
            let [with, alone] = both(&model, &data, &truth);
            assert!(with.best().assignment == chosen && near(with.best(), &truth), "{:?}", with.best());
            assert!(with.tried > with.ranked.len() && with.ranked.len() == alone.tried);
            hidden += usize::from(alone.ranked.iter().all(|other| other.assignment != chosen));
        }
        assert!(hidden > 0, "frequencies alone would have found them all");
    }
}
