//! Springs between masses with friction contacts, given as matrices in every way in which other programs write them.

use super::*;
use crate::bounds::{Origin::*, within};
use crate::linalg::matrix_market::MarketMatrix;
use crate::linalg::random::Random;
use crate::linalg::samples;
use crate::system::{Given, Imported, split};

/// How contacts get into the matrices.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Way {
    /// K with the normal stiffness, and friction as a term.
    Friction,
    /// K of the structure, and the whole contacts as a term.
    Contact,
    /// All in K.
    All,
}

/// A held chain of nodes with two degrees of freedom each, and `points` contacts between its nodes, or to the ground, of
/// stiffness `k` and friction μ, their normals turned by `slant` a point: K of the structure, normal stiffness, friction, M.
fn sample(points: usize, k: f64, mu: f64, slant: f64, seed: u64) -> [Mat<f64>; 4] {
    let (nodes, mut random) = (30, Random::seeded(seed));
    let n = 2 * nodes;
    let mut structure = Mat::<f64>::zeros(n, n);
    for i in 0..n {
        structure[(i, i)] += 1e3 * (1.5 + random.next());
        for j in [i + 1, i + 2].into_iter().filter(|j| *j < n) {
            let spring = 1e6 * (1.5 + random.next());
            for (a, b, sign) in [(i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)] {
                structure[(a, b)] += sign * spring;
            }
        }
    }
    let (mut normal, mut friction) = (Mat::<f64>::zeros(n, n), Mat::<f64>::zeros(n, n));
    for p in 0..points {
        let (sin, cos) = (slant * (p + 1) as f64).sin_cos();
        let mut ends = vec![(2 * p, 1.0)];
        if p % 2 == 0 {
            ends.push((n - 2 - 2 * p, -1.0));
        }
        let (mut g, mut t) = (vec![0.0; n], vec![0.0; n]);
        for (x, sign) in ends {
            (g[x], g[x + 1]) = (sign * sin, sign * cos);
            (t[x], t[x + 1]) = (sign * cos, -sign * sin);
        }
        for i in 0..n {
            for j in 0..n {
                normal[(i, j)] += k * g[i] * g[j];
                friction[(i, j)] -= mu * k * t[i] * g[j];
            }
        }
    }
    let mass = Mat::from_fn(n, n, |i, j| if i == j { 1.3 + 0.3 * random.next() } else { 0.0 });
    [structure, normal, friction, mass]
}

fn imported([structure, normal, friction, mass]: &[Mat<f64>; 4], way: Way) -> Imported {
    let market = |a: &Mat<f64>| MarketMatrix { re: samples::from_dense(a.as_ref()), im: None };
    let (k, terms) = match way {
        Way::Friction => (structure + normal, vec![market(friction).re]),
        Way::Contact => (structure.clone(), vec![market(&(normal + friction)).re]),
        Way::All => (structure + normal + friction, Vec::new()),
    };
    let (m, k) = (market(mass), market(&k));
    split(Given { place: "M", matrix: &m }, None, Given { place: "K", matrix: &k }, &terms).unwrap()
}

#[test]
fn the_structure_of_contacts_with_friction_has_no_negative_eigenvalue() {
    for seed in 0..24 {
        let (points, k) = (1 + seed as usize % 7, 10f64.powi(6 + seed as i32 % 6));
        let (mu, slant) = ([0.1, 0.4, 1.1][seed as usize % 3], [0.0, 0.17][seed as usize / 3 % 2]);
        let parts = sample(points, k, mu, slant, seed);
        let all = &parts[0] + &parts[1] + &parts[2];
        let size = all.norm_max();
        for way in [Way::Friction, Way::Contact, Way::All] {
            let found = imported(&parts, way);
            let structure = found.structure.stiffness.to_dense();
            let words = format!("{way:?}, {points} points of {k:e}, μ {mu}, slant {slant}");
            let (values, _) = symmetric_eigen(structure.as_ref()).unwrap();
            assert!(within(-values[0], 60.0 * 1e-15 * size, RoundOff), "{words}: {}", values[0]);
            let rest = found.coupling.as_ref().unwrap();
            // One force and one motion a point; more where K alone does not show which is which.
            assert!(rest.directions.len() <= 4 * points, "{words}: {}", rest.directions.len());
            let [rest, _] = rest.assembled(structure.nrows()).unwrap();
            let error = (&structure + rest.to_dense() - &all).norm_max();
            // A few roundings for each of up to seven points in the largest entry.
            assert!(within(error, 100.0 * f64::EPSILON * size, RoundOff), "{words}: {error:e} of {size:e}");
            if way != Way::All {
                // The contact as it is: closed, with its friction whole.
                let closed = (&structure - &parts[0] - &parts[1]).norm_max();
                assert!(
                    within(closed, 100.0 * f64::EPSILON * size, RoundOff),
                    "{words}: {closed:e} of {size:e}"
                );
            }
        }
    }
}

#[test]
fn a_coupling_of_many_rows_is_taken_by_its_columns() {
    let n = 2 * LARGEST_GROUP;
    let entries: Vec<_> =
        (0..n - 1).flat_map(|i| [entry(i, n - 1, 1.0 + i as f64), entry(i, 0, -1.0 - i as f64)]).collect();
    let term = SparseMatrix::try_new_from_triplets(n, n, &entries).unwrap();
    let (holding, terms) = divided(&term);
    assert!(holding.val().is_empty() && terms.len() == 1, "{} terms", terms.len());
    let [whole, _] = low_rank(terms, 2).unwrap().assembled(n).unwrap();
    let difference = add_scaled(&[(1.0, &whole), (-1.0, &term)]);
    assert!(difference.val().iter().all(|v| within(v.abs(), 1e-12 * n as f64, RoundOff)));
}
