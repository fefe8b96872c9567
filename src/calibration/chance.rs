//! How often as good a match arises by chance.

use super::assignments;
use super::linear::Linear;
use super::problem::Datum;
use crate::linalg::random::Random;
use rayon::prelude::*;

/// How often measured frequencies that mean nothing match as well.
///
/// Each draw replaces the measured frequencies of every set by as many that are log-uniform between the lowest and the
/// highest of them, and fits the unknowns to them with the best assignment, on the model linearised at the calibrated values.
/// Frequencies that no level can reach are no match.
///
/// It is about the frequencies alone: shapes and responses take no part in it, on either side. A response is compared line by
/// line and not matched with one of many, so that there is nothing that chance could hit. The assignment of the data is the one
/// that all of them chose, which has no smaller χ² of its frequencies than their own best one: the share by χ² is not stated too
/// small for that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chance {
    /// How many draws.
    pub draws: usize,
    /// Those whose largest relative error is as small as that of the data.
    pub by_error: usize,
    /// Those whose χ² is as small as that of the data.
    pub by_chi2: usize,
}

impl Chance {
    /// (k + 1)/(n + 1): the data count as one draw, so that the probability is never underestimated (Davison and Hinkley,
    /// Bootstrap Methods, 1997, eq. 4.11).
    pub fn probability(&self, as_good: usize) -> f64 {
        (as_good + 1) as f64 / (self.draws + 1) as f64
    }

    /// Draws, and compares with the data at their own χ² and largest error. The problem has no shapes.
    pub(super) fn new(
        linear: &Linear,
        reach: f64,
        draws: usize,
        (chi2, largest_error): (f64, f64),
    ) -> Chance {
        let problem = linear.problem;
        let spans: Vec<[f64; 2]> = problem.data.iter().map(|datum| span(&problem.data, datum.set)).collect();
        let mut random = Random::new();
        let mut drawn = || -> Vec<Datum> {
            let each = problem.data.iter().zip(&spans);
            each.map(|(datum, [low, high])| {
                let part = 0.5 * (random.next() + 1.0);
                Datum { frequency_hz: (low + part * (high - low)).exp(), ..datum.clone() }
            })
            .collect()
        };
        let sets: Vec<Vec<Datum>> = (0..draws).map(|_| drawn()).collect();
        let as_good = |data: &Vec<Datum>| -> [usize; 2] {
            let plausible: Vec<Vec<usize>> = data.iter().map(|d| linear.plausible(d, reach)).collect();
            let found = assignments::best(linear, data, &plausible, 1);
            let Some((least, assignment)) = found.best.first() else { return [0, 0] };
            let misfit = linear.misfit(data, assignment);
            let error = linear.largest_error(data, assignment, &linear.least(&misfit).1);
            [usize::from(error <= largest_error), usize::from(*least <= chi2)]
        };
        let counted: Vec<[usize; 2]> = sets.par_iter().map(as_good).collect();
        let total = |k: usize| counted.iter().map(|c| c[k]).sum();
        Chance { draws, by_error: total(0), by_chi2: total(1) }
    }
}

/// ln of the lowest and of the highest measured frequency of a set.
fn span(data: &[Datum], set: usize) -> [f64; 2] {
    let of = || data.iter().filter(|datum| datum.set == set).map(|datum| datum.frequency_hz.ln());
    [of().fold(f64::INFINITY, f64::min), of().fold(f64::NEG_INFINITY, f64::max)]
}

#[cfg(test)]
mod tests {
    use super::super::samples::level;
    use super::super::{CalibrationProblem, Level, Unknown};
    use super::*;
    use crate::bounds::{Origin::*, within};

    /// Levels a fixed ratio apart and no free unknown: what chance does is known.
    #[test]
    fn rigid_levels_are_matched_as_often_as_geometry_says() {
        // Levels at 1, e^0.1, …; a drawn frequency lies within ±1 % of one of them in a share 0.2 of all cases.
        let levels: Vec<Option<Level>> =
            (0..11).map(|k| Some(level(100.0 * (0.1 * f64::from(k)).exp(), vec![0.0]))).collect();
        let datum = |f: f64| Datum { set: 0, frequency_hz: f, deviation: 0.01, shape: None };
        let problem = CalibrationProblem {
            unknowns: vec![Unknown { bounds: [-1.0, 1.0], expected: None }],
            data: vec![datum(100.0), datum(100.0 * 1.0f64.exp())],
            level_sets: vec![0; 11],
            level_modes: vec![1; 11],
            curves: Vec::new(),
        };
        let linear = Linear::new(&problem, &[0.0], &levels);
        let chance = Chance::new(&linear, 0.2, 4000, (1.0, 0.01));
        // Both near different levels: 0.2² × 9/10 or so; the two may not share a level.
        let share = chance.by_error as f64 / 4000.0;
        assert!(within((share - 0.2 * 0.2 * 0.9).abs(), 0.012, RandomSample), "{share}");
        // χ² ≤ 1: a circle of 1 % in the square of ±1 %, π/4 of it.
        let share = chance.by_chi2 as f64 / 4000.0;
        assert!(within((share - 0.2 * 0.2 * 0.9 * 0.785).abs(), 0.012, RandomSample), "{share}");
        assert!(chance.probability(0) > 0.0);
    }
}
