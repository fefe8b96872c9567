//! How fast an oscillation grows and turns.

use std::f64::consts::{PI, TAU};

/// An exponential e^{(σ + 2πi f) t} fitted to a part of a complex record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Growth {
    /// σ \[1/s\].
    pub rate: f64,
    /// f \[Hz\].
    pub frequency_hz: f64,
    /// The first and last time of what was fitted \[s\].
    pub window: [f64; 2],
    /// Weighted r.m.s. deviation of ln|c| from its line: the smaller the more it is one exponential.
    pub deviation: f64,
}

/// Fits growth (or decay) of c = re + i im, sampled every `step` seconds, between two times: straight lines through
/// ln|c| and through its phase, which must turn by less than half a turn a step. The weights sin²(πt/T) keep out what
/// else there is at the beginning, such as a scheme's other roots, and what ripples along the line, such as a trace of the
/// conjugate motion, at whichever phase it begins and ends. `None` with fewer than ten samples, or where c vanishes.
pub fn growth(re: &[f64], im: &[f64], step: f64, window: [f64; 2]) -> Option<Growth> {
    let [first, last] = window.map(|t| ((t / step).round().max(0.0) as usize).min(re.len().min(im.len())));
    if last < first + 10 {
        return None;
    }
    let (mut size, mut angle) = (Vec::new(), Vec::new());
    for k in first..last {
        size.push(re[k].hypot(im[k]).ln());
        let phase = im[k].atan2(re[k]);
        let turned = angle.last().map_or(phase, |before: &f64| before + wrapped(phase - before));
        angle.push(turned);
    }
    let (rate, deviation) = line(&size)?;
    let (turning, _) = line(&angle)?;
    Some(Growth {
        rate: rate / step,
        frequency_hz: turning / step / TAU,
        window: [first as f64 * step, (last - 1) as f64 * step],
        deviation,
    })
}

/// An angle brought to (−π, π].
fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// The slope of the weighted straight line through equally spaced values, and the r.m.s. deviation from it.
fn line(values: &[f64]) -> Option<(f64, f64)> {
    let n = values.len() as f64;
    let weight = |k: usize| (PI * (k as f64 + 0.5) / n).sin().powi(2);
    let all: f64 = (0..values.len()).map(weight).sum();
    // The weights are symmetric, so that their middle is that of the record.
    let middle = 0.5 * (n - 1.0);
    let mean = values.iter().enumerate().map(|(k, y)| weight(k) * y).sum::<f64>() / all;
    let (mut xx, mut xy) = (0.0, 0.0);
    for (k, y) in values.iter().enumerate() {
        xx += weight(k) * (k as f64 - middle).powi(2);
        xy += weight(k) * (k as f64 - middle) * (y - mean);
    }
    let slope = xy / xx;
    let off = |(k, y): (usize, &f64)| weight(k) * (y - mean - slope * (k as f64 - middle)).powi(2);
    let deviation = (values.iter().enumerate().map(off).sum::<f64>() / all).sqrt();
    (slope.is_finite() && deviation.is_finite()).then_some((slope, deviation))
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex64 as c64;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn a_growing_turn_is_measured_and_nothing_is_not() {
        let step = 1e-4;
        let at = |k: usize| (25.0 * k as f64 * step).exp() * 1e-6;
        let turn = |k: usize| TAU * 153.7 * k as f64 * step + 0.4;
        let re: Vec<f64> = (0..3000).map(|k| at(k) * turn(k).cos()).collect();
        let im: Vec<f64> = (0..3000).map(|k| at(k) * turn(k).sin()).collect();
        let found = growth(&re, &im, step, [0.01, 0.29]).unwrap();
        assert!(
            within((found.rate - 25.0).abs(), 1e-9, RoundOff)
                && within((found.frequency_hz - 153.7).abs(), 1e-9, RoundOff),
            "{found:?}"
        );
        assert!(within(found.deviation, 1e-12, RoundOff));
        assert!(growth(&re, &im, step, [0.0, 5e-4]).is_none());
        assert!(growth(&[0.0; 50], &[0.0; 50], step, [0.0, 5e-3]).is_none());
    }

    /// A thousandth of the conjugate and a beginning that dies away in a hundredth of the record, at every phase: without
    /// weights σ is off by up to 1.3e-4 1/s, and f by 2e-5 Hz.
    #[test]
    fn a_ripple_and_a_beginning_are_kept_out() {
        let step = 1e-3;
        for k in 0..12 {
            let phase = TAU * f64::from(k) / 12.0;
            let at = |k: usize| {
                let t = k as f64 * step;
                let turn = TAU * 15.37 * t + phase;
                let c = c64::from_polar((0.25 * t).exp(), turn);
                c + 1e-3 * c.conj() + c64::from_polar(0.02 * (-t / 0.03).exp(), 3.0 * phase)
            };
            let record: Vec<c64> = (0..3000).map(at).collect();
            let (re, im): (Vec<f64>, Vec<f64>) = record.iter().map(|c| (c.re, c.im)).unzip();
            let found = growth(&re, &im, step, [0.0, 3.0]).unwrap();
            // What the window leaves of the ripple and of the beginning; the same at every run.
            assert!(within((found.rate - 0.25).abs(), 5e-7, Discretisation), "{phase}: {found:?}");
            assert!(within((found.frequency_hz - 15.37).abs(), 1e-7, Discretisation), "{phase}: {found:?}");
        }
    }
}
