//! Structural input of a complex eigenvalue analysis.

use crate::modal::{RealModes, ShiftedStiffness};
use std::f64::consts::TAU;

/// Known data of the structure alone, without contact: its real modes and, where they are at hand, factors of
/// K + K_σ − σM at a shift among them.
#[derive(Debug, Clone, Copy)]
pub struct Structural<'a> {
    /// Real modes of K + K_σ and M.
    pub real: &'a RealModes,
    /// Used where σ lies inside the band, and clear of the modes.
    pub shifted: Option<&'a ShiftedStiffness>,
}

impl Structural<'_> {
    /// Whether there are factors, and whether their shift lies inside `band_hz` and clear of the modes: then they cost no
    /// digits. Those that do not are of no use to an analysis, which makes its own.
    pub fn serves(&self, band_hz: [f64; 2]) -> bool {
        /// How far from the middle of the band in ω² a shift may be, relative to that: what lies beyond the real modes is as well seen from there.
        const FROM_THE_MIDDLE: f64 = 0.7;
        /// The distance of a shift from the modes, relative to it.
        const CLEAR: f64 = 1e-3;
        let band = band_hz.map(|f| TAU * f);
        let middle = 0.5 * (band[0] * band[0] + band[1] * band[1]);
        self.shifted.is_some_and(|s| {
            (s.shift - middle).abs() <= FROM_THE_MIDDLE * middle
                && self.real.eigenvalues.iter().all(|w| (w - s.shift).abs() > CLEAR * s.shift)
        })
    }
}

impl<'a> From<&'a RealModes> for Structural<'a> {
    fn from(real: &'a RealModes) -> Self {
        Structural { real, shifted: None }
    }
}
