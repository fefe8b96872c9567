//! Where a run in time starts from.

use crate::job::operating_point::OperatingPoint;
use crate::results::{ComplexResult, Geometry};

/// A run in time from steady sliding.
pub struct InTime<'a> {
    /// Where it starts.
    pub point: &'a OperatingPoint<'a>,
    /// Its complex modes.
    pub complex: &'a ComplexResult,
    /// The mesh that moves.
    pub geometry: &'a Geometry,
}
