//! A case run into a results folder, which can be resumed when it was interrupted.

use super::analyse::{Asked, analyse_from};
use super::analyses::{PHASE, Selection};
use super::checks::results_hold;
use super::folder::Folder;
use super::known::{KnownAnswers, origin};
use super::memory::check_memory;
use super::parts::collect;
use super::prepared::Prepared;
use super::singular::explained;
use crate::case::Case;
use crate::error::{Error, Fault, Result};
use crate::linalg::Engine;
use crate::linalg::factor::engine_names;
use crate::progress::Observer;
use crate::results::record::{Record, RecordOrigin};
use crate::results::{self, FieldsFile, FolderLock, Provenance, ResultsFile, RunResults, fits_on_disk};
use std::path::Path;
use std::time::Instant;

/// How a case is run.
#[derive(Debug, Clone, Default)]
pub struct RunOptions {
    /// Whether an interrupted run is resumed.
    pub resume: bool,
    /// Where matrices are factorised.
    pub engine: Engine,
}

/// Runs the analyses of a case and writes the results folder `out`; nothing is written when the input is wrong.
///
/// With [`RunOptions::resume`] the studies and the run in time that an earlier run of the same case left in `out` are resumed where it
/// stopped; the result is the same, bit for bit. Results of another case or of other files are refused. Without it an
/// interrupted record is moved to a folder of its own in `out`; the files of a run that had ended are replaced.
///
/// When an analysis has no answer, the results of those before are written and the failure is named in them.
///
/// # Errors
/// Faults of the input, an analysis without an answer, a folder that cannot be written or that another process uses.
pub fn run_case(
    case: &Case,
    selection: Selection,
    out: &Path,
    options: &RunOptions,
    observer: &dyn Observer,
) -> Result<RunResults> {
    let begin = if options.resume { Begin::Resumed } else { Begin::Anew };
    run_from(case, selection, out, (begin, &options.engine), observer)
}

/// Makes the results of `analysis` (`sweep`, `uncertainty`) in the folder `out` of the parts there, which so many `ranks` have computed
/// ([`run_parts`](super::run_parts)), or a job array ([`run_part`](super::run_part)): those of one process, bit for bit.
///
/// # Errors
/// As [`run_case`]; parts that do not have all points, of another case, of other files, or damaged ones.
pub fn merge_parts(
    case: &Case,
    analysis: &'static str,
    out: &Path,
    ranks: Option<usize>,
    observer: &dyn Observer,
) -> Result<RunResults> {
    let begin = Begin::Merged { analysis, ranks };
    run_from(case, Selection::Only(analysis), out, (begin, &Engine::default()), observer)
}

/// What a run begins with.
#[derive(Clone, Copy, PartialEq)]
enum Begin {
    /// Nothing.
    Anew,
    /// The record of an interrupted run.
    Resumed,
    /// The parts of an analysis that so many ranks have computed, or a job array.
    Merged { analysis: &'static str, ranks: Option<usize> },
}

fn run_from(
    case: &Case,
    selection: Selection,
    out: &Path,
    (begin, engine): (Begin, &Engine),
    observer: &dyn Observer,
) -> Result<RunResults> {
    let started = Instant::now();
    let (file, text) = case.places.source();
    let (engine_name, ranks) = match begin {
        Begin::Merged { ranks: Some(ranks), .. } => (engine_names::MPI, ranks),
        _ => (engine.name(), engine.ranks()),
    };
    let provenance = Some(Provenance::now(file, text).on_ranks(engine_name, ranks));
    let prepared = Prepared::new(case)?.with_engine(engine);
    engine.check_order(prepared.system.n_dofs())?;
    // Its faults are reported before anything is written.
    let asked = Asked::new(&prepared, selection)?;
    if let Some(expected) = check_memory(&prepared, selection)? {
        observer.begin(&format!("memory: about {}", expected.words()), None);
        observer.end();
    }
    asked.record_sizes().try_for_each(|size| fits_on_disk(out, &size))?;
    let origin = origin(case)?;
    let parts = match begin {
        Begin::Merged { analysis, .. } => collect(case, analysis, out, &origin)?,
        Begin::Anew | Begin::Resumed => Vec::new(),
    };
    let _lock = FolderLock::take(out)?;
    let mut results = RunResults { inputs: origin.inputs.clone(), provenance, ..RunResults::default() };
    let record = &match begin {
        Begin::Resumed => resumed(out, origin, &asked)?,
        Begin::Anew | Begin::Merged { .. } => {
            results.warnings.extend(moved_aside(out, observer)?);
            Record::new(out, origin)
        }
    };
    let known = KnownAnswers { own: Some(record), parts };
    let mut file = ResultsFile::create(out)?;
    let read = case.files().into_iter().chain(["calibrated.toml".into()]).map(|name| case.folder.join(name));
    file.spare(read.filter_map(|path| std::path::absolute(path).ok()));
    if begin == Begin::Resumed {
        file.spare(Record::files());
    }
    let preparation = started.elapsed().as_secs_f64();
    let mut folder = Folder::new(out, file, record);
    let done = analyse_from(&prepared, asked, &known, &mut folder, &mut results, observer)
        // What other runs left, and does not fit, is input.
        .map_err(|error| if begin == Begin::Anew { error.while_computing() } else { error })
        .map_err(|error| explained(&prepared, error));
    let failure = match done {
        Ok(()) => results_hold(&results).err(),
        Err(failure @ Error::Analysis { .. }) => Some(failure),
        Err(Error::Input(faults)) => {
            folder.file.discard();
            return Err(Error::Input(faults));
        }
        Err(refused) => return Err(refused),
    };
    results.failed = failure.as_ref().map(Error::to_string);
    results.timings.insert(0, ("read mesh and assemble".into(), preparation));
    write_results(out, folder, &mut results)?;
    record.end()?;
    match failure {
        Some(failure) => Err(failure),
        None => Ok(results),
    }
}

/// Record of an earlier run to resume from.
fn resumed(out: &Path, origin: RecordOrigin, asked: &Asked) -> Result<Record> {
    let record = Record::resume(out, origin)?;
    let left_out = [
        (record.in_time().rows > 0, "a run in time", "transient"),
        (record.has_study("sweep."), "sweeps", "sweep"),
        (record.has_study("map."), "maps", "sweep"),
        (record.has_study("uncertainty."), "samples", "uncertainty"),
    ];
    let lost = left_out.into_iter().find(|(there, _, analysis)| *there && !asked.includes(analysis));
    if let Some((_, what, analysis)) = lost.filter(|_| !record.ended()) {
        let found = format!("an interrupted record of {what}");
        let expected = format!("`stridor {analysis}` or `stridor run` to resume it");
        let fault = Fault::new(out.display().to_string(), found, expected);
        let help = "Use that command, or run without --resume (the record is kept aside)";
        return Err(Error::input(fault.with_help(help)));
    }
    Ok(record)
}

/// Keeps an interrupted record aside and says so.
fn moved_aside(out: &Path, observer: &dyn Observer) -> Result<Option<String>> {
    let sentence = results::set_aside(out)?.map(|aside| {
        format!(
            "The folder had the record of an interrupted run. It was moved to {}; --resume with --out of that folder resumes it",
            aside.display()
        )
    });
    sentence.iter().for_each(|sentence| observer.note(sentence));
    Ok(sentence)
}

/// Writes all that is written at the end.
fn write_results(out: &Path, folder: Folder, results: &mut RunResults) -> Result<()> {
    // The time of a phase is that of computing.
    let in_time = results.timings.iter_mut().find(|(phase, _)| phase == PHASE);
    in_time.into_iter().for_each(|(_, seconds)| *seconds -= folder.seconds_in_time);
    let Folder { mut file, fields, seconds: recording, .. } = folder;
    let writing = Instant::now();
    fields.map_or(Ok(()), FieldsFile::finish)?;
    file.stand_alone()?;
    results::write_files(out, results)?;
    crate::report::write_report(out, results)?;
    results.timings.push(("write results".into(), recording + writing.elapsed().as_secs_f64()));
    file.finish(results)
}
