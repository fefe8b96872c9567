//! Singular values of a small matrix.

use crate::linalg::orthogonal::{ThinSvd, thin_svd};
use faer::Mat;
use nalgebra::DMatrix;

/// A = U S Vᵀ with as many columns as the shorter side of A has, the largest value first. Where A has numbers that are not finite the
/// values are none either. The `svd` of nalgebra 0.35 is off by some percent where columns of A depend on one another.
pub(super) struct Svd {
    pub(super) u: DMatrix<f64>,
    pub(super) s: Vec<f64>,
    pub(super) v: DMatrix<f64>,
}

impl Svd {
    pub(super) fn new(a: &DMatrix<f64>) -> Self {
        let [rows, columns] = [a.nrows(), a.ncols()];
        let shorter = rows.min(columns);
        let a = Mat::from_fn(rows, columns, |i, j| a[(i, j)]);
        let Some(ThinSvd { left, values, right }) = thin_svd(a.as_ref()) else {
            let (u, v) = (DMatrix::zeros(rows, shorter), DMatrix::zeros(columns, shorter));
            return Svd { u, s: vec![f64::NAN; shorter], v };
        };
        Svd {
            u: DMatrix::from_fn(rows, shorter, |i, j| left[(i, j)]),
            s: values,
            v: DMatrix::from_fn(columns, shorter, |i, j| right[(i, j)]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn dependent_columns_have_one_value_and_it_is_right() {
        let w = DMatrix::from_fn(4, 2, |_, j| [-1.0, 1.0][j] * 2f64.ln() / 0.008);
        let Svd { u, s, v } = Svd::new(&w);
        let exact = 8f64.sqrt() * 2f64.ln() / 0.008;
        assert!(
            within((s[0] - exact).abs(), 1e-12 * exact, RoundOff) && within(s[1], 1e-12 * exact, RoundOff),
            "{s:?}"
        );
        let product = u * DMatrix::from_diagonal(&s.into()) * v.transpose();
        assert!(within((product - &w).norm(), 1e-12 * exact, RoundOff));
        assert!(Svd::new(&(w * f64::NAN)).s.iter().all(|s| s.is_nan()));
    }
}
