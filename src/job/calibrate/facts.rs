//! What was measured, and of what: the one place where measured frequencies enter a calibration.

use crate::case::{Case, SQUEAL};

/// Measured frequencies of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Facts {
    /// What they are frequencies of.
    pub of: Of,
    /// f \[Hz\].
    pub frequencies_hz: Vec<f64>,
    /// Relative standard deviation of each.
    pub deviation: f64,
}

/// What has a frequency.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Of {
    /// Real modes of this name.
    RealModes(String),
    /// Unstable complex modes at steady sliding.
    Unstable,
}

impl Of {
    /// What the case calls it.
    pub fn name(&self) -> &str {
        match self {
            Of::RealModes(name) => name,
            Of::Unstable => SQUEAL,
        }
    }
}

/// The measured frequencies that a case is calibrated against.
pub fn facts(case: &Case) -> Vec<Facts> {
    let wanted = case.calibrate.iter().flat_map(|c| c.against.iter().map(|name| (name, c.deviation)));
    let of = |(name, deviation): (&String, f64)| -> Option<Facts> {
        if name == SQUEAL {
            let frequencies_hz = case.cea.as_ref()?.measured_squeal.clone();
            return Some(Facts { of: Of::Unstable, frequencies_hz, deviation });
        }
        let frequencies_hz = case.modes.get(name)?.measured.clone();
        Some(Facts { of: Of::RealModes(name.clone()), frequencies_hz, deviation })
    };
    wanted.filter_map(of).collect()
}
