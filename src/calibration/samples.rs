//! Models with a closed form for the tests.

use super::{Datum, Level, Levels, Model, Problem, Unknown};
use crate::error::Result;
use crate::linalg::random::Random;

/// f_k = f_k0 exp(Σ a_kj x_j + ½ b (Σ a_kj x_j)²): smooth, with slopes that are known.
pub(super) struct Powers {
    pub base: Vec<f64>,
    pub exponents: Vec<Vec<f64>>,
    pub bend: f64,
}

impl Powers {
    /// `levels` levels of `unknowns` unknowns, the same for the same `seed`.
    pub(super) fn new(levels: usize, unknowns: usize, seed: usize) -> Self {
        let mut random = Random::new();
        (0..seed).for_each(|_| {
            random.next();
        });
        let base =
            (0..levels).map(|k| 300.0 * 1.2f64.powi(k as i32) * (1.0 + 0.05 * random.next())).collect();
        let exponents = (0..levels).map(|_| (0..unknowns).map(|_| 0.1 * random.next()).collect()).collect();
        Powers { base, exponents, bend: 0.5 }
    }
}

impl Model for Powers {
    fn levels(&self, x: &[f64]) -> Result<Levels> {
        let level = |(base, a): (&f64, &Vec<f64>)| {
            let s: f64 = a.iter().zip(x).map(|(a, x)| a * x).sum();
            Some(Level {
                frequency_hz: base * (s + 0.5 * self.bend * s * s).exp(),
                slope: a.iter().map(|a| a * (1.0 + self.bend * s)).collect(),
                split: vec![0.0; x.len()],
            })
        };
        Ok(self.base.iter().zip(&self.exponents).map(level).collect())
    }
}

/// Unknowns in ±2 without expectation and measured frequencies of one set.
pub(super) fn problem(model: &Powers, data: &[f64], deviation: f64) -> Problem {
    let unknowns = vec![Unknown { bounds: [-2.0, 2.0], expected: None }; model.exponents[0].len()];
    let datum = |f: &f64| Datum { set: 0, frequency_hz: *f, deviation };
    Problem { unknowns, data: data.iter().map(datum).collect(), level_sets: vec![0; model.base.len()] }
}
