//! Welch's averaged spectrum.

use super::hann::{Hann, NOISE_BANDWIDTH};

/// The amplitude of a record over frequency.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spectrum {
    /// Δf \[Hz\]: line k stands at k Δf.
    pub resolution_hz: f64,
    /// The amplitude (peak, not r.m.s.) of the sine that would give this line, in the unit of the record; root of the
    /// mean square over the segments.
    pub amplitude: Vec<f64>,
}

impl Spectrum {
    /// The frequency of line k \[Hz\].
    pub fn frequency_hz(&self, k: usize) -> f64 {
        k as f64 * self.resolution_hz
    }

    /// The highest line; the mean, which is taken off, does not count. `None` where all are zero.
    pub fn strongest(&self) -> Option<usize> {
        let lines = self.amplitude.iter().enumerate().skip(1).filter(|(_, a)| **a > 0.0);
        lines.max_by(|a, b| a.1.total_cmp(b.1)).map(|(k, _)| k)
    }

    /// Contribution of line k to the mean square of the record, ½a²/1.5 under a Hann window: a sine spreads over three or four
    /// lines, whose sum is its mean square.
    pub fn mean_square(&self, k: usize) -> f64 {
        0.5 * self.amplitude[k].powi(2) / NOISE_BANDWIDTH
    }
}

/// The spectrum of a record sampled every `step` seconds, from segments of `length` samples that overlap by a half, each
/// with its mean taken off and a Hann window: |X_k| · 2/Σw (P. D. Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70).
/// A record shorter than a segment is one segment.
///
/// ```
/// let step = 1e-4;
/// let record: Vec<f64> = (0..8000).map(|k| 3.0 * (2000.0 * step * k as f64).sin()).collect();
/// let spectrum = stridor_signal::spectrum(&record, step, 4000);
/// let peak = &stridor_signal::peaks(&spectrum, 1e-3, 1)[0];
/// assert!((peak.frequency_hz - 2000.0 / std::f64::consts::TAU).abs() < 0.02 && (peak.amplitude - 3.0).abs() < 0.01);
/// ```
pub fn spectrum(record: &[f64], step: f64, length: usize) -> Spectrum {
    let length = length.min(record.len()) & !1;
    if length < 4 {
        return Spectrum::default();
    }
    let mut welch = Welch::new(length, step);
    welch.take(record);
    welch.finish()
}

/// [`spectrum`] of a record that comes in pieces.
#[derive(Debug)]
pub struct Welch {
    hann: Hann,
    step: f64,
    pending: Vec<f64>,
    square: Vec<f64>,
    segments: usize,
}

impl Welch {
    /// Segments of `length` samples, one every `step` seconds.
    pub fn new(length: usize, step: f64) -> Self {
        let hann = Hann::new(length);
        let square = vec![0.0; hann.length() / 2 + 1];
        Welch { hann, step, pending: Vec::new(), square, segments: 0 }
    }

    /// The next samples.
    pub fn take(&mut self, values: &[f64]) {
        self.pending.extend_from_slice(values);
        let (length, mut begin) = (self.hann.length(), 0);
        while begin + length <= self.pending.len() {
            let lines = self.hann.transform(&self.pending[begin..begin + length]);
            self.square.iter_mut().zip(lines).for_each(|(sum, z)| *sum += z.norm_sqr());
            self.segments += 1;
            begin += length / 2;
        }
        self.pending.drain(..begin);
    }

    /// The spectrum; empty when not one segment was full.
    pub fn finish(self) -> Spectrum {
        if self.segments == 0 {
            return Spectrum::default();
        }
        let amplitude =
            self.square.iter().map(|s| self.hann.scale * (s / self.segments as f64).sqrt()).collect();
        Spectrum { resolution_hz: 1.0 / (self.hann.length() as f64 * self.step), amplitude }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn pieces_give_the_same_bits_and_lines_add_up_to_the_mean_square() {
        let (step, parts) = (2e-5, [(1661.3, 0.7), (3333.0, 0.2)]);
        let at = |k: usize| -> f64 {
            parts.iter().map(|(f, a)| a * (std::f64::consts::TAU * f * step * k as f64).sin()).sum()
        };
        let record: Vec<f64> = (0..30_000).map(at).collect();
        let whole = spectrum(&record, step, 4000);
        let mut welch = Welch::new(4000, step);
        record.chunks(777).for_each(|piece| welch.take(piece));
        assert_eq!(welch.finish(), whole);
        assert!(within(
            (whole.frequency_hz(whole.strongest().unwrap()) - 1661.3).abs(),
            0.51 * whole.resolution_hz,
            Discretisation
        ));
        assert!(Spectrum::default().strongest().is_none());
        let sum: f64 = (0..whole.amplitude.len()).map(|k| whole.mean_square(k)).sum();
        let exact: f64 = parts.iter().map(|(_, a)| 0.5 * a * a).sum();
        assert!(within((sum / exact - 1.0).abs(), 1e-3, Discretisation), "{sum} {exact}");
        assert_eq!(Welch::new(100, step).finish(), Spectrum::default());
    }
}
