//! Several symmetric matrices on one pattern, for products with all of them at once.
//!
//! A sparse product is bound by reading the indices and gathering the rows of x. K, M and C of a structure have both in
//! common, so that three products cost little more than one.

mod weighed;

pub use weighed::PerMatrix;

use super::SparseMatrix;
use super::lanes::{Aligned, Row, unpack};
use super::sparse::{Index, ROWS_A_TASK, columns_mut, union, with_packed, with_packed_columns};
use faer::{Mat, MatMut, MatRef};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::borrow::Cow;
use std::ops::Range;

/// Columns that go through the matrices together.
const PANEL: usize = 16;
type PackedRow = Aligned<[f64; PANEL]>;

/// Symmetric matrices of one size (one to four), stored whole on the union of their patterns.
#[derive(Debug, Clone)]
pub struct SharedPattern<'a> {
    starts: Cow<'a, [Index]>,
    rows: Cow<'a, [Index]>,
    /// The values of each matrix.
    values: Vec<Cow<'a, [f64]>>,
}

impl<'a> SharedPattern<'a> {
    /// Merges `matrices`; where all have one pattern they are borrowed as they are.
    ///
    /// # Panics
    /// When there are none or more than four, when their sizes differ, or beyond 2³² entries.
    pub fn new(matrices: &[&'a SparseMatrix]) -> Self {
        let (count, first) = (matrices.len(), matrices[0]);
        let n = first.ncols();
        assert!((1..=4).contains(&count), "one to four matrices");
        assert!(matrices.iter().all(|a| a.ncols() == n && a.nrows() == n), "matrices of one size");
        if matrices.iter().all(|a| a.col_ptr() == first.col_ptr() && a.row_idx() == first.row_idx()) {
            let values = matrices.iter().map(|a| Cow::Borrowed(a.val())).collect();
            return SharedPattern {
                starts: Cow::Borrowed(first.col_ptr()),
                rows: Cow::Borrowed(first.row_idx()),
                values,
            };
        }
        let (starts, rows, all) = union(matrices, count, |entries, values| values.copy_from_slice(entries));
        let of = |a: usize| Cow::Owned(all.iter().skip(a).step_by(count).copied().collect());
        SharedPattern {
            starts: Cow::Owned(starts),
            rows: Cow::Owned(rows),
            values: (0..count).map(of).collect(),
        }
    }

    /// The same, which borrows nothing.
    pub fn into_owned(self) -> SharedPattern<'static> {
        SharedPattern {
            starts: Cow::Owned(self.starts.into_owned()),
            rows: Cow::Owned(self.rows.into_owned()),
            values: self.values.into_iter().map(|values| Cow::Owned(values.into_owned())).collect(),
        }
    }

    /// The values of C matrices.
    fn slices<const C: usize>(&self) -> [&[f64]; C] {
        assert!(self.values.len() == C, "{} matrices", self.values.len());
        std::array::from_fn(|a| &*self.values[a])
    }

    /// A x of every matrix A, in their order, in the memory of `products`, of whatever size they are. Every entry is one sum
    /// in a fixed order: the same bits for any number of threads.
    ///
    /// # Panics
    /// When the shapes do not agree.
    pub fn times(&self, x: MatRef<'_, f64>, products: &mut Vec<Mat<f64>>) {
        let n = self.starts.len() - 1;
        assert!(x.nrows() == n, "shapes of A and x disagree");
        products.resize_with(self.values.len(), Mat::new);
        products.iter_mut().for_each(|y| y.resize_with(n, x.ncols(), |_, _| 0.0));
        for start in (0..x.ncols()).step_by(PANEL) {
            let width = PANEL.min(x.ncols() - start);
            with_packed(x.subcols(start, width), |packed: &[PackedRow]| {
                // The rows of a task of every product.
                let mut tasks: Vec<Vec<Vec<&mut [f64]>>> = Vec::new();
                tasks.resize_with(n.div_ceil(ROWS_A_TASK), Vec::new);
                for product in products.iter_mut() {
                    let columns = columns_mut(product.as_mut().subcols_mut(start, width));
                    split(columns.expect("columns in one piece"), &mut tasks);
                }
                self.each_block(packed, tasks, |task, rows, sums| {
                    for (a, columns) in task.iter_mut().enumerate() {
                        let mut columns: Vec<_> = columns.iter_mut().map(|y| &mut y[rows.clone()]).collect();
                        unpack(|i| &sums[i * self.values.len() + a], &mut columns);
                    }
                });
            });
        }
    }

    /// Products with sixteen columns that are not written down: `take` is given them a few rows at a time, with the task that
    /// the rows belong to and their places in it. A task is [`ROWS_A_TASK`] rows. Row i of the product with matrix a stands
    /// at `count` · i + a.
    ///
    /// # Panics
    /// When the numbers of rows or tasks do not agree.
    fn visit<T: Send>(
        &self,
        columns: [&[f64]; PANEL],
        tasks: Vec<T>,
        take: impl Fn(&mut T, Range<usize>, &[[f64; PANEL]]) + Sync,
    ) -> Vec<T> {
        let n = self.starts.len() - 1;
        assert!(columns.iter().all(|column| column.len() == n), "as many rows");
        with_packed_columns(&columns, n, |packed: &[PackedRow]| self.each_block(packed, tasks, take))
    }

    fn each_block<T: Send>(
        &self,
        packed: &[PackedRow],
        mut tasks: Vec<T>,
        take: impl Fn(&mut T, Range<usize>, &[[f64; PANEL]]) + Sync,
    ) -> Vec<T> {
        assert!(tasks.len() == packed.len().div_ceil(ROWS_A_TASK), "a task for some rows each");
        tasks.par_iter_mut().enumerate().for_each(|(number, task)| {
            let first = number * ROWS_A_TASK;
            let rows = first..packed.len().min(first + ROWS_A_TASK);
            match self.values.len() {
                1 => self.rows_times::<1, _>(rows, packed, task, &take),
                2 => self.rows_times::<2, _>(rows, packed, task, &take),
                3 => self.rows_times::<3, _>(rows, packed, task, &take),
                _ => self.rows_times::<4, _>(rows, packed, task, &take),
            }
        });
        tasks
    }

    fn rows_times<const C: usize, T>(
        &self,
        rows: Range<usize>,
        packed: &[PackedRow],
        task: &mut T,
        take: &impl Fn(&mut T, Range<usize>, &[[f64; PANEL]]),
    ) {
        let mut sums = [[[0.0; PANEL]; C]; BLOCK];
        for first in rows.clone().step_by(BLOCK) {
            let sums = &mut sums[..BLOCK.min(rows.end - first)];
            Arch::new().dispatch(Rows { merged: self, values: self.slices(), first, packed, sums });
            let begin = first - rows.start;
            take(task, begin..begin + sums.len(), sums.as_flattened());
        }
    }

    /// Y = A X for every matrix A with the columns of X that it wants: all from the one that stands beside Y on. X has four
    /// columns at most. As [`SharedPattern::times`], without its memory: made for a few columns again and again.
    ///
    /// # Panics
    /// When the shapes do not agree, or there are not two or three matrices.
    pub fn multiply(&self, out: &mut [(usize, MatMut<'_, f64>)], x: MatRef<'_, f64>) {
        match out {
            [a, b] => self.multiply_each([a, b], x),
            [a, b, c] => self.multiply_each([a, b, c], x),
            _ => panic!("two matrices or three"),
        }
    }

    fn multiply_each<const C: usize>(&self, out: [&mut (usize, MatMut<'_, f64>); C], x: MatRef<'_, f64>) {
        let n = self.starts.len() - 1;
        assert!(x.nrows() == n && x.ncols() <= FEW, "shapes of A and X disagree");
        let values = self.slices::<C>();
        let mut packed = Vec::new();
        let columns: [&[f64]; FEW] = std::array::from_fn(|c| slice(x, c));
        let row = |i: usize| columns.map(|column| column.get(i).copied().unwrap_or(0.0));
        (0..n).into_par_iter().with_min_len(ROWS_A_TASK).map(row).collect_into_vec(&mut packed);
        let mut tasks: Vec<[Vec<&mut [f64]>; C]> = Vec::new();
        tasks.resize_with(n.div_ceil(ROWS_A_TASK), || std::array::from_fn(|_| Vec::new()));
        let first = out.each_ref().map(|own| own.0);
        for (a, (first, y)) in out.into_iter().enumerate() {
            assert!(y.nrows() == n && *first + y.ncols() <= x.ncols(), "shapes of X and Y disagree");
            for column in y.as_mut().col_iter_mut() {
                let column = column.try_as_col_major_mut().expect("columns in one piece").as_slice_mut();
                let parts = column.chunks_mut(ROWS_A_TASK);
                tasks.iter_mut().zip(parts).for_each(|(task, part)| task[a].push(part));
            }
        }
        tasks.into_par_iter().enumerate().for_each(|(task, mut out)| {
            let rows = task * ROWS_A_TASK..n.min((task + 1) * ROWS_A_TASK);
            let mut sums = [[[0.0; FEW]; C]; BLOCK];
            for begin in rows.clone().step_by(BLOCK) {
                let sums = &mut sums[..BLOCK.min(rows.end - begin)];
                Arch::new().dispatch(Rows { merged: self, values, first: begin, packed: &packed, sums });
                for (a, columns) in out.iter_mut().enumerate() {
                    for (c, y) in columns.iter_mut().enumerate() {
                        let y = y[begin - rows.start..].iter_mut().zip(&*sums);
                        y.for_each(|(y, sum)| *y = sum[a][first[a] + c]);
                    }
                }
            }
        });
    }

    /// The values of all C matrices in every entry of the union.
    ///
    /// # Panics
    /// When there are not C matrices.
    pub fn entries<const C: usize>(&self) -> impl ExactSizeIterator<Item = [f64; C]> + Clone {
        let values = self.slices::<C>();
        (0..self.rows.len()).map(move |entry| values.map(|of| of[entry]))
    }

    /// [`SharedPattern::entries`], each behind its row and column.
    pub fn places<const C: usize>(&self) -> impl Iterator<Item = (usize, usize, [f64; C])> {
        let columns =
            self.starts.windows(2).enumerate().flat_map(|(j, ends)| (ends[0]..ends[1]).map(move |_| j));
        columns.zip(&*self.rows).zip(self.entries()).map(|((j, i), values)| (*i as usize, j, values))
    }
}

/// The most columns of [`SharedPattern::multiply`].
const FEW: usize = 4;
/// Rows whose sums are kept at hand.
const BLOCK: usize = 128;

/// Gives every task its rows of some columns.
fn split<'a>(columns: Vec<&'a mut [f64]>, tasks: &mut [Vec<Vec<&'a mut [f64]>>]) {
    let mut parts: Vec<_> = columns.into_iter().map(|column| column.chunks_mut(ROWS_A_TASK)).collect();
    tasks.iter_mut().for_each(|task| task.push(parts.iter_mut().filter_map(Iterator::next).collect()));
}

/// A column in one piece; nothing where there is none.
fn slice(x: MatRef<'_, f64>, c: usize) -> &[f64] {
    if c >= x.ncols() {
        return &[];
    }
    x.col(c).try_as_col_major().expect("columns in one piece").as_slice()
}

/// The rows of all matrices from `first` on, times packed columns.
struct Rows<'a, R, const C: usize, const W: usize> {
    merged: &'a SharedPattern<'a>,
    values: [&'a [f64]; C],
    first: usize,
    packed: &'a [R],
    sums: &'a mut [[[f64; W]; C]],
}

impl<R: Row<f64, W>, const C: usize, const W: usize> WithSimd for Rows<'_, R, C, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (starts, rows) = (&self.merged.starts, &self.merged.rows);
        for (i, sums) in self.sums.iter_mut().enumerate() {
            let entries = starts[self.first + i] as usize..starts[self.first + i + 1] as usize;
            let mut own = [[0.0; W]; C];
            let values = self.values.map(|values| &values[entries.clone()]);
            for (k, j) in rows[entries].iter().enumerate() {
                let x = self.packed[*j as usize].values();
                for a in 0..C {
                    let v = values[a][k];
                    for c in 0..W {
                        own[a][c] = x[c].mul_add(v, own[a][c]);
                    }
                }
            }
            *sums = own;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples;
    use super::super::sparse::times;
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn products_equal_those_of_each_matrix() {
        let matrices: Vec<_> = (1..5).map(|seed| samples::random_symmetric(61, seed)).collect();
        let x = Mat::from_fn(61, 11, |i, j| ((i * 7 + j * 3) as f64).sin());
        for count in 1..=4 {
            let given: Vec<_> = matrices[..count].iter().collect();
            let mut products = vec![Mat::zeros(3, 20); 2];
            SharedPattern::new(&given).times(x.as_ref(), &mut products);
            assert_eq!(products.len(), count);
            for (product, a) in products.iter().zip(given) {
                assert!(within((product - times(a, x.as_ref())).norm_max(), 1e-13, RoundOff));
            }
        }
    }

    #[test]
    fn matrices_on_one_pattern_are_borrowed_and_multiply_alike() {
        let (stiffness, mass) = samples::plate(6, false);
        let shared = SharedPattern::new(&[&mass, &stiffness]);
        assert!(shared.values.iter().all(|values| matches!(values, Cow::Borrowed(_))));
        let owned = shared.clone().into_owned();
        let x = Mat::from_fn(mass.ncols(), 5, |i, j| ((i * 7 + j * 3) as f64).sin());
        let products = |merged: &SharedPattern<'_>| {
            let mut products = Vec::new();
            merged.times(x.as_ref(), &mut products);
            products
        };
        assert_eq!(products(&shared), products(&owned));
        assert!(within(
            (&products(&shared)[1] - times(&stiffness, x.as_ref())).norm_max(),
            1e-12 * stiffness.to_dense().norm_max(),
            RoundOff
        ));
    }

    #[test]
    fn products_with_some_columns_each() {
        let [a, b, c] = [1, 2, 3].map(|seed| samples::random_symmetric(301, seed));
        let merged = SharedPattern::new(&[&a, &b, &c]);
        assert!(merged.places().all(|(i, j, v)| v == [&a, &b, &c].map(|a| *a.get(i, j).unwrap_or(&0.0))));
        let x = Mat::from_fn(301, 3, |i, j| ((i * 7 + j * 3) as f64).sin());
        let mut out = [3, 2, 1].map(|k| Mat::zeros(301, k));
        let [first, second, third] = out.each_mut().map(|y| y.as_mut());
        merged.multiply(&mut [(0, first), (1, second), (2, third)], x.as_ref());
        for (y, (begin, a)) in out.iter().zip([(0, &a), (1, &b), (2, &c)]) {
            let expected = times(a, x.subcols(begin, 3 - begin));
            assert!(within((y - expected).norm_max(), 1e-13 * a.to_dense().norm_max() * 301.0, RoundOff));
        }
    }
}
