//! One implicit step, condensed exactly onto the directions in which contact acts.

use super::effective::Effective;
use super::interface::{Interface, parts};
use super::model::Model;
use super::reaction::Reaction;
use super::scheme::Weights;
use super::state::State;
use super::stepper::{ITERATIONS, ROUND_OFF, Solver, Stuck};
use super::tangent::Tangent;
use crate::error::Result;
use faer::Mat;

/// With x = DᵀΔ and S = DᵀA⁻¹D the step is x − DᵀA⁻¹h + b S r(Dᵀu_t + x, Dᵀv_t + c₁x) = 0, as small as the contact, for
/// Newton's method with the consistent unsymmetric tangent. Then A Δ = h − b D r. DᵀA⁻¹h is known halfway through the
/// solution with the factors of A, so that r joins h there: one solution a step, and what comes out is that of Newton's
/// method on the whole but for round-off.
#[derive(Debug)]
pub(super) struct Condensed<'a> {
    model: &'a Model<'a>,
    weights: Weights,
    effective: Effective,
    contact: Contact,
}

impl<'a> Condensed<'a> {
    /// # Errors
    /// A matrix that is singular: a part without stiffness and mass.
    pub(super) fn new(model: &'a Model<'a>, weights: Weights) -> Result<Self> {
        let effective = Effective::new(model, &weights)?;
        let r = model.n_directions();
        let room = || vec![0.0; r];
        let mut contact = Contact {
            compliance: Mat::zeros(r, r),
            share: weights.share(),
            rate: weights.rate,
            step: weights.step,
            free: room(),
            predicted: [room(), room()],
            reaction: Reaction::new(model),
            tangent: Tangent::new(),
            x: room(),
            last: room(),
            motion: [room(), room()],
            moved: room(),
            rho: room(),
            newton: room(),
            again: room(),
        };
        contact.mix(&effective.seen, &Interface::new(model));
        Ok(Condensed { model, weights, effective, contact })
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
        to.reaction.copy_from_slice(&contact.reaction.force);
        to.bristles.copy_from_slice(&contact.reaction.bristles);
        for (mix, r) in to.interface.mixes.iter().zip(&to.reaction).filter(|(_, r)| **r != 0.0) {
            parts(mix).for_each(|(column, share)| effective.push(column, -weights.share() * share * r));
        }
        effective.finish(h.col_as_slice_mut(0), modal);
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
    tangent: Tangent,
    /// x, and x before the step of Newton's method.
    x: Vec<f64>,
    last: Vec<f64>,
    /// q, q̇ at x.
    motion: [Vec<f64>; 2],
    /// x* − b S r.
    moved: Vec<f64>,
    /// ρ = x − x* + b S r.
    rho: Vec<f64>,
    /// J⁻¹ρ, and with the same J after the step.
    newton: Vec<f64>,
    again: Vec<f64>,
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
    fn solve(&mut self, model: &Model<'_>, from: &State, to: &mut State) -> std::result::Result<(), Stuck> {
        self.moved(&from.reaction);
        std::mem::swap(&mut self.x, &mut self.moved);
        self.evaluate(model, from, to);
        self.residual();
        let mut length = 0.0;
        for iteration in 1..=ITERATIONS {
            to.iterations = iteration;
            self.tangent.set(model, &self.reaction, &self.compliance, (self.share, self.rate));
            self.tangent.solve(&self.rho, &mut self.newton);
            length = longest(&self.newton);
            if !length.is_finite() {
                return Err(Stuck::NotFinite);
            }
            let scale = self.x.iter().chain(&self.free).fold(0.0f64, |m, v| m.max(v.abs()));
            if length <= ROUND_OFF * scale.max(self.farthest()) {
                return Ok(());
            }
            self.last.copy_from_slice(&self.x);
            let mut damping = 1.0;
            let left = loop {
                let stepped = self.last.iter().zip(&self.newton).map(|(x, s)| x - damping * s);
                self.x.iter_mut().zip(stepped).for_each(|(x, next)| *x = next);
                self.evaluate(model, from, to);
                self.residual();
                self.tangent.solve(&self.rho, &mut self.again);
                let left = longest(&self.again);
                if left <= (1.0 - 0.25 * damping) * length || damping < 1e-3 {
                    break left;
                }
                damping *= 0.5;
            };
            // What is left is round-off, and so it is after another step, with this tangent or a softer one.
            let round_off = ROUND_OFF * scale.max(self.farthest());
            if left <= round_off && longest(&self.rho) <= round_off {
                return Ok(());
            }
        }
        // What only round-off keeps from converging is good enough.
        let enough = length <= 1e3 * ROUND_OFF * self.farthest();
        if enough { Ok(()) } else { Err(Stuck::Newton(length)) }
    }

    /// `moved` = x* − b S r for given forces.
    fn moved(&mut self, force: &[f64]) {
        self.moved.copy_from_slice(&self.free);
        for (j, force) in force.iter().enumerate().filter(|(_, f)| **f != 0.0) {
            let factor = self.share * force;
            self.moved.iter_mut().zip(self.compliance.col_as_slice(j)).for_each(|(x, s)| *x -= factor * s);
        }
    }

    /// r at x.
    fn evaluate(&mut self, model: &Model<'_>, from: &State, to: &State) {
        let [place, velocity] = &self.predicted;
        let [q, rate] = &mut self.motion;
        for (i, x) in self.x.iter().enumerate() {
            q[i] = place[i] + x;
            rate[i] = velocity[i] + self.rate * x;
        }
        self.reaction.evaluate(model, [q, rate], to, Some((from, self.step)));
    }

    /// `rho` = x − x* + b S r.
    fn residual(&mut self) {
        let force = std::mem::take(&mut self.reaction.force);
        self.moved(&force);
        self.reaction.force = force;
        let terms = self.x.iter().zip(&self.moved);
        self.rho.iter_mut().zip(terms).for_each(|(rho, (x, moved))| *rho = x - moved);
    }

    /// The largest displacement along a direction.
    fn farthest(&self) -> f64 {
        self.predicted[0].iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()))
    }
}

/// max |x|; not a number when one is not.
fn longest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m: f64, v| if v.is_nan() || m.is_nan() { f64::NAN } else { m.max(v.abs()) })
}
