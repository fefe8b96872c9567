//! The dense quadratic eigenproblem Q(λ) x = (λ² M + λ C + K) x = 0, ψᴴ Q(λ) = 0, all 2n eigenvalues.
//!
//! With M = L Lᵀ and y = Lᵀ x it becomes a standard eigenproblem, A z = μ z, λ = s μ, with
//!
//!   A = [ 0, I ; −L⁻¹ K L⁻ᵀ / s², −L⁻¹ C L⁻ᵀ / s ],   z = (y, μ y),
//!
//! whose left vectors end in the left vectors of Q. A is balanced before (Parlett & Reinsch, Numer. Math. 13 (1969)
//! 293); each pair is refined after, in Q itself, where that lowers its residual. C and K need not be symmetric, K may
//! be complex (loss factors); M is symmetric positive definite. Tisseur & Meerbergen, SIAM Review 43 (2001) 235.

#[cfg(test)]
mod tests;

use super::c64;
use super::dense::cholesky;
use crate::error::{Error, Result};
use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, evd_cplx, evd_real, evd_scratch};
use faer::linalg::solvers::Solve;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::traits::ComplexField;
use faer::{Accum, Mat, MatRef, Par};
use rayon::prelude::*;
use std::ops::Mul;

/// An eigenvalue with its vectors.
#[derive(Debug, Clone)]
pub struct QuadraticPair {
    /// λ.
    pub lambda: c64,
    /// x, Q(λ) x = 0, with xᴴMx = 1 and its largest entry real and positive.
    pub right: Vec<c64>,
    /// ψ, ψᴴ Q(λ) = 0, with ψᴴMψ = 1 and its largest entry real and positive.
    pub left: Vec<c64>,
    /// ‖Q(λ)x‖ / ((|λ|²‖M‖ + |λ|‖C‖ + ‖K‖) ‖x‖) in Frobenius norms, the larger of both vectors'.
    pub backward_error: f64,
}

/// Refinement stops at this backward error.
const GOOD: f64 = 4e-15;
/// Above this backward error a step of inverse iteration is worth its n³ operations.
const POOR: f64 = 1e-13;

/// All 2n eigenvalues of λ² M + λ C + K for real matrices, ascending by imaginary, then real part. Complex ones come
/// as exact conjugates with conjugate vectors.
///
/// ```
/// use faer::mat;
/// // ẍ + 0.2 ẋ + 4 x: λ = −0.1 ± i √3.99.
/// let pairs = stridor::linalg::solve_qep(mat![[1.0]].as_ref(), mat![[0.2]].as_ref(), mat![[4.0]].as_ref()).unwrap();
/// assert!((pairs[1].lambda.re + 0.1).abs() < 1e-15 && (pairs[1].lambda.im - 3.99f64.sqrt()).abs() < 1e-15);
/// ```
///
/// # Errors
/// [`Error::Analysis`] when M is not positive definite, or a number is not finite.
///
/// # Panics
/// When the matrices are not square and of one size.
pub fn solve_qep(m: MatRef<'_, f64>, c: MatRef<'_, f64>, k: MatRef<'_, f64>) -> Result<Vec<QuadraticPair>> {
    let problem = Problem::new(m, c, complex(k))?;
    let n = m.nrows();
    let (mut a, s) = problem.linearise(k)?;
    let balance = balance(&mut a);
    let (mut re, mut im) = (Diag::<f64>::zeros(2 * n), Diag::<f64>::zeros(2 * n));
    let (mut left, mut right) = (Mat::zeros(2 * n, 2 * n), Mat::zeros(2 * n, 2 * n));
    evd_real(
        a.as_ref(),
        re.as_mut(),
        im.as_mut(),
        Some(left.as_mut()),
        Some(right.as_mut()),
        Par::Seq,
        MemStack::new(&mut scratch::<f64>(2 * n)),
        Default::default(),
    )
    .map_err(|_| no_convergence(n))?;
    // Columns j and j + 1 hold real and imaginary part of a conjugate pair; the left ones satisfy zᴴA = μzᴴ.
    let firsts: Vec<usize> = (0..2 * n).filter(|j| im[*j] >= 0.0).collect();
    let column = |u: &Mat<f64>, j: usize| -> Vec<c64> {
        (0..2 * n).map(|i| c64::new(u[(i, j)], if im[j] > 0.0 { u[(i, j + 1)] } else { 0.0 })).collect()
    };
    let halves = firsts
        .into_par_iter()
        .map(|j| problem.pair(c64::new(re[j], im[j]) * s, &balance, column(&right, j), column(&left, j)))
        .collect::<Result<Vec<_>>>()?;
    let mut pairs = Vec::with_capacity(2 * n);
    for pair in halves {
        if pair.lambda.im != 0.0 {
            pairs.push(pair.conjugate());
        }
        pairs.push(pair);
    }
    sort(&mut pairs);
    Ok(pairs)
}

/// [`solve_qep`] with a complex K, as loss factors give it; no conjugate symmetry then.
///
/// # Errors
/// As [`solve_qep`].
///
/// # Panics
/// When the matrices are not square and of one size.
pub fn solve_qep_complex(
    m: MatRef<'_, f64>,
    c: MatRef<'_, f64>,
    k: MatRef<'_, c64>,
) -> Result<Vec<QuadraticPair>> {
    let problem = Problem::new(m, c, k.to_owned())?;
    let n = m.nrows();
    let (mut a, s) = problem.linearise(k)?;
    let balance = balance(&mut a);
    let mut values = Diag::<c64>::zeros(2 * n);
    let (mut left, mut right) = (Mat::zeros(2 * n, 2 * n), Mat::zeros(2 * n, 2 * n));
    evd_cplx(
        a.as_ref(),
        values.as_mut(),
        Some(left.as_mut()),
        Some(right.as_mut()),
        Par::Seq,
        MemStack::new(&mut scratch::<c64>(2 * n)),
        Default::default(),
    )
    .map_err(|_| no_convergence(n))?;
    let column = |u: &Mat<c64>, j: usize| -> Vec<c64> { u.col(j).iter().copied().collect() };
    let mut pairs = (0..2 * n)
        .into_par_iter()
        .map(|j| problem.pair(values[j] * s, &balance, column(&right, j), column(&left, j)))
        .collect::<Result<Vec<_>>>()?;
    sort(&mut pairs);
    Ok(pairs)
}

impl QuadraticPair {
    /// The pair of λ̄ for real matrices.
    fn conjugate(&self) -> Self {
        let conjugate = |x: &[c64]| x.iter().map(|x| x.conj()).collect();
        QuadraticPair {
            lambda: self.lambda.conj(),
            right: conjugate(&self.right),
            left: conjugate(&self.left),
            backward_error: self.backward_error,
        }
    }
}

/// The matrices with what the refinement needs.
struct Problem {
    m: Mat<c64>,
    c: Mat<c64>,
    k: Mat<c64>,
    norms: [f64; 3],
    /// M = L Lᵀ.
    l: Mat<f64>,
    l_complex: Mat<c64>,
    c_real: Mat<f64>,
}

impl Problem {
    fn new(m: MatRef<'_, f64>, c: MatRef<'_, f64>, k: Mat<c64>) -> Result<Self> {
        let n = m.nrows();
        let square = |rows, columns| rows == n && columns == n;
        assert!(square(n, m.ncols()) && square(c.nrows(), c.ncols()) && square(k.nrows(), k.ncols()));
        let norms = [m.norm_l2(), c.norm_l2(), k.norm_l2()];
        if norms.iter().any(|x| !x.is_finite()) {
            return Err(no_convergence(n));
        }
        let l = cholesky(m)?;
        let l_complex = complex(l.as_ref());
        Ok(Problem { m: complex(m), c: complex(c), k, norms, l, l_complex, c_real: c.to_owned() })
    }

    /// A and the scale s, a power of two near ‖L⁻¹ K L⁻ᵀ‖^½.
    fn linearise<T: Entry>(&self, k: MatRef<'_, T>) -> Result<(Mat<T>, f64)> {
        let n = k.nrows();
        let l = Mat::from_fn(n, n, |i, j| T::from(self.l[(i, j)]));
        let reduced = |a: MatRef<'_, T>| {
            let mut a = a.to_owned();
            solve_lower_triangular_in_place(l.as_ref(), a.as_mut(), Par::Seq);
            let mut a = a.transpose().to_owned();
            solve_lower_triangular_in_place(l.as_ref(), a.as_mut(), Par::Seq);
            a.transpose().to_owned()
        };
        let k = reduced(k);
        let c = reduced(Mat::from_fn(n, n, |i, j| T::from(self.c_real[(i, j)])).as_ref());
        let size: f64 = k.norm_max().sqrt().max(c.norm_max());
        if !size.is_finite() {
            return Err(no_convergence(n));
        }
        let s = if size > 0.0 { size.log2().round().exp2() } else { 1.0 };
        let a = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, true) => T::from(0.0),
            (true, false) => T::from(if j == i + n { 1.0 } else { 0.0 }),
            (false, true) => k[(i - n, j)] * (-1.0 / (s * s)),
            (false, false) => c[(i - n, j - n)] * (-1.0 / s),
        });
        Ok((a, s))
    }

    /// Turns an eigenvalue of A with its vectors into a refined pair of Q.
    fn pair(&self, lambda: c64, balance: &[f64], z: Vec<c64>, left: Vec<c64>) -> Result<QuadraticPair> {
        let n = self.m.nrows();
        // Of y and μ y the larger one has suffered less from rounding.
        let unbalanced = |i: usize| z[i] * balance[i];
        let size = |range: std::ops::Range<usize>| range.map(|i| unbalanced(i).norm_sqr()).sum::<f64>();
        let from = if size(0..n) >= size(n..2 * n) { 0 } else { n };
        let mut x = Mat::from_fn(n, 1, |i, _| unbalanced(from + i));
        let mut psi = Mat::from_fn(n, 1, |i, _| left[n + i] / balance[n + i]);
        for v in [&mut x, &mut psi] {
            solve_upper_triangular_in_place(self.l_complex.transpose(), v.as_mut(), Par::Seq);
        }
        let mut best = self.measured(lambda, x, psi);
        for _ in 0..2 {
            if best.3 <= GOOD || !best.3.is_finite() {
                break;
            }
            let next = self.refined(&best);
            if next.3 < best.3 {
                best = next;
            } else {
                break;
            }
        }
        let (lambda, x, psi, backward_error) = best;
        if !backward_error.is_finite() {
            return Err(no_convergence(n));
        }
        Ok(QuadraticPair { lambda, right: self.normal(x), left: self.normal(psi), backward_error })
    }

    /// One step of the two-sided Rayleigh quotient, λ − ψᴴQx / ψᴴQ′x; poor vectors get one of inverse iteration first.
    fn refined(&self, (lambda, x, psi, error): &Measured) -> Measured {
        let (mut x, mut psi) = (x.clone(), psi.clone());
        if *error > POOR {
            let lu = self.q(*lambda).partial_piv_lu();
            let slope = self.slope(*lambda);
            let normalised = |v: Mat<c64>| {
                let size = v.norm_l2();
                if size.is_finite() && size > 0.0 {
                    Some(v * faer::Scale(c64::new(1.0 / size, 0.0)))
                } else {
                    None
                }
            };
            let better_x = normalised(lu.solve(product(slope.as_ref(), x.as_ref())));
            let adjoint = product(slope.adjoint().to_owned().as_ref(), psi.as_ref());
            let better_psi = normalised(faer::linalg::solvers::Solve::solve_adjoint(&lu, adjoint));
            x = better_x.unwrap_or(x);
            psi = better_psi.unwrap_or(psi);
        }
        let q = dot(&psi, &product(self.q(*lambda).as_ref(), x.as_ref()));
        let q_slope = dot(&psi, &product(self.slope(*lambda).as_ref(), x.as_ref()));
        let step = q / q_slope;
        let moved = if step.is_finite() { lambda - step } else { *lambda };
        let (stayed, moved) = (self.measured(*lambda, x.clone(), psi.clone()), self.measured(moved, x, psi));
        if moved.3 < stayed.3 { moved } else { stayed }
    }

    fn measured(&self, lambda: c64, x: Mat<c64>, psi: Mat<c64>) -> Measured {
        let size = lambda.norm();
        let norm = size * size * self.norms[0] + size * self.norms[1] + self.norms[2];
        let residual = |r: Mat<c64>, v: &Mat<c64>| r.norm_l2() / (norm * v.norm_l2()).max(f64::MIN_POSITIVE);
        let right = residual(self.q_times(lambda, &x), &x);
        let left = residual(self.q_adjoint_times(lambda, &psi), &psi);
        (lambda, x, psi, right.max(left))
    }

    /// Q(λ) x.
    fn q_times(&self, lambda: c64, x: &Mat<c64>) -> Mat<c64> {
        let [m, c, k] = [&self.m, &self.c, &self.k].map(|a| product(a.as_ref(), x.as_ref()));
        Mat::from_fn(x.nrows(), 1, |i, _| lambda * (lambda * m[(i, 0)] + c[(i, 0)]) + k[(i, 0)])
    }

    /// Q(λ)ᴴ ψ.
    fn q_adjoint_times(&self, lambda: c64, psi: &Mat<c64>) -> Mat<c64> {
        let row = Mat::from_fn(1, psi.nrows(), |_, i| psi[(i, 0)].conj());
        let [m, c, k] = [&self.m, &self.c, &self.k].map(|a| product(row.as_ref(), a.as_ref()));
        Mat::from_fn(psi.nrows(), 1, |i, _| (lambda * (lambda * m[(0, i)] + c[(0, i)]) + k[(0, i)]).conj())
    }

    fn q(&self, lambda: c64) -> Mat<c64> {
        let n = self.m.nrows();
        Mat::from_fn(n, n, |i, j| lambda * (lambda * self.m[(i, j)] + self.c[(i, j)]) + self.k[(i, j)])
    }

    /// Q′(λ) = 2 λ M + C.
    fn slope(&self, lambda: c64) -> Mat<c64> {
        let n = self.m.nrows();
        Mat::from_fn(n, n, |i, j| 2.0 * lambda * self.m[(i, j)] + self.c[(i, j)])
    }

    /// The vector with vᴴMv = 1 and its largest entry real and positive.
    fn normal(&self, v: Mat<c64>) -> Vec<c64> {
        let size = dot(&v, &product(self.m.as_ref(), v.as_ref())).re.max(0.0).sqrt();
        let mut largest = c64::new(0.0, 0.0);
        for entry in v.col(0).iter() {
            // Entries that are equal but for rounding leave the choice to the first.
            if entry.norm() > largest.norm() * (1.0 + 1e-6) {
                largest = *entry;
            }
        }
        let factor = if size > 0.0 { largest.conj() / (largest.norm() * size) } else { c64::new(0.0, 0.0) };
        v.col(0).iter().map(|entry| entry * factor).collect()
    }
}

/// λ, x, ψ and their backward error.
type Measured = (c64, Mat<c64>, Mat<c64>, f64);

/// A real or complex number.
trait Entry: ComplexField<Real = f64> + From<f64> + Mul<f64, Output = Self> + Copy {
    fn size(self) -> f64;
}

impl Entry for f64 {
    fn size(self) -> f64 {
        self.abs()
    }
}

impl Entry for c64 {
    fn size(self) -> f64 {
        self.norm()
    }
}

/// D⁻¹ A D with D of powers of two such that rows and columns have about the same size; returns D.
fn balance<T: Entry>(a: &mut Mat<T>) -> Vec<f64> {
    let n = a.nrows();
    let mut d = vec![1.0; n];
    for _ in 0..20 {
        let mut changed = false;
        for i in 0..n {
            let (mut row, mut column) = (0.0f64, 0.0f64);
            for j in (0..n).filter(|j| *j != i) {
                row += a[(i, j)].size();
                column += a[(j, i)].size();
            }
            if row == 0.0 || column == 0.0 {
                continue;
            }
            let f = (0.5 * (row / column).log2()).round().exp2();
            if f == 1.0 {
                continue;
            }
            changed = true;
            d[i] *= f;
            for j in (0..n).filter(|j| *j != i) {
                a[(j, i)] = a[(j, i)] * f;
                a[(i, j)] = a[(i, j)] * (1.0 / f);
            }
        }
        if !changed {
            break;
        }
    }
    d
}

fn product(a: MatRef<'_, c64>, b: MatRef<'_, c64>) -> Mat<c64> {
    let mut out = Mat::zeros(a.nrows(), b.ncols());
    faer::linalg::matmul::matmul(out.as_mut(), Accum::Replace, a, b, c64::new(1.0, 0.0), Par::Seq);
    out
}

/// aᴴ b.
fn dot(a: &Mat<c64>, b: &Mat<c64>) -> c64 {
    (0..a.nrows()).map(|i| a[(i, 0)].conj() * b[(i, 0)]).sum()
}

fn complex(a: MatRef<'_, f64>) -> Mat<c64> {
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| c64::new(a[(i, j)], 0.0))
}

fn scratch<T: ComplexField>(n: usize) -> MemBuffer {
    MemBuffer::new(evd_scratch::<T>(
        n,
        ComputeEigenvectors::Yes,
        ComputeEigenvectors::Yes,
        Par::Seq,
        Default::default(),
    ))
}

fn sort(pairs: &mut [QuadraticPair]) {
    pairs.sort_by(|a, b| a.lambda.im.total_cmp(&b.lambda.im).then(a.lambda.re.total_cmp(&b.lambda.re)));
}

fn no_convergence(n: usize) -> Error {
    Error::analysis(
        format!("quadratic eigenproblem of order {n}"),
        "the iteration did not converge, or a number is not finite",
        "Look for zero masses and huge stiffnesses in the model",
    )
}
