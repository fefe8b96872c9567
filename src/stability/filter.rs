//! How much of one complex mode a motion holds.

use super::ComplexMode;
use crate::dynamics::{Block, Operator, Side};
use crate::equilibrium::SteadySliding;
use crate::error::{Error, Fault, Result};
use crate::linalg::c64;
use crate::linalg::sparse::times;
use crate::system::System;

/// The amplitude c of a mode in a motion near steady sliding, u = u₀ + Re(c φ) + other modes:
///
/// c = 2 (ψᴴ(λM + C + C_c) δu + ψᴴM δu̇) / ψᴴ(2λM + C + C_c)φ.
///
/// By the biorthogonality of the quadratic problem other modes, the conjugate among them, do not enter; while the motion
/// is small c turns and grows like e^{λt}.
#[derive(Debug, Clone)]
pub struct ModalFilter {
    /// Weights of δu, entry by entry.
    pub displacement: Vec<c64>,
    /// Weights of δu̇.
    pub velocity: Vec<c64>,
}

impl ModalFilter {
    /// c of a displacement from steady sliding and a velocity.
    pub fn amplitude(&self, displacement: &[f64], velocity: &[f64]) -> c64 {
        let terms = self.displacement.iter().zip(displacement).chain(self.velocity.iter().zip(velocity));
        terms.fold(c64::new(0.0, 0.0), |sum, (w, x)| sum + w * *x)
    }
}

/// The filter of `mode`.
///
/// # Errors
/// A mode of another system, or without its left vector; what the geometric stiffness of the preload returns.
pub fn modal_filter(system: &System, steady: &SteadySliding, mode: &ComplexMode) -> Result<ModalFilter> {
    let operator = Operator::new(system, steady)?;
    let n = operator.n();
    if !mode.of_size(n) {
        let found = format!("vectors of {} and {} degrees of freedom", mode.right.len(), mode.left.len());
        return Err(Error::input(Fault::new("mode of a filter", found, format!("both of {n}"))));
    }
    let left = Block::from_columns(n, &[&mode.left]);
    // Q′(λ)ᴴψ and Mψ.
    let slope = operator.slope(Side::Left, &[mode.eigenvalue], &left);
    let (slope, inertia) = (slope.column(0), left.map(|x| times(operator.mass, x)).column(0));
    let steepness = slope.iter().zip(&mode.right).fold(c64::new(0.0, 0.0), |sum, (s, x)| sum + s.conj() * x);
    let lambda = mode.eigenvalue.conj();
    let scale = c64::new(2.0, 0.0) / steepness;
    let displacement = slope.iter().zip(&inertia).map(|(s, m)| (s - lambda * m).conj() * scale).collect();
    Ok(ModalFilter { displacement, velocity: inertia.iter().map(|m| m.conj() * scale).collect() })
}
