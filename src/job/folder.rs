//! The results folder as a sink: every result is written as soon as it is there.

use super::sink::{ResultSink, ResultStage};
use crate::error::{Error, Fault, Result};
use crate::results::record::{Earlier, Record, RecordBlock};
use crate::results::{
    EventTable, FieldSnapshot, FieldsFile, HistoryTable, RecordPiece, RecordSize, Recording, ResultsFile,
    fits_on_disk,
};
use crate::transient::Checkpoint;
use std::ops::Range;
use std::path::Path;
use std::time::Instant;

/// Writes results into a folder, each as soon as it is there.
pub(super) struct Folder<'a> {
    dir: &'a Path,
    pub(super) file: ResultsFile,
    /// Record from which an interrupted run is resumed.
    pub(super) record: Record,
    /// Record of an earlier run.
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

    fn write(&mut self, stage: &ResultStage<'_>) -> Result<()> {
        let file = &mut self.file;
        match stage {
            ResultStage::Model(model) => file.write_head(model),
            ResultStage::Found(result) => file.write(&result.describe()),
            ResultStage::MapBegins(map, known) => {
                file.begin_map(map, &known.points, &known.trained)?;
                self.record.begin_map(&map.name, &known.points, &known.trained)
            }
            ResultStage::MapPoints(name, first, points) => {
                file.write_map_points(name, *first, points)?;
                self.record.add_map_points(name, *first, points)
            }
            ResultStage::Map(map) => file.finish_map(map),
            ResultStage::Samples(name, first, modes) => {
                // Before the record begins, so that files of earlier runs are gone.
                file.take_place()?;
                self.record.add_samples(name, *first, modes)
            }
            ResultStage::TransientBegins(recording) => self.begin_transient(recording),
            ResultStage::TransientPiece(piece) => {
                file.write_transient_piece(piece)?;
                self.tables.iter_mut().try_for_each(|(history, events)| {
                    history.append(piece.first, piece.values)?;
                    events.append(piece.events)
                })?;
                self.record.add_piece(piece)
            }
            ResultStage::TransientField(field) => {
                self.fields.iter_mut().try_for_each(|file| file.write(field))?;
                self.record.add_field(field)
            }
            ResultStage::Transient(transient) => file.finish_transient(transient),
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
                RecordBlock::Rows { first, values, modal, events } => {
                    let (values, modal, events) = (&values, &modal, &events);
                    file.write_transient_piece(&RecordPiece { first, values, modal, events, checkpoint })
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
            RecordBlock::Rows { first, values, modal: _, events: happened } => {
                history.append(first, &values)?;
                events.append(&happened)
            }
            RecordBlock::Field { number, motion: [displacement, velocity] } => {
                let field = FieldSnapshot { number, displacement: &displacement, velocity: &velocity };
                fields.iter_mut().try_for_each(|file| file.write(&field))
            }
            RecordBlock::Map { .. }
            | RecordBlock::MapPoints { .. }
            | RecordBlock::Samples { .. }
            | RecordBlock::Transient { .. } => Ok(()),
        })
    }
}

impl ResultSink for Folder<'_> {
    fn record(&mut self, stage: ResultStage<'_>) -> Result<()> {
        let started = Instant::now();
        let written = self.write(&stage);
        let seconds = started.elapsed().as_secs_f64();
        self.seconds += seconds;
        if matches!(
            stage,
            ResultStage::TransientBegins(_) | ResultStage::TransientPiece(_) | ResultStage::TransientField(_)
        ) {
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
