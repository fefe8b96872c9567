//! Results of a run: plain data first ([`RunResults`]), then the writers that take it.
//!
//! | file | what it holds | who reads it |
//! |---|---|---|
//! | `results.h5` | everything, in full precision, written stage by stage; groups and names as in `summary.json` | xarray, h5py, MATLAB, Julia |
//! | `summary.json` | the figures of each analysis: a contract for scripts | any script |
//! | `modes_<set>.csv`, `contact_points.csv`, `complex_modes.csv`, `sensitivities_mode_<k>.csv` | the tables | spreadsheets |
//! | `transient.csv`, `transient_spectrum.csv`, `events.csv` | motion in time, step by step, its spectra, what happened at the contacts | spreadsheets |
//! | `sound_<microphone>.wav`, `sound_spectrum.csv` | sound pressure in time, and sound power and pressure over frequency | audio players, spreadsheets |
//! | `frf_<name>.csv`, `frf_<name>.uff` | frequency responses | spreadsheets, test-data programs |
//! | `comparison_<name>.csv`, `comparison_<name>_frf.csv` | measured modes and responses beside the computed ones | spreadsheets |
//! | `modes_<set>.uff` | the shapes, for test-data programs | test-data programs |
//! | `calibrated.toml`, `calibration.csv` | the case with the numbers that were found, and measured beside computed frequencies; `calibration_responses.csv`: responses | stridor, spreadsheets |
//! | `sweep_<name>.csv`, `sweep_<name>_critical.csv` | the modes along a scalar, its critical values | spreadsheets |
//! | `map_<name>.csv`, `map_<name>_boundary.csv` | growth over two scalars, the boundary of stability | spreadsheets |
//! | `uncertainty_<name>.csv`, `…_modes.csv`, `…_scalars.csv` | samples of uncertain scalars; how often each mode grows; which scalar decides | spreadsheets |
//! | `damping_verdicts.csv` | verdicts that the modal damping decides | spreadsheets |
//! | `transient.vtkhdf` | the motion of all nodes at regular times | ParaView |
//! | `contact.vtu` | pressure and status on the faces in contact | ParaView, pyvista |
//! | `modes_<set>.vtu`, `steady.vtu`, `complex_modes.vtu`, `advice.vtu` | the shapes on the mesh | ParaView, pyvista |
//! | `record.bin`, `checkpoint.bin` | record from which an interrupted run is resumed: [`record`] | `--resume` |
//! | `parts/<analysis>/<k>-of-<n>.bin` | what one job of a job array computed of the sweeps and maps, or of the samples: [`record::Record`] | `--merge` |
//!
//! [`ResultsFile`] is used during the run, [`write_files`] once at its end.

mod calibration;
mod channel;
mod comparison;
mod complex;
mod contact_surface;
mod csv;
mod cycle_fields;
mod damping;
mod diagnostics;
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
mod held;
mod lock;
mod maps;
#[cfg(feature = "hdf5")]
mod maps_hdf5;
mod part_shares;
mod provenance;
mod real_modes;
pub mod record;
mod record_size;
mod records;
mod reduced_check;
mod run_results;
mod search;
mod sensitivity;
mod set_aside;
mod sound;
mod steady;
mod summary;
mod sweeps;
mod transient;
#[cfg(feature = "hdf5")]
mod transient_hdf5;
mod transient_tables;
mod uff;
mod uncertainty;
mod validation;
mod vtk;
mod write;

#[cfg(all(test, feature = "hdf5"))]
mod tests;

pub use calibration::{
    CalibratedDatum, CalibratedNumber, CalibratedResponse, CalibratedShape, CalibrationResult,
};
pub use channel::{Channel, modal_channel};
pub(crate) use channel::{MODAL_ABOUT, MODAL_UNIT, TIME};
pub use comparison::{MeasuredComparison, MeasuredResponses, MeasuredRow, Placed, ResponsePair};
pub use complex::ComplexResult;
pub use contact_surface::{ContactFace, ContactSurface};
pub use cycle_fields::CycleFields;
pub use damping::{DampingRow, DampingVerdicts};
pub use explored::SweepMethod;
#[cfg(feature = "hdf5")]
pub use fields::FieldsFile;
#[cfg(feature = "hdf5")]
pub use file::ResultsFile;

pub(crate) use diagnostics::ContactWatch;
pub use diagnostics::{ContactHistory, Diagnostics, Orbit, PhaseCurve, TouchState};
pub(crate) use folder::{FileNames, file_name, retire, write_atomically, write_result, written_files};
pub use frf::{FrfResponse, FrfResult, PlaceAndDirection, Resonance};
pub use lock::FolderLock;
pub use maps::MapResult;
pub use part_shares::{MODAL, POINTS, PartMode, PartShare, PartShares};
pub use provenance::{KEYS_OF_THE_RUN, Provenance};
pub use real_modes::NamedModes;
pub use record_size::{RecordSize, fits_in_memory, fits_on_disk};
pub use records::{AnalysisRecord, Records};
pub use reduced_check::{Deviation, MotionCompared, ReducedCheck};
pub use run_results::{Geometry, ModelSize, NodalField, RunResults};
pub use search::{Moved, SearchResult, SearchedNumber};
pub use sensitivity::{AdviceField, ModeSensitivity, Mounted, ParameterRate, SensitivityResult};
pub(crate) use set_aside::set_aside;
pub use sound::{MicrophoneSound, PressureRecord, Sound, Tone};
pub use steady::{PairTotals, SteadyResult};
pub use summary::{SCHEMA_VERSION, summary_json, write_summary};
pub use sweeps::SweepResult;
pub use transient::{
    ContactResponses, FieldSnapshot, Fields, GrowthCompared, RecordPiece, Recording, SpectrumOf,
    TransientResult,
};
pub use transient_tables::TransientCsv;
pub(crate) use transient_tables::TransientTables;
pub use uncertainty::{
    CheckedSample, ModeStatistics, SampledScalar, ScalarStatistics, UncertaintyResult, UncertaintyStudy,
};
pub use validation::{CheckedCase, CheckedQuantity, passed};
pub use vtk::write_vtk;
pub use write::write_files;
