//! A friction coefficient as a function of slip speed and pressure.

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
