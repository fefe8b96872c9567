//! What a run leaves behind: plain data first ([`RunResults`]), then the writers that take it.
//!
//! | file | what it holds | who reads it |
//! |---|---|---|
//! | `results.h5` | everything, in full precision, written stage by stage | h5py, MATLAB, Julia |
//! | `summary.json` | the figures of each analysis: a contract for scripts | any script |
//! | `modes_<set>.csv`, `contact_points.csv`, `complex_modes.csv`, `sensitivities.csv` | the tables | spreadsheets |
//! | `transient.csv`, `transient_spectrum.csv`, `events.csv` | motion in time, step by step, its spectra, what happened at the contacts | spreadsheets |
//! | `sound_<microphone>.wav`, `sound_spectrum.csv` | what is heard, and sound power and pressure over frequency | ears, spreadsheets |
//! | `frf_<name>.csv`, `frf_<name>.uff` | frequency responses | spreadsheets, test-data programs |
//! | `comparison_<name>.csv`, `comparison_<name>_frf.csv` | measured modes and responses beside the computed ones | spreadsheets |
//! | `modes_<set>.uff` | the shapes, for test-data programs | test-data programs |
//! | `calibrated.toml`, `calibration.csv` | the case with the numbers that were found, and measured beside computed frequencies; `calibration_responses.csv`: responses | stridor, spreadsheets |
//! | `critical_values.csv`, `sweep_<name>.csv`, `map_<name>.csv` | sweeps and maps | spreadsheets |
//! | `transient.vtkhdf` | the motion of all nodes at regular times | ParaView |
//! | `modes_<set>.vtu`, `steady.vtu`, `complex_modes.vtu`, `advice.vtu` | the shapes on the mesh | ParaView, pyvista |
//! | `record.bin`, `checkpoint.bin` | what an interrupted run is taken up from: [`record`] | `--resume` |
//!
//! [`ResultsFile`] is used while the run goes on, [`write_files`] once at its end.

mod calibration;
mod calibration_hdf5;
mod calibration_json;
mod comparison;
mod csv;
mod derived;
mod events_hdf5;
mod explored;
mod explored_csv;
mod explored_hdf5;
mod explored_json;
mod fields;
mod file;
mod folder;
mod frf;
mod hdf5;
mod json;
mod lock;
pub mod record;
mod reduced_check;
mod room;
mod search;
mod sensitivity;
mod sound;
mod sound_hdf5;
mod transient;
mod transient_csv;
mod transient_hdf5;
mod transient_json;
mod uff;
mod validation;
mod vtk;
mod watched;

#[cfg(test)]
pub(crate) mod sample;

pub use calibration::{
    CalibratedDatum, CalibratedNumber, CalibratedResponse, CalibratedShape, CalibrationResult,
};
pub use comparison::{MeasuredComparison, MeasuredResponses, MeasuredRow, Placed, ResponsePair};
pub(crate) use csv::Table as CsvTable;
pub use csv::write_csv;
pub use derived::{ComparedRow, PairTotals};
pub use explored::{DampingRow, DampingVerdicts, MapResult, Method, SweepResult};
pub use fields::FieldsFile;
pub use file::ResultsFile;
pub(crate) use folder::{FileNames, retire, set_aside, write_atomically, write_result};
pub use frf::{FrfResponse, FrfResult, PlaceAndDirection, Resonance};
pub use json::{SCHEMA_VERSION, summary_json, write_summary};
pub use lock::FolderLock;
pub use reduced_check::{Deviation, MotionCompared, ReducedCheck};
pub use room::{RecordSize, room_in_memory, room_on_disk};
pub use search::{Moved, SearchResult, SearchedNumber};
pub use sensitivity::{AdviceField, ModeSensitivity, Mounted, ParameterRate, SensitivityResult};
pub use sound::{Heard, Sound, Sounding, Tone};
pub use transient::{
    Channel, Field, Fields, GrowthCompared, Piece, Recording, SpectrumOf, TransientResult, modal_channel,
};
pub use transient_csv::{EventTable, HistoryTable};
pub use validation::{Checked, CheckedCase, passed};
pub use vtk::write_vtk;
pub(crate) use watched::ContactWatch;
pub use watched::{ContactHistory, Curve, Orbit, TouchState, Watched};

use crate::equilibrium::SteadySliding;
use crate::modal::{DiscModeName, RealModes};
use crate::stability::{Certificate, ComplexModes, Confirmation};
use std::path::Path;

/// Writes `summary.json`, the tables and the ParaView files of `results` into the folder `dir`.
///
/// # Errors
/// [`crate::error::Error::Io`] when the folder cannot be made or a file not be written.
pub fn write_files(dir: &Path, results: &RunResults) -> crate::error::Result<()> {
    write_summary(dir, results)?;
    write_csv(dir, results)?;
    explored_csv::write(dir, results)?;
    if let Some(sound) = results.transient.as_ref().and_then(|run| run.sound.as_ref()) {
        sound::write(dir, sound)?;
    }
    frf::write(dir, &results.frfs)?;
    comparison::write(dir, results)?;
    uff::write_modes(dir, results)?;
    if let Some(calibration) = &results.calibration {
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
    /// Real modes of parts and of the whole, in the order the case lists them.
    pub modes: Vec<NamedModes>,
    /// Measured modes set beside the computed ones.
    pub measured: Vec<MeasuredComparison>,
    /// Measured frequency responses set beside the computed ones.
    pub measured_frfs: Vec<MeasuredResponses>,
    /// Steady sliding.
    pub steady: Option<SteadyResult>,
    /// Complex eigenvalues.
    pub complex: Option<ComplexResult>,
    /// How complex eigenvalues answer scalars of the case and things mounted on its nodes.
    pub sensitivity: Option<SensitivityResult>,
    /// Complex modes along one scalar.
    pub sweeps: Vec<SweepResult>,
    /// Complex modes over two scalars.
    pub maps: Vec<MapResult>,
    /// Motion in time.
    pub transient: Option<TransientResult>,
    /// Frequency responses, in the order of their names.
    pub frfs: Vec<FrfResult>,
    /// Numbers of the case that were found from measured frequencies.
    pub calibration: Option<CalibrationResult>,
    /// Which verdicts the modal damping decides.
    pub damping: Option<DampingVerdicts>,
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

/// The real modes of one part or of the whole.
#[derive(Debug)]
pub struct NamedModes {
    /// `disc`, `rig`, `rig with closed contact` …
    pub name: String,
    /// Eigenvalues, errors and certificate.
    pub modes: RealModes,
    /// The shape of each mode at every node; zero outside the part.
    pub shapes: Vec<NodalField<f64>>,
    /// The part with the largest share of each mode's kinetic energy; `None` where only points move.
    pub moving_part: Vec<Option<String>>,
    /// The name of each mode, where the part is a disc and the mode bends it.
    pub names: Vec<Option<DiscModeName>>,
    /// Effective mass of each mode for translations along x, y, z \[kg\].
    pub effective_mass: Vec<[f64; 3]>,
    /// Total mass \[kg\].
    pub total_mass: f64,
    /// ζ of each mode by the damping of the case.
    pub damping_ratio: Vec<f64>,
    /// Whether `modes_<set>.uff` is wanted.
    pub universal: bool,
}

/// Steady sliding, for people.
#[derive(Debug)]
pub struct SteadyResult {
    /// The solution.
    pub state: SteadySliding,
    /// Displacement of every node.
    pub displacement: NodalField<f64>,
    /// Pair name and position \[m\] of every contact point.
    pub points: Vec<(String, [f64; 3])>,
    /// Load \[N\] and sliding velocity \[m/s\] of each pair, with its name.
    pub pairs: Vec<(String, f64, f64)>,
    /// For each pair two unit vectors: where the load presses the body (the disc) and where the counter-body (the
    /// slider) moves. Pictures draw them as arrows; empty where the case has no geometry.
    pub directions: Vec<[[f64; 3]; 2]>,
}

/// Complex modes, for people.
#[derive(Debug)]
pub struct ComplexResult {
    /// Eigenvalues, vectors, errors, budgets.
    pub modes: ComplexModes,
    /// The shape of each mode at every node.
    pub shapes: Vec<NodalField<crate::linalg::c64>>,
    /// A few words on the real modes that take part in each mode: `61 % disc (0,1), 22 % (3,0)`.
    pub participation: Vec<String>,
    /// What the real modes are called, in the order that [`ComplexMode::participation`](crate::stability::ComplexMode)
    /// counts them: `disc (0, 1)`, `mode 1718 Hz`.
    pub real_modes: Vec<String>,
    /// Frequencies that measurements show squealing \[Hz\], with their source; may be empty.
    pub measured_squeal_hz: Vec<(f64, String)>,
    /// Frequency band of the analysis \[Hz\].
    pub band_hz: [f64; 2],
    /// The count of the unstable eigenvalues, where there is one.
    pub certificate: Option<Certificate>,
    /// The second method beside it, if the case asked for one.
    pub confirmation: Option<Confirmation>,
}
