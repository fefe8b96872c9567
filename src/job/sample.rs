//! The results of a small rig with every analysis (`tests/data/small-rig`), computed once in a process, for the tests of the files
//! and of the report.

use super::{Prepared, Selection, analyse};
use crate::case::read_case;
use crate::results::record::InputFile;
use crate::results::*;
use std::path::Path;
use std::sync::OnceLock;

/// New records, equal to those of some types of a run.
macro_rules! copied {
    ($run:expr, $($record:ty),+) => {{
        let mut records = Records::default();
        $($run.all::<$record>().into_iter().for_each(|record| records.push(record.clone()));)+
        records
    }};
}

/// The whole run.
pub(crate) fn rig() -> RunResults {
    static RUN: OnceLock<RunResults> = OnceLock::new();
    let run = RUN.get_or_init(|| {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/small-rig/case.toml");
        let case = read_case(&file).expect("the case is valid");
        let prepared = Prepared::new(&case).expect("the model is valid");
        analyse(&prepared, Selection::Listed, &mut |_| Ok(()), &()).expect("every analysis has an answer")
    });
    RunResults {
        title: run.title.clone(),
        resolved_case: run.resolved_case.clone(),
        assumptions: run.assumptions.clone(),
        warnings: run.warnings.clone(),
        geometry: run.geometry.clone(),
        size: run.size,
        records: copied!(
            run,
            NamedModes,
            MeasuredComparison,
            MeasuredResponses,
            FrfResult,
            SteadyResult,
            ComplexResult,
            SensitivityResult,
            TransientResult,
            SweepResult,
            MapResult,
            DampingVerdicts,
            UncertaintyResult,
            CalibrationResult
        ),
        timings: run.timings.clone(),
        inputs: vec![InputFile::of_text("rig.msh", "")],
        provenance: Some(Provenance {
            commit: "unknown",
            command: ["stridor", "run", "rig.toml"].map(String::from).to_vec(),
            ..Provenance::now("rig.toml", "title = \"<written by hand>\"\n")
        }),
        failed: None,
    }
}
