//! Parts of a job array: each process computes a block of every study of a case (of its sweeps and maps, or of its samples), and one
//! makes the results of a single run of all of them.

use super::analyse::{Asked, operating_point};
use super::analyses::Selection;
use super::explore::Explorer;
use super::known::{KnownAnswers, origin};
use super::memory::check_memory;
use super::prepared::Prepared;
use super::singular::explained;
use super::states::Start;
use super::studies::{Study, studies};
use super::study_solver::StudySolver;
use crate::case::Case;
use crate::error::{Error, Fault, Result};
use crate::progress::Observer;
use crate::results::record::{Part, Record, RecordOrigin, read_parts};
use crate::sweep::{Block, bits};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The folder of the parts of an analysis in the results folder `out`.
pub fn parts_folder(out: &Path, analysis: &str) -> PathBuf {
    out.join("parts").join(analysis)
}

/// Parts that were begun of which a message says how many points they lack.
const SHOWN: usize = 20;

/// A part that is done.
#[derive(Debug)]
pub struct PartDone {
    /// Number of its points; none where the studies cannot be cut into so many parts.
    pub points: usize,
    /// Its file, which is not there without points.
    pub file: PathBuf,
}

/// Computes a part of `analysis` (`sweep`, `uncertainty`), apart from what an earlier, interrupted process computed of it, and keeps its
/// answers in a file of the results folder `out` as soon as they are there; of that folder it writes nothing else. Nothing is written
/// when the input is wrong.
///
/// A place without an answer is kept as such: the merge has the same error there as a whole run.
///
/// # Errors
/// Faults of the input, a folder with other parts, a case without complex modes, a file that cannot be written or that another process
/// uses.
pub fn run_part(
    case: &Case,
    analysis: &'static str,
    part: Part,
    out: &Path,
    observer: &dyn Observer,
) -> Result<PartDone> {
    let mut number = Some(part.number);
    let done = run_parts((case, analysis), part.of, &mut || Ok(number.take()), out, observer)?;
    Ok(done.into_iter().next().expect("one number was given"))
}

/// [`run_part`] of several parts of `of` of an analysis: `next` gives their numbers, until it has none. What all share is computed once.
///
/// # Errors
/// As [`run_part`]; those of `next`.
pub fn run_parts(
    (case, analysis): (&Case, &'static str),
    of: usize,
    next: &mut dyn FnMut() -> Result<Option<usize>>,
    out: &Path,
    observer: &dyn Observer,
) -> Result<Vec<PartDone>> {
    let own = without_second_opinions(case);
    let prepared = Prepared::new(&own)?;
    let selection = Selection::Only(analysis);
    let asked = Asked::new(&prepared, selection)?;
    check_memory(&prepared, selection)?;
    let (dir, studies, origin) = (parts_folder(out, analysis), studies(case, analysis), origin(case)?);
    let (shares, mut done) = (shares(&studies, of), Vec::new());
    // The next part that is not done yet.
    let mut open = |done: &mut Vec<PartDone>| -> Result<Option<(Share<'_>, Part, Record)>> {
        while let Some(number) = next()? {
            let part = Part { of, number };
            let share: Share = shares.iter().filter(|(own, ..)| *own == number).collect();
            let points = share.iter().map(|(_, study, block)| study.points_of(block).len()).sum();
            done.push(PartDone { points, file: dir.join(part.file()) });
            if points == 0 {
                continue;
            }
            let record = Record::open_part(&dir, part, &origin)?;
            if !record.ended() {
                return Ok(Some((share, part, record)));
            }
        }
        Ok(None)
    };
    let Some(mut work) = open(&mut done)? else { return Ok(done) };
    let computing = |error: Error| explained(&prepared, error.while_computing());
    let point = operating_point(&prepared, asked, observer).map_err(computing)?;
    let start = Start::new(&point).map_err(computing)?;
    let none = KnownAnswers::default();
    let explorer = Explorer::new(&start, &none, observer).map_err(computing)?;
    let mut solvers = Solvers { explorer: &explorer, last: None };
    loop {
        let (share, part, record) = work;
        record.begin_part(part, start.reference.digest())?;
        compute(&mut solvers, &share, &record, observer)?;
        let Some(next) = open(&mut done)? else { return Ok(done) };
        work = next;
    }
}

/// The blocks of a part.
type Share<'a> = Vec<&'a (usize, &'a Study, Block)>;

/// Computes blocks of studies and keeps their answers in the record of their part, which is then done.
fn compute<'s>(
    solvers: &mut Solvers<'s>,
    share: &[&(usize, &'s Study, Block)],
    record: &Record,
    observer: &dyn Observer,
) -> Result<()> {
    let known = KnownAnswers { own: Some(record), parts: Vec::new() };
    for (_, study, block) in share {
        let store = known.of(&study.name, 0);
        match solvers.of(study).and_then(|solver| solver.solve(block, &store, observer)) {
            Err(refused @ Error::Io { .. }) => return Err(refused),
            Err(error) => {
                observer.note(&format!("No answer in [{}], as the merge will say: {error}", study.name))
            }
            Ok(()) => {}
        }
    }
    record.end()
}

/// Solvers of studies. The last one is kept, as the next part may begin with its study; two would take twice the memory.
struct Solvers<'s> {
    explorer: &'s Explorer<'s>,
    last: Option<(&'s str, StudySolver<'s>)>,
}

impl<'s> Solvers<'s> {
    fn of(&mut self, study: &'s Study) -> Result<&StudySolver<'s>> {
        if self.last.as_ref().is_none_or(|(name, _)| *name != study.name) {
            self.last = None;
            self.last = Some((&study.name, self.explorer.solver(study)?));
        }
        Ok(&self.last.as_ref().expect("a solver that was made").1)
    }
}

/// The case without what is computed to confirm its complex modes.
fn without_second_opinions(case: &Case) -> Case {
    let mut own = case.clone();
    if let Some(cea) = &mut own.cea {
        cea.confirm = false;
        // The modes nearest to a frequency decide which real modes are computed.
        if cea.nearest.is_none() {
            cea.certify = Some(false);
        }
    }
    own
}

/// The blocks of all studies, each with the number of its part: dealt out in turn.
fn shares(studies: &[Study], of: usize) -> Vec<(usize, &Study, Block)> {
    let all = studies.iter().flat_map(|study| study.blocks(of).into_iter().map(move |block| (study, block)));
    all.enumerate().map(|(k, (study, block))| (k % of + 1, study, block)).collect()
}

/// The parts of `analysis` in the results folder `out`, which together are whole. Refuses parts that are missing, not done, of
/// another case, or damaged.
pub(super) fn collect(case: &Case, analysis: &str, out: &Path, origin: &RecordOrigin) -> Result<Vec<Record>> {
    let dir = parts_folder(out, analysis);
    let records = read_parts(&dir, origin)?;
    let Some(of) = records.first().and_then(Record::part).map(|first| first.of) else {
        let fault = Fault::new(dir.display().to_string(), "no part", "the files that --part leaves there");
        let help = format!("Compute every part first, as `stridor {analysis} CASE --part 1/40` to 40/40");
        return Err(Error::input(fault.with_help(help)));
    };
    complete(&dir, &records, of, &studies(case, analysis))?;
    Ok(records)
}

/// Refuses parts that are missing or not done.
fn complete(dir: &Path, records: &[Record], of: usize, studies: &[Study]) -> Result<()> {
    let shares = shares(studies, of);
    let record = |number: usize| records.iter().find(|record| record.part() == Some(Part { of, number }));
    let numbers: BTreeSet<usize> = shares.iter().map(|(number, ..)| *number).collect();
    let (begun, absent): (Vec<usize>, Vec<usize>) = numbers
        .into_iter()
        .filter(|number| record(*number).is_none_or(|record| !record.ended()))
        .partition(|number| record(*number).is_some());
    if begun.is_empty() && absent.is_empty() {
        return Ok(());
    }
    // Points of a part, and those that it has.
    let count = |number: usize| {
        let (mut all, mut there) = (0, 0);
        for (_, study, block) in shares.iter().filter(|(own, ..)| *own == number) {
            let points = study.points_of(block);
            let known = |k: &&usize| {
                record(number).is_some_and(|record| record.has(&study.name, &bits(&study.place(**k))))
            };
            (all, there) = (all + points.len(), there + points.iter().filter(known).count());
        }
        (all, there)
    };
    let lacks = |number: &usize| match count(*number) {
        (all, there) if there < all => format!("part {number} lacks {} of its {all} points", all - there),
        _ => format!("part {number} lacks places between its points"),
    };
    let mut found = Vec::new();
    if !absent.is_empty() {
        found.push(format!("of {of} parts these are missing: {}", ranges(&absent)));
    }
    if !begun.is_empty() {
        let more = begun.len().saturating_sub(SHOWN);
        let shown = begun[..begun.len() - more].iter().map(lacks).collect::<Vec<_>>().join(", ");
        let more = if more > 0 { format!(", and {more} more") } else { String::new() };
        found.push(format!("not done: {shown}{more}"));
    }
    let all: Vec<usize> = begun.into_iter().chain(absent).collect::<BTreeSet<_>>().into_iter().collect();
    let help = format!(
        "Compute {} of {of} with --part; a part that was begun resumes where it stopped",
        ranges(&all)
    );
    let fault = Fault::new(dir.display().to_string(), found.join("; "), "all parts, each done");
    Err(Error::input(fault.with_help(help)))
}

/// How many parts the studies of `analysis` are cut into in the results folder `out`, and the numbers of those that are done; none where
/// there are no parts.
///
/// # Errors
/// Every fault that [`run_parts`] finds before it computes; parts of another case, or damaged ones.
pub fn parts_done(
    case: &Case,
    analysis: &'static str,
    out: &Path,
) -> Result<Option<(usize, BTreeSet<usize>)>> {
    Asked::new(&Prepared::new(case)?, Selection::Only(analysis))?;
    let records = read_parts(&parts_folder(out, analysis), &origin(case)?)?;
    let done = records.iter().filter(|record| record.ended()).filter_map(Record::part);
    let numbers = done.map(|part| part.number).collect();
    Ok(records.first().and_then(Record::part).map(|first| (first.of, numbers)))
}

/// Ascending numbers as job arrays take them: `2,5-7`.
fn ranges(numbers: &[usize]) -> String {
    let chunks = numbers.chunk_by(|a, b| a + 1 == *b);
    let words = chunks.map(|chunk| match chunk {
        [one] => one.to_string(),
        more => format!("{}-{}", more[0], more[more.len() - 1]),
    });
    words.collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_given_as_job_arrays_take_them() {
        assert_eq!(ranges(&[2, 5, 6, 7, 9, 10]), "2,5-7,9-10");
        assert_eq!(ranges(&[1]), "1");
    }

    #[test]
    fn the_blocks_are_dealt_out_in_turn() {
        let axis = |points| crate::sweep::Axis { from: 0.0, to: 1.0, points, log: false };
        let grid = |name: &str, axes| Study {
            name: name.into(),
            paths: Vec::new(),
            bounds: Vec::new(),
            points: crate::job::studies::Points::Grid(axes),
        };
        let studies = [grid("sweep.a", vec![axis(4)]), grid("map.b", vec![axis(3), axis(2)])];
        // Three intervals and two cells.
        let numbers = |of| shares(&studies, of).iter().map(|(number, ..)| *number).collect::<Vec<_>>();
        assert_eq!(numbers(1), [1, 1]);
        assert_eq!(numbers(2), [1, 2, 1, 2]);
        assert_eq!(numbers(5), [1, 2, 3, 4, 5]);
        assert_eq!(numbers(9), [1, 2, 3, 4, 5]);
    }
}
