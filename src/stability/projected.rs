//! The projected quadratic eigenproblem: small and dense.

use super::basis::Basis;
use super::{ROUNDING, is_real};
use crate::dynamics::Operator;
use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::linalg::dense::{cholesky, product, symmetric_eigen};
use crate::linalg::lu::Lu;
use crate::linalg::orthogonal::{ThinSvd, thin_svd};
use crate::linalg::random::Random;
use crate::linalg::unsymmetric::{complex_eigenpairs, eigenpairs};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Conj, Mat, Par};

/// An eigenpair of the projected problem with its left vector, in coordinates of the basis.
#[derive(Debug, Clone)]
pub(super) struct SmallPair {
    pub(super) lambda: c64,
    pub(super) right: Vec<c64>,
    pub(super) left: Vec<c64>,
    /// zᴴQ′(λ)y of the left vector z and the right one y.
    pub(super) steepness: c64,
}

/// BᵀC_cB, BᵀK_cB, by which the interface enters a projected problem of any size.
pub(super) fn project_interface(operator: &Operator<'_>, basis: &Basis<'_>) -> (Mat<f64>, Mat<f64>) {
    let (m, r) = (basis.len(), basis.interface.ncols());
    let w = &basis.interface;
    // (BᵀW) c and (BᵀW) k column by column, then times (BᵀW)ᵀ.
    let (mut by_velocity, mut by_displacement) = (Mat::<f64>::zeros(m, r), Mat::<f64>::zeros(m, r));
    for term in &operator.interface.terms {
        for i in 0..m {
            by_velocity[(i, term.column)] += w[(i, term.row)] * term.damping;
            by_displacement[(i, term.column)] += w[(i, term.row)] * term.stiffness;
        }
    }
    let to_all = |by: &Mat<f64>| product(by.as_ref(), w.transpose());
    (to_all(&by_velocity), to_all(&by_displacement))
}

/// The wanted eigenpairs of Q(λ) y = (λ² M + λ C + K + iH) y = 0, ascending in (Im λ, Re λ).
///
/// With λ = s + s/θ for a real s > 0 of the size of the wanted eigenvalues, θ are the eigenvalues of
/// θ² Q(s) + θ s Q′(s) + s² M. Its companion matrix needs Q(s)⁻¹, not M⁻¹: directions (next to) without mass are at
/// θ = 0 and nothing of them is large, so that a singular M costs no digits. One Newton step on Q(λ) itself then takes
/// back what the linearisation lost.
/// Fails where Q(s) is singular, or the eigenvalues do not converge.
pub(super) fn solve(
    mass: &Mat<f64>,
    damping: &Mat<f64>,
    stiffness: &Mat<f64>,
    hysteretic: Option<&Mat<f64>>,
    s: f64,
    wanted: impl Fn(c64) -> bool + Sync,
) -> Result<Vec<SmallPair>> {
    let m = mass.nrows();
    // A band below all real modes, and nothing that damps or touches.
    if m == 0 {
        return Ok(Vec::new());
    }
    if hysteretic.is_none()
        && damping.norm_max() == 0.0
        && let Some(pairs) = symmetric_pairs(mass, stiffness, s, &wanted)
    {
        return Ok(pairs);
    }
    let failed = |what: &str| {
        Error::analysis(
            "complex eigenvalues, projected problem",
            format!("{what} (size {m})"),
            "Check the model for parts without mass or with numbers out of any range",
        )
    };
    let problem = Projection { mass, damping, stiffness, hysteretic };
    let Some(Linearised { s, lu, companion, mut theta, mut v }) = problem.linearised(s)? else {
        return Err(failed(&format!("its matrix near s = {s:e} is singular")));
    };
    let mut size = SPLIT;
    while size < MOST_SPLIT && dependent(&theta, &v) {
        (theta, v) = problem.pairs_of(&changed(&companion, size))?;
        size *= 16.0;
    }
    let mut chosen: Vec<(c64, usize)> =
        (0..2 * m).map(|i| (s + s / theta[i], i)).filter(|(z, _)| z.is_finite() && wanted(*z)).collect();
    chosen.sort_by(|a, b| a.0.im.total_cmp(&b.0.im).then(a.0.re.total_cmp(&b.0.re)));
    let (lambda, own) = chosen.into_iter().unzip();
    let inverse = Lu::new(v.transpose().to_owned());
    let companion = Companion { theta, v, inverse, at_s: lu, own };
    let (right, left) = companion.vectors();
    let complex = |a: &Mat<f64>, h: Option<&Mat<f64>>| {
        Mat::from_fn(m, m, |i, j| c64::new(a[(i, j)], h.map_or(0.0, |h| h[(i, j)])))
    };
    let quadratic = Quadratic {
        mass: complex(mass, None),
        damping: complex(damping, None),
        stiffness: complex(stiffness, hysteretic),
    };
    let mut pairs = Vectors { lambda, right, left };
    quadratic.separate(&mut pairs);
    Ok(polished(&quadratic, &companion, pairs, &wanted))
}

/// Factors of s at which the projected problem is linearised, one after the other.
const MOVED: [f64; 4] = [1.0, 0.881_966, 1.234_568, 0.618_034];
/// |θ| = s/|λ − s| of an eigenvalue that is too near to the shift, and the size of the companion matrix, θ² of a double one. Only
/// eigenvalues that diverge as fast as the band's modes turn are so near.
const NEXT_TO_SHIFT: f64 = 100.0;
const LARGE: f64 = 1e6;

/// The matrices of a projected problem.
struct Projection<'a> {
    mass: &'a Mat<f64>,
    damping: &'a Mat<f64>,
    stiffness: &'a Mat<f64>,
    hysteretic: Option<&'a Mat<f64>>,
}

/// A projected problem in θ at a shift s, with its eigenvalues and vectors.
struct Linearised {
    s: f64,
    /// Factors of Q(s).
    lu: Lu<c64>,
    companion: Mat<c64>,
    theta: Vec<c64>,
    v: Mat<c64>,
}

impl Projection<'_> {
    /// At s, or near it where that is on an eigenvalue or next to one: the first has no factors, the second costs the others their
    /// digits. None where Q is singular at every shift.
    fn linearised(&self, s: f64) -> Result<Option<Linearised>> {
        let mut last = None;
        for s in MOVED.map(|factor| factor * s) {
            let Some((lu, companion)) = self.companion(s) else { continue };
            let (theta, v) = self.pairs_of(&companion)?;
            let near = theta.iter().any(|theta| theta.norm() > NEXT_TO_SHIFT) || companion.norm_max() > LARGE;
            last = Some(Linearised { s, lu, companion, theta, v });
            if !near {
                break;
            }
        }
        Ok(last)
    }

    /// Factors of Q(s), and the companion matrix; none where Q(s) is singular.
    fn companion(&self, s: f64) -> Option<(Lu<c64>, Mat<c64>)> {
        let Projection { mass, damping, stiffness, hysteretic } = *self;
        let m = mass.nrows();
        let value = Mat::from_fn(m, m, |i, j| {
            let real = s * (s * mass[(i, j)] + damping[(i, j)]) + stiffness[(i, j)];
            c64::new(real, hysteretic.map_or(0.0, |h| h[(i, j)]))
        });
        let lu = Lu::new(value);
        // −Q(s)⁻¹ \[s² M, s Q′(s)\], the lower half of the companion matrix.
        let lower = lu.solve(Mat::from_fn(m, 2 * m, |i, j| {
            let rest = match j < m {
                true => mass[(i, j)],
                false => 2.0 * mass[(i, j - m)] + damping[(i, j - m)] / s,
            };
            c64::new(-s * s * rest, 0.0)
        }));
        let whole = |i: usize, j: usize| match i < m {
            true => c64::new(f64::from(j == i + m), 0.0),
            false => lower[(i - m, j)],
        };
        lower.is_all_finite().then(|| (lu, Mat::from_fn(2 * m, 2 * m, whole)))
    }

    /// Its eigenvalues θ and vectors. Without losses all numbers are real.
    fn pairs_of(&self, companion: &Mat<c64>) -> Result<(Vec<c64>, Mat<c64>)> {
        let real = |i: usize, j: usize| companion[(i, j)].re;
        match self.hysteretic {
            None => eigenpairs(Mat::from_fn(companion.nrows(), companion.ncols(), real).as_ref()),
            Some(_) => complex_eigenpairs(companion.as_ref()),
        }
    }
}

/// The wanted pairs of (λ² M + K) y = 0 with a symmetric K, each with itself as left vector: μ = 1/(s² − λ²) of the symmetric problem
/// M y = μ (K + s²M) y, so that equal eigenvalues, λ = 0 of several rigid bodies among them, have orthogonal vectors. `None` where K is
/// not symmetric but for rounding, or K + s²M not positive definite for any of the s that are tried, beyond the fastest divergence.
fn symmetric_pairs(
    mass: &Mat<f64>,
    stiffness: &Mat<f64>,
    s: f64,
    wanted: &impl Fn(c64) -> bool,
) -> Option<Vec<SmallPair>> {
    let m = mass.nrows();
    let noise = ROUNDING * stiffness.norm_max();
    let skew = |i: usize, j: usize| (stiffness[(i, j)] - stiffness[(j, i)]).abs();
    if (0..m).any(|j| (0..j).any(|i| skew(i, j) > noise)) {
        return None;
    }
    let half = |a: &Mat<f64>, i: usize, j: usize| 0.5 * (a[(i, j)] + a[(j, i)]);
    let symmetric = Mat::from_fn(m, m, |i, j| half(stiffness, i, j));
    let shifted = |square: f64| Mat::from_fn(m, m, |i, j| symmetric[(i, j)] + square * half(mass, i, j));
    let decomposed = |square: f64| {
        let factor = cholesky(shifted(square).as_ref()).ok()?;
        let mut inner = mass.clone();
        solve_lower_triangular_in_place(factor.as_ref(), inner.as_mut(), Par::Seq);
        let mut inner = inner.transpose().to_owned();
        solve_lower_triangular_in_place(factor.as_ref(), inner.as_mut(), Par::Seq);
        let (mu, vectors) = symmetric_eigen(inner.as_ref()).ok()?;
        // One next to −s² takes the digits of the others.
        (mu[m - 1] * square < NEXT_TO_SHIFT).then_some((factor, mu, vectors))
    };
    let mut squares = (0..FARTHER).map(|k| s * s * 16f64.powi(k));
    let (factor, mu, mut vectors) = squares.find_map(decomposed)?;
    solve_upper_triangular_in_place(factor.transpose(), vectors.as_mut(), Par::Seq);
    let [inertia, force] = [mass, &symmetric].map(|a| product(a.as_ref(), vectors.as_ref()));
    let mut pairs = Vec::new();
    // μ = 0 is what has no mass.
    for k in (0..m).filter(|k| mu[*k] > ROUNDING * mu[m - 1]) {
        let form = |a: &Mat<f64>| -> f64 { (0..m).map(|i| vectors[(i, k)] * a[(i, k)]).sum() };
        let (mass, length) = (form(&inertia), vectors.col(k).norm_l2());
        let square = -form(&force) / mass;
        let root = square.abs().sqrt();
        let lambda = if square < 0.0 { c64::new(0.0, root) } else { c64::new(root, 0.0) };
        let y: Vec<c64> = (0..m).map(|i| c64::new(vectors[(i, k)] / length, 0.0)).collect();
        for lambda in [lambda, -lambda].into_iter().filter(|z| wanted(*z)) {
            let steepness = 2.0 * lambda * mass / (length * length);
            pairs.push(SmallPair { lambda, right: y.clone(), left: y.clone(), steepness });
        }
    }
    pairs.sort_by(|a, b| a.lambda.im.total_cmp(&b.lambda.im).then(a.lambda.re.total_cmp(&b.lambda.re)));
    Some(pairs)
}

/// How often s² is taken 16 times as large.
const FARTHER: i32 = 6;

/// Two θ are the same within this part of them.
const TOGETHER: f64 = 1e-12;
/// θ nearer than this part of them may share their vectors, which are dependent below this sine.
const CLUSTER: f64 = 1e-9;
const DEPENDENT: f64 = 1e-10;
/// λ nearer than this part of them are the same: rounding parts those that share one vector by its root, far more.
const ALIKE: f64 = 1e-11;
/// The change that parts them, by the size of a row: a few roundings, at first.
const SPLIT: f64 = 4.0 * f64::EPSILON;
const MOST_SPLIT: f64 = 1e-13;

/// λ farther than this many s from s, as those of directions without mass, are not looked at.
const FAR: f64 = 1e3;

/// Whether θ that are all but equal have vectors that are dependent, as two λ = 0 of a rigid body, or a critically damped pair.
fn dependent(theta: &[c64], v: &Mat<c64>) -> bool {
    let mut seen: Vec<bool> = theta.iter().map(|theta| FAR * theta.norm() < 1.0).collect();
    (0..theta.len()).any(|j| {
        let near = |k: &usize| (theta[*k] - theta[j]).norm() <= CLUSTER * theta[j].norm();
        let group: Vec<usize> = (j..theta.len()).filter(|k| !seen[*k] && near(k)).collect();
        group.iter().for_each(|k| seen[*k] = true);
        if group.len() < 2 {
            return false;
        }
        let vectors = unit(Mat::from_fn(v.nrows(), group.len(), |i, k| v[(i, group[k])]));
        thin_svd(vectors.as_ref()).is_none_or(|svd| svd.values[group.len() - 1] < DEPENDENT)
    })
}

/// The companion matrix with a random change of its lower half, of `size` times the length of a row: within its own rounding, and
/// enough to part eigenvalues that would share one vector, by √`size` (approximate diagonalisation, E. B. Davies, SIAM J. Matrix
/// Anal. Appl. 29 (2007) 1051).
fn changed(companion: &Mat<c64>, size: f64) -> Mat<c64> {
    let (m, mut random) = (companion.nrows() / 2, Random::new());
    let mut changed = companion.clone();
    for i in m..2 * m {
        let length = size * companion.row(i).norm_l2();
        (0..2 * m).for_each(|j| changed[(i, j)] += c64::new(length * random.next(), 0.0));
    }
    changed
}

/// Pairs in coordinates of the basis, one a column.
struct Vectors {
    lambda: Vec<c64>,
    right: Mat<c64>,
    left: Mat<c64>,
}

impl Vectors {
    /// zⱼᴴxⱼ with the left vector z.
    fn form(&self, j: usize, x: &Mat<c64>) -> c64 {
        self.left.col(j).adjoint() * x.col(j)
    }
}

/// M, C and K + iH of Q(λ).
struct Quadratic {
    mass: Mat<c64>,
    damping: Mat<c64>,
    stiffness: Mat<c64>,
}

impl Quadratic {
    /// Q(λⱼ) yⱼ and Q(λⱼ)ᴴ zⱼ.
    fn values(&self, Vectors { lambda, right, left }: &Vectors) -> [Mat<c64>; 2] {
        let times = |x: &Mat<c64>| {
            [&self.stiffness, &self.damping, &self.mass].map(|a| product(a.as_ref(), x.as_ref()))
        };
        let adjoint = |x: &Mat<c64>| {
            [&self.stiffness, &self.damping, &self.mass].map(|a| product(a.adjoint(), x.as_ref()))
        };
        let sum = |[k, c, m]: [Mat<c64>; 3], s: &dyn Fn(usize) -> c64| {
            Mat::from_fn(k.nrows(), k.ncols(), |i, j| k[(i, j)] + s(j) * (c[(i, j)] + s(j) * m[(i, j)]))
        };
        [sum(times(right), &|j| lambda[j]), sum(adjoint(left), &|j| lambda[j].conj())]
    }

    /// Of eigenvalues that are the same but for rounding, as of equal parts, the QR algorithm gives any vectors of their common
    /// space, nearly parallel ones, too: it gets orthonormal right vectors, and left ones with zᵢᴴQ′yⱼ = 0 for i ≠ j.
    fn separate(&self, pairs: &mut Vectors) {
        let count = pairs.lambda.len();
        let mut seen = vec![false; count];
        for j in 0..count {
            let lambda = pairs.lambda[j];
            let near = |k: &usize| (pairs.lambda[*k] - lambda).norm() <= ALIKE * lambda.norm();
            let group: Vec<usize> = (j..count).filter(|k| !seen[*k] && near(k)).collect();
            group.iter().for_each(|k| seen[*k] = true);
            if group.len() < 2 {
                continue;
            }
            let span = |x: &Mat<c64>| {
                let x = Mat::from_fn(x.nrows(), group.len(), |i, k| x[(i, group[k])]);
                let whole = |svd: &ThinSvd<c64>| svd.values[group.len() - 1] > DEPENDENT * svd.values[0];
                thin_svd(x.as_ref()).filter(whole).map(|svd| svd.left)
            };
            let (Some(right), Some(left)) = (span(&pairs.right), span(&pairs.left)) else { continue };
            let lambda = group.iter().map(|k| pairs.lambda[*k]).collect();
            let common = Vectors { lambda, right, left };
            let lu = Lu::new(product(common.left.adjoint(), self.slopes(&common).as_ref()));
            let mixed = lu.solve(common.left.adjoint().to_owned());
            if !mixed.is_all_finite() {
                continue;
            }
            let left = unit(mixed.adjoint().to_owned());
            for (k, column) in group.iter().enumerate() {
                pairs.right.col_mut(*column).copy_from(common.right.col(k));
                pairs.left.col_mut(*column).copy_from(left.col(k));
            }
        }
    }

    /// Q′(λⱼ) yⱼ.
    fn slopes(&self, Vectors { lambda, right, .. }: &Vectors) -> Mat<c64> {
        let [c, m] = [&self.damping, &self.mass].map(|a| product(a.as_ref(), right.as_ref()));
        Mat::from_fn(c.nrows(), c.ncols(), |i, j| c[(i, j)] + 2.0 * lambda[j] * m[(i, j)])
    }
}

/// The companion matrix T of θ² Q(s) + θ s Q′(s) + s² M by its eigenpairs, and which of them are wanted.
struct Companion {
    theta: Vec<c64>,
    v: Mat<c64>,
    /// The factors of Vᵀ.
    inverse: Lu<c64>,
    /// Those of Q(s).
    at_s: Lu<c64>,
    /// The column of V for each wanted pair.
    own: Vec<usize>,
}

impl Companion {
    fn m(&self) -> usize {
        self.v.nrows() / 2
    }

    /// Right and left vectors of the wanted pairs. The rows of V⁻¹ are the left vectors wᴴ of T; their second half is
    /// ψᴴQ(s).
    fn vectors(&self) -> (Mat<c64>, Mat<c64>) {
        let (m, count) = (self.m(), self.own.len());
        let mut rows = Mat::from_fn(2 * m, count, |i, j| c64::new(f64::from(i == self.own[j]), 0.0));
        self.inverse.solve_in_place(rows.as_mut());
        let mut left = Mat::from_fn(m, count, |i, j| rows[(m + i, j)].conj());
        self.at_s.solve_transpose_in_place(Conj::Yes, left.as_mut());
        (unit(Mat::from_fn(m, count, |i, j| self.v[(i, self.own[j])])), unit(left))
    }

    /// θ²/(θ − θᵢ) for the wanted pair j; nothing for its own θᵢ, and others that are the same.
    fn weight(&self, i: usize, j: usize) -> c64 {
        let theta = self.theta[self.own[j]];
        let apart = theta - self.theta[i];
        if i == self.own[j] || apart.norm() <= TOGETHER * theta.norm() {
            return c64::new(0.0, 0.0);
        }
        theta * theta / apart
    }

    /// Q(λⱼ)⁻¹ bⱼ but for the pole at λⱼ: θ² \[I 0\] (θ − T)⁻¹ \[0; Q(s)⁻¹ b\].
    fn solve(&self, b: Mat<c64>) -> Mat<c64> {
        let m = self.m();
        let b = self.at_s.solve(b);
        let zero = c64::new(0.0, 0.0);
        let mut x = Mat::from_fn(2 * m, b.ncols(), |i, j| if i < m { zero } else { b[(i - m, j)] });
        self.inverse.solve_transpose_in_place(Conj::No, x.as_mut());
        let x = Mat::from_fn(2 * m, b.ncols(), |i, j| self.weight(i, j) * x[(i, j)]);
        product(self.v.subrows(0, m), x.as_ref())
    }

    /// Q(λⱼ)⁻ᴴ bⱼ likewise.
    fn solve_adjoint(&self, b: &Mat<c64>) -> Mat<c64> {
        let m = self.m();
        let x = product(self.v.subrows(0, m).adjoint(), b.as_ref());
        let mut x = Mat::from_fn(2 * m, b.ncols(), |i, j| self.weight(i, j) * x[(i, j)].conj());
        self.inverse.solve_in_place(x.as_mut());
        let mut x = Mat::from_fn(m, b.ncols(), |i, j| x[(m + i, j)].conj());
        self.at_s.solve_transpose_in_place(Conj::Yes, x.as_mut());
        x
    }
}

/// One Newton step for all pairs, which takes back what the linearisation lost: y − Q(λ)⁻¹Q(λ)y with the inverse that the
/// companion matrix gives but for the pole at λ, and λ − zᴴQ(λ)y / zᴴQ′(λ)y. It is kept where it brings both residuals down, λ is
/// `wanted` still, and real where it was: of a double real eigenvalue, zᴴQ′(λ)y ≈ 0, it may lead to the conjugate, which nobody looks
/// for, or take the one of a pair that is looked for to the real axis, where it would stand for itself alone.
fn polished(
    quadratic: &Quadratic,
    companion: &Companion,
    pairs: Vectors,
    wanted: &impl Fn(c64) -> bool,
) -> Vec<SmallPair> {
    let [right, left] = quadratic.values(&pairs);
    let size = |[right, left]: [&Mat<c64>; 2], j: usize| right.col(j).norm_l2().max(left.col(j).norm_l2());
    let before: Vec<f64> = (0..pairs.lambda.len()).map(|j| size([&right, &left], j)).collect();
    let left = unit(&pairs.left - companion.solve_adjoint(&left));
    let right = unit(&pairs.right - companion.solve(right));
    let mut next = Vectors { lambda: pairs.lambda.clone(), right, left };
    let ([rises, _], slopes) = (quadratic.values(&next), quadratic.slopes(&next));
    let step = |j: usize| next.form(j, &rises) / next.form(j, &slopes);
    next.lambda = (0..before.len()).map(|j| next.lambda[j] - step(j)).collect();
    let after = quadratic.values(&next);
    let slopes = [&pairs, &next].map(|pairs| quadratic.slopes(pairs));
    let pair = |j: usize| {
        let same_kind = wanted(next.lambda[j]) && is_real(next.lambda[j]) == is_real(pairs.lambda[j]);
        let better = usize::from(same_kind && size(after.each_ref(), j) < before[j]);
        let (vectors, slopes) = ([&pairs, &next][better], &slopes[better]);
        let list = |x: &Mat<c64>| x.col(j).iter().copied().collect();
        SmallPair {
            lambda: vectors.lambda[j],
            right: list(&vectors.right),
            left: list(&vectors.left),
            steepness: vectors.form(j, slopes),
        }
    };
    (0..before.len()).map(pair).collect()
}

/// Columns of unit length.
fn unit(mut x: Mat<c64>) -> Mat<c64> {
    for column in x.col_iter_mut() {
        let norm = column.norm_l2();
        column.iter_mut().for_each(|z| *z /= norm);
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn a_problem_without_directions_has_no_pairs() {
        let none = Mat::zeros(0, 0);
        for loss in [None, Some(&none)] {
            assert!(solve(&none, &none, &none, loss, 1.0, |_| true).unwrap().is_empty());
        }
    }

    /// Gyroscopic problems as of rotating brakes: a large skew G, clusters of overdamped directions, entries of C from 1e-6 to 1e6,
    /// friction in K. M = I, ω from 1e2 to 1e5 1/s.
    #[test]
    fn gyroscopic_problems_with_overdamped_clusters_are_solved() {
        let mut random = Random::seeded(7);
        for (trial, order) in [50usize, 132, 76, 200, 132, 96, 300, 60].into_iter().enumerate() {
            let m = order / 2;
            let omega: Vec<f64> = (0..m).map(|_| 10f64.powf(random.between(2.0, 5.0))).collect();
            let spin = 10f64.powf(random.between(0.0, 4.0));
            let mut c = Mat::<f64>::zeros(m, m);
            for i in 0..m {
                for j in 0..i {
                    let g = spin * random.next();
                    (c[(i, j)], c[(j, i)]) = (g, -g);
                }
                // A third of equal dashpots, a third of none but rounding, a third of all sizes.
                c[(i, i)] = [1e6, 1e-6, 10f64.powf(random.between(-6.0, 6.0))][i % 3];
            }
            let coupled = trial % 2 == 0;
            let k = Mat::from_fn(m, m, |i, j| match (i == j, coupled) {
                // Every third direction alike, with the dashpots above: many eigenvalues that are equal.
                (true, true) if i % 3 == 0 => 1e8,
                (true, _) => omega[i] * omega[i],
                (false, true) if i.abs_diff(j) == 3 => 1e5 * (i as f64 - j as f64),
                _ => 0.0,
            });
            let (mass, top) = (Mat::<f64>::identity(m, m), 5e4);
            let pairs = solve(&mass, &c, &k, None, 1e4, |z| z.im >= 0.0 && z.norm() <= top)
                .unwrap_or_else(|error| panic!("{trial}: {error}"));
            assert!(pairs.len() > m / 4, "{trial}: {}", pairs.len());
            let [of_c, of_k] = [c.norm_l2(), k.norm_l2()];
            for pair in &pairs {
                let z = pair.lambda;
                let row = |i: usize| -> c64 {
                    let term = |j: usize| z * z * mass[(i, j)] + z * c[(i, j)] + k[(i, j)];
                    (0..m).map(|j| term(j) * pair.right[j]).sum()
                };
                let residual = (0..m).map(|i| row(i).norm_sqr()).sum::<f64>().sqrt();
                let size = z.norm_sqr() + z.norm() * of_c + of_k;
                // The change of a matrix whose eigenvalues are parted, 1e-11 at most.
                assert!(within(residual, 1e-10 * size, RoundOff), "{trial}: {z} {:e}", residual / size);
            }
        }
    }
}
