//! What a run in time looks like: the data of its pictures, of bounded size however long it is.

use crate::signal::{LimitCycle, Spectrogram};

/// Data that was gathered while the run went on.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Watched {
    /// Spectrograms of the channels shown, each with the index of its channel.
    pub spectrograms: Vec<(usize, Spectrogram)>,
    /// How large the oscillation of the channels shown is at the end, each with the index of its channel.
    pub cycles: Vec<(usize, LimitCycle)>,
    /// The first and last time of what the limit cycles are taken from \[s\].
    pub window: [f64; 2],
    /// The last periods.
    pub orbit: Orbit,
    /// What the contact points did.
    pub contact: ContactHistory,
}

/// The last periods of the motion, sample by sample.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Orbit {
    /// How many periods of the strongest line they are, and its frequency \[Hz\].
    pub periods: [f64; 2],
    /// Velocity over displacement, and friction over the slip of the point that carries most where there is a contact.
    pub curves: Vec<Curve>,
}

/// One record over another.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curve {
    /// What is across and what is up, with units.
    pub axes: [String; 2],
    /// Their values.
    pub points: Vec<[f64; 2]>,
}

/// What a contact point does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TouchState {
    /// It does not touch.
    Open,
    /// It sticks.
    Stick,
    /// It slips against the motion of the counter-body.
    Backwards,
    /// It slips as the counter-body moves.
    Forwards,
}

impl TouchState {
    /// All of them, in the order of [`ContactHistory::counts`].
    pub const ALL: [TouchState; 4] =
        [TouchState::Open, TouchState::Stick, TouchState::Backwards, TouchState::Forwards];

    /// `open`, `stick` …
    pub fn name(self) -> &'static str {
        match self {
            TouchState::Open => "open",
            TouchState::Stick => "sticking",
            TouchState::Backwards => "slipping backwards",
            TouchState::Forwards => "slipping forwards",
        }
    }
}

/// What the contact points did over time: how many of them, times steps, were in which state in each column. Points that
/// never touched are left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ContactHistory {
    /// How long a column lasts \[s\].
    pub column: f64,
    /// Points that touched at some time.
    pub points: usize,
    /// Counts in the order of [`TouchState::ALL`].
    pub counts: Vec<[u64; 4]>,
}

/// Columns of a [`ContactHistory`].
const COLUMNS: usize = 840;

/// Gathers a [`ContactHistory`], in bounded memory.
#[derive(Debug)]
pub(crate) struct ContactWatch {
    step: f64,
    /// Steps a column.
    each: usize,
    taken: usize,
    points: usize,
    counts: Vec<[u64; 4]>,
}

impl ContactWatch {
    /// For `samples` moments, one every `step` seconds, of `points` contact points that touch at some time.
    pub(crate) fn new(samples: usize, step: f64, points: usize) -> Self {
        let each = samples.div_ceil(COLUMNS).max(1);
        ContactWatch { step, each, taken: 0, points, counts: Vec::new() }
    }

    /// How many points stick, slip backwards and slip forwards at the next moment.
    pub(crate) fn take(&mut self, [stick, backwards, forwards]: [usize; 3]) {
        if self.taken.is_multiple_of(self.each) {
            self.counts.push([0; 4]);
        }
        self.taken += 1;
        let Some(column) = self.counts.last_mut() else { return };
        let open = self.points.saturating_sub(stick + backwards + forwards);
        let states = [open, stick, backwards, forwards];
        column.iter_mut().zip(states).for_each(|(sum, count)| *sum += count as u64);
    }

    /// The history.
    pub(crate) fn finish(self) -> ContactHistory {
        let ContactWatch { step, each, points, counts, .. } = self;
        ContactHistory { column: each as f64 * step, points, counts }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_are_counted_in_columns() {
        let mut watch = ContactWatch::new(2000, 1e-5, 2);
        for k in 0..2000 {
            let swinging = if k % 4 == 0 { [0, 1, 0] } else { [0, 0, 1] };
            let late = usize::from(k >= 1000);
            watch.take([late, swinging[1], swinging[2]]);
        }
        let history = watch.finish();
        assert!(history.points == 2 && history.counts.len() == 667 && (history.column - 3e-5).abs() < 1e-18);
        let sum = history.counts.iter().fold([0; 4], |sum, c| [0, 1, 2, 3].map(|k| sum[k] + c[k]));
        assert_eq!(sum, [1000, 1000, 500, 1500]);
        assert!(history.counts[..666].iter().all(|c| c.iter().sum::<u64>() == 6));
        assert_eq!(history.counts[666].iter().sum::<u64>(), 4);
        assert_eq!(TouchState::ALL.map(|s| s as usize), [0, 1, 2, 3]);
    }
}
