//! How complex eigenvalues answer scalars of the case and things mounted on its nodes.

use super::analysis::{Analysis, Planned, Scope};
use crate::case::SensitivityAnalysis;
use crate::error::Result;
use crate::job::prepared::Prepared;
use crate::job::run::Run;
use crate::results::ComplexResult;

/// Sensitivities of complex eigenvalues.
pub const SENSITIVITY: Analysis = Analysis {
    name: "sensitivity",
    about: "Complex eigenvalues, their sensitivities, and where a mass or a damper stabilises them",
    // Every key of its table has a default.
    example: None,
    listed: |case| case.sensitivity.is_some(),
    ready: |_| true,
    needs: &["cea"],
    left_vectors: true,
    plan,
};

fn plan<'a>(prepared: &'a Prepared<'a>, _: Scope) -> Result<Box<dyn Planned<'a> + 'a>> {
    Ok(Box::new(PlannedSensitivity(prepared.case.sensitivity.clone().unwrap_or_default())))
}

struct PlannedSensitivity(SensitivityAnalysis);

impl<'a> Planned<'a> for PlannedSensitivity {
    fn run(self: Box<Self>, run: &mut Run<'a, '_>) -> Result<()> {
        let Some((point, complex)) = run.operating_point.clone().zip(run.results.get::<ComplexResult>())
        else {
            return Ok(());
        };
        let of = || point.sensitivities(&complex.modes, &self.0, run.observer);
        let found = run.clock.time("sensitivities", of)?;
        run.found(found)
    }
}
