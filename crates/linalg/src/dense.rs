//! Small dense symmetric eigenproblems, and the MAC of two vectors.
//!
//! Everything here runs on one thread, so that results do not depend on the number of threads.

use super::c64;
use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::traits::math_utils::one;
use faer::traits::{ComplexField, Conjugate};
use faer::{Accum, Mat, MatRef, Par};
use stridor_base::error::{Error, Result};

/// C = A B on one thread.
pub fn product<T: ComplexField>(
    a: MatRef<'_, impl Conjugate<Canonical = T>>,
    b: MatRef<'_, impl Conjugate<Canonical = T>>,
) -> Mat<T> {
    let mut c = Mat::zeros(a.nrows(), b.ncols());
    faer::linalg::matmul::matmul(c.as_mut(), Accum::Replace, a, b, one(), Par::Seq);
    c
}

/// A = S diag(ν) Sᵀ of a symmetric matrix, of which the lower triangle is read: ν ascending, SᵀS = I.
///
/// # Errors
/// [`Error::Analysis`] when A holds a NaN or an infinity.
pub fn symmetric_eigen(a: MatRef<'_, f64>) -> Result<(Vec<f64>, Mat<f64>)> {
    let n = a.nrows();
    if n == 0 {
        return Ok((Vec::new(), Mat::zeros(0, 0)));
    }
    // The divide and conquer underneath deflates against an absolute threshold: bring the matrix to size one.
    let size = a.norm_max();
    let scale = if size > 0.0 && size.is_finite() { size.log2().round().exp2() } else { 1.0 };
    let scaled = a * faer::Scale(1.0 / scale);
    let (mut values, mut vectors) = (Diag::zeros(n), Mat::zeros(n, n));
    let scratch = self_adjoint_evd_scratch::<f64>(n, ComputeEigenvectors::Yes, Par::Seq, Default::default());
    self_adjoint_evd(
        scaled.as_ref(),
        values.as_mut(),
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Default::default(),
    )
    .map_err(|_| no_convergence(n))?;
    let values: Vec<f64> = values.column_vector().iter().map(|v| v * scale).collect();
    if values.iter().any(|v| !v.is_finite()) {
        return Err(no_convergence(n));
    }
    Ok((values, vectors))
}

/// A^-½ of the Gram matrix of eigenvectors, of which the lower triangle is read: X A^-½ are orthonormal and as near to X as can
/// be.
///
/// # Errors
/// [`Error::Analysis`] when A is not positive definite, as two vectors fell together.
pub fn inverse_root(a: MatRef<'_, f64>) -> Result<Mat<f64>> {
    let (values, u) = symmetric_eigen(a)?;
    if values.iter().any(|v| *v <= 0.0 || v.is_nan()) {
        return Err(Error::analysis(
            "eigenvalues",
            "two eigenvectors fell together",
            "Ask for fewer modes, or move the bound",
        ));
    }
    let scaled = Mat::from_fn(values.len(), values.len(), |i, k| u[(i, k)] / values[k].sqrt());
    Ok(product(scaled.as_ref(), u.transpose()))
}

/// A x = ν B x with A symmetric and B symmetric positive definite: ν ascending, XᵀBX = I.
///
/// By B = L Lᵀ and the eigenvalues of L⁻¹ A L⁻ᵀ; the error of each ν is about 1e-16 max|ν|.
///
/// ```
/// use faer::mat;
/// let (a, b) = (mat![[2.0, 0.0], [0.0, 8.0]], mat![[1.0, 0.0], [0.0, 2.0]]);
/// let (values, _) = stridor_linalg::dense::definite_pencil(a.as_ref(), b.as_ref()).unwrap();
/// assert!((values[0] - 2.0).abs() < 1e-15 && (values[1] - 4.0).abs() < 1e-15);
/// ```
///
/// # Errors
/// [`Error::Analysis`] when B is not positive definite, or a number is not finite.
pub fn definite_pencil(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Result<(Vec<f64>, Mat<f64>)> {
    let l = cholesky(b)?;
    let mut c = a.to_owned();
    solve_lower_triangular_in_place(l.as_ref(), c.as_mut(), Par::Seq);
    let mut c = c.transpose().to_owned();
    solve_lower_triangular_in_place(l.as_ref(), c.as_mut(), Par::Seq);
    let symmetric = Mat::from_fn(c.nrows(), c.ncols(), |i, j| 0.5 * (c[(i, j)] + c[(j, i)]));
    let (values, mut vectors) = symmetric_eigen(symmetric.as_ref())?;
    solve_upper_triangular_in_place(l.transpose(), vectors.as_mut(), Par::Seq);
    Ok((values, vectors))
}

/// The lower triangular L of B = L Lᵀ.
///
/// # Errors
/// [`Error::Analysis`] when B is not positive definite.
pub fn cholesky(b: MatRef<'_, f64>) -> Result<Mat<f64>> {
    let n = b.nrows();
    let mut l = Mat::zeros(n, n);
    for j in 0..n {
        for i in j..n {
            let dot: f64 = (0..j).map(|k| l[(i, k)] * l[(j, k)]).sum();
            let rest: f64 = b[(i, j)] - dot;
            if i > j {
                l[(i, j)] = rest / l[(j, j)];
            } else if rest > 0.0 && rest.is_finite() {
                l[(j, j)] = rest.sqrt();
            } else {
                return Err(Error::analysis(
                    format!("Cholesky factorisation of order {n}"),
                    format!("pivot {j} is {rest:.3e}, so the matrix is not positive definite"),
                    "A mass or stiffness matrix of this kind has a part without mass or support",
                ));
            }
        }
    }
    Ok(l)
}

/// MAC = |aᴴb|² / (aᴴa · bᴴb) in [0, 1]: 1 for the same shape, 0 for orthogonal ones (or a zero vector).
///
/// Allemang, Sound and Vibration 37 (2003) 14.
///
/// # Panics
/// When the lengths differ.
pub fn mac(a: &[c64], b: &[c64]) -> f64 {
    assert_eq!(a.len(), b.len(), "vectors of two lengths");
    let dot: c64 = a.iter().zip(b).map(|(a, b)| a.conj() * b).sum();
    let norms = a.iter().map(|a| a.norm_sqr()).sum::<f64>() * b.iter().map(|b| b.norm_sqr()).sum::<f64>();
    if norms > 0.0 { dot.norm_sqr() / norms } else { 0.0 }
}

fn no_convergence(n: usize) -> Error {
    Error::analysis(
        format!("dense eigenvalues of order {n}"),
        "the iteration did not converge, most likely because an entry is not finite",
        "Look for zero or huge stiffnesses and masses in the model",
    )
}

#[cfg(test)]
mod tests {
    use super::super::samples;
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn pencil_satisfies_its_equation() {
        let a = samples::random_symmetric(30, 7).to_dense();
        let b = samples::random_definite(30, 8).to_dense();
        let (values, x) = definite_pencil(a.as_ref(), b.as_ref()).unwrap();
        let largest = values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        for (k, value) in values.iter().enumerate() {
            let residual = &a * x.col(k) - &b * x.col(k) * faer::Scale(*value);
            assert!(within(residual.norm_l2(), 1e-12 * largest * x.col(k).norm_l2() * b.norm_l2(), RoundOff));
        }
        assert!(within((x.transpose() * &b * &x - Mat::<f64>::identity(30, 30)).norm_max(), 1e-12, RoundOff));
        assert!(definite_pencil(b.as_ref(), a.as_ref()).is_err());
    }

    #[test]
    fn small_matrices_are_solved_as_well_as_large_ones() {
        let a = samples::membrane(14).0.to_dense();
        let (values, _) = symmetric_eigen(a.as_ref()).unwrap();
        // 2 n ε ‖A‖ of the values, as much of the reference.
        let bound = 4.0 * 196.0 * f64::EPSILON * 8.0;
        for scale in [1e-12, 1e12] {
            let (scaled, vectors) = symmetric_eigen((&a * faer::Scale(scale)).as_ref()).unwrap();
            for (k, value) in scaled.iter().enumerate() {
                assert!(within((value / scale - values[k]).abs(), bound, RoundOff), "{scale} {k}");
                let residual = &a * vectors.col(k) - vectors.col(k) * faer::Scale(value / scale);
                assert!(within(residual.norm_l2(), bound, RoundOff), "{scale} {k}");
            }
        }
    }

    #[test]
    fn one_by_one() {
        let (values, x) = definite_pencil(faer::mat![[6.0]].as_ref(), faer::mat![[4.0]].as_ref()).unwrap();
        assert_eq!((values[0], x[(0, 0)]), (1.5, 0.5));
    }

    #[test]
    fn mac_knows_scaled_and_orthogonal_vectors() {
        let i = c64::new(0.0, 1.0);
        let (a, b) = ([c64::new(1.0, 2.0), i], [c64::new(-2.0, 1.0), -c64::new(1.0, 0.0)]);
        assert!(within((mac(&a, &b) - 1.0).abs(), 1e-15, RoundOff), "b = i a");
        assert_eq!(mac(&[i, i], &[i, -i]), 0.0);
    }
}
