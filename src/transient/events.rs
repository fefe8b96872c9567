//! Events at the contact points: opening, closing, sticking, slipping, reversal of slip.

use super::model::TransientModel;
use super::state::State;

/// Event at a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// It loses touch.
    Opens,
    /// It touches again.
    Closes,
    /// Closed and slipping before and after, its slip velocity along the sliding direction changes sign.
    Turns,
    /// It stops to slip; a law with regularised friction never says so.
    Sticks,
    /// It slips again.
    Slips,
}

impl EventKind {
    /// All of them, in the order of their numbers in files.
    pub const ALL: [EventKind; 5] =
        [EventKind::Opens, EventKind::Closes, EventKind::Turns, EventKind::Sticks, EventKind::Slips];

    /// `opens`, `closes`, `turns`, `sticks` or `slips`.
    pub fn name(self) -> &'static str {
        match self {
            EventKind::Opens => "opens",
            EventKind::Closes => "closes",
            EventKind::Turns => "turns",
            EventKind::Sticks => "sticks",
            EventKind::Slips => "slips",
        }
    }
}

/// Something that happens at a contact point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// When \[s\]: within a step, where a straight line of what changes sign, penetration or slip velocity, passes zero; the
    /// end of the step where neither does.
    pub time: f64,
    /// The contact point, counted from 0.
    pub point: usize,
    /// Kind of event.
    pub kind: EventKind,
}

/// Sees what happens from one state to the next.
#[derive(Debug, Clone)]
pub struct Watch {
    time: f64,
    last: Vec<PreviousContact>,
}

/// How a contact point stands.
#[derive(Debug, Clone, Copy)]
struct PreviousContact {
    closed: bool,
    sticks: bool,
    /// δ \[m\].
    penetration: f64,
    /// v₁ \[m/s\].
    slip: f64,
}

impl Watch {
    /// Looks at a state for the first time.
    pub fn new(model: &TransientModel<'_>, state: &State) -> Self {
        Watch { time: state.time, last: seen(model, state).collect() }
    }

    /// Looks at the next state, and adds what has happened since.
    pub fn look(&mut self, model: &TransientModel<'_>, state: &State, events: &mut Vec<Event>) {
        for (point, now) in seen(model, state).enumerate() {
            let last = std::mem::replace(&mut self.last[point], now);
            let depth = (last.penetration, now.penetration);
            let (kind, (from, to)) = match (last.closed, now.closed) {
                (true, false) => (EventKind::Opens, depth),
                (false, true) => (EventKind::Closes, depth),
                (true, true) if last.sticks != now.sticks => {
                    (if now.sticks { EventKind::Sticks } else { EventKind::Slips }, (1.0, 1.0))
                }
                (true, true) if !now.sticks && (last.slip < 0.0) != (now.slip < 0.0) => {
                    (EventKind::Turns, (last.slip, now.slip))
                }
                _ => continue,
            };
            let part = if (from < 0.0) != (to < 0.0) { from / (from - to) } else { 1.0 };
            events.push(Event { time: self.time + part * (state.time - self.time), point, kind });
        }
        self.time = state.time;
    }
}

fn seen(model: &TransientModel<'_>, state: &State) -> impl Iterator<Item = PreviousContact> {
    (0..model.points.len()).map(move |point| PreviousContact {
        closed: state.contact_forces(point)[0] != 0.0,
        sticks: state.sticks(point),
        penetration: state.penetration(model, point),
        slip: state.slip_velocity(model, point)[0],
    })
}

#[cfg(test)]
mod tests {
    use super::super::{Plan, Scheme, StepMethod, TimeProfile, march};
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::contact::{Coulomb, NormalLaw, SlidingLaw};
    use crate::equilibrium::SteadySliding;
    use crate::equilibrium::samples::{pair, point, structure, vector};
    use crate::linalg::SparseVector;
    use crate::system::{Closing, System};
    use std::f64::consts::TAU;

    /// A mass thrown up from a soft spring bed falls back after 2 v/g, with v = √(2 g h); the belt under it turns round at
    /// known times.
    #[test]
    fn flights_and_turns_are_seen_when_they_happen() {
        // Gravity 10 m/s², bed 1 kN/m without damping, from rest 0.1 m above it.
        let structure = structure(2, |i, j| if i == j { 1.0 } else { 0.0 }, |_, _| 0.0);
        let touch = point(0.1, 1.0, vector(&[(0, 1.0)]), vector(&[(1, 1.0)]), SparseVector::default());
        let law = SlidingLaw::new(NormalLaw::linear(1e3), Coulomb { mu0: 0.0 }, 1e-3);
        let system = System {
            structure,
            pairs: vec![pair(vec![touch], law, Closing::Approach(0.0), 1.0)],
            load: vec![10.0, 0.0],
            prestress: None,
            coupling: None,
        };
        let (displacement, approach) = (vec![0.0; 2], vec![0.0]);
        let steady = SteadySliding { displacement, approach, points: vec![], iterations: 0, residual: 0.0 };
        let profile = TimeProfile::Reciprocating { frequency_hz: 3.0, phase: 0.0 };
        let model = TransientModel::new(&system, &steady).unwrap().driven(vec![profile], vec![]);
        let mut start = State::empty(&model);
        start.motion.col_as_slice_mut(2)[0] = 10.0;
        start.settle(&model);
        let mut watch = Watch::new(&model, &start);
        let mut events = Vec::new();
        let (scheme, method) = (Scheme::TRAPEZOIDAL, StepMethod::Condensed);
        let plan = Plan { scheme, step: 1e-4, steps: 15_000, method, tolerance: None };
        march(&model, start, &plan, &(), &mut |marched| {
            watch.look(&model, &marched.state, &mut events);
            Ok(())
        })
        .unwrap();
        // On the bed x = δ: ẍ = 10 − 1000 x from x = 0, ẋ = √2, until x = 0 again.
        let (speed, omega) = (2f64.sqrt(), 1e3f64.sqrt());
        let fall = speed / 10.0;
        let contact = (TAU - 2.0 * (speed * omega).atan2(10.0)) / omega;
        let mut expected = Vec::new();
        let mut time = fall;
        while time < 1.5 {
            expected.push((time, EventKind::Closes));
            expected.push((time + contact, EventKind::Opens));
            time += contact + 2.0 * fall;
        }
        // cos(2π 3 t) passes zero at (2k + 1)/12 s; seen while the point is closed.
        let closed = |t: f64| {
            let since = (t - fall).rem_euclid(contact + 2.0 * fall);
            t > fall && since < contact
        };
        let turns = (0..).map(|k| f64::from(2 * k + 1) / 12.0).take_while(|t| *t < 1.5);
        expected.extend(turns.filter(|t| closed(*t)).map(|t| (t, EventKind::Turns)));
        expected.retain(|(t, _)| *t < 1.5);
        expected.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert!(expected.iter().any(|(_, kind)| *kind == EventKind::Turns));
        assert_eq!(events.len(), expected.len(), "{events:?} {expected:?}");
        for (event, (time, kind)) in events.iter().zip(expected) {
            assert!(
                event.kind == kind && within((event.time - time).abs(), 2e-5, Discretisation),
                "{event:?} {time}"
            );
        }
    }
}
