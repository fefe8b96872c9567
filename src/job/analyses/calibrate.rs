//! Numbers of the case from measured frequencies.

use super::analysis::{Analysis, Planned, Scope};
use crate::case::Case;
use crate::error::Result;
use crate::job::calibrate;
use crate::job::prepared::Prepared;
use crate::job::run::Run;

/// Calibration.
pub struct CalibrateCommand;

impl Analysis for CalibrateCommand {
    fn name(&self) -> &'static str {
        "calibrate"
    }

    fn about(&self) -> &'static str {
        "Calibrate parameters of the case with measured modes and responses, and assess the result"
    }

    fn example(&self) -> Option<&'static str> {
        Some(
            "[calibrate] with `against = \"disc\"`, and [calibrate.parameter.NAME] with `path` and `between`",
        )
    }

    fn listed(&self, case: &Case) -> bool {
        case.calibrate.is_some()
    }

    fn plan<'a>(&self, prepared: &'a Prepared<'a>, _: Scope) -> Result<Box<dyn Planned<'a> + 'a>> {
        let wanted = prepared.case.calibrate.as_ref().ok_or_else(|| self.no_table())?;
        Ok(Box::new(calibrate::Calibrate::new(prepared, wanted)?))
    }
}

impl<'a> Planned<'a> for calibrate::Calibrate<'a> {
    fn run(self: Box<Self>, run: &mut Run<'a, '_>) -> Result<()> {
        let found = run.timed("calibration", |observer| calibrate::Calibrate::run(&self, observer))?;
        run.found(found)
    }
}
