//! Eigenpairs of (λ² M + λ C + K) x = 0 nearest a shift σ, by the two-level orthogonal Arnoldi method (TOAR): Su, Zhang
//! & Bai, SIAM workshop (2008); Lu, Su & Bai, SIAM J. Matrix Anal. Appl. 37 (2016) 195.
//!
//! With Q(λ) = λ² M + λ C + K, P = Q(σ), P′ = Q′(σ) and λ = σ + ρ/θ,
//!
//! θ² P x + θ ρ P′ x + ρ² M x = 0, or A v = θ v with A = \[−ρP⁻¹P′, −ρ²P⁻¹M; I, 0\] and v = (θx, x).
//!
//! The Krylov vectors are never stored in their double length: V = (U S₁; U S₂) with orthonormal U of about as many
//! columns as V, which is why the method stays backward stable. Restarts keep the span of the best Ritz vectors
//! (Krylov–Schur), and shrink U to the rank that is left.

use super::c64;
use super::dense::product;
use super::multivector::{combine, expand, gram};
use super::orthogonal::{ThinSvd, thin_svd};
use super::unsymmetric::complex_eigenpairs;
use faer::{Accum, Mat, MatRef, Scale};
use stridor_base::error::{Error, Result};

/// A quadratic eigenproblem at one shift.
pub trait ShiftedQuadratic {
    /// The order n.
    fn n(&self) -> usize;

    /// P⁻¹ (P′ x + M y), all n × 1.
    fn solve(&self, x: Mat<c64>, y: Mat<c64>) -> Mat<c64>;
}

/// Eigenpairs of [`toar`], nearest the shift first.
#[derive(Debug)]
pub struct ToarPairs {
    /// λ.
    pub values: Vec<c64>,
    /// x of each, ‖x‖ = 1, n × m.
    pub vectors: Mat<c64>,
    /// |λ − σ| within which there is no other; infinite where the problem has no others at all.
    pub within: f64,
    /// Solves with P that it took.
    pub solves: usize,
}

/// Restarts at most.
const RESTARTS: usize = 60;
/// After so many of them the Krylov space gets half as many vectors again: where the eigenvalues lie at about the same distance
/// from the shift, a small one sees no gap between those that are wanted and the others.
const PATIENCE: usize = 12;

/// The `count` eigenvalues of Q nearest `shift`, or, where these are fewer, at least those within `reach` of it, with
/// ‖A v − θ v‖ ≤ `tolerance` |θ| ‖v‖: eigenvalues beyond that which lie close together, as those of heavily damped parts do, converge
/// slowly and need not. `radius` is the distance within which they are expected: it scales the problem and decides nothing. Fewer than `count` when the problem has fewer.
///
/// # Errors
/// [`Error::Analysis`] when they do not converge.
pub fn toar(
    problem: &dyn ShiftedQuadratic,
    shift: c64,
    radius: f64,
    (count, reach): (usize, f64),
    tolerance: f64,
) -> Result<ToarPairs> {
    let count = count.min(2 * problem.n());
    let mut capacity = (2 * count).max(count + 16).min(2 * problem.n());
    let mut krylov = Krylov::new(problem, radius, capacity);
    for restart in 1..=RESTARTS {
        let closed = krylov.expand_to(capacity);
        let ritz = krylov.ritz()?;
        let converged = ritz.iter().take_while(|r| r.residual <= tolerance * r.theta.norm()).count();
        if converged >= count || closed {
            let found = krylov.pairs(shift, &ritz[..converged.min(count)]);
            let last = found.values.last().map_or(0.0, |z| (z - shift).norm());
            return Ok(ToarPairs { within: if closed { f64::INFINITY } else { last }, ..found });
        }
        // No Ritz value that is still on its way may end within the reach.
        if ritz[converged..].iter().all(|r| (r.theta.norm() + r.residual) * reach < radius) {
            return Ok(ToarPairs { within: reach, ..krylov.pairs(shift, &ritz[..converged]) });
        }
        krylov.restart(&ritz, count + (capacity - count) / 2)?;
        if restart % PATIENCE == 0 {
            capacity = (capacity + capacity / 2).min(2 * problem.n());
        }
    }
    Err(Error::analysis(
        "two-level Arnoldi",
        format!("{count} eigenvalues near {shift:.4} did not converge in {RESTARTS} restarts"),
        "Ask for fewer eigenvalues or take a shift nearer to them",
    ))
}

/// A Ritz pair of the projected problem.
struct Ritz {
    theta: c64,
    y: Vec<c64>,
    residual: f64,
}

/// A V = V H + v bᵀ with V = (U S₁; U S₂), and v the last column of S₁, S₂.
struct Krylov<'a> {
    problem: &'a dyn ShiftedQuadratic,
    radius: f64,
    /// n × d, orthonormal.
    u: Mat<c64>,
    /// Coordinates in U of the upper and lower halves, d × (k + 1).
    s: [Mat<c64>; 2],
    /// k × k.
    h: Mat<c64>,
    /// 1 × k.
    b: Vec<c64>,
    solves: usize,
}

impl<'a> Krylov<'a> {
    /// Starts from a vector that is the same in every run and leans on no degree of freedom.
    fn new(problem: &'a dyn ShiftedQuadratic, radius: f64, capacity: usize) -> Self {
        let n = problem.n();
        let mut u = Mat::zeros(n, 0);
        u.resize_with(n, 1, |i, _| {
            let x = (i as f64 + 1.0) * 0.618_033_988_749_894_9;
            c64::new(x.fract() - 0.5, (x * 1.324_717_957_244_746).fract() - 0.5)
        });
        let norm = u.norm_l2();
        u *= Scale(c64::new(1.0 / norm, 0.0));
        let half = c64::new(0.5f64.sqrt(), 0.0);
        let mut krylov = Krylov {
            problem,
            radius,
            u,
            s: [Mat::from_fn(1, 1, |_, _| half), Mat::from_fn(1, 1, |_, _| half)],
            h: Mat::zeros(0, 0),
            b: Vec::with_capacity(capacity),
            solves: 0,
        };
        // (x, x) is no vector of the range of A: one step first.
        let (x, y) = krylov.next_coordinates(0);
        krylov.s = [x, y];
        let norm = krylov.s[0].norm_l2().hypot(krylov.s[1].norm_l2());
        krylov.s.iter_mut().for_each(|s| *s *= Scale(c64::new(1.0 / norm, 0.0)));
        krylov
    }

    fn len(&self) -> usize {
        self.h.ncols()
    }

    /// A v of column `j` in coordinates of U, which grows by the direction that is new.
    fn next_coordinates(&mut self, j: usize) -> (Mat<c64>, Mat<c64>) {
        let d = self.u.ncols();
        let column = |s: &Mat<c64>| s.subcols(j, 1).to_owned();
        let (upper, lower) = (column(&self.s[0]), column(&self.s[1]));
        let real = |v: f64| Scale(c64::new(v, 0.0));
        let x = expand(self.u.as_ref(), upper.as_ref()) * real(self.radius);
        let y = expand(self.u.as_ref(), lower.as_ref()) * real(self.radius * self.radius);
        let mut w = self.problem.solve(x, y) * real(-1.0);
        self.solves += 1;
        let before = w.norm_l2();
        let mut along = Mat::<c64>::zeros(d, 1);
        for _ in 0..2 {
            let h = gram(self.u.as_ref(), w.as_ref());
            combine(w.as_mut(), Accum::Add, self.u.as_ref(), h.as_ref(), c64::new(-1.0, 0.0));
            along += h;
        }
        let left = w.norm_l2();
        let grown = left > 1e-14 * before && d < self.problem.n();
        if grown {
            self.u.resize_with(w.nrows(), d + 1, |i, _| w[(i, 0)] / left);
            let zero = |_: usize, _: usize| c64::new(0.0, 0.0);
            self.s.iter_mut().for_each(|s| s.resize_with(d + 1, s.ncols(), zero));
        }
        let d_new = self.u.ncols();
        let entry = |m: &Mat<c64>, i: usize, last: f64| if i < d { m[(i, 0)] } else { c64::new(last, 0.0) };
        (
            Mat::from_fn(d_new, 1, |i, _| entry(&along, i, left)),
            Mat::from_fn(d_new, 1, |i, _| entry(&upper, i, 0.0)),
        )
    }

    /// Arnoldi steps until V has `capacity` columns; true when it spans an invariant subspace before.
    fn expand_to(&mut self, capacity: usize) -> bool {
        while self.len() < capacity {
            let k = self.len();
            let (mut x, mut y) = self.next_coordinates(k);
            let before = x.norm_l2().hypot(y.norm_l2());
            let mut t = Mat::<c64>::zeros(k + 1, 1);
            for _ in 0..2 {
                let h = product(self.s[0].adjoint(), x.as_ref()) + product(self.s[1].adjoint(), y.as_ref());
                x -= product(self.s[0].as_ref(), h.as_ref());
                y -= product(self.s[1].as_ref(), h.as_ref());
                t += h;
            }
            let left = x.norm_l2().hypot(y.norm_l2());
            let row = std::mem::take(&mut self.b);
            let old = std::mem::replace(&mut self.h, Mat::zeros(0, 0));
            self.h = Mat::from_fn(k + 1, k + 1, |i, j| match (i < k, j < k) {
                (true, true) => old[(i, j)],
                (false, true) => row[j],
                (_, false) => t[(i, 0)],
            });
            self.b = vec![c64::new(0.0, 0.0); k + 1];
            if left <= 1e-14 * before {
                return true;
            }
            self.b[k] = c64::new(left, 0.0);
            for (s, part) in self.s.iter_mut().zip([&x, &y]) {
                s.resize_with(part.nrows(), k + 2, |i, _| part[(i, 0)] / left);
            }
        }
        self.len() >= 2 * self.problem.n()
    }

    /// Ritz pairs, largest |θ| first.
    fn ritz(&self) -> Result<Vec<Ritz>> {
        let (values, v) = complex_eigenpairs(self.h.as_ref())?;
        let mut ritz: Vec<Ritz> = (0..self.len())
            .map(|j| {
                let norm = v.col(j).norm_l2();
                let y: Vec<c64> = (0..self.len()).map(|i| v[(i, j)] / norm).collect();
                let residual = y.iter().zip(&self.b).map(|(y, b)| y * b).sum::<c64>().norm();
                Ritz { theta: values[j], y, residual }
            })
            .collect();
        ritz.sort_by(|a, b| b.theta.norm().total_cmp(&a.theta.norm()));
        Ok(ritz)
    }

    /// Keeps the span of the first `keep` Ritz vectors, and of U what they need.
    fn restart(&mut self, ritz: &[Ritz], keep: usize) -> Result<()> {
        let k = self.len();
        let keep = keep.min(k - 1);
        let z = range(Mat::from_fn(k, keep, |i, j| ritz[j].y[i]).as_ref())?.0;
        self.h = product(z.adjoint(), product(self.h.as_ref(), z.as_ref()).as_ref());
        self.b = (0..keep).map(|j| (0..k).map(|i| self.b[i] * z[(i, j)]).sum()).collect();
        let d = self.u.ncols();
        let rotated: Vec<Mat<c64>> = self
            .s
            .iter()
            .map(|s| {
                let kept = product(s.subcols(0, k), z.as_ref());
                Mat::from_fn(d, keep + 1, |i, j| if j < keep { kept[(i, j)] } else { s[(i, k)] })
            })
            .collect();
        let both = Mat::from_fn(d, 2 * keep + 2, |i, j| rotated[j / (keep + 1)][(i, j % (keep + 1))]);
        let (w, rank) = range(both.as_ref())?;
        let w = w.subcols(0, rank);
        self.u = expand(self.u.as_ref(), w);
        for (s, rotated) in self.s.iter_mut().zip(&rotated) {
            *s = product(w.adjoint(), rotated.as_ref());
        }
        Ok(())
    }

    fn pairs(&self, shift: c64, ritz: &[Ritz]) -> ToarPairs {
        let k = self.len();
        let coordinates = Mat::from_fn(self.u.ncols(), ritz.len(), |i, j| {
            // (θx, x): the larger half has lost fewer digits.
            let s = if ritz[j].theta.norm() >= 1.0 { &self.s[0] } else { &self.s[1] };
            (0..k).map(|l| s[(i, l)] * ritz[j].y[l]).sum::<c64>()
        });
        let mut vectors = expand(self.u.as_ref(), coordinates.as_ref());
        for j in 0..vectors.ncols() {
            let norm = vectors.col(j).norm_l2();
            vectors.col_mut(j).iter_mut().for_each(|v| *v /= norm);
        }
        let values = ritz.iter().map(|r| shift + c64::new(self.radius, 0.0) / r.theta).collect();
        ToarPairs { values, vectors, within: 0.0, solves: self.solves }
    }
}

/// Left singular vectors of A, and how many singular values are above round-off.
fn range(a: MatRef<'_, c64>) -> Result<(Mat<c64>, usize)> {
    let Some(ThinSvd { left, values, .. }) = thin_svd(a) else {
        return Err(Error::analysis(
            "two-level Arnoldi",
            "numbers that are infinite or none came up",
            "Check stiffnesses, masses and damping for values that are zero or huge",
        ));
    };
    let rank = values.iter().take_while(|s| **s > 1e-15 * values[0]).count();
    Ok((left, rank))
}

#[cfg(test)]
mod tests {
    use super::super::random::Random;
    use super::*;
    use faer::linalg::solvers::Solve;
    use stridor_base::bounds::{Origin::*, within};

    /// Dense M, C, K at a shift.
    struct Dense {
        m: Mat<c64>,
        slope: Mat<c64>,
        lu: faer::linalg::solvers::PartialPivLu<c64>,
    }

    impl Dense {
        fn new(m: &Mat<c64>, c: &Mat<c64>, k: &Mat<c64>, s: c64) -> Self {
            let p = Mat::from_fn(m.nrows(), m.nrows(), |i, j| s * s * m[(i, j)] + s * c[(i, j)] + k[(i, j)]);
            let slope = Mat::from_fn(m.nrows(), m.nrows(), |i, j| s * 2.0 * m[(i, j)] + c[(i, j)]);
            Dense { m: m.clone(), slope, lu: p.partial_piv_lu() }
        }
    }

    impl ShiftedQuadratic for Dense {
        fn n(&self) -> usize {
            self.m.nrows()
        }
        fn solve(&self, x: Mat<c64>, y: Mat<c64>) -> Mat<c64> {
            self.lu.solve(&self.slope * x + &self.m * y)
        }
    }

    fn random(n: usize, random: &mut Random) -> Mat<c64> {
        Mat::from_fn(n, n, |_, _| c64::new(random.next(), random.next()))
    }

    /// Eigenvalues of the companion matrix, nearest the shift first.
    fn exact(m: &Mat<c64>, c: &Mat<c64>, k: &Mat<c64>, shift: c64) -> Vec<c64> {
        let n = m.nrows();
        let lu = m.partial_piv_lu();
        let (c, k) = (lu.solve(c), lu.solve(k));
        let a = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, true) => -c[(i, j)],
            (true, false) => -k[(i, j - n)],
            (false, true) => c64::new(f64::from(i - n == j), 0.0),
            (false, false) => c64::new(0.0, 0.0),
        });
        let mut all = a.eigenvalues().unwrap();
        all.sort_by(|a, b| (a - shift).norm().total_cmp(&(b - shift).norm()));
        all
    }

    #[test]
    fn random_quadratic_problems_agree_with_a_dense_solver() {
        for (n, count, seed) in [(1, 1, 1), (2, 4, 2), (12, 5, 3), (40, 12, 4), (90, 20, 5)] {
            let mut numbers = Random::seeded(seed);
            let (m, c, k) = (random(n, &mut numbers), random(n, &mut numbers), random(n, &mut numbers));
            let shift = c64::new(0.3 * numbers.next(), numbers.next());
            let expected = exact(&m, &c, &k, shift);
            let found =
                toar(&Dense::new(&m, &c, &k, shift), shift, 0.5, (count, f64::INFINITY), 1e-13).unwrap();
            assert_eq!(found.values.len(), count);
            for (j, value) in found.values.iter().enumerate() {
                let error = expected.iter().map(|e| (e - value).norm()).fold(f64::INFINITY, f64::min);
                assert!(within(error, 1e-9, Tolerance), "n = {n}: {value} is off by {error:e}");
                let farthest = (expected[count - 1] - shift).norm();
                assert!(
                    within((value - shift).norm() - farthest, 1e-9 * farthest, Tolerance),
                    "not among the nearest"
                );
                let x = found.vectors.subcols(j, 1);
                let q = Mat::from_fn(n, n, |i, l| value * value * m[(i, l)] + value * c[(i, l)] + k[(i, l)]);
                assert!(within((q * x).norm_l2(), 1e-9, Tolerance));
            }
        }
    }

    /// Eigenvalues on a circle about the shift, which no rational function of few poles parts: the nearest by one part in
    /// a thousand.
    #[test]
    fn eigenvalues_at_one_distance_converge() {
        let mut numbers = Random::seeded(8);
        for n in [20, 40, 70] {
            let shift = c64::new(100.0, 0.0);
            let radius = |j: usize| 90.0 + 0.1 * (j as f64 + 0.5 * numbers.next());
            let square: Vec<c64> = {
                let mut radius = radius;
                (0..n).map(|j| c64::new(radius(j), 0.0)).collect()
            };
            // (λ − s)² = r e^{iα} of every degree of freedom: two eigenvalues each, at √r from the shift.
            let turn = |j: usize| c64::cis(std::f64::consts::TAU * (j as f64 * 0.618).fract());
            let diagonal = |value: &dyn Fn(usize) -> c64| {
                Mat::from_fn(n, n, |i, j| if i == j { value(i) } else { c64::new(0.0, 0.0) })
            };
            let m = diagonal(&|_| c64::new(1.0, 0.0));
            let c = diagonal(&|_| shift * -2.0);
            let k = diagonal(&|j| shift * shift - square[j] * turn(j));
            let found = toar(&Dense::new(&m, &c, &k, shift), shift, 10.0, (8, f64::INFINITY), 1e-12).unwrap();
            assert!(found.values.len() >= 8.min(2 * n));
            let last = square[3].re.sqrt();
            assert!(
                found.values.iter().all(|z| within((z - shift).norm() - last, 1e-9 * last, Tolerance)),
                "{:?}",
                found.values
            );
        }
    }

    #[test]
    fn frequencies_in_rad_per_second_are_as_easy_as_those_near_one() {
        // An undamped chain: λ = ±iω, ω from 60 to 20,000 rad/s.
        let n = 60;
        let zero = Mat::<c64>::zeros(n, n);
        let m = Mat::<c64>::identity(n, n);
        let k = Mat::from_fn(n, n, |i, j| {
            let stiffness = match i.abs_diff(j) {
                0 => 2.0,
                1 => -1.0,
                _ => 0.0,
            };
            c64::new(1e8 * stiffness, 0.0)
        });
        let omega = |j: usize| 2e4 * (j as f64 * std::f64::consts::PI / (2.0 * (n as f64 + 1.0))).sin();
        let shift = c64::new(0.0, omega(20) + 3.0);
        let found = toar(&Dense::new(&m, &zero, &k, shift), shift, 2e3, (9, f64::INFINITY), 1e-12).unwrap();
        for value in &found.values {
            let nearest = (1..=n).map(|j| (omega(j) - value.im).abs()).fold(f64::INFINITY, f64::min);
            assert!(within(nearest, 1e-8, Tolerance) && within(value.re.abs(), 1e-8, Tolerance), "{value}");
        }
        assert!(within((found.values[0].im - omega(20)).abs(), 1e-8, Tolerance));
    }

    /// Two lightly damped modes within the reach, and beyond it `n` − 2 overdamped ones all but equal, which converge one by one.
    #[test]
    fn clusters_beyond_the_reach_need_not_converge() {
        for (n, seed) in [(80, 1), (200, 2), (300, 3)] {
            let mut numbers = Random::seeded(seed);
            let spread: Vec<f64> = (0..n).map(|_| 1e-3 * numbers.next()).collect();
            let zero = c64::new(0.0, 0.0);
            let diagonal = |of: &dyn Fn(usize) -> f64| {
                Mat::from_fn(n, n, |i, j| if i == j { c64::new(of(i), 0.0) } else { zero })
            };
            let m = Mat::<c64>::identity(n, n);
            // λ² + 8 (1 + δ) λ + 8: overdamped at −1.17 and −6.8.
            let c = diagonal(&|i| if i < 2 { 0.01 } else { 8.0 * (1.0 + spread[i]) });
            let k = diagonal(&|i| [1.0, 1.1][i.min(1)] * if i < 2 { 1.0 } else { 8.0 / 1.1 });
            let shift = c64::new(1e-3, 1.0);
            let problem = Dense::new(&m, &c, &k, shift);
            let found = toar(&problem, shift, 0.5, (20, 0.5), 1e-12).unwrap();
            let inside = found.values.iter().filter(|z| (*z - shift).norm() <= 0.5).count();
            assert_eq!((inside, found.within), (2, 0.5));
            for square in [1.0f64, 1.1] {
                let exact = c64::new(-0.005, (square - 0.005f64.powi(2)).sqrt());
                let error = found.values.iter().map(|z| (z - exact).norm()).fold(f64::INFINITY, f64::min);
                assert!(within(error, 1e-12, Tolerance), "{n}: {error:e}");
            }
            assert!(found.solves < 150, "{} solves", found.solves);
        }
    }
}
