//! Sizes of vectors that are polynomials in s.

use crate::linalg::c64;
use faer::Mat;

/// The size of a vector p₀ + s p₁ + s² p₂, by the products pᵢᴴpⱼ.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    /// pᵢᴴpⱼ.
    products: [[c64; 3]; 3],
    /// ‖pᵢ‖.
    sizes: [f64; 3],
}

/// Factors of p₀, p₁ and p₂, and their magnitudes.
pub(super) struct SpectrumWeights(pub(super) [c64; 3], [f64; 3]);

impl SpectrumWeights {
    fn new(weights: [c64; 3]) -> Self {
        SpectrumWeights(weights, weights.map(|w| w.norm()))
    }

    /// Those of the value at `c`, the slope there, and the curvature.
    pub(super) fn at(c: c64) -> [Self; 3] {
        let (zero, one) = (c64::new(0.0, 0.0), c64::new(1.0, 0.0));
        [[one, c, c * c], [zero, one, c * 2.0], [zero, zero, one]].map(SpectrumWeights::new)
    }
}

impl Reach {
    /// Of the columns `k` of p₀, p₁ and p₂.
    pub(super) fn of(powers: &[Mat<c64>; 3], k: usize) -> Self {
        let dot = |i: usize, j: usize| -> c64 {
            let (a, b) = (powers[i].col_as_slice(k), powers[j].col_as_slice(k));
            a.iter().zip(b).map(|(a, b)| a.conj() * b).sum()
        };
        let products = [0, 1, 2].map(|i| [0, 1, 2].map(|j| dot(i, j)));
        Reach { products, sizes: [0, 1, 2].map(|i| products[i][i].re.sqrt()) }
    }

    /// ‖Σ wᵢ pᵢ‖, not less in spite of rounding.
    fn size(&self, of: &SpectrumWeights) -> f64 {
        let SpectrumWeights(weights, magnitudes) = of;
        let mut square = 0.0;
        for i in 0..3 {
            let term = magnitudes[i] * self.sizes[i];
            square += term * term;
            for j in 0..i {
                square += 2.0 * (weights[i].conj() * self.products[i][j] * weights[j]).re;
            }
        }
        (square.max(0.0) + self.rounding(of)).sqrt()
    }

    /// What rounding may make of the square of the size.
    pub(super) fn rounding(&self, SpectrumWeights(_, magnitudes): &SpectrumWeights) -> f64 {
        let terms: f64 = (0..3).map(|i| magnitudes[i] * self.sizes[i]).sum();
        8.0 * f64::EPSILON * terms * terms
    }

    /// A bound on the size within `h` of a point, whose weights are given.
    pub(super) fn within(&self, [value, slope, curvature]: &[SpectrumWeights; 3], h: f64) -> f64 {
        self.size(value) + h * (self.size(slope) + h * self.size(curvature))
    }
}
