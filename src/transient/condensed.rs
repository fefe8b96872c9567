//! One implicit step, condensed exactly onto the directions in which contact acts.

use super::effective::Effective;
use super::interface::{Interface, parts};
use super::model::Model;
use super::reaction::Reaction;
use super::scheme::Weights;
use super::state::State;
use super::stepper::{ITERATIONS, ROUND_OFF, Solver, Stuck};
use crate::error::Result;
use crate::linalg::sparse::dense_columns;
use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};

/// With x = DᵀΔ and S = DᵀA⁻¹D the step is x − DᵀA⁻¹h + b S r(Dᵀu_t + x, Dᵀv_t + c₁x) = 0, as small as the contact, for
/// Newton's method with the consistent unsymmetric tangent. Then Δ = A⁻¹h − b A⁻¹D r: one solution with A a step, and
/// what comes out is that of Newton's method on the whole but for round-off.
#[derive(Debug)]
pub(super) struct Condensed<'a> {
    model: &'a Model<'a>,
    weights: Weights,
    effective: Effective<'a>,
    /// A⁻¹P, n × columns.
    responses: Mat<f64>,
    /// BᵀA⁻¹P.
    modal_responses: Mat<f64>,
    /// PᵀA⁻¹P \[m/N\].
    seen: Mat<f64>,
    contact: Contact,
}

impl<'a> Condensed<'a> {
    /// # Errors
    /// A matrix that is singular: a part without stiffness and mass.
    pub(super) fn new(model: &'a Model<'a>, weights: Weights) -> Result<Self> {
        let effective = Effective::new(model, &weights)?;
        let (r, columns) = (model.n_directions(), model.columns.len());
        let responses = effective.responses(dense_columns(model.n(), &model.columns));
        let seen = Mat::from_fn(columns, columns, |i, j| model.columns[i].dot(responses.col_as_slice(j)));
        let mut contact = Contact {
            compliance: Mat::zeros(r, r),
            share: weights.share(),
            rate: weights.rate,
            step: weights.step,
            free: vec![0.0; r],
            predicted: [vec![0.0; r], vec![0.0; r]],
            reaction: Reaction::new(model),
        };
        contact.mix(&seen, &Interface::new(model));
        let modal_responses = effective.modal_share(&responses);
        Ok(Condensed { model, weights, effective, responses, modal_responses, seen, contact })
    }
}

impl Solver for Condensed<'_> {
    fn increment(
        &mut self,
        h: &mut Mat<f64>,
        modal: &mut Mat<f64>,
        from: &State,
        to: &mut State,
    ) -> std::result::Result<(), Stuck> {
        let (model, weights) = (self.model, &self.weights);
        self.effective.solve(h.as_mut(), modal);
        let contact = &mut self.contact;
        if model.travels() {
            contact.mix(&self.seen, &to.interface);
        }
        to.interface.motions(model, h.col_as_slice(0), &mut contact.free);
        to.predict_along(weights, &mut contact.predicted);
        contact.solve(model, from, to)?;
        to.reaction.copy_from_slice(&contact.reaction.force);
        to.bristles.copy_from_slice(&contact.reaction.bristles);
        let increment = h.col_as_slice_mut(0);
        for (mix, r) in to.interface.mixes.iter().zip(&to.reaction).filter(|(_, r)| **r != 0.0) {
            for (column, share) in parts(mix) {
                let factor = -weights.share() * share * r;
                let response = self.responses.col_as_slice(column);
                increment.iter_mut().zip(response).for_each(|(x, w)| *x += factor * w);
                (0..modal.nrows()).for_each(|i| modal[(i, 0)] += factor * self.modal_responses[(i, column)]);
            }
        }
        Ok(())
    }
}

/// The step along the directions.
#[derive(Debug)]
struct Contact {
    /// S = DᵀA⁻¹D \[m/N\].
    compliance: Mat<f64>,
    /// b.
    share: f64,
    /// c₁ \[1/s\].
    rate: f64,
    /// Δt \[s\].
    step: f64,
    /// x* = DᵀA⁻¹h.
    free: Vec<f64>,
    /// q_t, q̇_t: what the motion along the directions would be without Δ.
    predicted: [Vec<f64>; 2],
    /// The forces at the last place looked at.
    reaction: Reaction,
}

impl Contact {
    /// S from PᵀA⁻¹P.
    fn mix(&mut self, seen: &Mat<f64>, at: &Interface) {
        for (j, right) in at.mixes.iter().enumerate() {
            for (i, left) in at.mixes.iter().enumerate() {
                let entry = |(column, share): (usize, f64)| -> f64 {
                    share * parts(left).map(|(row, own)| own * seen[(row, column)]).sum::<f64>()
                };
                self.compliance[(i, j)] = parts(right).map(entry).sum();
            }
        }
    }

    /// Newton's method from where the last reaction would lead, with steps halved while they do not bring the next one down
    /// (Deuflhard's natural monotonicity test). Leaves r in `reaction`.
    fn solve(&mut self, model: &Model<'_>, from: &State, to: &State) -> std::result::Result<(), Stuck> {
        let mut x = self.moved(&from.reaction);
        let mut rho = self.residual(model, &x, from, to);
        let mut length = 0.0;
        for _ in 0..ITERATIONS {
            let tangent = Tangent::new(model, self);
            let step = tangent.solve(&rho);
            length = longest(&step);
            if !length.is_finite() {
                return Err(Stuck::NotFinite);
            }
            let scale = x.iter().chain(&self.free).fold(0.0f64, |m, v| m.max(v.abs()));
            if length <= ROUND_OFF * scale.max(self.farthest()) {
                return Ok(());
            }
            let mut damping = 1.0;
            loop {
                let next: Vec<f64> = x.iter().zip(&step).map(|(x, s)| x - damping * s).collect();
                let there = self.residual(model, &next, from, to);
                let again = longest(&tangent.solve(&there));
                if again <= (1.0 - 0.25 * damping) * length || damping < 1e-3 {
                    (x, rho) = (next, there);
                    break;
                }
                damping *= 0.5;
            }
        }
        // What only round-off keeps from converging is good enough.
        let enough = length <= 1e3 * ROUND_OFF * self.farthest();
        if enough { Ok(()) } else { Err(Stuck::Newton(length)) }
    }

    /// x* − b S r for given forces.
    fn moved(&self, force: &[f64]) -> Vec<f64> {
        let mut x = self.free.clone();
        for (j, force) in force.iter().enumerate().filter(|(_, f)| **f != 0.0) {
            let factor = self.share * force;
            x.iter_mut().zip(self.compliance.col_as_slice(j)).for_each(|(x, s)| *x -= factor * s);
        }
        x
    }

    /// x − x* + b S r(x), whose r is left in `reaction`.
    fn residual(&mut self, model: &Model<'_>, x: &[f64], from: &State, to: &State) -> Vec<f64> {
        let [place, velocity] = &self.predicted;
        let q: Vec<f64> = x.iter().zip(place).map(|(x, p)| p + x).collect();
        let rate: Vec<f64> = x.iter().zip(velocity).map(|(x, v)| v + self.rate * x).collect();
        self.reaction.evaluate(model, [&q, &rate], to, Some((from, self.step)));
        let moved = self.moved(&self.reaction.force);
        x.iter().zip(moved).map(|(x, moved)| x - moved).collect()
    }

    /// The largest displacement along a direction.
    fn farthest(&self) -> f64 {
        self.predicted[0].iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()))
    }
}

/// J = I + b S (∂r/∂q + c₁ ∂r/∂q̇), whose columns differ from those of I only where something acts: those are solved for,
/// the others follow.
struct Tangent {
    /// Where something acts.
    active: Vec<usize>,
    /// The columns of J − I there.
    columns: Mat<f64>,
    small: PartialPivLu<f64>,
}

impl Tangent {
    fn new(model: &Model<'_>, contact: &Contact) -> Self {
        let (active, columns) =
            contact.reaction.slopes(model, &contact.compliance, contact.share, contact.rate);
        let m = active.len();
        let small = Mat::from_fn(m, m, |i, j| columns[(active[i], j)] + if i == j { 1.0 } else { 0.0 });
        Tangent { active, columns, small: small.partial_piv_lu() }
    }

    /// J⁻¹ρ.
    fn solve(&self, rho: &[f64]) -> Vec<f64> {
        let some = self.small.solve(Mat::from_fn(self.active.len(), 1, |i, _| rho[self.active[i]]));
        let mut step = rho.to_vec();
        for j in 0..self.active.len() {
            let factor = some[(j, 0)];
            step.iter_mut().zip(self.columns.col_as_slice(j)).for_each(|(s, c)| *s -= factor * c);
        }
        self.active.iter().enumerate().for_each(|(j, place)| step[*place] = some[(j, 0)]);
        step
    }
}

/// max |x|; not a number when one is not.
fn longest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m: f64, v| if v.is_nan() || m.is_nan() { f64::NAN } else { m.max(v.abs()) })
}
