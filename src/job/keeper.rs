//! Where results go as they come.

use super::explore::KnownMap;
use crate::error::Result;
use crate::results::{
    CalibrationResult, Channel, ComplexResult, EventTable, Field, FieldsFile, FrfResult, HistoryTable,
    MapResult, NamedModes, Piece, Recording, ResultsFile, RunResults, SensitivityResult, SteadyResult,
    SweepResult, TransientResult, modal_channel, room_in_memory, room_on_disk,
};
use crate::sweep::MapPoint;
use crate::transient::Checkpoint;
use std::ops::Range;
use std::path::Path;
use std::time::Instant;

/// Lines that an earlier run recorded are written to a new table so many at once.
const AT_ONCE: usize = 4096;

/// A result that is ready to be written.
pub enum Stage<'a> {
    /// The case, its size and its geometry.
    Model(&'a RunResults),
    /// Real modes.
    Modes(&'a NamedModes),
    /// Steady sliding.
    Steady(&'a SteadyResult),
    /// Complex eigenvalues.
    Complex(&'a ComplexResult),
    /// Their sensitivities.
    Sensitivity(&'a SensitivityResult),
    /// A sweep.
    Sweep(&'a SweepResult),
    /// A map of which no new point is there yet, and what is known of it.
    MapBegins(&'a MapResult, &'a KnownMap),
    /// New points of the map of this name, from this one on.
    MapPoints(&'a str, usize, &'a [MapPoint]),
    /// A whole map.
    Map(&'a MapResult),
    /// A run in time that begins or, after [`Keeper::stopped`] had an answer, goes on.
    TransientBegins(&'a Recording<'a>),
    /// New rows of it.
    TransientPiece(&'a Piece<'a>),
    /// The motion of all nodes at one of its times.
    TransientField(&'a Field<'a>),
    /// A frequency response.
    Frf(&'a FrfResult),
    /// Numbers that were found from measured frequencies.
    Calibration(&'a CalibrationResult),
    /// A whole run in time.
    Transient(&'a TransientResult),
}

/// Takes results as they come, and has the record of a run in time at hand, which is too long for memory.
pub trait Keeper {
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

impl Keeper for Memory<'_> {
    fn record(&mut self, stage: Stage<'_>) -> Result<()> {
        if let Stage::TransientBegins(recording) = &stage {
            room_in_memory(recording)?;
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
    /// `transient.csv` and `events.csv`.
    tables: Option<(HistoryTable, EventTable)>,
    /// `transient.vtkhdf`.
    fields: Option<FieldsFile>,
    /// How long it took \[s\].
    pub(super) seconds: f64,
    /// The part of it that was taken from a run in time.
    pub(super) seconds_in_time: f64,
}

impl<'a> Folder<'a> {
    pub(super) fn new(dir: &'a Path, file: ResultsFile) -> Self {
        Folder { dir, file, tables: None, fields: None, seconds: 0.0, seconds_in_time: 0.0 }
    }

    fn write(&mut self, stage: &Stage<'_>) -> Result<()> {
        let file = &mut self.file;
        match stage {
            Stage::Model(model) => file.write_case(model).and_then(|()| file.write_geometry(&model.geometry)),
            Stage::Modes(modes) => file.write_modes(modes),
            Stage::Steady(steady) => file.write_steady(steady),
            Stage::Complex(complex) => file.write_complex(complex),
            Stage::Sensitivity(sensitivity) => file.write_sensitivity(sensitivity),
            Stage::Sweep(sweep) => file.write_sweep(sweep),
            Stage::MapBegins(map, known) => file.begin_map(map, &known.points, &known.trained),
            Stage::MapPoints(name, first, points) => file.write_map_points(name, *first, points),
            Stage::Map(map) => file.finish_map(map),
            Stage::TransientBegins(recording) => {
                room_on_disk(self.dir, recording)?;
                let fields = recording.fields.as_ref();
                self.fields = fields.map(|fields| FieldsFile::begin(self.dir, fields)).transpose()?;
                file.begin_transient(recording)?;
                let mut history = HistoryTable::create(self.dir, recording)?;
                let mut events = EventTable::create(self.dir, recording)?;
                for first in (0..recording.done).step_by(AT_ONCE) {
                    let rows = first..recording.done.min(first + AT_ONCE);
                    let read = |c: &Channel| self.file.read_transient(&c.name, rows.clone());
                    let values: Vec<Vec<f64>> = recording.channels.iter().map(read).collect::<Result<_>>()?;
                    history.append(first, &values)?;
                }
                for first in (0..recording.happened).step_by(AT_ONCE) {
                    let part = first..recording.happened.min(first + AT_ONCE);
                    events.append(&self.file.read_events(part)?)?;
                }
                self.tables = Some((history, events));
                Ok(())
            }
            Stage::TransientPiece(piece) => {
                file.write_transient_piece(piece)?;
                self.tables.iter_mut().try_for_each(|(history, events)| {
                    history.append(piece.first, piece.values)?;
                    events.append(piece.events)
                })
            }
            Stage::TransientField(field) => self.fields.iter_mut().try_for_each(|file| file.write(field)),
            Stage::Frf(frf) => file.write_frf(frf),
            Stage::Calibration(calibration) => file.write_calibration(calibration),
            Stage::Transient(transient) => file.finish_transient(transient),
        }
    }
}

impl Keeper for Folder<'_> {
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
        self.file.read_transient(channel, rows)
    }

    fn stopped(&self) -> Result<Option<Checkpoint>> {
        self.file.stopped()
    }
}
