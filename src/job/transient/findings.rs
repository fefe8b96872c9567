//! Results of a whole record, read back from its sink in parts.

use super::channels::ShownChannel;
use super::history_writer::HistoryWriter;
use super::limits::{another, unreadable};
use crate::error::Result;
use crate::results::{GrowthCompared, SpectrumOf};
use crate::signal::{self, Tones, Welch};
use crate::transient::Plan;
use std::f64::consts::TAU;
use std::ops::Range;

/// Segments that the second half of a run is cut into, each overlapping the next by a half.
const SEGMENTS: usize = 3;
/// Peaks named, and how far below the highest they may be.
const PEAKS: usize = 12;
const FLOOR: f64 = 1e-3;
/// The lowest frequency of a peak, in lines: half of the width of the main lobe of a Hann window.
const LOWEST: f64 = 2.0;
/// A disturbance is small while penetration and slip change by less than this part of themselves.
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
    pub(super) fn findings(&mut self, rows: usize, plan: &Plan, top_hz: f64) -> Result<Findings> {
        let step = plan.step;
        let mut channels = std::mem::take(&mut self.recorder.described);
        for channel in &mut channels {
            let name = channel.name.clone();
            channel.look(rows, step, |part| self.sink.recorded(&name, part))?;
        }
        self.recorder.described = channels;
        let (spectra, fundamental_hz) = self.spectra(rows, step, top_hz)?;
        Ok(Findings { spectra, fundamental_hz, growth: self.growth(rows, plan)? })
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
        let mut peaks = signal::peaks(&lines, FLOOR, PEAKS);
        // Below, a line is the trend of a segment as well as an oscillation.
        peaks.retain(|peak| peak.frequency_hz >= LOWEST * spectrum.resolution_hz);
        let window = [first as f64 * step, rows.saturating_sub(1) as f64 * step];
        let ShownChannel { channel, measured } = shown.clone();
        Ok(SpectrumOf { channel, window, spectrum, peaks, measured, beyond })
    }

    /// How a disturbance grew while it was small.
    fn growth(&self, rows: usize, plan: &Plan) -> Result<Option<GrowthCompared>> {
        let Some(along) = &self.recorder.along else { return Ok(None) };
        let (mode, eigenvalue) = (along.mode, along.eigenvalue);
        let end = self.small(rows.min(AT_ONCE))?;
        let time = end as f64 * plan.step;
        let integrator = plan.scheme.own_growth(eigenvalue.norm(), plan.step);
        let compared =
            |found, refused| Ok(Some(GrowthCompared { mode, eigenvalue, found, refused, integrator }));
        // From the first row to the last of them.
        if let Some(why) = unreadable(eigenvalue, plan, time - plan.step) {
            return compared(None, Some(why));
        }
        let [re, im] = self.recorder.channels.amplitude.map(|channel| self.read(channel, 0..end));
        let found = signal::growth(&re?, &im?, plan.step, [0.0, time]);
        match found.and_then(|found| another(eigenvalue, &found)) {
            Some(why) => compared(None, Some(why)),
            None => compared(found, None),
        }
    }

    /// How many of the first `rows` rows a motion fills that is small: the point that carries most keeps its state, its slip the
    /// sliding velocity, and its penetration or, where it also pulls, its stiffness, within a hundredth.
    fn small(&self, rows: usize) -> Result<usize> {
        let recorder = &self.recorder;
        let (model, point, channels) = (recorder.model, recorder.point, &recorder.channels);
        let Some(pair) = recorder.pairs.iter().position(|own| own.contains(&point)) else { return Ok(rows) };
        let read = |channel: usize| self.read(channel, 0..rows);
        let (depth, slip, speed) =
            (read(channels.penetration)?, read(channels.penetration + 1)?, read(channels.speeds[pair])?);
        let states = channels.states.map_or(Ok(Vec::new()), |first| (first..first + 3).map(read).collect());
        let states: Vec<Vec<f64>> = states?;
        let stiffness = |penetration: f64| model.normal_stiffness(point, penetration);
        let (pulls, at_rest) = (model.is_bilateral(point), stiffness(depth[0]));
        let varies = model.friction_varies(point, depth[0]);
        let large = |k: &usize| {
            let pressed = match pulls {
                true => (stiffness(depth[*k]) - at_rest).abs() > SMALL * at_rest.abs(),
                false => (depth[*k] - depth[0]).abs() > SMALL * depth[0].abs(),
            };
            let slides = varies && (slip[*k] - speed[*k]).abs() > SMALL * speed[*k].abs();
            pressed || slides || states.iter().any(|count| count[*k] != count[0])
        };
        Ok((0..rows).find(large).unwrap_or(rows))
    }
}
