//! Resolution of the unknowns by the data: singular values of the sensitivity, covariance, intervals.

use super::Fit;
use super::problem::{CalibrationProblem, Computed};
use super::residuals::Residuals;
use super::svd::Svd;
use nalgebra::DMatrix;
use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};

/// Standard deviations either side of the mean that hold 95 % of a normal distribution.
const NORMAL: f64 = 1.959_963_984_540_054;
/// Share of cases that an interval leaves out.
const OUTSIDE: f64 = 0.05;
/// Combinations of unknowns with less of the largest singular value are numerically without effect.
const NOTHING: f64 = 1e-9;

/// An interval.
pub type Interval = [f64; 2];

/// Covariance of the unknowns after the fit, the model taken as linear near it.
///
/// W_ij = ∂r_i/∂x_j is the sensitivity in standard deviations of the data, (∂ ln f_i/∂x_j)/s_i of a frequency. With P = 1 for each unknown that was
/// expected, and 0 for the others, the covariance is (WᵀW + P)⁻¹ (Mottershead and Friswell, J. Sound Vib. 167 (1993) 347).
#[derive(Debug, Clone, PartialEq)]
pub struct Knowledge {
    /// Singular values of W, descending: one over the standard deviation that the data alone leave to each direction.
    pub singular_values: Vec<f64>,
    /// The right singular vectors of W, one for each singular value: combinations of the unknowns.
    pub directions: Vec<Vec<f64>>,
    /// Standard deviation of each unknown, with what was expected.
    pub deviations: Vec<f64>,
    /// Correlations of the unknowns.
    pub correlations: Vec<Vec<f64>>,
    /// 95 %: normal, the stated deviations trusted; inside the bounds.
    pub intervals: Vec<Interval>,
    /// 95 %: Student's t with the degrees of freedom, deviations scaled by √(χ²/ν); `None` where ν = 0.
    pub scaled_intervals: Option<Vec<Interval>>,
    /// ν: facts beyond the number of unknowns.
    pub freedom: usize,
    /// χ²/ν.
    pub reduced_chi2: Option<f64>,
    /// The probability of a χ² at least as large when model and deviations are right.
    pub chi2_probability: Option<f64>,
}

impl Knowledge {
    /// Covariance after the fit of `assignment`.
    pub(super) fn new(problem: &CalibrationProblem, assignment: &[usize], fit: &Fit) -> Knowledge {
        let n = problem.unknowns.len();
        let (w, h) = sensitivity(problem, assignment, &fit.computed);
        let svd = Svd::new(&w);
        let directions = (0..n).map(|k| upright(svd.v.column(k).iter().copied().collect())).collect();
        let covariance = inverse(&h);
        let deviations: Vec<f64> = (0..n).map(|j| covariance[(j, j)].sqrt()).collect();
        let correlation = |i: usize, j: usize| {
            let product = deviations[i] * deviations[j];
            if product > 0.0 && product.is_finite() { covariance[(i, j)] / product } else { f64::NAN }
        };
        let freedom = problem.degrees_of_freedom(assignment, &fit.computed);
        let around = |j: usize, half: f64| -> Interval {
            let [lower, upper] = problem.unknowns[j].bounds;
            [(fit.x[j] - half).max(lower), (fit.x[j] + half).min(upper)]
        };
        let reduced_chi2 = (freedom > 0).then(|| fit.chi2 / freedom as f64);
        Knowledge {
            freedom,
            singular_values: svd.s,
            directions,
            correlations: (0..n).map(|i| (0..n).map(|j| correlation(i, j)).collect()).collect(),
            intervals: (0..n).map(|j| around(j, NORMAL * deviations[j])).collect(),
            scaled_intervals: reduced_chi2.map(|reduced| {
                let factor = student(freedom as f64) * reduced.sqrt();
                (0..n).map(|j| around(j, factor * deviations[j])).collect()
            }),
            reduced_chi2,
            chi2_probability: (freedom > 0).then(|| exceeded(fit.chi2, freedom as f64)),
            deviations,
        }
    }

    /// The largest singular value over the smallest; infinite where a combination has no effect at all.
    pub fn condition(&self) -> f64 {
        match (self.singular_values.first(), self.singular_values.last()) {
            (Some(first), Some(last)) if *last > NOTHING * first => first / last,
            _ => f64::INFINITY,
        }
    }

    /// How many combinations of the unknowns the data determine better than they were known before: those whose singular
    /// value is above 1.
    pub fn determined(&self) -> usize {
        self.singular_values.iter().filter(|s| **s > 1.0).count()
    }
}

/// W, and WᵀW + P.
fn sensitivity(
    problem: &CalibrationProblem,
    assignment: &[usize],
    computed: &Computed,
) -> (DMatrix<f64>, DMatrix<f64>) {
    let n = problem.unknowns.len();
    let measured = Residuals::measured(problem, assignment, computed).jacobian(n);
    // Rows of zeros leave the singular values as they are, and there are then as many as unknowns.
    let rows = measured.nrows().max(n);
    let w = measured.resize_vertically(rows, 0.0);
    let mut h = w.tr_mul(&w);
    for (j, unknown) in problem.unknowns.iter().enumerate() {
        h[(j, j)] += if unknown.expected.is_some() { 1.0 } else { 0.0 };
    }
    (w, h)
}

/// How much each of some residuals moves when what the data leave open moves by its unit: along the directions that they
/// determine no better than the bounds do.
pub(super) fn left_open(
    problem: &CalibrationProblem,
    assignment: &[usize],
    computed: &Computed,
    residuals: &Residuals,
) -> Vec<f64> {
    let eigen = sensitivity(problem, assignment, computed).1.symmetric_eigen();
    let n = problem.unknowns.len();
    let open: Vec<usize> = (0..n).filter(|k| eigen.eigenvalues[*k] < 1.0).collect();
    let moved = residuals.jacobian(n) * eigen.eigenvectors.select_columns(&open);
    moved.row_iter().map(|row| row.norm()).collect()
}

/// The vector with its largest entry positive.
fn upright(v: Vec<f64>) -> Vec<f64> {
    let largest = v.iter().fold(0.0f64, |m, x| if x.abs() > m.abs() + 1e-12 { *x } else { m });
    v.iter().map(|x| if largest < 0.0 { -x } else { *x }).collect()
}

/// H⁻¹ of a symmetric H; directions without curvature get a variance that no bounds can hold.
fn inverse(h: &DMatrix<f64>) -> DMatrix<f64> {
    let eigen = h.clone().symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    let variance = eigen.eigenvalues.map(|v| 1.0 / v.max(NOTHING * NOTHING * largest).max(f64::MIN_POSITIVE));
    &eigen.eigenvectors * DMatrix::from_diagonal(&variance) * eigen.eigenvectors.transpose()
}

/// t with P(|T| > t) = 5 % for Student's distribution with ν degrees of freedom.
fn student(freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::NAN, |t| t.inverse_cdf(1.0 - 0.5 * OUTSIDE))
}

/// P(X > χ²) for the chi-squared distribution with ν degrees of freedom.
fn exceeded(chi2: f64, freedom: f64) -> f64 {
    ChiSquared::new(freedom).map_or(f64::NAN, |distribution| distribution.sf(chi2))
}

#[cfg(test)]
mod tests {
    use super::super::Unknown;
    use super::super::samples::{Powers, level, problem};
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn students_t_is_that_of_the_tables() {
        for (freedom, t) in [(1.0, 12.706), (2.0, 4.303), (5.0, 2.571), (30.0, 2.042)] {
            assert!(within((student(freedom) - t).abs(), 6e-4, Reference), "{freedom} {}", student(freedom));
        }
    }

    #[test]
    fn the_probability_of_chi2_is_that_of_the_tables() {
        // 95 % points of chi-squared.
        for (freedom, chi2) in [(1.0, 3.841_459), (10.0, 18.307_038), (100.0, 124.342_113)] {
            assert!(within((exceeded(chi2, freedom) - 0.05).abs(), 1e-7, Reference), "{freedom}");
        }
        // For many degrees of freedom as many standard deviations away as Wilson and Hilferty say, on either side.
        for freedom in [250.0, 1e3, 1e4, 1e6] {
            for (z, probability) in [(-2.0, 0.977_250), (0.0, 0.5), (2.0, 0.022_750)] {
                let h: f64 = 2.0 / (9.0 * freedom);
                let found = exceeded(freedom * (1.0 - h + z * h.sqrt()).powi(3), freedom);
                assert!(within((found - probability).abs(), 2e-5, Theory), "{freedom}, {z}: {found}");
            }
        }
        assert!(exceeded(1e300, 500.0) == 0.0 && exceeded(0.0, 500.0) == 1.0);
    }

    #[test]
    fn a_straight_line_has_the_covariance_of_the_textbook() {
        // ln f_i = a + b t_i with deviation s: var b = s²/Σ(t − t̄)², var a = s² Σt²/(n Σ(t − t̄)²).
        let t = [-1.0, 0.0, 2.0, 3.0];
        let straight = |t: &f64| Some(level(100.0, vec![1.0, *t]));
        let model = Powers::new(4, 2, 0);
        let mut problem = problem(&model, &[101.0, 99.0, 100.0, 100.0], 0.01);
        problem.unknowns = vec![Unknown { bounds: [-9.0, 9.0], expected: None }; 2];
        let fit = Fit {
            x: vec![0.0; 2],
            computed: Computed { levels: t.iter().map(straight).collect(), lines: Vec::new() },
            chi2: 6.0,
            iterations: 0,
            evaluations: 0,
            gradient: 0.0,
            converged: true,
        };
        let known = Knowledge::new(&problem, &[0, 1, 2, 3], &fit);
        let spread = 10.0;
        assert!(within((known.deviations[1] - 0.01 / f64::sqrt(spread)).abs(), 1e-12, RoundOff));
        assert!(within(
            (known.deviations[0] - 0.01 * f64::sqrt(14.0 / (4.0 * spread))).abs(),
            1e-12,
            RoundOff
        ));
        assert!(within((known.correlations[0][1] + 4.0 / f64::sqrt(14.0 * 4.0)).abs(), 1e-12, RoundOff));
        let half = known.scaled_intervals.as_ref().unwrap()[1][1];
        assert!(within((half - 4.3027 * f64::sqrt(3.0) * known.deviations[1]).abs(), 1e-5, Reference));
        // P(χ² > 6) with two degrees of freedom is e⁻³.
        assert!(within((known.chi2_probability.unwrap() - (-3.0f64).exp()).abs(), 1e-9, RoundOff));
        assert!(known.determined() == 2 && known.condition() < 10.0);
        // A third unknown without effect is reported.
        problem.unknowns.push(Unknown { bounds: [-1.0, 1.0], expected: None });
        let mut fit = fit;
        fit.x.push(0.3);
        fit.computed.levels.iter_mut().flatten().for_each(|level| level.slope.push(0.0));
        let known = Knowledge::new(&problem, &[0, 1, 2, 3], &fit);
        assert!(known.determined() == 2 && known.condition().is_infinite());
        assert_eq!(known.intervals[2], [-1.0, 1.0]);
        assert!(within((known.directions[2][2] - 1.0).abs(), 1e-12, RoundOff));
    }
}
