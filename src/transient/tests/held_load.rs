//! Contacts that keep their load in motion.

use super::super::*;
use super::{full_newton_agrees, plan, schemes};
use crate::bounds::{Origin::*, within};
use crate::contact::{Coulomb, NormalLaw, SlidingLaw};
use crate::equilibrium::samples::{pair, point, random_system, structure, vector};
use crate::equilibrium::{SteadyOptions, solve_steady};
use crate::linalg::{SparseVector, c64};
use crate::system::{Closing, System};
use faer::Mat;

/// ΣN of every step is the load of its time, points lift off and fall back, and Newton's method on the whole agrees.
#[test]
fn the_sum_of_the_normal_forces_is_the_load_in_motion() {
    let mut opened = 0;
    for (seed, scheme) in schemes().into_iter().cycle().take(10).enumerate() {
        let load = 2.0 + seed as f64;
        let system = random_system(14, 4, load, seed as u64 + 1);
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let profile = TimeProfile::Ramp { from: 1.0 - 0.05 * seed as f64, duration: 0.5 };
        let begin = profile.factor(0.0);
        let loading = Loading { profile: profile.clone(), approaches: vec![0.0], factors: [begin, 1.0] };
        let model = || {
            let loadings = vec![Some(loading.clone())];
            TransientModel::new(&system, &steady).unwrap().loaded(loadings).holding(vec![Some(load)])
        };
        let model = model();
        let shape: Vec<c64> = (0..14).map(|k| c64::new(0.01 * (k as f64).sin(), 0.01)).collect();
        let start = State::steady(&model, &steady).disturbed(&model, c64::new(0.0, 9.0), &shape, 1.0);
        let sum = |state: &State| (0..4).map(|p| state.contact_forces(p)[0]).sum::<f64>();
        march(&model, start, &plan(scheme, 2e-3, 400), &(), &mut |moment| {
            let expected = load * profile.factor(moment.state.time);
            let found = sum(&moment.state);
            // The round-off of an approach beside the penetration that carries the load.
            assert!(
                within((found / expected - 1.0).abs(), 1e-10, RoundOff),
                "{seed} {}: {found} {expected}",
                moment.step
            );
            opened += (0..4).filter(|p| moment.state.contact_forces(*p)[0] == 0.0).count();
            Ok(())
        })
        .unwrap();
        let mut states: Vec<Mat<f64>> = Vec::new();
        march(&model, State::steady(&model, &steady), &plan(scheme, 2e-3, 60), &(), &mut |moment| {
            states.push(moment.state.motion.clone());
            Ok(())
        })
        .unwrap();
        full_newton_agrees(&model, &steady, plan(scheme, 2e-3, 60), &states);
    }
    assert!(opened > 0);
}

/// A block on springs that friction of a constant load drags: x = x₀ + A cos ωt whatever the contact's stiffness, where an approach
/// that is kept would change both the frequency and the force.
#[test]
fn friction_of_a_load_that_is_kept_is_a_constant_force() {
    for stiffness in [1e2, 1e4, 1e6] {
        let (load, mu) = (3.0, 0.4);
        // Springs inclined to the belt, so that sliding presses the block on it.
        let k = [[40.0, -15.0], [-15.0, 25.0]];
        let touch = point(0.0, 1.0, vector(&[(1, 1.0)]), vector(&[(0, 1.0)]), SparseVector::default());
        let law = SlidingLaw::new(NormalLaw::linear(stiffness), Coulomb { mu0: mu }, 0.0);
        let system = System {
            structure: structure(2, |i, j| f64::from(i == j), |i, j| k[i][j]),
            pairs: vec![pair(vec![touch], law, Closing::Load(load), 50.0)],
            load: vec![0.0; 2],
            prestress: None,
            coupling: None,
        };
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let model = TransientModel::new(&system, &steady).unwrap().holding(vec![Some(load)]);
        // A mode of the springs alone: K φ = ω²φ with φ = (1, s).
        let (trace, determinant) = (k[0][0] + k[1][1], k[0][0] * k[1][1] - k[0][1] * k[1][0]);
        let omega = (0.5 * (trace - (trace * trace - 4.0 * determinant).sqrt())).sqrt();
        let s = (omega * omega - k[0][0]) / k[0][1];
        let shape = [c64::new(0.1, 0.0), c64::new(0.1 * s, 0.0)];
        let start = State::steady(&model, &steady).disturbed(&model, c64::new(0.0, omega), &shape, 1.0);
        let step = 1e-3;
        let origin = steady.displacement.clone();
        march(&model, start, &plan(Scheme::TRAPEZOIDAL, step, 3000), &(), &mut |moment| {
            // The frequency of the scheme: tan(ω′Δt/2) = ωΔt/2.
            let turn = 2.0 * (0.5 * omega * step).atan() / step * moment.state.time;
            for (i, part) in [1.0, s].into_iter().enumerate() {
                let off = moment.state.motion[(i, 0)] - origin[i] - 0.1 * part * turn.cos();
                // Newmark's amplitude of a start with the exact acceleration is off by (ωΔt)²/4, 1e-5 of it, at most.
                assert!(within(off.abs(), 1e-5, Discretisation), "{stiffness} {}: {off:e}", moment.step);
            }
            Ok(())
        })
        .unwrap();
    }
}
