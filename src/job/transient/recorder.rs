//! Recorder of the channels of every step.

use super::along::Along;
use super::channels::{ChannelSample, Channels, ShownChannel};
use super::modal::ModalMotion;
use super::places::{Gauge, ProbePlace};
use crate::equilibrium::SteadySliding;
use crate::error::Result;
use crate::linalg::c64;
use crate::results::{Channel, TouchState};
use crate::system::System;
use crate::transient::{Checkpoint, Event, EventKind, Marched, State, TransientModel, Watch};

/// Makes a row of every step: a value for each channel. Holds the rows that are not yet written.
pub(super) struct Recorder<'a> {
    pub(super) model: &'a TransientModel<'a>,
    /// The name of the pair of every contact point.
    pub(super) named: Vec<String>,
    /// The points of each pair.
    pub(super) pairs: Vec<std::ops::Range<usize>>,
    /// The point that carries most at the start.
    pub(super) point: usize,
    /// Whether motion is recorded anywhere.
    probed: bool,
    /// How a row is made of a step.
    pub(super) channels: Channels,
    /// Name, unit and story of each channel.
    pub(super) described: Vec<Channel>,
    /// The channels to show: acceleration, friction, and the force in the first load cell, those of them that there are.
    pub(super) shown: Vec<ShownChannel>,
    pub(super) along: Option<Along>,
    /// The rows at hand, by channel.
    pub(super) values: Vec<Vec<f64>>,
    /// Events at the contact points during these rows.
    pub(super) events: Vec<Event>,
    /// Whether each contact point has touched.
    pub(super) touched: Vec<bool>,
    /// Modal accelerations from which sound is computed, if it is requested.
    pub(super) modal: Option<ModalMotion>,
    /// How often each kind of event happened since the start.
    pub(super) happened: [usize; EventKind::ALL.len()],
    watch: Option<Watch>,
    /// u₀.
    origin: &'a [f64],
    /// u − u₀.
    moved: Vec<f64>,
    /// Rows in which the point that carries most was in each state of [`TouchState::ALL`].
    pub(super) spent: [usize; TouchState::ALL.len()],
}

impl<'a> Recorder<'a> {
    /// A recorder of a run of `model` from its steady state, whose contact point `point` carries most.
    pub(super) fn new(
        (system, point): (&System, usize),
        steady: &'a SteadySliding,
        model: &'a TransientModel<'a>,
        (probes, gauges): (Vec<ProbePlace>, Vec<Gauge>),
        along: Option<Along>,
        modal: Option<ModalMotion>,
    ) -> Self {
        let points = &steady.points;
        let mut channels = Channels::new(system, steady, (&probes, gauges), point, along.is_some());
        let mut first = 0;
        let pairs = system.pairs.iter().map(|pair| {
            first += pair.points.len();
            first - pair.points.len()..first
        });
        Recorder {
            model,
            named: system.points().map(|(pair, _)| pair.name.clone()).collect(),
            pairs: pairs.collect(),
            point,
            probed: !probes.is_empty(),
            values: vec![Vec::new(); channels.described.len()],
            described: std::mem::take(&mut channels.described),
            shown: std::mem::take(&mut channels.shown),
            channels,
            along,
            events: Vec::new(),
            touched: vec![false; points.len()],
            modal,
            happened: Default::default(),
            watch: None,
            origin: &steady.displacement,
            moved: Vec::new(),
            spent: [0; TouchState::ALL.len()],
        }
    }

    /// Adds the row of a step.
    pub(super) fn take(&mut self, marched: &Marched) {
        let state = &marched.state;
        let (counts, amplitude) = (self.look(state), self.amplitude(state));
        let sample = ChannelSample { model: self.model, marched, counts, amplitude };
        self.values.iter_mut().zip(self.channels.row(&sample)).for_each(|(all, value)| all.push(value));
        if let Some(modal) = &mut self.modal {
            modal.take(state.motion.col_as_slice(2));
        }
        let earlier = self.events.len();
        let watch = self.watch.get_or_insert_with(|| Watch::new(self.model, state));
        watch.look(self.model, state, &mut self.events);
        self.events[earlier..].iter().for_each(|event| self.happened[event.kind as usize] += 1);
    }

    /// The amplitude of the disturbed mode; zero without one.
    fn amplitude(&mut self, state: &State) -> c64 {
        let Some(along) = &self.along else { return c64::new(0.0, 0.0) };
        let (u, v) = (state.motion.col_as_slice(0), state.motion.col_as_slice(1));
        self.moved.clear();
        self.moved.extend(u.iter().zip(self.origin).map(|(u, origin)| u - origin));
        along.filter.amplitude(&self.moved, v) * along.largest
    }

    /// The channels that are drawn over each other: velocity over displacement, friction over slip.
    pub(super) fn orbits(&self) -> Vec<[usize; 2]> {
        // The first probe comes first; the slip follows the penetration.
        let motion = self.probed.then_some([0, 1]);
        let friction = self.shown.get(1).filter(|_| !self.pairs.is_empty());
        let friction = friction.map(|friction| [self.channels.penetration + 1, friction.channel]);
        motion.into_iter().chain(friction).collect()
    }

    /// Number of rows at hand.
    pub(super) fn rows(&self) -> usize {
        self.values.first().map_or(0, Vec::len)
    }

    /// Lets go of the rows at hand.
    pub(super) fn forget(&mut self) {
        self.values.iter_mut().for_each(Vec::clear);
        self.events.clear();
        self.modal.iter_mut().for_each(ModalMotion::forget);
    }

    /// Adds what the rows to come depend on.
    pub(super) fn put(&self, checkpoint: &mut Checkpoint) {
        checkpoint.put("recorder", &self.spent.map(|count| count as f64));
        checkpoint.put("events", &self.happened.map(|count| count as f64));
        let touched: Vec<f64> = self.touched.iter().map(|touched| f64::from(*touched)).collect();
        checkpoint.put("touched", &touched);
    }

    /// Goes on from what was put away together with a march.
    /// Refuses a checkpoint of another model.
    pub(super) fn restore(&mut self, checkpoint: &Checkpoint, marched: &Marched) -> Result<()> {
        self.forget();
        self.spent = checkpoint.numbers("recorder")?.map(|count| count as usize);
        self.happened = checkpoint.numbers("events")?.map(|count| count as usize);
        let mut touched = vec![0.0; self.touched.len()];
        checkpoint.get("touched", &mut touched)?;
        self.touched = touched.into_iter().map(|touched| touched == 1.0).collect();
        self.watch = Some(Watch::new(self.model, &marched.state));
        Ok(())
    }

    /// How many points are in each state of [`TouchState::ALL`].
    fn look(&mut self, state: &State) -> [usize; TouchState::ALL.len()] {
        let mut counts = [0; TouchState::ALL.len()];
        for (pair, points) in self.pairs.iter().enumerate() {
            for point in points.clone() {
                let does = does(self.model, state, pair, point);
                counts[does as usize] += 1;
                self.touched[point] |= does != TouchState::Open;
                if point == self.point {
                    self.spent[does as usize] += 1;
                }
            }
        }
        counts
    }
}

/// State of a contact point of a pair.
fn does(model: &TransientModel<'_>, state: &State, pair: usize, point: usize) -> TouchState {
    if state.contact_forces(point)[0] == 0.0 && !model.is_bilateral(point) {
        TouchState::Open
    } else if state.sticks(point) {
        TouchState::Stick
    } else if state.slip_velocity(model, point)[0] * state.speeds()[pair] < 0.0 {
        TouchState::Backwards
    } else {
        TouchState::Forwards
    }
}
