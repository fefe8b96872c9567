//! `--engine`: analyses over the ranks of an MPI program.

use crate::case::Case;
use crate::error::{Error, Fault, Result};
use crate::job::{SHARED, Selection};
use crate::linalg::Engine;
use crate::linalg::factor::engine_names;
use crate::progress::Observer;
use crate::results::RunResults;
use clap::ValueEnum;
use std::path::Path;

/// The ranks of an MPI program, over which analyses are shared out. This library has none: the program `stridor-mpi` gives them.
pub trait Ranks: Sync {
    /// Starts MPI. Rank 0 does `work` with matrices that lie on all ranks, and with real modes by the Krylov–Schur method where
    /// that is asked for; the others come back when it has ended.
    ///
    /// # Errors
    /// Those of `work`; MPI cannot be started; the ranks run different builds of the program.
    fn matrices(&self, krylov_schur: bool, work: &mut dyn FnMut(&Engine) -> Result<()>) -> Result<()>;

    /// Starts MPI. Computes the studies of a case that `analysis` takes (`sweep`, `uncertainty`) in the folder `out`, their points
    /// shared out over the ranks; the results on rank 0.
    ///
    /// # Errors
    /// Faults of the input; an analysis without an answer; MPI cannot be started; the ranks run different builds of the program.
    fn points(
        &self,
        case: Result<Case>,
        analysis: &'static str,
        out: &Path,
        observer: &dyn Observer,
    ) -> Result<Option<RunResults>>;
}

/// How an analysis is shared out over the ranks of `mpirun`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum EngineName {
    /// For `modes` and `cea`: its matrices, by MUMPS, PETSc and SLEPc
    #[value(name = engine_names::SLEPC)]
    Slepc,
    /// The same with the real modes by Krylov–Schur of SLEPc, a second method to find them
    #[value(name = engine_names::SLEPC_KRYLOV_SCHUR)]
    SlepcKrylovSchur,
    /// For `sweep` and `uncertainty`: their points
    #[value(name = engine_names::MPI)]
    Mpi,
}

impl EngineName {
    fn option(self) -> String {
        let name = self.to_possible_value().expect("no value is skipped");
        format!("--engine {}", name.get_name())
    }

    /// The ranks, if it can do what is asked for.
    ///
    /// # Errors
    /// Another subcommand; a program without MPI.
    pub fn on(self, ranks: Option<&dyn Ranks>, selection: Selection) -> Result<&dyn Ranks> {
        let (fits, expected) = match self {
            EngineName::Slepc | EngineName::SlepcKrylovSchur => {
                (matches!(selection, Selection::Only("modes" | "cea")), "`stridor modes` or `stridor cea`")
            }
            EngineName::Mpi => (
                matches!(selection, Selection::Only(name) if SHARED.contains(&name)),
                "`stridor sweep` or `stridor uncertainty`",
            ),
        };
        if !fits {
            return Err(Error::input(Fault::new(self.option(), "another subcommand", expected)));
        }
        ranks.ok_or_else(|| {
            let fault = Fault::new(self.option(), "a program without MPI", "the program `stridor-mpi`");
            Error::input(fault.with_help(
                "In a clone of the repository, `.ci/setup --mpi` installs what it needs, and \
                 `cargo build --release -p stridor-mpi` builds it, or `cargo install --path crates/mpi`",
            ))
        })
    }
}
