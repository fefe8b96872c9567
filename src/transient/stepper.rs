//! One step of the scheme: what acts, what follows, what work was done.

use super::condensed::CondensedStep;
use super::energy_balance::Work;
use super::full_newton::FullNewton;
use super::model::TransientModel;
use super::reduced::ReducedStep;
use super::rows::{chunks, combine};
use super::scheme::{Scheme, Weights};
use super::solver::{Solver, StepFailure};
use super::state::State;
use crate::error::Result;
use faer::Mat;

/// How a step is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StepMethod {
    /// Condensed onto the contact: one solution with a matrix that is factorised once.
    #[default]
    Condensed,
    /// Newton's method on the whole, a new factorisation each iteration: the reference, for comparison.
    FullNewton,
}

/// A step of fixed length Δt: what is factorised and solved for once.
///
/// With u_{n+1} = u_t + Δ, v_{n+1} = v_t + c₁Δ, a_{n+1} = Δ/(β Δt²) and b = 1 − α_f the equation of motion is
///
/// A Δ = h − b D r_{n+1}, h = f_α − α_m M a − b (K u_t + C v_t) − α_f (K u + C v + D r)_n,
///
/// where K and C include the sparse skew parts.
#[derive(Debug)]
pub(super) struct Stepper<'a> {
    model: &'a TransientModel<'a>,
    weights: Weights,
    solver: Box<dyn Solver + 'a>,
    /// h, then Δ.
    increment: Mat<f64>,
}

impl<'a> Stepper<'a> {
    /// Makes ready for steps of `step` seconds.
    /// Fails where the matrix is singular: a part without stiffness and mass.
    pub(super) fn new(
        model: &'a TransientModel<'a>,
        scheme: Scheme,
        step: f64,
        method: StepMethod,
    ) -> Result<Self> {
        let weights = Weights::new(scheme, step);
        let solver: Box<dyn Solver + 'a> = match (model.basis, method) {
            (Some(basis), _) => Box::new(ReducedStep::new(model, basis, weights)),
            (None, StepMethod::Condensed) => Box::new(CondensedStep::new(model, weights)?),
            (None, StepMethod::FullNewton) => Box::new(FullNewton::new(model, weights)),
        };
        Ok(Stepper { model, weights, solver, increment: Mat::zeros(model.n(), 1) })
    }

    /// Advances `from` to `to`, which says what acts at its end ([`State::act`]); says what work was done.
    pub(super) fn step(&mut self, from: &State, to: &mut State) -> std::result::Result<Work, StepFailure> {
        let (model, weights) = (self.model, self.weights);
        to.look_back(model, from);
        let mut modal = self.force(from, to);
        self.solver.increment(&mut self.increment, &mut modal, from, to)?;
        advance(&weights, &from.motion, self.increment.col_as_slice(0), &mut to.motion);
        if let (Some(old), Some(new)) = (&from.modal, &mut to.modal) {
            advance(&weights, old, modal.col_as_slice(0), new);
        }
        to.derive(model);
        let work = Work::between(model, &weights, from, to);
        // Every number of the motion is in it.
        if work.turnover().is_finite() { Ok(work) } else { Err(StepFailure::NotFinite) }
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
        let elastic = [0, 1, 2].map(|k| from.elastic.col_as_slice(k));
        let inertia = from.inertia.col_as_slice(1);
        let viscous = from.viscous.as_ref().map(|viscous| [0, 1].map(|k| viscous.col_as_slice(k)));
        let h = self.increment.col_as_slice_mut(0);
        chunks([&mut *h], |first, [h]| {
            let rows = first..first + h.len();
            combine(spring, elastic.map(|x| &x[rows.clone()]), h);
            let given = model.load[rows.clone()].iter().zip(&inertia[rows.clone()]);
            h.iter_mut().zip(given).for_each(|(h, (load, inertia))| *h += load + mass * inertia);
            if let Some([v, a]) = viscous {
                let rates = v[rows.clone()].iter().zip(&a[rows]);
                h.iter_mut().zip(rates).for_each(|(h, (v, a))| *h += dashpot[1] * v + dashpot[2] * a);
            }
            if let Some(skew) = &from.skew {
                skew.add_to(spring.map(|f| -f), [-dashpot[1], -dashpot[2]], first..first + h.len(), h);
            }
        });
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

/// u, v, a at the end of a step from those at its beginning and from Δ.
fn advance(weights: &Weights, old: &Mat<f64>, increment: &[f64], new: &mut Mat<f64>) {
    let motion = [0, 1, 2].map(|k| old.col_as_slice(k));
    let (by_u, by_v) = (weights.predicted(), weights.predicted_rate());
    let (u, rest) = new.as_mut().split_at_col_mut(1);
    let (v, a) = rest.split_at_col_mut(1);
    let new = [u, v, a].map(|x| {
        let column = x.col_mut(0).try_as_col_major_mut();
        column.expect("the columns of a matrix are in one piece").as_slice_mut()
    });
    chunks(new, |first, [u, v, a]| {
        let rows = first..first + u.len();
        let [old_u, old_v, old_a] = motion.map(|x| &x[rows.clone()]);
        let increment = &increment[rows];
        let (v, a) = (&mut v[..u.len()], &mut a[..u.len()]);
        for i in 0..u.len() {
            let d = increment[i];
            u[i] = old_u[i] + by_u[1] * old_v[i] + by_u[2] * old_a[i] + d;
            v[i] = old_v[i] + by_v[2] * old_a[i] + weights.rate * d;
            a[i] = weights.inertia * d;
        }
    });
}
