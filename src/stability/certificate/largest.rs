//! Upper bounds of the largest eigenvalues of positive semidefinite matrices of which only products are known.
//!
//! Lanczos' method from a vector b gives θ ≤ λ₁, and θ is at least the Rayleigh quotient of p(S)b for every polynomial p of degree
//! below k. With θ < (1 − ε)λ₁, the Chebyshev polynomial of \[0, (1 − ε)λ₁\] gives
//!
//! ε T² b₁² < (1 − ε) ‖b‖², T = T_{k−1}((1 + ε)/(1 − ε)),
//!
//! b₁ the component of b along the first eigenvector (J. Kuczyński & H. Woźniakowski, SIAM J. Matrix Anal. Appl. 13 (1992) 1094, have
//! the like). For normally distributed b in r dimensions that has a probability of √(2r/π) √((1 − ε)/ε) / T at most: ε is chosen so that
//! this is [`RISK`], and λ₁ ≤ θ/(1 − ε) but for that.

use crate::error::Result;
use crate::linalg::dense::symmetric_eigen;
use crate::linalg::random::Random;
use crate::linalg::sparse::dot;
use faer::Mat;
use std::f64::consts::{PI, TAU};

/// Probability that a bound is too low.
const RISK: f64 = 1e-12;
/// Steps at most: λ₁ is then 1.56 θ at most for a thousand dimensions.
const STEPS: usize = 24;
/// What is left of a vector that lies in the span of others.
const NOTHING: f64 = 1e-13;

/// Vectors of a Krylov space with what the matrix is between them.
struct Krylov {
    basis: Vec<Vec<f64>>,
    diagonal: Vec<f64>,
    coupling: Vec<f64>,
    /// No further vector: the space is invariant.
    whole: bool,
}

/// Upper bounds of the largest eigenvalues of several positive semidefinite matrices of the orders `orders`; `products` gives the
/// products of all of them with a vector each, which is empty where none is needed.
pub(super) fn largest_eigenvalues(
    orders: &[usize],
    mut products: impl FnMut(&[Vec<f64>]) -> Vec<Vec<f64>>,
) -> Result<Vec<f64>> {
    let mut random = Random::new();
    let mut spaces: Vec<Krylov> = orders
        .iter()
        .map(|r| {
            let mut start: Vec<f64> = (0..*r).map(|_| normal(&mut random)).collect();
            let length = dot(&start, &start).sqrt();
            start.iter_mut().for_each(|x| *x /= length);
            Krylov { basis: vec![start], diagonal: Vec::new(), coupling: Vec::new(), whole: *r == 0 }
        })
        .collect();
    for step in 0..STEPS {
        let last = |space: &Krylov| if space.whole { Vec::new() } else { space.basis[step].clone() };
        let vectors: Vec<Vec<f64>> = spaces.iter().map(last).collect();
        if vectors.iter().all(Vec::is_empty) {
            break;
        }
        for (space, product) in spaces.iter_mut().zip(products(&vectors)).filter(|(space, _)| !space.whole) {
            space.extend(product);
        }
    }
    spaces.iter().zip(orders).map(|(space, r)| space.bound(*r)).collect()
}

impl Krylov {
    fn extend(&mut self, mut product: Vec<f64>) {
        let size = dot(&product, &product).sqrt();
        self.diagonal.push(dot(&product, &self.basis[self.basis.len() - 1]));
        for _ in 0..2 {
            for v in &self.basis {
                let share = dot(v, &product);
                product.iter_mut().zip(v).for_each(|(x, v)| *x -= share * v);
            }
        }
        let rest = dot(&product, &product).sqrt();
        self.whole = self.basis.len() == product.len() || rest <= NOTHING * size;
        if !self.whole {
            product.iter_mut().for_each(|x| *x /= rest);
            self.coupling.push(rest);
            self.basis.push(product);
        }
    }

    fn bound(&self, r: usize) -> Result<f64> {
        let k = self.diagonal.len();
        let tridiagonal = Mat::from_fn(k, k, |i, j| match i.abs_diff(j) {
            0 => self.diagonal[i],
            1 => self.coupling[i.min(j)],
            _ => 0.0,
        });
        let (values, _) = symmetric_eigen(tridiagonal.as_ref())?;
        let theta = values.last().copied().unwrap_or(0.0);
        Ok(if self.whole { theta } else { theta / (1.0 - shortfall(k, r)) })
    }
}

/// The least ε with √(2r/π) √((1 − ε)/ε) / T ≤ [`RISK`], by halving an interval.
fn shortfall(steps: usize, r: usize) -> f64 {
    let fails = |epsilon: f64| {
        // T_{k−1}((1 + ε)/(1 − ε)) ≥ ½ ((1 + √ε)/(1 − √ε))^(k−1).
        let root = epsilon.sqrt();
        let t = 0.5 * ((1.0 + root) / (1.0 - root)).powi(steps as i32 - 1);
        (2.0 * r as f64 / PI).sqrt() * ((1.0 - epsilon) / epsilon).sqrt() > RISK * t
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if fails(middle) { low = middle } else { high = middle }
    }
    high
}

/// A normally distributed number, by the method of Box and Muller.
fn normal(random: &mut Random) -> f64 {
    let [u, v] = [random.next(), random.next()].map(|x| 0.5 * (x + 1.0));
    (-2.0 * (1.0 - u).ln()).sqrt() * (TAU * v).cos()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    /// Diagonal matrices with a cluster at the top, of any order beside the number of steps, none and zero among them.
    #[test]
    fn bounds_lie_above_the_largest_eigenvalues_and_near_them() {
        let orders = [0, 1, 5, STEPS, 40, 2000];
        let value = |r: usize, i: usize| if r == 5 { 0.0 } else { 3.0 - 2.0 * (i as f64 / r as f64).powi(2) };
        let bounds = largest_eigenvalues(&orders, |vectors| {
            let product = |v: &Vec<f64>| (0..v.len()).map(|i| value(v.len(), i) * v[i]).collect();
            vectors.iter().map(product).collect()
        })
        .unwrap();
        assert_eq!((bounds[0], bounds[2]), (0.0, 0.0));
        for (bound, r) in bounds.iter().zip(orders).filter(|(_, r)| *r != 0 && *r != 5) {
            let most = if r <= STEPS { 1.0 + 1e-10 } else { 1.0 / (1.0 - shortfall(STEPS, r)) };
            let ratio = bound / 3.0;
            assert!(ratio > 1.0 - 1e-12 && within(ratio, most * (1.0 + 1e-12), Stated), "{r}: {ratio}");
        }
    }
}
