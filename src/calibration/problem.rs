//! Unknowns, what was measured, and the model that computes it.

use super::span::Span;
use crate::error::Result;
use std::ops::Range;
use std::sync::Arc;

/// Computed levels and lines as a function of the unknowns.
pub trait CalibrationModel: Sync {
    /// Every level and line at `x`, in the same order for every `x`.
    ///
    /// # Errors
    /// A model that cannot be computed at `x`.
    fn compute(&self, x: &[f64]) -> Result<Computed>;

    /// The levels; lines need not be there.
    ///
    /// # Errors
    /// As [`compute`](CalibrationModel::compute).
    fn levels(&self, x: &[f64]) -> Result<Computed> {
        self.compute(x)
    }
}

/// Levels and lines of a model at one place.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Computed {
    /// The levels; `None` where one is not found.
    pub levels: Vec<Option<Level>>,
    /// The lines of its frequency responses.
    pub lines: Vec<ResponseLine>,
}

/// A frequency response at one frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct ResponseLine {
    /// Its logarithm.
    pub value: f64,
    /// ∂value/∂x_j.
    pub slope: Vec<f64>,
}

/// A computed frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// f \[Hz\].
    pub frequency_hz: f64,
    /// ∂ ln f/∂x_j.
    pub slope: Vec<f64>,
    /// Of a double level: the two frequencies part with ∂ ln f/∂x_j = slope ± split.
    pub split: Vec<f64>,
    /// Its motions where shapes were measured; none where no measured shape is like them.
    pub span: Option<Span>,
}

/// A measured frequency, and a shape if one was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Datum {
    /// It is one of the levels of this set.
    pub set: usize,
    /// y \[Hz\].
    pub frequency_hz: f64,
    /// s: relative standard deviation of y.
    pub deviation: f64,
    /// ψ, in standard deviations of one of its components.
    pub shape: Option<Arc<[f64]>>,
}

/// A measured frequency response.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Where its lines begin among the computed ones.
    pub first: usize,
    /// Its logarithm at each.
    pub values: Vec<f64>,
    /// Standard deviation of that.
    pub deviation: f64,
}

impl Curve {
    /// Its lines among the computed ones.
    pub fn lines(&self) -> Range<usize> {
        self.first..self.first + self.values.len()
    }
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
pub struct CalibrationProblem {
    /// The unknowns.
    pub unknowns: Vec<Unknown>,
    /// Measured modes.
    pub data: Vec<Datum>,
    /// The set that each level of the model belongs to.
    pub level_sets: Vec<usize>,
    /// How many modes each level has: so many data may be that level.
    pub level_modes: Vec<usize>,
    /// The measured frequency responses.
    pub curves: Vec<Curve>,
}

impl CalibrationProblem {
    /// Levels and, where responses were measured, lines of `model` at `x`.
    pub(super) fn compute(&self, model: &dyn CalibrationModel, x: &[f64]) -> Result<Computed> {
        if self.curves.is_empty() { model.levels(x) } else { model.compute(x) }
    }

    /// The same without responses.
    pub(super) fn modes_alone(&self) -> CalibrationProblem {
        CalibrationProblem { curves: Vec::new(), ..self.clone() }
    }

    /// The same without shapes and responses.
    pub(super) fn frequencies_alone(&self) -> CalibrationProblem {
        let data = self.data.iter().map(|datum| Datum { shape: None, ..datum.clone() }).collect();
        CalibrationProblem { data, ..self.modes_alone() }
    }

    /// `x` moved inside the bounds.
    pub(super) fn inside(&self, x: &[f64]) -> Vec<f64> {
        x.iter().zip(&self.unknowns).map(|(x, u)| x.clamp(u.bounds[0], u.bounds[1])).collect()
    }
}
