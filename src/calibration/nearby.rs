//! A model near one place: quadratic in ln f and in the lines, linear in the shapes, so that thousands of fits cost nothing.

use super::problem::{CalibrationModel, CalibrationProblem, Computed, Level, ResponseLine};
use crate::error::Result;
use rayon::prelude::*;

/// ln f(x) ≈ ln f₀ + gᵀd + ½ dᵀHd, d = x − x₀, with the slopes g + Hd, of lines alike; Φ(x) ≈ Φ₀ + Σ d_j ∂Φ/∂x_j.
pub(super) struct QuadraticModel {
    x: Vec<f64>,
    here: Computed,
    /// H of every level and every line, by rows.
    curvature: Vec<Vec<Vec<f64>>>,
}

/// The slope of a level, or of a line beyond the levels.
fn slope(computed: &Computed, k: usize) -> Option<&[f64]> {
    match k.checked_sub(computed.levels.len()) {
        None => computed.levels[k].as_ref().map(|level| &level.slope[..]),
        Some(line) => Some(&computed.lines[line].slope),
    }
}

impl QuadraticModel {
    /// The model near `x`, where it is known: H_jk = (g_j(x + h_k) − g_j(x − h_k))/2h_k, made symmetric, with steps of
    /// `steps`, shorter towards a bound.
    pub(super) fn new(
        model: &dyn CalibrationModel,
        problem: &CalibrationProblem,
        (x, here): (&[f64], &Computed),
        steps: &[f64],
    ) -> Result<QuadraticModel> {
        let n = x.len();
        let sides: Vec<(usize, f64)> = (0..n).flat_map(|j| [(j, steps[j]), (j, -steps[j])]).collect();
        let moved = |(j, step): &(usize, f64)| -> Result<(f64, Computed)> {
            let mut there = x.to_vec();
            there[*j] += step;
            let there = problem.inside(&there);
            Ok((
                there[*j] - x[*j],
                if there[*j] == x[*j] { here.clone() } else { problem.compute(model, &there)? },
            ))
        };
        let around: Vec<(f64, Computed)> = sides.par_iter().map(moved).collect::<Result<_>>()?;
        let rate = |l: usize, j: usize, k: usize| -> f64 {
            let ((up, above), (down, below)) = (&around[2 * k], &around[2 * k + 1]);
            match (slope(above, l), slope(below, l)) {
                (Some(a), Some(b)) if up > down => (a[j] - b[j]) / (up - down),
                _ => 0.0,
            }
        };
        let symmetric = |l: usize, j: usize, k: usize| 0.5 * (rate(l, j, k) + rate(l, k, j));
        let of = |l: usize| (0..n).map(|j| (0..n).map(|k| symmetric(l, j, k)).collect()).collect();
        let curvature = (0..here.levels.len() + here.lines.len()).map(of).collect();
        Ok(QuadraticModel { x: x.to_vec(), here: here.clone(), curvature })
    }
}

impl CalibrationModel for QuadraticModel {
    fn compute(&self, x: &[f64]) -> Result<Computed> {
        let d: Vec<f64> = x.iter().zip(&self.x).map(|(x, x0)| x - x0).collect();
        let dot = |row: &[f64]| row.iter().zip(&d).map(|(a, d)| a * d).sum::<f64>();
        // How far the value moves, and its slope there.
        let moved = |slope: &[f64], h: &Vec<Vec<f64>>| -> (f64, Vec<f64>) {
            let bend: Vec<f64> = h.iter().map(|row| dot(row)).collect();
            let there = slope.iter().zip(&bend).map(|(g, b)| g + b).collect();
            (dot(slope) + 0.5 * dot(&bend), there)
        };
        let (of_levels, of_lines) = self.curvature.split_at(self.here.levels.len());
        let level = |(level, h): (&Option<Level>, &Vec<Vec<f64>>)| {
            let level = level.as_ref()?;
            let (rise, slope) = moved(&level.slope, h);
            Some(Level {
                frequency_hz: level.frequency_hz * rise.exp(),
                slope,
                split: level.split.clone(),
                span: level.span.as_ref().map(|span| span.moved(&d)),
            })
        };
        let line = |(line, h): (&ResponseLine, &Vec<Vec<f64>>)| {
            let (rise, slope) = moved(&line.slope, h);
            ResponseLine { value: line.value + rise, slope }
        };
        Ok(Computed {
            levels: self.here.levels.iter().zip(of_levels).map(level).collect(),
            lines: self.here.lines.iter().zip(of_lines).map(line).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::{Powers, problem};
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn a_quadratic_model_is_itself() {
        let model = Powers::new(4, 3, 5);
        let problem = problem(&model, &[300.0], 0.01);
        let x = [0.3, -0.4, 1.9];
        let here = model.compute(&x).unwrap();
        let near = QuadraticModel::new(&model, &problem, (&x, &here), &[0.5; 3]).unwrap();
        let there = [0.9, -1.0, 1.2];
        let (own, exact) = (near.compute(&there).unwrap(), model.compute(&there).unwrap());
        for (a, b) in own.levels.iter().zip(&exact.levels) {
            let (a, b) = (a.as_ref().unwrap(), b.as_ref().unwrap());
            assert!(within((a.frequency_hz / b.frequency_hz - 1.0).abs(), 1e-12, RoundOff));
            assert!(a.slope.iter().zip(&b.slope).all(|(a, b)| within((a - b).abs(), 1e-12, RoundOff)));
        }
    }
}
