//! What a run leaves behind: plain data first ([`RunResults`]), then the writers that take it.
//!
//! | file | what it holds | who reads it |
//! |---|---|---|
//! | `results.h5` | everything, in full precision, written stage by stage; groups and names as in `summary.json` | xarray, h5py, MATLAB, Julia |
//! | `summary.json` | the figures of each analysis: a contract for scripts | any script |
//! | `modes_<set>.csv`, `contact_points.csv`, `complex_modes.csv`, `sensitivities_mode_<k>.csv` | the tables | spreadsheets |
//! | `transient.csv`, `transient_spectrum.csv`, `events.csv` | motion in time, step by step, its spectra, what happened at the contacts | spreadsheets |
//! | `sound_<microphone>.wav`, `sound_spectrum.csv` | what is heard, and sound power and pressure over frequency | listeners, spreadsheets |
//! | `frf_<name>.csv`, `frf_<name>.uff` | frequency responses | spreadsheets, test-data programs |
//! | `comparison_<name>.csv`, `comparison_<name>_frf.csv` | measured modes and responses beside the computed ones | spreadsheets |
//! | `modes_<set>.uff` | the shapes, for test-data programs | test-data programs |
//! | `calibrated.toml`, `calibration.csv` | the case with the numbers that were found, and measured beside computed frequencies; `calibration_responses.csv`: responses | stridor, spreadsheets |
//! | `sweep_<name>.csv`, `sweep_<name>_critical.csv` | the modes along a scalar, its critical values | spreadsheets |
//! | `map_<name>.csv`, `map_<name>_boundary.csv` | growth over two scalars, the boundary of stability | spreadsheets |
//! | `damping_verdicts.csv` | verdicts that the modal damping decides | spreadsheets |
//! | `transient.vtkhdf` | the motion of all nodes at regular times | ParaView |
//! | `modes_<set>.vtu`, `steady.vtu`, `complex_modes.vtu`, `advice.vtu` | the shapes on the mesh | ParaView, pyvista |
//! | `record.bin`, `checkpoint.bin` | what an interrupted run is taken up from: [`record`] | `--resume` |
//!
//! [`ResultsFile`] is used while the run goes on, [`write_files`] once at its end.

mod calibration;
mod comparison;
mod complex;
mod csv;
mod damping;
mod derived;
#[cfg(feature = "hdf5")]
mod events_hdf5;
mod explored;
#[cfg(feature = "hdf5")]
mod fields;
#[cfg(feature = "hdf5")]
mod file;
mod folder;
mod frf;
#[cfg(feature = "hdf5")]
mod hdf5;
mod lock;
mod maps;
#[cfg(feature = "hdf5")]
mod maps_hdf5;
mod real_modes;
pub mod record;
mod record_size;
mod records;
mod reduced_check;
mod search;
mod sensitivity;
mod set_aside;
mod sound;
mod steady;
mod summary;
mod sweeps;
mod transient;
mod transient_csv;
#[cfg(feature = "hdf5")]
mod transient_hdf5;
mod uff;
mod validation;
mod vtk;
mod watched;

#[cfg(test)]
pub(crate) mod sample;
#[cfg(all(test, feature = "hdf5"))]
mod tests;

pub use calibration::{
    CalibratedDatum, CalibratedNumber, CalibratedResponse, CalibratedShape, CalibrationResult,
};
pub use comparison::{MeasuredComparison, MeasuredResponses, MeasuredRow, Placed, ResponsePair};
pub use complex::ComplexResult;
pub(crate) use csv::write_csv;
pub use damping::{DampingRow, DampingVerdicts};
pub use derived::PairTotals;
pub use explored::Method;
#[cfg(feature = "hdf5")]
pub use fields::FieldsFile;
#[cfg(feature = "hdf5")]
pub use file::ResultsFile;

pub(crate) use folder::{FileNames, file_name, retire, write_atomically, write_result};
pub use frf::{FrfResponse, FrfResult, PlaceAndDirection, Resonance};
pub use lock::FolderLock;
pub use maps::MapResult;
pub use real_modes::NamedModes;
pub use record_size::{RecordSize, fits_in_memory, fits_on_disk};
pub use records::{Record, Records};
pub use reduced_check::{Deviation, MotionCompared, ReducedCheck};
pub use search::{Moved, SearchResult, SearchedNumber};
pub use sensitivity::{AdviceField, ModeSensitivity, Mounted, ParameterRate, SensitivityResult};
pub(crate) use set_aside::set_aside;
pub use sound::{Heard, Sound, Sounding, Tone};
pub use steady::SteadyResult;
pub use summary::{SCHEMA_VERSION, summary_json, write_summary};
pub use sweeps::SweepResult;
pub use transient::{
    Channel, Field, Fields, GrowthCompared, Piece, Recording, SpectrumOf, TransientResult, modal_channel,
};
pub use transient_csv::{EventTable, HistoryTable};
pub use validation::{Checked, CheckedCase, passed};
pub use vtk::write_vtk;
pub(crate) use watched::ContactWatch;
pub use watched::{ContactHistory, Curve, Orbit, TouchState, Watched};

use std::path::Path;

/// Writes `summary.json`, the tables and the ParaView files of `results` into the folder `dir`.
///
/// # Errors
/// [`crate::error::Error::Io`] when the folder cannot be made or a file not be written.
pub fn write_files(dir: &Path, results: &RunResults) -> crate::error::Result<()> {
    write_summary(dir, results)?;
    write_csv(dir, results)?;
    if let Some(sound) = results.get::<TransientResult>().and_then(|run| run.sound.as_ref()) {
        sound::write(dir, sound)?;
    }
    frf::write_universal(dir, &results.all::<FrfResult>())?;
    uff::write_modes(dir, results)?;
    if let Some(calibration) = results.get::<CalibrationResult>() {
        calibration::write(dir, calibration)?;
    }
    write_vtk(dir, results)
}

/// Everything a run produced, as plain data for the writers and the report.
#[derive(Debug, Default)]
pub struct RunResults {
    /// The case's title.
    pub title: String,
    /// The resolved case as TOML, every default written out.
    pub resolved_case: String,
    /// Assumptions of the case: what the source does not state, in the user's words.
    pub assumptions: Vec<String>,
    /// Things the user should know (a plate too thick for its theory, a guessed value that decides), one sentence each.
    pub warnings: Vec<String>,
    /// Nodes and elements for pictures and ParaView.
    pub geometry: Geometry,
    /// Degrees of freedom and nonzeros of K.
    pub size: ModelSize,
    /// What the analyses have found.
    pub records: Records,
    /// Wall time of each phase \[s\].
    pub timings: Vec<(String, f64)>,
    /// The files that the case reads.
    pub inputs: Vec<record::InputFile>,
    /// Why the run has ended before its end, if it has: an analysis without an answer.
    pub failed: Option<String>,
}

/// The size of a model.
#[derive(Debug, Clone, Copy, Default)]
pub struct ModelSize {
    /// Nodes of the mesh in use.
    pub nodes: usize,
    /// Elements in use.
    pub elements: usize,
    /// Free degrees of freedom.
    pub dofs: usize,
    /// Stored entries of K, both triangles.
    pub nonzeros: usize,
    /// Contact points that may touch.
    pub contact_points: usize,
}

/// Nodes and elements as the analyses saw them (after the disc was tilted and set on the slider).
#[derive(Debug, Clone, Default)]
pub struct Geometry {
    /// Coordinates \[m\].
    pub nodes: Vec<[f64; 3]>,
    /// Node indices of every element: 1 (point), 2 (bar), 3 or 4 (shell).
    pub elements: Vec<Vec<usize>>,
    /// The part each element belongs to, an index into `parts`.
    pub part_of: Vec<usize>,
    /// The parts' names.
    pub parts: Vec<String>,
}

/// A displacement of every node: (ux, uy, uz, rx, ry, rz) \[m, rad\] in the order of [`Geometry::nodes`].
pub type NodalField<T> = Vec<[T; 6]>;
