//! Contacts that act on a reduced model from outside, with more points than it has coordinates.

use super::super::*;
use super::{blow, damped, plan, schemes};
use crate::bounds::{Origin::*, within};
use crate::contact::{Bristle, Coulomb, NormalLaw, SlidingLaw};
use crate::equilibrium::samples::{fluttering_bar, skew_parts, vector};
use crate::equilibrium::{SteadyOptions, SteadySliding, solve_steady};
use crate::linalg::c64;
use crate::linalg::multivector::gram;
use crate::linalg::sparse::times;
use crate::modal::samples::dense_modes;
use crate::reduction::{ManyPoints, Reduced, reduce};
use crate::stability::complex_modes;
use crate::system::System;
use faer::Mat;
use std::f64::consts::TAU;

/// What acts in a run.
#[derive(Clone, Copy)]
struct Acts {
    held: Option<f64>,
    back: bool,
}

impl Acts {
    fn on<'a>(self, model: TransientModel<'a>, push: Push) -> TransientModel<'a> {
        let profile = match self.back {
            true => TimeProfile::Reciprocating { frequency_hz: 0.9, phase: 0.1 },
            false => TimeProfile::Constant,
        };
        model.driven(vec![profile], vec![push]).holding(vec![self.held])
    }
}

/// Marches with the contacts in the system and apart from it, on the same coordinates, and says how often points opened and stuck.
fn both(system: &System, scheme: Scheme, acts: Acts) -> [usize; 2] {
    let steady = solve_steady(system, &SteadyOptions::default(), &()).unwrap();
    let bare = System { pairs: Vec::new(), ..system.clone() };
    let n = system.n_dofs();
    let identity = Mat::from_fn(n, n, |i, j| f64::from(i == j));
    let push = || Push { direction: vector(&[(3, 40.0), (11, -60.0)]), ..blow() };
    let inside = acts.on(TransientModel::new(system, &steady).unwrap(), push());
    let outside =
        acts.on(TransientModel::reduced(&bare, (&system.pairs, &identity), &steady).unwrap(), push());
    let plan = plan(scheme, 2e-3, 400);
    let (mut counts, mut states) = ([0, 0], Vec::new());
    march(&inside, State::steady(&inside, &steady), &plan, &(), &mut |moment| {
        states.push(moment.state.motion.clone());
        Ok(())
    })
    .unwrap();
    let largest = states.iter().map(|m| m.col(0).norm_max()).fold(0.0, f64::max);
    let end = march(&outside, State::steady(&outside, &steady), &plan, &(), &mut |moment| {
        let state = &moment.state;
        let off = (state.motion.col(0) - states[moment.step].col(0)).norm_max();
        assert!(within(off, 1e-6 * largest, Tolerance), "{scheme:?}, step {}: {off:e}", moment.step);
        for p in 0..outside.points.len() {
            counts[0] += usize::from(state.contact_forces(p)[0] == 0.0);
            counts[1] += usize::from(state.sticks(p));
        }
        Ok(())
    })
    .unwrap();
    assert!(
        end.split.0 == 0 && within(end.worst_residual, 1e-7, Tolerance),
        "{:?} {:e}",
        end.split,
        end.worst_residual
    );
    counts
}

/// Lift-off, loads that are kept, bristles that stick, and what was imported: each step is the condensed one.
#[test]
fn contacts_apart_from_a_system_move_it_as_those_in_it() {
    let mut counted = [0, 0];
    for (seed, scheme) in schemes().into_iter().cycle().take(10).enumerate() {
        let mut system = damped(seed as u64 + 1);
        system.structure.damping.modal = None;
        if seed % 3 == 1 {
            let normal = NormalLaw { stiffness: 60.0, cubic_stiffness: 5.0, damping: 0.0, bilateral: false };
            let bristle = Some(Bristle { stiffness: 40.0, damping: 1.0 });
            let law = SlidingLaw { bristle, ..SlidingLaw::new(normal, Coulomb { mu0: 0.4 }, 0.0) };
            system.pairs[0].law = std::sync::Arc::new(law);
        }
        if seed % 3 == 2 {
            let rest = skew_parts(30, seed as u64, 0.1, 0.0);
            system.coupling = Some(crate::system::Coupling { skew: None, ..rest });
        }
        let held = (seed % 2 == 1).then_some(3.0);
        let counts = both(&system, scheme, Acts { held, back: seed % 3 == 1 });
        counted = [0, 1].map(|k| counted[k] + counts[k]);
    }
    assert!(counted[0] > 100 && counted[1] > 100, "{counted:?}");
}

/// The deflections of a reduced model under random contact forces are as near as it states, and so is its motion through lift-off.
#[test]
fn a_model_reduced_with_its_contacts_apart_moves_like_the_full_one() {
    let mut sizes = Vec::new();
    for tolerance in [0.3, 0.1] {
        let system = fluttering_bar(9.0, 3);
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let modes = dense_modes(&system, 24);
        let direction = vector(&[(20, 4.0), (21, 4.0), (40, -6.0), (90, 3.0)]);
        let push = Push { direction, course: Pulse::HalfSine { begin: 0.01, duration: 0.2 } };
        let reduced = reduce(
            &system,
            &steady,
            &modes,
            std::slice::from_ref(&push.direction),
            Some(many(&system, &steady, tolerance)),
        )
        .unwrap();
        let contacts = reduced.contacts.as_ref().unwrap();
        assert!(contacts.error.largest <= tolerance, "{:?}", contacts.error);
        let [off, opened] = apart(&system, &steady, &reduced, push);
        assert!(within(off, tolerance, Stated), "{tolerance}: {off:e}");
        assert!(opened > 1000.0, "{opened}");
        sizes.push(reduced.basis.ncols());
    }
    assert!(sizes[0] < sizes[1] && sizes[1] < 110, "{sizes:?}");
}

/// A run that stopped goes on as if it had not, with the tangent that it had.
#[test]
fn a_reduced_march_that_was_put_away_goes_on_bit_for_bit() {
    let system = fluttering_bar(9.0, 3);
    let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
    let reduced =
        reduce(&system, &steady, &dense_modes(&system, 16), &[], Some(many(&system, &steady, 0.1))).unwrap();
    let (small, contacts) = (reduced.steady(&steady), reduced.contacts.as_ref().unwrap());
    let blow = Push { direction: reduced.form(&vector(&[(20, 4.0), (21, 4.0)])), ..blow() };
    let model = TransientModel::reduced(&reduced.system, (&contacts.pairs, &contacts.basis), &small).unwrap();
    let model = model.driven(vec![TimeProfile::Constant], vec![blow]).holding(vec![Some(9.0)]);
    let plan = plan(Scheme::hht(-0.05), 2e-3, 200);
    let mut middle = Checkpoint::default();
    let whole = march(&model, State::steady(&model, &small), &plan, &(), &mut |marched| {
        if marched.step == 77 {
            middle.put_march(marched);
        }
        let carried: f64 = (0..model.points.len()).map(|p| marched.state.contact_forces(p)[0]).sum();
        assert!(within((carried / 9.0 - 1.0).abs(), 1e-8, RoundOff), "{carried}");
        Ok(())
    })
    .unwrap();
    let mut again = middle.march(&model).unwrap();
    resume(&model, &mut again, &plan, &(), &mut |_| Ok(())).unwrap();
    let [mut a, mut b] = [Checkpoint::default(), Checkpoint::default()];
    a.put_march(&whole);
    b.put_march(&again);
    assert!(a == b && middle.arrays.contains_key("slopes"));
}

/// What a reduced model of the bar holds: with its complex modes up to 4 Hz.
fn many(system: &System, steady: &SteadySliding, tolerance: f64) -> ManyPoints {
    let modes = complex_modes(system, steady, &dense_modes(system, 120), [0.0, 4.0], &()).unwrap();
    ManyPoints { tolerance, linear: false, shapes: modes.parts(), states: Vec::new() }
}

/// A small motion grows and turns in a reduced model as the complex eigenvalue of the full one says, but for what the trapezoidal rule does to any
/// λ: ζ = (1 + λΔt/2)/(1 − λΔt/2) a step. It is 1e8 times smaller than the deflections of steady sliding.
#[test]
fn flutter_of_a_reduced_model_grows_as_the_complex_eigenvalue_says() {
    const SMALL: f64 = 1e-9;
    for load in [4.0, 9.0, 30.0] {
        let system = fluttering_bar(load, 3);
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let all = complex_modes(&system, &steady, &dense_modes(&system, 120), [0.0, 4.0], &()).unwrap().modes;
        let mode = all.iter().max_by(|a, b| a.eigenvalue.re.total_cmp(&b.eigenvalue.re)).unwrap();
        let lambda = mode.eigenvalue;
        let wanted = many(&system, &steady, 0.3);
        let reduced = reduce(&system, &steady, &dense_modes(&system, 30), &[], Some(wanted)).unwrap();
        let (small, contacts) = (reduced.steady(&steady), reduced.contacts.as_ref().unwrap());
        let model =
            TransientModel::reduced(&reduced.system, (&contacts.pairs, &contacts.basis), &small).unwrap();
        let model = model.balanced(&small);
        let part = |of: fn(&c64) -> f64| reduced.coordinates(&mode.right.iter().map(of).collect::<Vec<_>>());
        let shape: Vec<c64> =
            part(|z| z.re).into_iter().zip(part(|z| z.im)).map(|(re, im)| c64::new(re, im)).collect();
        let step = TAU / lambda.im / 50.0;
        let half = lambda * (0.5 * step);
        let expected = ((half + 1.0) / (-half + 1.0)).ln() / step;
        // c of u = u₀ + Re(c φ), u̇ = Re(c λ φ), by the coordinate that moves most.
        let k = (0..shape.len()).max_by(|a, b| shape[*a].norm().total_cmp(&shape[*b].norm())).unwrap();
        let (p, q) = (shape[k], lambda * shape[k]);
        let determinant = -p.re * q.im + p.im * q.re;
        let mut amplitudes = Vec::new();
        let from = State::steady(&model, &small).disturbed(&model, lambda, &shape, SMALL);
        march(&model, from, &plan(Scheme::TRAPEZOIDAL, step, 300), &(), &mut |moment| {
            let motion = &moment.state.motion;
            let (u, v) = (motion[(k, 0)] - small.displacement[k], motion[(k, 1)]);
            amplitudes
                .push(c64::new((-q.im * u + p.im * v) / determinant, (p.re * v - q.re * u) / determinant));
            Ok(())
        })
        .unwrap();
        // Whole periods, so that a tilt of the ellipse of (u, v) drops out.
        let turned = amplitudes[250] / amplitudes[50];
        let time = 200.0 * step;
        let angle = turned.im.atan2(turned.re);
        let near = ((expected.im * time - angle) / TAU).round();
        let found = c64::new(turned.norm().ln(), angle + TAU * near) / time;
        let (growth, frequency) = (found.re / expected.re - 1.0, found.im / expected.im - 1.0);
        assert!(expected.re > 0.01 * expected.im, "{load}: {expected}");
        assert!(within(growth.abs(), 1e-5, Discretisation), "{load}: {found} {expected}");
        assert!(within(frequency.abs(), 1e-6, Discretisation), "{load}: {found} {expected}");
    }
}

/// max |Vq − u|_M over max |u − u₀|_M of a run, of a reduced model and of the full one; and how often a point was open.
fn apart(system: &System, steady: &SteadySliding, reduced: &Reduced, push: Push) -> [f64; 2] {
    let contacts = reduced.contacts.as_ref().unwrap();
    let small = reduced.steady(steady);
    let seen = Push { direction: reduced.form(&push.direction), ..push.clone() };
    let still = || vec![TimeProfile::Constant];
    let full = TransientModel::new(system, steady).unwrap().driven(still(), vec![push]);
    let few = TransientModel::reduced(&reduced.system, (&contacts.pairs, &contacts.basis), &small).unwrap();
    let few = few.driven(still(), vec![seen]);
    let plan = plan(Scheme::TRAPEZOIDAL, 2e-3, 400);
    let (mut states, mut opened) = (Vec::new(), 0.0);
    march(&few, State::steady(&few, &small), &plan, &(), &mut |moment| {
        states.push(reduced.expand(moment.state.motion.col_as_slice(0)));
        opened += (0..few.points.len()).filter(|p| moment.state.contact_forces(*p)[0] == 0.0).count() as f64;
        Ok(())
    })
    .unwrap();
    let length =
        |x: &Mat<f64>| gram(x.as_ref(), times(&system.structure.mass, x.as_ref()).as_ref())[(0, 0)].sqrt();
    let (mut off, mut moved) = (0.0_f64, 0.0_f64);
    march(&full, State::steady(&full, steady), &plan, &(), &mut |moment| {
        let u = moment.state.motion.col_as_slice(0);
        let away = |other: &[f64]| Mat::from_fn(u.len(), 1, |i, _| u[i] - other[i]);
        off = off.max(length(&away(&states[moment.step])));
        moved = moved.max(length(&away(&steady.displacement)));
        Ok(())
    })
    .unwrap();
    [off / moved, opened]
}
