//! Result sinks take results as soon as they are there; the one here keeps them in memory.

use crate::dataset::{Describe, Group};
use crate::error::Result;
use crate::results::{
    FieldSnapshot, MapResult, RecordPiece, RecordSize, Recording, RunResults, TransientResult,
    TransientTables, fits_in_memory, modal_channel,
};
use crate::sweep::MapPoint;
use crate::transient::{Checkpoint, Event};
use std::ops::Range;

/// A result that is ready to be written.
pub enum ResultStage<'a> {
    /// The case, its size and its geometry.
    Model(&'a RunResults),
    /// Complete results of an analysis.
    Found(&'a dyn Describe),
    /// A study begins that takes long.
    StudyBegins,
    /// A map without points, and the places on which its reduced model was trained beyond those of every run.
    MapBegins(&'a MapResult, &'a [[f64; 2]]),
    /// New points of the map of this name, from this one on.
    MapPoints(&'a str, usize, &'a [MapPoint]),
    /// A whole map.
    Map(&'a MapResult),
    /// A run in time that begins or, after [`ResultSink::stopped`] had an answer, resumes.
    TransientBegins(&'a Recording<'a>),
    /// New rows of it.
    TransientPiece(&'a RecordPiece<'a>),
    /// The motion of all nodes at one of its times.
    TransientField(&'a FieldSnapshot<'a>),
    /// A whole run in time.
    Transient(&'a TransientResult),
}

/// Takes results as they come, and has the record of a run in time at hand, which is too long for memory.
pub trait ResultSink {
    /// Takes a result.
    ///
    /// # Errors
    /// [`Error::Io`](crate::error::Error::Io): a file of the results folder cannot be written, the disk is too small for the record of a run
    /// in time. [`Error::Analysis`](crate::error::Error::Analysis): memory is.
    fn record(&mut self, stage: ResultStage<'_>) -> Result<()>;

    /// Rows of a channel of the run in time.
    ///
    /// # Errors
    /// [`Error::Io`](crate::error::Error::Io): `results.h5`, where the record is kept, cannot be read.
    fn recorded(&self, channel: &str, rows: Range<usize>) -> Result<Vec<f64>>;

    /// State at which an earlier run in time stopped that is to be resumed.
    fn stopped(&self) -> Option<Checkpoint>;
}

/// The histories of a run in time that is short enough for memory, gathered from its stages.
#[derive(Debug, Default)]
pub struct Histories {
    tables: TransientTables,
    /// The name of each channel and of each real mode, if their accelerations are recorded.
    names: Vec<String>,
    /// Their values, the start included.
    values: Vec<Vec<f64>>,
    events: Vec<Event>,
}

impl Histories {
    /// Adds what a stage brings.
    pub fn keep(&mut self, stage: &ResultStage<'_>) {
        match stage {
            ResultStage::TransientBegins(recording) => {
                let channels = recording.channels.iter().map(|channel| channel.name.clone());
                let names: Vec<String> = channels.chain((0..recording.modes).map(modal_channel)).collect();
                let (tables, values) = (TransientTables::new(recording), vec![Vec::new(); names.len()]);
                *self = Histories { tables, names, values, events: Vec::new() };
            }
            ResultStage::TransientPiece(piece) => {
                let (channels, modal) = self.values.split_at_mut(self.tables.channels.len());
                channels.iter_mut().zip(piece.values).for_each(|(all, new)| all.extend(new));
                let modal = modal.iter_mut().zip(piece.modal);
                modal.for_each(|(all, new)| all.extend(new.iter().map(|a| f64::from(*a))));
                self.events.extend(piece.events);
            }
            _ => {}
        }
    }

    /// The name and the values of each channel, the start included.
    pub fn all(&self) -> impl Iterator<Item = (&str, &[f64])> {
        self.names.iter().map(String::as_str).zip(self.values.iter().map(Vec::as_slice))
    }

    /// The values of a channel, the start included.
    pub fn of(&self, channel: &str) -> Option<&[f64]> {
        self.all().find(|(name, _)| *name == channel).map(|(_, all)| all)
    }
}

impl Describe for Histories {
    /// `/transient/history` and `/transient/events` of `results.h5`; nothing without a run in time.
    fn describe(&self) -> Group<'_> {
        let (channels, modal) = self.values.split_at(self.tables.channels.len());
        if channels.is_empty() {
            return Group::new("", "");
        }
        let mut history = Group::new("history", "motion and forces at every step");
        if !modal.is_empty() {
            history = history.table(self.tables.modal(0, modal));
        }
        Group::new("transient", "")
            .table(self.tables.history(0, channels))
            .group(history)
            .table(self.tables.events(&self.events))
    }
}

/// Hands results on to a function and holds the record of a run in time itself, for runs that are short.
pub(super) struct Memory<'a> {
    record: &'a mut dyn FnMut(ResultStage) -> Result<()>,
    pub(super) histories: Histories,
}

impl<'a> Memory<'a> {
    pub(super) fn new(record: &'a mut dyn FnMut(ResultStage) -> Result<()>) -> Self {
        Memory { record, histories: Histories::default() }
    }
}

impl ResultSink for Memory<'_> {
    fn record(&mut self, stage: ResultStage<'_>) -> Result<()> {
        if let ResultStage::TransientBegins(recording) = &stage {
            fits_in_memory(&RecordSize::from(*recording))?;
        }
        self.histories.keep(&stage);
        (self.record)(stage)
    }

    fn recorded(&self, channel: &str, rows: Range<usize>) -> Result<Vec<f64>> {
        let values = self.histories.of(channel).and_then(|all| all.get(rows));
        Ok(values.unwrap_or_default().to_vec())
    }

    fn stopped(&self) -> Option<Checkpoint> {
        None
    }
}
