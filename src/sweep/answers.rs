//! Answers of a problem at the places that a sweep or a map asks for, kept so that several processes can share them: [`answer`]
//! computes one at a point of a grid, [`Answered`] keeps each and gives it instead of computing it again.

use super::{AtOnce, Axis, Modes, SweepProblem};
use crate::error::Result;
use crate::linalg::c64;
use faer::Mat;

/// Answers that are known.
pub trait AnswerStore: Sync {
    /// The answer at a place, given by the bits of the values there.
    fn find(&self, place: &[u64]) -> Option<Result<Modes>>;

    /// Takes an answer that was computed.
    ///
    /// # Errors
    /// A store that cannot be written.
    fn keep(&self, place: Vec<u64>, answer: &Result<Modes>) -> Result<()>;
}

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

/// The bits of values.
pub fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// The modes at point `k` of the grid of these axes: with their shapes in a sweep, λ alone in a map.
///
/// # Errors
/// A place without an answer.
pub fn answer(problem: &dyn SweepProblem, axes: &[Axis], k: usize) -> Result<Modes> {
    let at = place(axes, k);
    match axes {
        [_] => problem.modes(&at),
        _ => problem.eigenvalues(&at).map(alone),
    }
}

/// Eigenvalues without their shapes.
fn alone(eigenvalues: Vec<c64>) -> Modes {
    Modes { vectors: Mat::zeros(0, eigenvalues.len()), eigenvalues }
}

/// A problem with a store of its answers: those of a sweep, which asks for modes, or of a map, which asks for eigenvalues alone.
pub struct Answered<'a> {
    problem: &'a dyn SweepProblem,
    store: &'a dyn AnswerStore,
}

impl<'a> Answered<'a> {
    /// The answers of `problem` are in `store`, or put there.
    pub fn new(problem: &'a dyn SweepProblem, store: &'a dyn AnswerStore) -> Self {
        Answered { problem, store }
    }

    fn answer(&self, at: &[f64], compute: impl FnOnce() -> Result<Modes>) -> Result<Modes> {
        let place = bits(at);
        if let Some(known) = self.store.find(&place) {
            return known;
        }
        let answer = compute();
        self.store.keep(place, &answer)?;
        answer
    }
}

impl SweepProblem for Answered<'_> {
    fn modes(&self, at: &[f64]) -> Result<Modes> {
        self.answer(at, || self.problem.modes(at))
    }

    fn eigenvalues(&self, at: &[f64]) -> Result<Vec<c64>> {
        let modes = self.answer(at, || self.problem.eigenvalues(at).map(alone))?;
        Ok(modes.eigenvalues)
    }

    fn solutions_between(&self, points: usize) -> usize {
        self.problem.solutions_between(points)
    }

    fn at_once(&self) -> AtOnce {
        self.problem.at_once()
    }
}
