//! Damping matrices taken apart: α M + β K, which leaves the real modes uncoupled, and the rest.

use crate::linalg::SparseMatrix;
use crate::linalg::sparse::add_scaled;
use faer::sparse::Triplet;

/// X = α M + β K + rest.
#[derive(Debug)]
pub(super) struct Proportional {
    /// α \[1/s for C, 1/s² for H\], not negative.
    pub(super) mass_factor: f64,
    /// β \[s for C, 1 for H\], not negative.
    pub(super) stiffness_factor: f64,
    /// What is left; `None` when nothing is.
    pub(super) rest: Option<SparseMatrix>,
}

/// An entry of the rest below this part of its terms is their round-off.
const ROUND_OFF: f64 = 1e-10;

impl Proportional {
    /// Splits a symmetric `x`. The factors are those that fit most of the entries exactly (least sum of magnitudes, by
    /// reweighted least squares), so that a few dashpots on top of Rayleigh damping are told apart from it. Where no
    /// factors fit at least half of the entries, all of `x` is rest.
    pub(super) fn split(x: &SparseMatrix, mass: &SparseMatrix, stiffness: &SparseMatrix) -> Self {
        // The three matrices on their common pattern.
        let on_union = |a, b, c| add_scaled(&[(a, x), (b, mass), (c, stiffness)]);
        let (xs, ms, ks) = (on_union(1.0, 0.0, 0.0), on_union(0.0, 1.0, 0.0), on_union(0.0, 0.0, 1.0));
        let largest = |a: &SparseMatrix| a.val().iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
        let (m_size, k_size) = (largest(&ms), largest(&ks));
        let rows: Vec<[f64; 3]> = (0..xs.val().len())
            .map(|i| (ms.val()[i] / m_size, ks.val()[i] / k_size, xs.val()[i]))
            .filter(|(m, k, _)| *m != 0.0 || *k != 0.0)
            .map(|(m, k, x)| {
                let size = m.abs() + k.abs();
                [m / size, k / size, x / size]
            })
            .collect();
        let fit = fit(&rows);
        let (alpha, beta) = (fit[0] / m_size, fit[1] / k_size);
        let left = |i: usize| {
            let (a, b, c) = (alpha * ms.val()[i], beta * ks.val()[i], xs.val()[i]);
            let rest = c - a - b;
            if rest.abs() <= ROUND_OFF * (a.abs() + b.abs() + c.abs()) { 0.0 } else { rest }
        };
        let mut rest = Vec::new();
        for j in 0..xs.ncols() {
            for p in xs.col_ptr()[j]..xs.col_ptr()[j + 1] {
                let value = left(p);
                if value != 0.0 {
                    rest.push(Triplet::new(xs.row_idx()[p], j, value));
                }
            }
        }
        if alpha < 0.0 || beta < 0.0 || 2 * rest.len() > x.val().len() {
            return Proportional { mass_factor: 0.0, stiffness_factor: 0.0, rest: Some(x.clone()) };
        }
        let n = x.ncols();
        let rest = (!rest.is_empty())
            .then(|| SparseMatrix::try_new_from_triplets(n, n, &rest).expect("indices of the pattern"));
        Proportional { mass_factor: alpha, stiffness_factor: beta, rest }
    }
}

/// Rounds of the fit, of which only the last few look at all rows where those are many more than a sample.
const ROUNDS: usize = 40;
const LAST: usize = 4;
const SAMPLE: usize = 50_000;

/// (a, b) with Σ |x − a m − b k| least over the rows (m, k, x); factors that are round-off of the fit are zero.
fn fit(rows: &[[f64; 3]]) -> [f64; 2] {
    let size = rows.iter().fold(0.0f64, |s, r| s.max(r[2].abs()));
    let mut factors = [0.0; 2];
    if size == 0.0 {
        return factors;
    }
    let residual = |f: &[f64; 2], r: &[f64; 3]| (r[2] - f[0] * r[0] - f[1] * r[1]).abs();
    // An odd step, so that the sample does not fall in with the degrees of freedom of a node.
    let step = (rows.len() / SAMPLE) | 1;
    let mut floor = size;
    for round in 0..ROUNDS {
        let (mut g, mut h) = ([0.0; 3], [0.0; 2]);
        for r in rows.iter().step_by(if round < ROUNDS - LAST { step } else { 1 }) {
            // The residual's inverse as weight turns squares into magnitudes; the floor falls with the rounds.
            let weight = if round == 0 { 1.0 } else { floor / (residual(&factors, r) + floor) };
            g[0] += weight * r[0] * r[0];
            g[1] += weight * r[0] * r[1];
            g[2] += weight * r[1] * r[1];
            h[0] += weight * r[0] * r[2];
            h[1] += weight * r[1] * r[2];
        }
        let determinant = g[0] * g[2] - g[1] * g[1];
        factors = if determinant > 1e-14 * g[0] * g[2] {
            [(g[2] * h[0] - g[1] * h[1]) / determinant, (g[0] * h[1] - g[1] * h[0]) / determinant]
        } else if g[2] >= g[0] {
            [0.0, h[1] / g[2]]
        } else {
            [h[0] / g[0], 0.0]
        };
        floor = (0.3 * floor).max(1e-13 * size);
    }
    factors.map(|f| if f.abs() <= 1e-11 * size { 0.0 } else { f })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::samples;

    #[test]
    fn rayleigh_damping_is_recognised_below_a_few_dashpots() {
        let (k, m) = samples::plate(6, true);
        let rayleigh = add_scaled(&[(3.0, &m), (2e-6, &k)]);
        let split = Proportional::split(&rayleigh, &m, &k);
        assert!(split.rest.is_none() && (split.mass_factor - 3.0).abs() < 1e-8);
        assert!((split.stiffness_factor - 2e-6).abs() < 1e-15);
        let n = k.ncols();
        let ground = samples::from_dense(
            faer::Mat::from_fn(n, n, |i, j| if i == j && i % 25 == 0 { 7.0 } else { 0.0 }).as_ref(),
        );
        let split = Proportional::split(&add_scaled(&[(1.0, &rayleigh), (1.0, &ground)]), &m, &k);
        assert!((split.mass_factor - 3.0).abs() < 1e-7, "{}", split.mass_factor);
        let rest = split.rest.unwrap().to_dense();
        assert!((rest - ground.to_dense()).norm_max() < 1e-6);
    }

    #[test]
    fn one_of_the_two_factors_and_none() {
        let (k, m) = samples::plate(5, true);
        let lossy = add_scaled(&[(0.01, &k)]);
        let split = Proportional::split(&lossy, &m, &k);
        assert!(split.rest.is_none() && split.mass_factor == 0.0);
        assert!((split.stiffness_factor - 0.01).abs() < 1e-14);
        let other = samples::random_definite(k.ncols(), 4);
        let split = Proportional::split(&other, &m, &k);
        assert!(split.mass_factor == 0.0 && split.stiffness_factor == 0.0 && split.rest.is_some());
        let negative = add_scaled(&[(-0.5, &m)]);
        assert!(Proportional::split(&negative, &m, &k).rest.is_some());
    }
}
