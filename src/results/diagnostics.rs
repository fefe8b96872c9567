//! Data of the pictures of a run in time, of bounded size however long it is.

use super::Channel;
use crate::dataset::{Column, Dimension, Group, Table, Values, Variable, column};
use crate::signal::{LimitCycle, Spectrogram};

/// Data gathered during the run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Diagnostics {
    /// Spectrograms of the channels shown, each with the index of its channel.
    pub spectrograms: Vec<(usize, Spectrogram)>,
    /// How large the oscillation of the channels shown is at the end, each with the index of its channel.
    pub cycles: Vec<(usize, LimitCycle)>,
    /// The first and last time of what the limit cycles are taken from \[s\].
    pub window: [f64; 2],
    /// The last periods.
    pub orbit: Orbit,
    /// States of the contact points.
    pub contact: ContactHistory,
}

/// The last periods of the motion, sample by sample.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Orbit {
    /// How many periods of the fundamental, or of the strongest line, they are, and its frequency \[Hz\].
    pub periods: [f64; 2],
    /// Velocity over displacement, and friction over the slip of the point that carries most where there is a contact.
    pub curves: Vec<PhaseCurve>,
}

/// One record over another.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PhaseCurve {
    /// The channels across and up.
    pub channels: [usize; 2],
    /// Their values, at least 200 a period: between the steps by Akima's interpolation.
    pub points: Vec<[f64; 2]>,
}

/// State of a contact point.
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

    /// Their names, in the same order.
    const NAMES: [&'static str; 4] = ["open", "sticking", "slipping backwards", "slipping forwards"];

    /// `open`, `sticking` …
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

/// States of the contact points over time: number of points, times steps, in each state in each column. Points that
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

impl Diagnostics {
    /// How large the oscillation of the channels shown is at the end.
    pub(super) fn cycle_table(&self, channels: &[Channel]) -> Table<'static> {
        let cycles: Vec<LimitCycleRow> =
            self.cycles.iter().map(|(channel, cycle)| (&channels[*channel], self.window, cycle)).collect();
        Table::of("limit_cycle", "cycle", &cycle_columns(), &cycles)
    }

    /// The channels shown over time and frequency.
    pub(super) fn spectrogram_groups<'a>(&'a self, channels: &'a [Channel]) -> Vec<Group<'a>> {
        let of =
            |(channel, spectrogram): &'a (usize, Spectrogram)| over_time(&channels[*channel], spectrogram);
        self.spectrograms.iter().map(of).collect()
    }
}

/// A channel, the window, and the size of the oscillation.
type LimitCycleRow<'a> = (&'a Channel, [f64; 2], &'a LimitCycle);

fn cycle_columns<'a>() -> Vec<Column<LimitCycleRow<'a>>> {
    vec![
        column("channel", "text", "name of the channel", |(channel, ..): &LimitCycleRow| {
            channel.name.clone()
        }),
        column("unit", "text", "its unit", |(channel, ..): &LimitCycleRow| channel.unit),
        column(
            "window_s",
            "s",
            "the first and the last time of what was analysed",
            |(_, window, _): &LimitCycleRow| *window,
        )
        .along(Dimension::limits()),
        column("amplitude", "unit", "half the range of the oscillation", |(.., c): &LimitCycleRow| {
            c.amplitude
        }),
        column("rms", "unit", "root of the mean square about the mean", |(.., c): &LimitCycleRow| c.rms),
        column("mean", "unit", "mean", |(.., c): &LimitCycleRow| c.mean),
        column("drift", "1", "relative change of the r.m.s. over the window", |(.., c): &LimitCycleRow| {
            c.drift
        }),
        column(
            "steady",
            "1",
            "whether the oscillation neither grew nor died away",
            |(.., c): &LimitCycleRow| c.steady(),
        ),
    ]
}

fn over_time<'a>(channel: &'a Channel, spectrogram: &'a Spectrogram) -> Group<'a> {
    let time = Dimension::of_variable("time_s", spectrogram.columns());
    let frequency = Dimension::of_variable("frequency_hz", spectrogram.rows);
    let times = Values::RealRows(Box::new(|k| vec![spectrogram.time(k)]));
    let frequencies = Values::RealRows(Box::new(|k| vec![k as f64 * spectrogram.resolution_hz]));
    let amplitudes = Values::RealRows(Box::new(|k| spectrogram.column(k).to_vec()));
    Group::new(&*channel.name, "a channel over time and frequency")
        .value("begin_s", "s", "time of the middle of the first segment", spectrogram.begin)
        .value("hop_s", "s", "from one segment to the next", spectrogram.hop)
        .value("segment_s", "s", "length of a segment", spectrogram.segment)
        .value("resolution_hz", "Hz", "Δf, from line to line", spectrogram.resolution_hz)
        .with(Variable::new("time_s", "s", "time of the middle of each segment", vec![time.clone()], times))
        .with(Variable::new("frequency_hz", "Hz", "frequency", vec![frequency.clone()], frequencies))
        .with(Variable::new(
            "amplitude",
            channel.unit,
            "amplitude of the sine that gives each line",
            vec![time, frequency],
            amplitudes,
        ))
}

impl ContactHistory {
    /// States over time; none where no point touched.
    pub(super) fn group(&self) -> Option<Group<'_>> {
        let time = Dimension::of_variable("time_s", self.counts.len());
        let states = Dimension::named("state", &TouchState::NAMES);
        let times = Values::RealRows(Box::new(|k| vec![k as f64 * self.column]));
        let counts = Values::RealRows(Box::new(|k| self.counts[k].map(|count| count as f64).to_vec()));
        (self.points > 0).then(|| {
            Group::new("contact_state", "what the contact points did over time")
                .value("column_s", "s", "how long a column lasts", self.column)
                .value("points", "1", "points that touched at some time", self.points)
                .with(Variable::new("time_s", "s", "begin of each column", vec![time.clone()], times))
                .with(Variable::new(
                    "counts",
                    "1",
                    "points times steps of each column in each state",
                    vec![time, states],
                    counts,
                ))
        })
    }
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
    use crate::bounds::{Origin::*, within};

    #[test]
    fn states_are_counted_in_columns() {
        let mut watch = ContactWatch::new(2000, 1e-5, 2);
        for k in 0..2000 {
            let swinging = if k % 4 == 0 { [0, 1, 0] } else { [0, 0, 1] };
            let late = usize::from(k >= 1000);
            watch.take([late, swinging[1], swinging[2]]);
        }
        let history = watch.finish();
        assert!(
            history.points == 2
                && history.counts.len() == 667
                && within((history.column - 3e-5).abs(), 1e-18, RoundOff)
        );
        let sum = history.counts.iter().fold([0; 4], |sum, c| [0, 1, 2, 3].map(|k| sum[k] + c[k]));
        assert_eq!(sum, [1000, 1000, 500, 1500]);
        assert!(history.counts[..666].iter().all(|c| c.iter().sum::<u64>() == 6));
        assert_eq!(history.counts[666].iter().sum::<u64>(), 4);
        assert_eq!(TouchState::ALL.map(|s| s as usize), [0, 1, 2, 3]);
    }
}
