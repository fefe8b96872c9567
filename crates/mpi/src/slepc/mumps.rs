//! Real symmetric matrices factorised by MUMPS.

use super::{World, alone, ffi};
use std::ffi::c_int;
use std::ptr::NonNull;
use stridor_base::error::{Error, Result};
use stridor_linalg::Inertia;
use stridor_linalg::factor::singular;

/// Places of the entries of one triangle of a symmetric n × n matrix that this rank holds, from 1.
#[derive(Debug, Clone)]
pub struct Entries {
    /// n.
    pub n: c_int,
    /// Row of each entry.
    pub rows: Vec<c_int>,
    /// Column of each entry.
    pub columns: Vec<c_int>,
    /// The place of every row in the order of elimination, from 1; empty on other ranks than 0.
    pub place: Vec<c_int>,
}

/// A = L B Lᵀ, spread over all ranks.
#[derive(Debug)]
pub struct DistributedFactor {
    factor: NonNull<ffi::Factor>,
    n: usize,
    inertia: Inertia,
}

// SAFETY: a factor is used by one thread at a time, which `&mut` ensures, and MPI was started for calls from several threads.
unsafe impl Send for DistributedFactor {}

impl DistributedFactor {
    /// Factorises the matrix with the `values` of `entries`; collective. Where factors are not `kept` only their inertia is known.
    ///
    /// # Errors
    /// The matrix is singular to the last bit; memory does not suffice.
    pub fn new(_: &World, entries: &mut Entries, values: &mut [f64], kept: bool) -> Result<Self> {
        let Entries { n, rows, columns, place } = entries;
        let mut status = 0;
        let alone_while_factorizing = alone();
        // SAFETY: the arrays have the stated lengths and are not used by MUMPS after the call: it holds the pointers, but reads them
        // during analysis and factorisation alone.
        let factor = unsafe {
            ffi::stridor_mumps_new(
                *n,
                values.len() as i64,
                rows.as_mut_ptr(),
                columns.as_mut_ptr(),
                values.as_mut_ptr(),
                place.as_mut_ptr(),
                c_int::from(kept),
                &mut status,
            )
        };
        drop(alone_while_factorizing);
        let factor = NonNull::new(factor).ok_or_else(|| failure(-13, 0))?;
        let mut factor = DistributedFactor { factor, n: *n as usize, inertia: Inertia::default() };
        if status < 0 {
            return Err(failure(status, factor.infog(2)));
        }
        let (negative, zero) = (factor.infog(12) as usize, factor.infog(28) as usize);
        factor.inertia = Inertia { negative, zero, positive: factor.n - negative - zero };
        Ok(factor)
    }

    /// The order of A.
    pub fn n(&self) -> usize {
        self.n
    }

    /// Negative, zero and positive eigenvalues of A.
    pub fn inertia(&self) -> Inertia {
        self.inertia
    }

    /// Bytes of the factors on all ranks.
    pub fn memory_bytes(&self) -> usize {
        // INFOG(9): numbers in the factors, in millions where it is negative.
        match self.infog(9) {
            millions @ ..0 => 8_000_000 * millions.unsigned_abs() as usize,
            numbers => 8 * numbers as usize,
        }
    }

    pub(super) fn as_ptr(&mut self) -> *mut ffi::Factor {
        self.factor.as_ptr()
    }

    /// The right-hand sides on rank 0 (n × k, column after column, nothing on other ranks) become solutions; collective.
    ///
    /// # Errors
    /// Memory does not suffice.
    ///
    /// # Panics
    /// When `columns` are not whole ones.
    pub fn solve(&mut self, columns: &mut [f64], count: usize) -> Result<()> {
        assert!(columns.is_empty() || columns.len() == self.n * count, "whole columns");
        let _alone = alone();
        // SAFETY: on rank 0 the array holds `count` columns of n numbers; elsewhere MUMPS does not read it.
        let status = unsafe {
            ffi::stridor_mumps_solve(
                self.factor.as_ptr(),
                columns.as_mut_ptr(),
                count as c_int,
                self.n as c_int,
            )
        };
        if status < 0 { Err(failure(status, self.infog(2))) } else { Ok(()) }
    }

    fn infog(&self, k: c_int) -> c_int {
        // SAFETY: the factor lives; INFOG has 80 numbers.
        unsafe { ffi::stridor_mumps_infog(self.factor.as_ptr(), k) }
    }
}

impl Drop for DistributedFactor {
    fn drop(&mut self) {
        let _alone = alone();
        // SAFETY: it lives until here, and MPI still runs.
        unsafe { ffi::stridor_mumps_free(self.factor.as_ptr()) };
    }
}

/// INFOG(1) and INFOG(2) of MUMPS as an error (MUMPS Users' guide, section 8).
fn failure(status: c_int, detail: c_int) -> Error {
    let codes = format!("INFOG(1) = {status}, INFOG(2) = {detail}");
    match status {
        -10 | -6 => singular(format!("MUMPS stops, {codes}")),
        -5 | -7 | -8 | -9 | -11 | -13 | -14 | -15 | -17 | -18 | -19 | -20 => Error::analysis(
            "factorisation by MUMPS",
            format!("memory does not suffice on a rank ({codes})"),
            "Take more ranks on more machines, fewer ranks on each machine, or a coarser mesh",
        ),
        -51 | -52 => Error::analysis(
            "factorisation by MUMPS",
            format!("the pattern is too large for its 32-bit indices ({codes})"),
            "Build MUMPS and its orderings with 64-bit integers, or take a coarser mesh",
        ),
        _ => Error::analysis(
            "factorisation by MUMPS",
            format!("error {codes}"),
            "The codes are explained in the MUMPS Users' guide, section on error diagnostics",
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::failure;
    use stridor_linalg::factor::is_singular;

    #[test]
    fn codes_of_mumps_have_words() {
        for (code, words) in [
            (-10, "singular"),
            (-13, "memory"),
            (-7, "memory"),
            (-9, "memory"),
            (-51, "64-bit"),
            (-90, "INFOG(1) = -90"),
        ] {
            let text = failure(code, 7).to_string();
            assert_eq!(is_singular(&failure(code, 7)), code == -10);
            assert!(text.contains(words) && text.contains("INFOG(2) = 7"), "{text}");
        }
    }
}
