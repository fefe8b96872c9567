//! Solver of the equations of a step.

use super::state::State;
use faer::Mat;
use std::fmt::Debug;

/// Newton's iterations of one step.
pub(super) const ITERATIONS: usize = 40;
/// Steps of Newton's method below this part of the motion are round-off.
pub(super) const ROUND_OFF: f64 = 1e-14;
/// The part of the largest contact force by which friction may differ from what its law answers to it.
pub(super) const UNMATCHED: f64 = 1e-10;

/// Why a step has no solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum StepFailure {
    /// Newton's method did not converge.
    Newton {
        /// The length of its last step \[m\].
        length: f64,
        /// The contact point that it moved most, if any.
        point: Option<usize>,
    },
    /// A number that is not finite.
    NotFinite,
}

/// Solves A Δ + b D r_{n+1} = h.
pub(super) trait Solver: Debug {
    /// Replaces `h` + B `modal` by Δ and `modal` by BᵀΔ; leaves r_{n+1} in `to`.
    fn increment(
        &mut self,
        h: &mut Mat<f64>,
        modal: &mut Mat<f64>,
        from: &State,
        to: &mut State,
    ) -> std::result::Result<(), StepFailure>;
}
