//! Several symmetric matrices on one pattern, for products with all of them at once.
//!
//! A sparse product is bound by reading the indices and gathering the rows of x. K, M and C of a structure have both in
//! common, so that three products cost little more than one.

use super::SparseMatrix;
use super::sparse::{PANEL, ROWS_A_TASK, pack};
use faer::{Mat, MatMut, MatRef};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Symmetric matrices of one size (one to four), stored whole on the union of their patterns.
#[derive(Debug, Clone)]
pub struct Merged {
    count: usize,
    starts: Vec<usize>,
    rows: Vec<u32>,
    /// The values of all matrices in an entry, side by side.
    values: Vec<f64>,
}

impl Merged {
    /// Lays `matrices` side by side.
    ///
    /// # Panics
    /// When there are none or more than four, when their sizes differ, or beyond 2³² rows.
    pub fn new(matrices: &[&SparseMatrix]) -> Self {
        let (count, n) = (matrices.len(), matrices[0].ncols());
        assert!((1..=4).contains(&count) && u32::try_from(n).is_ok(), "one to four matrices");
        assert!(matrices.iter().all(|a| a.ncols() == n && a.nrows() == n), "matrices of one size");
        let parts: Vec<(Vec<usize>, Vec<u32>, Vec<f64>)> = (0..n.div_ceil(ROWS_A_TASK))
            .into_par_iter()
            .map(|task| {
                let (mut lengths, mut rows, mut values) = (Vec::new(), Vec::new(), Vec::new());
                for j in task * ROWS_A_TASK..n.min((task + 1) * ROWS_A_TASK) {
                    let before = rows.len();
                    merge_column(matrices, j, &mut rows, &mut values);
                    lengths.push(rows.len() - before);
                }
                (lengths, rows, values)
            })
            .collect();
        let entries = parts.iter().map(|part| part.1.len()).sum();
        let mut merged = Merged {
            count,
            starts: vec![0],
            rows: Vec::with_capacity(entries),
            values: Vec::with_capacity(count * entries),
        };
        let mut end = 0;
        for (lengths, rows, values) in parts {
            for length in lengths {
                end += length;
                merged.starts.push(end);
            }
            merged.rows.extend(rows);
            merged.values.extend(values);
        }
        merged
    }

    /// A x of every matrix A, in their order. Every entry is one sum in a fixed order: the same bits for any number of
    /// threads.
    ///
    /// # Panics
    /// When the shapes do not agree.
    pub fn times(&self, x: MatRef<'_, f64>) -> Vec<Mat<f64>> {
        let n = self.starts.len() - 1;
        assert!(x.nrows() == n, "shapes of A and x disagree");
        let mut products = vec![Mat::zeros(n, x.ncols()); self.count];
        for start in (0..x.ncols()).step_by(PANEL) {
            let width = PANEL.min(x.ncols() - start);
            let packed = pack::<f64, PANEL>(x.subcols(start, width));
            let mut tasks: Vec<Vec<MatMut<'_, f64>>> = Vec::new();
            tasks.resize_with(n.div_ceil(ROWS_A_TASK), Vec::new);
            for product in &mut products {
                let columns = product.as_mut().subcols_mut(start, width);
                let chunks: Vec<_> = columns.par_row_chunks_mut(ROWS_A_TASK).collect();
                tasks.iter_mut().zip(chunks).for_each(|(task, chunk)| task.push(chunk));
            }
            tasks.into_par_iter().enumerate().for_each(|(task, parts)| {
                let first = task * ROWS_A_TASK;
                match self.count {
                    1 => self.rows_times::<1>(first, &packed, parts),
                    2 => self.rows_times::<2>(first, &packed, parts),
                    3 => self.rows_times::<3>(first, &packed, parts),
                    _ => self.rows_times::<4>(first, &packed, parts),
                }
            });
        }
        products
    }

    fn rows_times<const C: usize>(
        &self,
        first: usize,
        packed: &[[f64; PANEL]],
        mut parts: Vec<MatMut<'_, f64>>,
    ) {
        let rows = parts.first().map_or(0, |part| part.nrows());
        let mut sums = vec![[[0.0; PANEL]; C]; rows];
        Arch::new().dispatch(Rows { merged: self, first, packed, sums: &mut sums });
        for (a, part) in parts.iter_mut().enumerate() {
            for c in 0..part.ncols() {
                part.as_mut().col_mut(c).iter_mut().zip(&sums).for_each(|(y, sum)| *y = sum[a][c]);
            }
        }
    }
}

/// The rows of all matrices from `first` on, times packed columns.
struct Rows<'a, const C: usize> {
    merged: &'a Merged,
    first: usize,
    packed: &'a [[f64; PANEL]],
    sums: &'a mut [[[f64; PANEL]; C]],
}

impl<const C: usize> WithSimd for Rows<'_, C> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (starts, (values, _)) = (&self.merged.starts, self.merged.values.as_chunks::<C>());
        for (i, sums) in self.sums.iter_mut().enumerate() {
            let entries = starts[self.first + i]..starts[self.first + i + 1];
            let mut own = [[0.0; PANEL]; C];
            for (j, v) in self.merged.rows[entries.clone()].iter().zip(&values[entries]) {
                let x = &self.packed[*j as usize];
                for a in 0..C {
                    for c in 0..PANEL {
                        own[a][c] += x[c] * v[a];
                    }
                }
            }
            *sums = own;
        }
    }
}

/// Appends the rows of column `j` that any of the matrices has, with the values of all.
fn merge_column(matrices: &[&SparseMatrix], j: usize, rows: &mut Vec<u32>, values: &mut Vec<f64>) {
    let mut open: Vec<_> = matrices
        .iter()
        .map(|a| a.row_idx_of_col_raw(j).iter().copied().zip(a.val_of_col(j).iter().copied()).peekable())
        .collect();
    while let Some(row) = open.iter_mut().filter_map(|entries| entries.peek().map(|(i, _)| *i)).min() {
        rows.push(row as u32);
        values.extend(open.iter_mut().map(|e| e.next_if(|(i, _)| *i == row).map_or(0.0, |(_, v)| v)));
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples;
    use super::super::sparse::times;
    use super::*;

    #[test]
    fn products_equal_those_of_each_matrix() {
        let matrices: Vec<_> = (1..5).map(|seed| samples::random_symmetric(61, seed)).collect();
        let x = Mat::from_fn(61, 11, |i, j| ((i * 7 + j * 3) as f64).sin());
        for count in 1..=4 {
            let given: Vec<_> = matrices[..count].iter().collect();
            let products = Merged::new(&given).times(x.as_ref());
            assert_eq!(products.len(), count);
            for (product, a) in products.iter().zip(given) {
                assert!((product - times(a, x.as_ref())).norm_max() < 1e-13);
            }
        }
    }
}
