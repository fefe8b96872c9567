//! Motion in time from steady sliding.

use super::analysis::{Analysis, Planned, Scope};
use crate::case::{CONTACT_TOLERANCE, TransientAnalysis};
use crate::equilibrium::FEW_POINTS;
use crate::error::Result;
use crate::job::prepared::Prepared;
use crate::job::run::Run;
use crate::job::sink::ResultStage;
use crate::job::transient::{InTime, TransientPlaces, places};
use crate::reduction::has_many_points;
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
    let warnings = without_effect(wanted, has_many_points(&prepared.system)).into_iter().collect();
    Ok(Box::new(PlannedTransient { wanted, places, least, warnings }))
}

/// Says that a tolerance of reduced contacts is given where contacts are not reduced.
fn without_effect(wanted: &TransientAnalysis, many_points: bool) -> Option<String> {
    let cause = match (many_points, wanted.is_reduced(many_points)) {
        (true, true) => return None,
        (true, false) => "the full model moves (`transient.model`)".to_string(),
        (false, _) => format!("contacts of up to {FEW_POINTS} points are in every model point by point"),
    };
    let tolerance = wanted.contact_tolerance;
    (tolerance != CONTACT_TOLERANCE)
        .then(|| format!("`transient.contact_tolerance` = {tolerance} has no effect: {cause}"))
}

struct PlannedTransient<'a> {
    wanted: &'a TransientAnalysis,
    places: TransientPlaces,
    least: RecordSize,
    warnings: Vec<String>,
}

impl<'a> Planned<'a> for PlannedTransient<'a> {
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

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

#[cfg(test)]
mod tests {
    use crate::case::Case;
    use crate::job::{Prepared, check_case};
    use std::path::Path;

    /// The solid brake in time, with changes.
    fn checked(changes: &[(&str, &str)], more: &str) -> Result<Vec<String>, String> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/solid-brake");
        let mut text = std::fs::read_to_string(folder.join("case.toml")).unwrap();
        changes.iter().for_each(|(from, to)| text = text.replace(from, to));
        text += &format!("\n[transient]\nduration = \"1 ms\"\ntime_step = \"1 us\"\n{more}");
        let case = Case::parse("case.toml", &text, folder).unwrap();
        let prepared = Prepared::new(&case).unwrap();
        check_case(&prepared)
            .map(|warnings| warnings.words().collect())
            .map_err(|error| case.places.locate(error).to_string())
    }

    #[test]
    fn loss_factors_are_named_at_their_materials() {
        let error = checked(&[], "").unwrap_err();
        assert!(error.contains("case.toml:") && error.contains("`material.lining.loss_factor`"), "{error}");
    }

    #[test]
    fn a_tolerance_without_effect_is_named() {
        let damped = [("loss_factor = 0.02", "rayleigh = { beta = \"1 us\" }")];
        let said = |more: &str| {
            let warnings = checked(&damped, more).unwrap();
            warnings.iter().any(|words| words.contains("`transient.contact_tolerance` = 0.05 has no effect"))
        };
        assert!(!said("") && said("contact_tolerance = 0.05\n"));
    }
}
