//! Newton's method on the condensed contact problem.

use super::SteadyOptions;
use super::condensed::Condensed;
use super::linear::directions;
use crate::error::{Error, Result};
use crate::system::{Closing, ContactForces, ContactMotion, ContactPair, ContactPoint, ContactTangent};
use faer::Mat;
use faer::linalg::solvers::Solve;

/// The condensed problem: with the penetration δ of every point and an approach a for every pair closed by a load,
///
/// e = e₀ + S (d e − N) + T₁ F₁ + T₂ F₂,  ΣN = L,  (N, F) = law(δ), e = gᵀu = δ − a + gap,
///
/// S = gᵀA⁻¹g, T = gᵀA⁻¹t, e₀ = gᵀA⁻¹f. The penetration is an unknown of its own: as the difference a − gap + e it would
/// lose the digits that a stiff law, where δ is far smaller than e, needs for its force.
pub(super) struct ContactProblem<'a> {
    pairs: &'a [ContactPair],
    load: &'a [f64],
    condensed: &'a Condensed,
    points: Vec<(usize, &'a ContactPair, &'a ContactPoint)>,
    unloaded: Vec<f64>,
    /// Pairs whose approach is unknown.
    loaded: Vec<usize>,
}

/// A solution of the condensed problem.
pub(super) struct ContactSolution {
    /// δ of every point \[m\].
    pub(super) penetration: Vec<f64>,
    /// a of every pair \[m\].
    pub(super) approach: Vec<f64>,
    pub(super) iterations: usize,
}

/// A change of the full state.
pub(super) struct Correction {
    pub(super) displacement: Vec<f64>,
    pub(super) approach: Vec<f64>,
    pub(super) penetration: Vec<f64>,
}

impl Correction {
    /// Adds it to a state.
    pub(super) fn add_to(&self, u: &mut [f64], approach: &mut [f64], penetration: &mut [f64]) {
        let add = |x: &mut [f64], d: &[f64]| x.iter_mut().zip(d).for_each(|(x, d)| *x += d);
        add(u, &self.displacement);
        add(approach, &self.approach);
        add(penetration, &self.penetration);
    }
}

/// Why no solution was accepted.
const NOT_MET: &str = "the equations are met to more than 1e-6 of the forces";

/// Where a load step stands: the fraction of load and of friction.
type Fraction = f64;

impl<'a> ContactProblem<'a> {
    pub(super) fn new(pairs: &'a [ContactPair], load: &'a [f64], condensed: &'a Condensed) -> Self {
        let points: Vec<_> = pairs
            .iter()
            .enumerate()
            .flat_map(|(k, pair)| pair.points.iter().map(move |p| (k, pair, p)))
            .collect();
        let loaded = (0..pairs.len()).filter(|k| matches!(pairs[*k].closing, Closing::Load(_))).collect();
        let unloaded = condensed.unloaded(load);
        ContactProblem { pairs, load, condensed, points, unloaded, loaded }
    }

    /// Newton from first touch; when that fails, in steps of load and friction.
    pub(super) fn solve(&self, options: &SteadyOptions) -> Result<ContactSolution> {
        self.solve_accepted(options, Some)
    }

    /// The first solution that is accepted, as `accept` gives it. A body that only closed contacts hold has, with every
    /// contact open, equations that are singular but for rounding, and a solution far away that means nothing.
    pub(super) fn solve_accepted<T>(
        &self,
        options: &SteadyOptions,
        mut accept: impl FnMut(ContactSolution) -> Option<T>,
    ) -> Result<T> {
        let mut last = None;
        for start in self.starts(1.0) {
            match self.newton(start, 1.0, options).map(&mut accept) {
                Ok(Some(accepted)) => return Ok(accepted),
                Ok(None) => {}
                Err(failure) => last = Some(failure),
            }
        }
        let stepped = self.stepped(options).map(|solution| accept(solution).ok_or(None));
        stepped.flatten().map_err(|failure| {
            let failure = failure.or(last).unwrap_or_else(|| NOT_MET.into());
            Error::analysis(
                "steady sliding",
                format!("no steady state was found, neither at once nor in load steps; {failure}"),
                "Check that the load presses against a support, or lower the friction: it may jam; that the stiffnesses of contacts, springs \
                 and supports do not span too many orders of magnitude",
            )
        })
    }

    fn stepped(&self, options: &SteadyOptions) -> std::result::Result<ContactSolution, Option<String>> {
        let (mut done, mut step): (Fraction, Fraction) = (0.0, 0.125);
        let mut from: Option<ContactSolution> = None;
        let mut iterations = 0;
        while done < 1.0 {
            let target = (done + step).min(1.0);
            let start = match &from {
                Some(stage) => vec![(stage.penetration.clone(), stage.approach.clone())],
                None => self.starts(target),
            };
            let mut failure = None;
            let found = start.into_iter().find_map(|s| match self.newton(s, target, options) {
                Ok(stage) => Some(stage),
                Err(f) => {
                    failure = Some(f);
                    None
                }
            });
            match found {
                Some(stage) => {
                    iterations += stage.iterations;
                    from = Some(stage);
                    done = target;
                    step *= 1.5;
                }
                None if step > 1e-3 => step *= 0.5,
                None => return Err(failure),
            }
        }
        from.map(|stage| ContactSolution { iterations, ..stage }).ok_or(None)
    }

    /// Where to begin: undeformed, at the approach that carries the load; and with every point pressed a little.
    fn starts(&self, fraction: Fraction) -> Vec<(Vec<f64>, Vec<f64>)> {
        let approach: Vec<f64> = self.pairs.iter().map(|pair| first_approach(pair, fraction)).collect();
        let undeformed = self.points.iter().map(|(k, _, point)| approach[*k] - point.gap).collect();
        let pressed = self.unloaded.iter().map(|e| 1e-3 * e.abs().max(1e-9)).collect();
        vec![(undeformed, approach.clone()), (pressed, approach)]
    }

    /// Damped Newton with the natural monotonicity test: a step is taken when the next simplified step is shorter. It ends
    /// when neither the lengths nor the forces change any more.
    fn newton(
        &self,
        (mut penetration, mut approach): (Vec<f64>, Vec<f64>),
        fraction: Fraction,
        options: &SteadyOptions,
    ) -> std::result::Result<ContactSolution, String> {
        let mut length = f64::INFINITY;
        for iteration in 1..=options.max_iterations {
            let laws = self.respond(&penetration, fraction);
            if !laws.iter().all(|(forces, tangent)| {
                (forces.normal + tangent.by_penetration.iter().sum::<f64>()).is_finite()
            }) {
                return Err(format!("at iteration {iteration} a force of the contact is not finite"));
            }
            let Some(factor) = ScaledLu::new(self.jacobian(&laws), self.points.len()) else {
                return Err(format!("at iteration {iteration} the contact leaves a motion free"));
            };
            let step = factor.solve(&self.residual(&penetration, &approach, &laws, fraction));
            length = self.length(&step);
            if !length.is_finite() {
                return Err(format!("at iteration {iteration} the step is not finite"));
            }
            let settled = length <= 1e-11 * self.scale(&penetration, &approach)
                && force_change(&laws, &step) <= 1e-9 * largest_force(&laws);
            let mut damping = 1.0;
            loop {
                let (next, next_approach) = self.moved(&penetration, &approach, &step, -damping);
                if settled {
                    return Ok(ContactSolution {
                        penetration: next,
                        approach: next_approach,
                        iterations: iteration,
                    });
                }
                let laws = self.respond(&next, fraction);
                let again =
                    self.length(&factor.solve(&self.residual(&next, &next_approach, &laws, fraction)));
                if again <= (1.0 - 0.25 * damping) * length || damping < 1e-3 {
                    (penetration, approach) = (next, next_approach);
                    break;
                }
                damping *= 0.5;
            }
        }
        Err(format!("after {} iterations the Newton step is still {length:.1e} m", options.max_iterations))
    }

    fn respond(&self, penetration: &[f64], fraction: Fraction) -> Vec<(ContactForces, ContactTangent)> {
        let at = |(penetration, (_, pair, point)): (&f64, &(usize, &ContactPair, &ContactPoint))| {
            let (mut forces, mut tangent) = respond(pair, point, *penetration);
            for i in 0..2 {
                forces.friction[i] *= fraction;
                tangent.by_penetration[1 + i] *= fraction;
            }
            (forces, tangent)
        };
        penetration.iter().zip(&self.points).map(at).collect()
    }

    /// e = δ − a + gap of every point.
    fn motions(&self, penetration: &[f64], approach: &[f64]) -> Vec<f64> {
        penetration
            .iter()
            .zip(&self.points)
            .map(|(d, (k, _, point))| d - (approach[*k] - point.gap))
            .collect()
    }

    /// e − e₀ − S (d e − N) − T₁F₁ − T₂F₂, then ΣN − L.
    fn residual(
        &self,
        penetration: &[f64],
        approach: &[f64],
        laws: &[(ContactForces, ContactTangent)],
        fraction: Fraction,
    ) -> Vec<f64> {
        let [s, t1, t2] = &self.condensed.compliance;
        let n = self.points.len();
        let motions = self.motions(penetration, approach);
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
        rho.extend(self.closure(laws, fraction));
        rho
    }

    /// ΣN − L of each loaded pair.
    fn closure(&self, laws: &[(ContactForces, ContactTangent)], fraction: Fraction) -> Vec<f64> {
        let carried = |k: usize| -> f64 {
            self.points
                .iter()
                .zip(laws)
                .filter(|((pair, ..), _)| *pair == k)
                .map(|(_, law)| law.0.normal)
                .sum()
        };
        self.loaded.iter().map(|k| carried(*k) - fraction * load(&self.pairs[*k])).collect()
    }

    fn jacobian(&self, laws: &[(ContactForces, ContactTangent)]) -> Mat<f64> {
        let [s, t1, t2] = &self.condensed.compliance;
        let n = self.points.len();
        let mut j = Mat::<f64>::zeros(n + self.loaded.len(), n + self.loaded.len());
        for q in 0..n {
            let slope = laws[q].1.by_penetration;
            let unknown = self.loaded.iter().position(|k| *k == self.points[q].0).map(|c| n + c);
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
        let change = self.approaches(step);
        (next, approach.iter().zip(change).map(|(a, s)| a + factor * s).collect())
    }

    /// The part of a step that is of the approaches, one a pair.
    fn approaches(&self, step: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.pairs.len()];
        self.loaded.iter().zip(&step[self.points.len()..]).for_each(|(k, da)| all[*k] = *da);
        all
    }

    /// The largest change of a motion e or an approach in a step.
    fn length(&self, step: &[f64]) -> f64 {
        let da = self.approaches(step);
        let de = step.iter().zip(&self.points).map(|(dd, (k, ..))| dd - da[*k]);
        norm(&de.chain(da.iter().copied()).collect::<Vec<_>>())
    }

    /// The length that steps are measured by: the largest displacement or penetration in sight.
    fn scale(&self, penetration: &[f64], approach: &[f64]) -> f64 {
        let motions = self.motions(penetration, approach);
        norm(&motions).max(norm(penetration)).max(f64::MIN_POSITIVE)
    }

    /// u = A⁻¹ (f + Σ g (d e − N) + t₁F₁ + t₂F₂).
    pub(super) fn displacement(&self, stage: &ContactSolution) -> Vec<f64> {
        let laws = self.respond(&stage.penetration, 1.0);
        let motions = self.motions(&stage.penetration, &stage.approach);
        let mut rhs = self.load.to_vec();
        for (p, (_, _, point)) in self.points.iter().enumerate() {
            let [g, t1, t2] = directions(point);
            let forces = laws[p].0;
            g.add_to(self.condensed.closed[p] * motions[p] - forces.normal, &mut rhs);
            t1.add_to(forces.friction[0], &mut rhs);
            t2.add_to(forces.friction[1], &mut rhs);
        }
        self.condensed.solve(&rhs)
    }

    /// How far a state is from fitting together: the largest |δ − (a − gap + gᵀu)| relative to the lengths in it, and the
    /// largest |ΣN − L| relative to L.
    pub(super) fn mismatch(&self, u: &[f64], approach: &[f64], penetration: &[f64]) -> f64 {
        let scale = self.scale(penetration, approach);
        let apart = norm(&self.apart(u, approach, penetration)) / scale;
        let closure = self.closure(&self.respond(penetration, 1.0), 1.0);
        let relative = |(k, gap): (&usize, &f64)| gap.abs() / load(&self.pairs[*k]);
        self.loaded.iter().zip(&closure).map(relative).fold(apart, f64::max)
    }

    /// δ − (a − gap + gᵀu) of every point.
    fn apart(&self, u: &[f64], approach: &[f64], penetration: &[f64]) -> Vec<f64> {
        let motions = self.motions(penetration, approach);
        motions.iter().zip(&self.points).map(|(e, (_, _, point))| e - point.normal.dot(u)).collect()
    }

    /// The Newton correction of a full state for its residual r = f − K u − r_c; `None` where the contact leaves a motion
    /// free.
    pub(super) fn full_correction(
        &self,
        u: &[f64],
        approach: &[f64],
        penetration: &[f64],
        r: &[f64],
    ) -> Option<Correction> {
        let n = self.points.len();
        let laws = self.respond(penetration, 1.0);
        let factor = ScaledLu::new(self.jacobian(&laws), n)?;
        // de = dδ − da + c with c what u and δ are apart.
        let apart = self.apart(u, approach, penetration);
        let s = &self.condensed.compliance[0];
        let mut rhs: Vec<f64> = (0..n)
            .map(|p| {
                let forced: f64 =
                    self.condensed.responses.col_as_slice(p).iter().zip(r).map(|(x, r)| x * r).sum();
                let closed: f64 = (0..n).map(|q| s[(p, q)] * self.condensed.closed[q] * apart[q]).sum();
                forced - apart[p] + closed
            })
            .collect();
        rhs.extend(self.closure(&laws, 1.0).iter().map(|gap| -gap));
        let step = factor.solve(&rhs);
        let da = self.approaches(&step);
        let mut full = r.to_vec();
        for (p, (k, _, point)) in self.points.iter().enumerate() {
            let [g, t1, t2] = directions(point);
            let (slope, dd) = (laws[p].1.by_penetration, step[p]);
            g.add_to(self.condensed.closed[p] * (dd - da[*k] + apart[p]) - slope[0] * dd, &mut full);
            t1.add_to(slope[1] * dd, &mut full);
            t2.add_to(slope[2] * dd, &mut full);
        }
        let displacement = self.condensed.solve(&full);
        Some(Correction { displacement, approach: da, penetration: step[..n].to_vec() })
    }
}

/// The law of a point at a penetration, in steady sliding.
pub(super) fn respond(
    pair: &ContactPair,
    point: &ContactPoint,
    penetration: f64,
) -> (ContactForces, ContactTangent) {
    let motion =
        ContactMotion { penetration, penetration_rate: 0.0, slip_velocity: [pair.sliding_velocity, 0.0] };
    pair.law.respond(&motion, point.weight)
}

/// The largest change of a normal force in a step.
fn force_change(laws: &[(ContactForces, ContactTangent)], step: &[f64]) -> f64 {
    laws.iter().zip(step).map(|(law, dd)| (law.1.by_penetration[0] * dd).abs()).fold(0.0, f64::max)
}

fn largest_force(laws: &[(ContactForces, ContactTangent)]) -> f64 {
    laws.iter().map(|law| law.0.normal.abs()).fold(0.0, f64::max)
}

/// The approach at which the undeformed bodies carry the load, by bisection (N grows with the approach).
fn first_approach(pair: &ContactPair, fraction: Fraction) -> f64 {
    let load = match pair.closing {
        Closing::Approach(approach) => return approach,
        Closing::Load(load) => load,
    };
    let carried = |a: f64| -> f64 { pair.points.iter().map(|p| respond(pair, p, a - p.gap).0.normal).sum() };
    let touch = pair.points.iter().map(|p| p.gap).fold(f64::INFINITY, f64::min);
    let mut beyond = 1e-9;
    while carried(touch + beyond) < fraction * load && beyond < 1e6 {
        beyond *= 2.0;
    }
    let (mut low, mut high) = (0.0, beyond);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if carried(touch + middle) < fraction * load { low = middle } else { high = middle }
    }
    touch + high
}

fn load(pair: &ContactPair) -> f64 {
    match pair.closing {
        Closing::Load(load) => load,
        Closing::Approach(_) => 0.0,
    }
}

/// max |xᵢ|; not a number where one of them is none.
pub(super) fn norm(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m: f64, v| if m.is_nan() || v.is_nan() { f64::NAN } else { m.max(v.abs()) })
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
