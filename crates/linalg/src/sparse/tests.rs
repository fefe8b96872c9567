use super::super::c64;
use super::super::samples;
use super::*;
use faer::Mat;
use stridor_base::bounds::{Origin::*, within};

#[test]
fn products_equal_the_dense_ones() {
    let a = samples::random_symmetric(57, 3);
    for k in [1, 2, 3, 4, 5, 11] {
        let x = Mat::from_fn(57, k, |i, j| ((i * 7 + j * 3) as f64).sin());
        let mut y = Mat::zeros(57, k);
        multiply(&a, x.as_ref(), y.as_mut());
        assert!(within((a.to_dense() * &x - &y).norm_max(), 1e-13, RoundOff));
        let xc = Mat::from_fn(57, k, |i, j| c64::new(x[(i, j)], -2.0 * x[(i, j)]));
        let mut yc = Mat::zeros(57, k);
        multiply(&a, xc.as_ref(), yc.as_mut());
        let error = (0..k).flat_map(|j| (0..57).map(move |i| (i, j)));
        assert!(within(
            error.map(|p| (yc[p] - c64::new(y[p], -2.0 * y[p])).norm()).fold(0.0, f64::max),
            1e-13,
            RoundOff
        ));
    }
}

#[test]
fn vectors_with_and_without_gaps_multiply_and_add_alike() {
    let dense: Vec<f64> = (0..40).map(|i| (i as f64 * 0.7).sin()).collect();
    for step in [1, 2] {
        let entries: Vec<(usize, f64)> = (5..36).step_by(step).map(|i| (i, (i as f64 * 1.3).cos())).collect();
        let vector = SparseVector::from_entries(entries.iter().copied());
        let expected: f64 = entries.iter().map(|(i, v)| v * dense[*i]).sum();
        assert!(within((vector.dot(&dense) - expected).abs(), 1e-14, RoundOff));
        let mut sum = dense.clone();
        vector.add_to(2.0, &mut sum);
        entries.iter().for_each(|(i, v)| sum[*i] -= 2.0 * v);
        // Two roundings of numbers up to 3, times ten.
        assert!(sum.iter().zip(&dense).all(|(a, b)| within(
            (a - b).abs(),
            10.0 * 6.0 * f64::EPSILON,
            RoundOff
        )));
        let mut own = vec![0.0; 40];
        vector.add_to(1.0, &mut own);
        assert_eq!(SparseVector::from_dense(&own), vector);
    }
    assert_eq!(SparseVector::default().dot(&dense), 0.0);
}

#[test]
fn sums_live_on_the_union_pattern() {
    let (a, b) = (samples::random_symmetric(40, 1), samples::random_symmetric(40, 2));
    let sum = add_scaled(&[(2.0, &a), (-0.5, &b)]);
    let expected = a.to_dense() * faer::Scale(2.0) - b.to_dense() * faer::Scale(0.5);
    assert!(within((sum.to_dense() - expected).norm_max(), 1e-14, RoundOff));
    let same = add_scaled(&[(2.0, &a), (-1.0, &a)]);
    assert_eq!(same.val(), a.val());
}

#[test]
fn matrices_share_a_pattern_where_that_adds_little() {
    let (stiffness, mass) = samples::plate(6, false);
    let n = stiffness.ncols();
    let spring = sum_of_squares(n, [(3.0, &SparseVector::from_entries([(0, 1.0), (n - 1, -1.0)]))]);
    let given = [mass, add_scaled(&[(1.0, &stiffness), (1.0, &spring)])];
    assert!(given[0].compute_nnz() < given[1].compute_nnz());
    let [first, second] = given.clone();
    let shared = on_one_pattern(first, second);
    assert!(shared[0].row_idx() == shared[1].row_idx() && shared[0].col_ptr() == shared[1].col_ptr());
    assert!(shared.iter().zip(&given).all(|(a, b)| a.to_dense() == b.to_dense()));
    let lumped = diagonal_matrix(&vec![1.0; n]);
    assert_eq!(on_one_pattern(lumped, stiffness)[0].compute_nnz(), n);
}

#[test]
fn quadratic_forms_equal_products() {
    // More rows than are formed together, more columns than a panel has.
    let a = samples::random_symmetric(700, 3);
    let x = Mat::from_fn(700, 11, |i, j| ((i * 7 + j * 3) as f64).sin());
    let expected = x.transpose() * times(&a, x.as_ref());
    let forms = quadratic_forms(&a, x.as_ref());
    let near = |j: usize| within((forms[j] - expected[(j, j)]).abs(), 1e-12 * expected.norm_max(), RoundOff);
    assert!(forms.len() == 11 && (0..11).all(near));
    assert!(quadratic_forms(&a, x.subcols(0, 0)).is_empty());
}

#[test]
fn norm_and_diagonal() {
    let a = samples::random_symmetric(30, 5);
    let dense = a.to_dense();
    let expected = (0..30).map(|j| dense.col(j).norm_l1()).fold(0.0, f64::max);
    assert!(within((norm_1(&a) - expected).abs(), 1e-14 * expected, RoundOff));
    assert!(diagonal(&a).iter().enumerate().all(|(i, d)| *d == dense[(i, i)]));
}

#[test]
fn products_do_not_depend_on_the_number_of_threads() {
    let a = samples::membrane(100).0;
    let x: Vec<f64> = (0..a.nrows()).map(|i| (i as f64).sin()).collect();
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| multiply_vector(&a, &x))
    };
    assert_eq!(with(1), with(3));
}
