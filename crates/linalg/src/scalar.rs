//! Numbers that real matrices multiply.

use super::{SparseMatrix, sparse};
use faer::{MatMut, MatRef, c64};
use std::ops::{AddAssign, Mul};

/// A number that a real sparse matrix can multiply: `f64` or `c64`.
pub trait Scalar: Copy + Default + Send + Sync + AddAssign + Mul<f64, Output = Self> + 'static {
    /// 0.
    const ZERO: Self;
    /// [`sparse::multiply`], compiled here rather than where it is called, with all that it calls beside it.
    #[doc(hidden)]
    fn multiply(a: &SparseMatrix, x: MatRef<'_, Self>, y: MatMut<'_, Self>);
}

impl Scalar for f64 {
    const ZERO: Self = 0.0;

    fn multiply(a: &SparseMatrix, x: MatRef<'_, f64>, y: MatMut<'_, f64>) {
        sparse::multiply_panels(a, x, y);
    }
}

impl Scalar for c64 {
    const ZERO: Self = c64::new(0.0, 0.0);

    fn multiply(a: &SparseMatrix, x: MatRef<'_, c64>, y: MatMut<'_, c64>) {
        sparse::multiply_panels(a, x, y);
    }
}
