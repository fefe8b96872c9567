//! The projected quadratic eigenproblem: small and dense.

use super::basis::Basis;
use super::operator::Operator;
use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::linalg::dense::product;
use crate::linalg::lu::Lu;
use crate::linalg::unsymmetric::{complex_eigenpairs, eigenpairs};
use faer::{Conj, Mat};
use rayon::prelude::*;

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
    let to_all = |by: &Mat<f64>| product(by.as_ref(), w.transpose());
    (to_all(&by_velocity), to_all(&by_displacement))
}

/// The wanted eigenpairs of Q(λ) y = (λ² M + λ C + K + iH) y = 0, ascending in (Im λ, Re λ).
///
/// With λ = s + s/θ for a real s > 0 of the size of the wanted eigenvalues, θ are the eigenvalues of
/// θ² Q(s) + θ s Q′(s) + s² M. Its companion matrix needs Q(s)⁻¹, not M⁻¹: directions (next to) without mass are at
/// θ = 0 and nothing of them is large, so that a singular M costs no digits. One step of inverse iteration on Q(λ)
/// itself then takes back what the linearisation lost.
///
/// # Errors
/// Q(s) is singular, or the eigenvalues do not converge.
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
    let failed = |what: &str| {
        Error::analysis(
            "complex eigenvalues, projected problem",
            format!("{what} (size {m})"),
            "Check the model for parts without mass or with numbers out of any range",
        )
    };
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
    if !lower.is_all_finite() {
        return Err(failed(&format!("its matrix at s = {s:e} is singular")));
    }
    let companion = Mat::from_fn(2 * m, 2 * m, |i, j| match i < m {
        true => c64::new(f64::from(j == i + m), 0.0),
        false => lower[(i - m, j)],
    });
    // Without losses all numbers are real.
    let (theta, v) = match hysteretic {
        None => eigenpairs(Mat::from_fn(2 * m, 2 * m, |i, j| companion[(i, j)].re).as_ref())?,
        Some(_) => complex_eigenpairs(companion.as_ref())?,
    };
    let mut chosen: Vec<(c64, usize)> =
        (0..2 * m).map(|i| (s + s / theta[i], i)).filter(|(z, _)| z.is_finite() && wanted(*z)).collect();
    chosen.sort_by(|a, b| a.0.im.total_cmp(&b.0.im).then(a.0.re.total_cmp(&b.0.re)));
    // The rows of V⁻¹ are the left vectors wᴴ of the companion matrix; their second half is ψᴴQ(s).
    let mut inverse_rows =
        Mat::from_fn(2 * m, chosen.len(), |i, j| c64::new(f64::from(i == chosen[j].1), 0.0));
    Lu::new(v.transpose().to_owned()).solve_in_place(inverse_rows.as_mut());
    let mut left = Mat::from_fn(m, chosen.len(), |i, j| inverse_rows[(m + i, j)].conj());
    lu.solve_transpose_in_place(Conj::Yes, left.as_mut());
    let pairs: Vec<SmallPair> = chosen
        .par_iter()
        .enumerate()
        .map(|(j, (lambda, column))| {
            let right = unit((0..m).map(|i| v[(i, *column)]).collect());
            let left = unit((0..m).map(|i| left[(i, j)]).collect());
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
    let lu = Lu::new(here.clone());
    let right = lu.solve(product(slope_here.as_ref(), column(&pair.right).as_ref()));
    let mut left = product(slope_here.adjoint(), column(&pair.left).as_ref());
    lu.solve_transpose_in_place(Conj::Yes, left.as_mut());
    let (right, left) = (list(&right), list(&left));
    let (y, z) = (column(&right), column(&left));
    let form = |a: &Mat<c64>| product(z.adjoint(), product(a.as_ref(), y.as_ref()).as_ref())[(0, 0)];
    let (rise, steepness) = (form(&here), form(&slope_here));
    let lambda = pair.lambda - rise / steepness;
    let there = q(lambda);
    let residual = |a: &Mat<c64>, y: &Mat<c64>, z: &Mat<c64>| {
        let (right, left) = (product(a.as_ref(), y.as_ref()), product(a.adjoint(), z.as_ref()));
        right.norm_l2().max(left.norm_l2())
    };
    let before = residual(&here, &column(&pair.right), &column(&pair.left));
    let after = residual(&there, &y, &z);
    if after < before { SmallPair { lambda, right, left } } else { pair }
}

fn unit(mut y: Vec<c64>) -> Vec<c64> {
    let norm = y.iter().map(|z| z.norm_sqr()).sum::<f64>().sqrt();
    y.iter_mut().for_each(|z| *z /= norm);
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_problem_without_directions_has_no_pairs() {
        let none = Mat::zeros(0, 0);
        for loss in [None, Some(&none)] {
            assert!(solve(&none, &none, &none, loss, 1.0, |_| true).unwrap().is_empty());
        }
    }
}
