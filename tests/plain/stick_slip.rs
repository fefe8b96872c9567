//! A mass held by a spring on a moving belt that sticks and slips: the exact limit cycle, from event to event.

use stridor::bounds::{Origin::*, within};
use stridor::validation::extrapolation::step;

/// A mass m on a spring k, on a belt of velocity V, under the friction F_s/(1 + a|V − ẋ|) while it slips and at most F_s
/// while it sticks (the textbook example of R. I. Leine, D. H. van Campen, A. de Kraker & L. van den Steen, Nonlinear
/// Dyn. 16 (1998) 41).
#[derive(Debug, Clone, Copy, PartialEq)]
struct MassOnBelt {
    /// m \[kg\].
    mass: f64,
    /// k \[N/m\].
    stiffness: f64,
    /// F_s \[N\].
    static_friction: f64,
    /// a \[s/m\].
    decline: f64,
    /// V > 0 \[m/s\].
    velocity: f64,
}

/// A period of sticking and slipping.
#[derive(Debug, Clone, Copy, PartialEq)]
struct StickSlipCycle {
    /// How long it slips \[s\].
    slip: f64,
    /// How long it sticks \[s\].
    stick: f64,
    /// The largest x, counted from the spring at rest \[m\].
    highest: f64,
    /// The smallest x \[m\].
    lowest: f64,
}

impl StickSlipCycle {
    /// T \[s\].
    fn period(&self) -> f64 {
        self.slip + self.stick
    }
}

impl MassOnBelt {
    /// The limit cycle, when there is one that sticks once a period and never overtakes the belt.
    ///
    /// Sticking ends at k x = F_s with ẋ = V, whatever was before: so the first slip from there is that of the cycle. It
    /// ends when ẋ = V again; sticking lasts as long as the belt takes back to F_s/k. The motion between is integrated by
    /// extrapolation, and the events are found to round-off by steps of just the length that leads to them.
    fn cycle(&self) -> Option<StickSlipCycle> {
        let MassOnBelt { mass, stiffness, static_friction, decline, velocity } = *self;
        let f = |_: f64, y: &[f64; 2]| {
            let friction = static_friction / (1.0 + decline * (velocity - y[1]));
            [y[1], (friction - stiffness * y[0]) / mass]
        };
        let h = 0.02 * (mass / stiffness).sqrt();
        let end = static_friction / stiffness;
        let (mut time, mut y) = (0.0, [end, velocity]);
        let (mut highest, mut lowest) = (end, end);
        // A turn and a half of the free oscillation at most.
        for k in 0..480 {
            let next = step(&f, time, y, h);
            // The length of a step to where the velocity reaches a value, which it does within this one.
            let reaching = |value: f64| {
                let (mut low, mut high) = (0.0, h);
                let above = y[1] > value;
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if (step(&f, time, y, middle)[1] > value) == above { low = middle } else { high = middle }
                }
                high
            };
            if (y[1] > 0.0) != (next[1] > 0.0) {
                let turned = step(&f, time, y, reaching(0.0))[0];
                highest = turned.max(highest);
                lowest = turned.min(lowest);
            }
            // In the first step the mass only leaves the belt.
            if k > 0 && next[1] >= velocity {
                let last = reaching(velocity);
                let x = step(&f, time, y, last)[0];
                // It sticks there if the spring does not pull more than friction holds.
                return (x.abs() <= end).then_some(StickSlipCycle {
                    slip: time + last,
                    stick: (end - x) / velocity,
                    highest,
                    lowest: lowest.min(x),
                });
            }
            (time, y) = (time + h, next);
        }
        None
    }
}

const BELT: MassOnBelt =
    MassOnBelt { mass: 1.0, stiffness: 1.0, static_friction: 1.0, decline: 3.0, velocity: 0.2 };

#[test]
fn the_cycle_is_the_known_one() {
    let cycle = BELT.cycle().unwrap();
    let found = [cycle.period(), cycle.slip, cycle.stick, cycle.highest, cycle.lowest];
    let known = [12.001_031, 4.296_000, 7.705_032, 1.133_945, -0.555_433];
    assert!(found.iter().zip(known).all(|(a, b)| within((a - b).abs(), 1e-6, Reference)), "{found:?}");
}

#[test]
fn units_do_not_matter() {
    // Another mass, stiffness and load: lengths go with F_s/k, times with √(m/k).
    let (m, k, load) = (3.0, 50.0, 7.0);
    let (length, time) = (load / k, f64::sqrt(m / k));
    let scaled = MassOnBelt {
        mass: m,
        stiffness: k,
        static_friction: load,
        decline: 3.0 * time / length,
        velocity: 0.2 * length / time,
    };
    let (a, b) = (BELT.cycle().unwrap(), scaled.cycle().unwrap());
    let pairs = [(a.slip, b.slip / time), (a.stick, b.stick / time), (a.lowest, b.lowest / length)];
    assert!(pairs.iter().all(|(a, b)| within((a - b).abs(), 1e-9, Tolerance)), "{a:?} {b:?}");
}
