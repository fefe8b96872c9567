//! One implicit step, condensed exactly onto the directions in which contact acts.

use super::along::StepContact;
use super::effective::Effective;
use super::interface::{TravellingInterface, parts};
use super::model::TransientModel;
use super::scheme::Weights;
use super::solver::{Solver, StepFailure};
use super::state::State;
use crate::error::Result;
use faer::Mat;

/// With x = DᵀΔ and S = DᵀA⁻¹D the forces r of a step determine x = DᵀA⁻¹h − b S r, and are those of the laws:
///
/// r − R(r, Dᵀu_t + x, Dᵀv_t + c₁x) = 0,
///
/// as small as the contact, for Newton's method with the consistent unsymmetric tangent. R depends on r itself where friction
/// is set-valued at rest: there the equation says that the point stands still, and r follows from the motion of the whole.
/// Then A Δ = h − b D r. DᵀA⁻¹h is known halfway through the solution with the factors of A, so that r joins h there: one
/// solution a step, and what comes out is that of Newton's method on the whole but for round-off.
#[derive(Debug)]
pub(super) struct CondensedStep<'a> {
    model: &'a TransientModel<'a>,
    weights: Weights,
    effective: Effective,
    contact: StepContact,
}

impl<'a> CondensedStep<'a> {
    /// It fails where the matrix is singular: a part without stiffness and mass.
    pub(super) fn new(model: &'a TransientModel<'a>, weights: Weights) -> Result<Self> {
        let effective = Effective::new(model, &weights)?;
        let mut contact = StepContact::new(model, &weights);
        contact.mix(&effective.seen, &TravellingInterface::new(model));
        Ok(CondensedStep { model, weights, effective, contact })
    }
}

impl Solver for CondensedStep<'_> {
    fn increment(
        &mut self,
        h: &mut Mat<f64>,
        modal: &mut Mat<f64>,
        from: &State,
        to: &mut State,
    ) -> std::result::Result<(), StepFailure> {
        let (model, weights) = (self.model, &self.weights);
        let (effective, contact) = (&mut self.effective, &mut self.contact);
        effective.begin(h.col_as_slice(0), modal);
        if model.travels() {
            contact.mix(&effective.seen, &to.interface);
        }
        for (free, mix) in contact.free.iter_mut().zip(&to.interface.mixes) {
            *free = parts(mix).map(|(column, share)| share * effective.free(column)).sum();
        }
        to.predict_along(weights, &mut contact.predicted);
        contact.solve(model, from, to)?;
        to.answer(&contact.reaction);
        for (mix, r) in to.interface.mixes.iter().zip(&to.reaction).filter(|(_, r)| **r != 0.0) {
            parts(mix).for_each(|(column, share)| effective.push(column, -weights.share() * share * r));
        }
        effective.finish(h.col_as_slice_mut(0), modal);
        Ok(())
    }
}
