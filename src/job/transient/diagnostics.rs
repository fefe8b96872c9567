//! Data of the pictures of a run, read back from its record in parts.

use super::findings::Findings;
use super::history_writer::HistoryWriter;
use crate::error::Result;
use crate::results::{ContactHistory, ContactWatch, Diagnostics, Orbit, PhaseCurve};
use crate::signal::{LimitCycle, ShortTime, Spectrogram, akima, limit_cycle};

/// The size of an oscillation is taken from this last part of the run, and from no more steps than these.
const PART: usize = 4;
const TAIL: usize = 1 << 16;
/// Periods that a phase plane shows, and points that it has at most.
const PERIODS: f64 = 12.0;
const POINTS: usize = 4000;
/// Points of a period, at least.
const SMOOTH: f64 = 200.0;
/// Rows that are read at once.
const AT_ONCE: usize = 1 << 16;

impl HistoryWriter<'_, '_> {
    /// Looks through the record of `rows` rows, `step` seconds apart, whose spectra are known; spectrograms reach up to
    /// `top_hz`.
    pub(super) fn diagnostics(
        &self,
        rows: usize,
        step: f64,
        known: &Findings,
        top_hz: f64,
    ) -> Result<Diagnostics> {
        let strongest = |channel: usize| {
            let of = known.spectra.iter().find(|of| of.channel == channel)?;
            let peak = of.peaks.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
            let line = || of.spectrum.strongest().map(|k| of.spectrum.frequency_hz(k));
            peak.map(|peak| peak.frequency_hz).or_else(line)
        };
        let shown = &self.recorder.shown;
        let begin = rows - (rows / PART).clamp(1, TAIL).min(rows);
        let mut spectrograms: Vec<(usize, Spectrogram)> = Vec::new();
        let mut cycles: Vec<(usize, LimitCycle)> = Vec::new();
        for channel in shown.iter().map(|shown| shown.channel) {
            let mut short = ShortTime::new(rows, step, top_hz);
            for first in (0..rows).step_by(AT_ONCE) {
                let part = self.read(channel, first..rows.min(first + AT_ONCE))?;
                part.into_iter().for_each(|value| short.take(value));
            }
            spectrograms.push((channel, short.finish()));
            if let Some(hz) = strongest(channel) {
                let cycle = limit_cycle(&self.read(channel, begin..rows)?, step, hz);
                cycles.extend(cycle.map(|cycle| (channel, cycle)));
            }
        }
        spectrograms.retain(|(_, spectrogram)| spectrogram.columns() > 0);
        let hz = known.fundamental_hz.or_else(|| strongest(shown.first()?.channel));
        let orbit = hz.map(|hz| self.orbit(rows, begin, step, hz)).transpose()?;
        Ok(Diagnostics {
            spectrograms,
            cycles,
            window: [begin as f64 * step, rows.saturating_sub(1) as f64 * step],
            orbit: orbit.unwrap_or_default(),
            contact: self.contact(rows, step)?,
        })
    }

    /// The last periods of the fundamental, or of the strongest line, not before row `begin`.
    fn orbit(&self, rows: usize, begin: usize, step: f64, hz: f64) -> Result<Orbit> {
        let wanted = ((PERIODS / (hz * step)).ceil() as usize).clamp(1, rows - begin);
        let every = wanted.div_ceil(POINTS).max(1);
        // Corners between the steps would show: they are no property of the motion.
        let parts = (SMOOTH * hz * step).ceil().max(1.0) as usize;
        let read = |channel: usize| -> Result<Vec<f64>> {
            let values = self.read(channel, rows - wanted..rows)?;
            Ok(if every > 1 { values.into_iter().step_by(every).collect() } else { akima(&values, parts) })
        };
        let curve = |channels: [usize; 2]| -> Result<PhaseCurve> {
            let [across, up] = channels;
            let points = read(across)?.into_iter().zip(read(up)?).map(|(x, y)| [x, y]).collect();
            Ok(PhaseCurve { channels, points })
        };
        let curves = self.recorder.orbits().into_iter().map(curve).collect::<Result<_>>()?;
        Ok(Orbit { periods: [wanted as f64 * step * hz, hz], curves })
    }

    /// States over time of the contact points that ever touched.
    fn contact(&self, rows: usize, step: f64) -> Result<ContactHistory> {
        let points = self.recorder.touched.iter().filter(|touched| **touched).count();
        let mut watch = ContactWatch::new(rows, step, points);
        let Some(first_channel) = self.recorder.channels.states.filter(|_| points > 0) else {
            return Ok(watch.finish());
        };
        for first in (0..rows).step_by(AT_ONCE) {
            let part = first..rows.min(first + AT_ONCE);
            let [stick, back, forth] = [0, 1, 2].map(|k| self.read(first_channel + k, part.clone()));
            let (stick, back, forth) = (stick?, back?, forth?);
            for ((stick, back), forth) in stick.iter().zip(&back).zip(&forth) {
                watch.take([*stick, *back, *forth].map(|count| count as usize));
            }
        }
        Ok(watch.finish())
    }
}
