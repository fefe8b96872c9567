//! Hands the record on, a piece at a time.

use super::deflection::Deflections;
use super::harmonic_fields::HarmonicFields;
use super::recorder::Recorder;
use super::snapshots::Snapshots;
use crate::error::{Error, Fault, Result};
use crate::job::sink::{ResultSink, ResultStage};
use crate::results::{FieldSnapshot, RecordPiece, Recording};
use crate::transient::{Checkpoint, Marched, Plan, State, TransientModel};
use std::time::{Duration, Instant};

/// Rows of a piece, at most.
const ROWS: usize = 4096;
/// A piece is written at the latest after this time.
const PATIENCE: Duration = Duration::from_secs(2);

/// Rows of the recorder, written to its sink. Each piece comes with a checkpoint; memory does not grow with the
/// run. How the rows are cut into pieces has no influence on them.
pub(super) struct HistoryWriter<'a, 'k> {
    pub(super) recorder: Recorder<'a>,
    pub(super) sink: &'k mut dyn ResultSink,
    snapshots: Option<Snapshots<'a>>,
    /// The motion over the last periods, and the highest frequency \[Hz\] that it may have.
    pub(super) cycle: (HarmonicFields<'a>, f64),
    /// What the model cannot mean.
    pub(super) deflections: Deflections<'a>,
    /// The first row that is at hand.
    first: usize,
    last_piece: Instant,
}

impl<'a, 'k> HistoryWriter<'a, 'k> {
    pub(super) fn new(
        recorder: Recorder<'a>,
        snapshots: Option<Snapshots<'a>>,
        (cycle, deflections): ((HarmonicFields<'a>, f64), Deflections<'a>),
        sink: &'k mut dyn ResultSink,
    ) -> Self {
        HistoryWriter { recorder, sink, snapshots, cycle, deflections, first: 0, last_piece: Instant::now() }
    }

    /// Begins with the first row or, where an earlier run stopped, resumes from there.
    /// Refuses what an earlier run left of another model.
    pub(super) fn begin(&mut self, start: State, model: &TransientModel<'_>, plan: &Plan) -> Result<Marched> {
        let mut marched = Marched::from(start);
        self.recorder.take(&marched);
        let earlier = self.sink.stopped();
        if let Some(checkpoint) = &earlier {
            self.begins_alike()?;
            marched = checkpoint.march(model)?;
            self.recorder.restore(checkpoint, &marched)?;
            self.cycle.0.restore(checkpoint)?;
            self.deflections.restore(checkpoint)?;
            self.first = marched.step + 1;
        }
        self.sink.record(ResultStage::TransientBegins(&Recording {
            time_step: plan.step,
            rows: plan.steps + 1,
            done: self.first,
            happened: if earlier.is_some() { self.recorder.happened.iter().sum() } else { 0 },
            channels: &self.recorder.described,
            modes: self.recorder.modal.as_ref().map_or(0, |modal| modal.rows.len()),
            pairs: &self.recorder.named,
            fields: self.snapshots.as_ref().map(|s| s.fields(plan.steps, self.first, plan.step)),
        }))?;
        if earlier.is_none() {
            self.snapshot(&marched)?;
        }
        self.flush(&marched)?;
        if marched.step >= self.cycle.0.ready() && !self.cycle.0.has_begun() {
            self.begin_cycle()?;
        }
        Ok(marched)
    }

    /// Begins the motion over the last periods: its fundamental is that of the record up to there.
    fn begin_cycle(&mut self) -> Result<()> {
        let (fields, top_hz) = &self.cycle;
        let hz = self.frequency(fields.ready() + 1, fields.step, *top_hz)?;
        if let Some(hz) = hz {
            self.cycle.0.begin(hz);
        }
        Ok(())
    }

    /// A program or a machine that is another may give another first row.
    fn begins_alike(&self) -> Result<()> {
        for (channel, own) in self.recorder.described.iter().zip(&self.recorder.values) {
            let earlier = self.sink.recorded(&channel.name, 0..1)?;
            if earlier.iter().map(|v| v.to_bits()).ne(own.iter().map(|v| v.to_bits())) {
                let (found, expected) =
                    (format!("{earlier:?} at the start"), format!("{own:?} as in this run"));
                let place = format!("the earlier run's `{}`", channel.name);
                return Err(Error::input(Fault::new(place, found, expected).with_help(
                    "The case and its files are the same, the program or the machine is not: run without --resume, or name another folder with --out",
                )));
            }
        }
        Ok(())
    }

    /// Takes a step.
    pub(super) fn take(&mut self, marched: &Marched) -> Result<()> {
        self.recorder.take(marched);
        self.snapshot(marched)?;
        self.cycle.0.take(marched);
        self.deflections.take(self.recorder.model, marched);
        if marched.step == self.cycle.0.ready() {
            self.flush(marched)?;
            return self.begin_cycle();
        }
        if self.recorder.rows() >= ROWS || self.last_piece.elapsed() >= PATIENCE {
            self.flush(marched)?;
        }
        Ok(())
    }

    /// Hands on the rows at hand, the last of which is of `marched`.
    pub(super) fn flush(&mut self, marched: &Marched) -> Result<()> {
        if self.recorder.rows() > 0 {
            let checkpoint = self.checkpoint(marched);
            let Recorder { values, events, modal, .. } = &self.recorder;
            let modal = modal.as_ref().map_or(&[][..], |modal| &modal.rows);
            let piece = RecordPiece { first: self.first, values, modal, events, checkpoint: &checkpoint };
            self.sink.record(ResultStage::TransientPiece(&piece))?;
            self.first += self.recorder.rows();
            self.recorder.forget();
        }
        self.last_piece = Instant::now();
        Ok(())
    }

    /// Hands on the motion of all nodes, where it is time for it.
    fn snapshot(&mut self, marched: &Marched) -> Result<()> {
        let due = |snapshots: &&Snapshots| marched.step.is_multiple_of(snapshots.every);
        let Some(snapshots) = self.snapshots.as_ref().filter(due) else { return Ok(()) };
        let number = marched.step / snapshots.every;
        let [displacement, velocity] = &snapshots.take(&marched.state);
        self.sink.record(ResultStage::TransientField(&FieldSnapshot { number, displacement, velocity }))
    }

    fn checkpoint(&self, marched: &Marched) -> Checkpoint {
        let mut checkpoint = Checkpoint::default();
        checkpoint.put_march(marched);
        self.recorder.put(&mut checkpoint);
        self.cycle.0.put(&mut checkpoint);
        self.deflections.put(&mut checkpoint);
        checkpoint
    }
}
