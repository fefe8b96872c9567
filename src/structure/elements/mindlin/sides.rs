//! Shear strain and bulge of the rotation on the sides of an element.

use crate::structure::Shell;
use crate::structure::elements::dkt::bending_rigidity;
use nalgebra::{Matrix3, RowSVector, SMatrix};

/// The section of a plate of thickness h.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateSection {
    /// Moments from curvatures \[N m\].
    pub rigidity: Matrix3<f64>,
    /// κ_s G h, shear force from shear strain \[N/m\].
    pub shear: f64,
}

impl PlateSection {
    /// The section of `plate`.
    pub fn new(plate: &Shell) -> Self {
        let material = &plate.material;
        PlateSection {
            rigidity: bending_rigidity(material.youngs_modulus, material.poissons_ratio, plate.thickness),
            shear: plate.shear_coefficient() * material.shear_modulus() * plate.thickness,
        }
    }
}

/// A side i → j of length l along t; rows on (w, θ₁, θ₂) of the C/3 corners.
///
/// Along the side β_s is quadratic, linear between its ends plus Δ 4s(1−s), and β across it is linear. With the mean shear
/// strain d = (w_j − w_i)/l + ½(β_si + β_sj) of the linear fields, two conditions give Δ and the constant shear strain γ̄:
///
/// * the mean of w,_s + β_s is γ̄: d + ⅔ Δ = γ̄;
/// * the shear force balances the moment, κ_s G h γ̄ = D β_s,ss = −8 D Δ/l².
///
/// Hence Δ = −3/2 d/(1+φ) and γ̄ = φ/(1+φ) d with φ = 12 D/(κ_s G h l²): φ → 0 is Kirchhoff's side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Side<const C: usize> {
    /// i and j.
    pub ends: [usize; 2],
    /// l \[m\].
    pub length: f64,
    /// t.
    pub tangent: [f64; 2],
    /// Δ.
    pub bulge: RowSVector<f64, C>,
    /// γ̄.
    pub shear: RowSVector<f64, C>,
}

/// The sides of an element from each corner to the next; C = 3 N.
pub fn sides<const N: usize, const C: usize>(
    corners: &[[f64; 2]; N],
    section: &PlateSection,
) -> [Side<C>; N] {
    std::array::from_fn(|i| {
        let j = (i + 1) % N;
        let (dx, dy) = (corners[j][0] - corners[i][0], corners[j][1] - corners[i][1]);
        let length = dx.hypot(dy);
        let tangent = [dx / length, dy / length];
        let mut mean = RowSVector::<f64, C>::zeros();
        for (node, sign) in [(i, -1.0), (j, 1.0)] {
            mean[3 * node] = sign / length;
            // β_s = t_x θ₂ − t_y θ₁.
            mean[3 * node + 1] = -0.5 * tangent[1];
            mean[3 * node + 2] = 0.5 * tangent[0];
        }
        let phi = 12.0 * section.rigidity[(0, 0)] / (section.shear * length * length);
        Side {
            ends: [i, j],
            length,
            tangent,
            bulge: mean * (-1.5 / (1.0 + phi)),
            shear: mean * (phi / (1.0 + phi)),
        }
    })
}

/// (γ_x, γ_y) at each corner: the vector whose components along the two sides that meet there are their γ̄.
pub fn corner_shear<const N: usize, const C: usize>(sides: &[Side<C>; N]) -> [[RowSVector<f64, C>; 2]; N] {
    std::array::from_fn(|i| {
        let (a, b) = (&sides[i], &sides[(i + N - 1) % N]);
        let ([ax, ay], [bx, by]) = (a.tangent, b.tangent);
        let det = ax * by - ay * bx;
        [(a.shear * by - b.shear * ay) / det, (b.shear * ax - a.shear * bx) / det]
    })
}

/// (w, ∂w/∂y, −∂w/∂x) at the corners from (w, θ₁, θ₂) there, ∇w = γ − β.
///
/// The cubic w with these values and slopes at the ends of a side is the one whose shear strain w,_s + β_s is γ̄ all along it.
pub fn slopes<const N: usize, const C: usize>(shear: &[[RowSVector<f64, C>; 2]; N]) -> SMatrix<f64, C, C> {
    let mut map = SMatrix::<f64, C, C>::identity();
    for (i, [x, y]) in shear.iter().enumerate() {
        let mut first = map.row_mut(3 * i + 1);
        first += y;
        let mut second = map.row_mut(3 * i + 2);
        second -= x;
    }
    map
}
