//! The transform of a segment under a Hann window.

use realfft::num_complex::Complex64;
use realfft::{RealFftPlanner, RealToComplex};
use std::f64::consts::TAU;
use std::sync::Arc;

/// A sine of amplitude a between its lines has Σ |line|² = 1.5 a² under a Hann window: its noise bandwidth in lines
/// (F. J. Harris, Proc. IEEE 66 (1978) 51).
pub const NOISE_BANDWIDTH: f64 = 1.5;

/// Transforms segments of one length: their mean taken off, w_k = ½ − ½ cos(2πk/L).
pub struct Hann {
    weights: Vec<f64>,
    /// 2/Σw: |line| times this is the amplitude of the sine that gives it.
    pub scale: f64,
    fft: Arc<dyn RealToComplex<f64>>,
    buffer: Vec<f64>,
    lines: Vec<Complex64>,
}

impl Hann {
    /// For segments of `length` samples, an even number of at least 4.
    pub fn new(length: usize) -> Self {
        let length = length.max(4) & !1;
        let weights: Vec<f64> =
            (0..length).map(|k| 0.5 - 0.5 * (TAU * k as f64 / length as f64).cos()).collect();
        let fft = RealFftPlanner::<f64>::new().plan_fft_forward(length);
        let (buffer, lines) = (fft.make_input_vec(), fft.make_output_vec());
        Hann { scale: 2.0 / weights.iter().sum::<f64>(), weights, fft, buffer, lines }
    }

    /// L, the samples of a segment.
    pub fn length(&self) -> usize {
        self.weights.len()
    }

    /// X_k = Σ_n w_n (x_n − x̄) e^{−2πikn/L} for k = 0 … L/2.
    ///
    /// # Panics
    /// When the segment has another length.
    pub fn transform(&mut self, segment: &[f64]) -> &[Complex64] {
        assert_eq!(segment.len(), self.weights.len(), "a segment of the length that was planned");
        let mean = segment.iter().sum::<f64>() / segment.len() as f64;
        for ((out, x), w) in self.buffer.iter_mut().zip(segment).zip(&self.weights) {
            *out = (x - mean) * w;
        }
        self.fft.process(&mut self.buffer, &mut self.lines).expect("buffers of the planned lengths");
        &self.lines
    }
}

impl std::fmt::Debug for Hann {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Hann({})", self.weights.len())
    }
}
