//! Time-dependent input: velocities of the counter-bodies, load histories, and pulse loads.

use crate::linalg::SparseVector;
use std::f64::consts::{PI, TAU};

/// How a sliding velocity or a load runs in time: V(t) = V · factor(t).
#[derive(Debug, Clone, PartialEq, Default)]
pub enum TimeProfile {
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

impl TimeProfile {
    /// factor(t).
    pub fn factor(&self, time: f64) -> f64 {
        match self {
            TimeProfile::Constant => 1.0,
            TimeProfile::Ramp { from, duration } => {
                let done = if *duration > 0.0 { (time / duration).clamp(0.0, 1.0) } else { 1.0 };
                from + (1.0 - from) * done
            }
            TimeProfile::Reciprocating { frequency_hz, phase } => (TAU * frequency_hz * time + phase).cos(),
            TimeProfile::Table { times, factors } => {
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

impl TimeProfile {
    /// ∫factor dt from 0 to `time` \[s\]: V times it is how far a counter-body has come.
    pub fn integral(&self, time: f64) -> f64 {
        match self {
            TimeProfile::Constant => time,
            TimeProfile::Ramp { from, duration } => {
                let ramped = time.min(*duration);
                let over =
                    if *duration > 0.0 { 0.5 * (1.0 - from) * ramped * ramped / duration } else { 0.0 };
                from * ramped + over + (time - ramped)
            }
            TimeProfile::Reciprocating { frequency_hz, phase } => {
                let omega = TAU * frequency_hz;
                ((omega * time + phase).sin() - phase.sin()) / omega
            }
            TimeProfile::Table { times, .. } => {
                // The trapezoidal rule is exact between the kinks.
                let kinks = times.iter().copied().filter(|t| *t > 0.0 && *t < time);
                let (mut at, mut sum) = ((0.0, self.factor(0.0)), 0.0);
                for t in kinks.chain([time]) {
                    let next = (t, self.factor(t));
                    sum += 0.5 * (next.0 - at.0) * (at.1 + next.1);
                    at = next;
                }
                sum
            }
        }
    }

    /// The least and the greatest of [`TimeProfile::integral`] from 0 to `duration` \[s\].
    pub fn reach(&self, duration: f64) -> [f64; 2] {
        let mut turns = vec![0.0, duration];
        match self {
            TimeProfile::Constant => {}
            TimeProfile::Ramp { from, duration: whole } => turns.push(whole * from / (from - 1.0)),
            TimeProfile::Reciprocating { frequency_hz, phase } => {
                // cos is zero at (k + ½)π: as many turns as it takes for every one to have come.
                let first = ((phase / PI - 0.5).ceil() as i64).max(i64::MIN / 2);
                let turn = |k: i64| ((k as f64 + 0.5) * PI - phase) / (TAU * frequency_hz);
                turns.extend((0..3).map(|k| turn(first + k)));
            }
            TimeProfile::Table { times, factors } => {
                turns.extend(times);
                for (t, f) in times.windows(2).zip(factors.windows(2)).filter(|(_, f)| f[0] * f[1] < 0.0) {
                    turns.push(t[0] + (t[1] - t[0]) * f[0] / (f[0] - f[1]));
                }
            }
        }
        let within = turns.into_iter().filter(|t| (0.0..=duration).contains(t)).map(|t| self.integral(t));
        within.fold([0.0, 0.0], |[low, high], s| [low.min(s), high.max(s)])
    }
}

/// A force on the structure that runs in time, beside the constant load: p(t) times a direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Push {
    /// The force on the degrees of freedom \[N, N m\] at p = 1.
    pub direction: SparseVector,
    /// p(t).
    pub course: Pulse,
}

/// p(t) of a force.
#[derive(Debug, Clone, PartialEq)]
pub enum Pulse {
    /// A half sine, sin(π (t − begin)/duration) while it lasts.
    HalfSine {
        /// When it begins \[s\].
        begin: f64,
        /// How long it lasts \[s\].
        duration: f64,
    },
    /// factor(t) − 1 of a profile: what a force that is part of the constant load has more or less than that.
    Change(TimeProfile),
}

impl Push {
    /// p(t).
    pub fn factor(&self, time: f64) -> f64 {
        match &self.course {
            Pulse::HalfSine { begin, duration } => {
                let part = (time - begin) / duration;
                if part > 0.0 && part < 1.0 { (PI * part).sin() } else { 0.0 }
            }
            Pulse::Change(profile) => profile.factor(time) - 1.0,
        }
    }
}

/// The approach of a pair whose closing load runs in time: that of steady equilibrium under the load of the moment, as of
/// a loading device without inertia that follows slowly.
#[derive(Debug, Clone, PartialEq)]
pub struct Loading {
    /// How the load runs.
    pub profile: TimeProfile,
    /// The approach \[m\] at equally spaced factors from the first to the last of `factors`; linear between them.
    pub approaches: Vec<f64>,
    /// The least and the greatest factor of the load.
    pub factors: [f64; 2],
}

impl Loading {
    /// The approach at a time \[m\].
    pub fn approach(&self, time: f64) -> f64 {
        let last = self.approaches.len() - 1;
        let [low, high] = self.factors;
        let place = (self.profile.factor(time) - low) / (high - low).max(f64::MIN_POSITIVE) * last as f64;
        let place = place.clamp(0.0, last as f64);
        let from = (place as usize).min(last.saturating_sub(1));
        let next = (from + 1).min(last);
        self.approaches[from] + (place - from as f64) * (self.approaches[next] - self.approaches[from])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn profiles_and_pushes_run_as_they_say() {
        let table = TimeProfile::Table { times: vec![1.0, 2.0, 4.0], factors: vec![0.5, 1.0, -1.0] };
        for (t, expected) in [(0.0, 0.5), (1.5, 0.75), (2.0, 1.0), (3.0, 0.0), (9.0, -1.0)] {
            assert_eq!(table.factor(t), expected, "{t}");
        }
        let ramp = TimeProfile::Ramp { from: 0.2, duration: 2.0 };
        let ramped = [0.0, 1.0, 5.0].map(|t| ramp.factor(t));
        assert!(ramped.iter().zip([0.2, 0.6, 1.0]).all(|(a, b)| within(
            (a - b).abs(),
            10.0 * f64::EPSILON,
            RoundOff
        )));
        let back = TimeProfile::Reciprocating { frequency_hz: 2.0, phase: 0.0 };
        assert!(within((back.factor(0.25) + 1.0).abs(), 1e-15, RoundOff));
        // ∫factor against the midpoint rule, and its reach against all of its values.
        let other = TimeProfile::Reciprocating { frequency_hz: 2.0, phase: 1.1 };
        let falling = TimeProfile::Ramp { from: -0.5, duration: 2.0 };
        for profile in [table, ramp, back, other, falling, TimeProfile::Constant] {
            let (mut sum, mut low, mut high) = (0.0, 0.0f64, 0.0f64);
            for k in 0..50_000 {
                sum += 1e-4 * profile.factor((f64::from(k) + 0.5) * 1e-4);
                (low, high) = (low.min(sum), high.max(sum));
            }
            assert!(within((profile.integral(5.0) - sum).abs(), 1e-6, Discretisation), "{profile:?}");
            let reach = profile.reach(5.0);
            assert!(
                within((reach[0] - low).abs(), 1e-6, Discretisation)
                    && within((reach[1] - high).abs(), 1e-6, Discretisation),
                "{profile:?} {reach:?}"
            );
        }
        let half_sine = Pulse::HalfSine { begin: 1.0, duration: 2.0 };
        let push = Push { direction: SparseVector::from_entries([(0, 2.0)]), course: half_sine };
        assert_eq!([push.factor(0.9), push.factor(2.0), push.factor(3.1)], [0.0, 1.0, 0.0]);
        let ramp = TimeProfile::Ramp { from: 0.0, duration: 2.0 };
        let less = Push { course: Pulse::Change(ramp.clone()), ..push };
        assert_eq!([less.factor(0.0), less.factor(1.0), less.factor(2.0)], [-1.0, -0.5, 0.0]);
        let loading = Loading { profile: ramp, approaches: vec![0.0, 2.0, 3.0], factors: [0.0, 1.0] };
        assert_eq!([0.0, 0.5, 1.0, 2.0].map(|t| loading.approach(t)), [0.0, 1.0, 2.0, 3.0]);
    }
}
