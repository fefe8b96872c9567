//! Where a system stands: its motion, and what the matrices make of it.

use super::interface::TravellingInterface;
use super::model::TransientModel;
use super::products::Derived;
use super::reaction::{Bristles, Moment, Reaction};
use super::rows::combine;
use super::scheme::Weights;
use super::skew::SkewForces;
use super::slopes::PointSlopes;
use crate::equilibrium::SteadySliding;
use crate::linalg::c64;
use crate::linalg::multivector::gram;
use faer::Mat;
use std::sync::Arc;

/// u, v and a are the columns 0, 1, 2 of `motion` and of what is derived from it.
#[derive(Debug, Clone)]
pub struct State {
    /// t \[s\].
    pub time: f64,
    /// u, v, a \[m, m/s, m/s²; radians for rotations\], n × 3.
    pub motion: Mat<f64>,
    /// K u, K v, K a.
    pub(super) elastic: Mat<f64>,
    /// M v, M a.
    pub(super) inertia: Mat<f64>,
    /// C v, C a of the sparse viscous matrix.
    pub(super) viscous: Option<Mat<f64>>,
    /// Forces of the sparse skew parts.
    pub(super) skew: Option<SkewForces>,
    /// Bᵀu, Bᵀv, Bᵀa of modal damping C = B diag(c) Bᵀ.
    pub(super) modal: Option<Mat<f64>>,
    /// Dᵀu, Dᵀv, Dᵀa, r × 3.
    pub(super) along: Mat<f64>,
    /// r along the directions \[N\].
    pub(super) reaction: Vec<f64>,
    /// Bristle deflections of each contact point.
    pub(super) bristles: Vec<Bristles>,
    /// p(t) of each push.
    pub(super) pushes: Vec<f64>,
    /// V of each pair at t \[m/s\].
    pub(super) speeds: Vec<f64>,
    /// Where the contacts act at t.
    pub(super) interface: TravellingInterface,
    /// Dᵀu, Dᵀv, Dᵀa of the motion at the beginning of the step that ended here, with its D: r × 3.
    pub(super) before: Mat<f64>,
    /// Newton's steps that its last step took.
    pub(super) iterations: usize,
    /// What the tangent was made of with which that step ended, of a reduced model with its contacts apart.
    pub(super) slopes: Option<Arc<PointSlopes>>,
}

impl State {
    /// Steady sliding: at rest, displaced by u₀.
    pub fn steady(model: &TransientModel<'_>, steady: &SteadySliding) -> Self {
        let mut state = State::empty(model);
        state.motion.col_as_slice_mut(0).copy_from_slice(&steady.displacement);
        state.settle(model);
        state
    }

    /// Moves along a complex mode: u += Re(s φ), v += Re(s λ φ), a += Re(s λ² φ), with s = `factor`.
    pub fn disturbed(mut self, model: &TransientModel<'_>, lambda: c64, shape: &[c64], factor: f64) -> Self {
        let mut turned = c64::new(factor, 0.0);
        for k in 0..3 {
            let column = self.motion.col_as_slice_mut(k);
            column.iter_mut().zip(shape).for_each(|(x, z)| *x += (turned * z).re);
            turned *= lambda;
        }
        self.settle(model);
        self
    }

    /// Computes all that depends on time and motion.
    pub(super) fn settle(&mut self, model: &TransientModel<'_>) {
        self.act(model, self.time);
        self.derive(model);
        self.project(model);
        self.react(model);
    }

    /// The motion of the modes that are damped.
    pub(super) fn project(&mut self, model: &TransientModel<'_>) {
        if let (Some(modal), Some(out)) = (&model.damping.modal, &mut self.modal) {
            *out = gram(modal.basis.as_ref(), self.motion.as_ref());
        }
    }

    /// The reaction to the motion, as in steady sliding.
    fn react(&mut self, model: &TransientModel<'_>) {
        let mut reaction = Reaction::new(model);
        let along = [0, 1].map(|k| self.along.col_as_slice(k));
        reaction.evaluate(model, along, self.moment(), None);
        self.answer(&reaction);
    }

    /// Takes over what the contacts answer.
    pub(super) fn answer(&mut self, reaction: &Reaction) {
        self.reaction.copy_from_slice(&reaction.force);
        self.bristles.copy_from_slice(&reaction.bristles);
        self.interface.approaches.copy_from_slice(&reaction.approaches);
    }

    /// Arguments of the reactions besides the motion.
    pub(super) fn moment(&self) -> Moment<'_> {
        Moment { time: self.time, interface: &self.interface, speeds: &self.speeds, before: &self.before }
    }

    /// Sets velocities, pulse loads and contact places at a time.
    pub(super) fn act(&mut self, model: &TransientModel<'_>, time: f64) {
        self.time = time;
        self.speeds.iter_mut().zip(model.speeds(time)).for_each(|(now, v)| *now = v);
        self.pushes.iter_mut().zip(&model.pushes).for_each(|(now, push)| *now = push.factor(time));
        self.interface.locate(model, time);
    }

    /// The motion that a step to here begins with, along the directions at its end.
    pub(super) fn look_back(&mut self, model: &TransientModel<'_>, from: &State) {
        if model.travels() {
            self.interface.motions(model, from.motion.as_ref(), self.before.as_mut());
        } else {
            self.before.copy_from(&from.along);
        }
    }

    /// Dᵀu_t and Dᵀv_t, the motion along the directions at the end of a step as far as it is known at its beginning.
    pub(super) fn predict_along(&self, weights: &Weights, out: &mut [Vec<f64>; 2]) {
        let along = [0, 1, 2].map(|k| self.before.col_as_slice(k));
        combine(weights.predicted(), along, &mut out[0]);
        combine(weights.predicted_rate(), along, &mut out[1]);
    }

    /// How many times Newton's method solved for the contact in the step that ended here.
    pub fn iterations(&self) -> usize {
        self.iterations
    }

    /// V of each pair \[m/s\].
    pub fn speeds(&self) -> &[f64] {
        &self.speeds
    }

    /// N, F₁, F₂ \[N\] of a contact point, friction on the body.
    pub fn contact_forces(&self, point: usize) -> [f64; 3] {
        let at = 3 * point;
        [self.reaction[at], -self.reaction[at + 1], -self.reaction[at + 2]]
    }

    /// Whether a contact point did not slip in the last step; a law with regularised friction never says so.
    pub fn sticks(&self, point: usize) -> bool {
        self.bristles[point].stick
    }

    /// Whether a point sticks whose friction at rest is set-valued.
    pub(super) fn rests(&self, model: &TransientModel<'_>) -> bool {
        model.points.iter().zip(&self.bristles).any(|(point, own)| own.stick && point.law.is_set_valued())
    }

    /// δ \[m\] of a contact point.
    pub fn penetration(&self, model: &TransientModel<'_>, point: usize) -> f64 {
        let pair = model.points[point].pair;
        self.interface.approaches[pair] - self.interface.gaps[point] + self.along[(3 * point, 0)]
    }

    /// The slip velocity of a contact point along t₁ and t₂ \[m/s\].
    pub fn slip_velocity(&self, model: &TransientModel<'_>, point: usize) -> [f64; 2] {
        let at = 3 * point;
        let of = &model.points[point];
        [of.speed * self.speeds[of.pair] - self.along[(at + 1, 1)], -self.along[(at + 2, 1)]]
    }

    /// ½vᵀMv + ½uᵀKu \[J\].
    pub fn energy(&self) -> f64 {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        0.5 * dot(self.motion.col_as_slice(1), self.inertia.col_as_slice(0))
            + 0.5 * dot(self.motion.col_as_slice(0), self.elastic.col_as_slice(0))
    }

    /// Allocated, zero state of `model`.
    pub(super) fn empty(model: &TransientModel<'_>) -> Self {
        let (n, r) = (model.n(), model.n_directions());
        State {
            time: 0.0,
            motion: Mat::zeros(n, 3),
            elastic: Mat::zeros(n, 3),
            inertia: Mat::zeros(n, 2),
            viscous: model.damping.viscous.as_ref().map(|_| Mat::zeros(n, 2)),
            skew: model.skew.map(|_| SkewForces::new(n)),
            modal: model.damping.modal.as_ref().map(|modal| Mat::zeros(modal.coefficients.len(), 3)),
            along: Mat::zeros(r, 3),
            reaction: vec![0.0; r],
            bristles: vec![Bristles::default(); model.points.len()],
            pushes: vec![0.0; model.pushes.len()],
            speeds: model.velocities.clone(),
            interface: TravellingInterface::new(model),
            before: Mat::zeros(r, 3),
            iterations: 0,
            slopes: None,
        }
    }

    /// Products of the sparse matrices with the motion, and the motion along the directions.
    pub(super) fn derive(&mut self, model: &TransientModel<'_>) {
        let (elastic, inertia) = (&mut self.elastic, &mut self.inertia);
        model.products.derive(&self.motion, Derived { elastic, inertia, viscous: self.viscous.as_mut() });
        if let (Some(skew), Some(forces)) = (model.skew, &mut self.skew) {
            forces.derive(skew, &self.motion);
        }
        self.interface.motions(model, self.motion.as_ref(), self.along.as_mut());
    }
}
