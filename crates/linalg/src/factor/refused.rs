//! Errors of a factorisation.

use stridor_base::error::Error;

/// The error of a factorisation of `n` unknowns, with what was `said`.
pub(super) fn out_of_memory(n: usize, said: &str) -> Error {
    Error::analysis(
        format!("factorisation of {n} unknowns"),
        format!("memory does not suffice ({said})"),
        "Take a coarser mesh, or a machine with more memory",
    )
}

/// What the error of a singular matrix begins with.
const SINGULAR: &str = "the matrix is singular";

/// Whether this is the error of a matrix that is [`singular`].
pub fn is_singular(error: &Error) -> bool {
    matches!(error, Error::Analysis { found, .. } if found.starts_with(SINGULAR))
}

/// The error of a matrix that is singular; `found` says how that was seen.
pub fn singular(found: impl std::fmt::Display) -> Error {
    Error::analysis(
        "factorisation",
        format!("{SINGULAR}: {found}"),
        "A part that nothing holds, a degree of freedom without stiffness and mass, or a shift on an eigenvalue does this",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_that_does_not_suffice_is_no_singular_matrix() {
        assert!(is_singular(&singular("elimination stops at row 3 of 5")));
        assert!(!is_singular(&out_of_memory(5, "2 GiB")));
    }
}
