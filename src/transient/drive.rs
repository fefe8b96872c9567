//! What acts in time: how the counter-bodies slide, and pushes.

use crate::linalg::SparseVector;
use std::f64::consts::{PI, TAU};

/// How a sliding velocity runs in time: V(t) = V · factor(t).
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Profile {
    /// V.
    #[default]
    Constant,
    /// From a part of V to V, linearly over a time \[s\].
    Ramp {
        /// factor(0).
        from: f64,
        /// How long it takes \[s\].
        duration: f64,
    },
    /// V cos(2π f t + φ).
    Reciprocating {
        /// f \[Hz\].
        frequency_hz: f64,
        /// φ \[rad\].
        phase: f64,
    },
    /// Linear between given times \[s\], ascending, constant beyond them.
    Table {
        /// Times \[s\].
        times: Vec<f64>,
        /// Factors, one a time.
        factors: Vec<f64>,
    },
}

impl Profile {
    /// factor(t).
    pub fn factor(&self, time: f64) -> f64 {
        match self {
            Profile::Constant => 1.0,
            Profile::Ramp { from, duration } => {
                let done = if *duration > 0.0 { (time / duration).clamp(0.0, 1.0) } else { 1.0 };
                from + (1.0 - from) * done
            }
            Profile::Reciprocating { frequency_hz, phase } => (TAU * frequency_hz * time + phase).cos(),
            Profile::Table { times, factors } => {
                let after = times.partition_point(|t| *t <= time);
                match (after.checked_sub(1), times.get(after)) {
                    (None, _) => factors.first().copied().unwrap_or(1.0),
                    (Some(before), None) => factors[before],
                    (Some(before), Some(next)) => {
                        let part = (time - times[before]) / (next - times[before]);
                        factors[before] + part * (factors[after] - factors[before])
                    }
                }
            }
        }
    }
}

/// A push on the structure: a half sine, p(t) = sin(π (t − begin)/duration) while it lasts.
#[derive(Debug, Clone, PartialEq)]
pub struct Push {
    /// The force on the degrees of freedom at its peak \[N, N m\].
    pub direction: SparseVector,
    /// When it begins \[s\].
    pub begin: f64,
    /// How long it lasts \[s\].
    pub duration: f64,
}

impl Push {
    /// p(t).
    pub fn factor(&self, time: f64) -> f64 {
        let part = (time - self.begin) / self.duration;
        if part > 0.0 && part < 1.0 { (PI * part).sin() } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_and_pushes_run_as_they_say() {
        let table = Profile::Table { times: vec![1.0, 2.0, 4.0], factors: vec![0.5, 1.0, -1.0] };
        for (t, expected) in [(0.0, 0.5), (1.5, 0.75), (2.0, 1.0), (3.0, 0.0), (9.0, -1.0)] {
            assert_eq!(table.factor(t), expected, "{t}");
        }
        let ramp = Profile::Ramp { from: 0.2, duration: 2.0 };
        let ramped = [0.0, 1.0, 5.0].map(|t| ramp.factor(t));
        assert!(ramped.iter().zip([0.2, 0.6, 1.0]).all(|(a, b)| (a - b).abs() < 1e-15));
        let back = Profile::Reciprocating { frequency_hz: 2.0, phase: 0.0 };
        assert!((back.factor(0.25) + 1.0).abs() < 1e-15);
        let push = Push { direction: SparseVector::from_entries([(0, 2.0)]), begin: 1.0, duration: 2.0 };
        assert_eq!([push.factor(0.9), push.factor(2.0), push.factor(3.1)], [0.0, 1.0, 0.0]);
    }
}
