//! `--engine`: analyses over the ranks of an MPI program.

use crate::error::{Error, Fault, Result};
use crate::job::Selection;
use crate::linalg::Engine;
use clap::ValueEnum;

/// Libraries that an analysis can be distributed with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum EngineName {
    /// MUMPS, PETSc and SLEPc: matrices over the ranks of `mpirun`; for `modes` and `cea`
    Slepc,
}

impl EngineName {
    /// That it can do what is asked for.
    fn check(self, selection: Selection) -> Result<()> {
        match selection {
            Selection::Only("modes" | "cea") => Ok(()),
            _ => Err(Error::input(Fault::new(
                "--engine slepc",
                "a subcommand without distributed matrices",
                "`stridor modes` or `stridor cea`",
            ))),
        }
    }
}

/// Runs `work` with the engine of that name, on rank 0; other ranks help and come back with its exit code.
pub fn with_engine(
    name: Option<EngineName>,
    selection: Selection,
    work: impl FnOnce(&Engine) -> Result<u8>,
) -> Result<u8> {
    let Some(name) = name else { return work(&Engine::default()) };
    name.check(selection)?;
    distributed(work)
}

#[cfg(feature = "slepc")]
fn distributed(work: impl FnOnce(&Engine) -> Result<u8>) -> Result<u8> {
    use crate::distributed::{Role, start};
    use std::sync::Arc;
    match start(&super::VERSION)? {
        Role::Ended(code) => Ok(code),
        Role::Lead(cluster) => {
            let done = work(&Engine::new(Arc::new(Arc::clone(&cluster))));
            cluster.end(done.as_ref().map_or_else(Error::exit_code, |code| *code));
            done
        }
    }
}

#[cfg(not(feature = "slepc"))]
fn distributed(_: impl FnOnce(&Engine) -> Result<u8>) -> Result<u8> {
    let fault =
        Fault::new("--engine slepc", "a build of stridor without MPI", "one with the feature `slepc`");
    Err(Error::input(
        fault.with_help("Build it with `.ci/setup --mpi` and `cargo build --release --features slepc`"),
    ))
}
