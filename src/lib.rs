#![warn(missing_docs)]
// Without these features some helpers have no user.
#![cfg_attr(not(feature = "cli"), allow(dead_code, unused_imports))]
//! **stridor** predicts when a disc will squeal, at which frequency, how loud, and what to change.
//!
//! The modules, in the order of the imports (a module only uses modules above it):
//!
//! | module | content |
//! |---|---|
//! | [`error`], [`progress`] | error type that carries data; progress of long work |
//! | [`numbers`] | numbers as text |
//! | [`schema`] | tables of a TOML file, each key declared once |
//! | [`pages`] | memory in large pages |
//! | [`memory`] | memory available to the process |
//! | [`solids`] | what solid materials have |
//! | [`input`] | input files: regular, of a bounded size |
//! | [`linalg`] | sparse symmetric factorisation, eigenvalues; knows no mechanics |
//! | [`system`] | M, C, K and the sliding interface: the input of every analysis |
//! | [`mesh`] | Gmsh files, generated discs and plates, regions, quality |
//! | [`decks`] | models of other programs: Abaqus, CalculiX, NASTRAN, ANSYS, universal files |
//! | [`structure`] | elements, constraints, assembly |
//! | [`contact`] | pairing of two bodies, normal and friction laws |
//! | [`equilibrium`] | steady sliding and its linearisation |
//! | [`dynamics`] | the operator Q(λ) about steady sliding: products, solutions, harmonic responses |
//! | [`modal`] | real modes, their names, their certificate |
//! | [`reduction`] | reduced models that keep the motion at the contacts |
//! | [`stability`] | complex eigenvalues at steady sliding |
//! | [`transient`] | motion in time: implicit integration, contact condensed |
//! | [`signal`] | spectra, spectrograms, peaks, growth and size of a record |
//! | [`sound`] | sound of vibrating plates: Rayleigh's integral |
//! | [`sweep`] | complex modes over scalars: branches, critical values, maps |
//! | [`uncertainty`] | uncertain scalars: distributions, samples, statistics |
//! | [`measured`] | measured modes and responses, compared with the computed ones |
//! | [`calibration`] | scalars identified from measurements, with their uncertainty |
//! | [`dataset`] | named quantities with units and dimensions, in JSON, HDF5, CSV and tables |
//! | [`results`] | HDF5, VTK, JSON, CSV |
//! | [`report`] | pictures and the HTML page |
//! | [`case`] | TOML → validated case → system |
//! | [`job`] | from a case to its results |
//! | [`validation`] | the validation suite: computed and reference values |
//! | [`search`] | search for scalars of a case, so that its results match references of any kind |
//! | [`cli`] | the command line |
//!
//! Cargo features: `cli` (default) is the program with its results folders, search and validation suite; `hdf5` and `report`,
//! which it needs, are `results.h5` and the page with its pictures. Meshes, models, analyses and their results need none. The program
//! for several machines, `stridor-mpi`, is a package of its own, `crates/mpi`, which gives [`cli`] its ranks.
//!
//! M ü + C u̇ + K u + Σ [g N − t₁ F₁ − t₂ F₂] = f. SI units (m, kg, s, N, rad) everywhere inside.

pub mod calibration;
pub mod case;
#[cfg(feature = "cli")]
pub mod cli;
pub mod contact;
pub mod dynamics;
pub mod equilibrium;
pub mod job;
pub mod modal;
pub mod reduction;
#[cfg(feature = "report")]
pub mod report;
pub mod results;
#[cfg(feature = "cli")]
pub mod search;
pub mod stability;
pub mod structure;
pub mod sweep;
pub mod system;
pub mod transient;
pub mod uncertainty;
#[cfg(feature = "cli")]
pub mod validation;

// Members of the workspace, below `crates/`.
pub use stridor_base::{bounds, connected, error, input, memory, numbers, pages, progress, solids};
pub use stridor_dataset as dataset;
pub use stridor_decks as decks;
pub use stridor_linalg as linalg;
pub use stridor_measured as measured;
pub use stridor_mesh as mesh;
pub use stridor_schema as schema;
pub use stridor_signal as signal;
pub use stridor_sound as sound;

/// The git commit at which the sources of this build were last compiled, 12 digits, with `-modified` where they differed from it;
/// `None` for a build outside a repository.
pub const COMMIT: Option<&str> = option_env!("STRIDOR_COMMIT");
