//! Sparse matrices of PETSc, whose rows are shared out.

use super::{World, alone, check, ffi};
use std::ptr::NonNull;
use stridor_base::error::Result;

/// The rows of a square matrix that one rank holds, compressed.
#[derive(Debug, Clone, Default)]
pub struct Rows {
    /// Where each row begins, and the end of the last.
    pub starts: Vec<i64>,
    /// Column of each entry.
    pub columns: Vec<i64>,
    /// Value of each entry; real and imaginary part of it in a complex matrix.
    pub values: Vec<f64>,
}

/// Square sparse matrix of which every rank holds some consecutive rows.
#[derive(Debug)]
pub struct DistributedMatrix {
    pub(super) matrix: NonNull<ffi::Matrix>,
    n: usize,
    own: usize,
}

// SAFETY: a matrix is used by one thread at a time, which `&mut` ensures, and MPI was started for calls from several threads.
unsafe impl Send for DistributedMatrix {}

impl DistributedMatrix {
    /// The n × n matrix that the rows of all ranks make up, in the order of the ranks; collective.
    ///
    /// # Errors
    /// A part that is too large for the indices of PETSc; memory does not suffice.
    ///
    /// # Panics
    /// When the arrays of `rows` do not fit together.
    pub fn new(_: &World, n: usize, rows: &Rows) -> Result<Self> {
        let (own, entries) = (rows.starts.len() - 1, rows.columns.len());
        let parts = if rows.values.len() == 2 * entries && entries > 0 { 2 } else { 1 };
        assert!(
            rows.starts[own] as usize == entries && rows.values.len() == parts * entries,
            "compressed rows"
        );
        let mut matrix = std::ptr::null_mut();
        let _alone = alone();
        // SAFETY: the arrays have the lengths that were asserted, and PETSc copies them.
        let code = unsafe {
            ffi::stridor_matrix_new(
                n as i64,
                own as i64,
                rows.starts.as_ptr(),
                rows.columns.as_ptr(),
                rows.values.as_ptr(),
                parts as i32,
                &mut matrix,
            )
        };
        check("distributed matrix", code)?;
        Ok(DistributedMatrix { matrix: NonNull::new(matrix).expect("a matrix without an error"), n, own })
    }

    /// The order of the matrix.
    pub fn n(&self) -> usize {
        self.n
    }

    /// How many rows lie on this rank.
    pub fn own(&self) -> usize {
        self.own
    }
}

impl Drop for DistributedMatrix {
    fn drop(&mut self) {
        let _alone = alone();
        // SAFETY: it lives until here, and MPI still runs.
        unsafe { ffi::stridor_matrix_free(self.matrix.as_ptr()) };
    }
}
