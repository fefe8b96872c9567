//! The cubic deflection of a bending triangle, for mass, geometric stiffness and interpolation.
//!
//! Bazeley, Cheung, Irons & Zienkiewicz (1965): w over the triangle is the cubic whose values and slopes at the
//! corners are given; its tenth coefficient is chosen so that every quadratic w is met exactly. In Bernstein form
//! w = Σ b_α B_α, B_α = 3!/α! L^α, the coefficients are
//! b₃₀₀ = w₁, b₂₁₀ = w₁ + ⅓ ∇w₁·(x₂ − x₁), …, b₁₁₁ = ¼ Σ (the six on the sides) − ⅙ Σ (the three at the corners).
//! Products of Bernstein polynomials of degree n integrate in closed form:
//! ∫ B_α B_β dA = A Π C(α_i+β_i, α_i) / (C(2n, n) C(2n+2, 2)).

use super::triangle::gradients;
use nalgebra::{SMatrix, SVector};
use std::sync::LazyLock;

const CUBIC: [[usize; 3]; 10] = [
    [3, 0, 0],
    [0, 3, 0],
    [0, 0, 3],
    [2, 1, 0],
    [2, 0, 1],
    [1, 2, 0],
    [0, 2, 1],
    [1, 0, 2],
    [0, 1, 2],
    [1, 1, 1],
];
const QUADRATIC: [[usize; 3]; 6] = [[2, 0, 0], [0, 2, 0], [0, 0, 2], [1, 1, 0], [0, 1, 1], [1, 0, 1]];

/// ∫ B_α B_β dA / A of the cubics.
static CUBIC_GRAM: LazyLock<SMatrix<f64, 10, 10>> = LazyLock::new(|| gram(&CUBIC, 3));
/// ∫ B_α B_β dA / A of the quadratics, in the order (200), (020), (002), (110), (011), (101).
pub(super) static QUADRATIC_GRAM: LazyLock<SMatrix<f64, 6, 6>> = LazyLock::new(|| gram(&QUADRATIC, 2));

fn gram<const N: usize>(indices: &[[usize; 3]; N], degree: usize) -> SMatrix<f64, N, N> {
    let total = binomial(2 * degree, degree) * binomial(2 * degree + 2, 2);
    SMatrix::from_fn(|a, b| {
        (0..3).map(|i| binomial(indices[a][i] + indices[b][i], indices[a][i])).product::<f64>() / total
    })
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64)
}

/// Bernstein coefficients of w from (w, θ₁, θ₂) at the corners, 10 × 9; θ₁ = ∂w/∂y, θ₂ = −∂w/∂x.
pub fn coefficients(corners: &[[f64; 2]; 3]) -> SMatrix<f64, 10, 9> {
    let mut b = SMatrix::<f64, 10, 9>::zeros();
    for (row, alpha) in CUBIC.iter().enumerate().take(9) {
        let i = (0..3).find(|i| alpha[*i] >= 2).expect("one index of a boundary coefficient is 2 or 3");
        b[(row, 3 * i)] = 1.0;
        if let Some(j) = (0..3).find(|j| alpha[*j] == 1) {
            b[(row, 3 * i + 1)] = (corners[j][1] - corners[i][1]) / 3.0;
            b[(row, 3 * i + 2)] = -(corners[j][0] - corners[i][0]) / 3.0;
        }
    }
    let (on_corners, on_sides) = (b.fixed_rows::<3>(0).row_sum(), b.fixed_rows::<6>(3).row_sum());
    b.set_row(9, &(on_sides / 4.0 - on_corners / 6.0));
    b
}

/// Bernstein coefficients (degree 2) of ∂w/∂x and ∂w/∂y, each 6 × 9.
pub fn slope_coefficients(corners: &[[f64; 2]; 3]) -> [SMatrix<f64, 6, 9>; 2] {
    let b = coefficients(corners);
    let grad = gradients(corners);
    [0, 1].map(|direction| {
        let mut slope = SMatrix::<f64, 6, 9>::zeros();
        for (row, beta) in QUADRATIC.iter().enumerate() {
            for i in 0..3 {
                let mut alpha = *beta;
                alpha[i] += 1;
                let k = CUBIC.iter().position(|a| *a == alpha).expect("β + e_i is of degree three");
                let updated = slope.row(row) + b.row(k) * (3.0 * grad[i][direction]);
                slope.set_row(row, &updated);
            }
        }
        slope
    })
}

/// ∫ Nᵀ N dA / A of w on (w, θ₁, θ₂) at the corners, 9 × 9.
pub fn deflection_products(corners: &[[f64; 2]; 3]) -> SMatrix<f64, 9, 9> {
    let b = coefficients(corners);
    b.transpose() * *CUBIC_GRAM * b
}

/// ∫ w,a w,b dA / A for (a, b) = (x, x), (y, y) and the sum (x, y) + (y, x), each 9 × 9.
pub fn slope_products(corners: &[[f64; 2]; 3]) -> [SMatrix<f64, 9, 9>; 3] {
    let [sx, sy] = slope_coefficients(corners);
    let (gx, gy) = (*QUADRATIC_GRAM * sx, *QUADRATIC_GRAM * sy);
    let xy = sx.transpose() * gy;
    [sx.transpose() * gx, sy.transpose() * gy, xy + xy.transpose()]
}

/// (w, θ₁, θ₂) at barycentric coordinates `at` from (w, θ₁, θ₂) at the corners, 3 × 9.
pub fn interpolate(corners: &[[f64; 2]; 3], at: [f64; 3]) -> SMatrix<f64, 3, 9> {
    let cubic = SVector::<f64, 10>::from_fn(|k, _| bernstein(CUBIC[k], at));
    let quadratic = SVector::<f64, 6>::from_fn(|k, _| bernstein(QUADRATIC[k], at));
    let [sx, sy] = slope_coefficients(corners);
    let mut rows = SMatrix::<f64, 3, 9>::zeros();
    rows.set_row(0, &(cubic.transpose() * coefficients(corners)));
    rows.set_row(1, &(quadratic.transpose() * sy));
    rows.set_row(2, &(quadratic.transpose() * -sx));
    rows
}

/// n!/α! L^α.
fn bernstein(alpha: [usize; 3], at: [f64; 3]) -> f64 {
    let multinomial =
        binomial(alpha[0] + alpha[1] + alpha[2], alpha[0]) * binomial(alpha[1] + alpha[2], alpha[1]);
    (0..3).fold(multinomial, |value, i| value * at[i].powi(alpha[i] as i32))
}
