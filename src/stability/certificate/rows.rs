//! Tall vectors that are zero but in some rows, such as the forces of a few dashpots and contacts, and as few directions as
//! span them.

use crate::linalg::multivector::{Columns, gram};
use crate::linalg::orthogonal::{PivotedQr, pivoted_qr};
use crate::linalg::row_sparse::RowSparse;
use crate::linalg::sparse::dot;
use faer::{Mat, MatMut};

/// Columns with entries in the rows `rows` (ascending) only.
#[derive(Debug, Clone)]
pub(super) struct ColumnBlock {
    pub(super) rows: Vec<usize>,
    pub(super) values: Mat<f64>,
}

impl ColumnBlock {
    /// Columns with entries everywhere.
    pub(super) fn whole(values: Mat<f64>) -> Self {
        ColumnBlock { rows: (0..values.nrows()).collect(), values }
    }

    /// D B.
    pub(super) fn image(d: &RowSparse, b: &Columns<'_>) -> Self {
        ColumnBlock { rows: d.rows().to_vec(), values: d.times_picked(b.picked(d.rows()).as_ref()) }
    }

    /// The columns of both, one behind the other.
    pub(super) fn beside(&self, other: &ColumnBlock) -> Self {
        let rows = union(&self.rows, &other.rows);
        let mut values = Mat::zeros(rows.len(), self.values.ncols() + other.values.ncols());
        for (part, first) in [(self, 0), (other, self.values.ncols())] {
            let places: Vec<usize> = part.rows.iter().map(|row| rows.partition_point(|r| r < row)).collect();
            for j in 0..part.values.ncols() {
                let to = values.col_as_slice_mut(first + j);
                places.iter().zip(part.values.col_as_slice(j)).for_each(|(i, v)| to[*i] = *v);
            }
        }
        ColumnBlock { rows, values }
    }

    /// The sum of as many columns.
    pub(super) fn plus(&self, other: &ColumnBlock) -> Self {
        let (both, k) = (self.beside(other), self.values.ncols());
        ColumnBlock { values: both.values.subcols(0, k) + both.values.subcols(k, k), rows: both.rows }
    }

    /// VᵀF.
    pub(super) fn seen_by(&self, v: &Columns<'_>) -> Mat<f64> {
        gram(v.picked(&self.rows).as_ref(), self.values.as_ref())
    }

    /// Writes the columns out.
    pub(super) fn write(&self, mut out: MatMut<'_, f64>) {
        for (j, mut column) in out.as_mut().col_iter_mut().enumerate() {
            let values = self.rows.iter().zip(self.values.col_as_slice(j));
            values.for_each(|(i, v)| column[*i] = *v);
        }
    }

    /// F = G C with as few columns of G as span those of F to 1e-12 of each, the largest rest first. The columns of G are
    /// orthogonal, their sizes those of the rests.
    ///
    /// Columns with entries nearly everywhere stay as they are, and so do many that rows outnumber: there is nothing to gain that is worth it.
    pub(super) fn spanned(self) -> (ColumnBlock, Mat<f64>) {
        const NOTHING_LEFT: f64 = 1e-12;
        /// Of so many columns the decomposition takes seconds.
        const MANY: usize = 600;
        let (n, k) = (self.rows.len(), self.values.ncols());
        if n > 8 * k || n >= k && k > MANY {
            return (self, Mat::identity(k, k));
        }
        let lengths: Vec<f64> = (0..k).map(|j| length(self.values.col_as_slice(j))).collect();
        let unit = Mat::from_fn(n, k, |i, j| match lengths[j] > 0.0 {
            true => self.values[(i, j)] / lengths[j],
            false => 0.0,
        });
        let PivotedQr { q, r, order } = pivoted_qr(unit);
        let rank = (0..n.min(k)).take_while(|d| r[(*d, *d)].abs() > NOTHING_LEFT).count();
        // A direction is scaled by its largest share in the original columns.
        let share = |d: usize, j: usize| r[(d, j)] * lengths[order[j]];
        let size = |d: usize| (0..k).fold(0.0f64, |s, j| s.max(share(d, j).abs())).max(f64::MIN_POSITIVE);
        let sizes: Vec<f64> = (0..rank).map(size).collect();
        let values = Mat::from_fn(n, rank, |i, d| q[(i, d)] * sizes[d]);
        let mut coefficients = Mat::zeros(rank, k);
        for (j, column) in order.iter().enumerate() {
            (0..rank).for_each(|d| coefficients[(d, *column)] = share(d, j) / sizes[d]);
        }
        (ColumnBlock { rows: self.rows, values }, coefficients)
    }
}

fn length(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

/// Two ascending lists as one.
fn union(a: &[usize], b: &[usize]) -> Vec<usize> {
    let mut all = [a, b].concat();
    all.sort_unstable();
    all.dedup();
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::linalg::dense::product;
    use crate::linalg::samples;

    fn written(n: usize, x: &ColumnBlock) -> Mat<f64> {
        let mut all = Mat::zeros(n, x.values.ncols());
        x.write(all.as_mut());
        all
    }

    #[test]
    fn images_and_their_products_are_those_of_whole_matrices() {
        let n = 60;
        let few = Mat::from_fn(n, n, |i, j| {
            let seldom = i % 7 == 3 && j % 7 == 3;
            if seldom { ((i * j) as f64).cos() } else { 0.0 }
        });
        let d = samples::from_dense(few.as_ref());
        let b = Mat::from_fn(n, 11, |i, j| ((3 * i + 5 * j) as f64).sin());
        let image = ColumnBlock::image(&RowSparse::new(&d), &Columns::of([b.as_ref()]));
        let whole = &few * &b;
        assert!(within((written(n, &image) - &whole).norm_max(), 1e-13, RoundOff));
        assert!(within(
            (image.seen_by(&Columns::of([b.as_ref()])) - b.transpose() * &whole).norm_max(),
            1e-12,
            RoundOff
        ));
        let twice = ColumnBlock::whole(whole.clone()).plus(&image);
        assert!(within((written(n, &twice) - &whole - &whole).norm_max(), 1e-12, RoundOff));
    }

    #[test]
    fn few_directions_span_many_columns() {
        let (n, rank) = (40, 9);
        let base = Mat::from_fn(n, rank, |i, j| ((i * (2 * j + 3)) as f64 * 0.1).sin());
        // Columns of sizes over twelve orders, one of them zero.
        let mix = Mat::from_fn(rank, 25, |i, j| match j {
            7 => 0.0,
            _ => (((i + 1) * (j + 2)) as f64).cos() * 10f64.powi(j as i32 % 13 - 6),
        });
        let values = &base * &mix;
        let (few, coefficients) = ColumnBlock::whole(values.clone()).spanned();
        assert_eq!(few.values.ncols(), rank);
        let again = product(few.values.as_ref(), coefficients.as_ref());
        for j in 0..25 {
            let error = (again.col(j) - values.col(j)).norm_l2();
            assert!(within(error, 1e-11 * values.col(j).norm_l2(), RoundOff), "{j}: {error:e}");
        }
    }
}
