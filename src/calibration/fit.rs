//! Bounded nonlinear least squares: Levenberg and Marquardt's method with the bounds in the subproblem.

use super::problem::{CalibrationModel, CalibrationProblem, Computed};
use super::quadratic::least_in_box;
use super::residuals::Residuals;
use crate::error::Result;
use nalgebra::{DMatrix, DVector};

/// The fit has converged when the projected gradient, each entry over √(JᵀJ)_jj, is below this share of √χ², or of 1 where
/// χ² is less. What χ² could still lose is about the square of it.
const CONVERGED: f64 = 1e-5;
/// Most iterations.
const MOST_ITERATIONS: usize = 60;
/// Damping beyond which no step helps.
const STIFF: f64 = 1e10;
/// A step smaller than this in every unknown's own unit is none.
const SMALLEST_STEP: f64 = 1e-10;

/// The least χ² of one assignment.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// The unknowns.
    pub x: Vec<f64>,
    /// Computed values there.
    pub computed: Computed,
    /// χ².
    pub chi2: f64,
    /// Accepted and refused steps.
    pub iterations: usize,
    /// Number of times the model was computed, the start not counted.
    pub evaluations: usize,
    /// The largest entry of the projected gradient over √(JᵀJ)_jj: by about its square χ² could still fall.
    pub gradient: f64,
    /// Whether that is small.
    pub converged: bool,
}

/// χ²/2 and its first derivatives at one place.
struct Here {
    residuals: DVector<f64>,
    jacobian: DMatrix<f64>,
}

impl Here {
    /// `None` where a level of the assignment is not found.
    fn new(
        problem: &CalibrationProblem,
        assignment: &[usize],
        x: &[f64],
        computed: &Computed,
    ) -> Option<Here> {
        let all = Residuals::all(problem, assignment, x, computed)?;
        Some(Here { residuals: all.vector(), jacobian: all.jacobian(x.len()) })
    }

    fn chi2(&self) -> f64 {
        self.residuals.norm_squared()
    }
}

/// The least χ² of `assignment` inside the bounds, from a start where the model is computed.
///
/// Each step d is the least value of ½ dᵀ(JᵀJ + λD)d + (Jᵀr)ᵀd inside the bounds, D the diagonal of JᵀJ: Levenberg and
/// Marquardt's step with the bounds as an active set (Nocedal and Wright, Numerical Optimization, 2nd ed., ch. 10 and 16). λ
/// follows the ratio of the gain of χ² to the expected one (Nielsen 1999).
///
/// # Errors
/// Those of the model.
pub fn fit(
    model: &dyn CalibrationModel,
    problem: &CalibrationProblem,
    assignment: &[usize],
    (x, computed): (&[f64], &Computed),
) -> Result<Fit> {
    let mut fit = Fit {
        x: x.to_vec(),
        computed: computed.clone(),
        chi2: f64::INFINITY,
        iterations: 0,
        evaluations: 0,
        gradient: f64::INFINITY,
        converged: false,
    };
    let Some(mut here) = Here::new(problem, assignment, x, computed) else { return Ok(fit) };
    fit.chi2 = here.chi2();
    let (mut damping, mut growth) = (1e-4, 2.0);
    loop {
        let h = here.jacobian.tr_mul(&here.jacobian);
        let g = here.jacobian.tr_mul(&here.residuals);
        fit.gradient = projected(problem, &fit.x, &h, &g);
        fit.converged = fit.gradient <= CONVERGED * fit.chi2.sqrt().max(1.0);
        if fit.converged || fit.iterations == MOST_ITERATIONS || damping > STIFF {
            return Ok(fit);
        }
        let mut damped = h.clone();
        let least = 1e-9 * h.diagonal().max();
        (0..g.len()).for_each(|j| damped[(j, j)] += damping * h[(j, j)].max(least));
        let distance = |end: usize| -> Vec<f64> {
            problem.unknowns.iter().zip(&fit.x).map(|(unknown, x)| unknown.bounds[end] - x).collect()
        };
        let d = least_in_box(&damped, &g, &distance(0), &distance(1));
        if d.amax() < SMALLEST_STEP {
            return Ok(fit);
        }
        let moved: Vec<f64> = problem.inside(&fit.x.iter().zip(&d).map(|(x, d)| x + d).collect::<Vec<_>>());
        let computed = problem.compute(model, &moved)?;
        fit.iterations += 1;
        fit.evaluations += 1;
        let there = Here::new(problem, assignment, &moved, &computed).filter(|there| there.chi2() < fit.chi2);
        match there {
            Some(there) => {
                let expected = -(2.0 * &g + &h * &d).dot(&d);
                let ratio = (fit.chi2 - there.chi2()) / expected.max(f64::MIN_POSITIVE);
                damping *= (1.0 - (2.0 * ratio - 1.0).powi(3)).max(0.1);
                growth = 2.0;
                (fit.x, fit.computed, fit.chi2) = (moved, computed, there.chi2());
                here = there;
            }
            None => {
                damping *= growth;
                growth *= 2.0;
            }
        }
    }
}

/// The largest |g_j|/√h_jj among the unknowns that a step against the gradient would not push out of the bounds.
fn projected(problem: &CalibrationProblem, x: &[f64], h: &DMatrix<f64>, g: &DVector<f64>) -> f64 {
    let held = |j: usize| {
        let [lower, upper] = problem.unknowns[j].bounds;
        (x[j] <= lower && g[j] > 0.0) || (x[j] >= upper && g[j] < 0.0)
    };
    let size = |j: usize| if h[(j, j)] > 0.0 { g[j].abs() / h[(j, j)].sqrt() } else { 0.0 };
    (0..g.len()).filter(|j| !held(*j)).map(size).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::super::residuals::misfit;
    use super::super::samples::{Powers, problem};
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn the_truth_is_found_again() {
        let model = Powers::new(5, 3, 0);
        let truth = [0.7, -1.1, 0.4];
        let exact: Vec<f64> =
            model.compute(&truth).unwrap().levels.iter().flatten().map(|level| level.frequency_hz).collect();
        let problem = problem(&model, &exact, 0.005);
        let start = [0.0; 3];
        let fit = fit(&model, &problem, &[0, 1, 2, 3, 4], (&start, &model.compute(&start).unwrap())).unwrap();
        assert!(fit.converged && within(fit.chi2, 1e-9, Tolerance) && fit.iterations < 15, "{fit:?}");
        assert!(fit.x.iter().zip(truth).all(|(x, t)| within((x - t).abs(), 1e-6, Tolerance)), "{:?}", fit.x);
    }

    #[test]
    fn at_a_bound_the_gradient_points_outwards_and_the_rest_is_least() {
        let model = Powers::new(5, 2, 3);
        let truth = [2.6, -0.5];
        let exact: Vec<f64> =
            model.compute(&truth).unwrap().levels.iter().flatten().map(|level| level.frequency_hz).collect();
        let mut problem = problem(&model, &exact, 0.01);
        problem.unknowns[1].expected = Some(0.2);
        let start = [0.0; 2];
        let assignment = [0, 1, 2, 3, 4];
        let found = fit(&model, &problem, &assignment, (&start, &model.compute(&start).unwrap())).unwrap();
        assert!(found.converged && found.x[0] == 2.0 && found.chi2 > 0.01, "{found:?}");
        for other in [[1.99, found.x[1]], [2.0, found.x[1] + 0.01], [2.0, found.x[1] - 0.01]] {
            let there = model.compute(&other).unwrap();
            assert!(misfit(&problem, &assignment, &other, &there) > found.chi2);
        }
    }
}
