//! Newton's method on the condensed contact problem.

use super::condensed::Condensed;
use super::linear::directions;
use super::steady::SteadyOptions;
use crate::error::{Error, Result};
use crate::system::{Closing, ContactForces, ContactMotion, ContactPair, ContactPoint, ContactTangent};
use faer::Mat;
use faer::linalg::solvers::Solve;

/// The condensed problem: with e = gᵀu of every point and an approach a for every pair closed by a load,
///
/// e = e₀ + S (d e − N) + T₁ F₁ + T₂ F₂,  ΣN = L,  (N, F) = law(a − gap + e), S = gᵀA⁻¹g, T = gᵀA⁻¹t, e₀ = gᵀA⁻¹f.
pub(super) struct Contact<'a> {
    pairs: &'a [ContactPair],
    load: &'a [f64],
    condensed: &'a Condensed,
    points: Vec<(usize, &'a ContactPair, &'a ContactPoint)>,
    unloaded: Vec<f64>,
    /// Pairs whose approach is unknown.
    loaded: Vec<usize>,
}

/// A solution of the condensed problem.
pub(super) struct Stage {
    pub(super) normal: Vec<f64>,
    pub(super) approach: Vec<f64>,
    pub(super) iterations: usize,
}

/// Where a load step stands: the fraction of load and of friction.
type Fraction = f64;

impl<'a> Contact<'a> {
    pub(super) fn new(pairs: &'a [ContactPair], load: &'a [f64], condensed: &'a Condensed) -> Self {
        let points: Vec<_> = pairs
            .iter()
            .enumerate()
            .flat_map(|(k, pair)| pair.points.iter().map(move |p| (k, pair, p)))
            .collect();
        let loaded = (0..pairs.len()).filter(|k| matches!(pairs[*k].closing, Closing::Load(_))).collect();
        let unloaded = condensed.unloaded(load);
        Contact { pairs, load, condensed, points, unloaded, loaded }
    }

    /// Newton from first touch; when that fails, in steps of load and friction.
    pub(super) fn solve(&self, options: &SteadyOptions) -> Result<Stage> {
        let mut last = None;
        for start in self.starts(1.0) {
            match self.newton(start, 1.0, options) {
                Ok(stage) => return Ok(stage),
                Err(failure) => last = Some(failure),
            }
        }
        self.stepped(options).map_err(|failure| {
            let failure = failure.or(last).unwrap_or_else(|| "no contact point".into());
            Error::analysis(
                "steady sliding",
                format!("no steady state was found, neither at once nor in load steps; {failure}"),
                "Check that the load presses against a support, or lower the friction: it may jam",
            )
        })
    }

    fn stepped(&self, options: &SteadyOptions) -> std::result::Result<Stage, Option<String>> {
        let (mut done, mut step): (Fraction, Fraction) = (0.0, 0.125);
        let mut from: Option<Stage> = None;
        let mut iterations = 0;
        while done < 1.0 {
            let target = (done + step).min(1.0);
            let start = match &from {
                Some(stage) => vec![(stage.normal.clone(), stage.approach.clone())],
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
        from.map(|stage| Stage { iterations, ..stage }).ok_or(None)
    }

    /// Where to begin: undeformed, at the approach that carries the load; and with every point pressed a little.
    fn starts(&self, fraction: Fraction) -> Vec<(Vec<f64>, Vec<f64>)> {
        let zero = vec![0.0; self.points.len()];
        let approach: Vec<f64> = self.pairs.iter().map(|pair| first_approach(pair, fraction)).collect();
        let pressed = self
            .points
            .iter()
            .enumerate()
            .map(|(p, (k, _, point))| point.gap - approach[*k] + 1e-3 * self.unloaded[p].abs().max(1e-9))
            .collect();
        vec![(zero, approach.clone()), (pressed, approach)]
    }

    /// Damped Newton with the natural monotonicity test: a step is taken when the next simplified step is shorter.
    fn newton(
        &self,
        (mut normal, mut approach): (Vec<f64>, Vec<f64>),
        fraction: Fraction,
        options: &SteadyOptions,
    ) -> std::result::Result<Stage, String> {
        let mut length = f64::INFINITY;
        for iteration in 1..=options.max_iterations {
            let laws = self.respond(&normal, &approach, fraction);
            let Some(factor) = Small::new(self.jacobian(&laws)) else {
                return Err(format!("at iteration {iteration} the contact leaves a motion free"));
            };
            let step = factor.solve(&self.residual(&normal, &laws, fraction));
            length = norm(&step);
            let scale = self.scale(&normal, &approach);
            if !length.is_finite() {
                return Err(format!("at iteration {iteration} the step is not finite"));
            }
            let mut damping = 1.0;
            loop {
                let (next, next_approach) = self.moved(&normal, &approach, &step, -damping);
                if length <= 1e-11 * scale {
                    return Ok(Stage { normal: next, approach: next_approach, iterations: iteration });
                }
                let laws = self.respond(&next, &next_approach, fraction);
                let again = norm(&factor.solve(&self.residual(&next, &laws, fraction)));
                if again <= (1.0 - 0.25 * damping) * length || damping < 1e-3 {
                    (normal, approach) = (next, next_approach);
                    break;
                }
                damping *= 0.5;
            }
        }
        Err(format!("after {} iterations the Newton step is still {length:.1e} m", options.max_iterations))
    }

    fn respond(
        &self,
        normal: &[f64],
        approach: &[f64],
        fraction: Fraction,
    ) -> Vec<(ContactForces, ContactTangent)> {
        let at = |p: usize| {
            let (k, pair, point) = self.points[p];
            let motion = ContactMotion {
                penetration: approach[k] - point.gap + normal[p],
                penetration_rate: 0.0,
                slip_velocity: [pair.sliding_velocity, 0.0],
            };
            let (mut forces, mut tangent) = pair.law.respond(&motion, point.weight);
            for i in 0..2 {
                forces.friction[i] *= fraction;
                tangent.by_penetration[1 + i] *= fraction;
            }
            (forces, tangent)
        };
        (0..self.points.len()).map(at).collect()
    }

    /// e − e₀ − S (d e − N) − T₁F₁ − T₂F₂, then ΣN − L.
    fn residual(
        &self,
        normal: &[f64],
        laws: &[(ContactForces, ContactTangent)],
        fraction: Fraction,
    ) -> Vec<f64> {
        let [s, t1, t2] = &self.condensed.compliance;
        let n = self.points.len();
        let mut rho: Vec<f64> = (0..n)
            .map(|p| {
                let answer: f64 = (0..n)
                    .map(|q| {
                        let forces = laws[q].0;
                        s[(p, q)] * (self.condensed.closed[q] * normal[q] - forces.normal)
                            + t1[(p, q)] * forces.friction[0]
                            + t2[(p, q)] * forces.friction[1]
                    })
                    .sum();
                normal[p] - fraction * self.unloaded[p] - answer
            })
            .collect();
        for k in &self.loaded {
            let carried: f64 = (0..n).filter(|p| self.points[*p].0 == *k).map(|p| laws[p].0.normal).sum();
            rho.push(carried - fraction * load(&self.pairs[*k]));
        }
        rho
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
                j[(p, q)] = identity - s[(p, q)] * self.condensed.closed[q] + by_law;
                if let Some(approach) = unknown {
                    j[(p, approach)] += by_law;
                }
            }
            if let Some(approach) = unknown {
                j[(approach, q)] += slope[0];
                j[(approach, approach)] += slope[0];
            }
        }
        j
    }

    fn moved(&self, normal: &[f64], approach: &[f64], step: &[f64], factor: f64) -> (Vec<f64>, Vec<f64>) {
        let next = normal.iter().zip(step).map(|(e, s)| e + factor * s).collect();
        let mut next_approach = approach.to_vec();
        for (c, k) in self.loaded.iter().enumerate() {
            next_approach[*k] += factor * step[normal.len() + c];
        }
        (next, next_approach)
    }

    /// The length that steps are measured by: the largest displacement or penetration in sight.
    fn scale(&self, normal: &[f64], approach: &[f64]) -> f64 {
        let deepest = (0..normal.len()).map(|p| {
            let (k, _, point) = self.points[p];
            normal[p].abs().max((approach[k] - point.gap + normal[p]).abs())
        });
        deepest.fold(f64::MIN_POSITIVE, f64::max)
    }

    /// u = A⁻¹ (f + Σ g (d e − N) + t₁F₁ + t₂F₂).
    pub(super) fn displacement(&self, stage: &Stage) -> Vec<f64> {
        let laws = self.respond(&stage.normal, &stage.approach, 1.0);
        let mut rhs = self.load.to_vec();
        for (p, (_, _, point)) in self.points.iter().enumerate() {
            let [g, t1, t2] = directions(point);
            let forces = laws[p].0;
            g.add_to(self.condensed.closed[p] * stage.normal[p] - forces.normal, &mut rhs);
            t1.add_to(forces.friction[0], &mut rhs);
            t2.add_to(forces.friction[1], &mut rhs);
        }
        self.condensed.solve(&rhs)
    }

    /// The Newton correction (du, da) of the full system for its residual r = f − K u − r_c.
    pub(super) fn full_correction(
        &self,
        u: &[f64],
        approach: &[f64],
        r: &[f64],
    ) -> Option<(Vec<f64>, Vec<f64>)> {
        let n = self.points.len();
        let normal: Vec<f64> = self.points.iter().map(|(_, _, p)| p.normal.dot(u)).collect();
        let laws = self.respond(&normal, approach, 1.0);
        let factor = Small::new(self.jacobian(&laws))?;
        let mut rhs: Vec<f64> = (0..n)
            .map(|p| self.condensed.responses.col_as_slice(p).iter().zip(r).map(|(x, r)| x * r).sum())
            .collect();
        let closure = self.residual(&normal, &laws, 1.0);
        rhs.extend(closure[n..].iter().map(|gap| -gap));
        let step = factor.solve(&rhs);
        let mut da = vec![0.0; approach.len()];
        for (c, k) in self.loaded.iter().enumerate() {
            da[*k] = step[n + c];
        }
        let mut full = r.to_vec();
        for (p, (k, _, point)) in self.points.iter().enumerate() {
            let [g, t1, t2] = directions(point);
            let (slope, dd) = (laws[p].1.by_penetration, step[p] + da[*k]);
            g.add_to(self.condensed.closed[p] * step[p] - slope[0] * dd, &mut full);
            t1.add_to(slope[1] * dd, &mut full);
            t2.add_to(slope[2] * dd, &mut full);
        }
        Some((self.condensed.solve(&full), da))
    }
}

/// The approach at which the undeformed bodies carry the load, by bisection (N grows with the approach).
fn first_approach(pair: &ContactPair, fraction: Fraction) -> f64 {
    let load = match pair.closing {
        Closing::Approach(approach) => return approach,
        Closing::Load(load) => load,
    };
    let carried = |a: f64| -> f64 {
        let at = |point: &ContactPoint| {
            let motion = ContactMotion {
                penetration: a - point.gap,
                penetration_rate: 0.0,
                slip_velocity: [pair.sliding_velocity, 0.0],
            };
            pair.law.respond(&motion, point.weight).0.normal
        };
        pair.points.iter().map(at).sum()
    };
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

fn norm(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, v| if v.is_nan() { f64::NAN } else { f64::max(m, v.abs()) })
}

/// A small dense factor, rows scaled so that metres and newtons do not mix.
struct Small {
    factor: faer::linalg::solvers::FullPivLu<f64>,
    row_scale: Vec<f64>,
}

impl Small {
    fn new(mut j: Mat<f64>) -> Option<Self> {
        let n = j.nrows();
        let mut row_scale = vec![0.0; n];
        for i in 0..n {
            let largest = (0..n).fold(0.0, |m: f64, k| m.max(j[(i, k)].abs()));
            if !(largest.is_finite() && largest > 0.0) {
                return None;
            }
            row_scale[i] = 1.0 / largest;
            (0..n).for_each(|k| j[(i, k)] *= row_scale[i]);
        }
        let factor = j.full_piv_lu();
        let pivots = (0..n).map(|i| factor.U()[(i, i)].abs());
        let (least, most) = pivots.fold((f64::INFINITY, 0.0f64), |(a, b), p| (a.min(p), b.max(p)));
        (n == 0 || least > 1e-14 * most).then_some(Small { factor, row_scale })
    }

    fn solve(&self, rhs: &[f64]) -> Vec<f64> {
        let mut x = Mat::from_fn(rhs.len(), 1, |i, _| rhs[i] * self.row_scale[i]);
        self.factor.solve_in_place(x.as_mut());
        x.col_as_slice(0).to_vec()
    }
}
