//! How large a sustained oscillation is, and whether it has settled.

/// A change of more than this part is not steady.
const STEADY: f64 = 0.05;
/// Pieces that the record is cut into: at most, and the fewest that say something.
const PIECES: [usize; 2] = [32, 4];
/// Periods of the strongest line that a piece holds at least.
const PERIODS: f64 = 2.0;

/// The size of an oscillation over a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitCycle {
    /// Half the range between the mean of the maxima and the mean of the minima of the pieces, in the unit of the
    /// record.
    pub amplitude: f64,
    /// Root of the mean square about the mean.
    pub rms: f64,
    /// The mean.
    pub mean: f64,
    /// The change of the r.m.s. from the first to the second half of the record, as a part of their mean.
    pub drift: f64,
    /// Number of pieces.
    pub pieces: usize,
}

impl LimitCycle {
    /// Whether the oscillation neither grew nor died away: |drift| ≤ 5 %.
    pub fn steady(&self) -> bool {
        self.drift.abs() <= STEADY
    }
}

/// The size of the oscillation in `record`, which is sampled every `step` seconds and whose strongest frequency is
/// `frequency_hz`. The record is cut into equal pieces, at most 32, each at least two periods long; the maxima and
/// minima are those of the pieces, so that a beat or a slow sway counts by its largest swing. `None` for a record
/// shorter than four pieces, or with a value that is not finite.
///
/// ```
/// let record: Vec<f64> = (0..20_000).map(|k| 1.0 + 2.0 * (0.05 * k as f64).sin()).collect();
/// let cycle = stridor_signal::limit_cycle(&record, 1e-5, 5000.0 / std::f64::consts::TAU).unwrap();
/// assert!((cycle.amplitude - 2.0).abs() < 1e-3 && (cycle.rms - 2f64.sqrt()).abs() < 1e-3 && cycle.steady());
/// ```
pub fn limit_cycle(record: &[f64], step: f64, frequency_hz: f64) -> Option<LimitCycle> {
    let periods = record.len() as f64 * step * frequency_hz;
    let pieces = ((periods / PERIODS) as usize).min(PIECES[0]).min(record.len());
    if pieces < PIECES[1] || record.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let (mut high, mut low) = (0.0, 0.0);
    for k in 0..pieces {
        let piece = &record[k * record.len() / pieces..(k + 1) * record.len() / pieces];
        high += piece.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x)) / pieces as f64;
        low += piece.iter().fold(f64::INFINITY, |m, x| m.min(*x)) / pieces as f64;
    }
    let mean = record.iter().sum::<f64>() / record.len() as f64;
    let square =
        |part: &[f64]| part.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / part.len().max(1) as f64;
    let (first, second) = record.split_at(record.len() / 2);
    let [before, after] = [first, second].map(|half| square(half).sqrt());
    let drift = if before + after > 0.0 { 2.0 * (after - before) / (before + after) } else { 0.0 };
    Some(LimitCycle { amplitude: 0.5 * (high - low), rms: square(record).sqrt(), mean, drift, pieces })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;
    use stridor_base::bounds::{Origin::*, within};

    fn record(of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..25_000).map(|k| of(k as f64 * 1e-5)).collect()
    }

    #[test]
    fn a_beat_counts_by_its_largest_swing() {
        let beat = record(|t| (TAU * 1661.0 * t).sin() + 0.5 * (TAU * 2597.0 * t).sin() - 3.0);
        let cycle = limit_cycle(&beat, 1e-5, 1661.0).unwrap();
        // The phase between the two at the swings of a piece; whole periods of one alone.
        assert!(within((cycle.amplitude - 1.5).abs(), 0.01, Discretisation), "{cycle:?}");
        assert!(
            within((cycle.rms - (0.5f64 + 0.125).sqrt()).abs(), 1e-3, Discretisation)
                && within((cycle.mean + 3.0).abs(), 1e-3, Discretisation)
        );
        assert!(cycle.steady() && cycle.pieces == 32);
    }

    #[test]
    fn what_decays_or_grows_is_not_steady() {
        for rate in [-2.0, 2.0] {
            let found = record(|t| (rate * t).exp() * (TAU * 1661.0 * t).sin());
            let cycle = limit_cycle(&found, 1e-5, 1661.0).unwrap();
            // e^{rate T/2} between the halves.
            let exact = 2.0 * (0.5 * rate * 0.125).tanh();
            assert!(
                within((cycle.drift - exact).abs(), 0.01, Discretisation) && !cycle.steady(),
                "{cycle:?} {exact}"
            );
        }
        assert!(limit_cycle(&record(|_| 4.0), 1e-5, 1661.0).unwrap().steady());
        assert!(limit_cycle(&record(|t| t)[..400], 1e-5, 1661.0).is_none());
        assert!(limit_cycle(&[f64::NAN; 5000], 1e-5, 1661.0).is_none());
    }
}
