//! The analyses of a case in their order, each result written as soon as it is there.

use super::analyses::{Planned, Selection};
use super::known::KnownAnswers;
#[cfg(feature = "cli")]
use super::operating_point::OperatingPoint;
use super::plausible;
use super::prepared::Prepared;
use super::pressed;
use super::run::Run;
use super::singular::explained;
use super::sink::{Memory, ResultSink, ResultStage};
use crate::equilibrium;
use crate::error::{Fault, Faults, Result};
use crate::progress::Observer;
use crate::results::{RecordSize, RunResults};
use std::rc::Rc;

/// Runs the analyses of a prepared case; `record` is called with each result as soon as it is there.
///
/// # Errors
/// An analysis without an answer, or what `record` returns.
pub fn analyse<'a>(
    prepared: &'a Prepared<'a>,
    selection: Selection,
    record: &mut dyn FnMut(ResultStage) -> Result<()>,
    observer: &dyn Observer,
) -> Result<RunResults> {
    let asked = Asked::new(prepared, selection)?;
    let mut results = RunResults::default();
    let sink = &mut Memory::new(record);
    analyse_from(prepared, asked, &KnownAnswers::default(), sink, &mut results, observer)
        .map_err(|error| explained(prepared, error.while_computing()))?;
    Ok(results)
}

/// Finds every fault that [`run_case`](super::run_case) finds before it computes; gives what the user should know.
///
/// # Errors
/// All of them.
pub fn check_case(prepared: &Prepared) -> Result<CaseWarnings> {
    let asked = Asked::new(prepared, Selection::Listed)?;
    let sentences = prepared.warnings.iter().chain(&asked.warnings).cloned().collect();
    Ok(CaseWarnings { sentences, unlikely: plausible::warnings(prepared) })
}

/// What the user should know of a valid case.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseWarnings {
    /// Sentences about its files and analyses.
    pub sentences: Vec<String>,
    /// Numbers that are hardly meant.
    pub unlikely: Vec<Fault>,
}

impl CaseWarnings {
    /// All of them as sentences.
    pub fn words(&self) -> impl Iterator<Item = String> + '_ {
        self.sentences.iter().cloned().chain(self.unlikely.iter().map(Fault::warning))
    }
}

/// [`analyse`] with answers that are known. What was found before a failure is in `results`.
pub(super) fn analyse_from<'a>(
    prepared: &'a Prepared<'a>,
    asked: Asked<'a>,
    known: &KnownAnswers,
    sink: &mut dyn ResultSink,
    results: &mut RunResults,
    observer: &dyn Observer,
) -> Result<()> {
    let case = prepared.case;
    results.title = case.title.clone();
    results.resolved_case = case.to_toml();
    results.assumptions = case.assumptions.clone();
    results.warnings.extend(prepared.warnings.iter().chain(&asked.warnings).cloned());
    results.warnings.extend(plausible::warnings(prepared).iter().map(Fault::warning));
    results.geometry = prepared.geometry();
    results.size = prepared.size();
    sink.record(ResultStage::Model(results))?;
    let mut run =
        Run::new(prepared, [asked.includes("cea"), asked.left_vectors()], known, sink, results, observer);
    let done = asked.planned.into_iter().try_for_each(|planned| planned.run(&mut run));
    let Run { clock, results, .. } = run;
    results.timings = clock.phases;
    done
}

/// The state about which the complex modes of a case are computed; its sweeps and maps start from it.
#[cfg(feature = "cli")]
pub(super) fn operating_point<'a>(
    prepared: &'a Prepared<'a>,
    asked: Asked<'a>,
    observer: &dyn Observer,
) -> Result<Rc<OperatingPoint<'a>>> {
    let (known, mut results) = (KnownAnswers::default(), RunResults::default());
    let mut nowhere = |_: ResultStage| Ok(());
    let sink = &mut Memory::new(&mut nowhere);
    let mut run = Run::new(prepared, [true, false], &known, sink, &mut results, observer);
    for planned in asked.planned {
        planned.run(&mut run)?;
        if let Some(point) = run.operating_point.take() {
            return Ok(point);
        }
    }
    unreachable!("sweeps and maps need complex modes")
}

/// The analyses that are selected; their input has no fault.
pub(super) struct Asked<'a> {
    selection: Selection,
    prepared: &'a Prepared<'a>,
    planned: Vec<Box<dyn Planned<'a> + 'a>>,
    /// Sentences for the user.
    warnings: Vec<String>,
}

impl<'a> Asked<'a> {
    /// Finds the faults of all that is selected before anything is computed or written.
    pub(super) fn new(prepared: &'a Prepared<'a>, selection: Selection) -> Result<Self> {
        let case = prepared.case;
        let mut faults = Faults::new();
        faults.take(selection.check(case));
        let named = matches!(selection, Selection::Only(_));
        let ready = selection.analyses(case).filter(|analysis| !named || (analysis.ready)(case));
        let planned = ready.filter_map(|analysis| faults.take((analysis.plan)(prepared, selection.scope())));
        let planned: Vec<_> = planned.collect();
        if planned.iter().any(|planned| planned.slides()) {
            faults.take(equilibrium::check(&prepared.system));
            faults.take(pressed::check(prepared));
        }
        if !planned.is_empty() && prepared.system.structure.mass.val().iter().all(|m| *m == 0.0) {
            let expected = "a part with mass: nothing vibrates without";
            let place = match (&case.matrices, case.material.is_empty()) {
                (Some(_), _) => "`matrices.mass`",
                (None, true) => "`mass`",
                (None, false) => "`material`",
            };
            faults.push(Fault::new(place, "no mass", expected));
        }
        // A file that two analyses read has its faults and warnings once.
        let faults = Faults(once(faults.0));
        let warnings = once(planned.iter().flat_map(|planned| planned.warnings()).collect());
        faults.into_result(Asked { selection, prepared, planned, warnings })
    }

    /// Whether the analysis called `name` is run.
    pub(super) fn includes(&self, name: &str) -> bool {
        self.selection.includes(name, self.prepared.case)
    }

    /// Whether an analysis takes the left vectors of the complex modes.
    fn left_vectors(&self) -> bool {
        self.selection.takes_left_vectors(self.prepared.case)
    }

    /// The sizes of the records that are kept on the disk.
    pub(super) fn record_sizes(&self) -> impl Iterator<Item = RecordSize> {
        self.planned.iter().filter_map(|planned| planned.record_size())
    }
}

/// Each item once, in its first place.
fn once<T: PartialEq>(items: Vec<T>) -> Vec<T> {
    let mut all = Vec::new();
    for item in items {
        if !all.contains(&item) {
            all.push(item);
        }
    }
    all
}
