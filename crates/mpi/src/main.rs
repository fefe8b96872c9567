//! The program `stridor-mpi`: `stridor` with `--engine`, for analyses over the ranks of an MPI program.

mod studies;

use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use stridor::case::Case;
use stridor::cli::{OrExit, Ranks, VERSION, process};
use stridor::error::Result;
use stridor::linalg::Engine;
use stridor::progress::Observer;
use stridor::results::RunResults;
use stridor_mpi::distributed::{RealModesMethod, Role, same_build, start};
use stridor_mpi::slepc::World;

#[global_allocator]
static MEMORY: OrExit = OrExit;

fn main() -> ExitCode {
    process(Some(&Mpi))
}

/// The ranks of `mpirun`.
struct Mpi;

impl Ranks for Mpi {
    fn matrices(&self, krylov_schur: bool, work: &mut dyn FnMut(&Engine) -> Result<()>) -> Result<()> {
        let method = if krylov_schur { RealModesMethod::KrylovSchur } else { RealModesMethod::BlockLanczos };
        match start(&VERSION, method)? {
            Role::Ended => Ok(()),
            Role::Lead(cluster) => {
                let done = work(&Engine::new(Arc::new(cluster.clone())));
                cluster.end();
                done
            }
        }
    }

    fn points(
        &self,
        case: Result<Case>,
        analysis: &'static str,
        out: &Path,
        observer: &dyn Observer,
    ) -> Result<Option<RunResults>> {
        let world = Arc::new(World::start()?);
        if !same_build(&world, &VERSION)? {
            return Ok(None);
        }
        // Rank 0 shows the progress.
        let observer = if world.rank() == 0 { observer } else { &() };
        studies::over_ranks(case, analysis, out, &world, observer)
    }
}
