//! `transient.csv`, which grows while the run goes on.

use super::csv::{Table, number};
use super::folder::refusal;
use super::{Channel, Recording};
use crate::error::Result;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// A table with a line for every step. Whole lines are added, so that it can be watched.
#[derive(Debug)]
pub struct HistoryTable {
    file: File,
    path: PathBuf,
    /// Δt \[s\].
    time_step: f64,
}

impl HistoryTable {
    /// Begins `transient.csv` in the folder `dir`, in the place of an earlier one.
    ///
    /// # Errors
    /// [`crate::error::Error::Io`], here and later, when the machine refuses.
    pub fn create(dir: &Path, recording: &Recording) -> Result<Self> {
        let path = dir.join("transient.csv");
        let file = File::create(&path).map_err(|source| refusal(&path, source))?;
        let mut table = HistoryTable { file, path, time_step: recording.time_step };
        let named: Vec<String> = recording.channels.iter().map(Channel::heading).collect();
        let headings = std::iter::once("time [s]").chain(named.iter().map(String::as_str));
        table.write(&Table::new(&headings.collect::<Vec<&str>>()).text)?;
        Ok(table)
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
        self.write(&text)
    }

    fn write(&mut self, text: &str) -> Result<()> {
        self.file.write_all(text.as_bytes()).map_err(|source| refusal(&self.path, source))
    }
}
