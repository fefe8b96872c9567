//! Residuals of measured and computed, and their derivatives.

use super::problem::{CalibrationProblem, Computed, Curve, Datum, Level, ResponseLine};
use nalgebra::{DMatrix, DVector};

/// Residuals r_i with their rows ∂r_i/∂x_j, in standard deviations.
#[derive(Debug, Clone, Default)]
pub(super) struct Residuals {
    pub values: Vec<f64>,
    /// By rows: `values.len()` × unknowns.
    rows: Vec<f64>,
    /// Scale factors of shapes that were eliminated: so many of the residuals are no facts.
    pub eliminated: usize,
}

impl Residuals {
    fn push(&mut self, value: f64, row: impl IntoIterator<Item = f64>) {
        self.values.push(value);
        self.rows.extend(row);
    }

    fn append(&mut self, other: Residuals) {
        self.values.extend(other.values);
        self.rows.extend(other.rows);
        self.eliminated += other.eliminated;
    }

    /// A measured mode beside a level: its frequency first, ln(f/y)/s, then its shape, if it has one.
    pub(super) fn of(datum: &Datum, level: &Level) -> Residuals {
        let mut all = Residuals::default();
        let frequency = (level.frequency_hz / datum.frequency_hz).ln() / datum.deviation;
        all.push(frequency, level.slope.iter().map(|g| g / datum.deviation));
        if let (Some(shape), Some(span)) = (&datum.shape, &level.span) {
            let apart = span.apart(shape);
            for (i, rest) in apart.rest.iter().enumerate() {
                all.push(*rest, apart.slopes.iter().map(|slope| slope[i]));
            }
            all.eliminated = span.dimension();
        }
        all
    }

    /// A measured response beside its own of all computed lines.
    pub(super) fn along(curve: &Curve, lines: &[ResponseLine]) -> Residuals {
        let mut all = Residuals::default();
        let s = curve.deviation;
        for (line, value) in lines[curve.lines()].iter().zip(&curve.values) {
            all.push((line.value - value) / s, line.slope.iter().map(|g| g / s));
        }
        all
    }

    /// Of everything measured, with the levels of `assignment`; those that are not found say nothing.
    pub(super) fn measured(
        problem: &CalibrationProblem,
        assignment: &[usize],
        computed: &Computed,
    ) -> Residuals {
        let mut all = Residuals::default();
        for (datum, k) in problem.data.iter().zip(assignment) {
            if let Some(level) = &computed.levels[*k] {
                all.append(Residuals::of(datum, level));
            }
        }
        problem.curves.iter().for_each(|curve| all.append(Residuals::along(curve, &computed.lines)));
        all
    }

    /// Of everything measured and expected at `x`; `None` where a level is not found, or something is not finite.
    pub(super) fn all(
        problem: &CalibrationProblem,
        assignment: &[usize],
        x: &[f64],
        computed: &Computed,
    ) -> Option<Residuals> {
        if assignment.iter().any(|k| computed.levels[*k].is_none()) {
            return None;
        }
        let mut all = Residuals::measured(problem, assignment, computed);
        for (j, unknown) in problem.unknowns.iter().enumerate() {
            if let Some(expected) = unknown.expected {
                all.push(x[j] - expected, (0..x.len()).map(|k| f64::from(u8::from(j == k))));
            }
        }
        let finite = all.values.iter().chain(&all.rows).all(|v| v.is_finite());
        finite.then_some(all)
    }

    /// How many facts they are.
    pub(super) fn facts(&self) -> usize {
        self.values.len() - self.eliminated
    }

    /// r.
    pub(super) fn vector(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.values)
    }

    /// ∂r/∂x for `unknowns` unknowns.
    pub(super) fn jacobian(&self, unknowns: usize) -> DMatrix<f64> {
        DMatrix::from_row_slice(self.values.len(), unknowns, &self.rows)
    }
}

/// χ² of an assignment at `x`, where everything is `computed`; infinite where a level is not found.
pub(super) fn misfit(
    problem: &CalibrationProblem,
    assignment: &[usize],
    x: &[f64],
    computed: &Computed,
) -> f64 {
    Residuals::all(problem, assignment, x, computed)
        .map_or(f64::INFINITY, |all| all.values.iter().map(|r| r * r).sum())
}
impl CalibrationProblem {
    /// Facts beyond the number of unknowns; none when there are no more. Facts are measured frequencies, lines, expectations,
    /// and the components of measured shapes less the scale factors that fit them to their levels.
    pub fn degrees_of_freedom(&self, assignment: &[usize], computed: &Computed) -> usize {
        let measured = Residuals::measured(self, assignment, computed).facts();
        let expected = self.unknowns.iter().filter(|u| u.expected.is_some()).count();
        (measured + expected).saturating_sub(self.unknowns.len())
    }
}
