//! Motion from rest under loads that are there at once.

use super::super::*;
use super::{free, plan, run, start};
use crate::bounds::{Origin::*, within};
use crate::contact::{Bristle, Coulomb, NormalLaw, SlidingLaw};
use crate::equilibrium::samples::{pair, point, sparse, structure, vector};
use crate::equilibrium::{SteadyOptions, SteadySliding, solve_steady};
use crate::linalg::SparseVector;
use crate::system::{Closing, Damping, System};
use nalgebra::{DMatrix, DVector, SymmetricEigen};

const END: f64 = 1.7;

/// A chain of springs between masses m_i and the ground.
fn chain(masses: &[f64]) -> (System, SteadySliding) {
    let (n, m) = (masses.len(), masses.to_vec());
    free(structure(n, move |i, j| if i == j { m[i] } else { 0.0 }, stiffness))
}

fn stiffness(i: usize, j: usize) -> f64 {
    match i.abs_diff(j) {
        0 => 5.0 + i as f64,
        1 => -2.0,
        _ => 0.0,
    }
}

/// u(t) = Σ φ φᵀF (1 − cos ωt)/ω² of the modes of the degrees of freedom with mass, the others condensed.
fn closed_form(masses: &[f64], force: &[f64], t: f64) -> DVector<f64> {
    let n = masses.len();
    let (with, without): (Vec<usize>, Vec<usize>) = (0..n).partition(|i| masses[*i] > 0.0);
    let block = |a: &[usize], b: &[usize]| DMatrix::from_fn(a.len(), b.len(), |i, j| stiffness(a[i], b[j]));
    let part = |of: &[usize]| DVector::from_fn(of.len(), |i, _| force[of[i]]);
    let inner = block(&without, &without).try_inverse().unwrap();
    let carry = block(&with, &without) * &inner;
    let condensed = block(&with, &with) - &carry * block(&without, &with);
    let root = DMatrix::from_diagonal(&DVector::from_fn(with.len(), |i, _| masses[with[i]].sqrt().recip()));
    let modes = SymmetricEigen::new(&root * condensed * &root);
    let modal = modes.eigenvectors.transpose() * &root * (part(&with) - carry * part(&without));
    let moved = modal.zip_map(&modes.eigenvalues, |f, square| f * (1.0 - (square.sqrt() * t).cos()) / square);
    let outer = root * modes.eigenvectors * moved;
    let held = inner * (part(&without) - block(&without, &with) * &outer);
    let mut u = DVector::zeros(n);
    with.iter().enumerate().for_each(|(k, i)| u[*i] = outer[k]);
    without.iter().enumerate().for_each(|(k, i)| u[*i] = held[k]);
    u
}

/// A force that is there from t = 0 on, which the state of rest does not know.
fn step_load(force: &[f64]) -> Push {
    let direction = SparseVector::from_entries(force.iter().copied().enumerate());
    Push { direction, course: Pulse::Change(TimeProfile::Table { times: vec![0.0], factors: vec![2.0] }) }
}

/// Second order against the closed form, of one and more degrees of freedom, with and without mass; with a(0) = 0 it were first.
#[test]
fn a_step_load_at_the_beginning_is_integrated_to_second_order() {
    let schemes = [Scheme::TRAPEZOIDAL, Scheme::hht(-0.1), Scheme::generalised_alpha(0.5)];
    for (masses, force, schemes) in [
        (&[2.0][..], &[3.0][..], &schemes[..]),
        (&[1.0, 0.5, 2.0, 1.5], &[1.0, -2.0, 0.0, 4.0], &schemes),
        (&[1.0, 0.0, 2.0], &[1.0, 0.0, -1.0], &schemes),
        // On a degree of freedom without mass it moves that at once, in the first step.
        (&[1.0, 0.0, 2.0], &[0.0, 3.0, 0.0], &schemes[..1]),
    ] {
        let (system, still) = chain(masses);
        let model = TransientModel::new(&system, &still).unwrap().driven(vec![], vec![step_load(force)]);
        let exact = closed_form(masses, force, END);
        let error = |from: State, scheme: Scheme, steps: usize| {
            let end = run(&model, from, plan(scheme, END / steps as f64, steps));
            let u = end.state.motion.col_as_slice(0);
            u.iter().zip(exact.iter()).map(|(u, e)| (u - e).abs()).fold(0.0, f64::max)
        };
        let zero = vec![0.0; masses.len()];
        for scheme in schemes {
            let order =
                |from: &dyn Fn() -> State| (error(from(), *scheme, 400) / error(from(), *scheme, 800)).log2();
            let found = order(&|| State::at_rest(&model, &still).unwrap());
            assert!(within((found - 2.0).abs(), 0.1, Discretisation), "{masses:?} {scheme:?}: {found}");
            let without = order(&|| start(&model, &zero, &zero, &zero));
            assert!(within((without - 1.0).abs(), 0.1, Discretisation), "{masses:?} {scheme:?}: {without}");
        }
    }
}

/// What has no mass passes its load to the rest by its springs, or by its dashpot if it has one, and follows the rest.
#[test]
fn the_first_acceleration_is_that_of_the_equation_of_motion() {
    let (masses, force) = ([1.0, 0.0, 2.0], [1.0, 3.0, -1.0]);
    let through_springs = -stiffness(0, 1) / stiffness(1, 1) * force[1];
    for (damping, passed) in [(0.0, through_springs), (0.3, 0.0)] {
        let (mut system, still) = chain(&masses);
        let dashpots = sparse(3, |i, j| if i == j { damping } else { 0.0 });
        system.structure.damping = Damping { viscous: Some(dashpots.into()), ..Damping::default() };
        let model = TransientModel::new(&system, &still).unwrap().driven(vec![], vec![step_load(&force)]);
        let state = State::at_rest(&model, &still).unwrap();
        let a = state.motion.col_as_slice(2);
        let follows = -(stiffness(1, 0) * a[0] + stiffness(1, 2) * a[2]) / stiffness(1, 1);
        let expected =
            [force[0] + passed, if damping > 0.0 { 0.0 } else { follows }, (force[2] + passed) / 2.0];
        for (found, expected) in a.iter().zip(expected) {
            // (ωδ)², or δ over a decay.
            assert!(within((found - expected).abs(), 1e-6, Theory), "{damping}: {found} {expected}");
        }
    }
}

/// A mass of 1 kg on a spring of 4 N/m, pressed by 1 N on a belt that runs at 100 m/s from t = 0 on: friction of 0.5 N drags it,
/// x = (F/k)(1 − cos ωt), whatever the law does near rest. A run that was interrupted ends with the same bits.
#[test]
fn friction_that_acts_at_once_is_a_step_load() {
    let normal = NormalLaw::linear(1e3);
    let smooth = SlidingLaw::new(normal, Coulomb { mu0: 0.5 }, 1e-3);
    let set_valued = SlidingLaw::new(normal, Coulomb { mu0: 0.5 }, 0.0);
    let bristle = |damping: f64| SlidingLaw {
        bristle: Some(Bristle { stiffness: 1e4, damping }),
        ..SlidingLaw::new(normal, Coulomb { mu0: 0.5 }, 0.0)
    };
    let system = |law: SlidingLaw| System {
        structure: structure(2, |i, j| f64::from(i == j), |i, j| if i + j == 0 { 4.0 } else { 0.0 }),
        pairs: vec![pair(
            vec![point(0.0, 1.0, vector(&[(1, 1.0)]), vector(&[(0, 1.0)]), SparseVector::default())],
            law,
            Closing::Approach(0.0),
            100.0,
        )],
        load: vec![0.0, 1.0],
        prestress: None,
        coupling: None,
    };
    let frictionless = system(SlidingLaw::new(normal, Coulomb { mu0: 0.0 }, 0.0));
    let still = solve_steady(&frictionless, &SteadyOptions::default(), &()).unwrap();
    let exact = 0.5 / 4.0 * (1.0 - (2.0 * END).cos());
    for law in [smooth, set_valued, bristle(1.0)] {
        let system = system(law);
        let model = TransientModel::new(&system, &still).unwrap();
        for scheme in [Scheme::TRAPEZOIDAL, Scheme::hht(-0.1)] {
            let error = |steps: usize| {
                let from = State::at_rest(&model, &still).unwrap();
                let plan = plan(scheme, END / steps as f64, steps);
                let mut middle = Checkpoint::default();
                let whole = march(&model, from, &plan, &(), &mut |marched| {
                    if marched.step == steps / 3 {
                        middle.put_march(marched);
                    }
                    Ok(())
                })
                .unwrap();
                let mut again = middle.march(&model).unwrap();
                resume(&model, &mut again, &plan, &(), &mut |_| Ok(())).unwrap();
                assert!(again.state.motion == whole.state.motion);
                (whole.state.motion[(0, 0)] - exact).abs()
            };
            let order = (error(400) / error(800)).log2();
            assert!(within((order - 2.0).abs(), 0.1, Discretisation), "{scheme:?}: {order}");
        }
    }
    // Bristles without damping must bend first: what they carry is round-off.
    let system = system(bristle(0.0));
    let model = TransientModel::new(&system, &still).unwrap();
    let state = State::at_rest(&model, &still).unwrap();
    assert!(state.motion[(0, 2)] == 0.0 && within(state.contact_forces(0)[1], 1e-80, RoundOff));
}
