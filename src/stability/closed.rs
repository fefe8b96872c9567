//! Contact of many points as part of the stiffness.
//!
//! K_c = Σ U k Uᵀ has a symmetric part Σ k_gg g gᵀ, k_gg = ∂N/∂δ, with k_tt t tᵀ of points that stick, which holds the bodies together, and friction, which is
//! small beside it. Real modes and factors of the open structure do not know it: as many of their combinations as there are
//! directions would have to come from corrections, and the digits of k_gg are lost in the projected problem. So where the
//! directions are more than the real modes, the spring of every point is added to K, real modes and factors are those of
//! the closed structure, and what is left of the interface is friction and damping.

use super::ComplexMode;
use super::post_processing::shares;
use crate::dynamics::{Block, Interface};
use crate::equilibrium::{SteadySliding, closed_structure};
use crate::error::Result;
use crate::linalg::multivector::gram;
use crate::linalg::sparse::times;
use crate::modal::{ModesWanted, RealModes, ShiftedStiffness, compute};
use crate::progress::Observer;
use crate::system::System;
use faer::Mat;
use std::f64::consts::TAU;

/// The same linear system: K with K_σ and the springs of the contact, and contact points without them.
pub struct ClosedContact {
    /// The system; its real modes are those of the structure with its contact closed.
    pub system: System,
    /// Its state, whose points have friction and damping alone.
    pub steady: SteadySliding,
    /// What of each point is part of K \[N/m\], along g, t₁, t₂.
    pub(super) springs: Vec<[f64; 3]>,
}

impl ClosedContact {
    /// Of `system` at a steady state.
    ///
    /// # Errors
    /// A geometric stiffness that cannot be worked out.
    pub fn of(system: &System, steady: &SteadySliding) -> Result<Self> {
        let springs = springs(steady);
        let structure = closed_structure(system, steady)?;
        let mut steady = steady.clone();
        steady
            .points
            .iter_mut()
            .for_each(|point| point.tangent = point.tangent.without(point.tangent.springs()));
        Ok(ClosedContact { system: System { structure, prestress: None, ..system.clone() }, steady, springs })
    }
}

/// A closed system with its real modes, and factors at a shift among them.
pub type ClosedModes = (ClosedContact, RealModes, ShiftedStiffness);

/// The closed system where the interface acts in more directions than there are `real` modes in a band up to `top` \[rad/s\]; none
/// otherwise. Its real modes reach as far as those given.
///
/// # Errors
/// A stiffness that cannot be factorised; real modes that do not converge.
pub fn closed_modes(
    (system, steady): (&System, &SteadySliding),
    real: &RealModes,
    top: f64,
    observer: &dyn Observer,
) -> Result<Option<ClosedModes>> {
    let many = springs(steady).as_flattened().iter().any(|k| *k != 0.0)
        && Interface::new(system, steady).active(top).len() > real.len();
    if !many || real.len() == system.n_dofs() {
        return Ok(None);
    }
    let closed = ClosedContact::of(system, steady)?;
    let counted = real.certificate.below_hz;
    let below = if real.certificate.holds() { counted } else { top / TAU };
    let (real, shifted) = compute(&closed.system.structure, ModesWanted::BelowHz(below), observer)?;
    Ok(Some((closed, real, shifted)))
}

fn springs(steady: &SteadySliding) -> Vec<[f64; 3]> {
    steady.points.iter().map(|point| point.tangent.springs()).collect()
}

/// Gives the modes their shares of `real` modes other than those of the basis.
pub(super) fn share_out(modes: &mut [ComplexMode], system: &System, real: &RealModes) {
    let inertia = times(&system.structure.mass, real.shapes.as_ref());
    for mode in modes {
        let right = Block::from_columns(mode.right.len(), &[&mode.right]);
        let amplitudes: Block = right.map(|x| -> Mat<f64> { gram(inertia.as_ref(), x) });
        mode.participation = shares(&amplitudes, 0);
    }
}

#[cfg(test)]
mod tests {
    use super::super::complex_modes;
    use super::super::exact::ExactProblem;
    use super::super::tests::{damped, dense_eigenvalues, dense_modes, nearest, steady};
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::equilibrium::samples::random_system;
    use crate::linalg::c64;

    /// Contact springs from the stiffness of the structure to a million times that, in more points than there are real modes: the
    /// modes are those of the dense problem, and their shares those of the real modes that were given.
    #[test]
    fn stiff_contact_of_many_points_agrees_with_the_dense_full_order_solution() {
        for (seed, power) in [(1, 0), (2, 2), (3, 4), (6, 6)] {
            let n = 180;
            let system = damped(random_system(n, 14, 20.0, 700 + seed), seed);
            let mut state = steady(&system);
            for point in &mut state.points {
                point.tangent.by_penetration.iter_mut().for_each(|k| *k *= 10f64.powi(power));
            }
            let real = dense_modes(&system, 24);
            let band = [0.01, 0.5 * (real.frequency_hz(11) + real.frequency_hz(12))];
            let found = complex_modes(&system, &state, &real, band, &()).unwrap();
            let exact = dense_eigenvalues(&system, &state, band);
            assert_eq!(found.modes.len(), exact.len(), "seed {seed}: {:?}", found.warnings);
            // The dense solver loses what rounding of the springs is beside λ², which the reference has with twice the digits.
            let refined = ExactProblem::new(&system, &state);
            let bound = 1e-9_f64.max(1e-14 * 10f64.powi(power));
            for mode in &found.modes {
                let exact = refined.eigenvalue(nearest(mode.eigenvalue, &exact));
                let error = (mode.eigenvalue - exact).norm() / exact.norm();
                assert!(
                    within(error, bound, RoundOff) && mode.accepted(),
                    "seed {seed}: {error:.1e} {mode:?}"
                );
                for (k, share) in &mode.participation {
                    let x = times(&system.structure.mass, real.shapes.subcols(*k, 1));
                    let amplitude: c64 = mode.right.iter().zip(x.col_as_slice(0)).map(|(r, x)| r * x).sum();
                    assert!(
                        within((amplitude.norm_sqr() - share).abs(), 1e-9, RoundOff),
                        "seed {seed}: mode {k}"
                    );
                }
            }
        }
    }
}
