//! A channel of a run in time between two times.

use super::reference::Near;
use crate::signal::{self, Peak};

/// Lines among which the strongest is sought.
const LINES: usize = 8;

/// The part of a channel that is evaluated.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChannelRecord<'a> {
    pub(super) values: &'a [f64],
    /// Δt \[s\].
    step: f64,
}

impl<'a> ChannelRecord<'a> {
    /// The samples from the first to the last time \[s\], those there are.
    pub(super) fn new(values: &'a [f64], step: f64, window: [f64; 2]) -> Self {
        let [first, last] = window.map(|t| (t / step).round().max(0.0) as usize);
        let end = (last + 1).min(values.len());
        ChannelRecord { values: &values[first.min(end)..end], step }
    }

    /// The largest value; not a number without samples, as in what follows.
    pub(super) fn highest(&self) -> f64 {
        self.values.iter().copied().fold(f64::NAN, f64::max)
    }

    /// The smallest value.
    pub(super) fn lowest(&self) -> f64 {
        self.values.iter().copied().fold(f64::NAN, f64::min)
    }

    /// Half of what the values span.
    pub(super) fn amplitude(&self) -> f64 {
        0.5 * (self.highest() - self.lowest())
    }

    /// The mean time between upward crossings of the middle of the span \[s\].
    pub(super) fn period(&self) -> f64 {
        let crossings = self.crossings();
        match (crossings.first(), crossings.last()) {
            (Some(first), Some(last)) if crossings.len() > 1 => {
                (last - first) / (crossings.len() - 1) as f64 * self.step
            }
            _ => f64::NAN,
        }
    }

    /// The mean time from the lowest value of a period to the next highest \[s\], over the whole periods there are. Of
    /// several that are as high but for 1e-4 of the span the first counts.
    pub(super) fn rise(&self) -> f64 {
        let near = 1e-4 * (self.highest() - self.lowest());
        let crossings = self.crossings();
        // Of a period about an upward crossing: from the crossing before to the one after.
        let times: Vec<f64> = crossings
            .windows(3)
            .map(|of| {
                let part = |from: f64, to: f64| from.ceil() as usize..(to.floor() as usize) + 1;
                let by_value = |a: &usize, b: &usize| self.values[*a].total_cmp(&self.values[*b]);
                let low = part(of[0], of[1]).min_by(by_value).unwrap_or(0);
                let rising = part(of[1], of[2]);
                let top = rising.clone().map(|k| self.values[k]).fold(f64::NEG_INFINITY, f64::max);
                let high = rising.into_iter().find(|k| self.values[*k] >= top - near).unwrap_or(low);
                (high as f64 - low as f64) * self.step
            })
            .collect();
        times.iter().sum::<f64>() / times.len() as f64
    }

    /// The strongest line; not a number where there is none.
    pub(super) fn tone(&self) -> Peak {
        let spectrum = signal::spectrum(self.values, self.step, self.values.len());
        let strongest = signal::peaks(&spectrum, 0.1, LINES)
            .into_iter()
            .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
        let none = Peak { frequency_hz: f64::NAN, amplitude: f64::NAN, relation: String::new() };
        strongest.unwrap_or(none)
    }

    /// The frequency of the highest peak \[Hz\]; not a number where there is none.
    pub(super) fn peak_near(&self, near: &Near) -> f64 {
        let spectrum = signal::spectrum(self.values, self.step, self.values.len());
        let peaks =
            signal::peaks(&spectrum, 0.0, usize::MAX).into_iter().filter(|p| near.holds(p.frequency_hz));
        let highest = peaks.max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
        highest.map_or(f64::NAN, |peak| peak.frequency_hz)
    }

    /// The highest line that is near, or near none, over the highest of all, both below the bound \[dB\]; the mean does not
    /// count.
    pub(super) fn level(&self, near: &Near, wanted: bool) -> f64 {
        let spectrum = signal::spectrum(self.values, self.step, self.values.len());
        let lines = || {
            let all =
                spectrum.amplitude.iter().enumerate().skip(2).map(|(k, a)| (spectrum.frequency_hz(k), *a));
            all.filter(|(hz, _)| *hz <= near.below_hz)
        };
        let highest = |of: &mut dyn Iterator<Item = (f64, f64)>| of.map(|(_, a)| a).fold(f64::NAN, f64::max);
        let part = highest(&mut lines().filter(|(hz, _)| near.holds(*hz) == wanted)) / highest(&mut lines());
        20.0 * part.log10()
    }

    /// Where the values rise through the middle of their span, in samples, between them by a straight line.
    fn crossings(&self) -> Vec<f64> {
        let middle = 0.5 * (self.highest() + self.lowest());
        let pairs = self.values.windows(2).enumerate();
        pairs
            .filter(|(_, pair)| pair[0] < middle && pair[1] >= middle)
            .map(|(k, pair)| k as f64 + (middle - pair[0]) / (pair[1] - pair[0]))
            .collect()
    }
}

impl Near {
    fn holds(&self, hz: f64) -> bool {
        self.frequencies_hz.iter().any(|f| (hz / f - 1.0).abs() <= self.within)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn peaks_are_found_where_they_are_sought_and_measured_against_the_highest() {
        let parts = [(936.4, 0.1), (1661.0, 1.0), (2000.0, 0.03), (2600.0, 0.3)];
        let at = |t: f64| parts.iter().map(|(f, a)| a * (std::f64::consts::TAU * f * t).sin()).sum::<f64>();
        let values: Vec<f64> = (0..20_000).map(|k| at(2e-5 * k as f64)).collect();
        let record = ChannelRecord::new(&values, 2e-5, [0.1, 0.4]);
        let near = |frequencies: &[f64], below_hz: f64| Near {
            frequencies_hz: frequencies.to_vec(),
            within: 0.02,
            below_hz,
        };
        assert!(within((record.peak_near(&near(&[936.0], 1e9)) - 936.4).abs(), 0.05, Discretisation));
        assert!(within((record.level(&near(&[936.0], 1e9), true) + 20.0).abs(), 1.0, Discretisation));
        assert!(within(record.level(&near(&[1650.0, 936.0], 1e9), true).abs(), 1e-12, RoundOff));
        assert!(within((record.level(&near(&[1661.0], 1e9), false) + 10.5).abs(), 1.0, Discretisation));
        assert!(within(
            (record.level(&near(&[1661.0, 936.0], 2200.0), false) + 30.5).abs(),
            1.0,
            Discretisation
        ));
        let silent = ChannelRecord::new(&values, 2e-5, [1.0, 2.0]);
        assert!(
            silent.peak_near(&near(&[936.0], 1e9)).is_nan()
                && silent.level(&near(&[936.0], 1e9), true).is_nan()
        );
    }

    #[test]
    fn a_saw_is_measured() {
        // Up in 0.3 s, down in 0.1 s, between 1 and 3.
        let at = |t: f64| {
            let part = t.rem_euclid(0.4);
            if part < 0.3 { 1.0 + part / 0.15 } else { 3.0 - (part - 0.3) / 0.05 }
        };
        let values: Vec<f64> = (0..5000).map(|k| at(1e-3 * k as f64)).collect();
        let record = ChannelRecord::new(&values, 1e-3, [1.0, 4.0]);
        // b₁ = A/(π² d (1 − d)) sin πd of a triangle with rise d = 0.75 and amplitude A = 1, times 2.
        let line = 2.0 * (0.75 * std::f64::consts::PI).sin() / (std::f64::consts::PI.powi(2) * 0.75 * 0.25);
        assert!(
            within((record.tone().frequency_hz - 2.5).abs(), 1e-3, Discretisation),
            "{:?}",
            record.tone()
        );
        assert!(
            within((record.tone().amplitude / line - 1.0).abs(), 2e-3, Discretisation),
            "{:?} {line}",
            record.tone()
        );
        assert!(
            within((record.period() - 0.4).abs(), 1e-9, RoundOff)
                && within((record.rise() - 0.3).abs(), 1.1e-3, Discretisation)
        );
        assert!(
            within((record.amplitude() - 1.0).abs(), 0.02, Discretisation)
                && within((record.highest() - 3.0).abs(), 0.02, Discretisation)
        );
        let short = ChannelRecord::new(&values, 1e-3, [1.0, 1.2]);
        assert!(short.period().is_nan() && short.rise().is_nan() && short.lowest() >= 1.0);
        assert!(ChannelRecord::new(&values, 1e-3, [7.0, 8.0]).amplitude().is_nan());
    }
}
