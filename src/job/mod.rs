//! From a case to its results: the one place where mechanics and analyses meet.
//!
//! 1. [`Prepared::new`] reads the mesh, places the bodies and builds the [`crate::system::System`].
//! 2. [`analyse`] runs the analyses of the case on it and hands each result on as soon as it is there.
//! 3. [`run_case`] does both and writes the results folder; [`run_part`] computes a block of every study,
//!    [`merge_parts`] makes the results folder of all blocks.
//!
//! A case may give M, C and K themselves instead of a mesh; [`export()`] writes any case in that form, and [`deck()`] makes
//! of one with a mesh a model of another program.

mod analyse;
mod analyses;
mod calibrate;
#[cfg(feature = "cli")]
mod checks;
mod clock;
mod compare;
mod complex;
mod contact_surfaces;
mod contact_twice;
mod contacts;
mod counter;
mod couplings;
mod deck;
mod discs;
mod equations;
mod explore;
mod export;
#[cfg(feature = "cli")]
mod folder;
mod forces;
mod frf;
mod frf_reach;
mod frf_stability;
mod imported;
mod known;
mod links;
mod measured;
mod memory;
mod mesh;
mod mesh_split;
mod model;
mod modes;
mod motion;
mod operating_point;
mod part_modes;
mod part_shares;
#[cfg(feature = "cli")]
mod parts;
mod place;
mod plausible;
mod prepared;
mod pressed;
mod regions;
mod rotation;
mod run;
#[cfg(feature = "cli")]
mod run_case;
#[cfg(test)]
pub(crate) mod sample;
#[cfg(test)]
mod samples;
mod scalars;
mod sensitivity;
mod sensors;
mod singular;
mod sink;
mod sound;
mod states;
mod steady_warnings;
mod studies;
mod study_solver;
mod table;
mod time_function;
mod transient;
mod travel;
mod uncertainty;
mod verify;

pub use analyse::{CaseWarnings, analyse, check_case};
pub use analyses::{ANALYSES, Analysis, Selection};
pub use calibrate::Coordinate;
pub use deck::deck;
pub use export::{ContactAs, export};
pub use imported::{read_points, read_rows};
#[cfg(feature = "cli")]
pub use known::origin;
pub use measured::{measured_set, read_modes};
pub use memory::{ExpectedMemory, check_memory};
#[cfg(feature = "cli")]
pub use parts::{PartDone, parts_done, parts_folder, run_part, run_parts};
pub use prepared::Prepared;
#[cfg(feature = "cli")]
pub use run_case::{RunOptions, merge_parts, run_case};
pub use sink::{Histories, ResultSink, ResultStage};
pub use states::Whole;
pub use studies::SHARED;
