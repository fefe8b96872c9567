//! Result sinks take results as soon as they are there; the one here keeps them in memory.

use crate::dataset::Describe;
use crate::error::Result;
use crate::results::{
    FieldSnapshot, MapResult, RecordPiece, RecordSize, Recording, RunResults, TransientResult,
    fits_in_memory, modal_channel,
};
use crate::sweep::MapPoint;
use crate::transient::Checkpoint;
use std::collections::BTreeMap;
use std::ops::Range;

/// Points of one map that an earlier, interrupted run has computed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct KnownMap {
    /// Its first points.
    pub points: Vec<MapPoint>,
    /// Places on which the family was trained beyond those that every run begins with, in their order.
    pub trained: Vec<[f64; 2]>,
}

/// The maps of an earlier run by name.
pub type KnownMaps = BTreeMap<String, KnownMap>;

/// A result that is ready to be written.
pub enum ResultStage<'a> {
    /// The case, its size and its geometry.
    Model(&'a RunResults),
    /// Complete results of an analysis.
    Found(&'a dyn Describe),
    /// A map of which no new point is there yet, and what is known of it.
    MapBegins(&'a MapResult, &'a KnownMap),
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
    /// The machine refuses.
    fn record(&mut self, stage: ResultStage<'_>) -> Result<()>;

    /// Rows of a channel of the run in time.
    ///
    /// # Errors
    /// The machine refuses.
    fn recorded(&self, channel: &str, rows: Range<usize>) -> Result<Vec<f64>>;

    /// State at which an earlier run in time stopped that is to be resumed.
    ///
    /// # Errors
    /// The machine refuses.
    fn stopped(&self) -> Result<Option<Checkpoint>>;
}

/// The histories of a run in time that is short enough for memory, gathered from its stages.
#[derive(Debug, Default)]
pub struct Histories {
    /// The name and the values of each channel.
    channels: Vec<(String, Vec<f64>)>,
}

impl Histories {
    /// Adds what a stage brings.
    pub fn keep(&mut self, stage: &ResultStage<'_>) {
        match stage {
            ResultStage::TransientBegins(recording) => {
                let names = recording.channels.iter().map(|channel| channel.name.clone());
                let names = names.chain((0..recording.modes).map(modal_channel));
                self.channels = names.map(|name| (name, Vec::new())).collect();
            }
            ResultStage::TransientPiece(piece) => {
                let (channels, modal) = self.channels.split_at_mut(piece.values.len());
                channels.iter_mut().zip(piece.values).for_each(|((_, all), new)| all.extend(new));
                let modal = modal.iter_mut().zip(piece.modal);
                modal.for_each(|((_, all), new)| all.extend(new.iter().map(|a| f64::from(*a))));
            }
            _ => {}
        }
    }

    /// The name and the values of each channel, the start included.
    pub fn all(&self) -> impl Iterator<Item = (&str, &[f64])> {
        self.channels.iter().map(|(name, all)| (name.as_str(), all.as_slice()))
    }

    /// The values of a channel, the start included.
    pub fn of(&self, channel: &str) -> Option<&[f64]> {
        self.all().find(|(name, _)| *name == channel).map(|(_, all)| all)
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

    fn stopped(&self) -> Result<Option<Checkpoint>> {
        Ok(None)
    }
}
