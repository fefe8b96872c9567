//! Steady sliding: the static state under load and friction, and the system linearised about it.
//!
//! K u₀ + Σ [g N − t₁ F₁ − t₂ F₂] = f, ΣN = load of each pair. [`solve_steady`] finds u₀; [`linearize`] gives
//! K_c = Σ U k Uᵀ and C_c = Σ U c Uᵀ as small blocks, [`tangent_stiffness`] K + K_σ(u₀).

mod assembled;
mod balance;
mod condensed;
mod conditions;
mod linear;
mod load_steps;
mod nearby;
mod newton;
mod no_state;
mod point_laws;
#[cfg(test)]
pub(crate) mod samples;
mod solver;
mod steady;
#[cfg(test)]
mod tests;

pub use balance::by_pair;
pub use condensed::closed_springs;
#[cfg(test)]
pub(crate) use condensed::closed_stiffness;
pub use linear::{
    ContactBlock, LinearContact, Spring, closed_structure, contact_force, directions, linearize,
    linearize_points, preloaded_structure, tangent_stiffness,
};
pub use nearby::Nearby;
pub use no_state::{EDGE, carrying_share};
pub use solver::{FEW_POINTS, SteadySolver};
pub use steady::{check, solve_steady, steady_sliding};

use crate::system::{ContactForces, ContactTangent};

/// Options of the steady-state solver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteadyOptions {
    /// The deepest penetration that still makes sense \[m\]: about half the thinner body. Infinite by default.
    pub penetration_limit: f64,
    /// Newton iterations of one load step.
    pub max_iterations: usize,
}

impl Default for SteadyOptions {
    fn default() -> Self {
        SteadyOptions { penetration_limit: f64::INFINITY, max_iterations: 60 }
    }
}

/// Steady sliding of a system.
#[derive(Debug, Clone)]
pub struct SteadySliding {
    /// u₀ \[m, rad\] on the degrees of freedom.
    pub displacement: Vec<f64>,
    /// Approach of each pair \[m\].
    pub approach: Vec<f64>,
    /// State of each contact point, in the order of [`crate::system::System::points`].
    pub points: Vec<PointState>,
    /// Newton iterations in all.
    pub iterations: usize,
    /// ‖K u₀ + r_c − f‖ / (‖f‖ + ‖r_c‖) of the full system.
    pub residual: f64,
}

/// One contact point at steady sliding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointState {
    /// δ₀ \[m\], negative when open.
    pub penetration: f64,
    /// Forces there \[N\].
    pub forces: ContactForces,
    /// Their derivatives there: the linearised contact.
    pub tangent: ContactTangent,
    /// Whether a point of a pair that does not slide has slid to where it stands: its friction is at its limit, |F| = μ(0) N.
    pub slips: bool,
}

impl PointState {
    /// Whether the point carries load.
    pub fn closed(&self) -> bool {
        self.forces.normal > 0.0
    }
}
