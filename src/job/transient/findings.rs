//! What a whole record says, read back from its keeper in parts.

use super::tape::Tape;
use crate::error::Result;
use crate::results::{GrowthCompared, SpectrumOf};
use crate::signal::{self, Spectrum};
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

/// What is found in a record.
pub(super) struct Findings {
    /// Spectra of the channels to show.
    pub(super) spectra: Vec<SpectrumOf>,
    /// How the disturbance grew while it was small.
    pub(super) growth: Option<GrowthCompared>,
}

impl Tape<'_, '_> {
    /// Looks through the record of `rows` rows, `step` seconds apart.
    pub(super) fn findings(&mut self, rows: usize, step: f64) -> Result<Findings> {
        let mut channels = std::mem::take(&mut self.recorder.channels);
        for channel in &mut channels {
            let name = channel.name.clone();
            channel.look(rows, step, |part| self.keeper.recorded(&name, part))?;
        }
        self.recorder.channels = channels;
        let spectra = self.recorder.shown.map(|channel| self.spectrum_of(channel, rows, step));
        let spectra = spectra.into_iter().collect::<Result<Vec<SpectrumOf>>>()?;
        Ok(Findings { spectra, growth: self.growth(rows, step)? })
    }

    fn read(&self, channel: usize, part: Range<usize>) -> Result<Vec<f64>> {
        self.keeper.recorded(&self.recorder.channels[channel].name, part)
    }

    /// The spectrum of the second half of a channel.
    fn spectrum_of(&self, channel: usize, rows: usize, step: f64) -> Result<SpectrumOf> {
        let first = rows / 2;
        let length = (rows - first).min(AT_ONCE) * 2 / (SEGMENTS + 1);
        let spectrum = match rows - first {
            half if half <= AT_ONCE => signal::spectrum(&self.read(channel, first..rows)?, step, length),
            _ => welch(first..rows, length, step, |part| self.read(channel, part))?,
        };
        let mut peaks = signal::peaks(&spectrum, FLOOR, PEAKS);
        signal::name_peaks(&mut peaks, 0.5 * spectrum.resolution_hz);
        let window = [first as f64 * step, rows.saturating_sub(1) as f64 * step];
        Ok(SpectrumOf { channel, window, spectrum, peaks })
    }

    /// How a disturbance grew while it was small.
    fn growth(&self, rows: usize, step: f64) -> Result<Option<GrowthCompared>> {
        let Some(along) = &self.recorder.along else { return Ok(None) };
        let penetration = self.read(self.recorder.penetration, 0..rows.min(AT_ONCE))?;
        let large = |d: &f64| (d - penetration[0]).abs() > SMALL * penetration[0].abs();
        let end = penetration.iter().position(large).unwrap_or(penetration.len());
        let [re, im] = self.recorder.amplitude.map(|channel| self.read(channel, 0..end));
        let found = signal::growth(&re?, &im?, step, [0.0, end as f64 * step]);
        Ok(Some(GrowthCompared { mode: along.mode, eigenvalue: along.eigenvalue, found }))
    }
}

/// The spectrum of a part of a record from segments of `length` values that overlap by a half, one in memory at a time:
/// the root of the mean square of theirs.
fn welch(
    part: Range<usize>,
    length: usize,
    step: f64,
    read: impl Fn(Range<usize>) -> Result<Vec<f64>>,
) -> Result<Spectrum> {
    let mut sum = Spectrum::default();
    let mut segments = 0.0;
    for begin in (part.start..=part.end - length).step_by(length / 2) {
        let one = signal::spectrum(&read(begin..begin + length)?, step, length);
        sum.resolution_hz = one.resolution_hz;
        sum.amplitude.resize(one.amplitude.len(), 0.0);
        sum.amplitude.iter_mut().zip(one.amplitude).for_each(|(sum, a)| *sum += a * a);
        segments += 1.0;
    }
    sum.amplitude.iter_mut().for_each(|a| *a = (*a / segments).sqrt());
    Ok(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_read_one_by_one_give_the_spectrum_of_the_whole() {
        let record: Vec<f64> =
            (0..9000).map(|k| (0.3 * k as f64).sin() + (1e-4 * (k * k) as f64).cos()).collect();
        let (from, length, step) = (1000, 1024, 1e-4);
        let whole = signal::spectrum(&record[from..], step, length);
        let parts = welch(from..record.len(), length, step, |part| Ok(record[part].to_vec())).unwrap();
        assert!(whole.resolution_hz == parts.resolution_hz && whole.amplitude.len() == parts.amplitude.len());
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-13 * (1.0 + a);
        assert!(whole.amplitude.iter().zip(&parts.amplitude).all(near));
    }
}
