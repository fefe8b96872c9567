//! The channels of a run in time: the name, the unit and the value of each.

use super::places::{Gauge, ProbePlace};
use crate::equilibrium::SteadySliding;
use crate::linalg::{SparseVector, c64};
use crate::results::{Channel, TouchState};
use crate::system::System;
use crate::transient::{Marched, TransientModel};
use std::sync::Arc;

/// A step from which a row is made.
pub(super) struct ChannelSample<'s> {
    pub(super) model: &'s TransientModel<'s>,
    pub(super) marched: &'s Marched,
    /// Contact points in each state of [`TouchState::ALL`].
    pub(super) counts: [usize; TouchState::ALL.len()],
    /// The amplitude of the disturbed mode, its largest translation \[m\].
    pub(super) amplitude: c64,
}

impl ChannelSample<'_> {
    /// Displacement, velocity or acceleration (0, 1, 2) of all degrees of freedom.
    fn motion(&self, derivative: usize) -> &[f64] {
        self.marched.state.motion.col_as_slice(derivative)
    }
}

type ChannelValue = Box<dyn Fn(&ChannelSample<'_>) -> f64 + Send + Sync>;

/// A channel to show, and the peaks that were measured in its place \[Hz\].
#[derive(Debug, Clone)]
pub(super) struct ShownChannel {
    pub(super) channel: usize,
    pub(super) measured: Vec<f64>,
}

/// All channels.
#[derive(Default)]
pub(super) struct Channels {
    pub(super) described: Vec<Channel>,
    values: Vec<ChannelValue>,
    /// The channels to show: acceleration, friction, and the force in the first load cell, those of them that there are.
    pub(super) shown: Vec<ShownChannel>,
    /// The channel of the penetration of the most loaded point; its slip follows.
    pub(super) penetration: usize,
    /// The channel of the velocity of each counter-body.
    pub(super) speeds: Vec<usize>,
    /// The channels that count the points that stick, slip backwards and slip forwards begin here.
    pub(super) states: Option<usize>,
    /// The channels of the amplitude of the disturbed mode, re and im.
    pub(super) amplitude: [usize; 2],
}

impl Channels {
    /// The channels of `probes`, `gauges` and the contact pairs, of the contact point `point`, of energies and, where the run
    /// is `disturbed`, of the amplitude of the disturbed mode.
    pub(super) fn new(
        system: &System,
        steady: &SteadySliding,
        (probes, gauges): (&[ProbePlace], Vec<Gauge>),
        point: usize,
        disturbed: bool,
    ) -> Self {
        let mut all = Channels::default();
        all.probes(probes, steady);
        let cell = all.gauges(gauges);
        all.pairs(system);
        all.shown.extend(cell);
        all.contact(point, !steady.points.is_empty());
        all.energies();
        if disturbed {
            all.disturbance();
        }
        all
    }

    /// The values of a step, one a channel.
    pub(super) fn row<'r>(&'r self, sample: &'r ChannelSample<'_>) -> impl Iterator<Item = f64> + 'r {
        self.values.iter().map(|value| value(sample))
    }

    fn add(
        &mut self,
        name: impl Into<String>,
        unit: &'static str,
        about: impl Into<String>,
        value: impl Fn(&ChannelSample<'_>) -> f64 + Send + Sync + 'static,
    ) -> usize {
        self.described.push(Channel::new(name.into(), unit, about.into()));
        self.values.push(Box::new(value));
        self.values.len() - 1
    }

    /// Motion along a direction: dᵀ(u − u₀), dᵀu̇, dᵀü.
    fn probes(&mut self, probes: &[ProbePlace], steady: &SteadySliding) {
        for ProbePlace { name, place, measured, direction } in probes {
            let origin = direction.dot(&steady.displacement);
            let direction = Arc::new(direction.clone());
            let along = |derivative: usize| {
                let direction = direction.clone();
                move |sample: &ChannelSample<'_>| direction.dot(sample.motion(derivative))
            };
            let displacement = along(0);
            let about = format!("displacement at {name} ({place}), from steady sliding");
            self.add(format!("{name}_displacement"), "m", about, move |s| displacement(s) - origin);
            let about = format!("velocity at {name} ({place})");
            self.add(format!("{name}_velocity"), "m/s", about, along(1));
            let about = format!("acceleration at {name} ({place})");
            let channel = self.add(format!("{name}_acceleration"), "m/s^2", about, along(2));
            if self.shown.is_empty() {
                self.shown.push(ShownChannel { channel, measured: measured.clone() });
            }
        }
    }

    /// Forces kᵀu + cᵀu̇ in springs; gives the first of them.
    fn gauges(&mut self, gauges: Vec<Gauge>) -> Option<ShownChannel> {
        let mut first = None;
        for Gauge { name, spring, stiffness, damping, measured, .. } in gauges {
            let force = move |sample: &ChannelSample<'_>| {
                let part = |row: &SparseVector, derivative| row.dot(sample.motion(derivative));
                part(&stiffness, 0) + part(&damping, 1)
            };
            let channel =
                self.add(format!("{name}_force"), "N", format!("force in the spring {spring}"), force);
            first.get_or_insert(ShownChannel { channel, measured });
        }
        first
    }

    /// ΣN, ΣF₁ and the sliding velocity of each pair.
    fn pairs(&mut self, system: &System) {
        let mut first = 0;
        for (k, pair) in system.pairs.iter().enumerate() {
            let (name, points) = (&pair.name, first..first + pair.points.len());
            first = points.end;
            let sum = |component: usize| {
                let points = points.clone();
                move |sample: &ChannelSample<'_>| -> f64 {
                    points.clone().map(|p| sample.marched.state.contact_forces(p)[component]).sum()
                }
            };
            let about = format!("sum of the normal forces of {name}");
            self.add(format!("{name}_normal_force"), "N", about, sum(0));
            let about = format!("sum of friction of {name} on the body along the sliding direction");
            let friction = self.add(format!("{name}_friction_force"), "N", about, sum(1));
            let about = format!("velocity of the counter-body of {name}");
            let speed = move |sample: &ChannelSample<'_>| sample.marched.state.speeds()[k];
            let speed = self.add(format!("{name}_sliding_velocity"), "m/s", about, speed);
            self.speeds.push(speed);
            if k == 0 {
                self.shown.push(ShownChannel { channel: friction, measured: Vec::new() });
            }
        }
    }

    /// Penetration and slip of the most loaded point, and how many points are in each state; zero without contact.
    fn contact(&mut self, point: usize, touches: bool) {
        let deep = move |sample: &ChannelSample<'_>| {
            if touches { sample.marched.state.penetration(sample.model, point) } else { 0.0 }
        };
        let about = "of the point that carries most in steady sliding";
        self.penetration = self.add("penetration", "m", about, deep);
        let slip = move |sample: &ChannelSample<'_>| {
            if touches { sample.marched.state.slip_velocity(sample.model, point)[0] } else { 0.0 }
        };
        self.add("slip_velocity", "m/s", "of the same point along the sliding direction", slip);
        if !touches {
            return;
        }
        let states = [
            ("points_sticking", "stick", TouchState::Stick),
            ("points_backwards", "slip against the motion of the counter-body", TouchState::Backwards),
            ("points_forwards", "slip as the counter-body moves", TouchState::Forwards),
        ];
        let numbers = states.map(|(name, words, state)| {
            let count = move |sample: &ChannelSample<'_>| sample.counts[state as usize] as f64;
            self.add(name, "1", format!("contact points that {words}"), count)
        });
        self.states = numbers.first().copied();
    }

    /// Energies and work since the start.
    fn energies(&mut self) {
        let about = "½vᵀMv + ½uᵀKu gained since the start";
        self.add("energy_stored", "J", about, |s| s.marched.work.kinetic + s.marched.work.strain);
        let about = "spent by the drives of the counter-bodies against friction, since the start";
        self.add("energy_drive", "J", about, |s| s.marched.work.drive);
        let about = "turned into heat by friction, since the start";
        self.add("energy_heat", "J", about, |s| s.marched.work.heat);
        let about = "taken by structural damping (negative), since the start";
        self.add("energy_damping", "J", about, |s| s.marched.work.damping);
        let about = "added by the integrator (mostly negative), since the start";
        self.add("energy_algorithm", "J", about, |s| s.marched.work.algorithm);
    }

    fn disturbance(&mut self) {
        let about = |part: &str| {
            format!("{part} part of the amplitude of the disturbed mode, its largest translation")
        };
        let re = self.add("mode_re", "m", about("real"), |s| s.amplitude.re);
        let im = self.add("mode_im", "m", about("imaginary"), |s| s.amplitude.im);
        self.amplitude = [re, im];
    }
}
