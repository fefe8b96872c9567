//! Steady sliding of a case and the linear system about it.

use super::prepared::Prepared;
use crate::equilibrium::{SteadySliding, preloaded_structure};
use crate::error::Result;
use crate::modal::{ModesWanted, RealModes, compute};
use crate::progress::Observer;
use crate::stability::ClosedContact;
use crate::system::System;
use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

/// The state about which a prepared case vibrates: complex modes belong to it, and sensitivities, sweeps and motion in time start from it.
pub struct OperatingPoint<'a> {
    /// The case made ready.
    pub prepared: &'a Prepared<'a>,
    /// Steady sliding.
    pub steady: Arc<SteadySliding>,
    /// The system with its modal damping.
    pub system: Cow<'a, System>,
    /// The real modes that span the complex ones: of the structure alone or, where `closed` is given, with its contact closed.
    pub real: RealModes,
    /// The system with its contact closed, where that has many points.
    pub closed: Option<ClosedContact>,
    /// Real modes of the structure alone where `real` are others, once they are requested.
    pub open: OnceLock<RealModes>,
}

impl OperatingPoint<'_> {
    /// The real modes of the structure alone, without contact, as far up as `real`.
    ///
    /// # Errors
    /// Modes that cannot be computed.
    pub fn open_modes(&self, observer: &dyn Observer) -> Result<&RealModes> {
        if self.closed.is_none() {
            return Ok(&self.real);
        }
        if let Some(open) = self.open.get() {
            return Ok(open);
        }
        let structure = preloaded_structure(&self.system, &self.steady)?;
        let below = ModesWanted::BelowHz(self.real.certificate.below_hz);
        let (open, _) = compute(&structure, below, observer)?;
        Ok(self.open.get_or_init(|| open))
    }
}
