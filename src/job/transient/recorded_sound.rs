//! The sound of a run in time, from the recorded accelerations of the real modes.

use super::history_writer::HistoryWriter;
use crate::error::Result;
use crate::results::{Sound, modal_channel};
use crate::sound::{BLOCK, SoundAccumulator};

impl HistoryWriter<'_, '_> {
    /// Sound of the record of `rows` rows.
    pub(super) fn recorded_sound(&self, mut accumulator: SoundAccumulator, rows: usize) -> Result<Sound> {
        let modes = self.recorder.modal.as_ref().map_or(0, |modal| modal.rows.len());
        for first in (0..rows).step_by(BLOCK) {
            let part = first..rows.min(first + BLOCK);
            let read = |mode: usize| self.sink.recorded(&modal_channel(mode), part.clone());
            accumulator.add((0..modes).map(read).collect::<Result<Vec<Vec<f64>>>>()?);
        }
        Ok(accumulator.finish())
    }
}
