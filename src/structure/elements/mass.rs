//! Consistent masses of a triangle of surface density ρh.

use super::bciz::{QUADRATIC_GRAM, deflection_products, slope_products};
use super::opt::mean_rotation;
use super::symmetrized;
use super::triangle::{SIDES, twice_area};
use nalgebra::SMatrix;

/// M on (w, θ₁, θ₂) at the corners, 9 × 9: ρh ∫ w² dA, and with `rotary_inertia` also ρh³/12 ∫ |∇w|² dA, w the
/// cubic of [`super::bciz`].
pub fn bending(
    corners: &[[f64; 2]; 3],
    density: f64,
    thickness: f64,
    rotary_inertia: bool,
) -> SMatrix<f64, 9, 9> {
    let mass = density * thickness * twice_area(corners) / 2.0;
    let mut m = deflection_products(corners) * mass;
    if rotary_inertia {
        let [xx, yy, _] = slope_products(corners);
        m += (xx + yy) * (mass * thickness * thickness / 12.0);
    }
    symmetrized(m)
}

/// M on (u, v, θ) at the corners, 9 × 9: ρh ∫ (u² + v²) dA.
///
/// The displacement is Allman's: along a side of length l its part across the side is quadratic, its middle bulging
/// by l(θ_i − θ_j)/8, so that the drilling rotations carry mass. Rotations equal at all three corners while the
/// corners stand still would carry none; the micro-rotation ρh³/12 (θ̄ − θ₀)² gives them theirs. It vanishes for
/// rigid motions and for linear displacements, and makes M positive definite.
pub fn membrane(corners: &[[f64; 2]; 3], density: f64, thickness: f64) -> SMatrix<f64, 9, 9> {
    let mass = density * thickness * twice_area(corners) / 2.0;
    // Bernstein coefficients (degree 2) of u and v: corners, then sides.
    let mut field = [SMatrix::<f64, 6, 9>::zeros(); 2];
    for (s, [i, j]) in SIDES.into_iter().enumerate() {
        let across = [-(corners[j][1] - corners[i][1]), corners[j][0] - corners[i][0]];
        for (component, coefficients) in field.iter_mut().enumerate() {
            coefficients[(s, 3 * s + component)] = 1.0;
            coefficients[(3 + s, 3 * i + component)] = 0.5;
            coefficients[(3 + s, 3 * j + component)] = 0.5;
            coefficients[(3 + s, 3 * i + 2)] = across[component] / 4.0;
            coefficients[(3 + s, 3 * j + 2)] = -across[component] / 4.0;
        }
    }
    let mut m = field
        .iter()
        .fold(SMatrix::<f64, 9, 9>::zeros(), |sum, n| sum + n.transpose() * *QUADRATIC_GRAM * n * mass);
    let mut twist = -mean_rotation(corners);
    for i in 0..3 {
        twist[3 * i + 2] = 1.0 / 3.0;
    }
    m += twist.transpose() * twist * (mass * thickness * thickness / 12.0);
    symmetrized(m)
}
