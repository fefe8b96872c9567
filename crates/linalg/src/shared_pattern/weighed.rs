//! Sums of products with complex vectors, and what the matrices are between those and others, in one pass: no product is
//! written down.

use super::super::c64;
use super::super::lanes::{pack, unpack};
use super::super::sparse::{ROWS_A_TASK, columns, columns_mut};
use super::{PANEL, SharedPattern, split};
use faer::{MatMut, MatRef};
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

/// Complex vectors that go through the matrices together: their real parts, then their imaginary ones.
const VECTORS: usize = PANEL / 2;
type Row = [f64; PANEL];

/// tᴴAx of every matrix A, in their order; zero beyond them.
pub type PerMatrix = [c64; 4];

/// Result of a few columns of one task.
struct Task<'y> {
    /// Re and Im of y.
    y: Vec<Vec<&'y mut [f64]>>,
    /// The first row.
    first: usize,
    /// y and then a test, row by row.
    packed: Vec<Row>,
    /// tᴴAx, that of every matrix for the first test, then for the next.
    sums: Vec<Row>,
}

impl SharedPattern<'_> {
    /// yⱼ += Σ_a factors\[a\]\[j\] A_a xⱼ for complex vectors \[Re x, Im x\] of two columns each, and tⱼᴴA_a xⱼ with that many
    /// others of every one of `tests`. The sums are in a fixed order: the same bits for any number of threads.
    ///
    /// # Panics
    /// When the shapes do not agree, or a column is in pieces.
    pub fn add_weighed(
        &self,
        factors: &[Vec<c64>],
        x: MatRef<'_, f64>,
        mut y: MatMut<'_, f64>,
        tests: &[MatRef<'_, f64>],
    ) -> Vec<Vec<PerMatrix>> {
        let (n, count) = (x.nrows(), x.ncols() / 2);
        let alike = |a: MatRef<'_, f64>| a.nrows() == n && a.ncols() == x.ncols();
        assert!(alike(y.as_ref()) && tests.iter().all(|t| alike(*t)), "shapes of x, y and tests disagree");
        let fits = |f: &Vec<c64>| f.len() == count;
        assert!(factors.len() == self.values.len() && factors.iter().all(fits), "a factor for each vector");
        let whole = |a| columns(a).expect("columns in one piece");
        let (x, tests) = (whole(x), tests.iter().map(|t| whole(*t)).collect::<Vec<_>>());
        let mut y = columns_mut(y.as_mut()).expect("columns in one piece");
        let (mut re_of_y, mut im_of_y) = y.split_at_mut(count);
        let mut forms = vec![vec![PerMatrix::default(); count]; tests.len()];
        for first in (0..count).step_by(VECTORS) {
            let few = first..count.min(first + VECTORS);
            let [x, tests] =
                [&[x.clone()][..], &tests].map(|all| all.iter().map(|a| panel(a, &few)).collect::<Vec<_>>());
            let mut tasks: Vec<Vec<Vec<&mut [f64]>>> = Vec::new();
            tasks.resize_with(n.div_ceil(ROWS_A_TASK), Vec::new);
            for part in [&mut re_of_y, &mut im_of_y] {
                let (own, rest) = std::mem::take(part).split_at_mut(few.len());
                split(own.iter_mut().map(|column| &mut **column).collect(), &mut tasks);
                *part = rest;
            }
            let of = |(number, y)| Task {
                y,
                first: number * ROWS_A_TASK,
                packed: Vec::new(),
                sums: vec![[0.0; PANEL]; tests.len() * self.values.len()],
            };
            let tasks = tasks.into_iter().enumerate().map(of).collect();
            let factors: Vec<Row> = factors.iter().map(|f| factor_row(&f[few.clone()])).collect();
            let tasks = self.visit(x[0], tasks, |task, rows, products| {
                task.take(rows, products, &factors, &tests);
            });
            for sums in tasks.iter().map(|task| &task.sums) {
                for (forms, sums) in forms.iter_mut().zip(sums.chunks(self.values.len())) {
                    for (a, sum) in sums.iter().enumerate() {
                        for (c, form) in forms[few.clone()].iter_mut().enumerate() {
                            form[a] += c64::new(sum[c], sum[VECTORS + c]);
                        }
                    }
                }
            }
        }
        forms
    }
}

/// Re and Im of a few vectors; of those that are missing the first one's.
fn panel<'a>(a: &[&'a [f64]], few: &Range<usize>) -> [&'a [f64]; PANEL] {
    let im = a.len() / 2;
    std::array::from_fn(|c| {
        let vector = few.start + if c % VECTORS < few.len() { c % VECTORS } else { 0 };
        a[if c < VECTORS { vector } else { im + vector }]
    })
}

/// Re and Im of a few factors.
fn factor_row(factors: &[c64]) -> Row {
    let factor = |c: usize| factors.get(c % VECTORS).copied().unwrap_or_default();
    std::array::from_fn(|c| if c < VECTORS { factor(c).re } else { factor(c).im })
}

impl Task<'_> {
    fn take(&mut self, rows: Range<usize>, products: &[Row], factors: &[Row], tests: &[[&[f64]; PANEL]]) {
        self.packed.resize(rows.len(), [0.0; PANEL]);
        let packed = &mut self.packed;
        let whole = self.first + rows.start..self.first + rows.end;
        for (test, sums) in tests.iter().zip(self.sums.chunks_mut(factors.len())) {
            pack(&test.map(|column| &column[whole.clone()]), packed);
            Arch::new().dispatch(Dots { products, tests: packed, sums });
        }
        let [re, im] = &mut self.y[..] else { return };
        for (part, half) in [&*re, &*im].into_iter().zip(0..) {
            for (c, column) in part.iter().enumerate() {
                packed
                    .iter_mut()
                    .zip(&column[rows.clone()])
                    .for_each(|(row, v)| row[half * VECTORS + c] = *v);
            }
        }
        Arch::new().dispatch(Sums { products, factors, y: packed });
        for (part, half) in [re, im].into_iter().zip(0..) {
            let mut columns: Vec<_> = part.iter_mut().map(|y| &mut y[rows.clone()]).collect();
            unpack(|i| packed[i].as_chunks::<VECTORS>().0[half..].first().expect("two halves"), &mut columns);
        }
    }
}

/// sums_a += tᴴ p_a row by row.
struct Dots<'a> {
    products: &'a [Row],
    tests: &'a [Row],
    sums: &'a mut [Row],
}

impl WithSimd for Dots<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let count = self.sums.len();
        for (a, sum) in self.sums.iter_mut().enumerate() {
            let mut own = *sum;
            for (t, products) in self.tests.iter().zip(self.products.chunks_exact(count)) {
                let p = &products[a];
                for c in 0..VECTORS {
                    let (tr, ti, pr, pi) = (t[c], t[VECTORS + c], p[c], p[VECTORS + c]);
                    own[c] = ti.mul_add(pi, tr.mul_add(pr, own[c]));
                    own[VECTORS + c] = (-ti).mul_add(pr, tr.mul_add(pi, own[VECTORS + c]));
                }
            }
            *sum = own;
        }
    }
}

/// y += Σ_a f_a p_a row by row.
struct Sums<'a> {
    products: &'a [Row],
    factors: &'a [Row],
    y: &'a mut [Row],
}

impl WithSimd for Sums<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (y, products) in self.y.iter_mut().zip(self.products.chunks_exact(self.factors.len())) {
            for (p, f) in products.iter().zip(self.factors) {
                for c in 0..VECTORS {
                    let (fr, fi, pr, pi) = (f[c], f[VECTORS + c], p[c], p[VECTORS + c]);
                    y[c] = (-fi).mul_add(pi, fr.mul_add(pr, y[c]));
                    y[VECTORS + c] = fi.mul_add(pr, fr.mul_add(pi, y[VECTORS + c]));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::samples;
    use super::super::super::sparse::times;
    use super::*;
    use faer::Mat;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn sums_and_forms_equal_those_of_products_that_are_written_down() {
        // More rows than a task has, and vectors on either side of a panel.
        for (side, count) in [(70, 3), (7, 8), (7, 11), (3, 0)] {
            let (stiffness, mass) = samples::membrane(side);
            let n = mass.ncols();
            let matrices = [mass, stiffness, samples::random_symmetric(n.min(50), 1)];
            let matrices = &matrices[..if n <= 50 { 3 } else { 2 }];
            let merged = SharedPattern::new(&matrices.iter().collect::<Vec<_>>());
            let wave = |s: f64| Mat::from_fn(n, 2 * count, |i, j| ((i * 7 + j * 3) as f64 * s).sin());
            let at = |a: &Mat<f64>, i: usize, j: usize| c64::new(a[(i, j)], a[(i, count + j)]);
            let (x, before, tests) = (wave(1.0), wave(0.3), [wave(0.7), wave(1.0)]);
            let factor = |a: usize, j: usize| c64::new(0.5 + a as f64, j as f64 - 2.0);
            let factors: Vec<Vec<c64>> =
                (0..matrices.len()).map(|a| (0..count).map(|j| factor(a, j)).collect()).collect();
            let mut y = before.clone();
            let forms =
                merged.add_weighed(&factors, x.as_ref(), y.as_mut(), &tests.each_ref().map(|t| t.as_ref()));
            let products: Vec<_> = matrices.iter().map(|a| times(a, x.as_ref())).collect();
            for j in 0..count {
                for i in 0..n {
                    let terms = products.iter().enumerate().map(|(a, p)| factor(a, j) * at(p, i, j));
                    let sum: c64 = terms.sum();
                    assert!(within(
                        (at(&y, i, j) - at(&before, i, j) - sum).norm(),
                        1e-12 * (1.0 + sum.norm()),
                        RoundOff
                    ));
                }
                for (test, forms) in tests.iter().zip(&forms) {
                    for (a, product) in products.iter().enumerate() {
                        let form: c64 = (0..n).map(|i| at(test, i, j).conj() * at(product, i, j)).sum();
                        assert!(within((forms[j][a] - form).norm(), 1e-11 * n as f64, RoundOff));
                    }
                }
            }
        }
    }
}
