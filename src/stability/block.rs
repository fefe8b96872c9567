//! Blocks of complex vectors, real and imaginary parts apart, so that real matrices and factors work on both.

use crate::linalg::c64;
use crate::linalg::sparse::dot;
use faer::Mat;
use rayon::prelude::*;

/// Complex vectors, one a column.
#[derive(Debug, Clone)]
pub(super) struct Block {
    pub(super) re: Mat<f64>,
    pub(super) im: Mat<f64>,
}

impl Default for Block {
    fn default() -> Self {
        Block::zeros(0, 0)
    }
}

impl Block {
    pub(super) fn zeros(n: usize, columns: usize) -> Self {
        Block { re: Mat::zeros(n, columns), im: Mat::zeros(n, columns) }
    }

    /// Makes room for `columns` vectors in the memory at hand.
    pub(super) fn resize(&mut self, n: usize, columns: usize) {
        [&mut self.re, &mut self.im].into_iter().for_each(|part| part.resize_with(n, columns, |_, _| 0.0));
    }

    pub(super) fn from_columns(n: usize, columns: &[&[c64]]) -> Self {
        let part = |f: fn(&c64) -> f64| Mat::from_fn(n, columns.len(), |i, j| f(&columns[j][i]));
        Block { re: part(|z| z.re), im: part(|z| z.im) }
    }

    /// Some columns of another block.
    pub(super) fn gathered(block: &Block, columns: &[usize]) -> Self {
        block.map(|part| Mat::from_fn(part.nrows(), columns.len(), |i, k| part[(i, columns[k])]))
    }

    pub(super) fn ncols(&self) -> usize {
        self.re.ncols()
    }

    /// The same operation on both parts.
    pub(super) fn map(&self, f: impl Fn(&Mat<f64>) -> Mat<f64>) -> Self {
        Block { re: f(&self.re), im: f(&self.im) }
    }

    /// self\[:, j\] = a\[j\] · x\[:, j\] + b\[j\] · y\[:, j\], in the memory at hand.
    pub(super) fn set_sum(&mut self, [(a, x), (b, y)]: [(&[c64], &Block); 2]) {
        self.resize(x.re.nrows(), x.ncols());
        let own = self.re.par_col_iter_mut().zip(self.im.par_col_iter_mut());
        let first = x.re.par_col_iter().zip(x.im.par_col_iter()).zip(a);
        let second = y.re.par_col_iter().zip(y.im.par_col_iter()).zip(b);
        own.zip(first).zip(second).for_each(|(((u, v), ((p, q), a)), ((r, s), b))| {
            let terms = p.iter().zip(q.iter()).zip(r.iter().zip(s.iter()));
            for ((u, v), ((p, q), (r, s))) in u.iter_mut().zip(v.iter_mut()).zip(terms) {
                *u = a.re * p - a.im * q + (b.re * r - b.im * s);
                *v = a.re * q + a.im * p + (b.re * s + b.im * r);
            }
        });
    }

    /// self\[:, j\] += factor\[j\] · x\[:, j\].
    pub(super) fn add_scaled(&mut self, factor: &[c64], x: &Block) {
        let own = self.re.par_col_iter_mut().zip(self.im.par_col_iter_mut());
        let others = x.re.par_col_iter().zip(x.im.par_col_iter());
        own.zip(others).zip(factor).for_each(|(((u, v), (p, q)), a)| {
            for (((u, v), p), q) in u.iter_mut().zip(v.iter_mut()).zip(p.iter()).zip(q.iter()) {
                *u += a.re * p - a.im * q;
                *v += a.re * q + a.im * p;
            }
        });
    }

    /// Column `j`.
    pub(super) fn column(&self, j: usize) -> Vec<c64> {
        self.re.col_as_slice(j).iter().zip(self.im.col_as_slice(j)).map(|(a, b)| c64::new(*a, *b)).collect()
    }

    /// self\[:, j\]ᴴ x\[:, j\].
    pub(super) fn dot(&self, j: usize, x: &Block) -> c64 {
        let (a, b) = (self.re.col_as_slice(j), self.im.col_as_slice(j));
        let (p, q) = (x.re.col_as_slice(j), x.im.col_as_slice(j));
        conjugate_dot([a, b], [p, q])
    }

    /// ‖self\[:, j\]‖₂.
    pub(super) fn norm(&self, j: usize) -> f64 {
        let [re, im] = [&self.re, &self.im].map(|part| dot(part.col_as_slice(j), part.col_as_slice(j)));
        (re + im).sqrt()
    }

    /// self\[:, j\] *= factor\[j\].
    pub(super) fn scale(&mut self, factor: &[f64]) {
        for part in [&mut self.re, &mut self.im] {
            let columns = part.par_col_iter_mut().zip(factor);
            columns.for_each(|(column, factor)| column.iter_mut().for_each(|v| *v *= factor));
        }
    }
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

    #[test]
    fn a_dot_conjugates_its_first_vector() {
        for n in [0, 3, 4, 23] {
            let vector = |s: f64| -> Vec<c64> {
                (0..n).map(|i| c64::new((s * i as f64).sin(), (0.3 + s * i as f64).cos())).collect()
            };
            let (x, y) = (vector(1.3), vector(0.7));
            let expected: c64 = x.iter().zip(&y).map(|(x, y)| x.conj() * y).sum();
            let block = |x: &[c64]| Block::from_columns(n, &[x]);
            assert!((block(&x).dot(0, &block(&y)) - expected).norm() <= 1e-14 * n as f64, "{n}");
        }
    }
}
