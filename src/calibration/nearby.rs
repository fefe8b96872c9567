//! A model near one place: quadratic in ln f and linear in the shapes, so that thousands of fits cost nothing.

use super::{Level, Levels, Model, Problem};
use crate::error::Result;
use rayon::prelude::*;

/// ln f(x) ≈ ln f₀ + gᵀd + ½ dᵀHd, d = x − x₀, with the slopes g + Hd; Φ(x) ≈ Φ₀ + Σ d_j ∂Φ/∂x_j.
pub(super) struct Nearby {
    x: Vec<f64>,
    levels: Levels,
    /// H of every level, by rows.
    curvature: Vec<Vec<Vec<f64>>>,
}

impl Nearby {
    /// The model near `x`, where its `levels` are known: H_jk = (g_j(x + h_k) − g_j(x − h_k))/2h_k, made symmetric, with steps
    /// of `steps`, shorter towards a bound.
    pub(super) fn new(
        model: &dyn Model,
        problem: &Problem,
        (x, levels): (&[f64], &Levels),
        steps: &[f64],
    ) -> Result<Nearby> {
        let n = x.len();
        let sides: Vec<(usize, f64)> = (0..n).flat_map(|j| [(j, steps[j]), (j, -steps[j])]).collect();
        let moved = |(j, step): &(usize, f64)| -> Result<(f64, Levels)> {
            let mut there = x.to_vec();
            there[*j] += step;
            let there = problem.inside(&there);
            Ok((there[*j] - x[*j], if there[*j] == x[*j] { levels.clone() } else { model.levels(&there)? }))
        };
        let around: Vec<(f64, Levels)> = sides.par_iter().map(moved).collect::<Result<_>>()?;
        let slope = |levels: &Levels, l: usize, j: usize| levels[l].as_ref().map(|level| level.slope[j]);
        let rate = |l: usize, j: usize, k: usize| -> f64 {
            let ((up, above), (down, below)) = (&around[2 * k], &around[2 * k + 1]);
            match (slope(above, l, j), slope(below, l, j)) {
                (Some(a), Some(b)) if up > down => (a - b) / (up - down),
                _ => 0.0,
            }
        };
        let symmetric = |l: usize, j: usize, k: usize| 0.5 * (rate(l, j, k) + rate(l, k, j));
        let of = |l: usize| (0..n).map(|j| (0..n).map(|k| symmetric(l, j, k)).collect()).collect();
        let curvature = (0..levels.len()).map(of).collect();
        Ok(Nearby { x: x.to_vec(), levels: levels.clone(), curvature })
    }
}

impl Model for Nearby {
    fn levels(&self, x: &[f64]) -> Result<Levels> {
        let d: Vec<f64> = x.iter().zip(&self.x).map(|(x, x0)| x - x0).collect();
        let dot = |row: &[f64]| row.iter().zip(&d).map(|(a, d)| a * d).sum::<f64>();
        let level = |(level, h): (&Option<Level>, &Vec<Vec<f64>>)| {
            let level = level.as_ref()?;
            let bend: Vec<f64> = h.iter().map(|row| dot(row)).collect();
            Some(Level {
                frequency_hz: level.frequency_hz * (dot(&level.slope) + 0.5 * dot(&bend)).exp(),
                slope: level.slope.iter().zip(&bend).map(|(g, b)| g + b).collect(),
                split: level.split.clone(),
                span: level.span.as_ref().map(|span| span.moved(&d)),
            })
        };
        Ok(self.levels.iter().zip(&self.curvature).map(level).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::{Powers, problem};
    use super::*;

    #[test]
    fn a_quadratic_model_is_itself() {
        let model = Powers::new(4, 3, 5);
        let problem = problem(&model, &[300.0], 0.01);
        let x = [0.3, -0.4, 1.9];
        let levels = model.levels(&x).unwrap();
        let near = Nearby::new(&model, &problem, (&x, &levels), &[0.5; 3]).unwrap();
        let there = [0.9, -1.0, 1.2];
        for (a, b) in near.levels(&there).unwrap().iter().zip(&model.levels(&there).unwrap()) {
            let (a, b) = (a.as_ref().unwrap(), b.as_ref().unwrap());
            assert!((a.frequency_hz / b.frequency_hz - 1.0).abs() < 1e-12);
            assert!(a.slope.iter().zip(&b.slope).all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }
}
