//! The projected quadratic eigenproblem: small and dense.

use super::basis::Basis;
use super::operator::Operator;
use crate::error::{Error, Result};
use crate::linalg::c64;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use rayon::prelude::*;

/// What stands for no mass, where vectors of the band have a mass of about one.
const TRACE_OF_MASS: f64 = 1e-10;

/// An eigenpair of the projected problem with its left vector, in coordinates of the basis.
#[derive(Debug, Clone)]
pub(super) struct SmallPair {
    pub(super) lambda: c64,
    pub(super) right: Vec<c64>,
    pub(super) left: Vec<c64>,
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
    (by_velocity * w.transpose(), by_displacement * w.transpose())
}

/// The wanted eigenpairs of (λ² M + λ C + K + iH) y = 0, ascending in (Im λ, Re λ).
///
/// Through the companion matrix of the problem scaled to ‖K‖ = 1, then one step of inverse iteration on Q(λ) itself,
/// which removes the companion's loss of digits for λ far below the highest frequency of the basis.
pub(super) fn solve(
    mass: &Mat<f64>,
    damping: &Mat<f64>,
    stiffness: &Mat<f64>,
    hysteretic: Option<&Mat<f64>>,
    wanted: impl Fn(c64) -> bool + Sync,
) -> Result<Vec<SmallPair>> {
    let m = mass.nrows();
    let failed = |what: &str| {
        Error::analysis(
            "complex eigenvalues, projected problem",
            format!("{what} (size {m})"),
            "Check the model for parts without mass or with numbers out of any range",
        )
    };
    // Directions with (next to) no mass have eigenvalues at infinity: with a trace of mass they are very large instead.
    // That moves the others by about as much, which the polishing on the true matrices takes back.
    let factor = |trace: f64| {
        let mass = Mat::from_fn(m, m, |i, j| mass[(i, j)] + if i == j { trace } else { 0.0 });
        mass.llt(Side::Lower).ok().map(|llt| llt.L().to_owned())
    };
    let sound = |l: &Mat<f64>| (0..m).all(|i| l[(i, i)] * l[(i, i)] >= TRACE_OF_MASS);
    let l = factor(0.0)
        .filter(sound)
        .or_else(|| factor(TRACE_OF_MASS))
        .ok_or_else(|| failed("the mass matrix is not positive definite"))?;
    let reduce = |a: &Mat<f64>| {
        let mut x = a.clone();
        l.solve_lower_triangular_in_place(x.as_mut());
        let mut y = x.transpose().to_owned();
        l.solve_lower_triangular_in_place(y.as_mut());
        y.transpose().to_owned()
    };
    let (c, k, h) = (reduce(damping), reduce(stiffness), hysteretic.map(&reduce));
    let scale = k.norm_l2().sqrt().max(c.norm_l2()).max(f64::MIN_POSITIVE);
    let entry = |i: usize, j: usize, k_entry: f64| match (i < m, j < m) {
        (true, true) => 0.0,
        (true, false) => f64::from(i == j - m),
        (false, true) => -k_entry / (scale * scale),
        (false, false) => -c[(i - m, j - m)] / scale,
    };
    let part = |a: &Mat<f64>, i: usize, j: usize| if i >= m && j < m { a[(i - m, j)] } else { 0.0 };
    let eigen = match &h {
        None => Mat::from_fn(2 * m, 2 * m, |i, j| entry(i, j, part(&k, i, j))).eigen(),
        Some(h) => Mat::from_fn(2 * m, 2 * m, |i, j| {
            c64::new(entry(i, j, part(&k, i, j)), -part(h, i, j) / (scale * scale))
        })
        .eigen(),
    }
    .map_err(|_| failed("its eigenvalues did not converge"))?;
    let v = eigen.U().to_owned();
    let mut chosen: Vec<(c64, usize)> =
        (0..2 * m).map(|i| (eigen.S()[i] * scale, i)).filter(|(z, _)| wanted(*z)).collect();
    chosen.sort_by(|a, b| a.0.im.total_cmp(&b.0.im).then(a.0.re.total_cmp(&b.0.re)));
    // The rows of V⁻¹ are the left vectors wᴴ; their second half is ψᴴ.
    let mut inverse_rows =
        Mat::from_fn(2 * m, chosen.len(), |i, j| c64::new(f64::from(i == chosen[j].1), 0.0));
    v.transpose().partial_piv_lu().solve_in_place(inverse_rows.as_mut());
    let back = |y: Vec<c64>| -> Vec<c64> {
        let mut parts = Mat::from_fn(m, 2, |i, p| if p == 0 { y[i].re } else { y[i].im });
        l.transpose().solve_upper_triangular_in_place(parts.as_mut());
        unit((0..m).map(|i| c64::new(parts[(i, 0)], parts[(i, 1)])).collect())
    };
    let pairs: Vec<SmallPair> = chosen
        .par_iter()
        .enumerate()
        .map(|(j, (lambda, column))| {
            let right = back((0..m).map(|i| v[(i, *column)]).collect());
            let left = back((0..m).map(|i| inverse_rows[(m + i, j)].conj()).collect());
            polish(mass, damping, stiffness, hysteretic, SmallPair { lambda: *lambda, right, left })
        })
        .collect();
    Ok(pairs)
}

/// One step of two-sided inverse iteration, kept when it brings both residuals down.
fn polish(mass: &Mat<f64>, c: &Mat<f64>, k: &Mat<f64>, h: Option<&Mat<f64>>, pair: SmallPair) -> SmallPair {
    let m = mass.nrows();
    let q = |s: c64| {
        Mat::from_fn(m, m, |i, j| {
            let lossy = h.map_or(0.0, |h| h[(i, j)]);
            s * s * mass[(i, j)] + s * c[(i, j)] + c64::new(k[(i, j)], lossy)
        })
    };
    let slope = |s: c64| Mat::from_fn(m, m, |i, j| s * 2.0 * mass[(i, j)] + c64::new(c[(i, j)], 0.0));
    let column = |y: &[c64]| Mat::from_fn(m, 1, |i, _| y[i]);
    let list = |y: &Mat<c64>| unit((0..m).map(|i| y[(i, 0)]).collect());
    let (here, slope_here) = (q(pair.lambda), slope(pair.lambda));
    let lu = here.partial_piv_lu();
    let mut right = &slope_here * column(&pair.right);
    lu.solve_in_place(right.as_mut());
    let mut left = slope_here.adjoint() * column(&pair.left);
    lu.solve_adjoint_in_place(left.as_mut());
    let (right, left) = (list(&right), list(&left));
    let (y, z) = (column(&right), column(&left));
    let rise = (z.adjoint() * &here * &y)[(0, 0)];
    let steepness = (z.adjoint() * &slope_here * &y)[(0, 0)];
    let lambda = pair.lambda - rise / steepness;
    let there = q(lambda);
    let residual =
        |a: &Mat<c64>, y: &Mat<c64>, z: &Mat<c64>| (a * y).norm_l2().max((a.adjoint() * z).norm_l2());
    let before = residual(&here, &column(&pair.right), &column(&pair.left));
    let after = residual(&there, &y, &z);
    if after < before { SmallPair { lambda, right, left } } else { pair }
}

fn unit(mut y: Vec<c64>) -> Vec<c64> {
    let norm = y.iter().map(|z| z.norm_sqr()).sum::<f64>().sqrt();
    y.iter_mut().for_each(|z| *z /= norm);
    y
}
