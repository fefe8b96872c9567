//! What was measured, and of what: the one place where measured data enter a calibration.

use super::super::prepared::Prepared;
use super::super::sensors::Sensors;
use crate::case::{Case, MeasuredData, SQUEAL};
use crate::error::{Fault, Faults, Result};
use crate::job::measured_set;
use crate::measured::{MeasuredMode, MeasuredSet};
use std::sync::Arc;

/// Standard deviation of a component of a measured shape, over their root mean square, that the case does not state.
const SHAPE_DEVIATION: f64 = 0.1;

/// Measured modes of one kind.
#[derive(Debug, Clone)]
pub struct Facts {
    /// What they are modes of.
    pub of: Of,
    /// The modes.
    pub modes: Vec<Fact>,
    /// Where their shapes were measured, if they have any.
    pub sensors: Option<Sensors>,
}

/// A measured mode.
#[derive(Debug, Clone, PartialEq)]
pub struct Fact {
    /// f \[Hz\].
    pub frequency_hz: f64,
    /// Relative standard deviation of it.
    pub deviation: f64,
    /// Its shape in standard deviations of a component.
    pub shape: Option<Arc<[f64]>>,
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

/// What a case is calibrated against, its shapes placed on the mesh.
///
/// # Errors
/// Every file of measured data that cannot be read, or has no modes; points of shapes that lie off the mesh.
pub fn facts(prepared: &Prepared) -> Result<Vec<Facts>> {
    let case = prepared.case;
    let mut faults = Faults::new();
    let wanted = case.calibrate.iter().flat_map(|c| c.against.iter().map(move |name| (name, c)));
    let found = wanted.filter_map(|(name, calibrate)| {
        let listed = |of: Of, frequencies_hz: &[f64]| {
            let fact = |hz: &f64| Fact { frequency_hz: *hz, deviation: calibrate.deviation, shape: None };
            Facts { of, modes: frequencies_hz.iter().map(fact).collect(), sensors: None }
        };
        if name == SQUEAL {
            return Some(listed(Of::Unstable, &case.cea.as_ref()?.measured_squeal));
        }
        if let Some(modes) = case.modes.get(name) {
            return Some(listed(Of::RealModes(name.clone()), &modes.measured));
        }
        let data = case.measured.get(name)?;
        let of = data.of.clone()?;
        let (set, _) = faults.take(measured_set(case, name))?;
        if set.modes.is_empty() {
            let found = "frequency responses without modes";
            faults.push(Fault::new(format!("`calibrate.against` \"{name}\""), found, "measured modes"));
        }
        let shapes = calibrate.shapes && set.modes.iter().any(|mode| mode.shape.is_some());
        faults.take(check_deviation(case, name, data, &set));
        let place = || Sensors::new(prepared, name, data, &set, &case.modes[&of]);
        let sensors = if shapes { faults.take(place()) } else { None };
        let fact = |mode: &MeasuredMode| Fact {
            frequency_hz: mode.frequency_hz,
            deviation: mode.deviation.unwrap_or(calibrate.deviation),
            shape: if shapes { shape(mode, data.shape_deviation.unwrap_or(SHAPE_DEVIATION)) } else { None },
        };
        Some(Facts { of: Of::RealModes(of), modes: set.modes.iter().map(fact).collect(), sensors })
    });
    let found = found.collect();
    faults.into_result(found)
}

/// A deviation of shapes is for shapes.
fn check_deviation(case: &Case, name: &str, data: &MeasuredData, set: &MeasuredSet) -> Result<()> {
    let used = case.calibrate.as_ref().is_some_and(|calibrate| calibrate.shapes);
    let found = match (data.shape_deviation, set.modes.iter().any(|mode| mode.shape.is_some())) {
        (Some(_), false) => "no mode with a shape",
        (Some(_), true) if !used => "`shapes = false` in [calibrate]",
        _ => return Ok(()),
    };
    let place = format!("`measured.{name}.shape_deviation`");
    let expected = "measured shapes that the case is calibrated against, or no deviation of shapes";
    Err(crate::error::Error::input(Fault::new(place, found, expected)))
}

/// The shape of a mode, made real, in units of `deviation` times the root mean square of its components.
fn shape(mode: &MeasuredMode, deviation: f64) -> Option<Arc<[f64]>> {
    let shape = mode.real_shape()?;
    let mean_square = shape.iter().map(|v| v * v).sum::<f64>() / shape.len() as f64;
    let unit = deviation * mean_square.sqrt();
    Some(shape.iter().map(|v| v / unit).collect())
}
