//! Membrane stiffness with drilling rotations: the optimal triangle.
//!
//! Felippa, "A study of optimal membrane triangles with drilling freedoms", CMAME 192 (2003) 2125: the member of the
//! template K = L C Lᵀ / V + ¾ β₀ T_θuᵀ K_θ T_θu that is exact in pure in-plane bending of a rectangle of any aspect
//! ratio: α_b = 3/2, β₀ = max(½(1−4ν²), 0.01), β₁…β₉ = 1, 2, 1, 0, 1, −1, −1, −1, −2.
//!
//! The basic part acts on the mean strain Lᵀu/V; the higher-order part on the hierarchical rotations
//! θ̃_i = θ_i − θ₀, θ₀ = ½(∂v/∂x − ∂u/∂y) of the linear displacement.

use super::symmetrized;
use super::triangle::{SIDES, gradients, twice_area};
use nalgebra::{Matrix3, RowSVector, SMatrix};

const ALPHA: f64 = 1.5;
/// β₁…β₉ as the rows of Q₁.
const BETA: [[f64; 3]; 3] = [[1.0, 2.0, 1.0], [0.0, 1.0, -1.0], [-1.0, -1.0, -2.0]];

/// Mean strains (ε_x, ε_y, γ_xy) from (u, v, θ) at the corners: Lᵀ/V, 3 × 9 \[1/m, drilling: 1\].
pub fn mean_strain(corners: &[[f64; 2]; 3]) -> SMatrix<f64, 3, 9> {
    let area = twice_area(corners) / 2.0;
    let grad = gradients(corners);
    let mut b = SMatrix::zeros();
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let [gx, gy] = grad[i];
        b[(0, 3 * i)] = gx;
        b[(1, 3 * i + 1)] = gy;
        b[(2, 3 * i)] = gy;
        b[(2, 3 * i + 1)] = gx;
        // A rotation at corner i moves the middles of its two sides, (k, i) and (i, j), across themselves by ±l/8.
        let [xij, yij] = difference(corners, i, j);
        let [xki, yki] = difference(corners, k, i);
        let f = ALPHA / (12.0 * area);
        b[(0, 3 * i + 2)] = f * (yki * yki - yij * yij);
        b[(1, 3 * i + 2)] = f * (xki * xki - xij * xij);
        b[(2, 3 * i + 2)] = 2.0 * f * (xij * yij - xki * yki);
    }
    b
}

/// θ₀ = ½(∂v/∂x − ∂u/∂y), the rotation of the linear displacement, from (u, v, θ) at the corners.
pub fn mean_rotation(corners: &[[f64; 2]; 3]) -> RowSVector<f64, 9> {
    let grad = gradients(corners);
    RowSVector::from_fn(|_, k| match k % 3 {
        0 => -0.5 * grad[k / 3][1],
        1 => 0.5 * grad[k / 3][0],
        _ => 0.0,
    })
}

/// K on (u, v, θ) at the corners, 9 × 9 \[N/m, N, N m\]; `elasticity` relates plane stresses to strains \[Pa\].
pub fn stiffness(
    corners: &[[f64; 2]; 3],
    elasticity: &Matrix3<f64>,
    poissons_ratio: f64,
    thickness: f64,
) -> SMatrix<f64, 9, 9> {
    let area = twice_area(corners) / 2.0;
    let volume = area * thickness;
    let mean = mean_strain(corners);
    let basic = mean.transpose() * elasticity * mean * volume;

    let rotation = mean_rotation(corners);
    let hierarchical =
        SMatrix::<f64, 3, 9>::from_fn(|i, k| f64::from(u8::from(k == 3 * i + 2)) - rotation[k]);

    // Strains along the sides ↔ Cartesian strains.
    let mut along_sides = Matrix3::zeros();
    let mut length_squared = [0.0; 3];
    for (s, [i, j]) in SIDES.into_iter().enumerate() {
        let [dx, dy] = difference(corners, j, i);
        length_squared[s] = dx * dx + dy * dy;
        let (cc, ss, cs) = (dx * dx, dy * dy, dx * dy);
        along_sides.set_row(s, &(nalgebra::RowVector3::new(cc, ss, cs) / length_squared[s]));
    }
    let cartesian = along_sides.try_inverse().unwrap_or_else(Matrix3::zeros);
    let natural = cartesian.transpose() * elasticity * cartesian;

    // Q_c gives the side strains at corner c; a cyclic renumbering turns Q₁ into Q₂ and Q₃.
    let q = [0, 1, 2].map(|c: usize| {
        Matrix3::from_fn(|s, i| 2.0 * area / 3.0 * BETA[(s + 3 - c) % 3][(i + 3 - c) % 3] / length_squared[s])
    });
    let at_rotations = SIDES
        .map(|[i, j]| (q[i] + q[j]) * 0.5)
        .iter()
        .fold(Matrix3::zeros(), |sum, m| sum + m.transpose() * natural * m);
    let beta0 = (0.5 * (1.0 - 4.0 * poissons_ratio * poissons_ratio)).max(0.01);
    let higher = hierarchical.transpose() * at_rotations * hierarchical * (0.75 * beta0 * volume);
    symmetrized(basic + higher)
}

/// x_ij = x_i − x_j and y_ij.
fn difference(c: &[[f64; 2]; 3], i: usize, j: usize) -> [f64; 2] {
    [c[i][0] - c[j][0], c[i][1] - c[j][1]]
}
