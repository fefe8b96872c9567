//! Blocks of complex vectors, real and imaginary parts apart, so that real matrices and factors work on all of them at once.

use crate::linalg::sparse::dot;
use crate::linalg::{SparseVector, c64};
use faer::{ColMut, Mat, MatMut, MatRef};
use rayon::prelude::*;

/// Complex vectors, one a column.
#[derive(Debug, Clone)]
pub struct Block {
    /// Re of every vector, then Im of every one.
    parts: Mat<f64>,
}

impl Default for Block {
    fn default() -> Self {
        Block::zeros(0, 0)
    }
}

impl Block {
    /// Vectors of n zeros.
    pub fn zeros(n: usize, columns: usize) -> Self {
        Block::of_parts(Mat::zeros(n, 2 * columns))
    }

    /// Of the real parts of all vectors and then the imaginary ones.
    pub(crate) fn of_parts(parts: Mat<f64>) -> Self {
        assert!(parts.ncols().is_multiple_of(2), "as many imaginary as real parts");
        Block { parts }
    }

    /// Vectors whose entries i, j are f(i, j).
    pub fn from_fn(n: usize, columns: usize, f: impl Fn(usize, usize) -> c64) -> Self {
        let mut block = Block::zeros(n, columns);
        for j in 0..columns {
            let [re, im] = block.vector_mut(j);
            for (i, (re, im)) in re.iter_mut().zip(im).enumerate() {
                let value = f(i, j);
                (*re, *im) = (value.re, value.im);
            }
        }
        block
    }

    /// Vectors of n entries each.
    ///
    /// # Panics
    /// When one has fewer.
    pub fn from_columns(n: usize, columns: &[&[c64]]) -> Self {
        Block::from_fn(n, columns.len(), |i, j| columns[j][i])
    }

    /// Some columns of another block.
    pub(crate) fn gathered(block: &Block, columns: &[usize]) -> Self {
        let mut some = Block::zeros(block.nrows(), columns.len());
        for (k, j) in columns.iter().enumerate() {
            some.vector_mut(k)
                .into_iter()
                .zip(block.vector(*j))
                .for_each(|(to, from)| to.copy_from_slice(from));
        }
        some
    }

    /// Resizes to `columns` vectors, whose entries are not cleared.
    pub(crate) fn resize(&mut self, n: usize, columns: usize) {
        self.parts.resize_with(n, 2 * columns, |_, _| 0.0);
    }

    /// The length of every vector.
    pub fn nrows(&self) -> usize {
        self.parts.nrows()
    }

    /// The number of vectors.
    pub fn ncols(&self) -> usize {
        self.parts.ncols() / 2
    }

    /// Re of every vector, then Im of every one.
    pub(crate) fn parts(&self) -> MatRef<'_, f64> {
        self.parts.as_ref()
    }

    pub(crate) fn parts_mut(&mut self) -> MatMut<'_, f64> {
        self.parts.as_mut()
    }

    pub(crate) fn into_parts(self) -> Mat<f64> {
        self.parts
    }

    /// Entry i of vector j.
    pub fn get(&self, i: usize, j: usize) -> c64 {
        c64::new(self.parts[(i, j)], self.parts[(i, self.ncols() + j)])
    }

    /// Re and Im of vector j.
    pub fn vector(&self, j: usize) -> [&[f64]; 2] {
        [j, self.ncols() + j].map(|c| self.parts.col_as_slice(c))
    }

    /// Re and Im of vector j, to be written.
    pub(crate) fn vector_mut(&mut self, j: usize) -> [&mut [f64]; 2] {
        let columns = self.ncols();
        let (re, im) = self.parts.as_mut().split_at_col_mut(columns);
        [re, im].map(|part| whole(part.col_mut(j)))
    }

    /// Image of every vector by a real operation.
    pub(crate) fn map(&self, f: impl FnOnce(MatRef<'_, f64>) -> Mat<f64>) -> Self {
        let parts = f(self.parts());
        assert!(parts.ncols() == self.parts.ncols(), "one column for each");
        Block { parts }
    }

    /// self\[:, j\] = factor · x\[:, j\], in the memory at hand.
    pub(crate) fn set_scaled(&mut self, factor: f64, x: &Block) {
        self.resize(x.nrows(), x.ncols());
        self.each_vector(|j, parts| {
            for (own, x) in parts.into_iter().zip(x.vector(j)) {
                own.iter_mut().zip(x).for_each(|(own, x)| *own = factor * x);
            }
        });
    }

    /// self\[:, j\] += factor\[j\] · x\[:, j\].
    pub(crate) fn add_scaled(&mut self, factor: &[c64], x: &Block) {
        self.each_vector(|j, [u, v]| {
            let ([p, q], a) = (x.vector(j), factor[j]);
            for (((u, v), p), q) in u.iter_mut().zip(v).zip(p).zip(q) {
                *u += a.re * p - a.im * q;
                *v += a.re * q + a.im * p;
            }
        });
    }

    /// self\[rows, j\] += factor\[j\] · x\[:, j\].
    pub(crate) fn add_rows(&mut self, factor: &[c64], rows: &[usize], x: &Block) {
        for (j, factor) in factor.iter().enumerate() {
            let [re, im] = self.vector_mut(j);
            for (k, i) in rows.iter().enumerate() {
                let value = factor * x.get(k, j);
                (re[*i], im[*i]) = (re[*i] + value.re, im[*i] + value.im);
            }
        }
    }

    /// self\[:, j\] *= factor\[j\].
    pub(crate) fn scale(&mut self, factor: &[f64]) {
        self.each_vector(|j, parts| parts.into_iter().flatten().for_each(|v| *v *= factor[j]));
    }

    /// Does something to Re and Im of every vector j.
    fn each_vector(&mut self, f: impl Fn(usize, [&mut [f64]; 2]) + Sync) {
        let columns = self.ncols();
        let (re, im) = self.parts.as_mut().split_at_col_mut(columns);
        let vectors = re.par_col_iter_mut().zip(im.par_col_iter_mut()).enumerate();
        vectors.for_each(|(j, (re, im))| f(j, [re, im].map(whole)));
    }

    /// Column `j`, scaled.
    pub(crate) fn scaled_column(&self, j: usize, factor: f64) -> Vec<c64> {
        let [re, im] = self.vector(j);
        re.iter().zip(im).map(|(a, b)| c64::new(factor * a, factor * b)).collect()
    }

    /// Column `j`.
    pub fn column(&self, j: usize) -> Vec<c64> {
        self.scaled_column(j, 1.0)
    }

    /// dᵀx of vector j.
    pub(crate) fn along(&self, j: usize, d: &SparseVector) -> c64 {
        let [re, im] = self.vector(j).map(|part| d.dot(part));
        c64::new(re, im)
    }

    /// self\[:, j\]ᴴ x\[:, j\].
    pub fn dot(&self, j: usize, x: &Block) -> c64 {
        conjugate_dot(self.vector(j), x.vector(j))
    }

    /// self\[rows, j\]ᴴ x\[:, j\].
    pub(crate) fn dot_rows(&self, j: usize, rows: &[usize], x: &Block) -> c64 {
        rows.iter().enumerate().map(|(k, i)| self.get(*i, j).conj() * x.get(k, j)).sum()
    }

    /// ‖self\[:, j\]‖₂.
    pub fn norm(&self, j: usize) -> f64 {
        self.vector(j).map(|part| dot(part, part)).iter().sum::<f64>().sqrt()
    }

    /// ‖self\[:, j\] + x\[:, j\]‖₂.
    pub(crate) fn norm_of_sum(&self, j: usize, x: &Block) -> f64 {
        let parts = self.vector(j).into_iter().zip(x.vector(j));
        parts.map(|(own, x)| own.iter().zip(x).map(|(a, b)| (a + b).powi(2)).sum::<f64>()).sum::<f64>().sqrt()
    }
}

/// A column of a matrix of its own, which is in one piece.
fn whole(column: ColMut<'_, f64>) -> &mut [f64] {
    column.try_as_col_major_mut().expect("in one piece").as_slice_mut()
}

/// Σ (a − ib)(p + iq), in sums side by side.
fn conjugate_dot([a, b]: [&[f64]; 2], [p, q]: [&[f64]; 2]) -> c64 {
    const SUMS: usize = 4;
    let parts = [a, b, p, q].map(|part| part.as_chunks::<SUMS>());
    let [a, b, p, q] = parts.map(|(whole, _)| &whole[..parts[0].0.len()]);
    let (mut re, mut im) = ([0.0; SUMS], [0.0; SUMS]);
    for i in 0..a.len() {
        for k in 0..SUMS {
            re[k] += a[i][k] * p[i][k] + b[i][k] * q[i][k];
            im[k] += a[i][k] * q[i][k] - b[i][k] * p[i][k];
        }
    }
    let [a, b, p, q] = parts.map(|(_, rest)| rest);
    let rest: c64 = (0..a.len()).map(|i| c64::new(a[i], -b[i]) * c64::new(p[i], q[i])).sum();
    c64::new(re.iter().sum(), im.iter().sum()) + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn a_dot_conjugates_its_first_vector() {
        for n in [0, 3, 4, 23] {
            let vector = |s: f64| -> Vec<c64> {
                (0..n).map(|i| c64::new((s * i as f64).sin(), (0.3 + s * i as f64).cos())).collect()
            };
            let (x, y) = (vector(1.3), vector(0.7));
            let expected: c64 = x.iter().zip(&y).map(|(x, y)| x.conj() * y).sum();
            let block = |x: &[c64]| Block::from_columns(n, &[x]);
            assert!(
                within((block(&x).dot(0, &block(&y)) - expected).norm(), 1e-14 * n as f64, RoundOff),
                "{n}"
            );
        }
    }
}
