//! The state at the beginning of a motion from rest.

use super::model::TransientModel;
use super::reaction::{Bristles, Reaction, Since};
use super::state::State;
use crate::equilibrium::SteadySliding;
use crate::error::Result;
use crate::linalg::factor::factorize;
use crate::linalg::sparse::{add_scaled, diagonal, multiply};
use faer::Mat;

/// The largest part of the forces that counts as round-off of an equilibrium.
const BALANCED: f64 = 1e-8;

/// The length of a step that has just begun \[s\]: nothing has moved in it.
const JUST_BEGUN: f64 = 1e-100;

/// ωδ of the fastest motion in the matrix that gives the acceleration, whose relative error is (ωδ)².
const FASTEST: f64 = 1e-5;

/// The part of the largest M_ii/K_ii below which a degree of freedom has no mass but round-off.
const NO_MASS: f64 = 1e-20;

impl State {
    /// At rest, displaced by the u of a state without friction: nothing slid yet, and no bristle is bent.
    ///
    /// Friction that needs no deflection acts at once, with the sliding velocities of t = 0, and so do pushes. The forces
    /// q = f + Σp d − (K + N) u − D r that are not in equilibrium then accelerate the structure, M a(0) = q: without a(0)
    /// every scheme were of first order.
    ///
    /// M may be singular. With A = M + δC + δ²K and a δ that is small against every period and decay,
    ///
    /// a(0) = A⁻¹ M A⁻¹ q,
    ///
    /// which is M⁻¹q but for (ωδ)² where M is regular. Degrees of freedom without mass are condensed: A⁻¹q → (a, K_oo⁻¹(q_o − …)/δ²)
    /// passes what acts on them to those with mass, and the second A⁻¹ gives them the acceleration −K_oo⁻¹K_om a_m at
    /// which they follow. They take the place that q demands of them in the first step.
    ///
    /// # Errors
    /// Degrees of freedom with neither mass nor stiffness nor damping.
    pub fn at_rest(model: &TransientModel<'_>, still: &SteadySliding) -> Result<Self> {
        let mut state = State::empty(model);
        state.motion.col_as_slice_mut(0).copy_from_slice(&still.displacement);
        state.settle(model);
        state.begin_to_slide(model);
        if let Some(mut acceleration) = state.unbalanced(model) {
            accelerate(model, &mut acceleration)?;
            state.motion.col_as_slice_mut(2).copy_from_slice(acceleration.col_as_slice(0));
            state.derive(model);
            state.project(model);
        }
        Ok(state)
    }

    /// The reaction at the end of a step that has just begun, with no bristle of a pair that slides bent.
    fn begin_to_slide(&mut self, model: &TransientModel<'_>) {
        let travel: Vec<f64> = self.speeds.iter().map(|speed| -JUST_BEGUN * speed).collect();
        self.before.copy_from(&self.along);
        // Those of pairs that never slide are bent by what presses them.
        let own = model.points.iter().zip(&self.bristles);
        let bent: Vec<Bristles> = own
            .map(|(point, own)| if model.sticks(point.pair) { *own } else { Bristles::default() })
            .collect();
        let since = Since {
            travel: &travel,
            approaches: &self.interface.approaches,
            bristles: &bent,
            duration: JUST_BEGUN,
            force: &self.reaction,
            resistance: &vec![1.0; model.points.len()],
        };
        let mut reaction = Reaction::new(model);
        let along = [0, 1].map(|k| self.along.col_as_slice(k));
        reaction.evaluate(model, along, self.moment(), Some(since));
        reaction.bristles.copy_from_slice(&bent);
        self.answer(&reaction);
    }

    /// q; `None` in equilibrium.
    fn unbalanced(&self, model: &TransientModel<'_>) -> Option<Mat<f64>> {
        let (q, largest) = self.residual(model);
        (q.norm_max() > BALANCED * largest).then_some(q)
    }

    /// q, and the largest of the forces in it.
    pub(super) fn residual(&self, model: &TransientModel<'_>) -> (Mat<f64>, f64) {
        let n = model.n();
        let mut reactions = vec![0.0; n];
        self.interface.add_reactions(model, -1.0, &self.reaction, &mut reactions);
        let mut forces = model.load.to_vec();
        for (push, factor) in model.pushes.iter().zip(&self.pushes) {
            push.direction.add_to(*factor, &mut forces);
        }
        if let Some(skew) = &self.skew {
            skew.add_to([1.0, 0.0, 0.0], [0.0; 2], 0..n, &mut forces);
        }
        let elastic = self.elastic.col_as_slice(0);
        let terms = [&forces[..], &reactions, elastic];
        let largest = terms.into_iter().flatten().fold(0.0, |most: f64, force| most.max(force.abs()));
        (Mat::from_fn(n, 1, |i, _| forces[i] + reactions[i] - elastic[i]), largest)
    }
}

impl TransientModel<'_> {
    /// The same model in equilibrium at a steady state that its coordinates have but for a little: what is left is taken from the load.
    #[must_use]
    pub fn balanced(mut self, steady: &SteadySliding) -> Self {
        let (off, _) = State::steady(&self, steady).residual(&self);
        self.load.to_mut().iter_mut().zip(off.col_as_slice(0)).for_each(|(load, off)| *load -= off);
        self
    }
}

/// Replaces q by A⁻¹ M A⁻¹ q.
fn accelerate(model: &TransientModel<'_>, q: &mut Mat<f64>) -> Result<()> {
    let viscous = model.damping.viscous.as_deref();
    let [m, k] = [model.mass, &*model.stiffness].map(diagonal);
    let c = viscous.map_or(vec![0.0; m.len()], diagonal);
    let ratio = |i: usize| if k[i] > 0.0 { m[i] / k[i] } else { f64::INFINITY };
    let ratios = || (0..m.len()).map(ratio).filter(|ratio| ratio.is_finite());
    let longest = ratios().fold(0.0, f64::max);
    let shortest = ratios().filter(|ratio| *ratio > NO_MASS * longest).fold(f64::INFINITY, f64::min);
    let decays = (0..m.len()).filter(|i| ratio(*i) > NO_MASS * longest && c[*i] > 0.0).map(|i| m[i] / c[i]);
    // 1 s where nothing but mass acts.
    let delta =
        (FASTEST * shortest.sqrt()).min(FASTEST * FASTEST * decays.fold(f64::INFINITY, f64::min)).min(1.0);
    let mut terms = vec![(1.0, model.mass), (delta * delta, &*model.stiffness)];
    terms.extend(viscous.map(|viscous| (delta, viscous)));
    let factor = factorize(&add_scaled(&terms))?;
    factor.solve_in_place(q.as_mut());
    let mut inertia = Mat::zeros(q.nrows(), 1);
    multiply(model.mass, q.as_ref(), inertia.as_mut());
    factor.solve_in_place(inertia.as_mut());
    *q = inertia;
    Ok(())
}
