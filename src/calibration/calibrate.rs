//! The whole calibration: assignments, fits, and what they are worth.

use super::left_out::leave_one_out;
use super::linear::Linear;
use super::problem::{CalibrationModel, CalibrationProblem, Computed};
use super::ranked::{ranked, tried};
use super::{Chance, Knowledge, LeftOut, Ranked, Trials, assignments};
use crate::error::{Error, Result};
use crate::progress::Observer;

/// Options besides the fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CalibrationOptions {
    /// A level may be what was measured when, linearised, it comes as near as a factor 1 + this inside the bounds.
    pub reach: f64,
    /// Predicts each datum and each response from all others.
    pub leave_one_out: bool,
    /// Draws of [`Chance`]; 0 for none.
    pub chance_draws: usize,
    /// [`Trials`]; 0 for none.
    pub trials: usize,
}

/// A calibrated model.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Computed values at the start.
    pub before: Computed,
    /// The fitted assignments, the least χ² first.
    pub ranked: Vec<Ranked>,
    /// How many assignments are plausible, or that there are at least so many where `all_counted` is false.
    pub plausible: usize,
    /// Whether `plausible` counts all.
    pub all_counted: bool,
    /// How many of the best on the linearised model were fitted to the modes, before the best of them were fitted to the
    /// responses, too; those of `ranked` where there are no responses.
    pub tried: usize,
    /// Whether no other assignment can match the modes better on the linearised model than those tried, short of the hopeless.
    pub all_searched: bool,
    /// Covariance and resolution of the unknowns by the data.
    pub knowledge: Knowledge,
    /// Each datum and each response predicted from all others; empty when it was not requested, or the others determine too
    /// little.
    pub left_out: LeftOut,
    /// How often chance does as well.
    pub chance: Option<Chance>,
    /// Whether the intervals hold the truth.
    pub trials: Option<Trials>,
}

impl Calibration {
    /// The best assignment.
    pub fn best(&self) -> &Ranked {
        &self.ranked[0]
    }
}

/// Fits the unknowns to the data, from `start`, and asks what the fit is worth.
///
/// # Errors
/// A model that cannot be computed, or a measured frequency that no level can come near.
pub fn calibrate(
    model: &dyn CalibrationModel,
    problem: &CalibrationProblem,
    start: &[f64],
    options: &CalibrationOptions,
    observer: &dyn Observer,
) -> Result<Calibration> {
    let before = model.compute(start)?;
    let linear = Linear::new(problem, start, &before.levels);
    let plausible: Vec<Vec<usize>> =
        problem.data.iter().map(|datum| linear.plausible(datum, options.reach)).collect();
    let found = assignments::best(&linear, &problem.data, &plausible, tried(problem));
    let (counted, all_counted) = assignments::count(problem, &plausible);
    if found.best.is_empty() {
        return Err(nothing_near(problem, &plausible, options.reach));
    }

    let (ranked, tried) = ranked(model, problem, found.best, (start, &before), observer)?;
    let best = &ranked[0];
    let knowledge = Knowledge::new(problem, &best.assignment, &best.fit);
    let left_out = match options.leave_one_out {
        true => leave_one_out(model, problem, best, observer)?,
        false => LeftOut::default(),
    };
    let chance = (options.chance_draws > 0 && !problem.data.is_empty()).then(|| {
        let problem = problem.frequencies_alone();
        let linear = Linear::new(&problem, &best.fit.x, &best.fit.computed.levels);
        let (chi2, x) = linear.least(&linear.misfit(&problem.data, &best.assignment));
        let own = (chi2, linear.largest_error(&problem.data, &best.assignment, &x));
        Chance::new(&linear, options.reach, options.chance_draws, own)
    });
    let trials = match options.trials {
        0 => None,
        count => Some(Trials::new(model, problem, &best.assignment, (&best.fit, &knowledge), count)?),
    };
    Ok(Calibration {
        knowledge,
        plausible: counted,
        all_counted,
        tried,
        all_searched: found.complete,
        left_out,
        chance,
        trials,
        before,
        ranked,
    })
}

fn nothing_near(problem: &CalibrationProblem, plausible: &[Vec<usize>], reach: f64) -> Error {
    let alone = problem.data.iter().zip(plausible).filter(|(_, levels)| levels.is_empty());
    let alone: Vec<String> = alone.map(|(datum, _)| format!("{} Hz", datum.frequency_hz)).collect();
    let found = if alone.is_empty() {
        "there are more measured frequencies than modes near them".to_string()
    } else {
        let like =
            if problem.data.iter().any(|d| d.shape.is_some()) { ", and is like its shape" } else { "" };
        format!("no computed mode comes within {:.0} % of {}{like}", 100.0 * reach, alone.join(", "))
    };
    let help = "Widen the bounds of the parameters or `mode_reach`, or leave the frequency, or with `shapes = false` the \
                measured shapes, out";
    Error::analysis("assigning modes to measured frequencies", found, help)
}

#[cfg(test)]
mod tests {
    use super::super::samples::{Powers, problem};
    use super::*;
    use crate::bounds::{Origin::*, within};

    const ALL: CalibrationOptions =
        CalibrationOptions { reach: 0.2, leave_one_out: true, chance_draws: 200, trials: 20 };

    #[test]
    fn the_assignment_that_made_the_data_wins() {
        let model = Powers::new(9, 2, 2);
        let truth = [0.9, -0.6];
        let levels = model.compute(&truth).unwrap().levels;
        let chosen = [1, 3, 4, 6, 7];
        let noise = [1.001, 0.9992, 1.0006, 0.9995, 1.0004];
        let data: Vec<f64> =
            chosen.iter().zip(noise).map(|(k, e)| e * levels[*k].as_ref().unwrap().frequency_hz).collect();
        let problem = problem(&model, &data, 0.001);
        let found = calibrate(&model, &problem, &[0.0; 2], &ALL, &()).unwrap();
        let best = found.best();
        assert!(
            best.assignment == chosen && best.fit.converged && within(best.largest_error, 2e-3, RandomSample)
        );
        assert!(found.plausible > 50 && found.all_counted && found.all_searched);
        assert!(best.weight == 1.0 && found.ranked[1..].iter().all(|other| other.weight < 0.001));
        let inside = |j: usize| {
            let [low, high] = found.knowledge.intervals[j];
            low <= truth[j] && truth[j] <= high
        };
        assert!(inside(0) && inside(1), "{:?}", found.knowledge);
        for (left, y) in found.left_out.data.iter().zip(&data) {
            assert!(within((left.predicted_hz.unwrap() / y - 1.0).abs(), 0.01, RandomSample));
        }
        assert!(found.chance.unwrap().by_error < 20 && found.trials.unwrap().converged == 20);
    }

    #[test]
    fn what_nothing_comes_near_is_told_and_too_few_data_predict_nothing() {
        let model = Powers::new(3, 2, 0);
        let far = problem(&model, &[9e9], 0.01);
        let error = calibrate(&model, &far, &[0.0; 2], &ALL, &()).unwrap_err();
        assert!(error.to_string().contains("9000000000 Hz") && error.exit_code() == 1, "{error}");
        let two = problem(&model, &[300.0, 360.0], 0.01);
        let found = calibrate(&model, &two, &[0.0; 2], &ALL, &()).unwrap();
        assert!(found.left_out.data.is_empty() && found.knowledge.reduced_chi2.is_none());
    }

    #[test]
    fn what_only_one_datum_tells_is_not_predicted_from_the_others() {
        let mut model = Powers::new(4, 2, 3);
        // The second unknown moves the last level alone.
        model.exponents.iter_mut().for_each(|a| a[1] = 0.0);
        model.exponents[3][1] = 0.1;
        let levels = model.compute(&[0.3, -0.4]).unwrap().levels;
        let data: Vec<f64> = levels.iter().flatten().map(|level| level.frequency_hz).collect();
        let problem = problem(&model, &data, 0.002);
        let options = CalibrationOptions { reach: 0.02, chance_draws: 0, trials: 0, ..ALL };
        let found = calibrate(&model, &problem, &[0.0; 2], &options, &()).unwrap();
        assert_eq!(found.best().assignment, [0, 1, 2, 3]);
        let predicted: Vec<bool> =
            found.left_out.data.iter().map(|left| left.predicted_hz.is_some()).collect();
        assert_eq!(predicted, [true, true, true, false]);
    }

    #[test]
    fn the_number_of_threads_does_not_matter() {
        let model = Powers::new(9, 2, 2);
        let problem = problem(&model, &[330.0, 500.0, 760.0], 0.002);
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| calibrate(&model, &problem, &[0.0; 2], &ALL, &()).unwrap())
        };
        assert_eq!(with(1), with(3));
    }
}
