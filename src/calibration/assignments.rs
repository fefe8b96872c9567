//! Which measured frequency is which level: the best assignments of all, by branch and bound on the linearised misfit.
//!
//! The least χ² of some of the data bounds that of all of them from below, so that a branch that is worse already than the
//! last of the best needs no further look (Land and Doig, Econometrica 28 (1960) 497).

use super::linear::{Linear, Misfit};
use super::problem::{CalibrationProblem, Datum};

/// More fits than this are not tried.
const MOST_FITS: usize = 2_000_000;
/// More assignments than this are not counted one by one.
const MOST_COUNTED: usize = 1_000_000;

/// Two data whose frequencies differ by less than this part may be the two modes of a double level that a test found parted.
const PARTED: f64 = 0.02;

/// The best assignments.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FoundAssignments {
    /// χ² and the level of each datum, the best first.
    pub best: Vec<(f64, Vec<usize>)>,
    /// Whether no better one can be: false when the search was cut.
    pub complete: bool,
}

/// The `keep` assignments with the least linearised χ², each level taken once, or by so many neighbouring data as it has
/// modes; `plausible` lists the levels that each datum
/// may be.
pub(super) fn best(
    linear: &Linear,
    data: &[Datum],
    plausible: &[Vec<usize>],
    keep: usize,
) -> FoundAssignments {
    // The data with the fewest choices first: their branches are few, and bound the others.
    let mut order: Vec<usize> = (0..data.len()).collect();
    order.sort_by_key(|i| plausible[*i].len());
    let mut search = AssignmentSearch {
        linear,
        data,
        plausible,
        order,
        keep,
        fits: 0,
        chosen: vec![usize::MAX; data.len()],
        best: Vec::new(),
    };
    search.descend(0, &linear.expected(), 0.0);
    FoundAssignments { best: search.best, complete: search.fits <= MOST_FITS }
}

/// Number of assignments, at most [`MOST_COUNTED`], and whether that is all.
pub(super) fn count(problem: &CalibrationProblem, plausible: &[Vec<usize>]) -> (usize, bool) {
    fn descend(
        problem: &CalibrationProblem,
        plausible: &[Vec<usize>],
        taken: &mut Vec<usize>,
        counted: &mut usize,
    ) {
        let Some(choices) = plausible.get(taken.len()) else {
            *counted += 1;
            return;
        };
        for k in choices {
            if *counted < MOST_COUNTED && free(problem, &problem.data, taken, taken.len(), *k) {
                taken.push(*k);
                descend(problem, plausible, taken, counted);
                taken.pop();
            }
        }
    }
    let mut counted = 0;
    descend(problem, plausible, &mut Vec::new(), &mut counted);
    (counted, counted < MOST_COUNTED)
}

/// Whether `level` is free for `datum` when the data took the levels `chosen`.
fn free(problem: &CalibrationProblem, data: &[Datum], chosen: &[usize], datum: usize, level: usize) -> bool {
    let others = || (0..chosen.len()).filter(|i| chosen[*i] == level);
    let near = |i: usize| (data[i].frequency_hz / data[datum].frequency_hz).ln().abs() < PARTED;
    others().count() < problem.level_modes[level] && others().all(near)
}

struct AssignmentSearch<'a> {
    linear: &'a Linear<'a>,
    data: &'a [Datum],
    plausible: &'a [Vec<usize>],
    order: Vec<usize>,
    keep: usize,
    fits: usize,
    chosen: Vec<usize>,
    best: Vec<(f64, Vec<usize>)>,
}

impl AssignmentSearch<'_> {
    fn hopeless(&self, chi2: f64) -> bool {
        self.best.len() == self.keep && self.best.last().is_some_and(|(worst, _)| chi2 >= *worst)
    }

    fn descend(&mut self, depth: usize, misfit: &Misfit, chi2: f64) {
        let Some(&datum) = self.order.get(depth) else {
            let place = self.best.partition_point(|(known, _)| *known <= chi2);
            self.best.insert(place, (chi2, self.chosen.clone()));
            self.best.truncate(self.keep);
            return;
        };
        let free = |k: &&usize| free(self.linear.problem, self.data, &self.chosen, datum, **k);
        let mut branches: Vec<(f64, usize, Misfit)> = self.plausible[datum]
            .iter()
            .filter(free)
            .map(|k| {
                let more = self.linear.with(misfit, (self.data, datum), *k);
                (self.linear.least(&more).0, *k, more)
            })
            .collect();
        self.fits += branches.len();
        branches.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (chi2, level, more) in branches {
            if self.fits > MOST_FITS || self.hopeless(chi2) {
                break;
            }
            self.chosen[datum] = level;
            self.descend(depth + 1, &more, chi2);
            self.chosen[datum] = usize::MAX;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::{Powers, problem};
    use super::super::{CalibrationModel, CalibrationProblem};
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn branch_and_bound_finds_what_trying_all_finds() {
        let model = Powers::new(8, 2, 4);
        let data = [310.0, 520.0, 640.0, 1010.0];
        let problem: CalibrationProblem = problem(&model, &data, 0.01);
        let x = [0.1, -0.2];
        let levels = model.compute(&x).unwrap().levels;
        let linear = Linear::new(&problem, &x, &levels);
        let plausible: Vec<Vec<usize>> = problem.data.iter().map(|d| linear.plausible(d, 0.3)).collect();
        let found = best(&linear, &problem.data, &plausible, 5);
        let mut all = Vec::new();
        for a in &plausible[0] {
            for b in &plausible[1] {
                for c in &plausible[2] {
                    for d in &plausible[3] {
                        let chosen = [*a, *b, *c, *d];
                        if (0..4).any(|i| (0..i).any(|j| chosen[i] == chosen[j])) {
                            continue;
                        }
                        let misfit = linear.misfit(&problem.data, &chosen);
                        all.push((linear.least(&misfit).0, chosen.to_vec()));
                    }
                }
            }
        }
        assert_eq!(count(&problem, &plausible), (all.len(), true));
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert!(found.complete && all.len() > 20, "{}", all.len());
        for (found, expected) in found.best.iter().zip(&all) {
            assert!(
                within((found.0 - expected.0).abs(), 1e-6 * (1.0 + expected.0), RoundOff)
                    && found.1 == expected.1
            );
        }
    }
}
