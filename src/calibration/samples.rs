//! Models with a closed form for the tests.

use super::Span;
use super::problem::{
    CalibrationModel, CalibrationProblem, Computed, Curve, Datum, Level, ResponseLine, Unknown,
};
use crate::error::Result;
use crate::linalg::c64;
use crate::linalg::random::Random;
use nalgebra::DMatrix;

/// f_k = f_k0 exp(Σ a_kj x_j + ½ b (Σ a_kj x_j)²): smooth, with slopes that are known.
pub(super) struct Powers {
    pub base: Vec<f64>,
    pub exponents: Vec<Vec<f64>>,
    pub bend: f64,
    /// Measured components of a shape; none for frequencies alone.
    pub components: usize,
    /// Its frequency responses.
    pub sampled: Vec<SampledResponse>,
}

/// ln |Σ w_k / (f_k² − f² + iηf_k²)| with η = 2 %, at some frequencies.
pub(super) struct SampledResponse {
    /// w_k of each level.
    pub weights: Vec<f64>,
    pub frequencies_hz: Vec<f64>,
}

impl SampledResponse {
    fn line(&self, hz: f64, levels: &[Option<Level>]) -> ResponseLine {
        let loss = c64::new(1.0, 0.02);
        let unknowns = levels.iter().flatten().next().map_or(0, |level| level.slope.len());
        let (mut h, mut slope) = (c64::new(0.0, 0.0), vec![c64::new(0.0, 0.0); unknowns]);
        for (weight, level) in self.weights.iter().zip(levels.iter().flatten()) {
            let square = loss * level.frequency_hz.powi(2);
            let part = *weight / (square - hz * hz);
            h += part;
            // ∂f² = 2f² ∂ ln f.
            let turn = -2.0 * part * square / (square - hz * hz);
            slope.iter_mut().zip(&level.slope).for_each(|(sum, g)| *sum += turn * *g);
        }
        let along = |d: &c64| (h.conj() * d).re / h.norm_sqr();
        ResponseLine { value: h.norm().ln(), slope: slope.iter().map(along).collect() }
    }
}

/// A single level without a shape.
pub(super) fn level(frequency_hz: f64, slope: Vec<f64>) -> Level {
    let split = vec![0.0; slope.len()];
    Level { frequency_hz, slope, split, span: None }
}

/// Motions that turn with the unknowns, each along its own way.
pub(super) fn turning(components: usize, modes: usize, x: &[f64]) -> Span {
    turning_as(0, components, modes, x)
}

/// The same for many levels.
fn turning_as(level: usize, components: usize, modes: usize, x: &[f64]) -> Span {
    let phase = |i: usize, k: usize| (1.0 + 0.7 * k as f64 + 0.37 * level as f64) * (i as f64 + 0.5);
    let way = |i: usize, k: usize, j: usize| (phase(i, k) * (2.3 + j as f64)).cos();
    let motion = |i: usize, k: usize| {
        phase(i, k).sin() + x.iter().enumerate().map(|(j, x)| 0.3 * way(i, k, j) * x.sin()).sum::<f64>()
    };
    let slope = |j: usize| DMatrix::from_fn(components, modes, |i, k| 0.3 * way(i, k, j) * x[j].cos());
    Span { motions: DMatrix::from_fn(components, modes, motion), slopes: (0..x.len()).map(slope).collect() }
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
        Powers { base, exponents, bend: 0.5, components: 0, sampled: Vec::new() }
    }
}

impl CalibrationModel for Powers {
    fn compute(&self, x: &[f64]) -> Result<Computed> {
        let level = |(k, (base, a)): (usize, (&f64, &Vec<f64>))| {
            let s: f64 = a.iter().zip(x).map(|(a, x)| a * x).sum();
            Some(Level {
                frequency_hz: base * (s + 0.5 * self.bend * s * s).exp(),
                slope: a.iter().map(|a| a * (1.0 + self.bend * s)).collect(),
                split: vec![0.0; x.len()],
                span: (self.components > 0).then(|| turning_as(k, self.components, 1 + k % 2, x)),
            })
        };
        let levels: Vec<Option<Level>> =
            self.base.iter().zip(&self.exponents).enumerate().map(level).collect();
        let of = |sampled: &SampledResponse| -> Vec<ResponseLine> {
            sampled.frequencies_hz.iter().map(|hz| sampled.line(*hz, &levels)).collect()
        };
        Ok(Computed { lines: self.sampled.iter().flat_map(of).collect(), levels })
    }
}

/// Responses of a model at `x` as if measured without noise.
pub(super) fn curves(model: &Powers, x: &[f64], deviation: f64) -> Vec<Curve> {
    let lines = model.compute(x).unwrap().lines;
    let mut first = 0;
    let curve = |sampled: &SampledResponse| {
        let own = first..first + sampled.frequencies_hz.len();
        first = own.end;
        Curve { first: own.start, values: lines[own].iter().map(|line| line.value).collect(), deviation }
    };
    model.sampled.iter().map(curve).collect()
}

/// Unknowns in ±2 without expectation and measured frequencies of one set.
pub(super) fn problem(model: &Powers, data: &[f64], deviation: f64) -> CalibrationProblem {
    let unknowns = vec![Unknown { bounds: [-2.0, 2.0], expected: None }; model.exponents[0].len()];
    let datum = |f: &f64| Datum { set: 0, frequency_hz: *f, deviation, shape: None };
    CalibrationProblem {
        unknowns,
        data: data.iter().map(datum).collect(),
        level_sets: vec![0; model.base.len()],
        level_modes: vec![1; model.base.len()],
        curves: Vec::new(),
    }
}
