//! Friction coefficients: how μ depends on the slip speed and on the pressure.

use std::fmt::Debug;

/// μ and its derivatives at one speed and pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficient {
    /// μ.
    pub value: f64,
    /// ∂μ/∂|v| \[s/m\]; negative where friction falls with speed.
    pub by_speed: f64,
    /// ∂μ/∂p \[per unit of pressure\].
    pub by_pressure: f64,
}

/// μ(|v|, p): a pure function of the slip speed |v| ≥ 0 \[m/s\] and of the pressure p = N/weight ≥ 0
/// (N/m for a line contact, N/m² for a face, N for a single point).
pub trait FrictionCoefficient: Debug + Send + Sync {
    /// μ and its derivatives.
    fn mu(&self, speed: f64, pressure: f64) -> Coefficient;
}

/// Coulomb friction: the same μ at every speed and pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constant(
    /// μ.
    pub f64,
);

impl FrictionCoefficient for Constant {
    fn mu(&self, _speed: f64, _pressure: f64) -> Coefficient {
        Coefficient { value: self.0, by_speed: 0.0, by_pressure: 0.0 }
    }
}

/// Friction that falls with speed: μ(v) = μ₀ + μ₁ exp(−α |v|).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exponential {
    /// μ₀: the limit at high speed.
    pub mu_0: f64,
    /// μ₁: what μ(0) has above μ₀.
    pub mu_1: f64,
    /// α \[s/m\].
    pub alpha: f64,
}

impl FrictionCoefficient for Exponential {
    fn mu(&self, speed: f64, _pressure: f64) -> Coefficient {
        let decaying = self.mu_1 * (-self.alpha * speed).exp();
        Coefficient { value: self.mu_0 + decaying, by_speed: -self.alpha * decaying, by_pressure: 0.0 }
    }
}

/// Static and kinetic friction with Stribeck's transition: μ(v) = μ_k + (μ_s − μ_k) exp(−(|v|/v_s)^δ) (B. Armstrong-Hélouvry,
/// P. Dupont & C. Canudas de Wit, Automatica 30 (1994) 1083).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stribeck {
    /// μ_s, at rest.
    pub at_rest: f64,
    /// μ_k, at high speed.
    pub kinetic: f64,
    /// v_s \[m/s\].
    pub velocity: f64,
    /// δ ≥ 1: 1 for an exponential, 2 for a bell.
    pub exponent: f64,
}

impl FrictionCoefficient for Stribeck {
    fn mu(&self, speed: f64, _pressure: f64) -> Coefficient {
        let part = speed / self.velocity;
        let above = (self.at_rest - self.kinetic) * (-part.powf(self.exponent)).exp();
        let slope = self.exponent * part.powf(self.exponent - 1.0) / self.velocity;
        Coefficient { value: self.kinetic + above, by_speed: -slope * above, by_pressure: 0.0 }
    }
}

/// Friction that falls to nothing: μ(v) = μ_s/(1 + a|v|), as in textbook examples of stick–slip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hyperbolic {
    /// μ_s, at rest.
    pub at_rest: f64,
    /// a \[s/m\].
    pub decline: f64,
}

impl FrictionCoefficient for Hyperbolic {
    fn mu(&self, speed: f64, _pressure: f64) -> Coefficient {
        let value = self.at_rest / (1.0 + self.decline * speed);
        Coefficient {
            value,
            by_speed: -self.decline * value / (1.0 + self.decline * speed),
            by_pressure: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponential_runs_from_the_static_to_the_high_speed_limit() {
        let law = Exponential { mu_0: 0.3, mu_1: 0.2, alpha: 4.0 };
        assert_eq!(law.mu(0.0, 0.0).value, 0.5);
        assert!((law.mu(50.0, 0.0).value - 0.3).abs() < 1e-15);
        let (slow, h) = (law.mu(0.25, 0.0), 1e-6);
        assert!((slow.value - (0.3 + 0.2 * (-1.0f64).exp())).abs() < 1e-15);
        let difference = (law.mu(0.25 + h, 0.0).value - law.mu(0.25 - h, 0.0).value) / (2.0 * h);
        assert!((slow.by_speed - difference).abs() < 1e-9);
    }

    #[test]
    fn falling_laws_start_at_rest_and_have_the_slopes_of_their_curves() {
        let bell = Stribeck { at_rest: 0.6, kinetic: 0.4, velocity: 0.05, exponent: 2.0 };
        let laws: [(&dyn FrictionCoefficient, f64, f64); 3] = [
            (&bell, 0.6, 0.4 + 0.2 * (-0.36f64).exp()),
            (&Stribeck { exponent: 1.0, ..bell }, 0.6, 0.4 + 0.2 * (-0.6f64).exp()),
            (&Hyperbolic { at_rest: 1.0, decline: 3.0 }, 1.0, 1.0 / 1.09),
        ];
        for (law, at_rest, moving) in laws {
            assert_eq!(law.mu(0.0, 0.0).value, at_rest);
            assert!(law.mu(0.0, 0.0).by_speed.is_finite());
            let (there, h) = (law.mu(0.03, 0.0), 1e-7);
            assert!((there.value - moving).abs() < 1e-14, "{law:?}");
            let slope = (law.mu(0.03 + h, 0.0).value - law.mu(0.03 - h, 0.0).value) / (2.0 * h);
            assert!((there.by_speed - slope).abs() < 1e-6, "{law:?}");
        }
    }
}
