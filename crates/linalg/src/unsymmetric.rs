//! Eigenvalues of small dense matrices that are not symmetric, with left and right vectors, on one thread.

use super::c64;
use super::dense::product;
use super::random::Random;
use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, EvdParams, SchurParams, evd_cplx, evd_real, evd_scratch};
use faer::traits::ComplexField;
use faer::{Auto, Mat, MatRef, Par};
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
    real(a, Vectors::Both)
}

/// [`spectrum`] of a complex matrix.
///
/// # Errors
/// As [`spectrum`].
pub fn complex_spectrum(a: MatRef<'_, c64>) -> Result<Eigenvalues> {
    complex(a, Vectors::Both)
}

/// The eigenvalues and right vectors of a real matrix.
///
/// # Errors
/// As [`spectrum`].
pub fn eigenpairs(a: MatRef<'_, f64>) -> Result<(Vec<c64>, Mat<c64>)> {
    real(a, Vectors::Right).map(|found| (found.values, found.right))
}

/// The eigenvalues and right vectors of a complex matrix.
///
/// # Errors
/// As [`spectrum`].
pub fn complex_eigenpairs(a: MatRef<'_, c64>) -> Result<(Vec<c64>, Mat<c64>)> {
    complex(a, Vectors::Right).map(|found| (found.values, found.right))
}

/// The eigenvalues of a real matrix alone, at a third of the cost of [`spectrum`].
///
/// # Errors
/// As [`spectrum`].
pub fn eigenvalues(a: MatRef<'_, f64>) -> Result<Vec<c64>> {
    real(a, Vectors::None).map(|found| found.values)
}

/// The eigenvalues of a complex matrix alone, at a sixth of the cost of [`complex_spectrum`].
///
/// # Errors
/// As [`spectrum`].
pub fn complex_eigenvalues(a: MatRef<'_, c64>) -> Result<Vec<c64>> {
    complex(a, Vectors::None).map(|found| found.values)
}

/// Vectors that are computed besides the eigenvalues.
#[derive(Clone, Copy, PartialEq)]
enum Vectors {
    None,
    Right,
    Both,
}

/// ‖A x − λ x‖ that is accepted of vectors of unit length, by ‖A‖: far above round-off, and far below that of an iteration that did
/// not converge.
const RESIDUAL: f64 = 1e-9;
/// Attempts after the first, and the random change of A with which they begin, by ‖A‖: that which rounding makes of it, and more each
/// time. It parts eigenvalues that are exactly equal, whose vectors the back substitution divides by nothing until they overflow.
const ATTEMPTS: i32 = 5;
const CHANGE: f64 = f64::EPSILON;

impl Eigenvalues {
    /// Of a matrix without rows.
    fn none() -> Self {
        Eigenvalues { values: Vec::new(), right: Mat::zeros(0, 0), left: Mat::zeros(0, 0) }
    }
}

/// Of a real matrix.
fn real(a: MatRef<'_, f64>, vectors: Vectors) -> Result<Eigenvalues> {
    let n = a.nrows();
    if n == 0 {
        return Ok(Eigenvalues::none());
    }
    check(n, a.is_all_finite())?;
    let lifted = Mat::from_fn(n, n, |i, j| c64::new(a[(i, j)], 0.0));
    let [mut left, mut right] = matrices::<f64>(n, vectors);
    let (mut re, mut im) = (Diag::zeros(n), Diag::zeros(n));
    let [of_left, of_right] = [left.as_mut(), right.as_mut()].map(|m| m.map(|m| m.as_mut()));
    let mut memory = scratch::<f64>(n, vectors, <EvdParams as Auto<f64>>::auto());
    let stack = MemStack::new(&mut memory);
    let ended = evd_real(a, re.as_mut(), im.as_mut(), of_left, of_right, Par::Seq, stack, Default::default());
    if ended.is_ok() {
        let (re, im) = (re.column_vector(), im.column_vector());
        let values: Vec<c64> = (0..n).map(|k| c64::new(re[k], im[k])).collect();
        let [left, right] = [left, right].map(|u| u.map_or(Mat::zeros(n, 0), |u| in_pairs(&u, &values)));
        let found = Eigenvalues { values, right, left };
        if converged(lifted.as_ref(), &found) {
            return Ok(found);
        }
    }
    // Vectors of equal conjugate pairs, which the back substitution in real numbers loses, are found in complex ones.
    again(lifted.as_ref(), vectors)
}

/// Of a complex matrix.
fn complex(a: MatRef<'_, c64>, vectors: Vectors) -> Result<Eigenvalues> {
    if a.nrows() == 0 {
        return Ok(Eigenvalues::none());
    }
    check(a.nrows(), a.is_all_finite())?;
    match attempt(a, vectors, <EvdParams as Auto<c64>>::auto()) {
        Some(found) => Ok(found),
        None => again(a, vectors),
    }
}

/// By the plain QR algorithm instead of the blocked one: A as it is, then with random changes of the size of its rounding.
fn again(a: MatRef<'_, c64>, vectors: Vectors) -> Result<Eigenvalues> {
    let (n, length, mut random) = (a.nrows(), a.norm_l2(), Random::new());
    let auto = <EvdParams as Auto<c64>>::auto();
    let plain = EvdParams { schur: SchurParams { blocking_threshold: usize::MAX, ..auto.schur }, ..auto };
    let attempts = (0..ATTEMPTS).find_map(|k| {
        let size = if k == 0 { 0.0 } else { CHANGE * length * 16f64.powi(k - 1) / (n as f64).sqrt() };
        let changed = Mat::from_fn(n, n, |i, j| a[(i, j)] + c64::new(size * random.next(), 0.0));
        attempt(changed.as_ref(), vectors, plain)
    });
    attempts.ok_or_else(|| no_convergence(n))
}

/// The decomposition of a complex matrix; none where it did not converge.
fn attempt(a: MatRef<'_, c64>, vectors: Vectors, params: EvdParams) -> Option<Eigenvalues> {
    let n = a.nrows();
    let [mut left, mut right] = matrices::<c64>(n, vectors);
    let mut values = Diag::zeros(n);
    let [of_left, of_right] = [left.as_mut(), right.as_mut()].map(|m| m.map(|m| m.as_mut()));
    let mut memory = scratch::<c64>(n, vectors, params);
    let stack = MemStack::new(&mut memory);
    evd_cplx(a, values.as_mut(), of_left, of_right, Par::Seq, stack, params.into()).ok()?;
    let values = values.column_vector().iter().copied().collect();
    let [left, right] = [left, right].map(|u| u.unwrap_or(Mat::zeros(n, 0)));
    Some(Eigenvalues { values, right, left }).filter(|found| converged(a, found))
}

/// Memory for left and right vectors.
fn matrices<T: ComplexField>(n: usize, vectors: Vectors) -> [Option<Mat<T>>; 2] {
    [vectors == Vectors::Both, vectors != Vectors::None].map(|wanted| wanted.then(|| Mat::zeros(n, n)))
}

/// Whether eigenvalues and vectors are what they should be, as the decomposition does not say when it gave up: they have small
/// residuals, and where there are no vectors the sum of the eigenvalues is the trace.
fn converged(a: MatRef<'_, c64>, found: &Eigenvalues) -> bool {
    let (n, length) = (a.nrows(), a.norm_l2());
    let sum = |of: &dyn Fn(usize) -> c64| (0..n).map(of).sum::<c64>();
    let trace = sum(&|k| a[(k, k)]) - sum(&|k| found.values[k]);
    let fits = |a: MatRef<'_, c64>, x: &Mat<c64>, conjugate: bool| {
        let image = product(a, x.as_ref());
        (0..x.ncols()).all(|k| {
            let value = if conjugate { found.values[k].conj() } else { found.values[k] };
            let residual = (0..n).map(|i| (image[(i, k)] - value * x[(i, k)]).norm_sqr()).sum::<f64>().sqrt();
            let size = x.col(k).norm_l2();
            size > 0.0 && size.is_finite() && residual <= RESIDUAL * length * size
        })
    };
    // The comparison is false where a value is not a number.
    trace.norm() <= RESIDUAL * n as f64 * length
        && fits(a, &found.right, false)
        && fits(a.adjoint().to_owned().as_ref(), &found.left, true)
}

/// Work memory of the decomposition beside its results.
fn scratch<T: ComplexField>(n: usize, vectors: Vectors, params: EvdParams) -> MemBuffer {
    let wanted = |there: bool| if there { ComputeEigenvectors::Yes } else { ComputeEigenvectors::No };
    let (left, right) = (wanted(vectors == Vectors::Both), wanted(vectors != Vectors::None));
    MemBuffer::new(evd_scratch::<T>(n, left, right, Par::Seq, params.into()))
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
    if finite {
        return Ok(());
    }
    Err(Error::analysis(
        format!("dense eigenvalues of order {n}"),
        "an entry is not finite",
        "Look for zero or huge stiffnesses, masses and velocities in the model",
    ))
}

fn no_convergence(n: usize) -> Error {
    Error::analysis(
        format!("dense eigenvalues of order {n}"),
        "the iteration did not converge",
        "Look for stiffnesses, masses and damping many orders of magnitude apart, or move the band",
    )
}

#[cfg(test)]
mod tests {
    use super::super::samples::random_symmetric;
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn right_and_left_vectors_satisfy_their_equations() {
        let n = 41;
        let (a, b) = (random_symmetric(n, 3).to_dense(), random_symmetric(n, 4).to_dense());
        let skew = Mat::from_fn(n, n, |i, j| if i > j { b[(i, j)] } else { -b[(i, j)] });
        let real = &a + &skew;
        let alone = eigenvalues(real.as_ref()).unwrap();
        let nearest = |z: &c64| alone.iter().map(|w| (w - z).norm()).fold(f64::INFINITY, f64::min);
        let values = spectrum(real.as_ref()).unwrap().values;
        assert!(
            alone.len() == n && values.iter().all(|z| within(nearest(z), 1e-12 * real.norm_l2(), RoundOff))
        );
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
                assert!(within(r.norm_l2(), 1e-13 * size * x.norm_l2(), RoundOff), "{k} {:e}", r.norm_l2());
                assert!(within(l.norm_l2(), 1e-13 * size * y.norm_l2(), RoundOff), "{k} {:e}", l.norm_l2());
            }
            assert!(s.values.iter().filter(|z| z.im != 0.0).count() > 4);
        }
    }

    #[test]
    fn what_is_not_finite_is_refused() {
        assert!(spectrum(faer::mat![[f64::NAN]].as_ref()).is_err());
        assert!(spectrum(Mat::zeros(0, 0).as_ref()).unwrap().values.is_empty());
    }

    /// λ and right vectors with small residuals, whatever the matrix: the largest change, 16³ √n ε, and a margin.
    fn solved(a: &Mat<c64>, (values, x): (Vec<c64>, Mat<c64>), label: &str) {
        let size = a.norm_l2();
        assert!(x.is_all_finite() && values.len() == a.nrows(), "{label}");
        for (k, value) in values.iter().enumerate() {
            let r = a * x.col(k) - x.col(k) * faer::Scale(*value);
            assert!(
                within(r.norm_l2(), 1e-10 * size * x.col(k).norm_l2(), RoundOff),
                "{label} {k} {:e}",
                r.norm_l2() / size
            );
        }
    }

    #[test]
    fn equal_eigenvalues_that_are_coupled_have_vectors() {
        let mut random = Random::new();
        for n in [12usize, 40, 74, 75, 80, 132, 300] {
            for (size, coupling) in [(1.0, 1.0), (1e5, 1e3), (1.0, 1e-10)] {
                // A triangle with one eigenvalue, behind a few others.
                let a = Mat::from_fn(n, n, |i, j| match (i < n / 4, i == j, i < j) {
                    (true, true, _) => random.next(),
                    (false, true, _) => -size,
                    (_, _, true) => coupling * random.next(),
                    _ => 0.0,
                });
                let lifted = Mat::from_fn(n, n, |i, j| c64::new(a[(i, j)], 0.0));
                let label = format!("{n} {size} {coupling}");
                solved(&lifted, eigenpairs(a.as_ref()).expect(&label), &label);
                solved(&lifted, complex_eigenpairs(lifted.as_ref()).expect(&label), &label);
                let both = spectrum(a.as_ref()).expect(&label);
                let adjoint = lifted.adjoint().to_owned();
                solved(&adjoint, (both.values.iter().map(|z| z.conj()).collect(), both.left), &label);
                assert_eq!(eigenvalues(a.as_ref()).expect(&label).len(), n);
            }
        }
    }

    /// Several equal blocks, turned: conjugate pairs and real eigenvalues that are double, triple, …
    #[test]
    fn equal_parts_have_vectors_each() {
        let mut random = Random::seeded(3);
        for (parts, order) in [(2, 2), (2, 4), (3, 4), (2, 40), (5, 16)] {
            let part = Mat::from_fn(order, order, |_, _| random.next());
            let n = parts * order;
            let whole = Mat::from_fn(n, n, |i, j| match i / order == j / order {
                true => part[(i % order, j % order)],
                false => 0.0,
            });
            let turn = Mat::from_fn(n, n, |_, _| random.next());
            let q = turn.qr().compute_Q();
            for a in [whole.clone(), &q * &whole * q.transpose()] {
                let label = format!("{parts} of order {order}");
                let lifted = Mat::from_fn(n, n, |i, j| c64::new(a[(i, j)], 0.0));
                let both = spectrum(a.as_ref()).expect(&label);
                // Independent vectors of both sides.
                for vectors in [&both.right, &both.left] {
                    let unit = Mat::from_fn(n, n, |i, k| vectors[(i, k)] / vectors.col(k).norm_l2());
                    let least = unit.singular_values().unwrap()[n - 1];
                    assert!(least > 1e-8, "{label}: {least:e}");
                }
                solved(&lifted, (both.values.clone(), both.right), &label);
                let adjoint = lifted.adjoint().to_owned();
                solved(&adjoint, (both.values.iter().map(|z| z.conj()).collect(), both.left), &label);
            }
        }
    }
}
