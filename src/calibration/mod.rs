//! Scalars of a model found from measured frequencies, and what the agreement is worth.
//!
//! Unknowns x and computed frequencies f(x), *levels* (a mode, or a double pair), stand against measured ones y. With an
//! assignment a of measured frequencies to levels, the residuals are
//!
//!   r_i = ln(f_a(i)(x) / y_i) / s_i   and, where something was known before,   r_j = x_j − x̄_j,
//!
//! χ² = Σ r² is least inside the bounds. Every unknown is measured in its own unit: the standard deviation of what was
//! known before, or half the width of its bounds where nothing was (Mottershead and Friswell, J. Sound Vib. 167 (1993) 347).
//!
//! 1. [`calibrate`] tries every plausible assignment on the model linearised at the start, by branch and bound,
//! 2. fits the best of them to the model itself ([`fit()`]),
//! 3. asks what the data determine ([`Knowledge`]), predicts each datum from the others ([`LeftOut`]), counts how often as
//!    good a match arises by chance ([`Chance`]) and whether its own intervals hold the truth ([`Trials`]).
//!
//! The room knows no mechanics: a [`Model`] gives levels with their slopes.

mod assignments;
mod calibrate;
mod chance;
mod fit;
mod knowledge;
mod linear;
mod nearby;
mod quadratic;
#[cfg(test)]
mod samples;
mod trials;

pub use calibrate::{Calibration, LeftOut, Options, Ranked, calibrate};
pub use chance::Chance;
pub use fit::{Fit, fit};
pub use knowledge::{Interval, Knowledge};
pub use trials::Trials;

use crate::error::Result;

/// Computed frequencies as functions of the unknowns.
pub trait Model: Sync {
    /// Every level at `x`, in the same order for every `x`; `None` where a level is not found.
    ///
    /// # Errors
    /// A model that cannot be computed at `x`.
    fn levels(&self, x: &[f64]) -> Result<Levels>;
}

/// The levels of a model at one place; `None` where one is not found.
pub type Levels = Vec<Option<Level>>;

/// A computed frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// f \[Hz\].
    pub frequency_hz: f64,
    /// ∂ ln f/∂x_j.
    pub slope: Vec<f64>,
    /// Of a double level: the two frequencies part with ∂ ln f/∂x_j = slope ± split.
    pub split: Vec<f64>,
}

/// A measured frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Datum {
    /// It is one of the levels of this set.
    pub set: usize,
    /// y \[Hz\].
    pub frequency_hz: f64,
    /// s: relative standard deviation of y.
    pub deviation: f64,
}

/// An unknown x_j, in a unit in which what was known before has the standard deviation 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unknown {
    /// The least and the largest value.
    pub bounds: [f64; 2],
    /// x̄_j: what was expected; none where every value inside the bounds is as good.
    pub expected: Option<f64>,
}

/// Unknowns and what was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// The unknowns.
    pub unknowns: Vec<Unknown>,
    /// What was measured.
    pub data: Vec<Datum>,
    /// The set that each level of the model belongs to.
    pub level_sets: Vec<usize>,
}

impl Problem {
    /// Measured frequencies and expectations.
    pub fn n_facts(&self) -> usize {
        self.data.len() + self.unknowns.iter().filter(|u| u.expected.is_some()).count()
    }

    /// Facts beyond the number of unknowns; none when there are no more.
    pub fn degrees_of_freedom(&self) -> usize {
        self.n_facts().saturating_sub(self.unknowns.len())
    }

    /// `x` moved inside the bounds.
    fn inside(&self, x: &[f64]) -> Vec<f64> {
        x.iter().zip(&self.unknowns).map(|(x, u)| x.clamp(u.bounds[0], u.bounds[1])).collect()
    }
}
