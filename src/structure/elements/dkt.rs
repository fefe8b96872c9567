//! Bending stiffness of a thin plate: the discrete Kirchhoff triangle.
//!
//! Batoz, Bathe & Ho, "A study of three-node triangular plate bending elements", IJNME 15 (1980) 1771.
//! The rotations β = (θ₂, −θ₁), with u = z β the in-plane displacement of a fibre at height z, are quadratic over
//! the triangle; Kirchhoff's β = −∇w holds at the corners and, along each side, at its middle:
//!
//! * w is cubic along a side of length l from i to j, so β_s(mid) = −3/2 (w_j − w_i)/l − ¼ (β_si + β_sj);
//! * β across the side is linear along it.
//!
//! Hence β = Σ L_i β_i + Σ_sides 4 L_i L_j Δ t with Δ = −3/2 (w_j − w_i)/l − ¾ (β_si + β_sj) and t the side's
//! direction. w inside the element is never needed.

use super::symmetrized;
use super::triangle::{SIDES, gradients, twice_area};
use nalgebra::{Matrix3, SMatrix};

/// Moments from curvatures: D [[1, ν, 0], [ν, 1, 0], [0, 0, (1−ν)/2]] with D = E h³ / 12(1−ν²) \[N m\].
pub fn bending_rigidity(youngs_modulus: f64, poissons_ratio: f64, thickness: f64) -> Matrix3<f64> {
    plane_stress(youngs_modulus, poissons_ratio) * (thickness.powi(3) / 12.0)
}

/// Stresses from strains (ε_x, ε_y, γ_xy) in plane stress \[Pa\].
pub fn plane_stress(youngs_modulus: f64, poissons_ratio: f64) -> Matrix3<f64> {
    let nu = poissons_ratio;
    let c = youngs_modulus / (1.0 - nu * nu);
    Matrix3::new(c, c * nu, 0.0, c * nu, c, 0.0, 0.0, 0.0, c * (1.0 - nu) / 2.0)
}

/// Curvatures (β_x,x; β_y,y; β_x,y + β_y,x) at barycentric coordinates `at` from (w, θ₁, θ₂) at the corners, 3 × 9.
pub fn curvatures(corners: &[[f64; 2]; 3], at: [f64; 3]) -> SMatrix<f64, 3, 9> {
    let grad = gradients(corners);
    // Gradient of β as (x, y) derivatives of (β_x, β_y), one column a degree of freedom.
    let mut d_beta = [[[0.0; 9]; 2]; 2];
    for i in 0..3 {
        for d in 0..2 {
            d_beta[d][0][3 * i + 2] += grad[i][d];
            d_beta[d][1][3 * i + 1] -= grad[i][d];
        }
    }
    for [i, j] in SIDES {
        let (dx, dy) = (corners[j][0] - corners[i][0], corners[j][1] - corners[i][1]);
        let l = dx.hypot(dy);
        let t = [dx / l, dy / l];
        let mut excess = [0.0; 9];
        for (node, sign) in [(i, 1.0), (j, -1.0)] {
            excess[3 * node] = sign * 1.5 / l;
            excess[3 * node + 1] = 0.75 * t[1];
            excess[3 * node + 2] = -0.75 * t[0];
        }
        for d in 0..2 {
            let bubble = 4.0 * (grad[i][d] * at[j] + at[i] * grad[j][d]);
            for component in 0..2 {
                for (entry, e) in d_beta[d][component].iter_mut().zip(excess) {
                    *entry += bubble * t[component] * e;
                }
            }
        }
    }
    let [[bx_x, by_x], [bx_y, by_y]] = d_beta;
    SMatrix::from_fn(|row, k| match row {
        0 => bx_x[k],
        1 => by_y[k],
        _ => bx_y[k] + by_x[k],
    })
}

/// K = ∫ κᵀ D κ dA on (w, θ₁, θ₂) at the corners, 9 × 9; `rigidity` relates moments to curvatures \[N m\].
///
/// κ is linear, so the three mid-side points integrate exactly.
pub fn stiffness(corners: &[[f64; 2]; 3], rigidity: &Matrix3<f64>) -> SMatrix<f64, 9, 9> {
    let weight = twice_area(corners) / 6.0;
    let k = [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]]
        .map(|at| curvatures(corners, at))
        .iter()
        .fold(SMatrix::zeros(), |sum, b| sum + b.transpose() * rigidity * b * weight);
    symmetrized(k)
}
