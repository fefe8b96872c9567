//! Eigenvalues of λ² M + λ C + K with twice the digits: references of the tests.
//!
//! The QR algorithm leaves each eigenvalue of the companion matrix A with an error of some ε ‖A‖ times its condition number,
//! ‖A‖ being about ‖M⁻¹K‖, far above |λ|. Newton's method with residuals of 32 digits takes that back; what is left is the
//! rounding of the entries of the matrices, ε ‖K‖ κ / |λ|.

use super::tests::{dense_matrices, dense_without_contact};
use crate::equilibrium::{ContactBlock, SteadySliding, directions, linearize};
use crate::linalg::c64;
use crate::system::System;
use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, cx128, fx128};

/// M, C + C_c and K + K_σ + iH + K_c of a system at steady sliding.
pub(super) struct ExactProblem {
    mass: Mat<c64>,
    damping: Mat<c64>,
    stiffness: Mat<c64>,
}

impl ExactProblem {
    pub(super) fn new(system: &System, steady: &SteadySliding) -> Self {
        let (stiffness, damping) = dense_matrices(system, steady);
        ExactProblem { mass: complex(&system.structure.mass.to_dense()), damping, stiffness }
    }

    /// The same problem with the forces of the contact stiffness as further unknowns, so that it is as well conditioned as the
    /// structure however stiff the contacts are: with s_b = κ_b u_bᵀφ and κ_b the largest |k_ab| of a direction u_b,
    /// Σ u_a k_ab u_bᵀ φ = Σ u_a (k_ab / κ_b) s_b and u_bᵀφ − s_b / κ_b = 0.
    pub(super) fn with_contact_forces(system: &System, steady: &SteadySliding) -> Self {
        let points: Vec<_> = system.points().map(|(_, point)| point).collect();
        let blocks = linearize(system, steady).blocks;
        let forces = || blocks.iter().flat_map(|block| (0..3).map(move |b| (block, b)));
        let largest =
            |block: &ContactBlock, b: usize| block.stiffness.iter().fold(0.0, |m: f64, k| m.max(k[b].abs()));
        let forces: Vec<_> = forces().filter(|(block, b)| largest(block, *b) > 0.0).collect();
        let (n, size) = (system.n_dofs(), system.n_dofs() + forces.len());
        let ((k, _), (_, c)) = (dense_without_contact(system), dense_matrices(system, steady));
        let padded = |a: &Mat<c64>| {
            let mut padded = Mat::<c64>::zeros(size, size);
            padded.submatrix_mut(0, 0, n, n).copy_from(a);
            padded
        };
        let (mut stiffness, damping) = (padded(&k), padded(&c));
        let mass = padded(&complex(&system.structure.mass.to_dense()));
        for (row, (block, b)) in (n..).zip(forces) {
            let (u, kappa) = (directions(points[block.point]), largest(block, b));
            stiffness[(row, row)] = c64::new(-1.0 / kappa, 0.0);
            u[b].iter().for_each(|(j, x)| stiffness[(row, j)] += x);
            for (a, u) in u.iter().enumerate() {
                u.iter().for_each(|(i, x)| stiffness[(i, row)] += x * block.stiffness[a][b] / kappa);
            }
        }
        ExactProblem { mass, damping, stiffness }
    }

    /// The simple eigenvalue that Newton's method reaches from `start`, an eigenvalue to a few digits.
    ///
    /// Unknowns are φ and λ with wᴴφ = 1. The matrix \[Q Q′φ; wᴴ 0\] is that of the start throughout, so that each of the steps
    /// gains as many digits as the start has.
    pub(super) fn eigenvalue(&self, start: c64) -> c64 {
        let n = self.mass.nrows();
        let q = |z: c64| &self.stiffness + faer::Scale(z) * (&self.damping + faer::Scale(z) * &self.mass);
        let slope = &self.damping + faer::Scale(start * 2.0) * &self.mass;
        let mut phi = Mat::from_fn(n, 1, |i, _| c64::new(1.0, (i as f64).sin()));
        // Beside an eigenvalue that is exact already, where there is no pivot of zero.
        let factors = q(start * (1.0 + 1e-7)).partial_piv_lu();
        for _ in 0..3 {
            phi = factors.solve(&phi);
            phi = &phi * faer::Scale(c64::new(1.0 / phi.norm_l2(), 0.0));
        }
        let w = phi.adjoint().to_owned();
        let (q, column) = (q(start), &slope * &phi);
        let bordered = Mat::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
            (true, true) => q[(i, j)],
            (true, false) => column[(i, 0)],
            (false, true) => w[(0, j)],
            (false, false) => c64::new(0.0, 0.0),
        });
        let bordered: PartialPivLu<c64> = bordered.partial_piv_lu();
        let mut phi: Vec<cx128> = (0..n).map(|i| wide(phi[(i, 0)])).collect();
        let mut lambda = wide(start);
        for _ in 0..STEPS {
            let residual = self.residual(lambda, &phi);
            let step = bordered.solve(Mat::from_fn(n + 1, 1, |i, _| match i < n {
                true => residual[i],
                false => c64::new(0.0, 0.0),
            }));
            phi.iter_mut().enumerate().for_each(|(i, phi)| *phi -= wide(step[(i, 0)]));
            lambda -= wide(step[(n, 0)]);
        }
        c64::new(lambda.re.0, lambda.im.0)
    }

    /// Q(λ)φ, summed with 32 digits.
    fn residual(&self, lambda: cx128, phi: &[cx128]) -> Vec<c64> {
        let row = |i: usize| {
            let mut sums = [wide(c64::new(0.0, 0.0)); 3];
            for (sum, a) in sums.iter_mut().zip([&self.stiffness, &self.damping, &self.mass]) {
                for (j, phi) in phi.iter().enumerate().filter(|(j, _)| a[(i, *j)] != c64::new(0.0, 0.0)) {
                    *sum += wide(a[(i, j)]) * phi;
                }
            }
            let [k, c, m] = sums;
            let sum = k + lambda * (c + lambda * m);
            c64::new(sum.re.0, sum.im.0)
        };
        (0..phi.len()).map(row).collect()
    }
}

/// Steps of Newton's method: from three digits to all, with a few to spare.
const STEPS: usize = 8;

fn complex(a: &Mat<f64>) -> Mat<c64> {
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| c64::new(a[(i, j)], 0.0))
}

fn wide(z: c64) -> cx128 {
    cx128::new(fx128::from(z.re), fx128::from(z.im))
}

#[cfg(test)]
mod tests {
    use super::super::complex_modes;
    use super::super::tests::{damped, dense_modes, steady};
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::contact::{Coulomb, NormalLaw, SlidingLaw};
    use crate::equilibrium::samples::random_system;
    use crate::system::Closing;
    use faer::mat;
    use std::sync::Arc;

    /// Two masses on springs 1 and dampers 1/4 to the ground, a spring of 2⁴⁰ between them: λ² + λ/4 + 1 = 0 of their common
    /// motion, with all digits, where the norm of the matrix takes twelve of them from the QR algorithm.
    #[test]
    fn an_eigenvalue_far_below_the_norm_of_the_matrices_has_all_its_digits() {
        let [one, tie] = [1.0, 2.0f64.powi(40)].map(|x| c64::new(x, 0.0));
        let diagonal = |x: c64| mat![[x, x * 0.0], [x * 0.0, x]];
        let stiffness = mat![[one + tie, -tie], [-tie, one + tie]];
        let problem = ExactProblem { mass: diagonal(one), damping: diagonal(one * 0.25), stiffness };
        let exact = c64::new(-0.125, f64::sqrt(1.0 - 0.125 * 0.125));
        let found = problem.eigenvalue(exact * 1.001);
        assert!(within((found - exact).norm(), 4.0 * f64::EPSILON, RoundOff), "{found}");
    }

    /// Contacts up to 1e18 N/m, whose forces come from the last digits of motions: the stated errors of all modes hold within a
    /// factor of two, and are not some thousand times too large as a rule. The reference has the contact forces as unknowns.
    #[test]
    fn stated_errors_hold_however_stiff_the_contacts_are() {
        for stiffness in [1e4, 1e7, 1e10, 1e13, 1e16, 1e18] {
            let (mut slack, mut compared) = (0.0, 0);
            for (kind, seed) in [(0, 4), (3, 5), (5, 6), (7, 7)] {
                let mut system = damped(random_system(60, 4, 8.0, seed), kind);
                let law = SlidingLaw::new(NormalLaw::linear(stiffness), Coulomb { mu0: 0.3 }, 0.0);
                (system.pairs[0].law, system.pairs[0].closing) = (Arc::new(law), Closing::Load(8.0));
                let (state, real) = (steady(&system), dense_modes(&system, 30));
                let band = [0.01, real.frequency_hz(12)];
                let found = complex_modes(&system, &state, &real, band, &()).unwrap();
                let exact = ExactProblem::with_contact_forces(&system, &state);
                for mode in found.modes.iter().filter(|mode| mode.eigenvalue_error < 1e-3) {
                    let z = exact.eigenvalue(mode.eigenvalue);
                    let error = (z - mode.eigenvalue).norm() / z.norm();
                    assert!(
                        within(error, 2.0 * mode.eigenvalue_error, Stated),
                        "{stiffness:e}, kind {kind}: {z}, found {} with {error:.1e}, stated {:.1e}",
                        mode.eigenvalue,
                        mode.eigenvalue_error
                    );
                    slack += (mode.eigenvalue_error / error.max(f64::EPSILON)).log10();
                    compared += 1;
                }
            }
            // Of stiffer contacts few modes have a digit left.
            assert!(stiffness > 1e14 || compared > 20, "{stiffness:e}: {compared}");
            let mean = slack / f64::from(compared.max(1));
            assert!(stiffness > 1e14 || mean < 3.5, "{stiffness:e}: {mean:.1}");
        }
    }
}
