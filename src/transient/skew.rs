//! Forces of sparse skew parts: N of the stiffness, circulatory, and G of the damping, gyroscopic.

use super::rows::sums;
use crate::linalg::sparse::multiply;
use crate::system::Skew;
use faer::Mat;
use std::ops::Range;

/// What the skew parts exert on the structure \[N, N m\].
#[derive(Debug, Clone)]
pub(super) struct SkewForces {
    /// −N u, −N v, −N a.
    circulatory: Mat<f64>,
    /// −G v, −G a.
    gyroscopic: Mat<f64>,
}

/// The work of the skew parts in a step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SkewWork {
    /// −Δuᵀ N ū.
    pub(super) circulatory: f64,
    /// −Δuᵀ G v̄: with Δu = Δt v̄ + Δt²(β−½γ)Δa it is −Δt²(β−½γ) ΔaᵀG v̄, of the scheme alone.
    pub(super) gyroscopic: f64,
    /// −Δuᵀ(N Δu + G Δv).
    pub(super) change: f64,
}

impl SkewForces {
    pub(super) fn new(n: usize) -> Self {
        SkewForces { circulatory: Mat::zeros(n, 3), gyroscopic: Mat::zeros(n, 2) }
    }

    /// Of u, v and a, the columns of `motion`.
    pub(super) fn derive(&mut self, skew: &Skew, motion: &Mat<f64>) {
        // A product with a matrix stored by columns is that with its transpose: the sign of a force.
        multiply(&skew.stiffness, motion.as_ref(), self.circulatory.as_mut());
        multiply(&skew.damping, motion.as_ref().subcols(1, 2), self.gyroscopic.as_mut());
    }

    /// h += forces at the displacement and the velocity that `spring` and `dashpot` are factors of, by u, v and a.
    pub(super) fn add_to(&self, spring: [f64; 3], dashpot: [f64; 2], rows: Range<usize>, h: &mut [f64]) {
        let [u, v, a] = [0, 1, 2].map(|k| &self.circulatory.col_as_slice(k)[rows.clone()]);
        let [by_v, by_a] = [0, 1].map(|k| &self.gyroscopic.col_as_slice(k)[rows.clone()]);
        for i in 0..h.len() {
            h[i] += spring[0] * u[i]
                + spring[1] * v[i]
                + spring[2] * a[i]
                + dashpot[0] * by_v[i]
                + dashpot[1] * by_a[i];
        }
    }

    /// The work from the forces at the beginning of a step, at the displacement `u0`, to those at its end.
    pub(super) fn work(&self, to: &SkewForces, [u0, u1]: [&[f64]; 2]) -> SkewWork {
        let [n0, n1] = [self, to].map(|of| of.circulatory.col_as_slice(0));
        let [g0, g1] = [self, to].map(|of| of.gyroscopic.col_as_slice(0));
        let [circulatory, gyroscopic, change] = sums(u0.len(), |rows| {
            let mut sums = [0.0; 3];
            for i in rows {
                let moved = u1[i] - u0[i];
                sums[0] += 0.5 * moved * (n1[i] + n0[i]);
                sums[1] += 0.5 * moved * (g1[i] + g0[i]);
                sums[2] += moved * (n1[i] - n0[i] + (g1[i] - g0[i]));
            }
            sums
        });
        SkewWork { circulatory, gyroscopic, change }
    }
}
