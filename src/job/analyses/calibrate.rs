//! Numbers of the case from measured frequencies.

use super::analysis::{Analysis, Planned, Scope};
use crate::error::Result;
use crate::job::calibrate;
use crate::job::prepared::Prepared;
use crate::job::run::Run;

/// Calibration.
pub const CALIBRATE: Analysis = Analysis {
    name: "calibrate",
    about: "Calibrate parameters of the case with measured modes and responses, and assess the result",
    example: Some(
        "[calibrate] with `against = \"disc\"`, and [calibrate.parameter.NAME] with `path` and `between`",
    ),
    listed: |case| case.calibrate.is_some(),
    ready: |case| case.calibrate.is_some(),
    needs: &[],
    left_vectors: false,
    plan,
};

fn plan<'a>(prepared: &'a Prepared<'a>, _: Scope) -> Result<Box<dyn Planned<'a> + 'a>> {
    let wanted = prepared.case.calibrate.as_ref().ok_or_else(|| CALIBRATE.no_table())?;
    Ok(Box::new(calibrate::Calibrate::new(prepared, wanted)?))
}

impl<'a> Planned<'a> for calibrate::Calibrate<'a> {
    fn run(self: Box<Self>, run: &mut Run<'a, '_>) -> Result<()> {
        let found = run.timed("calibration", |observer| calibrate::Calibrate::run(&self, observer))?;
        run.found(found)
    }
}
