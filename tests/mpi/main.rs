//! Analyses over the ranks of an MPI program; .ci/mpi runs them.

#[path = "../common/program.rs"]
mod program;
#[path = "../common/solid.rs"]
mod solid;
#[path = "../common/sweeps.rs"]
mod sweeps;

mod distributed;
