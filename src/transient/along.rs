//! The contact problem of a step, along the directions in which contact acts.

use super::interface::{TravellingInterface, parts};
use super::model::TransientModel;
use super::reaction::{Reaction, Since, resistance};
use super::scheme::Weights;
use super::solver::{ITERATIONS, ROUND_OFF, StepFailure, UNMATCHED};
use super::state::State;
use super::tangent::Tangent;
use faer::Mat;

/// r − R(r, q, q̇) = 0 with q = q_t + x, q̇ = q̇_t + c₁x and x = x* − b S r.
#[derive(Debug)]
pub(super) struct StepContact {
    /// S = DᵀA⁻¹D \[m/N\].
    compliance: Mat<f64>,
    /// b.
    share: f64,
    /// c₁ \[1/s\].
    rate: f64,
    /// Δt \[s\].
    step: f64,
    /// ρ of each point.
    resistance: Vec<f64>,
    /// x* = DᵀA⁻¹h.
    pub(super) free: Vec<f64>,
    /// q_t, q̇_t: what the motion along the directions would be without Δ.
    pub(super) predicted: [Vec<f64>; 2],
    /// R at the last place evaluated.
    pub(super) reaction: Reaction,
    tangent: Tangent,
    /// r, and r before the step of Newton's method.
    force: Vec<f64>,
    last: Vec<f64>,
    /// x = x* − b S r.
    x: Vec<f64>,
    /// q, q̇ at x.
    motion: [Vec<f64>; 2],
    /// ρ = r − R.
    rho: Vec<f64>,
    /// J⁻¹ρ, and the motion b S J⁻¹ρ that it causes.
    newton: Vec<f64>,
    moved: Vec<f64>,
    /// J⁻¹ρ with the same J after the step.
    again: Vec<f64>,
}

impl StepContact {
    pub(super) fn new(model: &TransientModel<'_>, weights: &Weights) -> Self {
        let r = model.n_directions();
        let zeros = || vec![0.0; r];
        StepContact {
            compliance: Mat::zeros(r, r),
            share: weights.share(),
            rate: weights.rate,
            step: weights.step,
            resistance: vec![1.0; model.points.len()],
            free: zeros(),
            predicted: [zeros(), zeros()],
            reaction: Reaction::new(model),
            tangent: Tangent::new(),
            force: zeros(),
            last: zeros(),
            x: zeros(),
            motion: [zeros(), zeros()],
            rho: zeros(),
            newton: zeros(),
            moved: zeros(),
            again: zeros(),
        }
    }

    /// S from PᵀA⁻¹P.
    pub(super) fn mix(&mut self, seen: &Mat<f64>, at: &TravellingInterface) {
        for (j, right) in at.mixes.iter().enumerate() {
            for (i, left) in at.mixes.iter().enumerate() {
                let entry = |(column, share): (usize, f64)| -> f64 {
                    share * parts(left).map(|(row, own)| own * seen[(row, column)]).sum::<f64>()
                };
                self.compliance[(i, j)] = parts(right).map(entry).sum();
            }
        }
        for (p, own) in self.resistance.iter_mut().enumerate() {
            let tangents = [3 * p + 1, 3 * p + 2].map(|k| self.compliance[(k, k)]);
            *own = resistance(tangents, self.share * self.rate);
        }
    }

    /// Newton's method from the last reaction, with steps halved while they do not bring the next one down (Deuflhard's natural
    /// monotonicity test, in the motion x). Leaves r in `reaction`.
    pub(super) fn solve(
        &mut self,
        model: &TransientModel<'_>,
        from: &State,
        to: &mut State,
    ) -> std::result::Result<(), StepFailure> {
        self.force.copy_from_slice(&from.reaction);
        self.evaluate(model, from, to);
        let mut length = 0.0;
        for iteration in 1..=ITERATIONS {
            to.iterations = iteration;
            self.tangent.set(model, &self.reaction, &self.compliance, (self.share, self.rate));
            self.tangent.solve(&self.rho, &mut self.newton);
            times(&self.compliance, self.share, &self.newton, &mut self.moved);
            length = longest(&self.moved);
            if !length.is_finite() {
                return Err(StepFailure::NotFinite);
            }
            if length <= self.round_off() && self.reaction.mismatch(&self.force) <= UNMATCHED {
                return Ok(());
            }
            self.last.copy_from_slice(&self.force);
            let mut damping = 1.0;
            let left = loop {
                let stepped = self.last.iter().zip(&self.newton).map(|(r, s)| r - damping * s);
                self.force.iter_mut().zip(stepped).for_each(|(r, next)| *r = next);
                self.evaluate(model, from, to);
                self.tangent.solve(&self.rho, &mut self.again);
                times(&self.compliance, self.share, &self.again, &mut self.moved);
                let left = longest(&self.moved);
                if left <= (1.0 - 0.25 * damping) * length || damping < 1e-3 {
                    break left;
                }
                damping *= 0.5;
            };
            // What is left is round-off, and so it is after another step, with this tangent or a softer one.
            times(&self.compliance, self.share, &self.rho, &mut self.moved);
            let round_off = self.round_off();
            if left <= round_off
                && longest(&self.moved) <= round_off
                && self.reaction.mismatch(&self.force) <= UNMATCHED
            {
                return Ok(());
            }
        }
        // What only round-off keeps from converging is good enough.
        let enough =
            length <= 1e3 * self.round_off() && self.reaction.mismatch(&self.force) <= 1e3 * UNMATCHED;
        if enough {
            Ok(())
        } else {
            Err(StepFailure::Newton { length, point: moved_most(&self.moved, model) })
        }
    }

    /// x and R at the iterate of r, and what is left.
    fn evaluate(&mut self, model: &TransientModel<'_>, from: &State, to: &State) {
        times(&self.compliance, -self.share, &self.force, &mut self.x);
        self.x.iter_mut().zip(&self.free).for_each(|(x, free)| *x += free);
        let [place, velocity] = &self.predicted;
        let [q, rate] = &mut self.motion;
        for (i, x) in self.x.iter().enumerate() {
            q[i] = place[i] + x;
            rate[i] = velocity[i] + self.rate * x;
        }
        let (duration, force, resistance) = (self.step, &self.force, &self.resistance);
        let (travel, bristles) = (&from.interface.travel, &from.bristles);
        let approaches = &from.interface.approaches;
        self.reaction.evaluate(
            model,
            [q, rate],
            to.moment(),
            Some(Since { travel, approaches, bristles, duration, force, resistance }),
        );
        let terms = self.force.iter().zip(&self.reaction.force);
        self.rho.iter_mut().zip(terms).for_each(|(rho, (r, answer))| *rho = r - answer);
    }

    /// The part of the motion along the directions that is round-off \[m\].
    fn round_off(&self) -> f64 {
        let all = self.x.iter().chain(&self.free).chain(&self.predicted[0]);
        ROUND_OFF * all.fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()))
    }
}

/// out = factor · S r.
fn times(compliance: &Mat<f64>, factor: f64, r: &[f64], out: &mut [f64]) {
    out.fill(0.0);
    for (j, r) in r.iter().enumerate().filter(|(_, r)| **r != 0.0) {
        out.iter_mut().zip(compliance.col_as_slice(j)).for_each(|(x, s)| *x += factor * r * s);
    }
}

/// max |x|; not a number when one is not.
fn longest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m: f64, v| if v.is_nan() || m.is_nan() { f64::NAN } else { m.max(v.abs()) })
}

/// The contact point with the largest entry among those of its directions.
pub(super) fn moved_most(along: &[f64], model: &TransientModel<'_>) -> Option<usize> {
    let largest = |p: &usize| along[3 * p..3 * p + 3].iter().fold(0.0f64, |m, x| m.max(x.abs()));
    (0..model.points.len()).max_by(|a, b| largest(a).total_cmp(&largest(b)))
}
