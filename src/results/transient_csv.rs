//! `transient.csv` and `events.csv`, which grow during the run.

use super::folder::{own, refusal};
use super::{Channel, Recording, TIME};
use crate::dataset::{CsvTable as Table, number};
use crate::error::Result;
use crate::transient::Event;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// A table with a line for every step. Whole lines are added, so that it can be watched.
#[derive(Debug)]
pub struct HistoryTable {
    lines: CsvFile,
    /// Δt \[s\].
    time_step: f64,
}

impl HistoryTable {
    /// Begins `transient.csv` in the folder `dir`, in the place of an earlier one.
    ///
    /// # Errors
    /// [`crate::error::Error::Io`], here and later, when the machine refuses.
    pub fn create(dir: &Path, recording: &Recording) -> Result<Self> {
        let channels = recording.channels.iter().map(Channel::title);
        let titles: Vec<String> = std::iter::once(TIME.into()).chain(channels).collect();
        let lines = CsvFile::create(dir, "transient.csv", &titles)?;
        Ok(HistoryTable { lines, time_step: recording.time_step })
    }

    /// Adds rows, the first of which is row `first`, from the values of each channel.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn append(&mut self, first: usize, values: &[Vec<f64>]) -> Result<()> {
        let mut text = String::new();
        for k in 0..values.first().map_or(0, Vec::len) {
            text.push_str(&number((first + k) as f64 * self.time_step));
            for channel in values {
                text.push(',');
                text.push_str(&number(channel[k]));
            }
            text.push('\n');
        }
        self.lines.write(&text)
    }
}

/// A table with a line for everything that happens at a contact point.
#[derive(Debug)]
pub struct EventTable {
    lines: CsvFile,
    /// The name of the pair of every contact point.
    pairs: Vec<String>,
}

impl EventTable {
    /// Begins `events.csv` in the folder `dir`, in the place of an earlier one.
    ///
    /// # Errors
    /// [`crate::error::Error::Io`], here and later, when the machine refuses.
    pub fn create(dir: &Path, recording: &Recording) -> Result<Self> {
        let lines = CsvFile::create(dir, "events.csv", &[TIME, "point", "pair", "kind"])?;
        Ok(EventTable { lines, pairs: recording.pairs.to_vec() })
    }

    /// Adds events.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn append(&mut self, events: &[Event]) -> Result<()> {
        let mut table = Table::default();
        for Event { time, point, kind } in events {
            let pair = self.pairs.get(*point).cloned().unwrap_or_default();
            table.row(&[number(*time), (point + 1).to_string(), pair, kind.name().to_string()]);
        }
        self.lines.write(&table.text)
    }
}

/// A file that whole lines are added to.
#[derive(Debug)]
struct CsvFile {
    file: File,
    path: PathBuf,
}

impl CsvFile {
    fn create(dir: &Path, name: &str, titles: &[impl AsRef<str>]) -> Result<Self> {
        own(dir, name)?;
        let path = dir.join(name);
        let file = File::create(&path).map_err(|source| refusal(&path, source))?;
        let mut lines = CsvFile { file, path };
        lines.write(&Table::new(titles).text)?;
        Ok(lines)
    }

    fn write(&mut self, text: &str) -> Result<()> {
        self.file.write_all(text.as_bytes()).map_err(|source| refusal(&self.path, source))
    }
}
