//! How mode shapes, and what a test sees of them, turn with the unknowns.

use super::neighbours::Change;
use crate::calibration::Span;
use crate::error::{Error, Result};
use crate::linalg::SparseVector;
use crate::linalg::multivector::{combine, expand, gram};
use crate::linalg::sparse::times;
use crate::modal::{RealModes, ShiftedStiffness};
use crate::system::Structure;
use faer::{Accum, Mat};
use nalgebra::DMatrix;

/// The iteration ends when it changes nothing by more than this part.
const CONVERGED: f64 = 1e-12;
/// The most steps of the iteration.
const MOST_STEPS: usize = 200;
/// Modes whose eigenvalues differ by less than this part are as good as one level.
const SAME: f64 = 1e-9;

/// Sensors of a test on a structure.
pub struct Observation {
    /// Each measured degree of freedom as a form of the structure's own.
    pub forms: Vec<SparseVector>,
    /// K − σM, factorised.
    pub factor: ShiftedStiffness,
}

/// The modes of a structure that a test sees.
pub struct ObservedModes<'a> {
    /// M and K.
    pub structure: &'a Structure,
    /// All modes up to a frequency.
    pub modes: &'a RealModes,
    /// Their sensors.
    pub observation: &'a Observation,
}

impl ObservedModes<'_> {
    /// Shapes of the modes `level` at the sensors, n_sensors × n_modes.
    pub fn motions(&self, level: &[usize]) -> DMatrix<f64> {
        self.observe(&self.observation.forms, level.iter().map(|k| self.modes.shapes.col_as_slice(*k)))
    }

    fn observe<'b>(
        &self,
        forms: &[SparseVector],
        columns: impl ExactSizeIterator<Item = &'b [f64]>,
    ) -> DMatrix<f64> {
        let count = columns.len();
        let values: Vec<f64> = columns.flat_map(|x| forms.iter().map(|form| form.dot(x))).collect();
        DMatrix::from_vec(forms.len(), count, values)
    }

    /// The motions of each of `levels` and their slopes by the `changes`; an unknown without one moves nothing.
    ///
    /// # Errors
    /// Slopes that do not converge.
    pub fn spans(&self, levels: &[&Vec<usize>], changes: &[Option<Change>]) -> Result<Vec<Span>> {
        let all: Vec<(usize, &[usize])> =
            levels.iter().flat_map(|level| level.iter().map(|k| (*k, &level[..]))).collect();
        let by = |change: &Change| {
            let turned = self.turned(&all, change)?;
            let moved = self.observe(&self.observation.forms, (0..all.len()).map(|c| turned.col_as_slice(c)));
            let shapes = all.iter().map(|(k, _)| self.modes.shapes.col_as_slice(*k));
            Ok(moved + self.observe(&change.seen, shapes))
        };
        let slopes: Vec<Option<DMatrix<f64>>> =
            changes.iter().map(|change| change.as_ref().map(by).transpose()).collect::<Result<_>>()?;
        let mut first = 0;
        let span = |level: &&Vec<usize>| {
            let (from, count) = (first, level.len());
            first += count;
            let own = |slope: &Option<DMatrix<f64>>| match slope {
                Some(slope) => slope.columns(from, count).into_owned(),
                None => DMatrix::zeros(self.observation.forms.len(), count),
            };
            Span { motions: self.motions(level), slopes: slopes.iter().map(own).collect() }
        };
        Ok(levels.iter().map(span).collect())
    }

    /// ∂φ_i of each mode i by an unknown, less what of it lies in its level: v with ΦᵀMv = 0 on the level's modes Φ and
    ///
    /// (K − λ_i M) v = −(I − MΦΦᵀ)(∂K − λ_i ∂M) φ_i.
    ///
    /// On the other computed modes it is φ_k φ_kᵀ(…)/(λ_i − λ_k) (Fox and Kapoor, AIAA J. 6 (1968) 2426); the modes of a
    /// double level need none of each other, so that their span turns by v although they themselves may jump (Ojalvo, AIAA J.
    /// 26 (1988) 361). What lies beyond the computed modes is solved for by conjugate gradients, M-orthogonal to the computed
    /// modes, with the factors of K − σM that found them as preconditioner: there both are positive definite, and the eigenvalues
    /// of (K − σM)⁻¹(K − λ_i M), (λ − λ_i)/(λ − σ), gather at 1.
    /// Fails where the iteration does not converge.
    fn turned(&self, wanted: &[(usize, &[usize])], change: &Change) -> Result<Mat<f64>> {
        let ObservedModes { structure, modes, observation } = self;
        let (n, shapes) = (modes.shapes.nrows(), modes.shapes.as_ref());
        let lambda: Vec<f64> = wanted.iter().map(|(k, _)| modes.eigenvalues[*k]).collect();
        let own = Mat::from_fn(n, wanted.len(), |i, c| modes.shapes[(i, wanted[c].0)]);
        let less = |mut a: Mat<f64>, b: Mat<f64>| {
            (0..lambda.len()).for_each(|c| (0..n).for_each(|i| a[(i, c)] -= lambda[c] * b[(i, c)]));
            a
        };
        let mut force = less(times(&change.stiffness, own.as_ref()), times(&change.mass, own.as_ref()));
        (0..lambda.len()).for_each(|c| force.col_mut(c).iter_mut().for_each(|f| *f = -*f));
        let inertia = times(&structure.mass, shapes);
        let share = gram(shapes, force.as_ref());
        let part = |k: usize, c: usize| {
            let apart = modes.eigenvalues[k] - lambda[c];
            let same = wanted[c].1.contains(&k) || apart.abs() <= SAME * lambda[c].abs();
            if same { 0.0 } else { share[(k, c)] / apart }
        };
        let near = expand(shapes, Mat::from_fn(modes.len(), wanted.len(), part).as_ref());
        combine(force.as_mut(), Accum::Add, inertia.as_ref(), share.as_ref(), -1.0);
        let mut far = Mat::<f64>::zeros(n, wanted.len());
        let dots = |a: &Mat<f64>, b: &Mat<f64>| -> Vec<f64> {
            (0..lambda.len()).map(|c| a.col(c).transpose() * b.col(c)).collect()
        };
        let precondition = |residual: &Mat<f64>| {
            let mut step = residual.clone();
            observation.factor.factor.solve_in_place(step.as_mut());
            let share = gram(inertia.as_ref(), step.as_ref());
            combine(step.as_mut(), Accum::Add, shapes, share.as_ref(), -1.0);
            step
        };
        let mut residual = force;
        let mut step = precondition(&residual);
        let mut direction = step.clone();
        let mut energy = dots(&residual, &step);
        for _ in 0..MOST_STEPS {
            let size = |c: usize| far.col(c).norm_l2() + near.col(c).norm_l2();
            let left = |c: usize| step.col(c).norm_l2() > CONVERGED * size(c).max(f64::MIN_POSITIVE);
            if !(0..lambda.len()).any(left) {
                return Ok(near + far);
            }
            let applied = less(
                times(&structure.stiffness, direction.as_ref()),
                times(&structure.mass, direction.as_ref()),
            );
            let curvature = dots(&direction, &applied);
            for c in 0..lambda.len() {
                let length = if curvature[c] > 0.0 { energy[c] / curvature[c] } else { 0.0 };
                for i in 0..n {
                    far[(i, c)] += length * direction[(i, c)];
                    residual[(i, c)] -= length * applied[(i, c)];
                }
            }
            step = precondition(&residual);
            let next = dots(&residual, &step);
            for c in 0..lambda.len() {
                let turn = if energy[c] > 0.0 { next[c] / energy[c] } else { 0.0 };
                (0..n).for_each(|i| direction[(i, c)] = step[(i, c)] + turn * direction[(i, c)]);
            }
            energy = next;
        }
        let found = format!("conjugate gradients have not converged in {MOST_STEPS} steps");
        let help = "Compute more modes than are measured: raise `below` or `count` of the real modes";
        Err(Error::analysis("derivatives of mode shapes", found, help))
    }
}
