//! The kernels of real matrices stored by columns: nothing tall is copied, a few columns stay in registers.
//!
//! A general product first copies its operands into an order of its own, which pays when each entry is used often. Here the
//! other matrix is narrow, so that the copy would cost as much as the product.

use super::super::lanes::pack;
use super::super::sparse::columns_mut;
use faer::{Accum, Mat, MatMut, MatRef};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::ops::Range;

/// Rows that one task works on.
pub(super) const ROWS: usize = 8192;
/// Rows that stay in the cache while all columns pass.
const SLAB: usize = 1024;

/// AᵀB.
pub(super) fn gram(n: usize, columns: &[&[f64]], others: &[&[f64]]) -> Mat<f64> {
    let parts: Vec<Vec<[f64; LANES]>> = (0..n.div_ceil(ROWS))
        .into_par_iter()
        .map(|task| {
            let mut sums = vec![[0.0; LANES]; columns.len() * others.len().div_ceil(LANES)];
            let rows = task * ROWS..n.min((task + 1) * ROWS);
            Arch::new().dispatch(Dots { a: columns, b: others, rows, sums: &mut sums });
            sums
        })
        .collect();
    let mut sum = Mat::zeros(columns.len(), others.len());
    for part in parts {
        for j in 0..others.len() {
            let part = &part[j / LANES * columns.len()..];
            sum.col_as_slice_mut(j).iter_mut().zip(part).for_each(|(sum, part)| *sum += part[j % LANES]);
        }
    }
    sum
}

/// Y (+)= factor · V C; false, and nothing done, where a column of Y is not in one piece.
pub(super) fn combine(
    mut y: MatMut<'_, f64>,
    c: MatRef<'_, f64>,
    accumulate: Accum,
    v: &[&[f64]],
    factor: f64,
) -> bool {
    let n = y.nrows();
    let Some(y_columns) = columns_mut(y.as_mut()) else { return false };
    let fits = c.nrows() == v.len() && c.ncols() == y_columns.len() && v.iter().all(|v| v.len() == n);
    assert!(fits, "shapes of Y, V and C disagree");
    let coefficients = side_by_side(c, factor);
    let mut tasks: Vec<Vec<&mut [f64]>> = Vec::new();
    tasks.resize_with(n.div_ceil(ROWS), Vec::new);
    for column in y_columns {
        tasks.iter_mut().zip(column.chunks_mut(ROWS)).for_each(|(task, rows)| task.push(rows));
    }
    let anew = matches!(accumulate, Accum::Replace);
    tasks.par_iter_mut().enumerate().for_each(|(task, y)| {
        Arch::new().dispatch(Sums { y, anew, first: task * ROWS, v, c: &coefficients });
    });
    true
}

/// The first columns of V become V C, a slab at a time: what it was is copied to where it stays in the cache.
pub(super) fn rotate(mut v: Vec<&mut [f64]>, c: MatRef<'_, f64>) {
    let (n, m) = (v.first().map_or(0, |v| v.len()), v.len());
    assert!(c.nrows() == m && c.ncols() <= m, "shapes of V and C disagree");
    let coefficients = side_by_side(c, 1.0);
    let mut slabs: Vec<Vec<&mut [f64]>> = Vec::new();
    slabs.resize_with(n.div_ceil(SLAB), Vec::new);
    for column in &mut v {
        slabs.iter_mut().zip(column.chunks_mut(SLAB)).for_each(|(slab, rows)| slab.push(rows));
    }
    slabs.par_iter_mut().for_each_init(Vec::new, |before: &mut Vec<f64>, slab| {
        before.clear();
        slab.iter().for_each(|column| before.extend_from_slice(column));
        let before: Vec<&[f64]> = before.chunks(slab[0].len()).collect();
        let y = &mut slab[..c.ncols()];
        Arch::new().dispatch(Sums { y, anew: true, first: 0, v: &before, c: &coefficients });
    });
}

/// The entries of C, a few columns side by side.
fn side_by_side(c: MatRef<'_, f64>, factor: f64) -> Vec<[f64; TOGETHER]> {
    let groups = (0..c.ncols()).step_by(TOGETHER).flat_map(|first| (0..c.nrows()).map(move |j| (first, j)));
    let entry = |j: usize, k: usize| if k < c.ncols() { factor * c[(j, k)] } else { 0.0 };
    groups.map(|(first, j)| std::array::from_fn(|t| entry(j, first + t))).collect()
}

/// Columns of B in a row of sums.
const LANES: usize = 8;

/// AᵀB over some rows.
struct Dots<'a> {
    a: &'a [&'a [f64]],
    b: &'a [&'a [f64]],
    rows: Range<usize>,
    /// A row of sums for each column of A, for the first columns of B, then for the next.
    sums: &'a mut [[f64; LANES]],
}

impl WithSimd for Dots<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        // As many rows of sums as the registers hold beside what they are made of.
        if S::REGISTER_COUNT >= 32 { self.run::<8>() } else { self.run::<4>() }
    }
}

impl Dots<'_> {
    #[inline(always)]
    fn run<const G: usize>(self) {
        let m = self.a.len();
        let mut packed = vec![[0.0; LANES]; SLAB.min(self.rows.len())];
        for start in self.rows.clone().step_by(SLAB) {
            let rows = start..self.rows.end.min(start + SLAB);
            let packed = &mut packed[..rows.len()];
            for (b, sums) in self.b.chunks(LANES).zip(self.sums.chunks_mut(m.max(1))) {
                let mut some = [&[][..]; LANES];
                some.iter_mut().zip(b).for_each(|(some, b)| *some = &b[rows.clone()]);
                pack(&some[..b.len()], packed);
                let whole = m - m % G;
                for (a, sums) in self.a.chunks_exact(G).zip(sums.chunks_exact_mut(G)) {
                    add_dots::<G>(std::array::from_fn(|g| &a[g][rows.clone()]), packed, sums);
                }
                for (a, sum) in self.a[whole..].iter().zip(&mut sums[whole..]) {
                    add_dots([&a[rows.clone()]], packed, std::slice::from_mut(sum));
                }
            }
        }
    }
}

/// sums_g += Σ_i a_g,i b_i.
#[inline(always)]
fn add_dots<const G: usize>(a: [&[f64]; G], b: &[[f64; LANES]], sums: &mut [[f64; LANES]]) {
    let a = a.map(|a| &a[..b.len()]);
    let mut own = [[0.0; LANES]; G];
    for (i, b) in b.iter().enumerate() {
        for g in 0..G {
            for k in 0..LANES {
                own[g][k] = a[g][i].mul_add(b[k], own[g][k]);
            }
        }
    }
    for (sum, own) in sums.iter_mut().zip(&own) {
        (0..LANES).for_each(|k| sum[k] += own[k]);
    }
}

/// Columns of Y that have their coefficients side by side.
const TOGETHER: usize = 8;
/// Columns of V that are read side by side: as many as the processor fetches ahead of their use.
const STREAMS: usize = 16;

/// Y (+)= V C over some rows of Y, the `first` of which is that of V.
struct Sums<'a, 'y> {
    y: &'a mut [&'y mut [f64]],
    /// Whether what Y holds is forgotten.
    anew: bool,
    first: usize,
    v: &'a [&'a [f64]],
    /// A row of coefficients for each column of V, for the first columns of Y, then for the next.
    c: &'a [[f64; TOGETHER]],
}

impl WithSimd for Sums<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        // Two registers of rows for each of four columns, beside what they are made of: so there are more multiplications than
        // numbers to fetch for them.
        if S::REGISTER_COUNT >= 32 { self.run::<16>() } else { self.run::<8>() }
    }
}

impl Sums<'_, '_> {
    #[inline(always)]
    fn run<const R: usize>(self) {
        let (rows, m) = (self.y.first().map_or(0, |y| y.len()), self.v.len());
        for start in (0..rows).step_by(SLAB) {
            let own = start..rows.min(start + SLAB);
            if self.anew && m == 0 {
                self.y.iter_mut().for_each(|y| y[own.clone()].fill(0.0));
            }
            for begin in (0..m).step_by(STREAMS) {
                let anew = self.anew && begin == 0;
                let of_v = self.first + own.start..self.first + own.end;
                let v = &self.v[begin..m.min(begin + STREAMS)];
                let v: Vec<&[f64]> = v.iter().map(|v| &v[of_v.clone()]).collect();
                for (y, c) in self.y.chunks_mut(TOGETHER).zip(self.c.chunks(m)) {
                    let c = &c[begin..begin + v.len()];
                    let (fours, rest) = y.as_chunks_mut::<4>();
                    let after = 4 * fours.len();
                    for (y, from) in fours.iter_mut().zip((0..).step_by(4)) {
                        add_sums::<R, 4>(y.each_mut().map(|y| &mut y[own.clone()]), anew, &v, c, from);
                    }
                    for (y, from) in rest.iter_mut().zip(after..) {
                        add_sums::<R, 1>([&mut y[own.clone()]], anew, &v, c, from);
                    }
                }
            }
        }
    }
}

/// y_k += Σ_j v_j c_jk for the columns of c from `from` on, y_k forgotten where it is `anew`; of v there are [`STREAMS`] at most.
#[inline(always)]
fn add_sums<const R: usize, const K: usize>(
    mut y: [&mut [f64]; K],
    anew: bool,
    v: &[&[f64]],
    c: &[[f64; TOGETHER]],
    from: usize,
) {
    let rows = y[0].len();
    let blocks = rows / R;
    let (mut v_blocks, mut factors) = ([&[][..]; STREAMS], [[0.0; K]; STREAMS]);
    for ((blocks, factors), (v, c)) in v_blocks.iter_mut().zip(&mut factors).zip(v.iter().zip(c)) {
        (*blocks, *factors) = (v.as_chunks().0, std::array::from_fn(|k| c[from + k]));
    }
    let (v_blocks, factors): (&[&[[f64; R]]], _) = (&v_blocks[..v.len()], &factors[..v.len()]);
    let mut y_blocks = y.each_mut().map(|y| &mut y.as_chunks_mut().0[..blocks]);
    for i in 0..blocks {
        let mut own: [[f64; R]; K] =
            if anew { [[0.0; R]; K] } else { std::array::from_fn(|k| y_blocks[k][i]) };
        for (v, c) in v_blocks.iter().zip(factors) {
            let v = &v[i];
            for k in 0..K {
                for r in 0..R {
                    own[k][r] = v[r].mul_add(c[k], own[k][r]);
                }
            }
        }
        for (y, own) in y_blocks.iter_mut().zip(own) {
            y[i] = own;
        }
    }
    for i in blocks * R..rows {
        if anew {
            y.iter_mut().for_each(|y| y[i] = 0.0);
        }
        for (v, c) in v.iter().zip(factors) {
            for (y, c) in y.iter_mut().zip(c) {
                y[i] = v[i].mul_add(*c, y[i]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::sparse::columns;
    use super::super::{combine_by_ranges, gram_by_ranges};
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn kernels_equal_general_products() {
        let wave = |n, m, s: f64| Mat::from_fn(n, m, |i, j| ((i * 7 + j * 3) as f64 * s).sin());
        // More rows than a task and a slab, and column counts on either side of all groups.
        for (n, m, w) in [(9000, 21, 11), (1030, 8, 4), (40, 3, 1), (17, 0, 5), (0, 4, 2), (300, 5, 0)] {
            let (v, x, c) = (wave(n, m, 1.0), wave(n, w, 0.7), wave(m, w, 1.3));
            let [v_columns, x_columns] = [&v, &x].map(|a| columns(a.as_ref()).unwrap());
            let square = gram(n, &v_columns, &x_columns);
            assert!(within((square - gram_by_ranges(v.as_ref(), x.as_ref())).norm_max(), 1e-11, RoundOff));
            for accumulate in [Accum::Replace, Accum::Add] {
                let (mut y, mut expected) = (x.clone(), x.clone());
                assert!(combine(y.as_mut(), c.as_ref(), accumulate, &v_columns, -0.5));
                combine_by_ranges(expected.as_mut(), accumulate, v.as_ref(), c.as_ref(), -0.5);
                assert!(within((y - expected).norm_max(), 1e-12, RoundOff));
            }
            for c in [wave(m, m, 1.3), wave(m, m / 2, 0.3)] {
                let (mut turned, expected) = (v.clone(), &v * &c);
                rotate(columns_mut(turned.as_mut()).unwrap(), c.as_ref());
                assert!(within((turned.subcols(0, c.ncols()) - expected).norm_max(), 1e-12, RoundOff));
            }
        }
    }

    /// Processors with sixteen registers take fewer rows and columns at a time.
    #[test]
    fn kernels_of_few_registers_equal_general_products() {
        let (n, m) = (1100, 21);
        let wave = |n, m, s: f64| Mat::from_fn(n, m, |i, j| ((i * 7 + j * 3) as f64 * s).sin());
        let (v, x, c) = (wave(n, m, 1.0), wave(n, LANES, 0.7), wave(m, TOGETHER, 1.3));
        let slices = |a: &Mat<f64>| (0..a.ncols()).map(|j| a.col_as_slice(j).to_vec()).collect::<Vec<_>>();
        let (v_columns, x_columns) = (slices(&v), slices(&x));
        let a: Vec<&[f64]> = v_columns.iter().map(|column| &column[..]).collect();
        let b: Vec<&[f64]> = x_columns.iter().map(|column| &column[..]).collect();
        let mut sums = vec![[0.0; LANES]; m];
        Dots { a: &a, b: &b, rows: 3..n, sums: &mut sums }.run::<4>();
        let expected = gram_by_ranges(v.subrows(3, n - 3), x.subrows(3, n - 3));
        assert!((0..m).all(|i| (0..LANES).all(|j| within(
            (sums[i][j] - expected[(i, j)]).abs(),
            1e-11,
            RoundOff
        ))));
        let mut y = vec![vec![1.0; n - 3]; TOGETHER];
        let mut columns: Vec<&mut [f64]> = y.iter_mut().map(|column| &mut column[..]).collect();
        let rows: Vec<[f64; TOGETHER]> = (0..m).map(|i| std::array::from_fn(|k| c[(i, k)])).collect();
        Sums { y: &mut columns, anew: false, first: 3, v: &a, c: &rows }.run::<8>();
        let expected = &v * &c;
        assert!((0..n - 3).all(|i| (0..TOGETHER).all(|k| within(
            (y[k][i] - 1.0 - expected[(i + 3, k)]).abs(),
            1e-12,
            RoundOff
        ))));
    }

    #[test]
    fn columns_in_pieces_are_left_to_the_general_product() {
        let a = Mat::from_fn(4, 30, |i, j| (i + j) as f64);
        assert!(columns(a.transpose()).is_none());
        assert_eq!(super::super::gram(a.transpose(), a.transpose()), &a * a.transpose());
    }
}
