//! Measured modes and responses of a calibration: the one place where measured data enter it.

use super::super::prepared::Prepared;
use super::super::sensors::Sensors;
use super::responses::{self, MeasuredFrfData};
use crate::case::{Case, MeasuredData, SQUEAL};
use crate::error::{Error, Fault, Faults, Result};
use crate::job::measured_set;
use crate::measured::{MeasuredMode, MeasuredSet};
use std::sync::Arc;

/// Standard deviation of a component of a measured shape, over their root mean square, that the case does not state.
const SHAPE_DEVIATION: f64 = 0.1;

/// Everything that a case is calibrated against.
#[derive(Debug, Clone, Default)]
pub struct Measurements {
    /// Modes.
    pub modes: Vec<MeasuredModeSet>,
    /// Frequency responses.
    pub responses: Vec<MeasuredFrfData>,
}

/// Measured modes of one kind.
#[derive(Debug, Clone)]
pub struct MeasuredModeSet {
    /// Structure or state whose modes they are.
    pub of: ModeKind,
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

/// Kind of computed modes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ModeKind {
    /// Real modes of this name.
    RealModes(String),
    /// Unstable complex modes at steady sliding.
    Unstable,
}

impl ModeKind {
    /// Name in the case.
    pub fn name(&self) -> &str {
        match self {
            ModeKind::RealModes(name) => name,
            ModeKind::Unstable => SQUEAL,
        }
    }
}

/// Measured data of a calibration, shapes and responses placed on the mesh.
///
/// # Errors
/// Every file of measured data that cannot be read, or has none of the data requested; points of shapes that lie off the
/// mesh, responses of no place of the case.
pub fn measurements(prepared: &Prepared) -> Result<Measurements> {
    let case = prepared.case;
    let mut faults = Faults::new();
    let mut all = Measurements::default();
    for (name, calibrate) in case.calibrate.iter().flat_map(|c| c.against.iter().map(move |name| (name, c))) {
        let listed = |of: ModeKind, frequencies_hz: &[f64]| {
            let fact = |hz: &f64| Fact { frequency_hz: *hz, deviation: calibrate.deviation, shape: None };
            MeasuredModeSet { of, modes: frequencies_hz.iter().map(fact).collect(), sensors: None }
        };
        if name == SQUEAL {
            all.modes.extend(case.cea.as_ref().map(|cea| listed(ModeKind::Unstable, &cea.measured_squeal)));
        } else if let Some(modes) = case.modes.get(name) {
            all.modes.push(listed(ModeKind::RealModes(name.clone()), &modes.measured));
        } else if let Some(data) = case.measured.get(name) {
            if data.of.is_some() {
                all.modes.extend(faults.take(modes(prepared, name, data)));
            }
            if let Some(frf) = data.frf.as_ref().filter(|_| calibrate.responses) {
                all.responses.extend(faults.take(responses::measured(prepared, name, data, frf)));
            }
        }
    }
    faults.into_result(all)
}

/// The modes of `[measured.NAME]`.
fn modes(prepared: &Prepared, name: &str, data: &MeasuredData) -> Result<MeasuredModeSet> {
    let case = prepared.case;
    let (of, calibrate) = (data.of.clone().unwrap_or_default(), case.calibrate.as_ref());
    let deviation = calibrate.map_or(data.deviation, |calibrate| calibrate.deviation);
    let (set, _) = measured_set(case, name)?;
    let mut faults = Faults::new();
    if set.modes.is_empty() {
        let found = "frequency responses without modes";
        let help = "Without `of` its responses alone are taken";
        let fault = Fault::new(format!("`calibrate.against` \"{name}\""), found, "measured modes");
        faults.push(fault.with_help(help));
    }
    let shapes = calibrate.is_some_and(|calibrate| calibrate.shapes)
        && set.modes.iter().any(|mode| mode.shape.is_some());
    faults.take(check_deviation(case, name, data, &set));
    let place = || Sensors::new(prepared, name, data, &set, &case.modes[&of]);
    let sensors = if shapes { faults.take(place()) } else { None };
    let fact = |mode: &MeasuredMode| Fact {
        frequency_hz: mode.frequency_hz,
        deviation: mode.deviation.unwrap_or(deviation),
        shape: if shapes { shape(mode, data.shape_deviation.unwrap_or(SHAPE_DEVIATION)) } else { None },
    };
    let facts =
        MeasuredModeSet { modes: set.modes.iter().map(fact).collect(), of: ModeKind::RealModes(of), sensors };
    faults.into_result(facts)
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
    Err(Error::input(Fault::new(place, found, expected)))
}

/// The shape of a mode, made real, in units of `deviation` times the root mean square of its components.
fn shape(mode: &MeasuredMode, deviation: f64) -> Option<Arc<[f64]>> {
    let shape = mode.real_shape()?;
    let mean_square = shape.iter().map(|v| v * v).sum::<f64>() / shape.len() as f64;
    let unit = deviation * mean_square.sqrt();
    Some(shape.iter().map(|v| v / unit).collect())
}
