//! The whole calibration: assignments, fits, and what they are worth.

use super::knowledge::left_open;
use super::linear::Linear;
use super::residuals::misfit;
use super::{Chance, Computed, Fit, Knowledge, Level, Model, Problem, Trials, assignments, fit};
use crate::error::{Error, Result};
use crate::progress::Observer;
use rayon::prelude::*;

/// So many assignments at most are fitted to the model itself, …
const FITTED: usize = 12;
/// … those of them whose linearised χ² is below so many times the least and so much more: the others have no weight.
const HOPEFUL: [f64; 2] = [4.0, 100.0];

/// What is asked besides the fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// A level may be what was measured when, linearised, it comes as near as a factor 1 + this inside the bounds.
    pub reach: f64,
    /// Predicts each datum from the others.
    pub leave_one_out: bool,
    /// Draws of [`Chance`]; 0 for none.
    pub chance_draws: usize,
    /// [`Trials`]; 0 for none.
    pub trials: usize,
}

/// A calibrated model.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// What the model gives at the start.
    pub before: Computed,
    /// The fitted assignments, the least χ² first.
    pub ranked: Vec<Ranked>,
    /// How many assignments are plausible, or that there are at least so many where `all_counted` is false.
    pub plausible: usize,
    /// Whether `plausible` counts all.
    pub all_counted: bool,
    /// Whether no other assignment can be better on the linearised model than those fitted, short of the hopeless.
    pub all_searched: bool,
    /// What the data determine.
    pub knowledge: Knowledge,
    /// Each datum predicted from the others; empty when it was not asked for, or the others determine too little.
    pub left_out: Vec<LeftOut>,
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

/// An assignment and its fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranked {
    /// The level of each datum.
    pub assignment: Vec<usize>,
    /// The least χ².
    pub fit: Fit,
    /// The least χ² of the model linearised at the start.
    pub linear_chi2: f64,
    /// max |f/y − 1|.
    pub largest_error: f64,
    /// The least MAC of a measured shape with its level; none without shapes.
    pub least_likeness: Option<f64>,
    /// exp(−Δχ²/2) beside the best.
    pub weight: f64,
}

/// A datum that was left out.
#[derive(Debug, Clone, PartialEq)]
pub struct LeftOut {
    /// The unknowns without it.
    pub x: Vec<f64>,
    /// What they predict for it \[Hz\]; `None` where the level is not found, or where what the others leave open moves it by
    /// more than the deviation of the datum.
    pub predicted_hz: Option<f64>,
    /// MAC of its shape, if it has one, with the one that they predict; likewise `None`.
    pub likeness: Option<f64>,
    /// Whether the fit converged.
    pub converged: bool,
}

/// Fits the unknowns to the data, from `start`, and asks what the fit is worth.
///
/// # Errors
/// A model that cannot be computed, or a measured frequency that no level can come near.
pub fn calibrate(
    model: &dyn Model,
    problem: &Problem,
    start: &[f64],
    options: &Options,
    observer: &dyn Observer,
) -> Result<Calibration> {
    let before = model.compute(start)?;
    let linear = Linear::new(problem, start, &before.levels);
    let plausible: Vec<Vec<usize>> =
        problem.data.iter().map(|datum| linear.plausible(datum, options.reach)).collect();
    let mut found = assignments::best(&linear, &problem.data, &plausible, FITTED);
    let (counted, all_counted) = assignments::count(problem, &plausible);
    if found.best.is_empty() {
        return Err(nothing_near(problem, &plausible, options.reach));
    }

    let hopeful = HOPEFUL[0] * found.best[0].0 + HOPEFUL[1];
    found.best.retain(|(chi2, _)| *chi2 <= hopeful);
    observer.begin("fitting assignments", Some(found.best.len() as u64));
    let fitted = |(linear_chi2, assignment): &(f64, Vec<usize>)| -> Result<Ranked> {
        let fit = fit(model, problem, assignment, (start, &before))?;
        observer.advance(1);
        Ok(Ranked {
            largest_error: largest_error(problem, assignment, &fit.computed),
            least_likeness: least_likeness(problem, assignment, &fit.computed),
            assignment: assignment.clone(),
            linear_chi2: *linear_chi2,
            weight: 0.0,
            fit,
        })
    };
    let mut ranked: Vec<Ranked> = found.best.par_iter().map(fitted).collect::<Result<_>>()?;
    observer.end();
    ranked.sort_by(|a, b| a.fit.chi2.total_cmp(&b.fit.chi2));
    let least = ranked[0].fit.chi2;
    ranked.iter_mut().for_each(|r| r.weight = (-0.5 * (r.fit.chi2 - least)).exp());

    let best = &ranked[0];
    let knowledge = Knowledge::new(problem, &best.assignment, &best.fit);
    let left_out = match options.leave_one_out {
        true => leave_one_out(model, problem, best, observer)?,
        false => Vec::new(),
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
        all_searched: found.complete,
        left_out,
        chance,
        trials,
        before,
        ranked,
    })
}

/// max |f/y − 1| of an assignment; infinite where a level is not found.
fn largest_error(problem: &Problem, assignment: &[usize], computed: &Computed) -> f64 {
    let error = |(datum, k): (&super::Datum, &usize)| {
        computed.levels[*k]
            .as_ref()
            .map_or(f64::INFINITY, |l| (l.frequency_hz / datum.frequency_hz - 1.0).abs())
    };
    problem.data.iter().zip(assignment).map(error).fold(0.0, f64::max)
}

/// The least MAC of a measured shape with its level; none without shapes.
fn least_likeness(problem: &Problem, assignment: &[usize], computed: &Computed) -> Option<f64> {
    let each = problem.data.iter().zip(assignment).filter_map(|(datum, k)| {
        let (shape, level) = (datum.shape.as_ref()?, computed.levels[*k].as_ref());
        Some(level.and_then(|level| level.span.as_ref()).map_or(0.0, |span| span.likeness(shape)))
    });
    each.reduce(f64::min)
}

/// Fits all data but one, each in turn, and predicts that one. Nothing where the others are fewer than the unknowns: what
/// they leave open would stay where the fit of all data put it.
fn leave_one_out(
    model: &dyn Model,
    problem: &Problem,
    best: &Ranked,
    observer: &dyn Observer,
) -> Result<Vec<LeftOut>> {
    if problem.degrees_of_freedom(&best.assignment, &best.fit.computed) == 0 {
        return Ok(Vec::new());
    }
    let n = problem.data.len();
    observer.begin("leaving data out", Some(n as u64));
    let without = |out: usize| -> Result<LeftOut> {
        let (mut others, mut assignment) = (problem.clone(), best.assignment.clone());
        others.data.remove(out);
        assignment.remove(out);
        let found = fit(model, &others, &assignment, (&best.fit.x, &best.fit.computed))?;
        observer.advance(1);
        let level = found.computed.levels[best.assignment[out]].as_ref();
        let known = misfit(&others, &assignment, &found.x, &found.computed).is_finite();
        let datum = &problem.data[out];
        let told = |level: &Level, what: usize| {
            known && left_open(&others, &assignment, &found.computed, (datum, level))[what] <= 1.0
        };
        let likeness = |level: &Level| Some(level.span.as_ref()?.likeness(datum.shape.as_ref()?));
        Ok(LeftOut {
            predicted_hz: level.filter(|level| told(level, 0)).map(|level| level.frequency_hz),
            likeness: level.filter(|level| told(level, 1)).and_then(likeness),
            converged: found.converged,
            x: found.x,
        })
    };
    let left_out = (0..n).into_par_iter().map(without).collect();
    observer.end();
    left_out
}

fn nothing_near(problem: &Problem, plausible: &[Vec<usize>], reach: f64) -> Error {
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

    const ALL: Options = Options { reach: 0.2, leave_one_out: true, chance_draws: 200, trials: 20 };

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
        assert!(best.assignment == chosen && best.fit.converged && best.largest_error < 2e-3);
        assert!(found.plausible > 50 && found.all_counted && found.all_searched);
        assert!(best.weight == 1.0 && found.ranked[1..].iter().all(|other| other.weight < 1e-3));
        let inside = |j: usize| {
            let [low, high] = found.knowledge.intervals[j];
            low <= truth[j] && truth[j] <= high
        };
        assert!(inside(0) && inside(1), "{:?}", found.knowledge);
        for (left, y) in found.left_out.iter().zip(&data) {
            assert!((left.predicted_hz.unwrap() / y - 1.0).abs() < 0.01);
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
        assert!(found.left_out.is_empty() && found.knowledge.reduced_chi2.is_none());
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
        let options = Options { reach: 0.02, chance_draws: 0, trials: 0, ..ALL };
        let found = calibrate(&model, &problem, &[0.0; 2], &options, &()).unwrap();
        assert_eq!(found.best().assignment, [0, 1, 2, 3]);
        let told: Vec<bool> = found.left_out.iter().map(|left| left.predicted_hz.is_some()).collect();
        assert_eq!(told, [true, true, true, false]);
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
