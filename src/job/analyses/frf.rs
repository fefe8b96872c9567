//! Frequency responses, each beside what a test measured.

use super::analysis::{Analysis, Planned, Scope};
use crate::error::{Faults, Result};
use crate::job::compare::{Tests, has_measured_frf};
use crate::job::frf::{self, frfs};
use crate::job::frf_stability::unsteady;
use crate::job::prepared::Prepared;
use crate::job::run::Run;
use crate::results::ComplexResult;

/// Frequency responses.
pub const FRF: Analysis = Analysis {
    name: "frf",
    about: "Frequency responses: motion at some places for a harmonic force at another",
    example: Some(
        "[frf.tap] with `band = [\"10 Hz\", \"3 kHz\"]` and `excitation = { at = [0, 0, 0], direction = [0, 0, 1] }`",
    ),
    listed: |case| !case.frf.is_empty(),
    ready: |case| !case.frf.is_empty(),
    needs: &[],
    left_vectors: false,
    plan,
};

fn plan<'a>(prepared: &'a Prepared<'a>, scope: Scope) -> Result<Box<dyn Planned<'a> + 'a>> {
    let mut faults = Faults::new();
    let mut frfs = faults.take(frfs(prepared)).unwrap_or_default();
    frfs.retain(|frf| scope == Scope::All || has_measured_frf(prepared.case, frf.name()));
    let tests = faults.take(Tests::of_responses(prepared, &mut frfs)).unwrap_or_default();
    let open = frfs.iter().filter_map(|frf| frf.warning(prepared.case));
    let warnings = tests.warnings.iter().cloned().chain(open).collect();
    faults.into_result(Box::new(PlannedFrfs { frfs, tests, warnings }))
}

struct PlannedFrfs<'a> {
    frfs: Vec<frf::PreparedFrf<'a>>,
    tests: Tests,
    warnings: Vec<String>,
}

impl<'a> Planned<'a> for PlannedFrfs<'a> {
    fn slides(&self) -> bool {
        self.frfs.iter().any(frf::PreparedFrf::slides)
    }

    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    fn run(self: Box<Self>, run: &mut Run<'a, '_>) -> Result<()> {
        let prepared = run.prepared;
        for frf in &self.frfs {
            let steady = if frf.slides() { Some(run.steady()?) } else { None };
            let phase = format!("frequency response {}", frf.name());
            let known = run.results.get::<ComplexResult>();
            let at = (steady.as_deref(), known.filter(|_| steady.is_some()));
            let observer = run.observer;
            let (response, beside) = run.clock.time(&phase, || frf.run(prepared, at, observer))?;
            run.results.warnings.extend(frf::undamped(&response));
            run.results.warnings.extend(unsteady(&response));
            let compared = self.tests.responses(&response, &beside);
            run.found(response)?;
            compared.into_iter().try_for_each(|comparison| run.found(comparison))?;
        }
        Ok(())
    }
}
