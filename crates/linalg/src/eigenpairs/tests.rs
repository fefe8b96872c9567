use super::super::dense::definite_pencil;
use super::super::factor::{factorize, singular};
use super::super::random::Random;
use super::super::samples;
use super::super::sparse::entry;
use super::*;
use std::f64::consts::PI;
use stridor_base::bounds::{Origin::*, within};

fn check(m: &SparseMatrix, pairs: &Eigenpairs) {
    check_to(1e-13, m, pairs);
}

fn check_to(worst: f64, m: &SparseMatrix, pairs: &Eigenpairs) {
    let mx = times(m, pairs.vectors.as_ref());
    let g = gram(pairs.vectors.as_ref(), mx.as_ref());
    let count = pairs.values.len();
    assert!(within((g - Mat::<f64>::identity(count, count)).norm_max(), 1e-12, RoundOff), "M-orthonormal");
    assert!(pairs.backward_errors.iter().all(|e| within(*e, worst, Stated)), "{:?}", pairs.backward_errors);
    assert_eq!(pairs.sturm.counted, [count; 2]);
    assert!(pairs.sturm.shifts[0] <= pairs.sturm.bound && pairs.sturm.bound <= pairs.sturm.shifts[1]);
}

#[test]
fn membrane_with_double_eigenvalues() {
    let (k, m) = samples::membrane(40);
    let exact = samples::membrane_eigenvalues(40);
    for wanted in [Wanted::Below(0.5), Wanted::Count(61)] {
        let pairs = lowest_eigenpairs(&k, &m, wanted, &()).unwrap();
        check(&m, &pairs);
        for (value, exact) in pairs.values.iter().zip(&exact) {
            // Ten times ε ‖K‖, which the lowest cannot be better than.
            let bound = 1e-12 * exact + 10.0 * f64::EPSILON * 8.0;
            assert!(within((value - exact).abs(), bound, RoundOff), "{value} {exact}");
        }
        match wanted {
            Wanted::Below(bound) => {
                assert_eq!(pairs.values.len(), exact.iter().filter(|v| **v < bound).count())
            }
            Wanted::Count(count) => {
                assert!(pairs.values.len() >= count && pairs.values.len() < count + 3)
            }
        }
    }
}

#[test]
fn free_chain_has_its_rigid_body_mode() {
    for n in [1, 2, 5, 50, 400] {
        let (k, m) = samples::free_chain(n);
        let pairs = lowest_eigenpairs(&k, &m, Wanted::Count(n.min(12)), &()).unwrap();
        check(&m, &pairs);
        for (j, value) in pairs.values.iter().enumerate() {
            let exact = 4.0 * (j as f64 * std::f64::consts::PI / (2 * n) as f64).sin().powi(2);
            assert!(within((value - exact).abs(), 1e-13, RoundOff), "{n} {j} {value} {exact}");
        }
    }
}

/// Fewer than the rigid-body motions: they are one cluster, and come whole.
#[test]
fn a_free_body_gives_its_rigid_motions_however_few_are_wanted() {
    for (size, count) in [(4, 1), (4, 2), (4, 3), (20, 1), (20, 2), (20, 3)] {
        let (k, m) = samples::plate(size, false);
        let pairs = lowest_eigenpairs(&k, &m, Wanted::Count(count), &()).unwrap();
        assert_eq!(pairs.values.len(), 3, "{size} {count}");
        assert_eq!(pairs.sturm.counted, [3; 2]);
        let elastic = lowest_eigenpairs(&k, &m, Wanted::Count(4), &()).unwrap().values[3];
        assert!(pairs.values.iter().all(|v| within(v.abs(), 1e-6 * elastic, RoundOff)), "{:?}", pairs.values);
    }
}

/// Masses that are nothing beside the stiffness, or zero, end in an error, not in a panic.
#[test]
fn matrices_without_eigenvalues_are_refused() {
    for (size, scales) in [(4, [1e-300, 1e-200, 1e200].as_slice()), (20, [1e-104].as_slice())] {
        let (k, m) = samples::plate(size, true);
        for scale in scales {
            let m = add_scaled(&[(*scale, &m)]);
            for wanted in [Wanted::Count(3), Wanted::Below(1e6)] {
                if let Err(error) = lowest_eigenpairs(&k, &m, wanted, &()) {
                    assert_eq!(error.exit_code(), 1, "{error}");
                }
            }
        }
        assert!(lowest_eigenpairs(&k, &add_scaled(&[(0.0, &m)]), Wanted::Count(3), &()).is_err());
    }
}

#[test]
fn a_bound_on_an_eigenvalue_moves_up() {
    let (k, m) = samples::membrane(20);
    let exact = samples::membrane_eigenvalues(20);
    let pairs = lowest_eigenpairs(&k, &m, Wanted::Below(exact[10]), &()).unwrap();
    check(&m, &pairs);
    assert!(pairs.values.len() >= 10 && pairs.sturm.bound >= exact[10]);
}

#[test]
fn factors_at_hand_find_the_same_pairs() {
    let (k, m) = samples::membrane(40);
    let exact = samples::membrane_eigenvalues(40);
    // Where the count is taken at the second bound, there is an eigenvalue.
    for bound in [0.5, exact[20] / (1.0 + APART)] {
        let shift = 0.17 * bound;
        let factor = factorize(&add_scaled(&[(1.0, &k), (-shift, &m)])).unwrap();
        let pairs = eigenpairs_below(&k, &m, bound, (shift, factor), &()).unwrap();
        check_to(BASIS.backward_error, &m, &pairs);
        assert_eq!(pairs.shift, shift);
        let below = exact.iter().filter(|v| **v < pairs.sturm.bound).count();
        assert!(pairs.values.len() == below && below >= exact.iter().filter(|v| **v < bound).count());
        for (value, exact) in pairs.values.iter().zip(&exact) {
            assert!(within((value - exact).abs(), 1e-12 * exact, RoundOff), "{value} {exact}");
        }
    }
    let factor = factorize(&k).unwrap();
    assert!(eigenpairs_below(&k, &m, f64::NAN, (0.0, factor), &()).is_err());
}

#[test]
fn free_plate_agrees_with_the_dense_solver() {
    let (k, m) = samples::plate(14, false);
    let (values, _) = definite_pencil(k.to_dense().as_ref(), m.to_dense().as_ref()).unwrap();
    let bound = 0.5 * (values[40] + values[41]);
    let pairs = lowest_eigenpairs(&k, &m, Wanted::Below(bound), &()).unwrap();
    check(&m, &pairs);
    assert_eq!(pairs.values.len(), 41);
    for (value, dense) in pairs.values.iter().zip(&values) {
        assert!(within((value - dense).abs(), 1e-14 * values[values.len() - 1], RoundOff), "{value} {dense}");
    }
    assert!(
        pairs.values[..3].iter().all(|v| within(v.abs(), 1e-6 * pairs.values[3], RoundOff)),
        "three rigid-body modes"
    );
}

#[test]
fn massless_degrees_of_freedom_have_no_finite_eigenvalue() {
    // A chain in which only every tenth point has mass: stiffness of ten springs in series between them.
    for n in [100, 1000] {
        let (k, _) = samples::free_chain(n);
        let entries: Vec<_> = (0..n).step_by(10).map(|p| entry(p, p, 1.0)).collect();
        let m = SparseMatrix::try_new_from_triplets(n, n, &entries).unwrap();
        let masses = n / 10;
        let exact = |j: usize| 0.4 * (j as f64 * std::f64::consts::PI / (2 * masses) as f64).sin().powi(2);
        let few = lowest_eigenpairs(&k, &m, Wanted::Count(6), &()).unwrap();
        let all = lowest_eigenpairs(&k, &m, Wanted::Count(n), &()).unwrap();
        let below = lowest_eigenpairs(&k, &m, Wanted::Below(0.5 * (exact(4) + exact(5))), &()).unwrap();
        assert_eq!((few.values.len(), below.values.len(), all.values.len()), (6, 5, masses));
        for pairs in [&few, &below, &all] {
            check(&m, pairs);
            for (j, value) in pairs.values.iter().enumerate() {
                // η ‖K‖₁ ‖x‖² with the backward error that is aimed at, 1e-14, and ‖x‖² = 10 for masses 1 on every tenth point;
                // round-off adds as much.
                let bound = 10.0 * 2.0 * 1e-14 * 4.0 * 10.0;
                assert!(within((value - exact(j)).abs(), bound, RoundOff), "{n} {j}");
            }
        }
    }
}

#[test]
fn a_withheld_mode_is_noticed() {
    let (k, m) = samples::membrane(12);
    let pencil = Pencil::new(&k, &m, &Engine::default()).unwrap();
    let whole = lowest_eigenpairs(&k, &m, Wanted::Count(7), &()).unwrap();
    let count = whole.values.len();
    let mut found =
        Found { values: whole.values, vectors: whole.vectors, shift: whole.shift, factor: whole.factor };
    found.values.remove(3);
    found.vectors = Mat::from_fn(144, count - 1, |i, j| found.vectors[(i, if j < 3 { j } else { j + 1 })]);
    let error = pencil.certify(found, whole.sturm).unwrap_err().to_string();
    assert!(
        error.contains(&format!("counts {count}")) && error.contains(&format!("{} were found", count - 1))
    );
}

#[test]
fn many_copies_are_all_found() {
    // Twenty equal chains side by side: every eigenvalue twenty times, more than a block holds.
    let (n, copies) = (30, 20);
    let (k, _) = samples::free_chain(n);
    let mut entries = Vec::new();
    for c in 0..copies {
        for j in 0..n {
            for (i, v) in k.row_idx_of_col(j).zip(k.val_of_col(j)) {
                entries.push(entry(c * n + i, c * n + j, *v));
            }
        }
    }
    let k = SparseMatrix::try_new_from_triplets(n * copies, n * copies, &entries).unwrap();
    let m = samples::identity(n * copies);
    for (wanted, expected) in [(Wanted::Below(0.03), 40), (Wanted::Count(45), 60)] {
        let pairs = lowest_eigenpairs(&k, &m, wanted, &()).unwrap();
        check(&m, &pairs);
        assert_eq!(pairs.values.len(), expected, "{wanted:?}");
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let (k, m) = samples::plate(18, true);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| lowest_eigenpairs(&k, &m, Wanted::Count(30), &()).unwrap())
    };
    let (one, three) = (with(1), with(3));
    assert!(one.values == three.values && one.vectors == three.vectors);
}

#[test]
fn senseless_requests_are_refused() {
    let (k, m) = samples::free_chain(4);
    for wanted in [Wanted::Below(-1.0), Wanted::Below(f64::NAN), Wanted::Count(0)] {
        assert!(lowest_eigenpairs(&k, &m, wanted, &()).is_err());
    }
    let none = lowest_eigenpairs(&samples::identity(4), &m, Wanted::Below(0.5), &()).unwrap();
    assert!(none.values.is_empty() && none.sturm.counted == [0, 0]);
}

#[test]
fn negative_eigenvalues_belong_to_the_lowest() {
    // A preload beyond buckling makes K indefinite.
    for side in [12, 24] {
        let (k, m) = samples::membrane(side);
        let exact = samples::membrane_eigenvalues(side);
        // The fifth and sixth are one double eigenvalue: K is singular, too.
        let load = exact[4];
        assert!(within((exact[5] - load).abs(), 1e-12, RoundOff));
        let buckled = add_scaled(&[(1.0, &k), (-load, &m)]);
        let bound = 0.5 * (exact[12] + exact[13]) - load;
        for wanted in [Wanted::Below(bound), Wanted::Count(3), Wanted::Count(13)] {
            let pairs = lowest_eigenpairs(&buckled, &m, wanted, &()).unwrap();
            check(&m, &pairs);
            assert!(
                pairs.values.iter().zip(&exact).all(|(v, e)| within((v - (e - load)).abs(), 1e-12, RoundOff)),
                "{wanted:?}"
            );
        }
    }
}

#[test]
fn other_shifts_are_tried_where_the_matrix_is_singular_and_not_where_memory_is_short() {
    let tried = |error: fn() -> Error| {
        let count = std::cell::Cell::new(0);
        let refuse = |_: f64| -> Result<Option<()>> {
            count.set(count.get() + 1);
            Err(error())
        };
        let refused = off_eigenvalues([1.0, 2.0, 3.0], refuse).unwrap_err().to_string();
        (count.get(), refused)
    };
    let (count, refused) = tried(|| singular("row 3"));
    assert!(count == 3 && refused.contains("singular"), "{count}: {refused}");
    let (count, refused) = tried(|| Error::analysis("factorisation", "memory does not suffice", "Wait"));
    assert!(count == 1 && refused.contains("memory"), "{count}: {refused}");
    // One that sits on an eigenvalue is passed over.
    assert_eq!(off_eigenvalues([1.0, 2.0, 3.0], |s| Ok((s > 1.5).then_some(s))).unwrap(), (2.0, 2.0));
}

/// Springs of one to six masses that span any number of digits, zero and negative ones among them, in mixed coordinates: all are found,
/// those far above the others and those far below a bound, too.
#[test]
fn stiffnesses_of_any_span_have_all_their_eigenvalues() {
    let mut random = Random::seeded(14);
    for trial in 0..300 {
        let n = 1 + random.below(6);
        let span = [0.0, 8.0, 17.0][trial % 3];
        let mut own: Vec<f64> = (0..n)
            .map(|_| match random.below(8) {
                0 => 0.0,
                1 => -(10f64.powf(-random.between(0.0, span))),
                _ => 10f64.powf(-random.between(0.0, span)),
            })
            .collect();
        let unit = 10f64.powi(3 * random.below(5) as i32 - 6);
        own.iter_mut().for_each(|k| *k *= unit);
        let mix = Mat::from_fn(n, n, |i, j| 0.3 * random.next() + f64::from(i == j));
        let of = |value: &dyn Fn(usize) -> f64| {
            let diagonal = Mat::from_fn(n, n, |i, j| if i == j { value(i) } else { 0.0 });
            let turned = mix.transpose() * diagonal * &mix;
            samples::from_dense(Mat::from_fn(n, n, |i, j| turned[(i.max(j), i.min(j))]).as_ref())
        };
        let (k, m) = (of(&|i| own[i]), of(&|_| 1.0));
        own.sort_by(f64::total_cmp);
        let largest = own.iter().fold(0.0f64, |l, k| l.max(k.abs()));
        for wanted in [Wanted::Count(n), Wanted::Below(3.0 * largest.max(unit))] {
            let pairs =
                lowest_eigenpairs(&k, &m, wanted, &()).unwrap_or_else(|e| panic!("{trial}: {e} {own:?}"));
            assert_eq!(pairs.values.len(), n, "{trial} {wanted:?}: {own:?} {:?}", pairs.values);
            for (value, exact) in pairs.values.iter().zip(&own) {
                assert!(within((value - exact).abs(), 1e-11 * largest, RoundOff), "{trial}: {value} {exact}");
            }
        }
    }
}

/// Matrices of a few hundred rows in which an iteration finds no gap: one eigenvalue for all, or all below zero.
#[test]
fn equal_and_negative_eigenvalues_of_larger_matrices_are_found() {
    let n = 320;
    let (chain, m) = samples::free_chain(n);
    let scaled = |factor: f64, k: &SparseMatrix| add_scaled(&[(factor, k)]);
    for (k, lowest, count) in [
        (scaled(1e4, &samples::identity(n)), 1e4, 2),
        (scaled(-3.0, &samples::identity(n)), -3.0, 5),
        (scaled(-1.0, &chain), -4.0 * (PI * (n - 1) as f64 / (2 * n) as f64).sin().powi(2), 20),
        (scaled(0.0, &chain), 0.0, 4),
    ] {
        let pairs = lowest_eigenpairs(&k, &m, Wanted::Count(count), &()).unwrap();
        assert!(pairs.values.len() >= count && pairs.sturm.counted == [pairs.values.len(); 2]);
        let error = (pairs.values[0] - lowest).abs();
        assert!(within(error, 1e-11 * lowest.abs().max(1.0), RoundOff), "{} {lowest}", pairs.values[0]);
    }
}

/// A mass on a spring without mass, whose stiffness hides those of the others in rounding.
#[test]
fn soft_springs_beside_stiff_ones_have_their_eigenvalues() {
    let entries = [entry(0, 0, 3.3e8), entry(0, 1, -3.3e8), entry(1, 0, -3.3e8), entry(1, 1, 3.3e8)];
    let others = [entry(2, 2, 2.4e-3), entry(3, 3, 2.5e3)];
    let k = SparseMatrix::try_new_from_triplets(4, 4, &[&entries[..], &others].concat()).unwrap();
    let masses = [entry(1, 1, 8.0), entry(2, 2, 0.25), entry(3, 3, 0.5)];
    let m = SparseMatrix::try_new_from_triplets(4, 4, &masses).unwrap();
    for wanted in [Wanted::Count(3), Wanted::Below(1e4)] {
        let values = lowest_eigenpairs(&k, &m, wanted, &()).unwrap().values;
        for (value, exact) in values.iter().zip([0.0, 9.6e-3, 5e3]) {
            assert!(within((value - exact).abs(), 1e-6, RoundOff), "{values:?}");
        }
        assert_eq!(values.len(), 3);
    }
}
