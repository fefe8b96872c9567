//! Geometric stiffness: what membrane and axial forces add to the stiffness against deflection (tension stiffens).

use super::bciz::slope_products;
use super::symmetrized;
use super::triangle::{gradients, twice_area};
use nalgebra::SMatrix;

/// K_σ = ∫ ∇wᵀ N ∇w dA on (w, θ₁, θ₂) at the corners, 9 × 9, for membrane forces `n` = (N_x, N_y, N_xy) \[N/m\],
/// positive in tension; w the cubic of [`super::bciz`].
pub fn plate(corners: &[[f64; 2]; 3], n: [f64; 3]) -> SMatrix<f64, 9, 9> {
    let [xx, yy, xy] = slope_products(corners);
    symmetrized((xx * n[0] + yy * n[1] + xy * n[2]) * (twice_area(corners) / 2.0))
}

/// K_σ = ∫ ∇uᵀ N ∇u + ∇vᵀ N ∇v dA on (u, v, θ₃) at the corners, 9 × 9: of motion in the plane, taken as linear. A rigid rotation in the
/// plane has its share of the forces that make N, as one out of it has.
pub fn membrane(corners: &[[f64; 2]; 3], [n_x, n_y, n_xy]: [f64; 3]) -> SMatrix<f64, 9, 9> {
    let (slopes, area) = (gradients(corners), twice_area(corners) / 2.0);
    let mut k = SMatrix::zeros();
    for (i, [ax, ay]) in slopes.into_iter().enumerate() {
        for (j, [bx, by]) in slopes.into_iter().enumerate() {
            let share = area * (ax * n_x * bx + ay * n_y * by + n_xy * (ax * by + ay * bx));
            (0..2).for_each(|c| k[(3 * i + c, 3 * j + c)] = share);
        }
    }
    symmetrized(k)
}

/// K_σ = N ∫ w′² dx of one bending plane of a bar of length l on (w, w′) at its ends, 4 × 4, N positive in tension;
/// w the cubic with these end values.
pub fn bar(length: f64, axial_force: f64) -> SMatrix<f64, 4, 4> {
    let l = length;
    #[rustfmt::skip]
    let k = SMatrix::<f64, 4, 4>::from_row_slice(&[
        36.0,     3.0 * l,      -36.0,    3.0 * l,
        3.0 * l,  4.0 * l * l,  -3.0 * l, -l * l,
        -36.0,    -3.0 * l,     36.0,     -3.0 * l,
        3.0 * l,  -l * l,       -3.0 * l, 4.0 * l * l,
    ]);
    k * (axial_force / (30.0 * l))
}
