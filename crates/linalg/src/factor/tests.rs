use super::super::samples;
use super::super::sparse::add_scaled;
use super::*;
use stridor_base::bounds::{Origin::*, within};

#[test]
fn inertia_equals_the_signs_of_the_eigenvalues() {
    for (n, seed) in [(1, 1), (2, 2), (5, 3), (30, 4), (90, 5)] {
        let a = samples::random_symmetric(n, seed);
        let (values, _) = super::super::dense::symmetric_eigen(a.to_dense().as_ref()).unwrap();
        let negative = values.iter().filter(|v| **v < 0.0).count();
        let factor = factorize(&a).unwrap();
        assert_eq!(factor.inertia(), Inertia { negative, zero: 0, positive: n - negative });
        assert_eq!(factor.symbolic().inertia(&a).unwrap(), factor.inertia());
        assert!(factor.n() == n && factor.memory_bytes() >= 8 * n);
    }
    // Only 2 × 2 pivots can do this one.
    let swap = samples::from_dense(faer::mat![[0.0, 1.0], [1.0, 0.0]].as_ref());
    assert_eq!(factorize(&swap).unwrap().inertia(), Inertia { negative: 1, zero: 0, positive: 1 });
}

#[test]
fn an_indefinite_plate_is_solved_backward_stably() {
    let (k, m) = samples::plate(24, false);
    for hz in [500.0, 3000.0, 9000.0f64] {
        let a = add_scaled(&[(1.0, &k), (-(std::f64::consts::TAU * hz).powi(2), &m)]);
        let factor = factorize(&a).unwrap();
        for columns in [1, 3, 16] {
            let mut x = Mat::from_fn(a.ncols(), columns, |i, j| ((i * i + 7 * j) as f64).sin());
            assert!(within(solve_refined(&a, &*factor, x.as_mut()), 1e-16, RoundOff));
        }
    }
}

#[test]
fn two_halves_are_a_solution_and_measure_without_the_second() {
    let (k, m) = samples::plate(24, false);
    let a = add_scaled(&[(1.0, &k), (-(std::f64::consts::TAU * 5000.0).powi(2), &m)]);
    let factor = factorize(&a).unwrap();
    assert!(factor.inertia().negative > 0);
    let n = a.ncols();
    let b: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).sin()).collect();
    let mut c = vec![0.0; n];
    c[n / 3] = 1.0;
    let half = |b: &[f64]| {
        let mut y = vec![0.0; n];
        factor.forward(b, &mut y);
        y
    };
    let mut whole = Mat::from_fn(n, 1, |i, _| b[i]);
    factor.solve_in_place(whole.as_mut());
    let (mut y, few, mut x) = (half(&b), half(&c), vec![0.0; n]);
    assert!(few.iter().filter(|value| **value != 0.0).count() < n / 2);
    let mut measured = few.clone();
    factor.pivots(&mut measured);
    let seen: f64 = measured.iter().zip(&y).map(|(a, b)| a * b).sum();
    assert!(within((seen - whole[(n / 3, 0)]).abs(), 1e-10 * whole.norm_max(), RoundOff));
    factor.backward(&mut y, &mut x);
    assert_eq!(x, whole.col_as_slice(0));
}

#[test]
fn metres_and_radians_may_differ_by_many_orders() {
    let mut a = samples::random_definite(20, 9).to_dense();
    let size = |i: usize| if i.is_multiple_of(2) { 1e9 } else { 1e-9 };
    a = Mat::from_fn(20, 20, |i, j| a[(i, j)] * size(i) * size(j));
    let factor = factorize(&samples::from_dense(a.as_ref())).unwrap();
    assert_eq!(factor.inertia(), Inertia { negative: 0, zero: 0, positive: 20 });
}

#[test]
fn singular_and_non_finite_matrices_are_refused() {
    let zero = samples::from_dense(faer::mat![[1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 2.0]].as_ref());
    assert!(factorize(&zero).unwrap_err().to_string().contains("row 1"));
    let nan = samples::from_dense(faer::mat![[1.0, f64::NAN], [f64::NAN, 1.0]].as_ref());
    assert!(factorize(&nan).unwrap_err().to_string().contains("NaN"));
    let (free, _) = samples::free_chain(6);
    match factorize(&free) {
        Ok(factor) => assert_eq!(factor.inertia(), Inertia { negative: 0, zero: 1, positive: 5 }),
        Err(error) => assert!(error.to_string().contains("singular")),
    }
}

#[test]
fn a_pattern_is_analysed_once() {
    let (k, m) = samples::plate(6, false);
    let sum = |s: f64| add_scaled(&[(1.0, &k), (-s, &m)]);
    let symbolic = SymbolicFactor::new(k.symbolic()).unwrap();
    let (low, high) = (symbolic.factorize(&sum(-1e4)).unwrap(), symbolic.factorize(&sum(1e9)).unwrap());
    assert!(low.inertia().negative == 0 && high.inertia().negative > 3);
}
