//! The sound of a run in time, from the recorded accelerations of the real modes.

use super::history_writer::HistoryWriter;
use crate::error::Result;
use crate::results::{Sound, modal_channel};
use crate::sound::{BLOCK, SoundAccumulator};

impl HistoryWriter<'_, '_> {
    /// Sound of the record of `rows` rows, its levels over the half that is loud.
    pub(super) fn recorded_sound(&self, mut accumulator: SoundAccumulator, rows: usize) -> Result<Sound> {
        let modes = self.recorder.modal.as_ref().map_or(0, |modal| modal.rows.len());
        let block = |first: usize| -> Result<Vec<Vec<f64>>> {
            let part = first..rows.min(first + BLOCK);
            (0..modes).map(|mode| self.sink.recorded(&modal_channel(mode), part.clone())).collect()
        };
        let mut loud = accumulator.loud_half();
        for first in (0..rows).step_by(BLOCK) {
            loud.add(&block(first)?);
        }
        accumulator.count_from(loud.begin());
        for first in (0..rows).step_by(BLOCK) {
            accumulator.add(block(first)?);
        }
        Ok(accumulator.finish())
    }
}
