//! Tables of a run in time whose rows come one after another, described once for `results.h5`, for `transient.csv` and `events.csv`, and
//! for memory.

use super::folder::{own, refusal};
use super::{Channel, MODAL_ABOUT, MODAL_UNIT, RecordPiece, Recording, TIME};
use crate::dataset::{Dimension, Table, Variable, column};
use crate::error::Result;
use crate::transient::Event;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Columns of the tables of a run in time.
#[derive(Debug, Clone, Default)]
pub(crate) struct TransientTables {
    /// Δt \[s\].
    time_step: f64,
    pub(crate) channels: Vec<Channel>,
    /// The name of the pair of every contact point.
    pairs: Vec<String>,
}

impl TransientTables {
    pub(crate) fn new(recording: &Recording) -> Self {
        let channels =
            recording.channels.iter().map(|c| Channel::new(c.name.clone(), c.unit, c.about.clone()));
        TransientTables {
            time_step: recording.time_step,
            channels: channels.collect(),
            pairs: recording.pairs.to_vec(),
        }
    }

    /// A value for each channel at every step, from row `first` on.
    pub(crate) fn history(&self, first: usize, values: &[Vec<f64>]) -> Table<'_> {
        let of = |channel: usize| values.get(channel).cloned().unwrap_or_default();
        let channels = self.channels.iter().enumerate();
        let columns = channels.map(|(k, c)| (c.name.clone(), c.unit, c.about.clone(), of(k)));
        self.steps("history", first, columns.collect())
    }

    /// The acceleration of each real mode at every step, from row `first` on.
    pub(crate) fn modal<V: Copy + Into<f64>>(&self, first: usize, values: &[Vec<V>]) -> Table<'_> {
        let columns = values.iter().enumerate().map(|(mode, all)| {
            let all = all.iter().map(|value| (*value).into()).collect();
            ((mode + 1).to_string(), MODAL_UNIT, MODAL_ABOUT.to_string(), all)
        });
        self.steps("modal_acceleration", first, columns.collect())
    }

    /// The times of `count` rows, from row `first` on.
    pub(crate) fn times(&self, first: usize, count: usize) -> Variable<'static> {
        let times = (first..first + count).map(|row| row as f64 * self.time_step).collect();
        let rows = vec![Dimension::of_variable(TIME, count)];
        Variable::reals(TIME, "s", "time of each step, from the start", rows, times)
    }

    fn steps(
        &self,
        key: &'static str,
        first: usize,
        columns: Vec<(String, &'static str, String, Vec<f64>)>,
    ) -> Table<'_> {
        let rows = Dimension::of_variable(TIME, columns.first().map_or(0, |(.., values)| values.len()));
        let time = self.times(first, rows.length);
        let columns = columns.into_iter().map(|(name, unit, about, values)| {
            Variable::reals(name, unit, about, vec![rows.clone()], values)
        });
        let columns = std::iter::once(time).chain(columns).collect();
        Table::along(key, rows, columns)
    }

    /// What happened at the contact points.
    pub(crate) fn events<'e>(&self, events: &'e [Event]) -> Table<'e> {
        let columns = [
            column(TIME, "s", "when it happened", |event: &Event| event.time),
            column("point", "1", "number of the contact point, from 1", |event: &Event| event.point + 1),
            column("kind", "text", "what it did", |event: &Event| event.kind.name()),
        ];
        Table::by("events", TIME, &columns, events)
    }

    /// The same with the pair of each point, for readers of `events.csv` alone.
    fn events_of_pairs<'e>(&self, events: &'e [Event]) -> Table<'e> {
        let mut table = self.events(events);
        let pairs = events.iter().map(|event| self.pairs.get(event.point).cloned().unwrap_or_default());
        let pair = Variable::texts("pair", "contact pair of the point", table.rows.clone(), pairs.collect());
        table.columns.insert(2, pair);
        table
    }
}

/// `transient.csv`, with a line for every step, and `events.csv`. Whole lines are added, so that they can be watched.
#[derive(Debug)]
pub struct TransientCsv {
    tables: TransientTables,
    history: CsvFile,
    events: CsvFile,
}

impl TransientCsv {
    /// Begins the files in the folder `dir`, in the place of earlier ones.
    ///
    /// # Errors
    /// [`crate::error::Error::Io`], here and later: one of them cannot be written.
    pub fn create(dir: &Path, recording: &Recording) -> Result<Self> {
        let tables = TransientTables::new(recording);
        let history = CsvFile::create(dir, "transient.csv", &tables.history(0, &[]))?;
        let events = CsvFile::create(dir, "events.csv", &tables.events_of_pairs(&[]))?;
        Ok(TransientCsv { tables, history, events })
    }

    /// Adds the rows and events of a piece.
    pub fn append(&mut self, piece: &RecordPiece) -> Result<()> {
        self.history.append(&self.tables.history(piece.first, piece.values))?;
        self.events.append(&self.tables.events_of_pairs(piece.events))
    }
}

/// A CSV file that the rows of a table are added to.
#[derive(Debug)]
struct CsvFile {
    file: File,
    path: PathBuf,
}

impl CsvFile {
    fn create(dir: &Path, name: &str, table: &Table) -> Result<Self> {
        own(dir, name)?;
        let path = dir.join(name);
        let file = File::create(&path).map_err(|source| refusal(&path, source))?;
        let mut lines = CsvFile { file, path };
        lines.write(&table.to_csv())?;
        Ok(lines)
    }

    fn append(&mut self, table: &Table) -> Result<()> {
        let text = table.to_csv();
        self.write(text.split_once('\n').map_or("", |(_, rows)| rows))
    }

    fn write(&mut self, text: &str) -> Result<()> {
        self.file.write_all(text.as_bytes()).map_err(|source| refusal(&self.path, source))
    }
}
