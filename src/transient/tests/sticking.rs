//! Friction without bristles and without regularisation, through rest.

use super::super::*;
use super::{full_newton_agrees, plan};
use crate::bounds::{Origin::*, within};
use crate::contact::{Bristle, Coulomb, Exponential, NormalLaw, SlidingLaw, Stribeck};
use crate::equilibrium::samples::{pair, point, structure, vector};
use crate::equilibrium::{SteadyOptions, SteadySliding, solve_steady};
use crate::linalg::SparseVector;
use crate::system::{Closing, ContactPoint, System};
use std::f64::consts::TAU;

/// Where a block of 1 kg on a spring of 1 N/m is at each of `times`, and how long it has stuck, on a belt of velocity
/// V cos(Ωt) with friction of at most `f`; exact between its events, which are located by bisection. It begins in steady
/// sliding.
fn from_event_to_event([v, omega, f]: [f64; 3], times: &[f64]) -> (Vec<f64>, f64) {
    #[derive(Clone, Copy)]
    enum Phase {
        Slip(f64),
        Stick,
    }
    let belt = |t: f64| v * (omega * t).cos();
    let travel = |t: f64| v / omega * (omega * t).sin();
    // x and ẋ at t from those at t₀.
    let at = |phase: Phase, [t0, x0, v0]: [f64; 3], t: f64| -> [f64; 2] {
        match phase {
            Phase::Slip(sign) => {
                let ((s, c), u) = ((t - t0).sin_cos(), x0 - sign * f);
                [sign * f + u * c + v0 * s, v0 * c - u * s]
            }
            Phase::Stick => [x0 + travel(t) - travel(t0), belt(t)],
        }
    };
    // Positive while the phase lasts.
    let lasts = |phase: Phase, from: [f64; 3], t: f64| -> f64 {
        let [x, speed] = at(phase, from, t);
        match phase {
            Phase::Slip(sign) => sign * (belt(t) - speed),
            Phase::Stick => f - (x - v * omega * (omega * t).sin()).abs(),
        }
    };
    let (mut from, mut phase, mut stuck, mut found) = ([0.0, f, 0.0], Phase::Slip(1.0), 0.0, Vec::new());
    let (mut t, scan) = (0.0, 1e-4);
    for time in times {
        while t < *time {
            let next = (t + scan).min(*time);
            if lasts(phase, from, next) >= 0.0 {
                t = next;
                continue;
            }
            let (mut low, mut high) = (t, next);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if lasts(phase, from, middle) >= 0.0 { low = middle } else { high = middle }
            }
            let [x, speed] = at(phase, from, high);
            // What keeps the block on the belt.
            let holds = x - v * omega * (omega * high).sin();
            phase = match phase {
                Phase::Slip(_) if holds.abs() <= f => Phase::Stick,
                Phase::Slip(sign) => Phase::Slip(-sign),
                Phase::Stick => {
                    stuck += high - from[0];
                    Phase::Slip(holds.signum())
                }
            };
            (from, t) = ([high, x, speed], high);
        }
        found.push(at(phase, from, *time)[0]);
    }
    if let Phase::Stick = phase {
        stuck += t - from[0];
    }
    (found, stuck)
}

/// A block on a spring of 1 N/m, pressed on a belt by 1 N, with the contact points given.
fn block(law: SlidingLaw, points: Vec<ContactPoint>, v: f64) -> System {
    let free = structure(2, |i, j| f64::from(i == j), |i, j| if (i, j) == (0, 0) { 1.0 } else { 0.0 });
    System {
        structure: free,
        pairs: vec![pair(points, law, Closing::Approach(0.0), v)],
        load: vec![0.0, 1.0],
        prestress: None,
        coupling: None,
    }
}

fn touch(weight: f64) -> ContactPoint {
    point(0.0, weight, vector(&[(1, 1.0)]), vector(&[(0, 1.0)]), SparseVector::default())
}

fn reciprocating<'a>(system: &'a System, steady: &SteadySliding, omega: f64) -> TransientModel<'a> {
    let profile = TimeProfile::Reciprocating { frequency_hz: omega / TAU, phase: 0.0 };
    TransientModel::new(system, steady).unwrap().driven(vec![profile], vec![])
}

#[test]
fn a_block_on_a_reciprocating_belt_moves_from_event_to_event_as_it_must() {
    for ([v, omega, f], most) in
        [([1.0, 0.7, 0.6], 5e-6), ([0.5, 0.4, 0.9], 2e-6), ([1.0, 0.7, 0.9], 2e-6), ([1.5, 1.7, 0.5], 1e-3)]
    {
        let system =
            block(SlidingLaw::new(NormalLaw::linear(1e3), Coulomb { mu0: f }, 0.0), vec![touch(1.0)], v);
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let model = reciprocating(&system, &steady, omega);
        for scheme in [Scheme::TRAPEZOIDAL, Scheme::hht(-0.05)] {
            let error = |step: f64| {
                let steps = (40.0 / step).round() as usize;
                let times: Vec<f64> = (1..=steps).map(|k| k as f64 * step).collect();
                let (exact, stuck) = from_event_to_event([v, omega, f], &times);
                let (mut worst, mut sticking) = (0.0f64, 0.0);
                march(&model, State::steady(&model, &steady), &plan(scheme, step, steps), &(), &mut |m| {
                    if m.step > 0 {
                        worst = worst.max((m.state.motion[(0, 0)] - exact[m.step - 1]).abs());
                        sticking += if m.state.sticks(0) { step } else { 0.0 };
                        let [n, f1, _] = m.state.contact_forces(0);
                        assert!(
                            within((n - 1.0).abs(), 1e-9, Tolerance)
                                && within(f1.abs() - f, 1e-9 * f, Tolerance)
                        );
                    }
                    Ok(())
                })
                .unwrap();
                // Newmark's method lets the force swing about that of sticking, and out of its bounds.
                if scheme.alpha_f > 0.0 {
                    assert!(
                        within((sticking - stuck).abs(), 16.0 * step, Discretisation),
                        "{sticking} {stuck}"
                    );
                }
                worst
            };
            let (coarse, fine) = (error(4e-3), error(1e-3));
            assert!(
                within(fine, most, Discretisation) && fine < 0.25 * coarse,
                "{scheme:?}: {coarse:e} {fine:e}"
            );
        }
    }
}

#[test]
fn two_points_at_one_place_carry_what_one_would() {
    let law = || SlidingLaw::new(NormalLaw::linear(1e3), Coulomb { mu0: 0.6 }, 0.0);
    let ends = [vec![touch(1.0)], vec![touch(0.5), touch(0.5)]].map(|points| {
        let system = block(law(), points, 1.0);
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let model = reciprocating(&system, &steady, 0.7);
        let mut stuck = 0;
        let mut path = Vec::new();
        march(&model, State::steady(&model, &steady), &plan(Scheme::hht(-0.05), 1e-2, 2000), &(), &mut |m| {
            stuck += usize::from(m.state.sticks(0));
            path.push(m.state.motion[(0, 0)]);
            Ok(())
        })
        .unwrap();
        assert!(stuck > 100, "{stuck}");
        path
    });
    let off = ends[0].iter().zip(&ends[1]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(within(off, 1e-9, RoundOff), "{off:e}");
}

/// The block on a belt of 1 m/s that turns round at 0.7 rad/s, and where it starts.
fn turned(law: SlidingLaw) -> (System, SteadySliding) {
    let system = block(law, vec![touch(1.0)], 1.0);
    let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
    (system, steady)
}

#[test]
fn a_contact_that_is_set_valued_at_rest_is_condensed_exactly_too() {
    let normal = NormalLaw::linear(1e3);
    let falling = Stribeck { mu_static: 0.6, mu_kinetic: 0.5, stribeck_velocity: 0.2, exponent: 2.0 };
    for law in [SlidingLaw::new(normal, Coulomb { mu0: 0.6 }, 0.0), SlidingLaw::new(normal, falling, 0.0)] {
        for scheme in [Scheme::TRAPEZOIDAL, Scheme::hht(-0.1)] {
            let (system, steady) = turned(law.clone());
            let model = reciprocating(&system, &steady, 0.7);
            let (mut stuck, mut states) = (0, Vec::new());
            let condensed = plan(scheme, 5e-3, 2000);
            let end = march(&model, State::steady(&model, &steady), &condensed, &(), &mut |moment| {
                stuck += usize::from(moment.state.sticks(0));
                states.push(moment.state.motion.clone());
                Ok(())
            })
            .unwrap();
            assert!(stuck > 50 && end.split.0 == 0, "{stuck} {:?}", end.split);
            assert!(within(end.worst_residual, 1e-9, Tolerance), "{scheme:?}: {:e}", end.worst_residual);
            full_newton_agrees(&model, &steady, condensed, &states);
        }
    }
}

#[test]
fn it_is_the_limit_of_stiff_bristles() {
    let path = |bristle: Option<Bristle>| {
        let law =
            SlidingLaw { bristle, ..SlidingLaw::new(NormalLaw::linear(1e3), Coulomb { mu0: 0.6 }, 0.0) };
        let (system, steady) = turned(law);
        let model = reciprocating(&system, &steady, 0.7);
        let mut path = Vec::new();
        let plan = plan(Scheme::hht(-0.05), 1e-3, 20_000);
        march(&model, State::steady(&model, &steady), &plan, &(), &mut |m| {
            path.push(m.state.motion[(0, 0)]);
            Ok(())
        })
        .unwrap();
        path
    };
    let exact = path(None);
    let off = |stiffness: f64| {
        let near = path(Some(Bristle { stiffness, damping: 0.0 }));
        near.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let offs = [1e3, 1e4, 1e5].map(off);
    assert!(offs[1] < 0.2 * offs[0] && offs[2] < 0.2 * offs[1] && within(offs[2], 3e-4, Theory), "{offs:?}");
}

#[test]
fn a_march_that_stops_says_where_and_what_cures_it() {
    // As good as without regularisation, but without the set of forces at rest.
    let law = SlidingLaw::new(NormalLaw::linear(1e3), Coulomb { mu0: 0.6 }, f64::MIN_POSITIVE);
    let system = block(law, vec![touch(1.0)], 1.0);
    let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
    let model = reciprocating(&system, &steady, 0.7);
    let plan = plan(Scheme::hht(-0.05), 1e-2, 2000);
    let error = march(&model, State::steady(&model, &steady), &plan, &(), &mut |_| Ok(())).unwrap_err();
    let text = error.to_string();
    let name = &system.pairs[0].name;
    let bristle = format!("`[contact.{name}.bristle]`");
    for part in ["at t = ", "point 1 of the contact", &bristle, "friction.regularisation", "time_step"] {
        assert!(text.contains(part), "{text}");
    }
    assert!(text.find(&bristle) < text.find("friction.regularisation"), "{text}");
}

#[test]
fn what_was_stuck_goes_on_bit_for_bit() {
    for method in [StepMethod::Condensed, StepMethod::FullNewton] {
        let (system, steady) = turned(SlidingLaw::new(NormalLaw::linear(1e3), Coulomb { mu0: 0.6 }, 0.0));
        let model = reciprocating(&system, &steady, 0.7);
        let plan = Plan { method, tolerance: Some(1e-4), ..plan(Scheme::hht(-0.1), 2e-2, 500) };
        let (mut middle, mut kept) = (Checkpoint::default(), 0);
        let whole = march(&model, State::steady(&model, &steady), &plan, &(), &mut |marched| {
            if marched.state.sticks(0) && kept == 0 {
                kept = marched.step;
                middle.put_march(marched);
            }
            Ok(())
        });
        let mut again = middle.march(&model).unwrap();
        resume(&model, &mut again, &plan, &(), &mut |_| Ok(())).unwrap();
        let packed = |marched: &Marched| {
            let mut end = Checkpoint::default();
            end.put_march(marched);
            end
        };
        assert!(kept > 0 && kept < 500 && packed(&again) == packed(&whole.unwrap()), "{kept}");
    }
}

/// The block of 0.8 kg on a spring of 210 N/m, pressed by 30 N on a belt of 0.12 m/s with μ = 0.4 + 0.15 e^{−9|v|}: it sticks for
/// 0.382028 s of each period of 0.646358 s (quadrature of ẍ between its events). Schemes with γ = ½ hold it without alternating.
#[test]
fn a_scheme_without_damping_holds_what_sticks_as_one_with_it() {
    let law = Exponential { mu0: 0.4, mu1: 0.15, alpha: 9.0 };
    let free = structure(
        2,
        |i, j| if i == j { 0.8 } else { 0.0 },
        |i, j| if (i, j) == (0, 0) { 210.0 } else { 0.0 },
    );
    let system = System {
        structure: free,
        pairs: vec![pair(
            vec![touch(1.0)],
            SlidingLaw::new(NormalLaw::linear(1e4), law, 0.0),
            Closing::Approach(0.0),
            0.12,
        )],
        load: vec![0.0, 30.0],
        prestress: None,
        coupling: None,
    };
    let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
    let model = TransientModel::new(&system, &steady).unwrap();
    for scheme in [Scheme::TRAPEZOIDAL, Scheme::hht(0.0), Scheme::generalised_alpha(1.0), Scheme::hht(-0.05)]
    {
        let mut start = State::steady(&model, &steady);
        start.motion[(0, 0)] += 0.024;
        start.settle(&model);
        let (step, steps) = (4e-4, 12_000);
        let (mut changes, mut stuck, mut last, mut worst) = (Vec::new(), 0usize, false, 0.0f64);
        let mut force = 0.0;
        march(&model, start, &plan(scheme, step, steps), &(), &mut |moment| {
            let now = moment.state.sticks(0);
            let friction = moment.state.contact_forces(0)[1];
            if now != last {
                changes.push((moment.step, now));
            }
            stuck += usize::from(now);
            // While it sticks the force follows the spring, 210 N/m × 0.12 m/s × Δt a step; not in the first few steps.
            let settled = changes.last().is_some_and(|(began, on)| *on && moment.step > began + 100);
            if settled && last {
                worst = worst.max((friction - force).abs());
            }
            (last, force) = (now, friction);
            Ok(())
        })
        .unwrap();
        let begins: Vec<usize> = changes.iter().filter(|(_, on)| *on).map(|(at, _)| *at).collect();
        assert!((7..=8).contains(&begins.len()), "{scheme:?}: {} times", begins.len());
        let lasted: Vec<usize> =
            changes.windows(2).filter(|pair| pair[0].1).map(|pair| pair[1].0 - pair[0].0).collect();
        for length in &lasted[1..] {
            // Events are at whole steps.
            assert!(
                within((*length as f64 * step - 0.382_028).abs(), 2.0 * step, Discretisation),
                "{scheme:?}: {length}"
            );
        }
        let period = (begins[begins.len() - 1] - begins[1]) as f64 * step / (begins.len() - 2) as f64;
        assert!(within((period - 0.646_358).abs(), step, Discretisation), "{scheme:?}: {period}");
        assert!(within(worst, 2.0 * 210.0 * 0.12 * step, Discretisation), "{scheme:?}: {worst}");
    }
}
