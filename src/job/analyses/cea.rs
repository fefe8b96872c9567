//! Complex eigenvalues at steady sliding.

use super::analysis::{Analysis, Planned, Scope};
use crate::case::{Case, CeaAnalysis};
use crate::error::Result;
use crate::job::complex::complex_result;
use crate::job::prepared::Prepared;
use crate::job::run::{OperatingPoint, Run};

/// Complex eigenvalue analysis.
pub struct CeaCommand;

impl Analysis for CeaCommand {
    fn name(&self) -> &'static str {
        "cea"
    }

    fn about(&self) -> &'static str {
        "Steady sliding and complex eigenvalues only"
    }

    fn example(&self) -> Option<&'static str> {
        Some("[cea] with `band = [0, \"6 kHz\"]`")
    }

    fn listed(&self, case: &Case) -> bool {
        case.cea.is_some()
    }

    fn plan<'a>(&self, prepared: &'a Prepared<'a>, _: Scope) -> Result<Box<dyn Planned<'a> + 'a>> {
        let wanted = prepared.case.cea.as_ref().ok_or_else(|| self.no_table())?;
        Ok(Box::new(PlannedCea(wanted)))
    }
}

struct PlannedCea<'a>(&'a CeaAnalysis);

impl<'a> Planned<'a> for PlannedCea<'a> {
    fn slides(&self) -> bool {
        true
    }

    fn warnings(&self) -> Vec<String> {
        not_all_of_the_band(self.0).into_iter().collect()
    }

    fn run(self: Box<Self>, run: &mut Run<'a, '_>) -> Result<()> {
        let steady = run.steady()?;
        run.basis()?;
        let (basis, left_vectors) = (run.basis.take(), run.left_vectors);
        let at = (run.prepared, &*steady);
        let (complex, system, real) =
            complex_result(at, self.0, basis, left_vectors, &mut run.clock, run.observer)?;
        run.results.warnings.extend(complex.modes.warnings.iter().cloned());
        run.operating_point = Some(OperatingPoint { steady, system, real }.into());
        run.found(complex)
    }
}

/// Says that `nearest` leaves modes of a band that the case gives beside it.
fn not_all_of_the_band(cea: &CeaAnalysis) -> Option<String> {
    let (hz, count) = cea.nearest.zip(cea.count)?;
    let [low, high] = cea.band;
    let given = low != 0.0 || high != 4.0 * hz;
    given.then(|| {
        format!(
            "[cea] looks for the {count} complex modes nearest to {hz} Hz alone, not for all from {low} to {high} Hz; \
             without `nearest` and `count` it looks for all"
        )
    })
}
