//! Answers at the points of a grid: one axis of a sweep, two of a map. They are independent of each other, so that several
//! processes can share them; [`answer`] computes one, and [`Answered`] gives those that are known instead of computing them again.

use super::{Axis, Checked, Modes, SweepProblem};
use crate::error::Result;
use crate::linalg::c64;
use crate::progress::Observer;
use faer::Mat;
use rayon::prelude::*;
use std::collections::{BTreeMap, HashMap};

/// Points that are computed and recorded together.
pub(super) const CHUNK: usize = 32;

/// The modes at points of a grid, or why there are none, by the number of the point.
pub type Answers = BTreeMap<usize, Result<Modes>>;

/// Number of points of the grid of these axes.
pub fn points(axes: &[Axis]) -> usize {
    axes.iter().map(|axis| axis.points).product()
}

/// Values of the parameters at point `k` of the grid of these axes; the first runs fastest.
pub fn place(axes: &[Axis], k: usize) -> Vec<f64> {
    let mut rest = k;
    let value = |axis: &Axis| {
        let value = axis.value(rest % axis.points);
        rest /= axis.points;
        value
    };
    axes.iter().map(value).collect()
}

/// The modes at point `k` of the grid of these axes: with their shapes in a sweep, λ alone in a map.
///
/// # Errors
/// A place without an answer.
pub fn answer(problem: &dyn SweepProblem, axes: &[Axis], k: usize) -> Result<Modes> {
    let at = place(axes, k);
    if let [_] = axes {
        return problem.modes(&at);
    }
    let eigenvalues = problem.eigenvalues(&at)?;
    Ok(Modes { vectors: Mat::zeros(0, eigenvalues.len()), eigenvalues })
}

/// The answers at the points `wanted` of a grid, handed to `keep` as soon as they are there: one by one, or in chunks where several
/// are computed at once.
///
/// # Errors
/// Those of `keep`.
pub fn answers(
    problem: &dyn SweepProblem,
    axes: &[Axis],
    wanted: &[usize],
    keep: &mut dyn FnMut(Answers) -> Result<()>,
    observer: &dyn Observer,
) -> Result<()> {
    observer.begin("points", Some(wanted.len() as u64));
    let solve = |k: &usize| {
        let found = answer(problem, axes, *k);
        observer.advance(1);
        (*k, found)
    };
    for chunk in wanted.chunks(if problem.parallel() { CHUNK } else { 1 }) {
        keep(chunk.par_iter().map(solve).collect())?;
    }
    observer.end();
    Ok(())
}

/// A problem of which answers are known at points of a grid.
pub struct Answered<'a> {
    problem: &'a dyn SweepProblem,
    /// By the bits of the values at the point.
    known: HashMap<Vec<u64>, &'a Result<Modes>>,
}

impl<'a> Answered<'a> {
    /// With `answers` at points of the grid of these axes.
    pub fn new<'b: 'a>(
        problem: &'a dyn SweepProblem,
        axes: &[Axis],
        answers: impl Iterator<Item = (usize, &'b Result<Modes>)>,
    ) -> Self {
        Answered { problem, known: answers.map(|(k, answer)| (bits(&place(axes, k)), answer)).collect() }
    }

    fn at(&self, at: &[f64]) -> Option<&'a Result<Modes>> {
        self.known.get(&bits(at)).copied()
    }
}

fn bits(at: &[f64]) -> Vec<u64> {
    at.iter().map(|value| value.to_bits()).collect()
}

impl SweepProblem for Answered<'_> {
    fn modes(&self, at: &[f64]) -> Result<Modes> {
        self.at(at).map_or_else(|| self.problem.modes(at), Clone::clone)
    }

    fn eigenvalues(&self, at: &[f64]) -> Result<Vec<c64>> {
        match self.at(at) {
            Some(Ok(modes)) => Ok(modes.eigenvalues.clone()),
            Some(Err(error)) => Err(error.clone()),
            None => self.problem.eigenvalues(at),
        }
    }

    fn check(&self, at: &[f64]) -> Result<Vec<Checked>> {
        self.problem.check(at)
    }

    fn check_nearest(&self, at: &[f64], near: c64) -> Result<Option<Checked>> {
        self.problem.check_nearest(at, near)
    }

    fn parallel(&self) -> bool {
        self.problem.parallel()
    }
}
