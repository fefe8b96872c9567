//! The normal force as a function of penetration.

/// N/w = k_n δ + k_nl δ³ + c_n δ̇, with w the weight of the point (a length, an area or a share of one).
///
/// Unilateral by default: N = 0 for δ ≤ 0 (lift-off), and the dashpot never pulls (N ≥ 0). Bilateral: the same
/// polynomial for either sign of δ, so that the bodies never separate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalLaw {
    /// k_n \[N/m per unit of weight\].
    pub stiffness: f64,
    /// k_nl \[N/m³ per unit of weight\].
    pub cubic_stiffness: f64,
    /// c_n \[N s/m per unit of weight\].
    pub damping: f64,
    /// Whether the contact also pulls.
    pub bilateral: bool,
}

/// N per unit of weight and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NormalForce {
    /// N.
    pub value: f64,
    /// ∂N/∂δ.
    pub by_penetration: f64,
    /// ∂N/∂δ̇.
    pub by_penetration_rate: f64,
}

impl NormalLaw {
    /// The unilateral linear penalty of stiffness `k_n`.
    pub fn linear(stiffness: f64) -> Self {
        NormalLaw { stiffness, cubic_stiffness: 0.0, damping: 0.0, bilateral: false }
    }

    /// N at penetration δ \[m\] and rate δ̇ \[m/s\], for unit weight.
    pub fn force(&self, penetration: f64, rate: f64) -> NormalForce {
        if !self.bilateral && penetration <= 0.0 {
            return NormalForce::default();
        }
        let square = penetration * penetration;
        let value = (self.stiffness + self.cubic_stiffness * square) * penetration + self.damping * rate;
        if !self.bilateral && value < 0.0 {
            return NormalForce::default();
        }
        NormalForce {
            value,
            by_penetration: self.stiffness + 3.0 * self.cubic_stiffness * square,
            by_penetration_rate: self.damping,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubic_penalty_opens_only_when_unilateral_and_its_dashpot_never_pulls() {
        let mut law = NormalLaw { stiffness: 2.0, cubic_stiffness: 3.0, damping: 5.0, bilateral: false };
        assert_eq!(law.force(2.0, 0.0).value, 2.0 * 2.0 + 3.0 * 8.0);
        assert_eq!(law.force(-0.1, 1.0), NormalForce::default());
        assert_eq!(law.force(0.1, -1.0), NormalForce::default());
        law.bilateral = true;
        assert_eq!(law.force(-2.0, 0.0).value, -(2.0 * 2.0 + 3.0 * 8.0));
        assert_eq!(law.force(-2.0, 0.0).by_penetration, 2.0 + 9.0 * 4.0);
    }
}
