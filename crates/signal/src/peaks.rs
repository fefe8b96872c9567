//! Peaks of a spectrum.

use super::Spectrum;
use std::f64::consts::PI;

/// A peak.
#[derive(Debug, Clone, PartialEq)]
pub struct Peak {
    /// Where it is \[Hz\], between the lines.
    pub frequency_hz: f64,
    /// How high it is, in the unit of the spectrum.
    pub amplitude: f64,
    /// Relation to the fundamental of the run: `fundamental`, `2 × 1661 Hz`, `936 + 1661 Hz`; empty where none is shown: see
    /// [`Tones`](super::Tones).
    pub relation: String,
}

/// The `count` highest peaks that reach `floor` times the highest, ascending in frequency. A peak is a line above its
/// neighbours on two sides. With r the ratio of the higher neighbour to it, a sine under a Hann window stands
/// d = (2r − 1)/(r + 1) lines towards that neighbour and is π d (1 − d²)/sin(π d) times as high (T. Grandke, IEEE Trans.
/// Instrum. Meas. 32 (1983) 350).
pub fn peaks(spectrum: &Spectrum, floor: f64, count: usize) -> Vec<Peak> {
    let a = &spectrum.amplitude;
    let highest = a.iter().skip(2).fold(0.0, |m: f64, v| m.max(*v));
    let is_peak = |k: &usize| {
        let k = *k;
        let beats = |other: usize| a[k] > a[other];
        beats(k - 1) && beats(k + 1) && a[k] >= a[k - 2] && a[k] >= a[k + 2] && a[k] >= floor * highest
    };
    let mut found: Vec<Peak> = (3..a.len().saturating_sub(2))
        .filter(is_peak)
        .map(|k| {
            let (side, neighbour) = if a[k + 1] >= a[k - 1] { (1.0, a[k + 1]) } else { (-1.0, a[k - 1]) };
            let ratio = neighbour / a[k];
            let d = ((2.0 * ratio - 1.0) / (ratio + 1.0)).clamp(0.0, 0.5);
            let higher = if d > 0.0 { PI * d * (1.0 - d * d) / (PI * d).sin() } else { 1.0 };
            Peak {
                frequency_hz: (k as f64 + side * d) * spectrum.resolution_hz,
                amplitude: higher * a[k],
                relation: String::new(),
            }
        })
        .collect();
    found.sort_by(|x, y| y.amplitude.total_cmp(&x.amplitude));
    found.truncate(count);
    found.sort_by(|x, y| x.frequency_hz.total_cmp(&y.frequency_hz));
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum;
    use std::f64::consts::TAU;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn sines_between_the_lines_are_found_with_their_amplitudes() {
        let parts = [(936.3, 2.0), (1661.0, 5.0), (2597.3, 0.1), (3322.0, 0.3), (725.9, 0.002)];
        let step = 5e-5;
        let at = |k: usize| -> f64 {
            parts.iter().map(|(f, a)| a * (TAU * f * step * k as f64 + f).cos()).sum::<f64>() + 7.0
        };
        let record: Vec<f64> = (0..12_000).map(at).collect();
        let spectrum = spectrum(&record, step, 4000);
        // The smallest is below a thousandth of the highest.
        let found = peaks(&spectrum, 1e-3, 10);
        assert_eq!(found.len(), 4, "{found:?}");
        for (peak, (f, a)) in found.iter().zip(&parts[..4]) {
            assert!(
                within((peak.frequency_hz - f).abs(), 0.1, Discretisation)
                    && within((peak.amplitude / a - 1.0).abs(), 0.01, Discretisation),
                "{peak:?}"
            );
        }
    }
}
