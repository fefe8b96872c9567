//! What is left out with the eigenvectors beyond the region: a bound that does not add up over them.
//!
//! Of E the eigenvalues λ_k of a set F contribute Q_ZB X_F D_F Z_F Q_BZ, D_F = diag(1/(s − λ_k)), at most the product of the norms of
//! Q_ZB X_F |D_F|^½ and |D_F|^½ Z_F Q_BZ. Far from the contour these change slowly: a few discs cover it. The norms are those of small
//! matrices, ‖P‖² = λ_max(PᴴP) ≤ ‖(PᴴP)¹⁶‖^(1/16) of Frobenius.

use super::reach::{Reach, SpectrumWeights};
use crate::linalg::c64;
use crate::linalg::dense::product;
use faer::Mat;

/// Of more eigenvalues the norms cost too much.
const MOST: usize = 400;
/// Squarings of a matrix for its largest eigenvalue.
const SQUARINGS: i32 = 4;

/// The eigenvalues of a set, with the products pᵢᴴpⱼ of Q_ZB X_F = p₀ + s p₁ + s² p₂, and those of Q_ZBᵀ with Z_F.
#[derive(Debug)]
pub(super) struct Far {
    /// Their places among all.
    members: Vec<usize>,
    values: Vec<c64>,
    sides: [FarSide; 2],
}

#[derive(Debug)]
struct FarSide {
    products: [[Mat<c64>; 3]; 3],
    reaches: Vec<Reach>,
}

/// A disc in which the bound holds.
#[derive(Debug, Clone, Copy)]
pub(super) struct FarDisc {
    pub(super) centre: c64,
    pub(super) radius: f64,
    pub(super) bound: f64,
}

impl Far {
    /// The eigenvalues further than `reach` from zero, none where they are too many, given p₀, p₁ and p₂ of all on either side.
    pub(super) fn new(
        values: &[c64],
        reach: f64,
        powers: [[Mat<c64>; 3]; 2],
        reaches: &[Vec<Reach>; 2],
    ) -> Self {
        let mut members: Vec<usize> = (0..values.len()).filter(|k| values[*k].norm() > reach).collect();
        if members.len() > MOST {
            members.clear();
        }
        let side = |side: usize| {
            let chosen = |power: &Mat<c64>| {
                let mut chosen = Mat::zeros(power.nrows(), members.len());
                members.iter().enumerate().for_each(|(j, k)| chosen.col_mut(j).copy_from(power.col(*k)));
                chosen
            };
            let chosen = powers[side].each_ref().map(chosen);
            let between = |i: usize, j: usize| {
                let a = &chosen[i];
                let adjoint = Mat::from_fn(a.ncols(), a.nrows(), |k, l| a[(l, k)].conj());
                product(adjoint.as_ref(), chosen[j].as_ref())
            };
            FarSide {
                products: [0, 1, 2].map(|i| [0, 1, 2].map(|j| between(i, j))),
                reaches: members.iter().map(|k| reaches[side][*k]).collect(),
            }
        };
        let sides = [side(0), side(1)];
        Far { values: members.iter().map(|k| values[*k]).collect(), members, sides }
    }

    /// Whether the eigenvalue at a place among all is one of these.
    pub(super) fn holds(&self, place: usize) -> bool {
        self.members.binary_search(&place).is_ok()
    }

    /// A bound on their part of ‖E‖ in the disc of the radius `ratio` times the distance of the nearest of them from `start`, which
    /// begins a shade before that and lies in a `direction`.
    pub(super) fn disc(&self, start: c64, direction: c64, ratio: f64) -> FarDisc {
        let nearest = self.values.iter().fold(f64::INFINITY, |d, value| d.min((start - value).norm()));
        if self.values.is_empty() {
            return FarDisc { centre: start, radius: f64::INFINITY, bound: 0.0 };
        }
        let radius = ratio * nearest;
        let centre = start + direction * (0.998 * radius);
        FarDisc { centre, radius, bound: self.bound(centre, radius) }
    }

    /// A bound on their part of ‖E‖ in the disc of radius `h` about `c`.
    pub(super) fn bound(&self, c: c64, h: f64) -> f64 {
        let d: Vec<f64> = self.values.iter().map(|value| 1.0 / ((c - value).norm() - h).max(0.0)).collect();
        let [value, slope, curvature] = SpectrumWeights::at(c);
        let of = |side: &FarSide| {
            let norm = |weights: &SpectrumWeights| side.norm(weights, &d);
            norm(&value) + h * (norm(&slope) + h * norm(&curvature))
        };
        of(&self.sides[0]) * of(&self.sides[1])
    }
}

impl FarSide {
    /// ‖(Σ wᵢ pᵢ) |D|^½‖, not less in spite of rounding.
    fn norm(&self, weights: &SpectrumWeights, d: &[f64]) -> f64 {
        let factors = &weights.0;
        let mut square = Mat::<c64>::zeros(d.len(), d.len());
        for (i, products) in self.products.iter().enumerate() {
            for (j, product) in products.iter().enumerate() {
                let factor = factors[i].conj() * factors[j];
                if factor.norm() > 0.0 {
                    square += product * faer::Scale(factor);
                }
            }
        }
        let rounding: f64 = self.reaches.iter().zip(d).map(|(reach, d)| reach.rounding(weights) * d).sum();
        let square = Mat::from_fn(d.len(), d.len(), |i, j| square[(i, j)] * (d[i] * d[j]).sqrt());
        (largest_eigenvalue(square) + rounding).sqrt()
    }
}

/// A bound on the largest eigenvalue of a positive semidefinite matrix.
fn largest_eigenvalue(mut a: Mat<c64>) -> f64 {
    let mut logarithm = 0.0;
    for squaring in 0..=SQUARINGS {
        let size = a.norm_l2();
        if !(size > 0.0 && size.is_finite()) {
            return size;
        }
        logarithm += size.ln() * 0.5f64.powi(squaring);
        a *= faer::Scale(c64::new(1.0 / size, 0.0));
        if squaring < SQUARINGS {
            a = product(a.as_ref(), a.as_ref());
        }
    }
    logarithm.exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::linalg::random::Random;

    #[test]
    fn the_largest_eigenvalue_is_bounded_closely() {
        let mut random = Random::new();
        for n in [1, 7, 60] {
            let root = Mat::from_fn(n, n, |_, _| c64::new(random.next(), random.next()));
            let adjoint = Mat::from_fn(n, n, |i, j| root[(j, i)].conj());
            let a = product(adjoint.as_ref(), root.as_ref());
            let exact = root.svd().unwrap().S().column_vector()[0].re.powi(2);
            let ratio = largest_eigenvalue(a) / exact;
            let most = (n as f64).powf(1.0 / 32.0);
            assert!(ratio > 1.0 - 1e-12 && within(ratio, most * (1.0 + 1e-12), Stated), "{n}: {ratio}");
        }
        assert_eq!(largest_eigenvalue(Mat::zeros(3, 3)), 0.0);
    }
}
