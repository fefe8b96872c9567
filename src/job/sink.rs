//! Result sinks take results as soon as they are there; the one here keeps them in memory.

use crate::dataset::{Describe, Dimension, Group, Table, Variable, column};
use crate::error::Result;
use crate::results::{
    FieldSnapshot, MODAL_ABOUT, MODAL_UNIT, MapResult, RecordPiece, RecordSize, Recording, RunResults, TIME,
    TransientResult, fits_in_memory, modal_channel,
};
use crate::sweep::{MapPoint, SampleModes};
use crate::transient::{Checkpoint, Event};
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
    /// New samples of the study of this name, from this one on.
    Samples(&'a str, usize, &'a [SampleModes]),
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
    /// Δt \[s\].
    time_step: f64,
    channels: Vec<History>,
    /// Accelerations of the real modes, if they are recorded.
    modal: Vec<History>,
    events: Vec<Event>,
}

/// A recorded quantity with its values, the start included.
#[derive(Debug)]
struct History {
    name: String,
    unit: &'static str,
    about: String,
    values: Vec<f64>,
}

impl Histories {
    /// Adds what a stage brings.
    pub fn keep(&mut self, stage: &ResultStage<'_>) {
        match stage {
            ResultStage::TransientBegins(recording) => *self = Histories::of_recording(recording),
            ResultStage::TransientPiece(piece) => {
                self.channels.iter_mut().zip(piece.values).for_each(|(all, new)| all.values.extend(new));
                let modal = self.modal.iter_mut().zip(piece.modal);
                modal.for_each(|(all, new)| all.values.extend(new.iter().map(|a| f64::from(*a))));
                self.events.extend(piece.events);
            }
            _ => {}
        }
    }

    fn of_recording(recording: &Recording) -> Self {
        let history =
            |name: String, unit, about: &str| History { name, unit, about: about.into(), values: Vec::new() };
        let channels = recording.channels.iter();
        let modal = |mode| history(modal_channel(mode), MODAL_UNIT, MODAL_ABOUT);
        Histories {
            time_step: recording.time_step,
            channels: channels.map(|c| history(c.name.clone(), c.unit, &c.about)).collect(),
            modal: (0..recording.modes).map(modal).collect(),
            events: Vec::new(),
        }
    }

    /// The name and the values of each channel, the start included.
    pub fn all(&self) -> impl Iterator<Item = (&str, &[f64])> {
        self.channels.iter().chain(&self.modal).map(|own| (own.name.as_str(), own.values.as_slice()))
    }

    /// The values of a channel, the start included.
    pub fn of(&self, channel: &str) -> Option<&[f64]> {
        self.all().find(|(name, _)| *name == channel).map(|(_, all)| all)
    }

    /// The histories over their times.
    fn table(&self, key: &'static str, histories: &[History]) -> Table<'_> {
        let rows = Dimension::of_variable(TIME, histories.first().map_or(0, |own| own.values.len()));
        let times = (0..rows.length).map(|row| row as f64 * self.time_step).collect();
        let along = || vec![rows.clone()];
        let time = Variable::reals(TIME, "s", "time of each step, from the start", along(), times);
        let columns = histories.iter().map(|own| {
            let name = own.name.rsplit('/').next().unwrap_or_default().to_string();
            Variable::reals(name, own.unit, own.about.clone(), along(), own.values.clone())
        });
        let columns = std::iter::once(time).chain(columns).collect();
        Table::along(key, rows, columns)
    }
}

impl Describe for Histories {
    /// `/transient/history` and `/transient/events` of `results.h5`; nothing without a run in time.
    fn describe(&self) -> Group<'_> {
        if self.channels.is_empty() {
            return Group::new("", "");
        }
        let mut history = Group::new("history", "motion and forces at every step");
        if !self.modal.is_empty() {
            history = history.table(self.table("modal_acceleration", &self.modal));
        }
        let events = [
            column(TIME, "s", "when it happened", |event: &Event| event.time),
            column("point", "1", "number of the contact point, from 1", |event: &Event| event.point + 1),
            column("kind", "text", "what it did", |event: &Event| event.kind.name()),
        ];
        Group::new("transient", "")
            .table(self.table("history", &self.channels))
            .group(history)
            .table(Table::by("events", TIME, &events, &self.events))
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
