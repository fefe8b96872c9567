//! How the motions of the modes go together, line by line.

use super::radiation::entries;
use rayon::prelude::*;
use stridor_signal::{Hann, NOISE_BANDWIDTH};

/// Mean products of modal accelerations over frequency, from Hann-windowed segments that overlap by a half.
///
/// S_mn of a line is what it adds to the mean of q̈_m q̈_n: ½ Re(X_m X_n*) (2/Σw)² / 1.5, the mean over the segments.
#[derive(Debug)]
pub struct CrossSpectra {
    hann: Hann,
    step: f64,
    lines: usize,
    pending: Vec<Vec<f64>>,
    /// For each line the entries m ≥ n row by row.
    sums: Vec<f64>,
    segments: usize,
}

impl CrossSpectra {
    /// Of `modes` accelerations that come every `step` seconds, from segments of `length` steps, up to `top_hz`.
    pub fn new(modes: usize, length: usize, step: f64, top_hz: f64) -> Self {
        let hann = Hann::new(length);
        let seconds = hann.length() as f64 * step;
        let lines = ((top_hz * seconds) as usize + 1).min(hann.length() / 2 + 1);
        let sums = vec![0.0; lines * (modes * (modes + 1) / 2)];
        CrossSpectra { hann, step, lines, pending: vec![Vec::new(); modes], sums, segments: 0 }
    }

    /// The next accelerations: one slice a mode, all of one length.
    pub fn take(&mut self, accelerations: &[Vec<f64>]) {
        self.pending.iter_mut().zip(accelerations).for_each(|(all, new)| all.extend_from_slice(new));
        let (length, mut begin) = (self.hann.length(), 0);
        while begin + length <= self.pending.first().map_or(0, Vec::len) {
            self.add(begin);
            begin += length / 2;
        }
        self.pending.iter_mut().for_each(|all| drop(all.drain(..begin)));
    }

    /// One segment.
    fn add(&mut self, begin: usize) {
        let modes = self.pending.len();
        // [line][mode], so that a line is in one place.
        let mut spectra = vec![[0.0; 2]; self.lines * modes];
        for (m, all) in self.pending.iter().enumerate() {
            let lines = self.hann.transform(&all[begin..begin + self.hann.length()]);
            for (k, line) in lines.iter().take(self.lines).enumerate() {
                spectra[k * modes + m] = [line.re, line.im];
            }
        }
        let each = modes * (modes + 1) / 2;
        self.sums.par_chunks_mut(each.max(1)).zip(spectra.par_chunks(modes.max(1))).for_each(|(sums, x)| {
            let mut rest = sums;
            for m in 0..modes {
                let (row, below) = rest.split_at_mut(m + 1);
                let [re, im] = x[m];
                row.iter_mut().zip(x).for_each(|(sum, other)| *sum += re * other[0] + im * other[1]);
                rest = below;
            }
        });
        self.segments += 1;
    }

    /// Segments so far.
    pub fn segments(&self) -> usize {
        self.segments
    }

    /// Δf \[Hz\]: line k stands at k Δf.
    pub fn resolution_hz(&self) -> f64 {
        1.0 / (self.hann.length() as f64 * self.step)
    }

    /// The number of lines.
    pub fn lines(&self) -> usize {
        self.lines
    }

    /// S_mn of line k, entries m ≥ n row by row; zero before the first segment.
    pub fn products(&self, k: usize) -> Vec<f64> {
        let each = entries(self.pending.len()).count();
        let scale = 0.5 * self.hann.scale.powi(2) / (NOISE_BANDWIDTH * self.segments.max(1) as f64);
        self.sums[k * each..(k + 1) * each].iter().map(|s| scale * s).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn products_add_up_to_the_means_of_the_motions() {
        let (step, hz) = (1e-5, 1661.3);
        let of = |amplitude: f64, phase: f64| -> Vec<f64> {
            (0..40_000).map(|k| amplitude * (TAU * hz * step * k as f64 + phase).cos()).collect()
        };
        let motions = [of(2.0, 0.3), of(0.5, 1.4)];
        let mut cross = CrossSpectra::new(2, 8192, step, 6000.0);
        for k in 0..40 {
            cross.take(&motions.clone().map(|m| m[1000 * k..1000 * (k + 1)].to_vec()));
        }
        assert!(cross.segments() == 8 && cross.lines() == 492, "{} {}", cross.segments(), cross.lines());
        let mut sum = [0.0; 3];
        for k in 0..cross.lines() {
            sum.iter_mut().zip(cross.products(k)).for_each(|(sum, s)| *sum += s);
        }
        let exact = [2.0, 0.5 * (1.4f64 - 0.3).cos(), 0.125];
        assert!(
            sum.iter().zip(exact).all(|(a, b)| within((a / b - 1.0).abs(), 1e-3, Discretisation)),
            "{sum:?}"
        );
    }
}
