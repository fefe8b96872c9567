//! Welch's averaged spectrum.

use realfft::RealFftPlanner;
use std::f64::consts::TAU;

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
}

/// The spectrum of a record sampled every `step` seconds, from segments of `length` samples that overlap by a half, each
/// with its mean taken off and a Hann window: |X_k| · 2/Σw (P. D. Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70).
/// A record shorter than a segment is one segment.
///
/// ```
/// let step = 1e-4;
/// let record: Vec<f64> = (0..8000).map(|k| 3.0 * (2000.0 * step * k as f64).sin()).collect();
/// let spectrum = stridor::signal::spectrum(&record, step, 4000);
/// let peak = &stridor::signal::peaks(&spectrum, 1e-3, 1)[0];
/// assert!((peak.frequency_hz - 2000.0 / std::f64::consts::TAU).abs() < 0.02 && (peak.amplitude - 3.0).abs() < 0.01);
/// ```
pub fn spectrum(record: &[f64], step: f64, length: usize) -> Spectrum {
    let length = length.min(record.len()) & !1;
    if length < 4 {
        return Spectrum::default();
    }
    let window: Vec<f64> = (0..length).map(|k| 0.5 - 0.5 * (TAU * k as f64 / length as f64).cos()).collect();
    let scale = 2.0 / window.iter().sum::<f64>();
    let fft = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let (mut buffer, mut lines) = (fft.make_input_vec(), fft.make_output_vec());
    let mut square = vec![0.0; lines.len()];
    let mut segments = 0;
    for begin in (0..=record.len() - length).step_by(length / 2) {
        let segment = &record[begin..begin + length];
        let mean = segment.iter().sum::<f64>() / length as f64;
        for ((out, x), w) in buffer.iter_mut().zip(segment).zip(&window) {
            *out = (x - mean) * w;
        }
        if fft.process(&mut buffer, &mut lines).is_err() {
            return Spectrum::default();
        }
        square.iter_mut().zip(&lines).for_each(|(sum, z)| *sum += z.norm_sqr());
        segments += 1;
    }
    let amplitude = square.iter().map(|s| scale * (s / segments as f64).sqrt()).collect();
    Spectrum { resolution_hz: 1.0 / (length as f64 * step), amplitude }
}
