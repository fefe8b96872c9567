//! Complex modes along one scalar of the case, or over two.

use super::analysis::{Analysis, Planned, Scope};
use crate::error::Result;
use crate::job::explore::{Studies, explore};
use crate::job::prepared::Prepared;
use crate::job::run::Run;

/// Sweeps and maps.
pub const SWEEP: Analysis = Analysis {
    name: "sweep",
    about: "Complex eigenvalues, and the sweeps and maps of the case",
    example: Some(
        "[sweep.mu] with `parameter = \"contact.NAME.friction.mu0\"`, `from = 0.1` and `to = 0.7`, or a [map.NAME]",
    ),
    listed: |case| !(case.sweep.is_empty() && case.map.is_empty()),
    ready: |case| !(case.sweep.is_empty() && case.map.is_empty()),
    needs: &["cea"],
    left_vectors: false,
    plan,
};

fn plan<'a>(_: &'a Prepared<'a>, _: Scope) -> Result<Box<dyn Planned<'a> + 'a>> {
    Ok(Box::new(PlannedStudies {
        phase: "sweeps and maps",
        studies: &|explorer, results, record| explorer.sweeps_and_maps(results, record),
    }))
}

/// Studies of the case, which run as one phase.
pub(super) struct PlannedStudies {
    pub(super) phase: &'static str,
    pub(super) studies: &'static Studies<'static>,
}

impl<'a> Planned<'a> for PlannedStudies {
    fn run(self: Box<Self>, run: &mut Run<'a, '_>) -> Result<()> {
        let Some(point) = run.operating_point.clone() else { return Ok(()) };
        let Run { sink, results, clock, known, observer, .. } = run;
        clock.time(self.phase, || {
            explore(&point, self.studies, known, results, &mut |stage| sink.record(stage), *observer)
        })
    }
}
