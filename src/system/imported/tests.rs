//! Imported matrices, split and put together again.

use super::*;
use crate::bounds::{Origin::*, within};
use crate::linalg::random::Random;
use crate::linalg::samples;
use crate::linalg::sparse::entry;

fn real(re: SparseMatrix) -> MarketMatrix {
    MarketMatrix { re, im: None }
}

fn given(matrix: &MarketMatrix) -> Given<'_> {
    Given { place: "`matrices.stiffness` k.mtx", matrix }
}

/// K of a plate plus friction-like terms: n points that couple three rows each, in units far apart.
fn with_friction(points: usize, unit: f64) -> (SparseMatrix, SparseMatrix) {
    let (k, m) = samples::plate(8, false);
    let (n, mut triplets) = (k.nrows(), Vec::new());
    for p in 0..points {
        let [w, t, r] = [3 * p, 3 * p + 1, 3 * p + 2];
        for (row, factor) in [(w, 1e4), (t, 4e3 * unit), (r, -3e3 * unit)] {
            triplets.push(entry(row, w, factor));
            triplets.push(entry(row, n - 3, -factor));
        }
    }
    let contact = SparseMatrix::try_new_from_triplets(n, n, &triplets).unwrap();
    (add_scaled(&[(1.0, &k), (1.0, &contact)]), m)
}

#[test]
fn the_parts_add_up_to_what_was_given() {
    for (points, unit) in [(1, 1.0), (5, 1e-9), (9, 1.0)] {
        let (k, m) = with_friction(points, unit);
        let imported =
            split(given(&real(m)), Some(given(&real(k.clone()))), given(&real(k.clone())), &[]).unwrap();
        let coupling = imported.coupling.unwrap();
        // The points share one dof, hence one group: ½ skew of g tᵀ per point has rank 2 for all that share t; one-sided, beside
        // a diagonal that stays, 3.
        assert!(coupling.directions.len() <= 3 * points, "{} of {points}", coupling.directions.len());
        let [rest, rest_c] = coupling.assembled(k.nrows()).unwrap();
        let viscous = imported.structure.damping.viscous.unwrap();
        let size = row_sizes(&k);
        for (symmetric, rest) in [(&imported.structure.stiffness, &rest), (&viscous, &rest_c)] {
            let difference = add_scaled(&[(1.0, &k), (-1.0, symmetric), (-1.0, rest)]);
            for j in 0..k.ncols() {
                for (i, v) in difference.row_idx_of_col(j).zip(difference.val_of_col(j)) {
                    assert!(within(v.abs(), 4e-15 * (size[i] * size[j]).sqrt(), RoundOff), "{i} {j} {v:e}");
                }
            }
            let t = symmetric.transpose().to_col_major().unwrap();
            assert_eq!(t.val(), symmetric.val());
        }
    }
}

/// Two discs' worth of contact pairs, each friction term a moment about a slanted axis and far smaller than the
/// entries of K that it is added to.
#[test]
fn rounding_of_small_terms_on_large_entries_is_no_rank() {
    let (k, m) = samples::plate(12, false);
    let (n, pairs) = (k.nrows(), 20);
    for size in [1e-2, 1e-5, 1e-7] {
        let mut triplets = Vec::new();
        for p in 0..pairs {
            let angle = 0.3 + p as f64;
            let [upper, lower] = [3 * p, n - 3 - 3 * p];
            for moment in [upper, lower] {
                for (row, part) in [(moment + 1, angle.cos()), (moment + 2, angle.sin())] {
                    let scale = size * (k[(row, row)] * k[(upper, upper)]).sqrt() * part;
                    triplets.push(entry(row, upper, scale));
                    triplets.push(entry(row, lower, -scale));
                }
            }
        }
        let friction = SparseMatrix::try_new_from_triplets(n, n, &triplets).unwrap();
        let noisy = add_scaled(&[(1.0, &k), (1.0, &friction)]);
        let damping = add_scaled(&[(1e-5, &k), (3.0, &m), (1e-6, &friction)]);
        let (k, c) = (real(noisy), real(damping));
        let coupling = split(given(&real(m.clone())), Some(given(&c)), given(&k), &[]).unwrap().coupling;
        assert_eq!(coupling.unwrap().directions.len(), 2 * pairs, "{size:e}");
    }
}

#[test]
fn groups_that_do_not_meet_stay_apart_and_sparse() {
    let (k, m) = samples::plate(8, false);
    let triplets: Vec<_> = (0..6).map(|p| entry(9 * p, 9 * p + 1, 1e3)).collect();
    let friction = SparseMatrix::try_new_from_triplets(k.nrows(), k.nrows(), &triplets).unwrap();
    let k = add_scaled(&[(1.0, &k), (1.0, &friction)]);
    let coupling = split(given(&real(m)), None, given(&real(k)), &[]).unwrap().coupling.unwrap();
    assert_eq!(coupling.directions.len(), 12);
    assert!(coupling.directions.iter().all(|d| d.indices().len() == 1));
    assert!(
        within((coupling.stiffness[(0, 1)] - 500.0).abs(), 1e-9, RoundOff)
            && coupling.stiffness[(0, 2)] == 0.0
    );
}

#[test]
fn rounding_of_the_exporter_is_no_coupling_and_a_loss_factor_is_hysteretic() {
    let (k, m) = samples::plate(6, false);
    let mut rounded = k.clone();
    rounded.val_of_col_mut(5)[0] *= 1.0 + 4.0 * f64::EPSILON;
    let im = add_scaled(&[(0.01, &k)]);
    let lossy = MarketMatrix { re: rounded, im: Some(im.clone()) };
    let imported = split(given(&real(m)), None, given(&lossy), &[]).unwrap();
    assert!(imported.coupling.is_none() && imported.structure.damping.viscous.is_none());
    let hysteretic = imported.structure.damping.hysteretic.unwrap();
    assert!(hysteretic.val().iter().zip(im.val()).all(|(a, b)| within((a - b).abs(), 1e-11, RoundOff)));
}

#[test]
fn what_has_no_meaning_is_refused_all_at_once() {
    let (k, m) = with_friction(2, 1.0);
    let complex = |re: &SparseMatrix, im: &SparseMatrix| MarketMatrix {
        re: add_scaled(&[(1.0, re), (0.0, im)]),
        im: Some(add_scaled(&[(0.0, re), (1.0, im)])),
    };
    let mut bad_mass = add_scaled(&[(1.0, &k)]);
    bad_mass.val_of_col_mut(0)[0] = -1.0;
    let (bad_mass, c, lossy) = (real(bad_mass), complex(&m, &m), complex(&m, &k));
    let text = split(given(&bad_mass), Some(given(&c)), given(&lossy), &[]).unwrap_err().to_string();
    for part in ["4 faults", "symmetric mass", "masses of zero", "real damping", "imaginary part with"] {
        assert!(text.contains(part), "{part} not in\n{text}");
    }
    let small = real(samples::plate(5, false).1);
    let text = split(given(&small), None, given(&real(k.clone())), &[]).unwrap_err().to_string();
    assert!(text.contains("as the mass has it"), "{text}");
    let n = k.nrows();
    let hole = SparseMatrix::try_new_from_triplets(n, n, &[entry(0, 0, 1.0)]).unwrap();
    let hole = real(hole);
    let text = split(given(&hole), None, given(&hole), &[]).unwrap_err().to_string();
    assert!(text.contains(&format!("{} rows of zeros, row 2", n - 1)), "{text}");
}

#[test]
fn masses_that_are_zero_but_for_rounding_are_zero() {
    let diagonal = |m: &[f64]| {
        let entries: Vec<_> = m.iter().enumerate().map(|(i, m)| entry(i, i, *m)).collect();
        real(SparseMatrix::try_new_from_triplets(m.len(), m.len(), &entries).unwrap())
    };
    let k = diagonal(&[1.0; 4]);
    let mass = split(given(&diagonal(&[1e-6, -1e-27, 3e-18, 2e-7])), None, given(&k), &[]).unwrap();
    let mass = mass.structure.mass;
    assert_eq!([0, 1, 2, 3].map(|i| mass[(i, i)]), [1e-6, 0.0, 3e-18, 2e-7]);
    let error = split(given(&diagonal(&[1e-6, -1e-20, 1e-7, 2e-7])), None, given(&k), &[]).unwrap_err();
    assert!(error.to_string().contains("masses of zero or more"), "{error}");
}

#[test]
fn a_skew_part_of_high_rank_stays_sparse() {
    let n = 5000;
    let triplets: Vec<_> =
        (0..n).flat_map(|i| [(i, i, 2.0), (i, (i + 1) % n, 0.5)]).map(|(i, j, v)| entry(i, j, v)).collect();
    let k = real(SparseMatrix::try_new_from_triplets(n, n, &triplets).unwrap());
    let ones: Vec<_> = (0..n).map(|i| entry(i, i, 1.0)).collect();
    let m = real(SparseMatrix::try_new_from_triplets(n, n, &ones).unwrap());
    let imported = split(given(&m), Some(given(&k)), given(&k), &[]).unwrap();
    let coupling = imported.coupling.unwrap();
    assert!(coupling.directions.is_empty() && coupling.skew.is_some());
    let [rest, rest_c] = coupling.assembled(n).unwrap();
    for (symmetric, rest) in
        [(imported.structure.stiffness, rest), (imported.structure.damping.viscous.unwrap(), rest_c)]
    {
        assert_eq!((rest.get(0, 1), rest.get(1, 0)), (Some(&0.25), Some(&-0.25)));
        let difference = add_scaled(&[(1.0, &k.re), (-1.0, &symmetric), (-1.0, &rest)]);
        assert!(difference.val().iter().all(|v| *v == 0.0));
    }
}

/// A chain of n masses between walls, springs from 1e5 to 3e5 N/m: K and M.
fn chain(n: usize, seed: u64) -> [SparseMatrix; 2] {
    let mut random = Random::seeded(seed);
    let mut stiffness = Vec::new();
    for i in 0..=n {
        let k = 1e5 * (2.0 + random.next());
        let ends: Vec<usize> = [i.checked_sub(1), (i < n).then_some(i)].into_iter().flatten().collect();
        for a in &ends {
            stiffness.extend(ends.iter().map(|b| entry(*a, *b, if a == b { k } else { -k })));
        }
    }
    let mass: Vec<_> = (0..n).map(|i| entry(i, i, 2.0 + random.next())).collect();
    [stiffness, mass].map(|entries| SparseMatrix::try_new_from_triplets(n, n, &entries).unwrap())
}

#[test]
fn asymmetry_of_rounding_in_many_rows_is_left_out_with_a_warning() {
    for (seed, size) in [1e-13, 3e-12, 5e-11].into_iter().enumerate() {
        for n in [20, 600] {
            let [exact, mass] = chain(n, seed as u64);
            let (mut given_k, mut random) = (exact.clone(), Random::seeded(7));
            for j in 0..n {
                given_k.val_of_col_mut(j).iter_mut().for_each(|v| *v *= 1.0 + size * random.next());
            }
            let found = split(given(&real(mass)), None, given(&real(given_k)), &[]).unwrap();
            assert!(found.coupling.is_none(), "{n} {size:e}");
            assert!(found.warnings.iter().any(|w| w.contains("not symmetric")), "{:?}", found.warnings);
            let rest = add_scaled(&[(1.0, &*found.structure.stiffness), (-1.0, &exact)]);
            // The mean of two entries that are off by `size` at most.
            assert!(
                rest.val().iter().all(|v| within(v.abs(), 1.01 * size * 6e5, RandomSample)),
                "{n} {size:e}"
            );
        }
    }
}

#[test]
fn rows_of_multipliers_are_refused_wherever_they_stand() {
    for seed in 0..12 {
        let (n, count) = (5 + seed as usize, 1 + seed as usize % 3);
        let [k, m] = chain(n, seed);
        // Each multiplier couples two masses, at the end or at the beginning of the matrices.
        let first = if seed % 2 == 0 { n } else { 0 };
        let place = |i: usize| if first == 0 { i + count } else { i };
        let moved = |a: &SparseMatrix| -> Vec<_> {
            let column = |j: usize| a.row_idx_of_col(j).zip(a.val_of_col(j)).map(move |(i, v)| (i, j, *v));
            (0..n).flat_map(column).map(|(i, j, v)| entry(place(i), place(j), v)).collect()
        };
        let (mut stiffness, mass) = (moved(&k), moved(&m));
        for c in 0..count {
            let size = 10f64.powi(seed as i32 - 3);
            for (mass, sign) in [(c, 1.0), (c + 2, -1.0)] {
                let [row, column] = [first + c, place(mass)];
                stiffness.extend([entry(row, column, sign * size), entry(column, row, sign * size)]);
            }
        }
        let [k, m] = [stiffness, mass]
            .map(|all| real(SparseMatrix::try_new_from_triplets(n + count, n + count, &all).unwrap()));
        let text = split(given(&m), None, given(&k), &[]).unwrap_err().to_string();
        assert!(text.contains(&format!("row {}", first + 1)) && text.contains("Lagrange"), "{seed}: {text}");
    }
}

/// [a m; m b] has a negative eigenvalue beyond m² = ab; at m² = ab, in a few digits, and without a diagonal it is taken.
#[test]
fn a_mass_of_negative_kinetic_energy_is_refused() {
    let mut random = Random::seeded(8);
    for (trial, part) in [0.3, 1.0, 1.003, 1.02, 3.0, -0.9, -1.1].into_iter().enumerate() {
        let unit = 10f64.powf(random.between(-9.0, 3.0));
        let [a, b] = [0.5 * unit, 1e4 * random.between(0.5, 2.0) * unit];
        let m = part * (a * b).sqrt();
        let entries = [entry(0, 0, a), entry(2, 2, b), entry(0, 2, m), entry(2, 0, m), entry(1, 1, unit)];
        let mass = SparseMatrix::try_new_from_triplets(3, 3, &entries).unwrap();
        let mass = MarketMatrix { re: mass, im: None };
        let stiffness = real(samples::identity(3));
        let found = split(Given { place: "m.mtx", matrix: &mass }, None, given(&stiffness), &[]);
        let words = found.err().map(|error| error.to_string()).unwrap_or_default();
        assert_eq!(words.contains("row 3 and column 1"), part.abs() > 1.01, "{trial}: {words}");
    }
}
