//! Scalars of a model found from measured frequencies, shapes and frequency responses, and what the agreement is worth.
//!
//! Unknowns x and computed frequencies f(x), *levels* (a mode, or a double pair), stand against measured ones y. With an
//! assignment a of measured frequencies to levels, the residuals are
//!
//!   r_i = ln(f_a(i)(x) / y_i) / s_i   and, where something was known before,   r_j = x_j − x̄_j,
//!
//! and beside each measured shape ψ, in standard deviations of a component, (I − P)ψ with the orthogonal projection P on the
//! motions that the level makes where ψ was measured ([`Span`]): m components less a scale factor for each mode of the level.
//!
//! Beside each line of a measured frequency response its logarithm less the measured one, over its standard deviation (Grafe,
//! Model Updating of Large Structural Dynamics Models Using Measured Response Functions, thesis, Imperial College 1998), which
//! needs no assignment.
//!
//! χ² = Σ r² is least inside the bounds. Every unknown is measured in its own unit: the standard deviation of what was
//! known before, or half the width of its bounds where nothing was (Mottershead and Friswell, J. Sound Vib. 167 (1993) 347).
//!
//! 1. [`calibrate`] tries every plausible assignment on the model linearised at the start, by branch and bound,
//! 2. fits the best of them to the model itself ([`fit()`]), to the modes first where there are responses, and ranks them by the
//!    whole χ² ([`Ranked`]),
//! 3. asks what the data determine ([`Knowledge`]), predicts each datum and each response from all others ([`LeftOut`]), counts
//!    how often frequencies match as well by chance ([`Chance`]) and whether its own intervals hold the truth ([`Trials`]).
//!
//! This module is independent of mechanics: a [`CalibrationModel`] gives levels with their derivatives.

mod assignments;
mod calibrate;
mod chance;
mod fit;
mod knowledge;
mod left_out;
mod linear;
mod nearby;
mod problem;
mod quadratic;
mod ranked;
mod residuals;
#[cfg(test)]
mod samples;
mod span;
mod svd;
mod trials;

pub use calibrate::{Calibration, CalibrationOptions, calibrate};
pub use chance::Chance;
pub use fit::{Fit, fit};
pub use knowledge::{Interval, Knowledge};
pub use left_out::{LeftOut, LeftOutCurve, LeftOutDatum};
pub use linear::LIKE;
pub use problem::{
    CalibrationModel, CalibrationProblem, Computed, Curve, Datum, Level, ResponseLine, Unknown,
};
pub use ranked::Ranked;
pub use span::{Apart, Span};
pub use trials::Trials;
