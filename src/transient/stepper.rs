//! One step of the scheme: what acts, what follows, what work was done.

use super::condensed::Condensed;
use super::full_newton::FullNewton;
use super::ledger::Work;
use super::model::Model;
use super::scheme::{Scheme, Weights};
use super::state::State;
use crate::error::Result;
use faer::Mat;
use std::fmt::Debug;

/// Newton's iterations of one step.
pub(super) const ITERATIONS: usize = 40;
/// Steps of Newton's method below this part of the motion are round-off.
pub(super) const ROUND_OFF: f64 = 1e-14;

/// How a step is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// Condensed onto the contact: one solution with a matrix that is factorised once.
    #[default]
    Condensed,
    /// Newton's method on the whole, a new factorisation each iteration: the reference, for comparison.
    FullNewton,
}

/// Why a step has no solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stuck {
    /// Newton's method did not converge: the length of its last step \[m\].
    Newton(f64),
    /// A number that is not finite.
    NotFinite,
}

/// Solves A Δ + b D r_{n+1} = h.
pub(super) trait Solver: Debug {
    /// Replaces `h` + B `modal` by Δ and `modal` by BᵀΔ; leaves r_{n+1} in `to`.
    fn increment(
        &mut self,
        h: &mut Mat<f64>,
        modal: &mut Mat<f64>,
        from: &State,
        to: &mut State,
    ) -> std::result::Result<(), Stuck>;
}

/// A step of fixed length Δt: what is factorised and solved for once.
///
/// With u_{n+1} = u_t + Δ, v_{n+1} = v_t + c₁Δ, a_{n+1} = Δ/(β Δt²) and b = 1 − α_f the equation of motion is
///
/// A Δ = h − b D r_{n+1}, h = f_α − α_m M a − b (K u_t + C v_t) − α_f (K u + C v + D r)_n.
#[derive(Debug)]
pub(super) struct Stepper<'a> {
    model: &'a Model<'a>,
    weights: Weights,
    solver: Box<dyn Solver + 'a>,
    /// h, then Δ.
    increment: Mat<f64>,
}

impl<'a> Stepper<'a> {
    /// Makes ready for steps of `step` seconds.
    ///
    /// # Errors
    /// A matrix that is singular: a part without stiffness and mass.
    pub(super) fn new(model: &'a Model<'a>, scheme: Scheme, step: f64, method: Method) -> Result<Self> {
        let weights = Weights::new(scheme, step);
        let solver: Box<dyn Solver + 'a> = match method {
            Method::Condensed => Box::new(Condensed::new(model, weights)?),
            Method::FullNewton => Box::new(FullNewton::new(model, weights)),
        };
        Ok(Stepper { model, weights, solver, increment: Mat::zeros(model.n(), 1) })
    }

    /// Advances `from` to `to`, which says what acts at its end ([`State::act`]); says what work was done.
    pub(super) fn step(&mut self, from: &State, to: &mut State) -> std::result::Result<Work, Stuck> {
        let (model, weights) = (self.model, self.weights);
        to.look_back(model, from);
        let mut modal = self.force(from, to);
        self.solver.increment(&mut self.increment, &mut modal, from, to)?;
        advance(&weights, &from.motion, self.increment.col_as_slice(0), &mut to.motion);
        if let (Some(old), Some(new)) = (&from.modal, &mut to.modal) {
            advance(&weights, old, modal.col_as_slice(0), new);
        }
        to.derive(model);
        if !(to.motion.as_ref().norm_max().is_finite()) {
            return Err(Stuck::NotFinite);
        }
        Ok(Work::between(model, &weights, from, to))
    }

    /// h but for its modal part goes to `increment`; returned is w of that part, B w.
    fn force(&mut self, from: &State, to: &State) -> Mat<f64> {
        let (model, weights) = (self.model, self.weights);
        let (share, alpha) = (weights.share(), weights.scheme.alpha_f);
        let mut spring = weights.predicted().map(|p| -share * p);
        spring[0] -= alpha;
        let mut dashpot = weights.predicted_rate().map(|p| -share * p);
        dashpot[1] -= alpha;
        let mass = -weights.scheme.alpha_m;
        let h = self.increment.col_as_slice_mut(0);
        combine(spring, [0, 1, 2].map(|k| from.elastic.col_as_slice(k)), h);
        let inertia = from.inertia.col_as_slice(1);
        (0..h.len()).for_each(|i| h[i] += model.load[i] + mass * inertia[i]);
        if let Some(viscous) = &from.viscous {
            let (v, a) = (viscous.col_as_slice(0), viscous.col_as_slice(1));
            (0..h.len()).for_each(|i| h[i] += dashpot[1] * v[i] + dashpot[2] * a[i]);
        }
        for (k, push) in model.pushes.iter().enumerate() {
            push.direction.add_to(share * to.pushes[k] + alpha * from.pushes[k], h);
        }
        from.interface.add_reactions(model, -alpha, &from.reaction, h);
        match (&model.damping.modal, &from.modal) {
            (Some(modal), Some(along)) => Mat::from_fn(modal.coefficients.len(), 1, |i, _| {
                modal.coefficients[i] * (dashpot[1] * along[(i, 1)] + dashpot[2] * along[(i, 2)])
            }),
            _ => Mat::zeros(0, 1),
        }
    }
}

/// out = Σ factor · x.
pub(super) fn combine(factors: [f64; 3], x: [&[f64]; 3], out: &mut [f64]) {
    for (i, out) in out.iter_mut().enumerate() {
        *out = factors[0] * x[0][i] + factors[1] * x[1][i] + factors[2] * x[2][i];
    }
}

/// u, v, a at the end of a step from those at its beginning and from Δ.
fn advance(weights: &Weights, old: &Mat<f64>, increment: &[f64], new: &mut Mat<f64>) {
    let motion = [0, 1, 2].map(|k| old.col_as_slice(k));
    combine(weights.predicted(), motion, new.col_as_slice_mut(0));
    combine(weights.predicted_rate(), motion, new.col_as_slice_mut(1));
    for (k, factor) in [1.0, weights.rate].into_iter().enumerate() {
        new.col_as_slice_mut(k).iter_mut().zip(increment).for_each(|(x, d)| *x += factor * d);
    }
    new.col_as_slice_mut(2).iter_mut().zip(increment).for_each(|(a, d)| *a = weights.inertia * d);
}
