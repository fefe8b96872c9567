//! The model linearised at one place: what a fit would find there, in microseconds.

use super::problem::{CalibrationProblem, Datum, Level};
use super::quadratic::least_in_box;
use nalgebra::{DMatrix, DVector};

/// A mode whose shape is less like the measured one than this is not what was measured, however near its frequency.
pub const LIKE: f64 = 0.1;

/// ln f_k(x) ≈ ln f_k(x₀) + g_k·(x − x₀); shapes stay as they are at x₀, where the slopes of modes that mix promise too much, and
/// frequency responses, whose peaks must meet before a slope says anything, take no part before the modes have met.
#[derive(Debug, Clone)]
pub(super) struct Linear<'a> {
    pub(super) problem: &'a CalibrationProblem,
    x: Vec<f64>,
    levels: &'a [Option<Level>],
    /// χ² of the shape of each datum with each level.
    shapes: Vec<Vec<f64>>,
}

/// χ²(x) ≈ constant + 2 (½ dᵀHd + gᵀd), d = x − x₀, of the residuals that were added.
#[derive(Debug, Clone)]
pub(super) struct Misfit {
    h: DMatrix<f64>,
    g: DVector<f64>,
    constant: f64,
}

impl Misfit {
    /// Adds the residual `at` + `row`·d.
    fn add(&mut self, at: f64, row: impl Fn(usize) -> f64) {
        let row = DVector::from_fn(self.g.len(), |j, _| row(j));
        self.h.ger(1.0, &row, &row, 1.0);
        self.g.axpy(at, &row, 1.0);
        self.constant += at * at;
    }
}

impl<'a> Linear<'a> {
    pub(super) fn new(problem: &'a CalibrationProblem, x: &[f64], levels: &'a [Option<Level>]) -> Self {
        let apart = |datum: &Datum, level: &Option<Level>| match (&datum.shape, level.as_ref()) {
            (Some(shape), Some(Level { span: Some(span), .. })) => {
                let size: f64 = shape.iter().map(|v| v * v).sum();
                (1.0 - span.mac(shape)) * size
            }
            _ => 0.0,
        };
        let row = |datum: &Datum| levels.iter().map(|level| apart(datum, level)).collect();
        Linear { problem, x: x.to_vec(), levels, shapes: problem.data.iter().map(row).collect() }
    }

    /// The levels that may be what was measured: of the same set, of a shape that is at all like the measured one, and inside
    /// the bounds they come as near as a factor 1 + `reach`. They are in the order of the levels.
    pub(super) fn plausible(&self, datum: &Datum, reach: f64) -> Vec<usize> {
        let y = datum.frequency_hz.ln();
        let near = |level: &Level| {
            let (mut low, mut high) = (level.frequency_hz.ln(), level.frequency_hz.ln());
            for ((slope, x), unknown) in level.slope.iter().zip(&self.x).zip(&self.problem.unknowns) {
                let ends = unknown.bounds.map(|bound| slope * (bound - x));
                low += ends[0].min(ends[1]);
                high += ends[0].max(ends[1]);
            }
            low - reach.ln_1p() <= y && y <= high + reach.ln_1p()
        };
        let like = |level: &Level| match (&datum.shape, &level.span) {
            (Some(shape), Some(span)) => span.mac(shape) >= LIKE,
            (Some(_), None) => false,
            (None, _) => true,
        };
        let same = |k: &usize| self.problem.level_sets[*k] == datum.set;
        let may = |k: &usize| self.levels[*k].as_ref().is_some_and(|level| near(level) && like(level));
        (0..self.levels.len()).filter(same).filter(may).collect()
    }

    /// The misfit of what was expected alone.
    pub(super) fn expected(&self) -> Misfit {
        let n = self.x.len();
        let mut misfit = Misfit { h: DMatrix::zeros(n, n), g: DVector::zeros(n), constant: 0.0 };
        for (j, unknown) in self.problem.unknowns.iter().enumerate() {
            if let Some(expected) = unknown.expected {
                misfit.add(self.x[j] - expected, |k| f64::from(u8::from(j == k)));
            }
        }
        misfit
    }

    /// `misfit` with one more of the data, which is taken for a level that was found.
    pub(super) fn with(&self, misfit: &Misfit, (data, datum): (&[Datum], usize), level: usize) -> Misfit {
        let mut more = misfit.clone();
        if data[datum].shape.is_some() {
            more.constant += self.shapes[datum][level];
        }
        let datum = &data[datum];
        if let Some(level) = &self.levels[level] {
            let at = (level.frequency_hz / datum.frequency_hz).ln() / datum.deviation;
            more.add(at, |j| level.slope[j] / datum.deviation);
        }
        more
    }

    /// The misfit of what was expected and of all data, taken for these levels.
    pub(super) fn misfit(&self, data: &[Datum], assignment: &[usize]) -> Misfit {
        let each = assignment.iter().enumerate();
        each.fold(self.expected(), |misfit, (datum, level)| self.with(&misfit, (data, datum), *level))
    }

    /// The least χ² inside the bounds, and where it is.
    pub(super) fn least(&self, misfit: &Misfit) -> (f64, Vec<f64>) {
        let distance = |k: usize| {
            let each = self.problem.unknowns.iter().zip(&self.x);
            each.map(|(unknown, x)| unknown.bounds[k] - x).collect::<Vec<f64>>()
        };
        let d = least_in_box(&misfit.h, &misfit.g, &distance(0), &distance(1));
        let chi2 = misfit.constant + (&misfit.h * &d + 2.0 * &misfit.g).dot(&d);
        (chi2.max(0.0), self.x.iter().zip(&d).map(|(x, d)| x + d).collect())
    }

    /// max |f/y − 1| at `x`.
    pub(super) fn largest_error(&self, data: &[Datum], assignment: &[usize], x: &[f64]) -> f64 {
        let error = |(datum, k): (&Datum, &usize)| {
            self.levels[*k].as_ref().map_or(f64::INFINITY, |level| {
                let moved: f64 =
                    level.slope.iter().zip(x.iter().zip(&self.x)).map(|(g, (x, x0))| g * (x - x0)).sum();
                (level.frequency_hz * moved.exp() / datum.frequency_hz - 1.0).abs()
            })
        };
        data.iter().zip(assignment).map(error).fold(0.0, f64::max)
    }
}
