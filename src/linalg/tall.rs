//! Products of tall matrices, real or complex: thousands of rows, tens or hundreds of columns.
//!
//! Work is split over fixed ranges of rows, and sums are added in the order of the ranges: the same bits for any number
//! of threads.

mod real;

use super::c64;
use super::dense::product;
use faer::traits::ComplexField;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use rayon::prelude::*;

/// Columns that go through the matrices together where there may be many.
const PANEL: usize = 32;

/// The columns of a wide matrix a few at a time, as first column and width, so that little memory is held beside them.
pub fn panels(columns: std::ops::Range<usize>) -> impl Iterator<Item = (usize, usize)> {
    let end = columns.end;
    columns.step_by(PANEL).map(move |start| (start, PANEL.min(end - start)))
}

/// Rows that one task works on.
pub(super) const ROWS: usize = 8192;

/// Numbers of tall matrices, `f64` or [`c64`].
pub trait Entry: ComplexField {
    /// AᴴB.
    fn gram(a: MatRef<'_, Self>, b: MatRef<'_, Self>) -> Mat<Self>;

    /// Y (+)= factor · V C.
    fn combine(
        y: MatMut<'_, Self>,
        accumulate: Accum,
        v: MatRef<'_, Self>,
        c: MatRef<'_, Self>,
        factor: Self,
    );
}

impl Entry for f64 {
    fn gram(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
        real::gram(a, b).unwrap_or_else(|| gram_by_ranges(a, b))
    }

    fn combine(
        mut y: MatMut<'_, f64>,
        accumulate: Accum,
        v: MatRef<'_, f64>,
        c: MatRef<'_, f64>,
        factor: f64,
    ) {
        if !real::combine(vec![(y.as_mut(), c)], accumulate, v, factor) {
            combine_by_ranges(y, accumulate, v, c, factor);
        }
    }
}

impl Entry for c64 {
    fn gram(a: MatRef<'_, c64>, b: MatRef<'_, c64>) -> Mat<c64> {
        gram_by_ranges(a, b)
    }

    fn combine(y: MatMut<'_, c64>, accumulate: Accum, v: MatRef<'_, c64>, c: MatRef<'_, c64>, factor: c64) {
        combine_by_ranges(y, accumulate, v, c, factor);
    }
}

/// AᴴB: partial products of fixed ranges of rows, added in their order.
pub fn gram<T: Entry>(a: MatRef<'_, T>, b: MatRef<'_, T>) -> Mat<T> {
    T::gram(a, b)
}

/// Y (+)= factor · V C, over fixed ranges of rows.
pub fn combine<T: Entry>(y: MatMut<'_, T>, accumulate: Accum, v: MatRef<'_, T>, c: MatRef<'_, T>, factor: T) {
    T::combine(y, accumulate, v, c, factor);
}

/// Yₖ = V Cₖ for several: of a tall V most of the time is that of reading it.
pub fn expand_into(mut parts: Vec<(MatMut<'_, f64>, MatRef<'_, f64>)>, v: MatRef<'_, f64>) {
    let again = parts.iter_mut().map(|(y, c)| (y.as_mut(), *c)).collect();
    if !real::combine(again, Accum::Replace, v, 1.0) {
        parts.into_iter().for_each(|(y, c)| combine_by_ranges(y, Accum::Replace, v, c, 1.0));
    }
}

fn gram_by_ranges<T: ComplexField>(a: MatRef<'_, T>, b: MatRef<'_, T>) -> Mat<T> {
    let n = a.nrows();
    let parts: Vec<Mat<T>> = (0..n.div_ceil(ROWS))
        .into_par_iter()
        .map(|task| {
            let (start, rows) = (task * ROWS, ROWS.min(n - task * ROWS));
            let (a, b) = (a.subrows(start, rows), b.subrows(start, rows));
            let mut part = Mat::zeros(a.ncols(), b.ncols());
            let one = faer::traits::math_utils::one::<T>();
            faer::linalg::matmul::matmul(part.as_mut(), Accum::Replace, a.adjoint(), b, one, Par::Seq);
            part
        })
        .collect();
    let mut sum = Mat::zeros(a.ncols(), b.ncols());
    for part in parts {
        sum += part;
    }
    sum
}

fn combine_by_ranges<T: ComplexField>(
    y: MatMut<'_, T>,
    accumulate: Accum,
    v: MatRef<'_, T>,
    c: MatRef<'_, T>,
    factor: T,
) {
    y.par_row_chunks_mut(ROWS).enumerate().for_each(|(task, y)| {
        let v = v.subrows(task * ROWS, y.nrows());
        faer::linalg::matmul::matmul(y, accumulate, v, c, factor.clone(), Par::Seq);
    });
}

/// The first columns of V become V C, range of rows by range of rows.
pub fn rotate(v: MatMut<'_, f64>, c: MatRef<'_, f64>) {
    v.par_row_chunks_mut(ROWS).for_each(|mut v| {
        let rotated = product(v.as_ref(), c);
        v.as_mut().subcols_mut(0, c.ncols()).copy_from(&rotated);
    });
}

/// \[A B\].
pub fn beside(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    let mut both = Mat::zeros(b.nrows(), a.ncols() + b.ncols());
    both.subcols_mut(0, a.ncols()).copy_from(a);
    both.subcols_mut(a.ncols(), b.ncols()).copy_from(b);
    both
}

/// V C as a new matrix, over fixed ranges of rows.
pub fn expand<T: Entry>(v: MatRef<'_, T>, c: MatRef<'_, T>) -> Mat<T> {
    let mut y = Mat::zeros(v.nrows(), c.ncols());
    combine(y.as_mut(), Accum::Replace, v, c, faer::traits::math_utils::one::<T>());
    y
}
