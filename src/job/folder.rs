//! The results folder as a sink: every result is written as soon as it is there.

use super::sink::{ResultSink, ResultStage};
use crate::error::{Error, Fault, Result};
use crate::results::record::{Earlier, Entry, Record};
use crate::results::{
    FieldSnapshot, FieldsFile, RecordPiece, RecordSize, Recording, ResultsFile, TransientCsv, fits_on_disk,
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
    record: &'a Record,
    /// What it has of a run in time.
    earlier: Earlier,
    /// `transient.csv` and `events.csv`.
    tables: Option<TransientCsv>,
    /// `transient.vtkhdf`.
    pub(super) fields: Option<FieldsFile>,
    /// How long it took \[s\].
    pub(super) seconds: f64,
    /// The part of it that was taken from a run in time.
    pub(super) seconds_in_time: f64,
}

impl<'a> Folder<'a> {
    pub(super) fn new(dir: &'a Path, file: ResultsFile, record: &'a Record) -> Self {
        let earlier = record.in_time();
        Folder { dir, file, record, earlier, tables: None, fields: None, seconds: 0.0, seconds_in_time: 0.0 }
    }

    fn write(&mut self, stage: &ResultStage<'_>) -> Result<()> {
        let file = &mut self.file;
        match stage {
            ResultStage::Model(model) => file.write_head(model),
            ResultStage::Found(result) => file.write(&result.describe()),
            // Before the record begins, so that files of earlier runs are gone.
            ResultStage::StudyBegins => file.take_place(),
            ResultStage::MapBegins(map, trained) => file.begin_map(map, trained),
            ResultStage::MapPoints(name, first, points) => file.write_map_points(name, *first, points),
            ResultStage::Map(map) => file.finish_map(map),
            ResultStage::TransientBegins(recording) => self.begin_transient(recording),
            ResultStage::TransientPiece(piece) => {
                file.write_transient_piece(piece)?;
                self.tables.iter_mut().try_for_each(|tables| tables.append(piece))?;
                self.record.add_piece(piece)
            }
            ResultStage::TransientField(field) => {
                self.record.add_field(field);
                self.fields.iter_mut().try_for_each(|file| file.write(field))
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
        let checkpoint = &earlier.march.clone();
        let Folder { file, record, tables, fields, .. } = self;
        file.begin_transient(recording)?;
        // The pieces of the earlier run.
        let replay = |each: &mut dyn FnMut(&RecordPiece) -> Result<()>,
                      field: &mut dyn FnMut(&FieldSnapshot) -> Result<()>| {
            let Some(checkpoint) = checkpoint else { return Ok(()) };
            record.replay(&mut |entry| match entry {
                Entry::Rows { first, values, modal, events } => {
                    let (values, modal, events) = (&values, &modal, &events);
                    each(&RecordPiece { first, values, modal, events, checkpoint })
                }
                Entry::Field { number, motion: [displacement, velocity] } => {
                    field(&FieldSnapshot { number, displacement: &displacement, velocity: &velocity })
                }
                _ => Ok(()),
            })
        };
        // Before it takes the place of the earlier file, which has these rows.
        replay(&mut |piece| file.write_transient_piece(piece), &mut |_| Ok(()))?;
        file.take_place()?;
        *fields = recording.fields.as_ref().map(|begun| FieldsFile::begin(self.dir, begun)).transpose()?;
        let tables = tables.insert(TransientCsv::create(self.dir, recording)?);
        let mut write = |field: &FieldSnapshot| fields.iter_mut().try_for_each(|file| file.write(field));
        replay(&mut |piece| tables.append(piece), &mut write)?;
        if checkpoint.is_none() {
            record.begin_transient(recording);
        }
        Ok(())
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

    fn stopped(&self) -> Option<Checkpoint> {
        self.earlier.march.clone()
    }
}
