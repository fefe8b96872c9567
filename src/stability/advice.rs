//! Where a little mass, a spring or a damper would calm a mode: the sensitivities to such a thing at any place.
//!
//! A thing that acts on one displacement dᵀu, mounted on the structure as it slides steadily (a spring comes without
//! tension), leaves the steady state alone. It adds m d dᵀ to M, k d dᵀ to K or c d dᵀ to C, so that with a = (dᵀψ)* dᵀφ
//!
//! dλ/dm = −λ² a / ψᴴQ′φ,   dλ/dk = −a / ψᴴQ′φ,   dλ/dc = −λ a / ψᴴQ′φ,
//!
//! and, where there is modal damping, λ ψᴴ(∂C)φ besides: mass and springs move the real modes that C is made of.

use super::sensitivity::Sensitivity;
use crate::linalg::{SparseVector, c64};

/// dλ per unit of a thing that acts on one displacement dᵀu.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointRates {
    /// Per mass \[1/(s kg)\]; a point mass acts on three displacements, whose rates add up.
    pub by_mass: c64,
    /// Per stiffness of a spring to the ground \[1/s per N/m\].
    pub by_stiffness: c64,
    /// Per constant of a damper to the ground \[1/s per N s/m\].
    pub by_damping: c64,
}

impl Sensitivity<'_> {
    /// The rates for every mode and every displacement dᵀu of `rows`: \[mode\]\[row\].
    pub fn at(&self, rows: &[SparseVector]) -> Vec<Vec<PointRates>> {
        let modal = self.modal.as_ref().map(|modal| modal.of_rows(rows));
        (0..self.lambda.len())
            .map(|j| {
                let (s, slope) = (self.lambda[j], self.steepness[j]);
                let rate = |(r, row): (usize, &SparseVector)| {
                    let a = self.psi.along(j, row).conj() * self.phi.along(j, row);
                    let zero = c64::new(0.0, 0.0);
                    let [by_k, by_m] = modal.as_ref().map_or([zero; 2], |modal| modal[j][r]);
                    PointRates {
                        by_mass: -(s * s * a + s * by_m) / slope,
                        by_stiffness: -(a + s * by_k) / slope,
                        by_damping: -s * a / slope,
                    }
                };
                rows.iter().enumerate().map(rate).collect()
            })
            .collect()
    }
}
