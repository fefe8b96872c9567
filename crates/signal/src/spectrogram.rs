//! Which frequencies sound when.

use super::hann::Hann;

/// Columns and rows at most, whatever the length of the run.
const CELLS: [usize; 2] = [600, 400];
/// A segment is this many times as long as one that resolves time and frequency by equal parts of the picture.
const SHARPNESS: f64 = 2.5;

/// The amplitude of a record over time and frequency.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spectrogram {
    /// The time of the middle of the first column \[s\].
    pub begin: f64,
    /// From one column to the next \[s\].
    pub hop: f64,
    /// How long the segment is that each spectrum is taken from \[s\].
    pub segment: f64,
    /// Δf \[Hz\]: row k stands at k Δf.
    pub resolution_hz: f64,
    /// Rows of a column.
    pub rows: usize,
    /// Column after column: the amplitude (peak, not r.m.s.) of the sine that would give this line, in the unit of the
    /// record.
    pub amplitude: Vec<f64>,
}

impl Spectrogram {
    /// The columns.
    pub fn columns(&self) -> usize {
        self.amplitude.len().checked_div(self.rows).unwrap_or(0)
    }

    /// A column, from 0 Hz upwards.
    pub fn column(&self, k: usize) -> &[f64] {
        &self.amplitude[k * self.rows..(k + 1) * self.rows]
    }

    /// The time of a column \[s\].
    pub fn time(&self, k: usize) -> f64 {
        self.begin + k as f64 * self.hop
    }
}

/// The spectrogram up to `top_hz` of a record sampled every `step` seconds; see [`ShortTime`].
pub fn spectrogram(record: &[f64], step: f64, top_hz: f64) -> Spectrogram {
    let mut short = ShortTime::new(record.len(), step, top_hz);
    record.iter().for_each(|x| short.take(*x));
    short.finish()
}

/// Spectra of short segments with a Hann window, one after the other, of a record that comes sample by sample.
///
/// With T the length of the record and F the highest frequency shown, a segment lasts 2.5 √(T/1.5F), so that
/// the resolutions in time and frequency are balanced in the picture, and at most 400/F. Segments begin evenly spaced, at most half a
/// segment apart; of a long record a column is the root mean square of several. There are at most 600 columns and 400
/// rows.
#[derive(Debug)]
pub struct ShortTime {
    hann: Hann,
    step: f64,
    rows: usize,
    /// Samples from one segment to the next, and segments a column.
    hop: usize,
    together: usize,
    pending: Vec<f64>,
    skip: usize,
    square: Vec<f64>,
    summed: usize,
    amplitude: Vec<f64>,
}

impl ShortTime {
    /// For `samples` samples, one every `step` seconds, up to `top_hz`.
    pub fn new(samples: usize, step: f64, top_hz: f64) -> Self {
        let top = top_hz.min(0.5 / step);
        let balanced = SHARPNESS * (samples as f64 * step / (1.5 * top)).sqrt();
        let longest = ((CELLS[1] - 1) as f64 / top).min(0.25 * samples as f64 * step);
        let hann = Hann::new((balanced.min(longest) / step) as usize);
        let length = hann.length();
        let span = samples.saturating_sub(length);
        let hop = span.div_ceil(CELLS[0] - 1).clamp(1, length / 2);
        let rows = ((top * length as f64 * step) as usize + 1).min(length / 2 + 1).min(CELLS[1]);
        let together = (1 + span / hop).div_ceil(CELLS[0]);
        ShortTime {
            hann,
            step,
            rows,
            hop,
            together,
            pending: Vec::with_capacity(2 * length),
            skip: 0,
            square: vec![0.0; rows],
            summed: 0,
            amplitude: Vec::new(),
        }
    }

    /// The next sample.
    pub fn take(&mut self, value: f64) {
        let length = self.hann.length();
        self.pending.push(value);
        if self.pending.len() < self.skip + length {
            return;
        }
        let lines = self.hann.transform(&self.pending[self.skip..]);
        self.square.iter_mut().zip(lines).for_each(|(sum, z)| *sum += z.norm_sqr());
        self.summed += 1;
        if self.summed == self.together {
            self.column();
        }
        self.skip += self.hop;
        // Thrown away a segment at a time, so that a small hop does not move the rest each time.
        if self.skip >= length {
            self.pending.drain(..self.skip);
            self.skip = 0;
        }
    }

    fn column(&mut self) {
        let (scale, count) = (self.hann.scale, self.summed as f64);
        self.amplitude.extend(self.square.iter().map(|s| scale * (s / count).sqrt()));
        self.square.fill(0.0);
        self.summed = 0;
    }

    /// The spectrogram; empty when the record was shorter than a segment.
    pub fn finish(mut self) -> Spectrogram {
        if self.summed > 0 {
            self.column();
        }
        if self.amplitude.is_empty() {
            return Spectrogram::default();
        }
        let length = self.hann.length() as f64 * self.step;
        let hop = self.hop as f64 * self.step;
        Spectrogram {
            begin: 0.5 * length + 0.5 * (self.together - 1) as f64 * hop,
            hop: self.together as f64 * hop,
            segment: length,
            resolution_hz: 1.0 / length,
            rows: self.rows,
            amplitude: self.amplitude,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;
    use stridor_base::bounds::{Origin::*, within};

    fn ridge(column: &[f64]) -> (usize, f64) {
        let top = column.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        (top.0, *top.1)
    }

    #[test]
    fn the_ridge_of_a_chirp_follows_its_frequency() {
        let (step, n) = (1e-4, 20_000);
        let at = |k: usize| {
            let t = k as f64 * step;
            (TAU * (300.0 * t + 0.5 * 200.0 * t * t)).sin()
        };
        let record: Vec<f64> = (0..n).map(at).collect();
        let found = spectrogram(&record, step, 2000.0);
        assert!((500..=600).contains(&found.columns()) && found.rows <= 400, "{}", found.columns());
        for k in 0..found.columns() {
            let (row, height) = ridge(found.column(k));
            let off = row as f64 * found.resolution_hz - (300.0 + 200.0 * found.time(k));
            assert!(within(off.abs(), 0.51 * found.resolution_hz, Discretisation), "{k}: {off}");
            assert!(height > 0.75 && height < 1.02, "{k}: {height}");
        }
    }

    #[test]
    fn two_sines_keep_their_amplitudes_and_the_size_stays_bounded() {
        let step = 1e-5;
        let (f, g) = (1000.0, 3000.0);
        for n in [4_000, 100_000, 350_000] {
            let at = |k: usize| {
                let t = k as f64 * step;
                let late = if k > n / 2 { 0.5 } else { 0.0 };
                3.0 * (TAU * f * t).sin() + late * (TAU * g * t).cos() + 20.0
            };
            let record: Vec<f64> = (0..n).map(at).collect();
            let found = spectrogram(&record, step, 6000.0);
            assert!(found.columns() <= 600 && found.columns() > 200 && found.rows <= 400);
            let last = found.column(found.columns() - 1);
            let first = found.column(0);
            let line = |column: &[f64], hz: f64| {
                let near = (hz / found.resolution_hz).round() as usize;
                column[near - 2..=near + 2].iter().fold(0.0f64, |m, v| m.max(*v))
            };
            // A sine between two lines stands up to 15 % lower in either.
            assert!((0.84..1.001).contains(&(line(last, f) / 3.0)), "{n}");
            assert!((0.84..1.001).contains(&(line(last, g) / 0.5)), "{n}");
            assert!(line(first, g) < 0.02, "{n}: {}", line(first, g));
            let end = found.time(found.columns() - 1) + 0.5 * found.segment;
            assert!(within((end / (n as f64 * step) - 1.0).abs(), 0.05, Discretisation), "{n}: {end}");
        }
        assert_eq!(spectrogram(&[], step, 6000.0), Spectrogram::default());
        assert_eq!(spectrogram(&[1.0, 2.0], step, 6000.0).columns(), 0);
    }
}
