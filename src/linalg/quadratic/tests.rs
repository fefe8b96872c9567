use super::super::samples;
use super::*;

fn check(m: &Mat<f64>, c: &Mat<f64>, k: &Mat<c64>, pairs: &[QuadraticPair], tolerance: f64) {
    let problem = Problem::new(m.as_ref(), c.as_ref(), k.clone()).unwrap();
    assert_eq!(pairs.len(), 2 * m.nrows());
    for pair in pairs {
        let x = Mat::from_fn(m.nrows(), 1, |i, _| pair.right[i]);
        let psi = Mat::from_fn(m.nrows(), 1, |i, _| pair.left[i]);
        let q = problem.q(pair.lambda);
        let size = pair.lambda.norm_sqr() * m.norm_l2() + pair.lambda.norm() * c.norm_l2() + k.norm_l2();
        assert!((&q * &x).norm_l2() < tolerance * size * x.norm_l2(), "right {}", pair.lambda);
        assert!((psi.adjoint() * &q).norm_l2() < tolerance * size * psi.norm_l2(), "left {}", pair.lambda);
        for v in [&x, &psi] {
            assert!((dot(v, &(&problem.m * v)) - 1.0).norm() < 1e-12);
        }
        assert!(pair.backward_error < tolerance);
    }
    assert!(pairs.windows(2).all(|p| p[0].lambda.im <= p[1].lambda.im));
}

fn unsymmetric(n: usize, seed: u64) -> Mat<f64> {
    let mut random = samples::Random::new(seed);
    Mat::from_fn(n, n, |_, _| random.next())
}

#[test]
fn random_problems_satisfy_both_equations() {
    for n in [1, 2, 3, 10, 40, 90] {
        let m = samples::random_definite(n, 1).to_dense();
        let (c, k) = (unsymmetric(n, 2), unsymmetric(n, 3));
        let pairs = solve_qep(m.as_ref(), c.as_ref(), k.as_ref()).unwrap();
        check(&m, &c, &complex(k.as_ref()), &pairs, 1e-13);
        // λ and λ̄ come together; the sum of all is −trace(M⁻¹C).
        let sum: c64 = pairs.iter().map(|p| p.lambda).sum();
        use faer::prelude::*;
        let trace: f64 = {
            let t = m.partial_piv_lu().solve(&c);
            (0..n).map(|i| t[(i, i)]).sum()
        };
        let size: f64 = pairs.iter().map(|p| p.lambda.norm()).sum();
        assert!((sum + trace).norm() < 1e-11 * size, "{sum} {trace}");
        let lossy = Mat::from_fn(n, n, |i, j| k[(i, j)] * c64::new(1.0, 0.02 * (1 + i) as f64));
        let pairs = solve_qep_complex(m.as_ref(), c.as_ref(), lossy.as_ref()).unwrap();
        check(&m, &c, &lossy, &pairs, 1e-13);
    }
}

#[test]
fn widely_spread_oscillators_are_exact() {
    // ω from 1e-2 to 1e8 rad/s, 1 % damping, hidden behind a rotation of neighbours.
    let n = 11;
    let omega = |i: usize| 10f64.powi(i as i32 - 2);
    let m = Mat::<f64>::identity(n, n);
    let c = Mat::from_fn(n, n, |i, j| if i == j { 0.02 * omega(i) } else { 0.0 });
    let k = Mat::from_fn(n, n, |i, j| if i == j { omega(i).powi(2) } else { 0.0 });
    let pairs = solve_qep(m.as_ref(), c.as_ref(), k.as_ref()).unwrap();
    for (i, pair) in pairs[n..].iter().enumerate() {
        let exact = c64::new(-0.01, (1.0 - 1e-4f64).sqrt()) * omega(i);
        assert!((pair.lambda - exact).norm() < 1e-14 * omega(i), "{} {exact}", pair.lambda);
    }
}

#[test]
fn two_degrees_of_freedom_with_friction_flutter_where_the_closed_form_says() {
    // K = [[k₁ + k₂/2 + k_t, −k₂/2 + μ k_n], [−k₂/2, k₂/2 + k_n]], M = I, C = 0: flutter above μ = 0.625.
    let k = |mu: f64| faer::mat![[2.0, -0.5 + mu], [-0.5, 1.5]];
    let (m, c) = (Mat::<f64>::identity(2, 2), Mat::<f64>::zeros(2, 2));
    let growth = |mu: f64| {
        let pairs = solve_qep(m.as_ref(), c.as_ref(), k(mu).as_ref()).unwrap();
        pairs.iter().map(|p| p.lambda.re).fold(0.0, f64::max)
    };
    assert!(growth(0.625 - 1e-9) < 1e-10 && growth(0.625 + 1e-9) > 1e-6);
    // λ² = −7/4 ± √(1/16 − (μ − 1/2)/2) at μ = 0.7.
    let exact = (c64::new(-1.75, 0.0) + c64::new(0.0, (0.1f64 - 0.0625).sqrt())).sqrt();
    assert!((growth(0.7) - exact.re).abs() < 1e-14);
}

#[test]
fn coalesced_and_zero_eigenvalues_are_accepted() {
    // A Jordan block at the flutter point, and a free mass.
    let m = Mat::<f64>::identity(2, 2);
    let c = Mat::<f64>::zeros(2, 2);
    let jordan = faer::mat![[2.0, 0.125], [-0.5, 1.5]];
    let pairs = solve_qep(m.as_ref(), c.as_ref(), jordan.as_ref()).unwrap();
    assert!(pairs.iter().all(|p| (p.lambda * p.lambda + 1.75).norm() < 1e-7 && p.backward_error < 1e-14));
    let free = solve_qep(m.as_ref(), c.as_ref(), c.as_ref()).unwrap();
    assert!(free.iter().all(|p| p.lambda.norm() < 1e-150));
}

#[test]
fn what_is_not_a_problem_is_refused() {
    let m = faer::mat![[1.0, 0.0], [0.0, -1.0]];
    let z = Mat::<f64>::zeros(2, 2);
    assert!(solve_qep(m.as_ref(), z.as_ref(), z.as_ref()).is_err());
    let nan = faer::mat![[f64::NAN, 0.0], [0.0, 1.0]];
    assert!(solve_qep(Mat::<f64>::identity(2, 2).as_ref(), z.as_ref(), nan.as_ref()).is_err());
    let empty = Mat::<f64>::zeros(0, 0);
    assert!(solve_qep(empty.as_ref(), empty.as_ref(), empty.as_ref()).unwrap().is_empty());
}

#[test]
#[ignore = "a measurement: cargo test --release --lib quadratic::tests::timing -- --ignored --nocapture"]
fn timing() {
    for n in [150, 300, 600] {
        let k = Mat::from_fn(n, n, |i, j| if i == j { (i as f64 * 100.0 + 1.0).powi(2) } else { 0.0 })
            + unsymmetric(n, 3) * faer::Scale(1e4);
        let c = unsymmetric(n, 4);
        let m = Mat::<f64>::identity(n, n);
        let start = std::time::Instant::now();
        let pairs = solve_qep(m.as_ref(), c.as_ref(), k.as_ref()).unwrap();
        let worst = pairs.iter().map(|p| p.backward_error).fold(0.0, f64::max);
        println!("n = {n}: {:.2} s, backward error {worst:.1e}", start.elapsed().as_secs_f64());
    }
}
