//! The contact points of all pairs with the forces and conditions of a state.

use crate::system::{Closing, ContactForces, ContactMotion, ContactPair, ContactPoint, ContactTangent};

/// Part of the load and of the friction that acts in a load step.
pub(super) type Fraction = f64;

/// Forces of a point and their derivatives.
pub(super) type Law = (ContactForces, ContactTangent);

/// A state of a system in contact.
#[derive(Debug, Clone)]
pub(super) struct State {
    /// u on the degrees of freedom \[m, rad\].
    pub(super) displacement: Vec<f64>,
    /// a of every pair \[m\].
    pub(super) approach: Vec<f64>,
    /// δ of every point \[m\].
    pub(super) penetration: Vec<f64>,
}

impl State {
    /// Adds `factor` times a change.
    pub(super) fn add(&mut self, factor: f64, change: &State) {
        let add = |x: &mut [f64], d: &[f64]| x.iter_mut().zip(d).for_each(|(x, d)| *x += factor * d);
        add(&mut self.displacement, &change.displacement);
        add(&mut self.approach, &change.approach);
        add(&mut self.penetration, &change.penetration);
    }
}

/// The points of the pairs of a system.
pub(super) struct PointLaws<'a> {
    pub(super) pairs: &'a [ContactPair],
    /// Every point with its pair and the index of that.
    pub(super) points: Vec<(usize, &'a ContactPair, &'a ContactPoint)>,
    /// Pairs whose approach is unknown.
    pub(super) loaded: Vec<usize>,
}

impl<'a> PointLaws<'a> {
    pub(super) fn new(pairs: &'a [ContactPair]) -> Self {
        let points = pairs.iter().enumerate();
        let points = points.flat_map(|(k, pair)| pair.points.iter().map(move |p| (k, pair, p))).collect();
        let loaded = (0..pairs.len()).filter(|k| matches!(pairs[*k].closing, Closing::Load(_))).collect();
        PointLaws { pairs, points, loaded }
    }

    /// The place of the approach of a pair among those that are unknown.
    pub(super) fn unknown(&self, pair: usize) -> Option<usize> {
        self.loaded.binary_search(&pair).ok()
    }

    /// Forces of every point at its penetration, a part of its friction; of points that stick at the displacement `u`, which others do not
    /// need.
    pub(super) fn respond(&self, penetration: &[f64], u: &[f64], fraction: Fraction) -> Vec<Law> {
        let at = |(penetration, (_, pair, point)): (&f64, &(usize, &ContactPair, &ContactPoint))| {
            let (mut forces, mut tangent) = respond(pair, point, *penetration, slid(pair, point, u));
            if pair.sticks() {
                return (forces, tangent);
            }
            for i in 0..2 {
                forces.friction[i] *= fraction;
                tangent.by_penetration[1 + i] *= fraction;
            }
            (forces, tangent)
        };
        penetration.iter().zip(&self.points).map(at).collect()
    }

    /// e = δ − a + gap of every point.
    pub(super) fn motions(&self, penetration: &[f64], approach: &[f64]) -> Vec<f64> {
        let of = |(d, (k, _, point)): (&f64, &(usize, &ContactPair, &ContactPoint))| {
            d - (approach[*k] - point.gap)
        };
        penetration.iter().zip(&self.points).map(of).collect()
    }

    /// δ − (a − gap + gᵀu) of every point.
    pub(super) fn apart(&self, state: &State) -> Vec<f64> {
        let motions = self.motions(&state.penetration, &state.approach);
        let of = |(e, (_, _, point)): (&f64, &(usize, &ContactPair, &ContactPoint))| {
            e - point.normal.dot(&state.displacement)
        };
        motions.iter().zip(&self.points).map(of).collect()
    }

    /// ΣN − L of each loaded pair.
    pub(super) fn closure(&self, laws: &[Law], fraction: Fraction) -> Vec<f64> {
        let mut carried = vec![0.0; self.pairs.len()];
        self.points.iter().zip(laws).for_each(|((k, ..), law)| carried[*k] += law.0.normal);
        self.loaded.iter().map(|k| carried[*k] - fraction * load(&self.pairs[*k])).collect()
    }

    /// How far a state is from fitting together: the largest |δ − (a − gap + gᵀu)| relative to the lengths in it, and the
    /// largest |ΣN − L| relative to L.
    pub(super) fn mismatch(&self, state: &State) -> f64 {
        let scale = self.scale(&state.penetration, &state.approach);
        let apart = norm(&self.apart(state)) / scale;
        let closure = self.closure(&self.respond(&state.penetration, &state.displacement, 1.0), 1.0);
        let relative = |(k, gap): (&usize, &f64)| gap.abs() / load(&self.pairs[*k]);
        self.loaded.iter().zip(&closure).map(relative).fold(apart, f64::max)
    }

    /// The approaches of all pairs, given those of the loaded ones, the others zero.
    pub(super) fn approaches(&self, loaded: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.pairs.len()];
        self.loaded.iter().zip(loaded).for_each(|(k, a)| all[*k] = *a);
        all
    }

    /// The largest change of a motion e or an approach, given the changes of penetrations and approaches.
    pub(super) fn length(&self, penetration: &[f64], approach: &[f64]) -> f64 {
        let de = penetration.iter().zip(&self.points).map(|(dd, (k, ..))| dd - approach[*k]);
        norm(&de.chain(approach.iter().copied()).collect::<Vec<_>>())
    }

    /// The length that steps are measured by: the largest displacement or penetration in sight.
    pub(super) fn scale(&self, penetration: &[f64], approach: &[f64]) -> f64 {
        let motions = self.motions(penetration, approach);
        norm(&motions).max(norm(penetration)).max(f64::MIN_POSITIVE)
    }

    /// Whether a pair carries nothing at these penetrations.
    pub(super) fn some_pair_is_open(&self, penetration: &[f64]) -> bool {
        let mut presses = vec![false; self.pairs.len()];
        for (delta, (k, pair, point)) in penetration.iter().zip(&self.points) {
            presses[*k] |= respond(pair, point, *delta, [0.0; 2]).0.normal != 0.0;
        }
        presses.contains(&false)
    }

    /// Penetrations and approaches to begin with: undeformed, at the approach that carries the load; and with every point
    /// pressed a little, given its motions gᵀu under the load alone.
    pub(super) fn starts(&self, unloaded: &[f64], fraction: Fraction) -> [(Vec<f64>, Vec<f64>); 2] {
        let approach: Vec<f64> = self.pairs.iter().map(|pair| first_approach(pair, fraction)).collect();
        let undeformed = self.points.iter().map(|(k, _, point)| approach[*k] - point.gap).collect();
        let pressed = unloaded.iter().map(|e| 1e-3 * e.abs().max(1e-9)).collect();
        [(undeformed, approach.clone()), (pressed, approach)]
    }
}

/// Δ \[m\] along t₁ and t₂ of a point of a pair that sticks; zero of one that slides, whose law does not need it.
pub(super) fn slid(pair: &ContactPair, point: &ContactPoint, u: &[f64]) -> [f64; 2] {
    if pair.sticks() { [0, 1].map(|k| -point.tangents[k].dot(u)) } else { [0.0; 2] }
}

/// The law of a point at a penetration, in steady sliding; of one that sticks at what it slid.
pub(super) fn respond(pair: &ContactPair, point: &ContactPoint, penetration: f64, slid: [f64; 2]) -> Law {
    if pair.sticks() {
        return pair.law.hold(penetration, slid, point.weight);
    }
    let motion =
        ContactMotion { penetration, penetration_rate: 0.0, slip_velocity: [pair.velocity_at(point), 0.0] };
    pair.law.respond(&motion, point.weight)
}

/// Whether every force and its slope is a number.
pub(super) fn are_finite(laws: &[Law]) -> bool {
    laws.iter()
        .all(|(forces, tangent)| (forces.normal + tangent.by_penetration.iter().sum::<f64>()).is_finite())
}

/// The largest change of a normal force in a step.
pub(super) fn force_change(laws: &[Law], penetration: &[f64]) -> f64 {
    laws.iter().zip(penetration).map(|(law, dd)| (law.1.by_penetration[0] * dd).abs()).fold(0.0, f64::max)
}

pub(super) fn largest_force(laws: &[Law]) -> f64 {
    laws.iter().map(|law| law.0.normal.abs()).fold(0.0, f64::max)
}

/// The approach at which the undeformed bodies carry the load, by bisection (N grows with the approach).
fn first_approach(pair: &ContactPair, fraction: Fraction) -> f64 {
    let load = match pair.closing {
        Closing::Approach(approach) => return approach,
        Closing::Load(load) => load,
    };
    let carried =
        |a: f64| -> f64 { pair.points.iter().map(|p| respond(pair, p, a - p.gap, [0.0; 2]).0.normal).sum() };
    let touch = pair.least_gap();
    let mut beyond = 1e-9;
    while carried(touch + beyond) < fraction * load && beyond < 1e6 {
        beyond *= 2.0;
    }
    let (mut low, mut high) = (0.0, beyond);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if carried(touch + middle) < fraction * load { low = middle } else { high = middle }
    }
    touch + high
}

fn load(pair: &ContactPair) -> f64 {
    match pair.closing {
        Closing::Load(load) => load,
        Closing::Approach(_) => 0.0,
    }
}

/// max |xᵢ|; not a number where one of them is none.
pub(super) fn norm(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m: f64, v| if m.is_nan() || v.is_nan() { f64::NAN } else { m.max(v.abs()) })
}
