//! Small hand-made systems for the tests of equilibrium and stability.

use crate::contact::{Coulomb, Exponential, NormalLaw, SlidingLaw};
use crate::linalg::random::Random;
use crate::linalg::{SparseMatrix, SparseVector, sparse};
use crate::system::{Closing, ContactPair, ContactPoint, Coupling, Damping, Skew, Structure, System};
use std::sync::Arc;

/// A sparse matrix from its dense rows.
pub(crate) fn sparse(n: usize, entry: impl Fn(usize, usize) -> f64) -> SparseMatrix {
    let all = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
    let triplets: Vec<_> =
        all.map(|(i, j)| sparse::entry(i, j, entry(i, j))).filter(|t| t.val != 0.0).collect();
    SparseMatrix::try_new_from_triplets(n, n, &triplets).unwrap()
}

/// A structure of n dofs without damping.
pub(crate) fn structure(
    n: usize,
    m: impl Fn(usize, usize) -> f64,
    k: impl Fn(usize, usize) -> f64,
) -> Structure {
    Structure {
        mass: sparse(n, m).into(),
        stiffness: sparse(n, k).into(),
        damping: Damping::default(),
        engine: Default::default(),
    }
}

pub(crate) fn vector(entries: &[(usize, f64)]) -> SparseVector {
    SparseVector::from_entries(entries.iter().copied())
}

pub(crate) fn point(
    gap: f64,
    weight: f64,
    g: SparseVector,
    t1: SparseVector,
    t2: SparseVector,
) -> ContactPoint {
    ContactPoint { position: [0.0; 3], gap, weight, speed: 1.0, normal: g, tangents: [t1, t2] }
}

pub(crate) fn pair(
    points: Vec<ContactPoint>,
    law: SlidingLaw,
    closing: Closing,
    velocity: f64,
) -> ContactPair {
    ContactPair {
        name: "pair".into(),
        points: points.into(),
        law: Arc::new(law),
        closing,
        sliding_velocity: velocity,
    }
}

/// A bar of 60 masses on a belt, `each` contact points from one to the next: it bends across (y) and stretches along (x), and touches below its axis,
/// so that t is x − h y′; the face is inclined, so that friction and pressure drive each other: the bar flutters. Damped in proportion to stiffness and mass.
pub(crate) fn fluttering_bar(load: f64, each: usize) -> System {
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
        Some(sparse::add_scaled(&[(2e-4, &structure.stiffness), (0.02, &structure.mass)]).into());
    let points = (0..each * (MASSES - 1)).map(|p| {
        let (node, part) = (p / each, ((p % each) as f64 + 0.5) / each as f64);
        let between = |first: usize| [(first + node, 1.0 - part), (first + node + 1, part)];
        let slope = [(node, 2.0), (node + 1, -2.0)];
        let across = [between(0).map(|(i, v)| (i, -v)), between(MASSES).map(|(i, v)| (i, 0.2 * v))].concat();
        let along = between(MASSES).into_iter().chain(slope).collect::<Vec<_>>();
        point(0.0, 3.0 / each as f64, vector(&across), vector(&along), vector(&[]))
    });
    let normal = NormalLaw { stiffness: 60.0, cubic_stiffness: 1e6, damping: 0.0, bilateral: false };
    let law = SlidingLaw::new(normal, Coulomb { mu0: 0.3 }, 1e-3);
    let pairs = vec![pair(points.collect(), law, Closing::Load(load), 0.02)];
    System { structure, pairs, load: vec![0.0; 2 * MASSES], prestress: None, coupling: None }
}

/// Random skew parts of full rank, gyroscopic of the size `spin` and circulatory of the size `friction`.
pub(crate) fn skew_parts(n: usize, seed: u64, spin: f64, friction: f64) -> Coupling {
    let mut random = Random::seeded(seed);
    let mut skew = |size: f64| {
        let below: Vec<f64> = (0..n).map(|_| size * random.next()).collect();
        let value = |i: usize, j: usize| match i.abs_diff(j) {
            1 | 5 => below[i.min(j)] * if i > j { 1.0 } else { -1.0 },
            _ => 0.0,
        };
        Arc::new(sparse(n, value))
    };
    Coupling::sparse(Skew { stiffness: skew(friction), damping: skew(spin) })
}

/// The two-degree-of-freedom model: one mass, k₁ = 1 along x, k₂ = 1 at 45°, k_t along x, on a belt under it that
/// moves along +x; bilateral contact. The mass is pressed down (−y), so δ = −y: g = (0, −1), and t = (1, 0).
pub(crate) fn two_dof(k_t: f64, k_n: f64, mu: f64) -> System {
    let k = [[1.5 + k_t, -0.5], [-0.5, 0.5]];
    let normal = NormalLaw { bilateral: true, ..NormalLaw::linear(k_n) };
    let point = point(0.0, 1.0, vector(&[(1, -1.0)]), vector(&[(0, 1.0)]), SparseVector::default());
    System {
        structure: structure(2, |i, j| if i == j { 1.0 } else { 0.0 }, |i, j| k[i][j]),
        pairs: vec![pair(
            vec![point],
            SlidingLaw::new(normal, Coulomb { mu0: mu }, 0.0),
            Closing::Approach(0.0),
            1.0,
        )],
        load: vec![0.0, -1.0],
        prestress: None,
        coupling: None,
    }
}

/// A random elastic body of `n` degrees of freedom on springs to the ground, with `points` unilateral contact points
/// of random sparse directions, a cubic normal law and falling friction, pressed by `load`.
pub(crate) fn random_system(n: usize, points: usize, load: f64, seed: u64) -> System {
    let mut random = Random::seeded(seed);
    let ground: Vec<f64> = (0..n).map(|_| random.between(50.0, 400.0)).collect();
    let link: Vec<f64> = (0..n).map(|_| random.between(200.0, 2000.0)).collect();
    let far: Vec<f64> = (0..n).map(|_| random.between(10.0, 100.0)).collect();
    let mass: Vec<f64> = (0..n).map(|_| random.between(0.5, 2.0)).collect();
    let spring = |i: usize, j: usize| -> f64 {
        let (low, high) = (i.min(j), i.max(j));
        match high - low {
            1 => -link[low],
            5 => -far[low],
            _ => 0.0,
        }
    };
    let stiffness = |i: usize, j: usize| {
        if i != j {
            return spring(i, j);
        }
        ground[i] - (0..n).filter(|k| *k != i).map(|k| spring(i, k)).sum::<f64>()
    };
    let structure = structure(
        n,
        |i, j| match i.abs_diff(j) {
            0 => mass[i],
            1 => 0.1,
            _ => 0.0,
        },
        stiffness,
    );
    let points = (0..points)
        .map(|_| {
            let mut direction = |entries: usize| {
                let pick: Vec<(usize, f64)> =
                    (0..entries).map(|_| (random.below(n), random.between(-1.0, 1.0))).collect();
                vector(&pick)
            };
            let (g, t1, t2) = (direction(4), direction(4), direction(3));
            point(random.between(0.0, 0.02), random.between(0.5, 1.5), g, t1, t2)
        })
        .collect();
    let normal = NormalLaw { stiffness: 300.0, cubic_stiffness: 2e4, damping: 0.0, bilateral: false };
    let law = SlidingLaw::new(normal, Exponential { mu0: 0.35, mu1: 0.25, alpha: 0.8 }, 1e-3);
    System {
        structure,
        pairs: vec![pair(points, law, Closing::Load(load), 1.2)],
        load: (0..n).map(|_| random.between(-1.0, 1.0)).collect(),
        prestress: None,
        coupling: None,
    }
}
