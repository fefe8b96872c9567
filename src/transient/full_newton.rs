//! One implicit step by Newton's method on the whole system: slow and plain, to compare with.

use super::model::Model;
use super::reaction::Reaction;
use super::scheme::Weights;
use super::state::State;
use super::stepper::{ITERATIONS, ROUND_OFF, Solver, Stuck};
use crate::linalg::SparseMatrix;
use crate::linalg::sparse::{add_scaled, entry, multiply_vector};
use crate::linalg::tall::{expand, gram};
use faer::Mat;
use faer::linalg::solvers::Solve;

/// A₀Δ + B E BᵀΔ + b D r(u_t + Δ, v_t + c₁Δ) − h − B w = 0 with the tangent A₀ + b D (∂r/∂q + c₁ ∂r/∂q̇) Dᵀ. The modal
/// part B E Bᵀ, dense but small beside A₀, is left to the iteration.
#[derive(Debug)]
pub(super) struct FullNewton<'a> {
    model: &'a Model<'a>,
    weights: Weights,
    linear: SparseMatrix,
    reaction: Reaction,
}

impl<'a> FullNewton<'a> {
    pub(super) fn new(model: &'a Model<'a>, weights: Weights) -> Self {
        FullNewton { model, weights, linear: model.effective(&weights), reaction: Reaction::new(model) }
    }

    /// The residual at Δ, without B w.
    fn residual(&mut self, delta: &[f64], h: &[f64], at: &[Vec<f64>; 2], ends: [&State; 2]) -> Vec<f64> {
        let model = self.model;
        let [from, to] = ends;
        let mut along = vec![0.0; model.n_directions()];
        to.interface.motions(model, delta, &mut along);
        let q: Vec<f64> = along.iter().zip(&at[0]).map(|(x, p)| p + x).collect();
        let rate: Vec<f64> = along.iter().zip(&at[1]).map(|(x, v)| v + self.weights.rate * x).collect();
        self.reaction.evaluate(model, [&q, &rate], to, Some((from, self.weights.step)));
        let mut rho = multiply_vector(&self.linear, delta);
        rho.iter_mut().zip(h).for_each(|(rho, h)| *rho -= h);
        to.interface.add_reactions(model, self.weights.share(), &self.reaction.force, &mut rho);
        rho
    }
}

impl Solver for FullNewton<'_> {
    fn increment(
        &mut self,
        h: &mut Mat<f64>,
        modal: &mut Mat<f64>,
        from: &State,
        to: &mut State,
    ) -> Result<(), Stuck> {
        let (model, weights) = (self.model, self.weights);
        let n = model.n();
        let mut at = [0, 1].map(|_| vec![0.0; model.n_directions()]);
        to.predict_along(&weights, &mut at);
        let mut force = h.col_as_slice(0).to_vec();
        if let Some(own) = &model.damping.modal {
            let part = expand(own.basis.as_ref(), modal.as_ref());
            force.iter_mut().zip(part.col_as_slice(0)).for_each(|(h, p)| *h += p);
        }
        let [_, c, _] = weights.effective();
        // From where the last acceleration would lead.
        let mut delta: Vec<f64> = from.motion.col_as_slice(2).iter().map(|a| a / weights.inertia).collect();
        let mut length = 0.0;
        for _ in 0..ITERATIONS {
            let mut rho = self.residual(&delta, &force, &at, [from, to]);
            let column = Mat::from_fn(n, 1, |i, _| delta[i]);
            if let Some(own) = &model.damping.modal {
                let mut share = gram(own.basis.as_ref(), column.as_ref());
                own.coefficients.iter().enumerate().for_each(|(i, own)| share[(i, 0)] *= c * own);
                let part = expand(own.basis.as_ref(), share.as_ref());
                rho.iter_mut().zip(part.col_as_slice(0)).for_each(|(r, p)| *r += p);
            }
            let entries = self.reaction.tangent(model, &to.interface, weights.rate).into_iter();
            let entries: Vec<_> = entries.map(|(i, j, v)| entry(i, j, weights.share() * v)).collect();
            let contact =
                SparseMatrix::try_new_from_triplets(n, n, &entries).map_err(|_| Stuck::NotFinite)?;
            let tangent = add_scaled(&[(1.0, &self.linear), (1.0, &contact)]);
            let lu = tangent.sp_lu().map_err(|_| Stuck::NotFinite)?;
            let step = lu.solve(Mat::from_fn(n, 1, |i, _| rho[i]));
            length = step.norm_max();
            if !length.is_finite() {
                return Err(Stuck::NotFinite);
            }
            (0..n).for_each(|i| delta[i] -= step[(i, 0)]);
            let scale = from.motion.col(0).norm_max().max(column.norm_max());
            if length <= ROUND_OFF * scale {
                self.residual(&delta, &force, &at, [from, to]);
                to.reaction.copy_from_slice(&self.reaction.force);
                to.bristles.copy_from_slice(&self.reaction.bristles);
                h.col_as_slice_mut(0).copy_from_slice(&delta);
                if let Some(own) = &model.damping.modal {
                    *modal = gram(own.basis.as_ref(), h.as_ref());
                }
                return Ok(());
            }
        }
        Err(Stuck::Newton(length))
    }
}
