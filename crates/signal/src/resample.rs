//! From one sampling rate to another, limited to the band that both can hold.

use puruspe::In;
use std::f64::consts::PI;

/// Zero crossings of the kernel on either side.
const CROSSINGS: f64 = 32.0;
/// β of Kaiser's window: 85 dB below.
const KAISER: f64 = 8.6;
/// The cut-off, as a part of the lower of the two Nyquist frequencies; what lies above that frequency is then 80 dB down.
const CUT: f64 = 0.92;
/// Kernel values kept between two crossings; linear between them, an error of 1e-5.
const FINE: f64 = 256.0;

/// Resamples a record that comes sample by sample: y(t) = Σ_n x_n h(t − nΔt) with h the sinc of the cut-off under
/// Kaiser's window (J. O. Smith & P. Gossett, IEEE ICASSP 1984, 19.4.1). Before its first and after its last sample the
/// record is zero.
#[derive(Debug)]
pub struct Resampler {
    /// Δt \[s\].
    step: f64,
    rate: f64,
    /// Half the length of h \[s\].
    half: f64,
    /// h at equal spacing from 0 to `half`.
    kernel: Vec<f64>,
    /// The samples from number `first` on.
    samples: Vec<f64>,
    first: usize,
    /// The number of the next output.
    next: usize,
}

impl Resampler {
    /// From one sample every `step` seconds to `rate` samples a second.
    pub fn new(step: f64, rate: f64) -> Self {
        let cut = CUT * 0.5 * rate.min(1.0 / step);
        let half = CROSSINGS / (2.0 * cut);
        let at = |k: usize| {
            let x = k as f64 / FINE;
            let window = (1.0 - (x / CROSSINGS).powi(2)).max(0.0).sqrt();
            let sinc = if k == 0 { 1.0 } else { (PI * x).sin() / (PI * x) };
            2.0 * cut * step * sinc * In(0, KAISER * window) / In(0, KAISER)
        };
        let kernel = (0..=(CROSSINGS * FINE) as usize + 1).map(at).collect();
        Resampler { step, rate, half, kernel, samples: Vec::new(), first: 0, next: 0 }
    }

    /// The next samples; what is known of the output by then is added to `out`.
    pub fn take(&mut self, values: &[f64], out: &mut Vec<f64>) {
        self.samples.extend_from_slice(values);
        let known = (self.first + self.samples.len()) as f64 * self.step;
        while self.next as f64 / self.rate + self.half < known {
            out.push(self.value(self.next as f64 / self.rate));
            self.next += 1;
        }
        let needed = ((self.next as f64 / self.rate - self.half) / self.step).floor().max(0.0) as usize;
        let done = needed.saturating_sub(self.first).min(self.samples.len());
        self.samples.drain(..done);
        self.first += done;
    }

    /// Remaining output, up to the last sample.
    pub fn finish(&mut self, out: &mut Vec<f64>) {
        let end = (self.first + self.samples.len()) as f64 * self.step;
        while (self.next as f64 + 0.5) / self.rate < end {
            out.push(self.value(self.next as f64 / self.rate));
            self.next += 1;
        }
    }

    fn value(&self, time: f64) -> f64 {
        let begin = ((time - self.half) / self.step).ceil().max(self.first as f64) as usize - self.first;
        let end = ((time + self.half) / self.step).floor().max(0.0) as usize + 1;
        let end = end.saturating_sub(self.first).min(self.samples.len());
        let per_second = FINE * CROSSINGS / self.half;
        let mut sum = 0.0;
        for (k, x) in self.samples.iter().enumerate().take(end).skip(begin) {
            let place = (time - (self.first + k) as f64 * self.step).abs() * per_second;
            let below = (place as usize).min(self.kernel.len() - 2);
            let part = place - below as f64;
            sum += x * (self.kernel[below] + part * (self.kernel[below + 1] - self.kernel[below]));
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;
    use stridor_base::bounds::{Origin::*, within};

    fn resampled(step: f64, hz: f64, seconds: f64) -> Vec<f64> {
        let mut resampler = Resampler::new(step, 48_000.0);
        let mut out = Vec::new();
        let record: Vec<f64> =
            (0..(seconds / step) as usize).map(|k| (TAU * hz * k as f64 * step).sin()).collect();
        record.chunks(333).for_each(|piece| resampler.take(piece, &mut out));
        resampler.finish(&mut out);
        out
    }

    #[test]
    fn a_sine_of_both_bands_stays_and_what_lies_above_goes() {
        for step in [1e-5, 3.7e-6, 2.5e-5] {
            let out = resampled(step, 3333.0, 0.05);
            assert!(out.len().abs_diff(2400) <= 2, "{}", out.len());
            let off = |k: usize| (out[k] - (TAU * 3333.0 * k as f64 / 48_000.0).sin()).abs();
            let worst = (100..2300).map(off).fold(0.0, f64::max);
            assert!(within(worst, 2e-4, Discretisation), "{step}: {worst}");
        }
        for hz in [24_200.0, 30_000.0, 44_900.0] {
            let out = resampled(1e-5, hz, 0.05);
            let worst = out[100..2300].iter().fold(0.0f64, |m, x| m.max(x.abs()));
            assert!(within(worst, 2e-4, Discretisation), "{hz}: {worst}");
        }
    }
}
