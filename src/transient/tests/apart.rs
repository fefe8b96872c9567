//! Contacts that act on a reduced model from outside, with more points than it has coordinates.

use super::super::*;
use super::{blow, damped, plan, schemes};
use crate::bounds::{Origin::*, within};
use crate::contact::{Bristle, Coulomb, NormalLaw, SlidingLaw};
use crate::equilibrium::samples::{pair, point, skew_parts, structure, vector};
use crate::equilibrium::{SteadyOptions, SteadySliding, solve_steady};
use crate::linalg::multivector::gram;
use crate::linalg::sparse::{add_scaled, times};
use crate::modal::samples::dense_modes;
use crate::reduction::{Reduced, reduce};
use crate::system::{Closing, System};
use faer::Mat;

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

/// A bar of 60 masses on a belt, three contact points to each: it bends across (y) and stretches along (x), and touches below its axis,
/// so that t is x − h y′; the face is inclined, so that friction and pressure drive each other: the bar flutters. Damped in proportion to stiffness and mass.
fn bar(load: f64) -> System {
    const MASSES: usize = 60;
    let chain = |i: usize, j: usize, link: f64, ground: f64| match i.abs_diff(j) {
        0 => link * if i == 0 || i == MASSES - 1 { 1.0 } else { 2.0 } + ground,
        1 => -link,
        _ => 0.0,
    };
    let stiffness = |i: usize, j: usize| match (i < MASSES, j < MASSES) {
        (true, true) => chain(i, j, 2000.0, 1.0),
        (false, false) => chain(i - MASSES, j - MASSES, 5000.0, 20.0),
        _ => 0.0,
    };
    let mut structure = structure(2 * MASSES, |i, j| f64::from(i == j), stiffness);
    structure.damping.viscous =
        Some(add_scaled(&[(2e-4, &structure.stiffness), (0.02, &structure.mass)]).into());
    let points = (0..3 * (MASSES - 1)).map(|p| {
        let (node, part) = (p / 3, (p % 3) as f64 / 3.0 + 1.0 / 6.0);
        let between = |first: usize| [(first + node, 1.0 - part), (first + node + 1, part)];
        let slope = [(node, 2.0), (node + 1, -2.0)];
        let across = [between(0).map(|(i, v)| (i, -v)), between(MASSES).map(|(i, v)| (i, 0.2 * v))].concat();
        let along = between(MASSES).into_iter().chain(slope).collect::<Vec<_>>();
        point(0.0, 1.0, vector(&across), vector(&along), vector(&[]))
    });
    let law = SlidingLaw::new(
        NormalLaw { stiffness: 60.0, cubic_stiffness: 1e6, damping: 0.0, bilateral: false },
        Coulomb { mu0: 0.3 },
        1e-3,
    );
    let pairs = vec![pair(points.collect(), law, Closing::Load(load), 0.02)];
    System { structure, pairs, load: vec![0.0; 2 * MASSES], prestress: None, coupling: None }
}

/// The deflections of a reduced model under random contact forces are as near as it states, and so is its motion through lift-off.
#[test]
fn a_model_reduced_with_its_contacts_apart_moves_like_the_full_one() {
    let mut sizes = Vec::new();
    for tolerance in [0.3, 0.1] {
        let system = bar(9.0);
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let modes = dense_modes(&system, 24);
        let direction = vector(&[(20, 4.0), (21, 4.0), (40, -6.0), (90, 3.0)]);
        let push = Push { direction, course: Pulse::HalfSine { begin: 0.01, duration: 0.2 } };
        let reduced =
            reduce(&system, &steady, &modes, std::slice::from_ref(&push.direction), Some(tolerance)).unwrap();
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
    let system = bar(9.0);
    let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
    let reduced = reduce(&system, &steady, &dense_modes(&system, 16), &[], Some(0.1)).unwrap();
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
