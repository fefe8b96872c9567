//! Eigenvalues of small dense matrices that are not symmetric, with left and right vectors, on one thread.

use super::c64;
use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, evd_cplx, evd_real, evd_scratch};
use faer::traits::ComplexField;
use faer::{Mat, MatMut, MatRef, Par};
use stridor_base::error::{Error, Result};

/// A X = X diag(λ) and YᴴA = diag(λ) Yᴴ.
#[derive(Debug, Clone)]
pub struct Eigenvalues {
    /// λ, in the order of the algorithm.
    pub values: Vec<c64>,
    /// X, one right vector a column.
    pub right: Mat<c64>,
    /// Y, one left vector a column.
    pub left: Mat<c64>,
}

/// The spectrum of a real matrix by the QR algorithm; the error of a well conditioned λ is about 1e-15 ‖A‖.
///
/// ```
/// use faer::mat;
/// let spectrum = stridor_linalg::unsymmetric::spectrum(mat![[0.0, 2.0], [-2.0, 0.0]].as_ref()).unwrap();
/// assert!(spectrum.values.iter().all(|l| l.re.abs() < 1e-15 && (l.im.abs() - 2.0).abs() < 1e-15));
/// ```
///
/// # Errors
/// [`Error::Analysis`] when a number is not finite or the iteration does not converge.
pub fn spectrum(a: MatRef<'_, f64>) -> Result<Eigenvalues> {
    let n = a.nrows();
    let (mut left, mut right) = (Mat::zeros(n, n), Mat::zeros(n, n));
    let values = eigen_of_real(a, Some(left.as_mut()), Some(right.as_mut()))?;
    Ok(Eigenvalues { right: in_pairs(&right, &values), left: in_pairs(&left, &values), values })
}

/// [`spectrum`] of a complex matrix.
///
/// # Errors
/// As [`spectrum`].
pub fn complex_spectrum(a: MatRef<'_, c64>) -> Result<Eigenvalues> {
    let n = a.nrows();
    let (mut left, mut right) = (Mat::zeros(n, n), Mat::zeros(n, n));
    let values = eigen_of_complex(a, Some(left.as_mut()), Some(right.as_mut()))?;
    Ok(Eigenvalues { values, right, left })
}

/// The eigenvalues and right vectors of a real matrix.
///
/// # Errors
/// As [`spectrum`].
pub fn eigenpairs(a: MatRef<'_, f64>) -> Result<(Vec<c64>, Mat<c64>)> {
    let mut right = Mat::zeros(a.nrows(), a.nrows());
    let values = eigen_of_real(a, None, Some(right.as_mut()))?;
    let right = in_pairs(&right, &values);
    Ok((values, right))
}

/// The eigenvalues and right vectors of a complex matrix.
///
/// # Errors
/// As [`spectrum`].
pub fn complex_eigenpairs(a: MatRef<'_, c64>) -> Result<(Vec<c64>, Mat<c64>)> {
    let mut right = Mat::zeros(a.nrows(), a.nrows());
    let values = eigen_of_complex(a, None, Some(right.as_mut()))?;
    Ok((values, right))
}

/// The eigenvalues of a real matrix alone, at a third of the cost of [`spectrum`].
///
/// # Errors
/// As [`spectrum`].
pub fn eigenvalues(a: MatRef<'_, f64>) -> Result<Vec<c64>> {
    eigen_of_real(a, None, None)
}

/// Eigenvalues, and those vectors for which there is scratch: of a conjugate pair Re and then Im of the one with Im λ > 0.
fn eigen_of_real(
    a: MatRef<'_, f64>,
    left: Option<MatMut<'_, f64>>,
    right: Option<MatMut<'_, f64>>,
) -> Result<Vec<c64>> {
    let n = a.nrows();
    check(n, a.is_all_finite())?;
    let (mut re, mut im) = (Diag::zeros(n), Diag::zeros(n));
    let mut memory = scratch::<f64>(n, &left, &right);
    let stack = MemStack::new(&mut memory);
    evd_real(a, re.as_mut(), im.as_mut(), left, right, Par::Seq, stack, Default::default())
        .map_err(|_| no_convergence(n))?;
    let (re, im) = (re.column_vector(), im.column_vector());
    Ok((0..n).map(|k| c64::new(re[k], im[k])).collect())
}

/// Eigenvalues, and those vectors for which there is scratch.
fn eigen_of_complex(
    a: MatRef<'_, c64>,
    left: Option<MatMut<'_, c64>>,
    right: Option<MatMut<'_, c64>>,
) -> Result<Vec<c64>> {
    let n = a.nrows();
    check(n, a.is_all_finite())?;
    let mut values = Diag::zeros(n);
    let mut memory = scratch::<c64>(n, &left, &right);
    let stack = MemStack::new(&mut memory);
    evd_cplx(a, values.as_mut(), left, right, Par::Seq, stack, Default::default())
        .map_err(|_| no_convergence(n))?;
    Ok(values.column_vector().iter().copied().collect())
}

/// Work memory of the decomposition beside its results.
fn scratch<T: ComplexField>(
    n: usize,
    left: &Option<MatMut<'_, T>>,
    right: &Option<MatMut<'_, T>>,
) -> MemBuffer {
    let wanted = |there: bool| if there { ComputeEigenvectors::Yes } else { ComputeEigenvectors::No };
    let (left, right) = (wanted(left.is_some()), wanted(right.is_some()));
    MemBuffer::new(evd_scratch::<T>(n, left, right, Par::Seq, Default::default()))
}

/// The vectors of a real matrix, whose conjugate pairs stand in two columns: Re and Im of the one with Im λ > 0.
fn in_pairs(u: &Mat<f64>, values: &[c64]) -> Mat<c64> {
    Mat::from_fn(u.nrows(), u.ncols(), |i, k| match values[k].im {
        w if w > 0.0 => c64::new(u[(i, k)], u[(i, k + 1)]),
        w if w < 0.0 => c64::new(u[(i, k - 1)], -u[(i, k)]),
        _ => c64::new(u[(i, k)], 0.0),
    })
}

fn check(n: usize, finite: bool) -> Result<()> {
    if n > 0 && finite { Ok(()) } else { Err(no_convergence(n)) }
}

fn no_convergence(n: usize) -> Error {
    Error::analysis(
        format!("dense eigenvalues of order {n}"),
        "the iteration did not converge, most likely because an entry is not finite",
        "Look for zero or huge stiffnesses, masses and velocities in the model",
    )
}

#[cfg(test)]
mod tests {
    use super::super::samples::random_symmetric;
    use super::*;

    #[test]
    fn right_and_left_vectors_satisfy_their_equations() {
        let n = 41;
        let (a, b) = (random_symmetric(n, 3).to_dense(), random_symmetric(n, 4).to_dense());
        let skew = Mat::from_fn(n, n, |i, j| if i > j { b[(i, j)] } else { -b[(i, j)] });
        let real = &a + &skew;
        let alone = eigenvalues(real.as_ref()).unwrap();
        let nearest = |z: &c64| alone.iter().map(|w| (w - z).norm()).fold(f64::INFINITY, f64::min);
        let values = spectrum(real.as_ref()).unwrap().values;
        assert!(alone.len() == n && values.iter().all(|z| nearest(z) < 1e-12 * real.norm_l2()));
        let complex = Mat::from_fn(n, n, |i, j| c64::new(real[(i, j)], b[(i, (j + 1) % n)]));
        let lifted = Mat::from_fn(n, n, |i, j| c64::new(real[(i, j)], 0.0));
        for (a, s) in [
            (&lifted, spectrum(real.as_ref()).unwrap()),
            (&complex, complex_spectrum(complex.as_ref()).unwrap()),
        ] {
            let size = a.norm_l2();
            for (k, value) in s.values.iter().enumerate() {
                let (x, y) = (s.right.col(k), s.left.col(k));
                let r = a * x - x * faer::Scale(*value);
                let l = a.adjoint() * y - y * faer::Scale(value.conj());
                assert!(r.norm_l2() < 1e-13 * size * x.norm_l2(), "{k} {:e}", r.norm_l2());
                assert!(l.norm_l2() < 1e-13 * size * y.norm_l2(), "{k} {:e}", l.norm_l2());
            }
            assert!(s.values.iter().filter(|z| z.im != 0.0).count() > 4);
        }
    }

    #[test]
    fn what_is_not_finite_is_refused() {
        assert!(spectrum(faer::mat![[f64::NAN]].as_ref()).is_err());
        assert!(spectrum(Mat::zeros(0, 0).as_ref()).is_err());
    }
}
