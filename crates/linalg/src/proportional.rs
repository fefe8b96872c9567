//! Damping matrices taken apart: α M + β K, which leaves the real modes uncoupled, and the rest.

use super::SparseMatrix;
use super::shared_pattern::SharedPattern;
use super::sparse::entry;

/// X = α M + β K + rest.
#[derive(Debug, Clone, Default)]
pub struct Proportional {
    /// α \[1/s for C, 1/s² for H\], not negative.
    pub mass_factor: f64,
    /// β \[s for C, 1 for H\], not negative.
    pub stiffness_factor: f64,
    /// Remainder; `None` when it is zero.
    pub rest: Option<SparseMatrix>,
}

/// An entry of the rest below this part of its terms is their round-off.
const ROUND_OFF: f64 = 1e-13;
/// Entries that are looked at first where there are many more.
const SAMPLE: usize = 10_000;
/// Rounds of the fit to the sample, and to all entries.
const ROUNDS: i32 = 36;
const LAST: usize = 2;

impl Proportional {
    /// Splits a symmetric `x`. The factors are those that fit most of the entries exactly (least sum of magnitudes, by
    /// reweighted least squares), so that a few dashpots on top of Rayleigh damping are separated from it. Where no
    /// factors fit at least half of the entries, all of `x` is rest.
    pub fn split(x: &SparseMatrix, mass: &SparseMatrix, stiffness: &SparseMatrix) -> Self {
        let merged = SharedPattern::new(&[mass, stiffness, x]);
        let entries = merged.entries::<3>();
        let largest = |a: &SparseMatrix| a.val().iter().fold(f64::MIN_POSITIVE, |l, v| l.max(v.abs()));
        let [m_size, k_size] = [mass, stiffness].map(largest);
        let (m_inverse, k_inverse) = (m_size.recip(), k_size.recip());
        // Entries where M or K have one, those of M and K of about the size of one.
        let row = |[m, k, x]: [f64; 3]| {
            let (m, k) = (m * m_inverse, k * k_inverse);
            let size = m.abs() + k.abs();
            let inverse = size.recip();
            (size >= f64::MIN_POSITIVE).then_some([m * inverse, k * inverse, x * inverse])
        };
        // An odd step, so that the sample does not fall in with the degrees of freedom of a node.
        let step = (entries.len() / SAMPLE) | 1;
        let sample: Vec<[f64; 3]> = entries.clone().step_by(step).filter_map(row).collect();
        let mut fit = Fit::new(sample.iter().fold(0.0, |s, row| row[2].abs().max(s)));
        for round in 0..ROUNDS {
            // The residual's inverse as weight turns squares into magnitudes; what counts as none falls with the rounds.
            let floor = 0.3f64.powi(round).max(1e-12) * fit.size;
            let weight = |left: f64| if round == 0 { 1.0 } else { floor / (left.abs() + floor) };
            fit.improve(sample.iter().copied(), weight);
        }
        // Then all entries that fit, alike.
        let near = 1e-9 * fit.size;
        let weight = |left: f64| if left.abs() <= near { 1.0 } else { 0.0 };
        (0..LAST).for_each(|_| fit.improve(entries.clone().filter_map(row), weight));
        let [alpha, beta] = fit.factors();
        let (alpha, beta) = (alpha / m_size, beta / k_size);
        let mut rest = Vec::new();
        for (i, j, [m, k, x]) in merged.places::<3>() {
            let (a, b) = (alpha * m, beta * k);
            let left = x - a - b;
            if left.abs() > ROUND_OFF * (a.abs() + b.abs() + x.abs()) {
                rest.push(entry(i, j, left));
            }
        }
        if alpha < 0.0 || beta < 0.0 || 2 * rest.len() > x.val().len() {
            return Proportional { rest: Some(x.clone()), ..Proportional::default() };
        }
        let n = x.ncols();
        let rest = (!rest.is_empty())
            .then(|| SparseMatrix::try_new_from_triplets(n, n, &rest).expect("indices of the pattern"));
        Proportional { mass_factor: alpha, stiffness_factor: beta, rest }
    }
}

/// (a, b) with Σ weight (x − a m − b k)² least over the rows (m, k, x), from round to round.
struct Fit {
    factors: [f64; 2],
    /// The largest |x| of the sample.
    size: f64,
}

impl Fit {
    fn new(size: f64) -> Self {
        Fit { factors: [0.0; 2], size }
    }

    /// Adds to the factors those that fit what they leave, so that their digits are not lost in the sums; `weight` is that
    /// of a row which leaves so much.
    fn improve(&mut self, rows: impl Iterator<Item = [f64; 3]>, weight: impl Fn(f64) -> f64) {
        let (mut g, mut h) = ([0.0; 3], [0.0; 2]);
        for [m, k, x] in rows {
            let left = x - self.factors[0] * m - self.factors[1] * k;
            let weight = weight(left);
            g[0] += weight * m * m;
            g[1] += weight * m * k;
            g[2] += weight * k * k;
            h[0] += weight * m * left;
            h[1] += weight * k * left;
        }
        let determinant = g[0] * g[2] - g[1] * g[1];
        let change = if g[0] + g[2] == 0.0 || self.size == 0.0 {
            [0.0; 2]
        } else if determinant > 1e-14 * g[0] * g[2] {
            [(g[2] * h[0] - g[1] * h[1]) / determinant, (g[0] * h[1] - g[1] * h[0]) / determinant]
        } else if g[2] >= g[0] {
            [0.0, h[1] / g[2]]
        } else {
            [h[0] / g[0], 0.0]
        };
        (0..2).for_each(|i| self.factors[i] += change[i]);
    }

    /// The factors; those that are round-off of the fit are zero.
    fn factors(&self) -> [f64; 2] {
        self.factors.map(|f| if f.abs() <= 1e-11 * self.size { 0.0 } else { f })
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples;
    use super::super::sparse::add_scaled;
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn rayleigh_damping_is_recognised_below_a_few_dashpots() {
        let (k, m) = samples::plate(6, true);
        let rayleigh = add_scaled(&[(3.0, &m), (2e-6, &k)]);
        let split = Proportional::split(&rayleigh, &m, &k);
        assert!(split.rest.is_none() && within((split.mass_factor - 3.0).abs(), 1e-9, RoundOff));
        assert!(within((split.stiffness_factor - 2e-6).abs(), 1e-15, RoundOff));
        let n = k.ncols();
        let ground = samples::from_dense(
            faer::Mat::from_fn(n, n, |i, j| if i == j && i % 25 == 0 { 7.0 } else { 0.0 }).as_ref(),
        );
        let split = Proportional::split(&add_scaled(&[(1.0, &rayleigh), (1.0, &ground)]), &m, &k);
        assert!(within((split.mass_factor - 3.0).abs(), 1e-8, RoundOff), "{}", split.mass_factor);
        let rest = split.rest.unwrap().to_dense();
        assert!(within((rest - ground.to_dense()).norm_max(), 1e-6, RoundOff));
    }

    #[test]
    fn one_of_the_two_factors_and_none() {
        let (k, m) = samples::plate(5, true);
        let lossy = add_scaled(&[(0.01, &k)]);
        let split = Proportional::split(&lossy, &m, &k);
        assert!(split.rest.is_none() && split.mass_factor == 0.0);
        assert!(within((split.stiffness_factor - 0.01).abs(), 1e-14, RoundOff));
        let other = samples::random_definite(k.ncols(), 4);
        let split = Proportional::split(&other, &m, &k);
        assert!(split.mass_factor == 0.0 && split.stiffness_factor == 0.0 && split.rest.is_some());
        let negative = add_scaled(&[(-0.5, &m)]);
        assert!(Proportional::split(&negative, &m, &k).rest.is_some());
    }
}
