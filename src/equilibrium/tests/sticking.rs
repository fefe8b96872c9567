//! Pairs that do not slide: their points stick elastically, up to μ N.

use super::super::samples::*;
use super::super::*;
use crate::bounds::{Origin::*, within};
use crate::contact::{Bristle, Coulomb, NormalLaw, SlidingLaw};
use crate::linalg::SparseVector;
use crate::linalg::random::Random;
use crate::system::{Closing, System};
use std::sync::Arc;

fn law(stiffness: f64, mu0: f64) -> SlidingLaw {
    let bristle = Some(Bristle { stiffness, damping: 3.0 });
    SlidingLaw { bristle, ..SlidingLaw::new(NormalLaw::linear(100.0), Coulomb { mu0 }, 0.0) }
}

/// A mass on a spring k = 7 in x, pressed down on the ground with 2 N and pushed along it: F = −k_t x up to μN.
#[test]
fn a_mass_on_the_ground_is_held_by_its_bristle_up_to_the_friction_it_can_carry() {
    for (push, mu0) in [(0.9, 0.5), (-0.9, 0.5), (4.0, 0.5), (-4.0, 0.2)] {
        let p = point(0.0, 1.0, vector(&[(1, -1.0)]), vector(&[(0, 1.0)]), SparseVector::default());
        let system = System {
            structure: structure(2, |i, j| f64::from(i == j), |i, j| if i + j == 0 { 7.0 } else { 0.0 }),
            pairs: vec![pair(vec![p], law(50.0, mu0), Closing::Approach(0.0), 0.0)],
            load: vec![push, -2.0],
            prestress: None,
            coupling: None,
        };
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let held: f64 = push / 57.0;
        let x = if 50.0 * held.abs() <= mu0 * 2.0 { held } else { (push - push.signum() * mu0 * 2.0) / 7.0 };
        assert!(within((steady.displacement[0] - x).abs(), 1e-13, RoundOff), "{push}: {steady:?}");
        assert!(within((steady.displacement[1] + 2.0 / 100.0).abs(), 1e-14, RoundOff));
        assert!(within((steady.points[0].forces.friction[0] - (7.0 * x - push)).abs(), 1e-12, RoundOff));
        // Small motions bend the bristle, also where the point has slid to where it stands.
        let block = &linearize(&system, &steady).blocks[0];
        assert_eq!(block.stiffness, [[100.0, 0.0, 0.0], [0.0, 50.0, 0.0], [0.0, 0.0, 50.0]]);
        assert_eq!(block.damping, [[0.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]]);
    }
}

/// The same balance by the force of the contact at the displacement that was found; the states from nothing and from a neighbour's are one.
#[test]
fn pairs_that_stick_and_pairs_that_slide_balance_together() {
    let (mut held, mut carried, mut open) = (0, 0, 0);
    for seed in 0..16 {
        let (n, points) = (40 + 6 * seed as usize, 3 + seed as usize);
        let mut system = random_system(n, points, 6.0, 300 + seed);
        let mut other = random_system(n, points, 4.0, 900 + seed).pairs.remove(0);
        other.name = "held".into();
        other.sliding_velocity = 0.0;
        other.law = Arc::new(law(if seed % 2 == 0 { 80.0 } else { 8e4 }, 0.1));
        system.pairs.push(other);
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let force = contact_force(&system, &steady.approach, &steady.displacement, &vec![0.0; n]);
        let elastic =
            crate::linalg::sparse::multiply_vector(&system.structure.stiffness, &steady.displacement);
        let size = force.iter().chain(&system.load).fold(0.0_f64, |m, f| m.max(f.abs()));
        for i in 0..n {
            let off = (elastic[i] + force[i] - system.load[i]).abs();
            assert!(within(off, 1e-11 * size, RoundOff), "seed {seed}: {off:e} of {size:e}");
        }
        for point in &steady.points[points..] {
            let [a, b] = point.forces.friction;
            let share = a.hypot(b) / (0.1 * point.forces.normal);
            assert!(!point.closed() || within(share - 1.0, 1e-9, RoundOff), "seed {seed}: {share}");
            carried += usize::from(point.closed() && share > 1.0 - 1e-9);
            held += usize::from(point.closed() && share < 0.99);
            open += usize::from(!point.closed());
        }
        let mut neighbour = system.clone();
        neighbour.load.iter_mut().for_each(|f| *f *= 1.01);
        let whole = solve_steady(&neighbour, &SteadyOptions::default(), &()).unwrap();
        let near = Nearby::new(&system, &steady).unwrap().solve(&neighbour).unwrap();
        let largest = whole.displacement.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        for (a, b) in whole.displacement.iter().zip(&near.displacement) {
            assert!(within((a - b).abs(), 1e-9 * largest, Tolerance), "seed {seed}");
        }
    }
    assert!(held > 20 && carried > 20 && open > 20, "{held} {carried} {open}");
}

#[test]
fn a_pair_at_rest_needs_a_bristle() {
    let mut system = random_system(30, 3, 5.0, 1);
    system.pairs[0].sliding_velocity = 0.0;
    let error = solve_steady(&system, &SteadyOptions::default(), &()).unwrap_err().to_string();
    assert!(error.contains("bristle"), "{error}");
}

/// A mass on springs k_x and k_z, pressed by an approach a, N = k_n a/(1 + k_n/k_z), and pushed along the face by f: it sticks elastically up to
/// k_t f/(k_x + k_t) = μN, and has slid beyond.
#[test]
fn a_point_at_its_limit_has_slid() {
    let mut random = Random::seeded(31);
    let mut counts = [0; 2];
    for _ in 0..200 {
        let mut at = |low: f64, high: f64| random.between(low, high);
        let [kx, kz, kn, kt] = [at(10.0, 1e3), at(10.0, 1e3), at(1e2, 1e4), at(1e2, 1e4)];
        let (mu, approach) = (at(0.1, 0.8), at(1e-3, 1e-2));
        let normal = kn * approach / (1.0 + kn / kz);
        let force = at(0.0, 2.0) * mu * normal * (kx + kt) / kt;
        let law = SlidingLaw {
            bristle: Some(Bristle { stiffness: kt, damping: 0.0 }),
            ..SlidingLaw::new(NormalLaw::linear(kn), Coulomb { mu0: mu }, 0.0)
        };
        let contact = point(0.0, 1.0, vector(&[(1, -1.0)]), vector(&[(0, 1.0)]), vector(&[]));
        let k = [[kx, 0.0], [0.0, kz]];
        let mut system = random_system(2, 1, 1.0, 1);
        system.structure = structure(2, |i, j| f64::from(i == j), |i, j| k[i][j]);
        system.pairs = vec![pair(vec![contact], law, Closing::Approach(approach), 0.0)];
        system.load = vec![force, 0.0];
        let state = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let found = &state.points[0];
        assert!(within(found.forces.normal / normal - 1.0, 1e-9, Tolerance), "{found:?} {normal}");
        let slips = kt * force / (kx + kt) > mu * normal;
        assert_eq!(found.slips, slips, "{found:?}");
        counts[usize::from(slips)] += 1;
    }
    assert!(counts[0] > 50 && counts[1] > 50, "{counts:?}");
}
