//! Steady sliding of a case and the linear system about it.

use super::prepared::Prepared;
use crate::equilibrium::SteadySliding;
use crate::modal::RealModes;
use crate::system::System;
use std::borrow::Cow;
use std::sync::Arc;

/// The state about which a prepared case vibrates: complex modes belong to it, and sensitivities, sweeps and motion in time start from it.
pub struct OperatingPoint<'a> {
    /// The case made ready.
    pub prepared: &'a Prepared<'a>,
    /// Steady sliding.
    pub steady: Arc<SteadySliding>,
    /// The system with its modal damping.
    pub system: Cow<'a, System>,
    /// The real modes that span the complex ones.
    pub real: RealModes,
}
