//! What a complex eigenvalue analysis is given of the structure.

use crate::modal::{RealModes, ShiftedStiffness};

/// What is known of the structure alone, without contact: its real modes and, where they are at hand, factors of
/// K + K_σ − σM at a shift among them.
#[derive(Debug, Clone, Copy)]
pub struct Structural<'a> {
    /// Real modes of K + K_σ and M.
    pub real: &'a RealModes,
    /// Used where σ lies inside the band, and clear of the modes.
    pub shifted: Option<&'a ShiftedStiffness>,
}

impl<'a> From<&'a RealModes> for Structural<'a> {
    fn from(real: &'a RealModes) -> Self {
        Structural { real, shifted: None }
    }
}
