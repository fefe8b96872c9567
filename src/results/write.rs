//! The files of a run that are written at its end.

use super::calibration::{CalibrationResult, write_calibrated};
use super::csv::write_csv;
use super::frf::FrfResult;
use super::run_results::RunResults;
use super::sound::write_sound;
use super::summary::write_summary;
use super::transient::TransientResult;
use super::uff::{write_functions, write_modes};
use super::vtk::write_vtk;
use crate::error::Result;
use std::path::Path;

/// Writes `summary.json`, the tables and the ParaView files of `results` into the folder `dir`.
///
/// # Errors
/// [`crate::error::Error::Io`] when the folder cannot be made or a file not be written.
pub fn write_files(dir: &Path, results: &RunResults) -> Result<()> {
    write_summary(dir, results)?;
    write_csv(dir, results)?;
    if let Some(sound) = results.get::<TransientResult>().and_then(|run| run.sound.as_ref()) {
        write_sound(dir, sound)?;
    }
    write_functions(dir, &results.all::<FrfResult>())?;
    write_modes(dir, results)?;
    if let Some(calibration) = results.get::<CalibrationResult>() {
        write_calibrated(dir, calibration)?;
    }
    write_vtk(dir, results)
}
