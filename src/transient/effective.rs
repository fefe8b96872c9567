//! The matrix of an implicit step, factorised once.

use super::diagonal::Diagonal;
use super::model::Model;
use super::scheme::Weights;
use crate::error::{Error, Result};
use crate::linalg::SymmetricFactor;
use crate::linalg::factor::factorize;
use crate::linalg::tall::{combine, expand, gram};
use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Accum, Mat, MatMut};

/// A = (1−α_m)/(β Δt²) M + (1−α_f) c₁ C + (1−α_f) K, with the modal part of C as an update of low rank:
/// A = A₀ + B E Bᵀ, E = (1−α_f) c₁ diag(c), so A⁻¹h = y − X (I + E G)⁻¹E Bᵀy with y = A₀⁻¹h, X = A₀⁻¹B, G = BᵀX
/// (Sherman, Morrison & Woodbury, in the form that allows modes without damping).
#[derive(Debug)]
pub(super) struct Effective<'a> {
    inverse: Inverse,
    modal: Option<ModalUpdate<'a>>,
}

/// A₀⁻¹.
#[derive(Debug)]
enum Inverse {
    Factor(Box<dyn SymmetricFactor>),
    /// The diagonal of A₀⁻¹.
    Diagonal(Vec<f64>),
}

impl Inverse {
    fn new(model: &Model<'_>, weights: &Weights) -> Result<Self> {
        let Some(Diagonal { mass, stiffness, viscous }) = &model.diagonal else {
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

    fn apply(&self, mut x: MatMut<'_, f64>) {
        match self {
            Inverse::Factor(factor) => factor.solve_in_place(x),
            Inverse::Diagonal(values) => {
                for k in 0..x.ncols() {
                    x.as_mut().col_mut(k).iter_mut().zip(values).for_each(|(x, value)| *x *= value);
                }
            }
        }
    }
}

#[derive(Debug)]
struct ModalUpdate<'a> {
    basis: &'a Mat<f64>,
    /// X.
    responses: Mat<f64>,
    /// G.
    seen: Mat<f64>,
    /// The diagonal of E.
    weights: Vec<f64>,
    /// I + E G.
    small: PartialPivLu<f64>,
}

impl ModalUpdate<'_> {
    /// (I + E G)⁻¹E x.
    fn answer(&self, x: &Mat<f64>) -> Mat<f64> {
        self.small.solve(Mat::from_fn(x.nrows(), x.ncols(), |i, j| self.weights[i] * x[(i, j)]))
    }
}

impl<'a> Effective<'a> {
    pub(super) fn new(model: &Model<'a>, weights: &Weights) -> Result<Self> {
        let [_, c, _] = weights.effective();
        let inverse = Inverse::new(model, weights)?;
        let modal = model.damping.modal.as_ref().map(|modal| {
            let mut responses = modal.basis.clone();
            inverse.apply(responses.as_mut());
            let seen = gram(modal.basis.as_ref(), responses.as_ref());
            let weights: Vec<f64> = modal.coefficients.iter().map(|own| c * own).collect();
            let small = Mat::from_fn(seen.nrows(), seen.ncols(), |i, j| {
                weights[i] * seen[(i, j)] + if i == j { 1.0 } else { 0.0 }
            });
            ModalUpdate { basis: &modal.basis, responses, seen, weights, small: small.partial_piv_lu() }
        });
        Ok(Effective { inverse, modal })
    }

    /// h ← A⁻¹(h + B w) of one column; Bᵀ of the result is left in `w`, which is empty without modal damping.
    pub(super) fn solve(&self, mut h: MatMut<'_, f64>, w: &mut Mat<f64>) {
        self.inverse.apply(h.as_mut());
        if let Some(update) = &self.modal {
            let seen = gram(update.basis.as_ref(), h.as_ref());
            let part = update.answer(&(&seen + &update.seen * &*w));
            let factors = &*w - part;
            combine(h, Accum::Add, update.responses.as_ref(), factors.as_ref(), 1.0);
            *w = seen + &update.seen * factors;
        }
    }

    /// A⁻¹D of dense columns.
    pub(super) fn responses(&self, mut d: Mat<f64>) -> Mat<f64> {
        self.inverse.apply(d.as_mut());
        if let Some(update) = &self.modal {
            let part = update.answer(&gram(update.basis.as_ref(), d.as_ref()));
            d -= expand(update.responses.as_ref(), part.as_ref());
        }
        d
    }

    /// Bᵀx, m × columns; nothing without modal damping.
    pub(super) fn modal_share(&self, x: &Mat<f64>) -> Mat<f64> {
        match &self.modal {
            Some(update) => gram(update.basis.as_ref(), x.as_ref()),
            None => Mat::zeros(0, x.ncols()),
        }
    }
}
