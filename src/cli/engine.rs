//! `--engine`: analyses over the ranks of an MPI program.

use crate::error::{Error, Fault, Result};
use crate::job::{SHARED, Selection};
use crate::linalg::factor::engine_names;
use clap::ValueEnum;

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

    /// That it can do what is asked for.
    ///
    /// # Errors
    /// Another subcommand; a build without MPI.
    pub fn check(self, selection: Selection) -> Result<()> {
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
        if !cfg!(feature = "slepc") {
            let (found, expected) = ("a build of stridor without MPI", "one with the feature `slepc`");
            let help = "Build it with `.ci/setup --mpi` and `cargo build --release --features slepc`";
            return Err(Error::input(Fault::new(self.option(), found, expected).with_help(help)));
        }
        Ok(())
    }
}

#[cfg(feature = "slepc")]
pub use on_ranks::{shared_matrices, shared_points};

#[cfg(feature = "slepc")]
mod on_ranks {
    use crate::case::Case;
    use crate::cli::engine::EngineName;
    use crate::cli::output::SUCCESS;
    use crate::cli::progress::Bars;
    use crate::cli::version::VERSION;
    use crate::distributed::{RealModesMethod, Role, same_build, start};
    use crate::error::Result;
    use crate::job::studies_on_ranks;
    use crate::linalg::Engine;
    use crate::results::RunResults;
    use crate::slepc::World;
    use std::path::Path;
    use std::sync::Arc;

    /// Runs `work` on rank 0 with matrices that lie on all ranks; the others come back when it has ended.
    pub fn shared_matrices(name: EngineName, work: impl FnOnce(&Engine) -> Result<u8>) -> Result<u8> {
        let method = match name {
            EngineName::SlepcKrylovSchur => RealModesMethod::KrylovSchur,
            EngineName::Slepc | EngineName::Mpi => RealModesMethod::BlockLanczos,
        };
        match start(&VERSION, method)? {
            Role::Ended => Ok(SUCCESS),
            Role::Lead(cluster) => {
                let done = work(&Engine::new(Arc::new(cluster.clone())));
                cluster.end();
                done
            }
        }
    }

    /// Shares the points of the studies of a case that `analysis` takes; the results on rank 0.
    pub fn shared_points(
        read: impl FnOnce() -> Result<Case>,
        analysis: &'static str,
        out: &Path,
        quiet: bool,
    ) -> Result<Option<RunResults>> {
        let world = Arc::new(World::start()?);
        let bars = Bars::new(quiet || world.rank() > 0);
        if !same_build(&world, &VERSION)? {
            return Ok(None);
        }
        studies_on_ranks(read(), analysis, out, &world, &bars)
    }
}
