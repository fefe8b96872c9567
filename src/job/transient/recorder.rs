//! What is recorded of every step.

use super::along::Along;
use super::modal::ModalMotion;
use super::places::{Gauge, Probe};
use crate::equilibrium::SteadySliding;
use crate::error::Result;
use crate::linalg::SparseVector;
use crate::results::{Channel, TouchState};
use crate::system::System;
use crate::transient::{Checkpoint, Event, EventKind, Marched, Model, State, Watch};

/// Makes a row of every step: a value for each channel. Holds the rows that are not yet written.
pub(super) struct Recorder<'a> {
    model: &'a Model<'a>,
    /// Directions, and where they stand in steady sliding.
    probes: Vec<(SparseVector, f64)>,
    /// k and c of the springs whose force is recorded.
    gauges: Vec<[SparseVector; 2]>,
    /// The name of the pair of every contact point.
    pub(super) named: Vec<String>,
    /// The points of each pair.
    pairs: Vec<std::ops::Range<usize>>,
    /// The point that carries most at the start.
    point: usize,
    pub(super) channels: Vec<Channel>,
    /// The channels to show: acceleration, friction, and the force in the first load cell, those of them that there are.
    pub(super) shown: Vec<Shown>,
    /// The channel of the penetration of the most loaded point.
    pub(super) penetration: usize,
    pub(super) along: Option<Along>,
    /// The channels of its amplitude, re and im.
    pub(super) amplitude: [usize; 2],
    /// The rows at hand, by channel.
    pub(super) values: Vec<Vec<f64>>,
    /// What happened at the contact points during these rows.
    pub(super) events: Vec<Event>,
    /// The channels that count the points that stick, slip backwards and slip forwards begin here.
    pub(super) states: Option<usize>,
    /// Whether each contact point has touched.
    pub(super) touched: Vec<bool>,
    /// What the sound is made of, if it is asked for.
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

/// A channel to show, and the peaks that were measured in its place \[Hz\].
#[derive(Debug, Clone)]
pub(super) struct Shown {
    pub(super) channel: usize,
    pub(super) measured: Vec<f64>,
}

impl<'a> Recorder<'a> {
    pub(super) fn new(
        system: &System,
        steady: &'a SteadySliding,
        model: &'a Model<'a>,
        (mut probes, gauges): (Vec<Probe>, Vec<Gauge>),
        along: Option<Along>,
        modal: Option<ModalMotion>,
    ) -> Self {
        let points = &steady.points;
        let heaviest = |a: &usize, b: &usize| points[*a].forces.normal.total_cmp(&points[*b].forces.normal);
        let point = (0..points.len()).max_by(heaviest).unwrap_or(0);
        if probes.is_empty()
            && let Some((_, place)) = system.points().nth(point)
        {
            let direction = place.tangents[0].clone();
            let place = "the point that carries most".into();
            probes.push(Probe { name: "contact".into(), place, direction, measured: Vec::new() });
        }
        let mut channels = Vec::new();
        let mut add = |name: String, unit: &'static str, about: String| {
            channels.push(Channel::new(name, unit, about));
            channels.len() - 1
        };
        let (mut shown, mut cell) = (Vec::new(), None);
        for Probe { name, place, measured, .. } in &probes {
            add(
                format!("{name}_displacement"),
                "m",
                format!("displacement at {name} ({place}), from steady sliding"),
            );
            add(format!("{name}_velocity"), "m/s", format!("velocity at {name} ({place})"));
            let channel =
                add(format!("{name}_acceleration"), "m/s^2", format!("acceleration at {name} ({place})"));
            if shown.is_empty() {
                shown.push(Shown { channel, measured: measured.clone() });
            }
        }
        for gauge in &gauges {
            let about = format!("force in the spring {}", gauge.spring);
            let channel = add(format!("{}_force", gauge.name), "N", about);
            cell.get_or_insert(Shown { channel, measured: gauge.measured.clone() });
        }
        let gauges = gauges.into_iter().map(|gauge| [gauge.stiffness, gauge.damping]).collect();
        let mut first = 0;
        let mut pairs = Vec::new();
        for (k, pair) in system.pairs.iter().enumerate() {
            pairs.push(first..first + pair.points.len());
            first += pair.points.len();
            let name = &pair.name;
            add(format!("{name}_normal_force"), "N", format!("sum of the normal forces of {name}"));
            let friction = add(
                format!("{name}_friction_force"),
                "N",
                format!("sum of friction of {name} on the body along the sliding direction"),
            );
            add(format!("{name}_sliding_velocity"), "m/s", format!("velocity of the counter-body of {name}"));
            if k == 0 {
                shown.push(Shown { channel: friction, measured: Vec::new() });
            }
        }
        shown.extend(cell);
        let penetration =
            add("penetration".into(), "m", "of the point that carries most in steady sliding".into());
        add("slip_velocity".into(), "m/s", "of the same point along the sliding direction".into());
        let states = (!points.is_empty()).then(|| {
            let of = |words: &str| format!("contact points that {words}");
            add("points_sticking".into(), "1", of("stick"));
            add("points_backwards".into(), "1", of("slip against the motion of the counter-body"));
            add("points_forwards".into(), "1", of("slip as the counter-body moves")) - 2
        });
        let story = "½vᵀMv + ½uᵀKu gained since the start";
        add("energy_stored".into(), "J", story.into());
        for (name, about) in [
            ("energy_drive", "spent by the drives of the counter-bodies against friction"),
            ("energy_heat", "turned into heat by friction"),
            ("energy_damping", "taken by structural damping (negative)"),
            ("energy_algorithm", "added by the integrator (mostly negative)"),
        ] {
            add(name.into(), "J", format!("{about}, since the start"));
        }
        let amplitude = [("mode_re", "real"), ("mode_im", "imaginary")].map(|(name, part)| {
            let about =
                format!("{part} part of the amplitude of the disturbed mode, its largest translation");
            if along.is_some() { add(name.into(), "m", about) } else { 0 }
        });
        let placed = |probe: Probe| {
            let origin = probe.direction.dot(&steady.displacement);
            (probe.direction, origin)
        };
        let probes = probes.into_iter().map(placed).collect();
        let (origin, moved) = (&steady.displacement, Vec::new());
        let values = vec![Vec::new(); channels.len()];
        Recorder {
            model,
            probes,
            gauges,
            named: system.points().map(|(pair, _)| pair.name.clone()).collect(),
            pairs,
            point,
            channels,
            shown,
            penetration,
            along,
            amplitude,
            values,
            events: Vec::new(),
            states,
            touched: vec![false; points.len()],
            modal,
            happened: Default::default(),
            watch: None,
            origin,
            moved,
            spent: [0; TouchState::ALL.len()],
        }
    }

    /// Adds the row of a step.
    pub(super) fn take(&mut self, marched: &Marched) {
        let Marched { state, work, .. } = marched;
        let mut row = Vec::with_capacity(self.channels.len());
        for (direction, origin) in &self.probes {
            row.push(direction.dot(state.motion.col_as_slice(0)) - origin);
            row.extend([1, 2].map(|k| direction.dot(state.motion.col_as_slice(k))));
        }
        for [stiffness, damping] in &self.gauges {
            let [u, v] = [0, 1].map(|k| state.motion.col_as_slice(k));
            row.push(stiffness.dot(u) + damping.dot(v));
        }
        for (k, points) in self.pairs.iter().enumerate() {
            let sum = |component: usize| -> f64 {
                points.clone().map(|p| state.contact_forces(p)[component]).sum()
            };
            row.extend([sum(0), sum(1), state.speeds()[k]]);
        }
        let slip = if self.pairs.is_empty() { 0.0 } else { state.slip_velocity(self.model, self.point)[0] };
        let deep = if self.pairs.is_empty() { 0.0 } else { state.penetration(self.point) };
        row.extend([deep, slip]);
        if self.states.is_some() {
            let [_, counts @ ..] = self.look(state);
            row.extend(counts.map(|count| count as f64));
        }
        row.extend([work.kinetic + work.strain, work.drive, work.heat, work.damping]);
        row.push(work.algorithm);
        if let Some(along) = &self.along {
            let (u, v) = (state.motion.col_as_slice(0), state.motion.col_as_slice(1));
            self.moved.clear();
            self.moved.extend(u.iter().zip(self.origin).map(|(u, origin)| u - origin));
            let amplitude = along.filter.amplitude(&self.moved, v) * along.largest;
            row.extend([amplitude.re, amplitude.im]);
        }
        self.values.iter_mut().zip(row).for_each(|(values, value)| values.push(value));
        if let Some(modal) = &mut self.modal {
            modal.take(state.motion.col_as_slice(2));
        }
        let earlier = self.events.len();
        let watch = self.watch.get_or_insert_with(|| Watch::new(self.model, state));
        watch.look(self.model, state, &mut self.events);
        self.events[earlier..].iter().for_each(|event| self.happened[event.kind as usize] += 1);
    }

    /// The channels that are drawn over each other: velocity over displacement, friction over slip.
    pub(super) fn orbits(&self) -> Vec<[usize; 2]> {
        // The first probe comes first; the slip follows the penetration.
        let motion = (!self.probes.is_empty()).then_some([0, 1]);
        let friction = self.shown.get(1).filter(|_| !self.pairs.is_empty());
        let friction = friction.map(|friction| [self.penetration + 1, friction.channel]);
        motion.into_iter().chain(friction).collect()
    }

    /// How many rows are at hand.
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
    ///
    /// # Errors
    /// Input: it is of another model.
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

/// What a contact point of a pair does.
fn does(model: &Model<'_>, state: &State, pair: usize, point: usize) -> TouchState {
    if state.contact_forces(point)[0] == 0.0 {
        TouchState::Open
    } else if state.sticks(point) {
        TouchState::Stick
    } else if state.slip_velocity(model, point)[0] * state.speeds()[pair] < 0.0 {
        TouchState::Backwards
    } else {
        TouchState::Forwards
    }
}
