//! A mode along one parameter.

use super::Modes;
use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::stability::unstable;
use faer::Mat;

/// One mode followed along the parameter.
#[derive(Debug, Clone)]
pub struct Branch {
    /// Index of its first value in [`super::Sweep::values`].
    pub first: usize,
    /// λ at that value and those after it.
    pub eigenvalues: Vec<c64>,
    /// The least MAC of its shapes at two neighbouring values; 1 for a single value.
    pub lowest_mac: f64,
    /// Its place among the modes of each of its values.
    pub(crate) places: Vec<usize>,
    /// What rounding may leave of σ at each of its values \[1/s\].
    pub(crate) rounding: Vec<f64>,
}

impl Branch {
    /// λ at value `k` of [`super::Sweep::values`], where the branch exists.
    pub fn at(&self, k: usize) -> Option<c64> {
        k.checked_sub(self.first).and_then(|k| self.eigenvalues.get(k)).copied()
    }

    /// Whether the mode grows, by more than rounding, at each of its values.
    pub fn growing(&self) -> impl DoubleEndedIterator<Item = bool> + '_ {
        self.eigenvalues.iter().zip(&self.rounding).map(|(z, rounding)| unstable(*z) && z.re > *rounding)
    }

    /// The place of the branch among the modes at value `k`.
    pub(super) fn place(&self, k: usize) -> Option<usize> {
        k.checked_sub(self.first).and_then(|k| self.places.get(k)).copied()
    }
}

/// The modes at one value; none where it has no answer.
pub(super) struct Sample {
    pub(super) value: f64,
    pub(super) modes: Modes,
    /// Why it has no answer.
    pub(super) why_none: Option<Error>,
}

impl Sample {
    pub(super) fn new(value: f64, answer: Result<Modes>) -> Self {
        let none = Modes { eigenvalues: Vec::new(), vectors: Mat::new() };
        match answer {
            Ok(modes) => Sample { value, modes, why_none: None },
            Err(why) => Sample { value, modes: none, why_none: Some(why) },
        }
    }
}
