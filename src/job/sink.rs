//! Result sinks: memory, or a folder, that take results as soon as they are there.

use crate::dataset::Describe;
use crate::error::{Error, Fault, Result};
use crate::results::record::{Block, Earlier, Record};
use crate::results::{
    EventTable, Field, FieldsFile, HistoryTable, MapResult, Piece, RecordSize, Recording, ResultsFile,
    RunResults, TransientResult, fits_in_memory, fits_on_disk, modal_channel,
};
use crate::sweep::MapPoint;
use crate::transient::Checkpoint;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::time::Instant;

/// What an earlier, interrupted run knows of one map.
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
pub enum Stage<'a> {
    /// The case, its size and its geometry.
    Model(&'a RunResults),
    /// What an analysis has found, as a whole.
    Found(&'a dyn Describe),
    /// A map of which no new point is there yet, and what is known of it.
    MapBegins(&'a MapResult, &'a KnownMap),
    /// New points of the map of this name, from this one on.
    MapPoints(&'a str, usize, &'a [MapPoint]),
    /// A whole map.
    Map(&'a MapResult),
    /// A run in time that begins or, after [`ResultSink::stopped`] had an answer, goes on.
    TransientBegins(&'a Recording<'a>),
    /// New rows of it.
    TransientPiece(&'a Piece<'a>),
    /// The motion of all nodes at one of its times.
    TransientField(&'a Field<'a>),
    /// A whole run in time.
    Transient(&'a TransientResult),
}

/// Takes results as they come, and has the record of a run in time at hand, which is too long for memory.
pub trait ResultSink {
    /// Takes a result.
    ///
    /// # Errors
    /// The machine refuses.
    fn record(&mut self, stage: Stage<'_>) -> Result<()>;

    /// Rows of a channel of the run in time.
    ///
    /// # Errors
    /// The machine refuses.
    fn recorded(&self, channel: &str, rows: Range<usize>) -> Result<Vec<f64>>;

    /// Where an earlier run in time stopped that is to be taken up.
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
    pub fn keep(&mut self, stage: &Stage<'_>) {
        match stage {
            Stage::TransientBegins(recording) => {
                let names = recording.channels.iter().map(|channel| channel.name.clone());
                let names = names.chain((0..recording.modes).map(modal_channel));
                self.channels = names.map(|name| (name, Vec::new())).collect();
            }
            Stage::TransientPiece(piece) => {
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
    record: &'a mut dyn FnMut(Stage) -> Result<()>,
    pub(super) histories: Histories,
}

impl<'a> Memory<'a> {
    pub(super) fn new(record: &'a mut dyn FnMut(Stage) -> Result<()>) -> Self {
        Memory { record, histories: Histories::default() }
    }
}

impl ResultSink for Memory<'_> {
    fn record(&mut self, stage: Stage<'_>) -> Result<()> {
        if let Stage::TransientBegins(recording) = &stage {
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

/// Writes results into a folder, each as soon as it is there.
pub(super) struct Folder<'a> {
    dir: &'a Path,
    pub(super) file: ResultsFile,
    /// What a run that is killed is taken up from.
    pub(super) record: Record,
    /// What an earlier run has recorded.
    earlier: Earlier,
    /// `transient.csv` and `events.csv`.
    tables: Option<(HistoryTable, EventTable)>,
    /// `transient.vtkhdf`.
    pub(super) fields: Option<FieldsFile>,
    /// How long it took \[s\].
    pub(super) seconds: f64,
    /// The part of it that was taken from a run in time.
    pub(super) seconds_in_time: f64,
}

impl<'a> Folder<'a> {
    pub(super) fn new(dir: &'a Path, file: ResultsFile, record: Record, earlier: Earlier) -> Self {
        Folder { dir, file, record, earlier, tables: None, fields: None, seconds: 0.0, seconds_in_time: 0.0 }
    }

    fn write(&mut self, stage: &Stage<'_>) -> Result<()> {
        let file = &mut self.file;
        match stage {
            Stage::Model(model) => file.write_head(model),
            Stage::Found(result) => file.write(&result.describe()),
            Stage::MapBegins(map, known) => {
                file.begin_map(map, &known.points, &known.trained)?;
                self.record.begin_map(&map.name, &known.points, &known.trained)
            }
            Stage::MapPoints(name, first, points) => {
                file.write_map_points(name, *first, points)?;
                self.record.add_map_points(name, *first, points)
            }
            Stage::Map(map) => file.finish_map(map),
            Stage::TransientBegins(recording) => self.begin_transient(recording),
            Stage::TransientPiece(piece) => {
                file.write_transient_piece(piece)?;
                self.tables.iter_mut().try_for_each(|(history, events)| {
                    history.append(piece.first, piece.values)?;
                    events.append(piece.events)
                })?;
                self.record.add_piece(piece)
            }
            Stage::TransientField(field) => {
                self.fields.iter_mut().try_for_each(|file| file.write(field))?;
                self.record.add_field(field)
            }
            Stage::Transient(transient) => file.finish_transient(transient),
        }
    }

    /// Begins a run in time, with what an earlier run has recorded of it.
    fn begin_transient(&mut self, recording: &Recording) -> Result<()> {
        let earlier = &self.earlier;
        let done = [recording.done, recording.happened, recording.fields.map_or(0, |fields| fields.done)];
        if done != [earlier.rows, earlier.events, earlier.fields] {
            let found =
                format!("{} rows, {} events, {} fields", earlier.rows, earlier.events, earlier.fields);
            let expected =
                format!("{} rows, {} events, {} fields, as its checkpoint has", done[0], done[1], done[2]);
            let fault = Fault::new("the record of the interrupted run", found, expected);
            return Err(Error::input(fault.with_help("It is damaged: run without --resume")));
        }
        fits_on_disk(self.dir, &RecordSize::from(recording))?;
        let checkpoint = earlier.march.clone();
        let Folder { file, record, tables, fields, .. } = self;
        file.begin_transient(recording)?;
        if let Some(checkpoint) = &checkpoint {
            // Before it takes the place of the earlier file, which has these rows.
            record.replay(&mut |block| match block {
                Block::Rows { first, values, modal, events } => {
                    let (values, modal, events) = (&values, &modal, &events);
                    file.write_transient_piece(&Piece { first, values, modal, events, checkpoint })
                }
                _ => Ok(()),
            })?;
        }
        file.take_place()?;
        *fields = recording.fields.as_ref().map(|begun| FieldsFile::begin(self.dir, begun)).transpose()?;
        let (history, events) = tables
            .insert((HistoryTable::create(self.dir, recording)?, EventTable::create(self.dir, recording)?));
        if checkpoint.is_none() {
            return record.begin_transient(recording);
        }
        record.replay(&mut |block| match block {
            Block::Rows { first, values, modal: _, events: happened } => {
                history.append(first, &values)?;
                events.append(&happened)
            }
            Block::Field { number, motion: [displacement, velocity] } => {
                let field = Field { number, displacement: &displacement, velocity: &velocity };
                fields.iter_mut().try_for_each(|file| file.write(&field))
            }
            Block::Map { .. } | Block::MapPoints { .. } | Block::Transient { .. } => Ok(()),
        })
    }
}

impl ResultSink for Folder<'_> {
    fn record(&mut self, stage: Stage<'_>) -> Result<()> {
        let started = Instant::now();
        let written = self.write(&stage);
        let seconds = started.elapsed().as_secs_f64();
        self.seconds += seconds;
        if matches!(stage, Stage::TransientBegins(_) | Stage::TransientPiece(_) | Stage::TransientField(_)) {
            self.seconds_in_time += seconds;
        }
        written
    }

    fn recorded(&self, channel: &str, rows: Range<usize>) -> Result<Vec<f64>> {
        if self.tables.is_some() {
            return self.file.read_transient(channel, rows);
        }
        // Before the run in time begins only the start is at hand.
        let start = self.earlier.channels.iter().filter(|(name, _)| name == channel && rows == (0..1));
        Ok(start.map(|(_, value)| *value).collect())
    }

    fn stopped(&self) -> Result<Option<Checkpoint>> {
        Ok(self.earlier.march.clone())
    }
}
