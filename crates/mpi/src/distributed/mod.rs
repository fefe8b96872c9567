//! The distributed engine: matrices factorised over the ranks of an MPI program.
//!
//! Rank 0 runs the analysis as a program of one process does: it reads the case, assembles M and K and holds the vectors. What grows
//! fastest with the mesh, the factors, is spread over all ranks ([`Cluster`], a [`Backend`] of [`Engine`]): METIS shares out the rows,
//! each rank receives those of its own and hands them to MUMPS, which factorises and solves in parallel, or to SLEPc, whose TOAR
//! confirms the complex modes and whose Krylov–Schur method finds the real ones where that is asked for ([`RealModesMethod`]). The
//! other ranks serve: they wait for commands of rank 0 and perform them with it. Only rank 0 reads and writes files then, so that ranks
//! cannot have different ones.
//!
//! Of sweeps and maps the ranks share the points instead: [`Deal`] hands out numbers as they come free.
//!
//! [`Backend`]: stridor_linalg::factor::Backend
//! [`Engine`]: stridor_linalg::Engine

mod cluster;
mod command;
mod deal;
mod rank;
mod shares;

pub use cluster::{Cluster, RealModesMethod};
pub use deal::Deal;

use crate::slepc::World;
use rank::serve;
use stridor_base::error::{Error, Result};

/// What this process is to do.
#[derive(Debug)]
pub enum Role {
    /// Rank 0: run the analysis.
    Lead(Cluster),
    /// Another rank, whose work is over. It ends with exit code 0 whatever the result: at another one `mpirun` ends rank 0, which may
    /// not have written its message yet.
    Ended,
}

/// Starts MPI. Rank 0 comes back at once, the others when rank 0 has [ended](Cluster::end) its work.
///
/// # Errors
/// MPI cannot be started; the ranks run different builds of the program.
pub fn start(build: &str, method: RealModesMethod) -> Result<Role> {
    let world = World::start()?;
    let same = same_build(&world, build)?;
    match world.rank() {
        0 => Ok(Role::Lead(Cluster::new(world, method))),
        _ if !same => Ok(Role::Ended),
        _ => serve(world).map(|()| Role::Ended),
    }
}

/// Whether all ranks run the same build.
///
/// # Errors
/// On rank 0, when they do not.
pub fn same_build(world: &World, build: &str) -> Result<bool> {
    match first_that_differs(world, build)? {
        None => Ok(true),
        Some(_) if world.rank() > 0 => Ok(false),
        Some(rank) => Err(Error::analysis(
            "starting MPI",
            format!("rank {rank} runs another build of stridor than rank 0"),
            "Install the same program on all machines",
        )),
    }
}

/// The first rank whose `text` is not that of rank 0; collective.
pub fn first_that_differs(world: &World, text: &str) -> Result<Option<usize>> {
    let own = fingerprint(text);
    let mut first = [own];
    world.broadcast(&mut first)?;
    let mut verdict = [0u64];
    if world.rank() == 0 {
        for rank in 1..world.size() {
            if world.receive::<u64>(rank)? != [1] && verdict[0] == 0 {
                verdict[0] = rank as u64;
            }
        }
    } else {
        world.send(&[u64::from(first[0] == own)], 0)?;
    }
    world.broadcast(&mut verdict)?;
    Ok((verdict[0] > 0).then_some(verdict[0] as usize))
}

/// FNV-1a.
fn fingerprint(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}
