//! One implicit step of a reduced model with more contact points than coordinates.

use super::along::moved_most;
use super::interface::parts;
use super::model::TransientModel;
use super::reaction::{Reaction, Since, resistance};
use super::scheme::Weights;
use super::slopes::PointSlopes;
use super::solver::{ITERATIONS, Solver, StepFailure, UNMATCHED};
use super::state::State;
use crate::linalg::lu::Lu;
use crate::linalg::multivector::gram;
use faer::Mat;
use rayon::prelude::*;
use std::sync::Arc;

/// A step of Newton's below this part of the position is the last one. It is taken: beside a steady state that is 1e8 times as large, a small
/// motion would otherwise keep the acceleration that it had.
const SETTLED: f64 = 1e-12;
/// The part of a step that its next one with the same tangent may have before the tangent is made anew.
const SLOW: f64 = 0.3;

/// With x = DᵀV Δ the step solves
///
/// A Δ + b VᵀD r = h,   r = R(r, q_t + x, q̇_t + c₁ x)
///
/// by Newton's method on Δ. About an iterate r is R + (I − ∂R/∂r)⁻¹(…) point by point: ∂R/∂r, of friction that is set-valued at rest, couples
/// no two points. So the tangent
///
/// A + b VᵀD (I − ∂R/∂r)⁻¹(∂R/∂q + c₁ ∂R/∂q̇) DᵀV
///
/// is as small as Δ. It serves as long as steps with it converge fast: it changes where points open or stick, and those are few in a step.
#[derive(Debug)]
pub(super) struct ReducedStep<'a> {
    model: &'a TransientModel<'a>,
    basis: &'a Mat<f64>,
    weights: Weights,
    /// A, and A with the imported terms of low rank.
    linear: Mat<f64>,
    coupled: Mat<f64>,
    /// With the derivatives that it was made of.
    tangent: Option<(Arc<PointSlopes>, Lu<f64>)>,
    reaction: Reaction,
    /// ρ of each point.
    resistance: Vec<f64>,
    /// q_t, q̇_t.
    predicted: [Vec<f64>; 2],
    at: Iterate,
    last: Iterate,
    /// q, q̇.
    motion: [Vec<f64>; 2],
    /// r at the iterate, friction at rest eliminated.
    answer: Vec<f64>,
    /// Newton's step from the last iterate.
    step: Mat<f64>,
    /// h − A Δ − b VᵀD r at the iterate, then Newton's step from there.
    again: Mat<f64>,
    /// DᵀV of the step in `again`, and of that in `step`.
    moved: Mat<f64>,
    way: Mat<f64>,
}

#[derive(Debug, Clone)]
struct Iterate {
    /// Δ.
    delta: Vec<f64>,
    /// x.
    along: Vec<f64>,
    /// r.
    force: Vec<f64>,
}

impl<'a> ReducedStep<'a> {
    pub(super) fn new(model: &'a TransientModel<'a>, basis: &'a Mat<f64>, weights: Weights) -> Self {
        let (n, directions) = (model.n(), model.n_directions());
        let sum = model.effective(&weights);
        let mut linear = Mat::<f64>::zeros(n, n);
        for j in 0..n {
            sum.row_idx_of_col(j).zip(sum.val_of_col(j)).for_each(|(i, v)| linear[(i, j)] += v);
        }
        let factor = weights.share() * weights.rate;
        let compliance = |p: usize| {
            [1, 2].map(|c| {
                let t = model.columns[3 * p + c];
                let seen = |i: usize| t.dot(basis.col_as_slice(i));
                (0..n).map(|i| seen(i).powi(2) / linear[(i, i)].abs()).sum::<f64>()
            })
        };
        let own = |p: usize| {
            if model.points[p].law.is_set_valued() { resistance(compliance(p), factor) } else { 1.0 }
        };
        let resistance = (0..model.points.len()).into_par_iter().map(own).collect();
        let mut coupled = linear.clone();
        if let Some([k, c]) = model.coupling {
            let imported = &model.columns[model.columns.len() - k.nrows()..];
            for (i, row) in imported.iter().enumerate() {
                for (j, column) in imported.iter().enumerate() {
                    let slope = weights.share() * (k[(i, j)] + weights.rate * c[(i, j)]);
                    row.iter()
                        .for_each(|(a, x)| column.iter().for_each(|(b, y)| coupled[(a, b)] += slope * x * y));
                }
            }
        }
        let zeros = || vec![0.0; directions];
        let at = Iterate { delta: vec![0.0; n], along: zeros(), force: zeros() };
        ReducedStep {
            model,
            basis,
            weights,
            linear,
            coupled,
            tangent: None,
            reaction: Reaction::new(model),
            resistance,
            predicted: [zeros(), zeros()],
            last: at.clone(),
            at,
            motion: [zeros(), zeros()],
            answer: zeros(),
            step: Mat::zeros(n, 1),
            again: Mat::zeros(n, 1),
            moved: Mat::zeros(directions, 1),
            way: Mat::zeros(directions, 1),
        }
    }

    /// R at the iterate, and `again` = h − A Δ − b VᵀD r.
    fn evaluate(&mut self, h: &Mat<f64>, from: &State, to: &State) {
        let [q, rate] = &mut self.motion;
        for (i, x) in self.at.along.iter().enumerate() {
            q[i] = self.predicted[0][i] + x;
            rate[i] = self.predicted[1][i] + self.weights.rate * x;
        }
        let since = Since {
            travel: &from.interface.travel,
            approaches: &from.interface.approaches,
            bristles: &from.bristles,
            duration: self.weights.step,
            force: &self.at.force,
            resistance: &self.resistance,
        };
        self.reaction.evaluate(self.model, [q, rate], to.moment(), Some(since));
        self.answer.copy_from_slice(&self.reaction.force);
        for point in self.held() {
            let rows = [0, 1, 2].map(|c| 3 * point + c);
            let off = self.reaction.resolved(point, rows.map(|k| self.reaction.force[k] - self.at.force[k]));
            rows.into_iter().zip(off).for_each(|(k, off)| self.answer[k] = self.at.force[k] + off);
        }
        let again = self.again.col_as_slice_mut(0);
        again.copy_from_slice(h.col_as_slice(0));
        for (j, delta) in self.at.delta.iter().enumerate() {
            again.iter_mut().zip(self.linear.col_as_slice(j)).for_each(|(out, a)| *out -= a * delta);
        }
        to.interface.add_reactions(self.model, -self.weights.share(), &self.answer, again);
    }

    /// The points whose friction depends on its iterate.
    fn held(&self) -> Vec<usize> {
        (0..self.model.points.len()).filter(|p| self.reaction.holds(*p)).collect()
    }

    /// The tangent at the iterate.
    fn renew(&mut self, to: &State) {
        let slopes = PointSlopes::new(self.model, &self.reaction, self.weights.rate);
        self.make(&Arc::new(slopes), to);
    }

    /// The tangent of these derivatives.
    fn make(&mut self, slopes: &Arc<PointSlopes>, to: &State) {
        let (model, basis) = (self.model, self.basis);
        let forces = |j: usize| {
            let (column, mut force) = (basis.col_as_slice(j), vec![0.0; basis.nrows()]);
            let seen = |k: usize| -> f64 {
                parts(&to.interface.mixes[k]).map(|(c, share)| share * model.columns[c].dot(column)).sum()
            };
            let follows = slopes.follow(model, seen);
            for (p, touch) in model.points.iter().enumerate().filter(|(p, _)| !slopes.is_silent(*p)) {
                let along = [0, 1, 2].map(|c| seen(3 * p + c));
                let push = slopes.change(p, along, follows[touch.pair]);
                for (c, push) in push.into_iter().enumerate().filter(|(_, push)| *push != 0.0) {
                    let mix = &to.interface.mixes[3 * p + c];
                    parts(mix).for_each(|(c, share)| model.columns[c].add_to(share * push, &mut force));
                }
            }
            force
        };
        let columns: Vec<Vec<f64>> = (0..basis.ncols()).into_par_iter().map(forces).collect();
        let forces = Mat::from_fn(basis.nrows(), basis.ncols(), |i, j| columns[j][i]);
        let seen = gram(basis.as_ref(), forces.as_ref());
        let tangent = Lu::new(&self.coupled + faer::Scale(self.weights.share()) * seen);
        self.tangent = Some((Arc::clone(slopes), tangent));
    }

    /// The tangent that the step before ended with, if it was one of this length; says whether there is one.
    fn take_over(&mut self, from: &State, to: &State) -> bool {
        let Some(slopes) = from.slopes.as_ref().filter(|slopes| slopes.rate() == self.weights.rate) else {
            return false;
        };
        if !self.tangent.as_ref().is_some_and(|(own, _)| Arc::ptr_eq(own, slopes)) {
            self.make(slopes, to);
        }
        !self.model.travels()
    }

    /// Newton's step from `again`, in its place; says how far it moves the points.
    fn newton(&mut self, to: &State) -> f64 {
        if let Some((_, tangent)) = &self.tangent {
            tangent.solve_in_place(self.again.as_mut());
        }
        to.interface.motions(self.model, self.again.as_ref(), self.moved.as_mut());
        let all = self.moved.col_as_slice(0).iter();
        all.fold(0.0, |m: f64, v| if v.is_nan() || m.is_nan() { f64::NAN } else { m.max(v.abs()) })
    }

    /// By how much Newton's step changes the iterates of r of the points whose friction depends on them.
    fn follow(&self) -> Vec<(usize, [f64; 3])> {
        let held = self.held();
        if held.is_empty() {
            return Vec::new();
        }
        let slopes = PointSlopes::new(self.model, &self.reaction, self.weights.rate);
        let moved = self.moved.col_as_slice(0);
        let follows = slopes.follow(self.model, |k| moved[k]);
        let change = |p: usize| {
            let along = [0, 1, 2].map(|c| moved[3 * p + c]);
            let push = slopes.change(p, along, follows[self.model.points[p].pair]);
            (p, [0, 1, 2].map(|c| self.answer[3 * p + c] + push[c] - self.at.force[3 * p + c]))
        };
        held.into_iter().map(change).collect()
    }

    /// From the last iterate a part of Newton's step, with these changes of the forces.
    fn advance(&mut self, part: f64, forces: &[(usize, [f64; 3])]) {
        let towards = |at: &mut [f64], last: &[f64], step: &[f64]| {
            at.iter_mut().zip(last.iter().zip(step)).for_each(|(x, (last, step))| *x = last + part * step);
        };
        towards(&mut self.at.delta, &self.last.delta, self.step.col_as_slice(0));
        towards(&mut self.at.along, &self.last.along, self.way.col_as_slice(0));
        for (p, change) in forces {
            let rows = 3 * p..3 * p + 3;
            towards(&mut self.at.force[rows.clone()], &self.last.force[rows], change);
        }
    }

    /// Leaves Δ in `h`, and what was found in `to`.
    fn answer(&self, h: &mut Mat<f64>, to: &mut State) {
        to.answer(&self.reaction);
        to.slopes = self.tangent.as_ref().map(|(slopes, _)| Arc::clone(slopes));
        h.col_as_slice_mut(0).copy_from_slice(&self.at.delta);
    }

    /// The motion along the directions that is round-off \[m\].
    fn round_off(&self) -> f64 {
        let all = self.at.along.iter().chain(&self.predicted[0]);
        SETTLED * all.fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()))
    }
}

impl Solver for ReducedStep<'_> {
    fn increment(
        &mut self,
        h: &mut Mat<f64>,
        _: &mut Mat<f64>,
        from: &State,
        to: &mut State,
    ) -> std::result::Result<(), StepFailure> {
        to.predict_along(&self.weights, &mut self.predicted);
        // From where the last acceleration would lead, and the last forces.
        let onward = 1.0 / self.weights.inertia;
        let scaled =
            |x: &[f64], out: &mut [f64]| out.iter_mut().zip(x).for_each(|(out, a)| *out = onward * a);
        scaled(from.motion.col_as_slice(2), &mut self.at.delta);
        scaled(to.before.col_as_slice(2), &mut self.at.along);
        self.at.force.copy_from_slice(&from.reaction);
        self.evaluate(h, from, to);
        let mut fresh = !self.take_over(from, to);
        if fresh {
            self.renew(to);
        }
        let mut length = self.newton(to);
        for iteration in 1..=ITERATIONS {
            to.iterations = iteration;
            if !length.is_finite() {
                return Err(StepFailure::NotFinite);
            }
            let forces = self.follow();
            self.last.clone_from(&self.at);
            self.step.copy_from(&self.again);
            self.way.copy_from(&self.moved);
            if length <= self.round_off() && self.reaction.mismatch(&self.at.force) <= UNMATCHED {
                self.advance(1.0, &forces);
                self.evaluate(h, from, to);
                self.answer(h, to);
                return Ok(());
            }
            let mut damping = 1.0;
            let left = loop {
                self.advance(damping, &forces);
                self.evaluate(h, from, to);
                let left = self.newton(to);
                if left <= (1.0 - 0.25 * damping) * length || damping < 1e-3 || !fresh {
                    break left;
                }
                damping *= 0.5;
            };
            let slow = left.is_nan() || left > (SLOW * length).max(self.round_off());
            if slow && !fresh && (left.is_nan() || left >= length) {
                // The tangent is of another state: back, and anew.
                std::mem::swap(&mut self.at, &mut self.last);
                self.evaluate(h, from, to);
            }
            fresh = slow;
            length = left;
            if slow {
                self.evaluate(h, from, to);
                self.renew(to);
                length = self.newton(to);
            }
        }
        let enough =
            length <= 1e3 * self.round_off() && self.reaction.mismatch(&self.at.force) <= 1e3 * UNMATCHED;
        if enough {
            self.answer(h, to);
            return Ok(());
        }
        Err(StepFailure::Newton { length, point: moved_most(self.moved.col_as_slice(0), self.model) })
    }
}
