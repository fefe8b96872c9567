//! Results of a whole record, read back from its sink in parts.

use super::channels::ShownChannel;
use super::history_writer::HistoryWriter;
use crate::error::Result;
use crate::results::{GrowthCompared, SpectrumOf};
use crate::signal::{self, Tones, Welch};
use std::f64::consts::TAU;
use std::ops::Range;

/// Segments that the second half of a run is cut into, each overlapping the next by a half.
const SEGMENTS: usize = 3;
/// Peaks named, and how far below the highest they may be.
const PEAKS: usize = 12;
const FLOOR: f64 = 1e-3;
/// A disturbance is small while the penetration changes by less than this part of itself.
const SMALL: f64 = 0.01;
/// Values of a channel that are in memory at once: what is longer is cut into shorter segments, or cut off.
const AT_ONCE: usize = 1 << 20;
/// Peaks are named from no more than this many last values of each channel.
const NAMED: usize = 1 << 18;

/// Spectra and growth of a record.
pub(super) struct Findings {
    /// Spectra of the channels to show.
    pub(super) spectra: Vec<SpectrumOf>,
    /// Fundamental of their peaks \[Hz\].
    pub(super) fundamental_hz: Option<f64>,
    /// How the disturbance grew while it was small.
    pub(super) growth: Option<GrowthCompared>,
}

impl HistoryWriter<'_, '_> {
    /// Looks through the record of `rows` rows, `step` seconds apart; peaks are named up to `top_hz`.
    pub(super) fn findings(&mut self, rows: usize, step: f64, top_hz: f64) -> Result<Findings> {
        let mut channels = std::mem::take(&mut self.recorder.described);
        for channel in &mut channels {
            let name = channel.name.clone();
            channel.look(rows, step, |part| self.sink.recorded(&name, part))?;
        }
        self.recorder.described = channels;
        let (spectra, fundamental_hz) = self.spectra(rows, step, top_hz)?;
        Ok(Findings { spectra, fundamental_hz, growth: self.growth(rows, step)? })
    }

    /// The spectra of the second half of the channels to show, their peaks with names, and the fundamental \[Hz\].
    fn spectra(&self, rows: usize, step: f64, top_hz: f64) -> Result<(Vec<SpectrumOf>, Option<f64>)> {
        let shown = self.recorder.shown.iter();
        let spectra = shown.map(|shown| self.spectrum_of(shown, rows, step, top_hz));
        let mut spectra = spectra.collect::<Result<Vec<SpectrumOf>>>()?;
        let part = rows - (rows / 2).min(NAMED)..rows;
        let records = spectra.iter().map(|of| self.read(of.channel, part.clone()));
        let records = records.collect::<Result<Vec<Vec<f64>>>>()?;
        let mut tones = Tones {
            records: records.iter().map(Vec::as_slice).collect(),
            resolution_hz: spectra.first().map_or(0.0, |of| of.spectrum.resolution_hz),
            peaks: spectra.iter_mut().map(|of| &mut of.peaks[..]).collect(),
            step,
        };
        let fundamental_hz = tones.name();
        Ok((spectra, fundamental_hz))
    }

    /// Frequency of the motion in the first `rows` rows \[Hz\]: the fundamental, else the strongest peak of the first channel, else
    /// that of the mode along which it was disturbed.
    pub(super) fn frequency(&self, rows: usize, step: f64, top_hz: f64) -> Result<Option<f64>> {
        let (spectra, fundamental_hz) = self.spectra(rows, step, top_hz)?;
        let peaks = spectra.first().map_or(&[][..], |of| &of.peaks);
        let strongest = peaks.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
        let mode = self.recorder.along.as_ref().map(|along| along.eigenvalue.im / TAU);
        Ok(fundamental_hz.or(strongest.map(|peak| peak.frequency_hz)).or(mode))
    }

    pub(super) fn read(&self, channel: usize, part: Range<usize>) -> Result<Vec<f64>> {
        self.sink.recorded(&self.recorder.described[channel].name, part)
    }

    /// The spectrum of the second half of a channel, and its peaks up to `top_hz`.
    fn spectrum_of(&self, shown: &ShownChannel, rows: usize, step: f64, top_hz: f64) -> Result<SpectrumOf> {
        let first = rows / 2;
        let length = (rows - first).min(AT_ONCE) * 2 / (SEGMENTS + 1);
        let mut welch = Welch::new(length, step);
        for begin in (first..rows).step_by(AT_ONCE) {
            welch.take(&self.read(shown.channel, begin..rows.min(begin + AT_ONCE))?);
        }
        let spectrum = welch.finish();
        let mut lines = spectrum.clone();
        lines.amplitude.truncate((top_hz / spectrum.resolution_hz) as usize + 1);
        let beyond = spectrum.strongest().map(|k| spectrum.frequency_hz(k)).filter(|hz| *hz > top_hz);
        let peaks = signal::peaks(&lines, FLOOR, PEAKS);
        let window = [first as f64 * step, rows.saturating_sub(1) as f64 * step];
        let ShownChannel { channel, measured } = shown.clone();
        Ok(SpectrumOf { channel, window, spectrum, peaks, measured, beyond })
    }

    /// How a disturbance grew while it was small.
    fn growth(&self, rows: usize, step: f64) -> Result<Option<GrowthCompared>> {
        let Some(along) = &self.recorder.along else { return Ok(None) };
        let penetration = self.read(self.recorder.channels.penetration, 0..rows.min(AT_ONCE))?;
        let large = |d: &f64| (d - penetration[0]).abs() > SMALL * penetration[0].abs();
        let end = penetration.iter().position(large).unwrap_or(penetration.len());
        let [re, im] = self.recorder.channels.amplitude.map(|channel| self.read(channel, 0..end));
        let found = signal::growth(&re?, &im?, step, [0.0, end as f64 * step]);
        Ok(Some(GrowthCompared { mode: along.mode, eigenvalue: along.eigenvalue, found }))
    }
}
