//! Error for a factorisation that does not fit into memory.

use crate::error::Error;

/// The error of a factorisation of `n` unknowns, with what was `said`.
pub(super) fn out_of_memory(n: usize, said: &str) -> Error {
    Error::analysis(
        format!("factorisation of {n} unknowns"),
        format!("memory does not suffice ({said})"),
        "Take a coarser mesh, or a machine with more memory",
    )
}
