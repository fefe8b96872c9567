//! Parts of a job array: each process computes a share of the points of all sweeps and maps of a case, and one makes the results of
//! a single run of them.

use super::analyse::{Asked, operating_point};
use super::analyses::Selection;
use super::explore::{Explorer, Nominal, Start};
use super::grids::{Grid, grids};
use super::known::{Parts, origin};
use super::memory::check_memory;
use super::prepared::Prepared;
use super::singular::explained;
use crate::case::Case;
use crate::error::{Error, Fault, Result};
use crate::progress::Observer;
use crate::results::record::{Part, PartFile, RecordOrigin, read_parts};
use crate::sweep::Answers;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The folder of the parts in the results folder.
const FOLDER: &str = "parts";
/// Parts that were begun of which a message says how many points they lack.
const SHOWN: usize = 20;

/// A part that has all its points.
#[derive(Debug)]
pub struct PartDone {
    /// Number of its points; none where there are more parts than points.
    pub points: usize,
    /// Its file, which is not there without points.
    pub file: PathBuf,
}

/// Computes the points of a part, apart from those that an earlier, interrupted process computed, and keeps them in a file of the
/// results folder `out`, chunk by chunk; of that folder it writes nothing else. Nothing is written when the input is wrong.
///
/// # Errors
/// Faults of the input, a folder with other parts, an analysis without an answer, a file that cannot be written or that another
/// process uses.
pub fn run_part(case: &Case, part: Part, out: &Path, observer: &dyn Observer) -> Result<PartDone> {
    let own = without_second_opinions(case);
    let prepared = Prepared::new(&own)?;
    let selection = Selection::Only("sweep");
    let asked = Asked::new(&prepared, selection)?;
    check_memory(&prepared, selection)?;
    let (dir, grids) = (out.join(FOLDER), grids(case));
    let mut share = share(&grids, part);
    let points = share.iter().map(|(_, points)| points.len()).sum();
    let done = PartDone { points, file: dir.join(part.file()) };
    if points == 0 {
        return Ok(done);
    }
    let mut file = PartFile::open(&dir, part, origin(case)?)?;
    for (grid, points) in &mut share {
        let known = file.record.answers.get(&grid.name);
        points.retain(|k| known.is_none_or(|known| !known.contains_key(k)));
    }
    share.retain(|(_, points)| !points.is_empty());
    if share.is_empty() {
        return Ok(done);
    }
    let computing = |error: Error| explained(&prepared, error.while_computing());
    let point = operating_point(&prepared, asked, observer).map_err(computing)?;
    let nominal =
        Nominal { prepared: &prepared, system: &point.system, steady: &point.steady, real: &point.real };
    let start = Start::new(&nominal).map_err(computing)?;
    let explorer = Explorer::new(&start, observer).map_err(computing)?;
    file.begin(start.reference.digest())?;
    for (grid, points) in &share {
        let computed = explorer.answers(grid, points, &mut |answers| keep(&mut file, grid, answers));
        file.save()?;
        computed.map_err(computing)?;
    }
    Ok(done)
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

/// Keeps answers. A sweep has no result without one of its points; and that the machine refuses something is no answer.
fn keep(file: &mut PartFile, grid: &Grid, answers: Answers) -> Result<()> {
    let (mut kept, mut refused) = (Answers::new(), None);
    for (k, answer) in answers {
        match answer {
            Err(error) if grid.axes.len() == 1 || matches!(error, Error::Io { .. }) => {
                refused.get_or_insert(error);
            }
            answer => drop(kept.insert(k, answer)),
        }
    }
    file.add(&grid.name, kept)?;
    refused.map_or(Ok(()), Err)
}

/// The points of a part: the points of all grids in their order are dealt out to the parts in turn.
fn share(grids: &[Grid], part: Part) -> Vec<(&Grid, Vec<usize>)> {
    let mut before = 0;
    let own = |grid| {
        let first = before;
        before += Grid::points(grid);
        (grid, (0..Grid::points(grid)).filter(|k| part.has(first + k)).collect())
    };
    grids.iter().map(own).collect()
}

/// The parts in the results folder `out`, which have every point of the sweeps and maps of the case.
///
/// # Errors
/// Input: points that are missing, with the parts that they belong to; parts of another case, or damaged ones.
pub(super) fn collect(case: &Case, out: &Path, origin: &RecordOrigin) -> Result<Parts> {
    let dir = out.join(FOLDER);
    let records = read_parts(&dir, origin)?;
    let Some(of) = records.first().map(|first| first.part.of) else {
        let fault = Fault::new(dir.display().to_string(), "no part", "the files that --part leaves there");
        let help = "Compute every part first, as `stridor sweep CASE --part 1/40` to 40/40";
        return Err(Error::input(fault.with_help(help)));
    };
    let parts = Parts { dir, records };
    complete(&parts, of, &grids(case))?;
    Ok(parts)
}

/// Refuses parts that lack points.
fn complete(parts: &Parts, of: usize, grids: &[Grid]) -> Result<()> {
    // Points of each part, and how many of them are missing.
    let mut count: BTreeMap<usize, [usize; 2]> = BTreeMap::new();
    let mut point = 0;
    for grid in grids {
        let known: BTreeSet<usize> = parts.answers(&grid.name).map(|(k, _)| k).collect();
        for k in 0..grid.points() {
            let [all, missing] = count.entry(point % of + 1).or_default();
            *all += 1;
            *missing += usize::from(!known.contains(&k));
            point += 1;
        }
    }
    let lacking: Vec<(usize, [usize; 2])> =
        count.into_iter().filter(|(_, [_, missing])| *missing > 0).collect();
    if lacking.is_empty() {
        return Ok(());
    }
    let missing: usize = lacking.iter().map(|(_, [_, missing])| missing).sum();
    let begun = |number: &usize| parts.records.iter().any(|part| part.part.number == *number);
    let numbers = |keep: bool| lacking.iter().map(|(number, _)| *number).filter(move |n| begun(n) == keep);
    let mut found = format!("{} of {point} points", point - missing);
    let absent: Vec<usize> = numbers(false).collect();
    if !absent.is_empty() {
        found += &format!("; of {of} parts these are missing: {}", ranges(&absent));
    }
    let unfinished: Vec<String> = lacking
        .iter()
        .filter(|(number, _)| begun(number))
        .map(|(number, [all, missing])| format!("part {number} lacks {missing} of its {all}"))
        .collect();
    if !unfinished.is_empty() {
        let more = unfinished.len().saturating_sub(SHOWN);
        found += &format!("; begun: {}", unfinished[..unfinished.len() - more].join(", "));
        found += &if more > 0 { format!(", and {more} more") } else { String::new() };
    }
    let all: Vec<usize> = lacking.iter().map(|(number, _)| *number).collect();
    let help = format!(
        "Compute {} of {of} with --part; a part that was begun resumes where it stopped",
        ranges(&all)
    );
    let fault = Fault::new(parts.dir.display().to_string(), found, "all points");
    Err(Error::input(fault.with_help(help)))
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
    fn every_point_belongs_to_one_part() {
        let axis = |points| crate::sweep::Axis { from: 0.0, to: 1.0, points, log: false };
        let grid = |name: &str, axes| Grid { name: name.into(), paths: Vec::new(), axes };
        let grids = [grid("sweep.a", vec![axis(5)]), grid("map.b", vec![axis(3), axis(2)])];
        for of in [1, 4, 11, 20] {
            let mut seen = [vec![0; 5], vec![0; 6]];
            for number in 1..=of {
                let share = share(&grids, Part { of, number });
                let count: usize = share.iter().map(|(_, points)| points.len()).sum();
                assert!(count.abs_diff(11 / of) <= 1, "part {number} of {of} has {count} points");
                share
                    .iter()
                    .zip(&mut seen)
                    .for_each(|((_, points), seen)| points.iter().for_each(|k| seen[*k] += 1));
            }
            assert_eq!(seen, [vec![1; 5], vec![1; 6]]);
        }
    }
}
