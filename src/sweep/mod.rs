//! How the complex modes change with one or two scalars: branches, critical values, maps, the boundary of stability.
//!
//! * [`sweep`] follows every mode along one parameter by its shape, through crossings, and *locates* the values at which
//!   one becomes unstable or stable.
//! * [`map`] solves a grid over two parameters; [`boundary`] locates the line on which the largest growth is zero.
//! * [`sampled`] solves places that are given one by one, each mode paired with one of a reference.
//! * [`blocks`] cut both so that several processes share them; [`Answered`] keeps their answers.
//!
//! All of them take a [`SweepProblem`]: a reduced family or whole analyses, they do not know which.

mod answers;
mod assign;
mod at_once;
mod blocks;
mod boundary;
mod branch;
mod critical;
mod interaction;
mod map;
#[cfg(test)]
mod onset_tests;
mod points;
mod root;
#[cfg(test)]
mod root_order_tests;
mod rounding;
mod sampled;
#[cfg(test)]
mod tests;
mod track;

pub use answers::{AnswerStore, Answered, answer, bits, place, points};
pub use at_once::AtOnce;
pub use blocks::{Block, blocks};
pub use boundary::{Boundary, boundary};
pub use branch::Branch;
pub use critical::{Critical, CriticalKind};
pub use interaction::{Interaction, InteractionKind};
pub use map::{MapPoint, map};
pub use points::{Filled, RecordPoints, Unanswered, reasoned};
pub use sampled::{Paired, SampleModes, sampled};
pub use track::{Sweep, sweep};

use crate::error::Result;
use crate::linalg::c64;
use crate::stability::unstable;
use faer::Mat;

/// Parametric eigenvalue problem of a sweep: the complex modes at a place of its parameters.
pub trait SweepProblem: Sync {
    /// The modes at `at`, one value a parameter.
    ///
    /// # Errors
    /// A place without an answer, such as a contact that opens.
    fn modes(&self, at: &[f64]) -> Result<Modes>;

    /// λ of the modes at `at` alone, in any order.
    ///
    /// # Errors
    /// As [`SweepProblem::modes`].
    fn eigenvalues(&self, at: &[f64]) -> Result<Vec<c64>> {
        Ok(self.modes(at)?.eigenvalues)
    }

    /// The solutions between the points of an axis that each search may take at most: for branches, critical values, interactions. A
    /// number, and no time, so that the results are the same on every machine.
    fn solutions_between(&self, points: usize) -> usize {
        4000 + 20 * points
    }

    /// How many places are solved at once.
    fn at_once(&self) -> AtOnce {
        AtOnce::Shared
    }
}

/// A problem whose modes can be measured on the full order.
pub trait MeasuredProblem: SweepProblem {
    /// The modes at `at` with their errors on the full order.
    ///
    /// # Errors
    /// As [`SweepProblem::modes`].
    fn check(&self, at: &[f64]) -> Result<Vec<Checked>>;

    /// The mode at `at` that is nearest to λ = `near`, with its error on the full order.
    ///
    /// # Errors
    /// As [`SweepProblem::modes`].
    fn check_nearest(&self, at: &[f64], near: c64) -> Result<Option<Checked>> {
        let far = |mode: &Checked| (mode.eigenvalue - near).norm();
        Ok(self.check(at)?.into_iter().min_by(|a, b| far(a).total_cmp(&far(b))))
    }
}

/// The complex modes at one place, one of each conjugate pair.
#[derive(Debug, Clone)]
pub struct Modes {
    /// λ = σ + iω \[1/s\].
    pub eigenvalues: Vec<c64>,
    /// Their shapes, one a column, in coordinates in which MAC is the plain scalar product (the mass matrix is
    /// one); without rows when shapes at two places cannot be compared.
    pub vectors: Mat<c64>,
}

/// A mode measured on the full order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Checked {
    /// λ \[1/s\].
    pub eigenvalue: c64,
    /// η as in [`crate::stability::ComplexMode`].
    pub backward_error: f64,
    /// Estimated |Δλ|/|λ|.
    pub eigenvalue_error: f64,
}

/// The values that a parameter takes: equal steps, or equal ratios when `log`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// First value.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// How many values, at least two.
    pub points: usize,
    /// Equal ratios; both ends have the same sign and are not zero.
    pub log: bool,
}

impl Axis {
    /// Value `k` of [`Axis::points`].
    pub fn value(&self, k: usize) -> f64 {
        match k {
            0 => self.from,
            k if k + 1 >= self.points => self.to,
            k => self.between(self.from, self.to, k as f64 / (self.points - 1) as f64),
        }
    }

    /// All values.
    pub fn values(&self) -> Vec<f64> {
        (0..self.points).map(|k| self.value(k)).collect()
    }

    /// The value a fraction `t` of the way from `a` to `b`.
    pub(crate) fn between(&self, a: f64, b: f64, t: f64) -> f64 {
        if self.log { a * (b / a).powf(t) } else { a + t * (b - a) }
    }
}

impl Modes {
    /// What rounding may leave of σ of mode `k` \[1/s\].
    fn rounding(&self, k: usize) -> f64 {
        rounding::rounding(&self.eigenvalues, &self.vectors, k)
    }

    /// Column `k` of the shapes.
    fn vector(&self, k: usize) -> &[c64] {
        self.vectors.col_as_slice(k)
    }
}
