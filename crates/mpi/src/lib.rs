//! PETSc, SLEPc and MUMPS over MPI ([`slepc`]), and matrices factorised over the ranks of an MPI program ([`distributed`]).

pub mod distributed;
pub mod slepc;
