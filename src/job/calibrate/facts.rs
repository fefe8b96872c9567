//! What was measured, and of what: the one place where measured frequencies enter a calibration.

use crate::case::{Case, SQUEAL};
use crate::error::{Fault, Faults, Result};
use crate::job::measured_set;

/// Measured frequencies of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Facts {
    /// What they are frequencies of.
    pub of: Of,
    /// f \[Hz\].
    pub frequencies_hz: Vec<f64>,
    /// Relative standard deviation of each.
    pub deviations: Vec<f64>,
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
///
/// # Errors
/// Every file of measured data that cannot be read, or has no modes.
pub fn facts(case: &Case) -> Result<Vec<Facts>> {
    let mut faults = Faults::new();
    let wanted = case.calibrate.iter().flat_map(|c| c.against.iter().map(|name| (name, c.deviation)));
    let found = wanted.filter_map(|(name, deviation)| {
        let listed = |of: Of, frequencies_hz: &[f64]| Facts {
            of,
            deviations: vec![deviation; frequencies_hz.len()],
            frequencies_hz: frequencies_hz.to_vec(),
        };
        if name == SQUEAL {
            return Some(listed(Of::Unstable, &case.cea.as_ref()?.measured_squeal));
        }
        if let Some(modes) = case.modes.get(name) {
            return Some(listed(Of::RealModes(name.clone()), &modes.measured));
        }
        let of = case.measured.get(name)?.of.clone()?;
        let (set, _) = faults.take(measured_set(case, name))?;
        if set.modes.is_empty() {
            let found = "frequency responses without modes";
            faults.push(Fault::new(format!("`calibrate.against` \"{name}\""), found, "measured modes"));
        }
        Some(Facts {
            of: Of::RealModes(of),
            frequencies_hz: set.modes.iter().map(|mode| mode.frequency_hz).collect(),
            deviations: set.modes.iter().map(|mode| mode.deviation.unwrap_or(deviation)).collect(),
        })
    });
    let found = found.collect();
    faults.into_result(found)
}
