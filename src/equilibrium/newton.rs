//! Newton's method on the condensed contact problem.

use super::PointState;
use super::balance::states;
use super::condensed::Condensed;
use super::linear::directions;
use super::load_steps::{Lost, Newton, Watch};
use super::point_laws::{Fraction, Law, PointLaws, State, are_finite, force_change, largest_force, norm};
use crate::progress::Observer;
use crate::system::ContactPair;
use faer::Mat;
use faer::linalg::solvers::Solve;

/// The condensed problem: with the penetration δ of every point and an approach a for every pair closed by a load,
///
/// e = e₀ + S (d e − N) + T₁ F₁ + T₂ F₂,  ΣN = L,  (N, F) = law(δ), e = gᵀu = δ − a + gap,
///
/// S = gᵀA⁻¹g, T = gᵀA⁻¹t, e₀ = gᵀA⁻¹f. The penetration is an unknown of its own: as the difference a − gap + e it would
/// lose the digits that a stiff law, where δ is far smaller than e, needs for its force.
pub(super) struct ContactProblem<'a> {
    pub(super) contact: PointLaws<'a>,
    load: &'a [f64],
    condensed: &'a Condensed,
    unloaded: Vec<f64>,
    max_iterations: usize,
    observer: &'a dyn Observer,
}

/// δ of every point and a of every pair \[m\].
#[derive(Debug, Clone)]
pub(super) struct Closure {
    pub(super) penetration: Vec<f64>,
    pub(super) approach: Vec<f64>,
}

impl Newton for ContactProblem<'_> {
    type Stage = Closure;

    fn contact(&self) -> &PointLaws<'_> {
        &self.contact
    }

    fn state(&self, stage: &Closure) -> (Vec<PointState>, Vec<f64>) {
        (states(self.contact.pairs, &stage.penetration, &[]), stage.approach.clone())
    }

    fn starts(&self, fraction: Fraction) -> Vec<Closure> {
        let starts = self.contact.starts(&self.unloaded, fraction);
        starts.into_iter().map(|(penetration, approach)| Closure { penetration, approach }).collect()
    }

    /// Damped Newton with the natural monotonicity test: a step is taken when the next simplified step is shorter. It ends
    /// when neither the lengths nor the forces change any more.
    fn solve(
        &self,
        Closure { mut penetration, mut approach }: Closure,
        fraction: Fraction,
    ) -> std::result::Result<(Closure, usize), Lost<Closure>> {
        let mut watch = Watch::new(self.observer);
        let (contact, n) = (&self.contact, self.contact.points.len());
        let mut length = f64::INFINITY;
        let measured = |step: &[f64]| contact.length(&step[..n], &contact.approaches(&step[n..]));
        for iteration in 1..=self.max_iterations {
            let laws = contact.respond(&penetration, &[], fraction);
            let lost = |why: String| {
                let at = Closure { penetration: penetration.clone(), approach: approach.clone() };
                Err(Lost { why, at })
            };
            if !are_finite(&laws) {
                return lost(format!("at iteration {iteration} a force of the contact is not finite"));
            }
            let Some(factor) = ScaledLu::new(self.jacobian(&laws), n) else {
                return lost(format!("at iteration {iteration} the contact leaves a motion free"));
            };
            let step = factor.solve(&self.residual(&penetration, &approach, &laws, fraction));
            length = measured(&step);
            if !length.is_finite() {
                return lost(format!("at iteration {iteration} the step is not finite"));
            }
            let settled = length <= 1e-11 * contact.scale(&penetration, &approach)
                && force_change(&laws, &step) <= 1e-9 * largest_force(&laws);
            if !settled && let Err(why) = watch.step(iteration, length, &laws) {
                return lost(why);
            }
            let mut damping = 1.0;
            loop {
                let (next, next_approach) = self.moved(&penetration, &approach, &step, -damping);
                if settled {
                    return Ok((Closure { penetration: next, approach: next_approach }, iteration));
                }
                let laws = contact.respond(&next, &[], fraction);
                let again = measured(&factor.solve(&self.residual(&next, &next_approach, &laws, fraction)));
                if again <= (1.0 - 0.25 * damping) * length || damping < 1e-3 {
                    (penetration, approach) = (next, next_approach);
                    break;
                }
                damping *= 0.5;
            }
        }
        let why = format!("after {} iterations the Newton step is still {length:.1e} m", self.max_iterations);
        Err(Lost { why, at: Closure { penetration, approach } })
    }
}

impl<'a> ContactProblem<'a> {
    /// Of pairs and a load on the structure of `condensed`, solved in up to `max_iterations` watched by `observer`.
    pub(super) fn new(
        (pairs, load): (&'a [ContactPair], &'a [f64]),
        condensed: &'a Condensed,
        max_iterations: usize,
        observer: &'a dyn Observer,
    ) -> Self {
        let unloaded = condensed.unloaded(load);
        ContactProblem { contact: PointLaws::new(pairs), load, condensed, unloaded, max_iterations, observer }
    }

    /// e − e₀ − S (d e − N) − T₁F₁ − T₂F₂, then ΣN − L.
    fn residual(&self, penetration: &[f64], approach: &[f64], laws: &[Law], fraction: Fraction) -> Vec<f64> {
        let [s, t1, t2] = &self.condensed.compliance;
        let n = self.contact.points.len();
        let motions = self.contact.motions(penetration, approach);
        let mut rho: Vec<f64> = (0..n)
            .map(|p| {
                let answer: f64 = (0..n)
                    .map(|q| {
                        let forces = laws[q].0;
                        s[(p, q)] * (self.condensed.closed[q] * motions[q] - forces.normal)
                            + t1[(p, q)] * forces.friction[0]
                            + t2[(p, q)] * forces.friction[1]
                    })
                    .sum();
                motions[p] - fraction * self.unloaded[p] - answer
            })
            .collect();
        rho.extend(self.contact.closure(laws, fraction));
        rho
    }

    fn jacobian(&self, laws: &[Law]) -> Mat<f64> {
        let [s, t1, t2] = &self.condensed.compliance;
        let PointLaws { points, loaded, .. } = &self.contact;
        let n = points.len();
        let mut j = Mat::<f64>::zeros(n + loaded.len(), n + loaded.len());
        for q in 0..n {
            let slope = laws[q].1.by_penetration;
            let unknown = self.contact.unknown(points[q].0).map(|c| n + c);
            for p in 0..n {
                let by_law = s[(p, q)] * slope[0] - t1[(p, q)] * slope[1] - t2[(p, q)] * slope[2];
                let identity = if p == q { 1.0 } else { 0.0 };
                let by_motion = identity - s[(p, q)] * self.condensed.closed[q];
                j[(p, q)] = by_motion + by_law;
                if let Some(approach) = unknown {
                    j[(p, approach)] -= by_motion;
                }
            }
            if let Some(approach) = unknown {
                j[(approach, q)] = slope[0];
            }
        }
        j
    }

    fn moved(
        &self,
        penetration: &[f64],
        approach: &[f64],
        step: &[f64],
        factor: f64,
    ) -> (Vec<f64>, Vec<f64>) {
        let next = penetration.iter().zip(step).map(|(d, s)| d + factor * s).collect();
        let change = self.contact.approaches(&step[penetration.len()..]);
        (next, approach.iter().zip(change).map(|(a, s)| a + factor * s).collect())
    }

    /// A solution on the degrees of freedom: u = A⁻¹ (f + Σ g (d e − N) + t₁F₁ + t₂F₂).
    pub(super) fn whole(&self, Closure { penetration, approach }: Closure) -> State {
        let laws = self.contact.respond(&penetration, &[], 1.0);
        let motions = self.contact.motions(&penetration, &approach);
        let mut rhs = self.load.to_vec();
        for (p, (_, _, point)) in self.contact.points.iter().enumerate() {
            let [g, t1, t2] = directions(point);
            let forces = laws[p].0;
            g.add_to(self.condensed.closed[p] * motions[p] - forces.normal, &mut rhs);
            t1.add_to(forces.friction[0], &mut rhs);
            t2.add_to(forces.friction[1], &mut rhs);
        }
        State { displacement: self.condensed.solve(&rhs), approach, penetration }
    }

    /// The Newton correction of a full state for its residual r = f − K u − r_c; `None` where the contact leaves a motion
    /// free.
    pub(super) fn correction(&self, state: &State, r: &[f64]) -> Option<State> {
        let points = &self.contact.points;
        let n = points.len();
        let laws = self.contact.respond(&state.penetration, &[], 1.0);
        let factor = ScaledLu::new(self.jacobian(&laws), n)?;
        // de = dδ − da + c with c what u and δ are apart.
        let apart = self.contact.apart(state);
        let s = &self.condensed.compliance[0];
        let mut rhs: Vec<f64> = (0..n)
            .map(|p| {
                let forced: f64 =
                    self.condensed.responses.col_as_slice(p).iter().zip(r).map(|(x, r)| x * r).sum();
                let closed: f64 = (0..n).map(|q| s[(p, q)] * self.condensed.closed[q] * apart[q]).sum();
                forced - apart[p] + closed
            })
            .collect();
        rhs.extend(self.contact.closure(&laws, 1.0).iter().map(|gap| -gap));
        let step = factor.solve(&rhs);
        let da = self.contact.approaches(&step[n..]);
        let mut full = r.to_vec();
        for (p, (k, _, point)) in points.iter().enumerate() {
            let [g, t1, t2] = directions(point);
            let (slope, dd) = (laws[p].1.by_penetration, step[p]);
            g.add_to(self.condensed.closed[p] * (dd - da[*k] + apart[p]) - slope[0] * dd, &mut full);
            t1.add_to(slope[1] * dd, &mut full);
            t2.add_to(slope[2] * dd, &mut full);
        }
        let displacement = self.condensed.solve(&full);
        Some(State { displacement, approach: da, penetration: step[..n].to_vec() })
    }
}

/// A small dense factor. Columns are scaled by their displacement rows, then rows by themselves, so that metres, newtons and
/// stiffnesses do not mix.
struct ScaledLu {
    factor: faer::linalg::solvers::FullPivLu<f64>,
    row_scale: Vec<f64>,
    column_scale: Vec<f64>,
}

impl ScaledLu {
    /// Of a matrix whose first `displacements` rows are displacements.
    fn new(mut j: Mat<f64>, displacements: usize) -> Option<Self> {
        let n = j.nrows();
        let over = |largest: f64| (largest.is_finite() && largest > 0.0).then(|| 1.0 / largest);
        let mut column_scale = vec![0.0; n];
        for (k, scale) in column_scale.iter_mut().enumerate() {
            *scale = over(norm(&j.col_as_slice(k)[..displacements]))?;
            j.col_as_slice_mut(k).iter_mut().for_each(|v| *v *= *scale);
        }
        let mut row_scale = vec![0.0; n];
        for i in 0..n {
            row_scale[i] = over((0..n).fold(0.0, |m: f64, k| m.max(j[(i, k)].abs())))?;
            (0..n).for_each(|k| j[(i, k)] *= row_scale[i]);
        }
        let factor = j.full_piv_lu();
        let pivots = (0..n).map(|i| factor.U()[(i, i)].abs());
        let (least, most) = pivots.fold((f64::INFINITY, 0.0f64), |(a, b), p| (a.min(p), b.max(p)));
        (n == 0 || least > 1e-14 * most).then_some(ScaledLu { factor, row_scale, column_scale })
    }

    fn solve(&self, rhs: &[f64]) -> Vec<f64> {
        let mut x = Mat::from_fn(rhs.len(), 1, |i, _| rhs[i] * self.row_scale[i]);
        self.factor.solve_in_place(x.as_mut());
        x.col_as_slice(0).iter().zip(&self.column_scale).map(|(x, c)| x * c).collect()
    }
}
