//! `search.csv`: every evaluation, so that an interrupted search resumes where it stopped.

use super::facts::Facts;
use super::file::SearchFile;
use crate::dataset::CsvTable;
use crate::error::text::printable;
use crate::error::{Error, Fault, Result};
use crate::results::record::{self, RecordOrigin};
use crate::results::{retire, write_result};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

const NAME: &str = "search.csv";

/// The evaluations of a search.
pub(super) struct Log {
    dir: PathBuf,
    heading: String,
    facts: usize,
    /// Origin of the evaluations.
    origin: RecordOrigin,
    /// Files that the search reads, which may be in its folder.
    read: Vec<PathBuf>,
    kept: Mutex<KnownEvaluations>,
}

#[derive(Default)]
struct KnownEvaluations {
    /// All that is known, by the values of the numbers; of an earlier run also what this one has not come to yet.
    known: BTreeMap<Vec<u64>, LoggedEvaluation>,
    /// The values that this run has come to.
    seen: BTreeSet<Vec<u64>>,
    /// Rows in the order of the search.
    rows: Vec<LoggedEvaluation>,
    /// Rows of this generation, in the order in which the threads came.
    fresh: Vec<LoggedEvaluation>,
    /// Whether the files of an earlier search are gone.
    alone: bool,
}

#[derive(Clone)]
struct LoggedEvaluation {
    values: Vec<f64>,
    cost: f64,
    computed: Vec<f64>,
}

impl Log {
    /// An empty log, or that of an earlier run of the same search in `dir`.
    /// Refuses a log of another search or of other files, and one that cannot be read.
    pub(super) fn open(dir: &Path, file: &SearchFile, resume: bool) -> Result<Log> {
        let numbers = file.parameters.keys().map(|name| printable(name));
        let facts = file.checks.iter().map(|check| printable(&check.quantity));
        let heading: Vec<String> = ["cost".to_string()].into_iter().chain(numbers).chain(facts).collect();
        let mut table = CsvTable::default();
        table.row(&heading);
        let log = Log {
            dir: dir.to_path_buf(),
            heading: table.text.trim_end_matches('\n').to_string(),
            facts: file.checks.len(),
            origin: file.origin()?,
            read: file.files(),
            kept: Mutex::default(),
        };
        let path = dir.join(NAME);
        if resume && path.exists() {
            record::check_origin(dir, &log.origin)?;
            let text = std::fs::read_to_string(&path)
                .map_err(|error| Error::io(&path, error, "Search without --resume"))?;
            log.read(&text, &path, file.parameters.len())?;
        }
        Ok(log)
    }

    fn read(&self, text: &str, path: &Path, numbers: usize) -> Result<()> {
        let fault = |line: usize, found: &str, expected: &str| {
            let place = format!("{}:{line}", path.display());
            Error::input(Fault::new(place, found, expected).with_help("Search without --resume"))
        };
        let mut lines = text.lines();
        if lines.next() != Some(self.heading.as_str()) {
            return Err(fault(1, "the columns of another search", &format!("`{}`", self.heading)));
        }
        let mut kept = self.kept.lock().expect("no thread panics here");
        for (k, line) in lines.enumerate() {
            let cells: std::result::Result<Vec<f64>, _> =
                line.split(',').filter(|cell| !cell.is_empty()).map(str::parse).collect();
            let cells = cells.map_err(|_| fault(k + 2, "a cell that is no number", "numbers"))?;
            if cells.len() != 1 + numbers && cells.len() != 1 + numbers + self.facts {
                return Err(fault(
                    k + 2,
                    &format!("{} cells", cells.len()),
                    "a cost, numbers, and facts or none",
                ));
            }
            let (values, computed) = cells[1..].split_at(numbers);
            let row =
                LoggedEvaluation { values: values.to_vec(), cost: cells[0], computed: computed.to_vec() };
            kept.known.insert(key(values), row);
        }
        Ok(())
    }

    /// Values computed at these parameters.
    pub(super) fn find(&self, values: &[f64]) -> Option<Vec<f64>> {
        self.kept
            .lock()
            .expect("no thread panics here")
            .known
            .get(&key(values))
            .map(|row| row.computed.clone())
    }

    /// Keeps an evaluation until [`Log::flush`].
    pub(super) fn keep(&self, values: &[f64], facts: &Facts) {
        let mut kept = self.kept.lock().expect("no thread panics here");
        let row =
            LoggedEvaluation { values: values.to_vec(), cost: facts.cost, computed: facts.computed.clone() };
        if kept.seen.insert(key(values)) {
            kept.known.insert(key(values), row.clone());
            kept.fresh.push(row);
        }
    }

    /// Writes all, those since the last time in the order of their cost.
    pub(super) fn flush(&self) -> Result<()> {
        let mut kept = self.kept.lock().expect("no thread panics here");
        if !kept.alone {
            retire(&self.dir, &[&self.read[..], &[NAME.into()]].concat())?;
            record::keep_origin(&self.dir, &self.origin, false)?;
            kept.alone = true;
        }
        let mut fresh = std::mem::take(&mut kept.fresh);
        fresh.sort_by(|a, b| a.cost.total_cmp(&b.cost).then_with(|| key(&a.values).cmp(&key(&b.values))));
        kept.rows.extend(fresh);
        let mut text = self.heading.clone() + "\n";
        let ahead = kept.known.iter().filter(|(values, _)| !kept.seen.contains(*values)).map(|(_, row)| row);
        for row in kept.rows.iter().chain(ahead) {
            let cells =
                std::iter::once(&row.cost).chain(&row.values).chain(&row.computed).map(f64::to_string);
            text += &(cells.collect::<Vec<_>>().join(",") + "\n");
        }
        write_result(&self.dir, NAME, text.as_bytes())
    }

    /// Says that the search has ended, so that a later one may take its place.
    pub(super) fn end(&self) -> Result<()> {
        record::keep_origin(&self.dir, &self.origin, true)
    }

    /// The cost of every evaluation, in their order.
    pub(super) fn costs(&self) -> Vec<f64> {
        self.kept.lock().expect("no thread panics here").rows.iter().map(|row| row.cost).collect()
    }

    /// How many evaluations had no answer.
    pub(super) fn without_answer(&self) -> usize {
        let kept = self.kept.lock().expect("no thread panics here");
        kept.rows.iter().filter(|row| row.computed.is_empty()).count()
    }
}

fn key(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}
