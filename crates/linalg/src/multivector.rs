//! Products of multivectors, real or complex: thousands of rows, tens or hundreds of columns.
//!
//! Work is split over fixed ranges of rows, and sums are added in the order of the ranges: the same bits for any number
//! of threads.

mod real;

use super::c64;
use super::sparse::{columns, columns_mut};
use faer::traits::ComplexField;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use rayon::prelude::*;
use real::ROWS;
use std::ops::Range;

/// Columns that go through the matrices together where there may be many.
const PANEL: usize = 16;

/// The columns of a wide matrix a few at a time, as first column and width, so that little memory is held beside them.
pub fn panels(columns: Range<usize>) -> impl Iterator<Item = (usize, usize)> {
    let end = columns.end;
    columns.step_by(PANEL).map(move |start| (start, PANEL.min(end - start)))
}

/// Scalars of multivectors, `f64` or [`c64`].
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
        assert!(a.nrows() == b.nrows(), "as many rows");
        match (columns(a), columns(b)) {
            (Some(columns), Some(others)) => real::gram(a.nrows(), &columns, &others),
            _ => gram_by_ranges(a, b),
        }
    }

    fn combine(
        mut y: MatMut<'_, f64>,
        accumulate: Accum,
        v: MatRef<'_, f64>,
        c: MatRef<'_, f64>,
        factor: f64,
    ) {
        let own = columns(v).is_some_and(|v| real::combine(y.as_mut(), c, accumulate, &v, factor));
        if !own {
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

/// The columns of a real multivector V, which may lie in several places.
#[derive(Debug, Clone)]
pub struct Columns<'a> {
    rows: usize,
    each: Vec<&'a [f64]>,
}

impl<'a> Columns<'a> {
    /// Those of several matrices, one behind the other.
    ///
    /// # Panics
    /// When the matrices have different numbers of rows, or a column is in pieces.
    pub fn of<const N: usize>(parts: [MatRef<'a, f64>; N]) -> Self {
        let rows = parts.first().map_or(0, |part| part.nrows());
        assert!(parts.iter().all(|part| part.nrows() == rows), "as many rows");
        Columns {
            rows,
            each: parts.iter().flat_map(|part| columns(*part).expect("columns in one piece")).collect(),
        }
    }

    /// Some of them.
    pub fn range(&self, columns: Range<usize>) -> Self {
        Columns { rows: self.rows, each: self.each[columns].to_vec() }
    }

    /// One of them.
    pub fn column(&self, j: usize) -> &'a [f64] {
        self.each[j]
    }

    /// VᵀB.
    ///
    /// # Panics
    /// When B has another number of rows, or a column in pieces.
    pub fn gram(&self, b: MatRef<'_, f64>) -> Mat<f64> {
        assert!(b.nrows() == self.rows, "as many rows");
        real::gram(self.rows, &self.each, &columns(b).expect("columns in one piece"))
    }

    /// Y (+)= factor · V C.
    ///
    /// # Panics
    /// When the shapes disagree, or a column of Y is in pieces.
    pub fn combine(&self, y: MatMut<'_, f64>, c: MatRef<'_, f64>, accumulate: Accum, factor: f64) {
        assert!(real::combine(y, c, accumulate, &self.each, factor), "columns in one piece");
    }

    /// V C as a new matrix.
    pub fn expand(&self, c: MatRef<'_, f64>) -> Mat<f64> {
        let mut y = Mat::zeros(self.rows, c.ncols());
        self.combine(y.as_mut(), c, Accum::Replace, 1.0);
        y
    }

    /// Some rows of V.
    pub fn picked(&self, rows: &[usize]) -> Mat<f64> {
        Mat::from_fn(rows.len(), self.each.len(), |i, j| self.each[j][rows[i]])
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
///
/// # Panics
/// When a column of V is in pieces.
pub fn rotate(mut v: MatMut<'_, f64>, c: MatRef<'_, f64>) {
    real::rotate(columns_mut(v.as_mut()).expect("columns in one piece"), c);
}

/// \[A B\].
pub fn beside(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    let mut both = Mat::zeros(b.nrows(), a.ncols() + b.ncols());
    both.subcols_mut(0, a.ncols()).copy_from(a);
    both.subcols_mut(a.ncols(), b.ncols()).copy_from(b);
    both
}

/// Adds the columns of `part` after those of `all`.
pub fn append(all: &mut Mat<f64>, part: MatRef<'_, f64>) {
    let first = all.ncols();
    all.resize_with(part.nrows(), first + part.ncols(), |i, j| part[(i, j - first)]);
}

/// V C as a new matrix, over fixed ranges of rows.
pub fn expand<T: Entry>(v: MatRef<'_, T>, c: MatRef<'_, T>) -> Mat<T> {
    let mut y = Mat::zeros(v.nrows(), c.ncols());
    combine(y.as_mut(), Accum::Replace, v, c, faer::traits::math_utils::one::<T>());
    y
}
