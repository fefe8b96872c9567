//! Products of tall matrices: thousands of rows, tens or hundreds of columns.
//!
//! Work is split over fixed ranges of rows, and sums are added in the order of the ranges: the same bits for any number
//! of threads.

use super::dense::product;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use rayon::prelude::*;

/// Rows that one task works on.
pub(super) const ROWS: usize = 8192;

/// AᵀB: partial products of fixed ranges of rows, added in their order.
pub fn gram(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    let n = a.nrows();
    let parts: Vec<Mat<f64>> = (0..n.div_ceil(ROWS))
        .into_par_iter()
        .map(|task| {
            let (start, rows) = (task * ROWS, ROWS.min(n - task * ROWS));
            product(a.subrows(start, rows).transpose(), b.subrows(start, rows))
        })
        .collect();
    let mut sum = Mat::zeros(a.ncols(), b.ncols());
    for part in parts {
        sum += part;
    }
    sum
}

/// Y (+)= factor · V C, over fixed ranges of rows.
pub fn combine(y: MatMut<'_, f64>, accumulate: Accum, v: MatRef<'_, f64>, c: MatRef<'_, f64>, factor: f64) {
    y.par_row_chunks_mut(ROWS).enumerate().for_each(|(task, y)| {
        let v = v.subrows(task * ROWS, y.nrows());
        faer::linalg::matmul::matmul(y, accumulate, v, c, factor, Par::Seq);
    });
}

/// V C as a new matrix, over fixed ranges of rows.
pub fn expand(v: MatRef<'_, f64>, c: MatRef<'_, f64>) -> Mat<f64> {
    let mut y = Mat::zeros(v.nrows(), c.ncols());
    combine(y.as_mut(), Accum::Replace, v, c, 1.0);
    y
}
