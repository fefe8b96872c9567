//! Orthogonal factors of small dense matrices, on one thread: QR with exchanged columns, and singular values.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::householder::{
    apply_block_householder_sequence_on_the_left_in_place_scratch as apply_scratch,
    apply_block_householder_sequence_on_the_left_in_place_with_conj as apply,
};
use faer::linalg::qr::col_pivoting::factor;
use faer::linalg::qr::no_pivoting::factor::recommended_block_size;
use faer::linalg::svd::{ComputeSvdVectors, svd, svd_scratch};
use faer::traits::ComplexField;
use faer::{Conj, Mat, MatRef, Par};

/// The columns of A in another order as Q R, with as many columns of Q and rows of R as the shorter side of A has: each step takes
/// the column of which most is left.
#[derive(Debug)]
pub struct PivotedQr {
    /// Q.
    pub q: Mat<f64>,
    /// R.
    pub r: Mat<f64>,
    /// The column of A that each column of Q R is.
    pub order: Vec<usize>,
}

/// The orthogonal factors of A, in its memory.
pub fn pivoted_qr(mut a: Mat<f64>) -> PivotedQr {
    let (m, n) = a.shape();
    let size = m.min(n);
    let (mut order, mut back) = (vec![0usize; n], vec![0usize; n]);
    let block = recommended_block_size::<f64>(m, n);
    let mut coefficients = Mat::zeros(block, size);
    let scratch = factor::qr_in_place_scratch::<usize, f64>(m, n, block, Par::Seq, Default::default());
    factor::qr_in_place(
        a.as_mut(),
        coefficients.as_mut(),
        &mut order,
        &mut back,
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Default::default(),
    );
    let mut q = Mat::identity(m, size);
    let mut memory = MemBuffer::new(apply_scratch::<f64>(m, block, size));
    let (reflectors, stack) = (a.subcols(0, size), MemStack::new(&mut memory));
    apply(reflectors, coefficients.as_ref(), Conj::No, q.as_mut(), Par::Seq, stack);
    let r = Mat::from_fn(size, n, |i, j| if i <= j { a[(i, j)] } else { 0.0 });
    PivotedQr { q, r, order }
}

/// A = U S Vᴴ with as many columns of U and V as the shorter side of A has, the largest singular value first.
pub struct ThinSvd<T> {
    /// U.
    pub left: Mat<T>,
    /// The diagonal of S.
    pub values: Vec<f64>,
    /// V.
    pub right: Mat<T>,
}

/// The singular values and vectors of A; `None` where a number is not finite, or they do not converge.
pub fn thin_svd<T: ComplexField<Real = f64>>(a: MatRef<'_, T>) -> Option<ThinSvd<T>> {
    let (m, n) = a.shape();
    let size = m.min(n);
    if !a.is_all_finite() {
        return None;
    }
    let (mut left, mut right, mut values) = (Mat::zeros(m, size), Mat::zeros(n, size), Diag::zeros(size));
    let thin = ComputeSvdVectors::Thin;
    let scratch = svd_scratch::<T>(m, n, thin, thin, Par::Seq, Default::default());
    let mut memory = MemBuffer::new(scratch);
    svd(
        a,
        values.as_mut(),
        Some(left.as_mut()),
        Some(right.as_mut()),
        Par::Seq,
        MemStack::new(&mut memory),
        Default::default(),
    )
    .ok()?;
    let values = values.column_vector().iter().map(faer::traits::math_utils::real).collect();
    Some(ThinSvd { left, values, right })
}

#[cfg(test)]
mod tests {
    use super::super::random::Random;
    use super::*;
    use faer::c64;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn factors_are_orthogonal_and_multiply_to_the_matrix() {
        for (m, n) in [(5, 9), (40, 70), (6, 6), (7, 3), (3, 0)] {
            let size = m.min(n);
            let mut random = Random::new();
            let a = Mat::from_fn(m, n, |_, _| random.next());
            let PivotedQr { q, r, order } = pivoted_qr(a.clone());
            let unit = |q: &Mat<f64>| {
                within((q.transpose() * q - Mat::<f64>::identity(size, size)).norm_max(), 1e-13, RoundOff)
            };
            assert!(
                unit(&q)
                    && (1..size).all(|i| within((r[(i, i)] / r[(i - 1, i - 1)]).abs() - 1.0, 0.01, RoundOff))
            );
            let reordered = Mat::from_fn(m, n, |i, j| a[(i, order[j])]);
            assert!(within((&q * &r - reordered).norm_max(), 1e-13, RoundOff));
            let ThinSvd { left, values, right } = thin_svd(a.as_ref()).unwrap();
            let scaled = Mat::from_fn(m, size, |i, k| left[(i, k)] * values[k]);
            assert!(
                unit(&left)
                    && unit(&right)
                    && within((scaled * right.transpose() - &a).norm_max(), 1e-12, RoundOff)
            );
        }
        let i = c64::new(0.0, 1.0);
        let of_complex = thin_svd(faer::mat![[i * 3.0, i * 0.0]].as_ref()).unwrap();
        assert!(within((of_complex.values[0] - 3.0).abs(), 1e-15, RoundOff));
        assert!(thin_svd(faer::mat![[f64::NAN]].as_ref()).is_none());
    }
}
