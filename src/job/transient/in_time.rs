//! Where a run in time starts from.

use crate::equilibrium::SteadySliding;
use crate::modal::RealModes;
use crate::results::{ComplexResult, Geometry};
use crate::structure::{DofMap, Model};
use crate::system::System;

/// A run in time of `system`, whose modal damping is in it, from its steady state.
pub struct InTime<'a> {
    /// The system with its modal damping.
    pub system: &'a System,
    /// Where it starts.
    pub steady: &'a SteadySliding,
    /// Its complex modes.
    pub complex: &'a ComplexResult,
    /// The real modes that span them.
    pub real: &'a RealModes,
    /// The way to the motion of every node.
    pub dofs: &'a DofMap,
    /// The parts that move.
    pub model: &'a Model,
    /// The mesh that moves.
    pub geometry: &'a Geometry,
}
