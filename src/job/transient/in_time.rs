//! Where a run in time starts from.

use crate::case::TransientAnalysis;
use crate::job::operating_point::OperatingPoint;
use crate::reduction::has_many_points;
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

/// Steps of a reduced model that are compared with the full one, when the case does not say.
const COMPARED: usize = 100;

impl InTime<'_> {
    /// Whether a reduced model moves.
    pub(super) fn is_reduced(&self, wanted: &TransientAnalysis) -> bool {
        wanted.is_reduced(has_many_points(&self.point.system))
    }

    /// Steps of a reduced model that the full one makes, too; the full one of many points makes none unless it is asked to.
    pub(super) fn compared(&self, wanted: &TransientAnalysis) -> usize {
        let few = self.is_reduced(wanted) && !has_many_points(&self.point.system);
        wanted.compare_steps.unwrap_or(if few { COMPARED } else { 0 })
    }
}
