//! The compiled part of the Python package `stridor`: cases, runs, and results as trees of arrays.
//!
//! | module | content |
//! |---|---|
//! | [`case`] | cases: reading, scalars, check |
//! | [`mesh`] | meshes as Gmsh files |
//! | [`model`] | M, C, K and the contact points as arrays |
//! | [`run`] | a run on a thread of its own, with progress and Ctrl-C |
//! | [`tree`] | described results as nested dicts of arrays |
//! | [`errors`] | errors as exceptions |

mod case;
mod errors;
mod mesh;
mod model;
mod run;
mod tree;

use pyo3::prelude::*;
use std::ffi::OsString;
use stridor::pages::LargePages;

/// Memory in large pages, as the program has it.
#[global_allocator]
static MEMORY: LargePages = LargePages;

/// The compiled part of stridor.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::case::Case;
    #[pymodule_export]
    use super::mesh::mesh_text;
    #[pymodule_export]
    use super::run::Run;
    #[pymodule_export]
    use super::{main, version};
}

/// Version of the program and, where it is known, its commit.
#[pyfunction]
fn version() -> (&'static str, Option<&'static str>) {
    (env!("CARGO_PKG_VERSION"), stridor::COMMIT)
}

/// Runs the command line on `arguments`, the first of which is the name of the program, and gives its exit code.
#[pyfunction]
fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| stridor::cli::main(arguments))
}
