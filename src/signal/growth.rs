//! How fast an oscillation grows and turns.

use std::f64::consts::TAU;

/// An exponential e^{(σ + 2πi f) t} fitted to a part of a complex record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Growth {
    /// σ \[1/s\].
    pub rate: f64,
    /// f \[Hz\].
    pub frequency_hz: f64,
    /// The first and last time of what was fitted \[s\].
    pub window: [f64; 2],
    /// R.m.s. deviation of ln|c| from its line: the smaller the more it is one exponential.
    pub deviation: f64,
}

/// Fits growth (or decay) of c = re + i im, sampled every `step` seconds, between two times: straight lines through
/// ln|c| and through its phase, which must turn by less than half a turn a step. `None` with fewer than ten samples, or
/// where c vanishes.
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

/// The slope of the straight line through equally spaced values, and the r.m.s. deviation from it.
fn line(values: &[f64]) -> Option<(f64, f64)> {
    let n = values.len() as f64;
    let (middle, mean) = (0.5 * (n - 1.0), values.iter().sum::<f64>() / n);
    let (mut xx, mut xy) = (0.0, 0.0);
    for (k, y) in values.iter().enumerate() {
        xx += (k as f64 - middle).powi(2);
        xy += (k as f64 - middle) * (y - mean);
    }
    let slope = xy / xx;
    let off = |(k, y): (usize, &f64)| (y - mean - slope * (k as f64 - middle)).powi(2);
    let deviation = (values.iter().enumerate().map(off).sum::<f64>() / n).sqrt();
    (slope.is_finite() && deviation.is_finite()).then_some((slope, deviation))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_growing_turn_is_measured_and_nothing_is_not() {
        let step = 1e-4;
        let at = |k: usize| (25.0 * k as f64 * step).exp() * 1e-6;
        let turn = |k: usize| TAU * 153.7 * k as f64 * step + 0.4;
        let re: Vec<f64> = (0..3000).map(|k| at(k) * turn(k).cos()).collect();
        let im: Vec<f64> = (0..3000).map(|k| at(k) * turn(k).sin()).collect();
        let found = growth(&re, &im, step, [0.01, 0.29]).unwrap();
        assert!((found.rate - 25.0).abs() < 1e-9 && (found.frequency_hz - 153.7).abs() < 1e-9, "{found:?}");
        assert!(found.deviation < 1e-12);
        assert!(growth(&re, &im, step, [0.0, 5e-4]).is_none());
        assert!(growth(&[0.0; 50], &[0.0; 50], step, [0.0, 5e-3]).is_none());
    }
}
