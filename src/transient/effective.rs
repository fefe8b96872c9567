//! The matrix of an implicit step, factorised once.

use super::interface::column;
use super::model::TransientModel;
use super::products::Diagonal;
use super::scheme::Weights;
use crate::error::{Error, Result};
use crate::linalg::SparseVector;
use crate::linalg::dense::product;
use crate::linalg::factor::{HalfSolutions, SymbolicFactor, System, UnsymmetricFactor, factorize};
use crate::linalg::lu::Lu;
use crate::linalg::multivector::{combine, gram};
use faer::{Accum, Mat, MatMut};
use rayon::prelude::*;

/// A = (1−α_m)/(β Δt²) M + (1−α_f) c₁ C + (1−α_f) K = A₀ + B E Bᵀ: the modal part of C, E = (1−α_f) c₁ diag(c), apart from
/// the sparse rest with its skew parts, which is factorised: A₀ = H R, H⁻¹ being the half of a solution that goes up the tree and
/// R⁻¹ that which goes down. Where nothing is skew R = J Hᵀ with the pivots J.
///
/// The step solves A Δ = h + B w + P φ, with forces φ along the columns of P that depend on PᵀA⁻¹(h + B w). What is needed
/// of the columns is seen halfway, in y = H⁻¹h: pᵀA₀⁻¹h = (R⁻ᵀp)ᵀy, where R⁻ᵀp has few entries. With G = BᵀA₀⁻¹B, V = BᵀA₀⁻¹P,
/// W = PᵀA₀⁻¹B,
///
/// s = w − (I + E G)⁻¹E (BᵀA₀⁻¹h + G w),   PᵀA⁻¹(h + B w) = PᵀA₀⁻¹h + W s,   A₀Δ = h + P φ + B (s − (I + E G)⁻¹E V φ)
///
/// (Sherman, Morrison & Woodbury, in the form that allows modes without damping).
#[derive(Debug)]
pub(super) struct Effective {
    inverse: Inverse,
    /// Halves of the columns p of P: H⁻¹p, which takes forces in, and R⁻ᵀp, which measures.
    columns: Vec<[SparseVector; 2]>,
    /// PᵀA⁻¹P \[m/N\].
    pub(super) seen: Mat<f64>,
    modal: Option<ModalUpdate>,
    /// y.
    half: Vec<f64>,
}

/// A₀⁻¹.
#[derive(Debug)]
enum Inverse {
    Factor(Box<dyn HalfSolutions>),
    /// With skew parts.
    Unsymmetric(UnsymmetricFactor<f64>),
    /// The diagonal of A₀⁻¹.
    Diagonal(Vec<f64>),
}

impl Inverse {
    fn new(model: &TransientModel<'_>, weights: &Weights) -> Result<Self> {
        if model.skew.is_some() {
            let sum = model.effective(weights);
            let symbolic = SymbolicFactor::new(sum.symbolic())?;
            return Ok(Inverse::Unsymmetric(UnsymmetricFactor::new(&symbolic, sum)?));
        }
        let Some(Diagonal { mass, stiffness, viscous }) = model.products.diagonal() else {
            return Ok(Inverse::Factor(factorize(&model.effective(weights))?));
        };
        let [m, c, k] = weights.effective();
        let entries = mass.iter().zip(stiffness).zip(viscous);
        let sums: Vec<f64> =
            entries.map(|((mass, stiff), viscous)| m * mass + c * viscous + k * stiff).collect();
        if let Some(dof) = sums.iter().position(|sum| *sum == 0.0) {
            return Err(Error::analysis(
                "transient",
                format!("degree of freedom {dof} has neither stiffness nor mass"),
                "Give it one of them, or leave it out",
            ));
        }
        Ok(Inverse::Diagonal(sums.iter().map(|sum| 1.0 / sum).collect()))
    }

    /// y = H⁻¹b.
    fn forward(&self, b: &[f64], y: &mut [f64]) {
        match self {
            Inverse::Factor(factor) => factor.forward(b, y),
            Inverse::Unsymmetric(factor) => copy(&factor.forward(System::Plain, column(b)), y),
            Inverse::Diagonal(_) => y.copy_from_slice(b),
        }
    }

    /// R⁻ᵀb, given b and y = H⁻¹b: J⁻¹y where nothing is skew.
    fn measure(&self, b: &[f64], y: &mut [f64]) {
        match self {
            Inverse::Factor(factor) => factor.pivots(y),
            Inverse::Unsymmetric(factor) => copy(&factor.forward(System::Adjoint, column(b)), y),
            Inverse::Diagonal(values) => {
                y.iter_mut().zip(values).for_each(|(y, value)| *y *= value);
            }
        }
    }

    /// x = R⁻¹y.
    fn backward(&self, y: &mut [f64], x: &mut [f64]) {
        match self {
            Inverse::Factor(factor) => factor.backward(y, x),
            Inverse::Unsymmetric(factor) => {
                copy(&factor.backward(System::Plain, column(y).to_owned()), x);
            }
            Inverse::Diagonal(values) => {
                let scaled = y.iter().zip(values);
                x.iter_mut().zip(scaled).for_each(|(x, (y, value))| *x = y * value);
            }
        }
    }

    /// Both halves of a column.
    fn halves(&self, n: usize, column: &SparseVector) -> [SparseVector; 2] {
        let (mut b, mut y) = (vec![0.0; n], vec![0.0; n]);
        column.add_to(1.0, &mut b);
        self.forward(&b, &mut y);
        let taken = SparseVector::from_dense(&y);
        self.measure(&b, &mut y);
        [taken, SparseVector::from_dense(&y)]
    }
}

#[derive(Debug)]
struct ModalUpdate {
    /// H⁻¹B.
    halves: Mat<f64>,
    /// R⁻ᵀB, where that is not J⁻¹H⁻¹B.
    measures: Option<Mat<f64>>,
    /// G.
    seen: Mat<f64>,
    /// V.
    columns: Mat<f64>,
    /// Wᵀ.
    rows: Mat<f64>,
    /// (I + E G)⁻¹E V.
    answers: Mat<f64>,
    /// The diagonal of E.
    weights: Vec<f64>,
    /// I + E G.
    small: Lu<f64>,
    /// BᵀA₀⁻¹h + V φ.
    motion: Mat<f64>,
    /// s, then what B is multiplied by.
    factors: Mat<f64>,
    /// J⁻¹y.
    measured: Vec<f64>,
}

impl ModalUpdate {
    /// (I + E G)⁻¹E x.
    fn answer(&self, x: &Mat<f64>) -> Mat<f64> {
        self.small.solve(Mat::from_fn(x.nrows(), x.ncols(), |i, j| self.weights[i] * x[(i, j)]))
    }

    fn new(
        basis: &Mat<f64>,
        weights: Vec<f64>,
        inverse: &Inverse,
        columns: &[[SparseVector; 2]],
    ) -> ModalUpdate {
        let (n, m) = (basis.nrows(), basis.ncols());
        let mut halves = Mat::zeros(n, m);
        let mut measures = Mat::zeros(n, m);
        let mut half = vec![0.0; n];
        for j in 0..m {
            inverse.forward(basis.col_as_slice(j), &mut half);
            halves.col_as_slice_mut(j).copy_from_slice(&half);
            inverse.measure(basis.col_as_slice(j), &mut half);
            measures.col_as_slice_mut(j).copy_from_slice(&half);
        }
        let seen = gram(measures.as_ref(), halves.as_ref());
        let small = Mat::from_fn(m, m, |i, j| weights[i] * seen[(i, j)] + if i == j { 1.0 } else { 0.0 });
        let along = |side: usize, of: &Mat<f64>| {
            Mat::from_fn(m, columns.len(), |i, p| columns[p][side].dot(of.col_as_slice(i)))
        };
        let rows = along(1, &halves);
        let (columns, measures) = match inverse {
            Inverse::Unsymmetric(_) => (along(0, &measures), Some(measures)),
            _ => (rows.clone(), None),
        };
        let (motion, factors) = (Mat::zeros(m, 1), Mat::zeros(m, 1));
        let (answers, measured) = (Mat::zeros(0, 0), half);
        let small = Lu::new(small);
        let mut update = ModalUpdate {
            halves,
            measures,
            seen,
            columns,
            rows,
            answers,
            weights,
            small,
            motion,
            factors,
            measured,
        };
        update.answers = update.answer(&update.columns);
        update
    }
}

impl Effective {
    pub(super) fn new(model: &TransientModel<'_>, weights: &Weights) -> Result<Self> {
        let [_, c, _] = weights.effective();
        let n = model.n();
        let inverse = Inverse::new(model, weights)?;
        let columns: Vec<[SparseVector; 2]> =
            model.columns.par_iter().map(|column| inverse.halves(n, column)).collect();
        let mut dense = vec![0.0; n];
        let mut seen = Mat::zeros(columns.len(), columns.len());
        for (j, [taken, _]) in columns.iter().enumerate() {
            taken.add_to(1.0, &mut dense);
            columns.iter().enumerate().for_each(|(i, [_, measure])| seen[(i, j)] = measure.dot(&dense));
            taken.indices().iter().for_each(|i| dense[*i] = 0.0);
        }
        let modal = model.damping.modal.as_ref().map(|modal| {
            let weights = modal.coefficients.iter().map(|own| c * own).collect();
            ModalUpdate::new(&modal.basis, weights, &inverse, &columns)
        });
        if let Some(update) = &modal {
            seen -= product(update.rows.transpose(), update.answers.as_ref());
        }
        Ok(Effective { inverse, columns, seen, modal, half: vec![0.0; n] })
    }

    /// Goes half of the way from h + B w; `w` is empty without modal damping.
    pub(super) fn begin(&mut self, h: &[f64], w: &Mat<f64>) {
        self.inverse.forward(h, &mut self.half);
        if let Some(update) = &mut self.modal {
            update.motion = match &update.measures {
                Some(measures) => gram(measures.as_ref(), column(&self.half)),
                None => {
                    update.measured.copy_from_slice(&self.half);
                    self.inverse.measure(h, &mut update.measured);
                    gram(update.halves.as_ref(), column(&update.measured))
                }
            };
            update.factors = w - update.answer(&(&update.motion + product(update.seen.as_ref(), w.as_ref())));
        }
    }

    /// An entry of PᵀA⁻¹(h + B w).
    pub(super) fn free(&self, column: usize) -> f64 {
        let motion = self.columns[column][1].dot(&self.half);
        match &self.modal {
            Some(update) => {
                let share = update.rows.col_as_slice(column).iter().zip(update.factors.col_as_slice(0));
                motion + share.map(|(v, s)| v * s).sum::<f64>()
            }
            None => motion,
        }
    }

    /// Adds a force along a column of P.
    pub(super) fn push(&mut self, column: usize, force: f64) {
        self.columns[column][0].add_to(force, &mut self.half);
        if let Some(update) = &mut self.modal {
            for i in 0..update.weights.len() {
                update.motion[(i, 0)] += force * update.columns[(i, column)];
                update.factors[(i, 0)] -= force * update.answers[(i, column)];
            }
        }
    }

    /// Goes the rest of the way: Δ, and BᵀΔ in `w`.
    pub(super) fn finish(&mut self, increment: &mut [f64], w: &mut Mat<f64>) {
        if let Some(update) = &self.modal {
            let half = MatMut::from_column_major_slice_mut(&mut self.half, update.halves.nrows(), 1);
            combine(half, Accum::Add, update.halves.as_ref(), update.factors.as_ref(), 1.0);
            *w = &update.motion + product(update.seen.as_ref(), update.factors.as_ref());
        }
        self.inverse.backward(&mut self.half, increment);
    }
}

fn copy(of: &Mat<f64>, to: &mut [f64]) {
    to.copy_from_slice(of.col_as_slice(0));
}
