//! Motion in time from steady sliding.

use super::analysis::{Analysis, Planned, Scope};
use crate::case::TransientAnalysis;
use crate::error::Result;
use crate::job::prepared::Prepared;
use crate::job::run::Run;
use crate::job::sink::ResultStage;
use crate::job::transient::{InTime, TransientPlaces, places};
use crate::results::{ComplexResult, RecordSize};

/// The phase of motion in time.
pub const PHASE: &str = "transient";

/// Motion in time.
pub const TRANSIENT: Analysis = Analysis {
    name: "transient",
    about: "Complex eigenvalues, and motion in time from steady sliding",
    example: Some("[transient] with `duration = \"10 ms\"` and `time_step = \"5 us\"`"),
    listed: |case| case.transient.is_some(),
    ready: |case| case.transient.is_some(),
    needs: &["cea"],
    left_vectors: true,
    plan,
};

fn plan<'a>(prepared: &'a Prepared<'a>, _: Scope) -> Result<Box<dyn Planned<'a> + 'a>> {
    let wanted = prepared.case.transient.as_ref().ok_or_else(|| TRANSIENT.no_table())?;
    let places = places(prepared, wanted)?;
    let least = places.least_record(prepared, wanted);
    Ok(Box::new(PlannedTransient { wanted, places, least }))
}

struct PlannedTransient<'a> {
    wanted: &'a TransientAnalysis,
    places: TransientPlaces,
    least: RecordSize,
}

impl<'a> Planned<'a> for PlannedTransient<'a> {
    fn record_size(&self) -> Option<RecordSize> {
        Some(self.least)
    }

    fn run(self: Box<Self>, run: &mut Run<'a, '_>) -> Result<()> {
        let Run { results, clock, sink, observer, .. } = run;
        let Some((point, complex)) = run.operating_point.clone().zip(results.get::<ComplexResult>()) else {
            return Ok(());
        };
        let in_time = InTime { point: &point, complex, geometry: &results.geometry };
        let found = clock.time(PHASE, || in_time.run(self.wanted, self.places, *sink, *observer))?;
        sink.record(ResultStage::Transient(&found))?;
        results.warnings.extend(found.warnings.iter().cloned());
        results.records.push(found);
        Ok(())
    }
}
