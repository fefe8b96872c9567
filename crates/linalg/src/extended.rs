//! Linear systems solved with twice the digits: references of the tests.

use faer::linalg::solvers::Solve;
use faer::{Mat, fx128};

/// The solution of A x = b for these very numbers, and by how much it moves when each entry of A and b is rounded,
/// ε |A⁻¹| (|A| |x| + |b|) (Skeel, J. ACM 26 (1979) 494): no method with numbers of 16 digits can be expected to do better.
///
/// Iterative refinement, with residuals of 32 digits.
pub fn solve(a: &Mat<f64>, b: &[f64]) -> (Vec<f64>, Vec<f64>) {
    const STEPS: usize = 8;
    let n = b.len();
    let factors = a.partial_piv_lu();
    let mut x = vec![fx128::from(0.0); n];
    for _ in 0..STEPS {
        let residual = Mat::from_fn(n, 1, |i, _| {
            let product = (0..n).fold(fx128::from(0.0), |sum, j| sum + fx128::from(a[(i, j)]) * x[j]);
            (fx128::from(b[i]) - product).0
        });
        let step = factors.solve(&residual);
        x.iter_mut().enumerate().for_each(|(i, x)| *x += fx128::from(step[(i, 0)]));
    }
    let x: Vec<f64> = x.iter().map(|x| x.0).collect();
    let inverse = factors.solve(&Mat::<f64>::identity(n, n));
    let rounded: Vec<f64> = (0..n)
        .map(|i| f64::EPSILON * (b[i].abs() + (0..n).map(|j| (a[(i, j)] * x[j]).abs()).sum::<f64>()))
        .collect();
    let moved = (0..n).map(|i| (0..n).map(|j| inverse[(i, j)].abs() * rounded[j]).sum()).collect();
    (x, moved)
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    /// A Hilbert matrix of ten rows, κ = 2e13, times whole numbers so that its entries are exact.
    #[test]
    fn an_ill_conditioned_system_is_solved_to_the_last_digit() {
        let multiple = 232_792_560.0;
        let a = Mat::from_fn(10, 10, |i, j| multiple / (i + j + 1) as f64);
        let exact: Vec<f64> = (0..10).map(|i| f64::from(i % 3) - 1.0).collect();
        let b: Vec<f64> = (0..10).map(|i| (0..10).map(|j| a[(i, j)] * exact[j]).sum()).collect();
        let (x, moved) = solve(&a, &b);
        assert!(
            x.iter().zip(&exact).all(|(x, exact)| within((x - exact).abs(), 4.0 * f64::EPSILON, RoundOff)),
            "{x:?}"
        );
        assert!(moved.iter().any(|moved| *moved > 1e-5));
    }
}
