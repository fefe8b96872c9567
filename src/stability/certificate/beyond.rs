//! Nothing grows faster than the region reaches.
//!
//! For Re s = σ ≥ R and |Im s| ≤ R the Hermitian part of s̄Q(s)/σ is
//!
//! K + K_σ + |s|²M + (|s|²/σ) C + W [k_s + (ω/σ) i k_k + (|s|²/σ) c_s] Wᵀ (+ (ω/σ) H),
//!
//! with k_s, c_s the symmetric and k_k the skew part of k and c. As ω ≤ σ, |s|² ≥ R² and σ ≤ |s|²/σ ≤ 2σ, it is positive
//! definite, and s no eigenvalue, when C and H dissipate and
//! * K + K_σ + R²M + W(k_s − |k_k| − 2b c₋)Wᵀ is positive definite, c₋ the negative part of c_s (σ ≤ b), and
//! * ½ b M + W c_s Wᵀ is semidefinite (σ > b).
//!
//! The first is a matter of the receptance at s = R, the second of an inertia count, where friction falls.

use super::reduced::ReducedModel;
use crate::error::Result;
use crate::linalg::SparseMatrix;
use crate::linalg::dense::{product, symmetric_eigen};
use crate::linalg::factor::inertia_like;
use crate::linalg::sparse::{add_scaled, diagonal, entry};
use crate::stability::analysis::CompletedAnalysis;
use faer::{Mat, MatRef};
use std::f64::consts::TAU;

/// Whether no eigenvalue with |ω| ≤ R has a growth rate of R or more, R the top of the band; false when that could not
/// be shown.
pub(super) fn nothing_faster(model: &ReducedModel, analysis: &CompletedAnalysis<'_>) -> Result<bool> {
    let radius = TAU * analysis.band_hz[1];
    if !model.dissipative {
        return Ok(false);
    }
    let interface = &analysis.operator.interface;
    let sizes = interface.sizes(radius);
    let r = model.active.len();
    let scale: Vec<f64> = model.active.iter().map(|d| sizes[*d].sqrt()).collect();
    let (mut k, mut c) = (Mat::<f64>::zeros(r, r), Mat::<f64>::zeros(r, r));
    let place = |d: usize| model.active.iter().position(|a| *a == d);
    for term in &interface.terms {
        if let (Some(i), Some(j)) = (place(term.row), place(term.column)) {
            k[(i, j)] += term.stiffness / (scale[i] * scale[j]);
            c[(i, j)] += term.damping / (scale[i] * scale[j]);
        }
    }
    let part = |a: &Mat<f64>, sign: f64| Mat::from_fn(r, r, |i, j| 0.5 * (a[(i, j)] + sign * a[(j, i)]));
    let (k_s, k_k, c_s) = (part(&k, 1.0), part(&k, -1.0), part(&c, 1.0));
    let skew = function(product(k_k.transpose(), k_k.as_ref()).as_ref(), |v| v.max(0.0).sqrt())?;
    let falling = function(c_s.as_ref(), |v| (-v).max(0.0))?;
    let falls = falling.norm_max() > 1e-14 * c_s.norm_max();
    let Some((receptance, error)) = receptance(model, analysis, &scale, radius) else { return Ok(false) };
    let held = |b: f64| -> Result<bool> {
        let worst = Mat::from_fn(r, r, |i, j| k_s[(i, j)] - skew[(i, j)] - 2.0 * b * falling[(i, j)]);
        let root = function(worst.as_ref(), |v| (-v).max(0.0).sqrt())?;
        let product = product(product(root.as_ref(), receptance.as_ref()).as_ref(), root.as_ref());
        let (values, _) = symmetric_eigen(product.as_ref())?;
        let largest = values.last().copied().unwrap_or(0.0);
        Ok(largest + root.norm_l2().powi(2) * error < 1.0)
    };
    if !falls {
        return held(0.0);
    }
    for factor in [1024.0, 256.0, 64.0, 16.0, 4.0, 1.5] {
        let b = factor * radius;
        if held(b)? {
            return Ok(holds_against_friction(analysis, b));
        }
    }
    Ok(false)
}

/// W_BᵀP_B(R)⁻¹W_B of the undamped structure for the scaled directions, and a bound on what Wᵀ(K + R²M)⁻¹W has beyond it;
/// `None` when K + R²M is not known to be positive definite.
fn receptance(
    model: &ReducedModel,
    analysis: &CompletedAnalysis<'_>,
    scale: &[f64],
    radius: f64,
) -> Option<(Mat<f64>, f64)> {
    let m = model.oscillators.len();
    let stiff: Vec<f64> = model.oscillators.iter().map(|o| o.stiffness + radius * radius).collect();
    if stiff.iter().any(|v| *v <= 0.0) {
        return None;
    }
    let v = Mat::from_fn(m, scale.len(), |i, j| model.interface[(i, j)] * scale[j]);
    let flexible = Mat::from_fn(m, scale.len(), |i, j| v[(i, j)] / stiff[i]);
    let within = product(v.transpose(), flexible.as_ref());
    let Some(remainder) = &model.remainder else { return Some((within, 0.0)) };
    // Γ = (R² + σ_A) ZᵀMB without damping, by the first term of the remainder.
    let g = radius * radius + analysis.shift;
    let (_, l) = remainder.terms.first()?;
    let y =
        (product(l.transpose(), flexible.as_ref()) * faer::Scale(g)).norm_l2() + remainder.missed_response;
    let own: f64 = (0..m).map(|i| (g * l.row(i).norm_l2()).powi(2) / stiff[i]).sum();
    let slack = 1.0 / remainder.amplification([radius; 2], 0.0) - own;
    (slack > 0.0).then(|| (within, y * y / slack))
}

/// f of a symmetric matrix.
fn function(a: MatRef<'_, f64>, f: impl Fn(f64) -> f64) -> Result<Mat<f64>> {
    let (values, vectors) = symmetric_eigen(a)?;
    let n = values.len();
    let scaled = Mat::from_fn(n, n, |i, j| vectors[(i, j)] * f(values[j]));
    Ok(product(scaled.as_ref(), vectors.transpose()))
}

/// Whether ½ b M + W c_s Wᵀ is positive semidefinite, M taken with the rounding of its entries ([`rounding`]). First a diagonal
/// below W c_s Wᵀ replaces it, as that is in the pattern whose analysis is at hand.
fn holds_against_friction(analysis: &CompletedAnalysis<'_>, b: f64) -> bool {
    let (mass, stiffness) = (analysis.operator.mass, &*analysis.operator.stiffness);
    let definite = |matrix: &SparseMatrix| {
        inertia_like(analysis.factor, matrix).is_ok_and(|i| i.negative == 0 && i.zero == 0)
    };
    let friction = symmetric_damping(analysis);
    let (rounding, below) = (rounding(mass), diagonal_below(&friction, mass));
    let inertia = [(0.5 * b, mass), (0.5 * b, &rounding)];
    definite(&add_scaled(&[inertia[0], inertia[1], (0.0, stiffness), (1.0, &below)]))
        || definite(&add_scaled(&[inertia[0], inertia[1], (1.0, &friction)]))
}

/// A diagonal that bounds the rounding of M, d_i = 1e-14 |m_ii| + u max m: massless degrees of freedom have pivots of either
/// sign of that size, whatever the units, and M + D is a mass matrix equal to the given one within rounding.
fn rounding(mass: &SparseMatrix) -> SparseMatrix {
    let own = diagonal(mass);
    let largest = own.iter().fold(0.0f64, |l, m| l.max(*m));
    let entries: Vec<_> =
        own.iter().enumerate().map(|(i, m)| entry(i, i, 1e-14 * m.abs() + f64::EPSILON * largest)).collect();
    SparseMatrix::try_new_from_triplets(own.len(), own.len(), &entries).expect("a diagonal")
}

/// A diagonal D with A − D positive semidefinite: by Gershgorin's discs of A in coordinates of unit mass,
/// dᵢ = mᵢ (aᵢᵢ/mᵢ − Σ_{j≠i} |aᵢⱼ| / √(mᵢmⱼ)), mᵢ the diagonal of M, where it is no mass its rounding.
fn diagonal_below(a: &SparseMatrix, mass: &SparseMatrix) -> SparseMatrix {
    let own = diagonal(mass);
    let least = f64::EPSILON * own.iter().fold(0.0f64, |l, m| l.max(*m));
    let m = |i: usize| own[i].max(least);
    let bound = |j: usize| {
        let entries = a.row_idx_of_col(j).zip(a.val_of_col(j));
        entries.map(|(i, v)| if i == j { *v } else { -v.abs() * (m(j) / m(i)).sqrt() }).sum()
    };
    let rows = (0..a.ncols()).filter(|j| !a.row_idx_of_col_raw(*j).is_empty());
    let triplets: Vec<_> = rows.map(|j| entry(j, j, bound(j))).collect();
    SparseMatrix::try_new_from_triplets(a.nrows(), a.ncols(), &triplets).expect("indices of a matrix")
}

/// W c_s Wᵀ as a sparse matrix.
fn symmetric_damping(analysis: &CompletedAnalysis<'_>) -> SparseMatrix {
    let (interface, n) = (&analysis.operator.interface, analysis.operator.n());
    let mut triplets = Vec::new();
    for term in interface.terms.iter().filter(|t| t.damping != 0.0) {
        let (row, column) = (interface.directions[term.row], interface.directions[term.column]);
        for (i, a) in row.iter() {
            for (j, b) in column.iter() {
                let value = 0.5 * term.damping * (a * b);
                triplets.extend([entry(i, j, value), entry(j, i, value)]);
            }
        }
    }
    SparseMatrix::try_new_from_triplets(n, n, &triplets).expect("directions of the system")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::samples;

    #[test]
    fn diagonal_lies_below() {
        let n = 40;
        let mass = Mat::from_fn(n, n, |i, j| if i == j { 10f64.powi(i as i32 % 7 - 3) } else { 0.0 });
        let coupled = |i: usize| i % 3 == 1;
        let a = Mat::from_fn(n, n, |i, j| match coupled(i) && coupled(j) {
            true => ((i + j) as f64).cos() * (mass[(i, i)] * mass[(j, j)]).sqrt(),
            false => 0.0,
        });
        let below = diagonal_below(&samples::from_dense(a.as_ref()), &samples::from_dense(mass.as_ref()));
        assert!(below.compute_nnz() == (0..n).filter(|i| coupled(*i)).count());
        // In coordinates of unit mass, so that no entry is lost beside others.
        let rest = Mat::from_fn(n, n, |i, j| {
            let d = if i == j { below.get(i, i).copied().unwrap_or(0.0) } else { 0.0 };
            (a[(i, j)] - d) / (mass[(i, i)] * mass[(j, j)]).sqrt()
        });
        let (values, _) = symmetric_eigen(rest.as_ref()).unwrap();
        assert!(values[0] > -1e-12, "{}", values[0]);
    }
}
