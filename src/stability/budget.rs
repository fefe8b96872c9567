//! Where the growth of a mode comes from, and which real modes take part in it.

use super::GrowthBudget;
use crate::dynamics::{Forms, Operator, TermOrigin};
use crate::linalg::c64;

impl GrowthBudget {
    /// The sum of the terms: σ.
    pub fn total(&self) -> f64 {
        self.structural_damping + self.falling_friction + self.transverse_friction + self.mode_coupling
    }
}

/// An eigenvalue with ω below this part of |λ| is real: ω is the rounding of zero.
const REAL: f64 = 1e-9;

/// The terms of σ of a pair, for φ scaled to φᴴMφ = 1, given what the matrices are between φ and φ, and the `motion` Wᵀφ of
/// the interface.
///
/// The imaginary part of φᴴQ(λ)φ = 0 is 2σω + ω Re γ + σ Im γ + Im κ = 0 with γ = φᴴ(C + C_c)φ and κ = φᴴ(K + iH +
/// K_c)φ. Each entry of a contact block is one summand of γ or κ: (g, g) is damping in the normal direction and goes
/// with the structure's, (t₁, t₁) is falling friction, what turns with the transverse slip touches t₂, and a friction
/// force that follows the normal motion (t, g) couples the modes. A real eigenvalue (ω = 0) has no such balance: all
/// terms are zero. Sparse skew parts, φᴴK_kφ = i `circulatory` and φᴴC_kφ = i `gyroscopic`, make it (2ω + gyroscopic) σ + … +
/// circulatory = 0: gyroscopic forces do no work, and have no term of their own.
pub(super) fn growth_budget(
    operator: &Operator<'_>,
    lambda: c64,
    forms: &Forms,
    motion: &[c64],
    [circulatory, gyroscopic]: [f64; 2],
) -> GrowthBudget {
    let mut budget = GrowthBudget::default();
    let omega = lambda.im;
    let inertia = 2.0 * omega + gyroscopic;
    if omega <= REAL * lambda.norm() || inertia.abs() <= REAL * lambda.norm() {
        return budget;
    }
    let by_velocity = |gamma: c64| -(omega * gamma.re + lambda.re * gamma.im) / inertia;
    let by_displacement = |kappa: c64| -kappa.im / inertia;
    budget.mode_coupling = -circulatory / inertia;
    budget.structural_damping = by_velocity(forms.damping) + by_displacement(c64::new(0.0, 1.0) * forms.loss);
    for term in &operator.interface.terms {
        let product = motion[term.row].conj() * motion[term.column];
        let share = by_velocity(product * term.damping) + by_displacement(product * term.stiffness);
        match term.origin {
            TermOrigin::Normal => budget.structural_damping += share,
            TermOrigin::Falling => budget.falling_friction += share,
            TermOrigin::Transverse => budget.transverse_friction += share,
            TermOrigin::Coupling => budget.mode_coupling += share,
        }
    }
    budget
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equilibrium::samples::random_system;
    use crate::stability::tests::steady;

    /// What rounding leaves of the frequency of a real eigenvalue divides nothing.
    #[test]
    fn real_eigenvalues_have_no_budget() {
        let system = random_system(12, 3, 20.0, 4);
        let state = steady(&system);
        let operator = Operator::new(&system, &state).unwrap();
        let one = c64::new(1.0, 1e-12);
        let motion = vec![one; operator.interface.directions.len()];
        let forms = Forms { mass: one, stiffness: one, damping: one, loss: one };
        for power in -300..-9 {
            for growth in [-3.0, 1e-3, 2e4] {
                let lambda = c64::new(growth, f64::abs(growth) * 10f64.powi(power));
                let budget = growth_budget(&operator, lambda, &forms, &motion, [0.0; 2]);
                assert_eq!(budget, GrowthBudget::default(), "{lambda}");
            }
        }
    }
}
