//! What a run in time looks like: gathers the data of its pictures, in bounded memory.

use crate::results::{ContactWatch, Orbit, SpectrumOf, TouchState, Watched};
use crate::signal::{ShortTime, limit_cycle};
use crate::transient::{Model, State};

/// The size of an oscillation is taken from this last part of the run, and from no more steps than these.
const PART: usize = 4;
const TAIL: usize = 1 << 16;
/// Periods of the strongest line that a phase plane shows, and points that it has at most.
const PERIODS: f64 = 12.0;
const POINTS: usize = 4000;

/// What a moment shows of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Glance {
    /// Displacement \[m\] and velocity \[m/s\] of the motion shown.
    pub motion: [f64; 2],
    /// The friction force shown \[N\].
    pub friction: f64,
    /// Slip velocity of the point that carries most \[m/s\].
    pub slip: f64,
}

/// Watches a run.
#[derive(Debug)]
pub struct Watch {
    step: f64,
    /// The channels shown: motion and friction.
    shown: [usize; 2],
    spectrograms: [ShortTime; 2],
    contact: ContactWatch,
    taken: usize,
    /// The first moment of the tail.
    begin: usize,
    tail: Vec<Glance>,
}

impl Watch {
    /// For a run of `steps` steps of `step` seconds with `points` contact points, whose channels `shown` are the
    /// velocity and the friction force of a [`Glance`]; spectrograms reach up to `top_hz`.
    pub fn new(steps: usize, step: f64, points: usize, shown: [usize; 2], top_hz: f64) -> Self {
        let samples = steps + 1;
        let short = || ShortTime::new(samples, step, top_hz);
        Watch {
            step,
            shown,
            spectrograms: [short(), short()],
            contact: ContactWatch::new(samples, step, points),
            taken: 0,
            begin: samples - (samples / PART).clamp(1, TAIL),
            tail: Vec::new(),
        }
    }

    /// The next moment.
    pub fn take(
        &mut self,
        glance: Glance,
        model: &Model<'_>,
        state: &State,
        pair_of: impl Fn(usize) -> usize,
    ) {
        let [motion, friction] = &mut self.spectrograms;
        motion.take(glance.motion[1]);
        friction.take(glance.friction);
        let points = self.contact.points();
        self.contact.take((0..points).map(|p| point_state(model, state, p, pair_of(p))));
        if self.taken >= self.begin {
            self.tail.push(glance);
        }
        self.taken += 1;
    }

    /// What was seen; `spectra` are those of the channels shown.
    pub fn finish(self, spectra: &[SpectrumOf]) -> Watched {
        let strongest = |channel: usize| {
            let of = spectra.iter().find(|of| of.channel == channel)?;
            let peak = of.peaks.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))?;
            Some(peak.frequency_hz)
        };
        let records: [Vec<f64>; 2] = [
            self.tail.iter().map(|glance| glance.motion[1]).collect(),
            self.tail.iter().map(|glance| glance.friction).collect(),
        ];
        let cycles = self.shown.iter().zip(&records).filter_map(|(channel, record)| {
            Some((*channel, limit_cycle(record, self.step, strongest(*channel)?)?))
        });
        let cycles = cycles.collect();
        let orbit = strongest(self.shown[0]).map(|hz| {
            let wanted = ((PERIODS / (hz * self.step)).ceil() as usize).max(1);
            let last = &self.tail[self.tail.len() - wanted.min(self.tail.len())..];
            let kept: Vec<&Glance> = last.iter().step_by(last.len().div_ceil(POINTS).max(1)).collect();
            Orbit {
                periods: [last.len() as f64 * self.step * hz, hz],
                motion: kept.iter().map(|glance| glance.motion).collect(),
                friction: kept.iter().map(|glance| [glance.slip, glance.friction]).collect(),
            }
        });
        let spectrograms = self.spectrograms.map(ShortTime::finish);
        Watched {
            spectrograms: self.shown.into_iter().zip(spectrograms).filter(|(_, s)| s.columns() > 0).collect(),
            cycles,
            window: [self.begin as f64 * self.step, self.taken.saturating_sub(1) as f64 * self.step],
            orbit: orbit.unwrap_or_default(),
            contact: self.contact.finish(),
        }
    }
}

/// What a contact point of a pair does.
fn point_state(model: &Model<'_>, state: &State, point: usize, pair: usize) -> TouchState {
    if state.contact_forces(point)[0] == 0.0 {
        TouchState::Open
    } else if state.slip_velocity(model, point)[0] * state.speeds()[pair] < 0.0 {
        TouchState::Backwards
    } else {
        TouchState::Forwards
    }
}
