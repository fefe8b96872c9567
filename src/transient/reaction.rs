//! The forces along the directions D, as functions of the motion along them.

use super::interface::TravellingInterface;
use super::model::TransientModel;
use crate::equilibrium::ContactBlock;
use crate::system::{ContactMotion, ContactTangent, SlipAnswer, SlipStep};
use faer::Mat;

/// r(q, q̇) with q = Dᵀu, on the left-hand side: (N, −F₁, −F₂) of every contact point, then k q + c q̇ of what was
/// imported; and its derivatives.
#[derive(Debug, Clone)]
pub(super) struct Reaction {
    /// r \[N\].
    pub(super) force: Vec<f64>,
    /// Bristle deflections of each point.
    pub(super) bristles: Vec<Bristles>,
    /// ∂r/∂q \[N/m\] and ∂r/∂q̇ \[N s/m\] of each point.
    blocks: Vec<ContactBlock>,
    /// ∂(F₁, F₂)/∂**F** of the iterate of each point.
    by_friction: Vec<[[f64; 2]; 2]>,
    /// The approach of each pair \[m\].
    pub(super) approaches: Vec<f64>,
    /// How the approach of a pair that keeps its load follows the motion, by direction: ∂a/∂q and ∂a/∂q̇.
    follows: Vec<Vec<(usize, [f64; 2])>>,
    /// ∂r/∂a \[N/m\] of each point whose pair keeps its load.
    by_approach: Vec<[f64; 3]>,
}

/// Internal friction state of a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Bristles {
    /// How far they are bent along t₁ and t₂ \[m\].
    pub(super) bent: [f64; 2],
    /// Whether the point did not slip in the step that ended here.
    pub(super) stick: bool,
}

/// The part of the friction iterate in a linearised row that its law answers with, of 1 at rest. Below 1 it keeps the tangent
/// regular where the friction of several points at rest is not unique.
const HELD: f64 = 1.0 - 1e-8;

/// Arguments of the reactions besides the motion along the directions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment<'a> {
    /// t \[s\].
    pub(super) time: f64,
    /// Where the contacts act.
    pub(super) interface: &'a TravellingInterface,
    /// V of each pair \[m/s\].
    pub(super) speeds: &'a [f64],
    /// Dᵀu, Dᵀv, Dᵀa of the motion at the beginning of the step that ends here, r × 3.
    pub(super) before: &'a Mat<f64>,
}

/// The step that a reaction ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Since<'a> {
    /// ∫V dt of each pair where it began \[m\].
    pub(super) travel: &'a [f64],
    /// The approach of each pair there \[m\].
    pub(super) approaches: &'a [f64],
    /// Bristle deflections of each point there.
    pub(super) bristles: &'a [Bristles],
    /// Δt \[s\].
    pub(super) duration: f64,
    /// The iterate of r \[N\].
    pub(super) force: &'a [f64],
    /// ρ \[N s/m\] of each point.
    pub(super) resistance: &'a [f64],
}

/// A row of the linearised equation r − R(r, q, q̇) = 0, with R the answer of the laws.
#[derive(Debug)]
pub(super) struct LinearisedRow<'a> {
    /// Which one.
    pub(super) place: usize,
    /// ∂R/∂q + c₁ ∂R/∂q̇ by direction.
    pub(super) slopes: &'a [(usize, f64)],
    /// ∂R/∂r by direction.
    pub(super) held: &'a [(usize, f64)],
}

/// ρ of a point \[N s/m\]: about the force that changes the velocity in a time step by 1 m/s, from the compliances of its
/// tangents \[m/N\] and b c₁; any where it cannot move.
pub(super) fn resistance(compliance: [f64; 2], factor: f64) -> f64 {
    let most = factor * compliance[0].max(compliance[1]);
    if most > 0.0 { 1.0 / most } else { 1.0 }
}

impl Reaction {
    pub(super) fn new(model: &TransientModel<'_>) -> Self {
        let silent = |point| ContactBlock::new(point, &ContactTangent::default());
        Reaction {
            force: vec![0.0; model.n_directions()],
            bristles: vec![Bristles::default(); model.points.len()],
            blocks: (0..model.points.len()).map(silent).collect(),
            by_friction: vec![[[0.0; 2]; 2]; model.points.len()],
            approaches: model.approaches.clone(),
            follows: vec![Vec::new(); model.velocities.len()],
            by_approach: vec![[0.0; 3]; model.points.len()],
        }
    }

    /// Evaluates at q, q̇ \[m, m/s\] with what acts at the time of `to`, at the end of a step; or without one, at the start
    /// of all, as in steady sliding.
    pub(super) fn evaluate(
        &mut self,
        model: &TransientModel<'_>,
        [q, rate]: [&[f64]; 2],
        to: Moment<'_>,
        since: Option<Since<'_>>,
    ) {
        self.approach(model, [q, rate], to, since);
        for (p, point) in model.points.iter().enumerate() {
            let at = 3 * p;
            let motion = ContactMotion {
                penetration: self.approaches[point.pair] - to.interface.gaps[p] + q[at],
                penetration_rate: rate[at] + approaching(&self.approaches, point.pair, since),
                slip_velocity: [point.speed * to.speeds[point.pair] - rate[at + 1], -rate[at + 2]],
            };
            let answer = match since {
                Some(Since { travel: before, bristles, duration, force, resistance, .. }) => {
                    let travel = point.speed * (to.interface.travel[point.pair] - before[point.pair]);
                    let moved = [1, 2].map(|c| q[at + c] - to.before[(at + c, 0)]);
                    let since = SlipStep {
                        bristle: bristles[p].bent,
                        slid: [travel - moved[0], -moved[1]],
                        duration,
                        friction: [-force[at + 1], -force[at + 2]],
                        resistance: resistance[p],
                    };
                    point.law.advance(&motion, &since, point.weight)
                }
                None => {
                    let sticks = model.sticks(point.pair);
                    let (forces, tangent) = if sticks {
                        point.law.hold(motion.penetration, [-q[at + 1], -q[at + 2]], point.weight)
                    } else {
                        point.law.respond(&motion, point.weight)
                    };
                    let bristle = point.law.bent(forces.friction, point.weight);
                    SlipAnswer { forces, tangent, bristle, sticks, ..SlipAnswer::default() }
                }
            };
            let SlipAnswer { forces, tangent, by_friction, .. } = answer;
            let values = [forces.normal, -forces.friction[0], -forces.friction[1]];
            self.force[at..at + 3].copy_from_slice(&values);
            self.bristles[p] = Bristles { bent: answer.bristle, stick: answer.sticks };
            let block = ContactBlock::new(p, &tangent);
            let per_step = since.map_or(0.0, |since| 1.0 / since.duration);
            self.by_approach[p] =
                [0, 1, 2].map(|row| block.stiffness[row][0] + per_step * block.damping[row][0]);
            self.blocks[p] = block;
            self.by_friction[p] = by_friction;
        }
        let first = 3 * model.points.len();
        if let Some([k, c]) = model.coupling {
            for i in 0..k.nrows() {
                let row =
                    |a: &Mat<f64>, x: &[f64]| (0..k.ncols()).map(|j| a[(i, j)] * x[first + j]).sum::<f64>();
                self.force[first + i] = row(k, q) + row(c, rate);
            }
        }
    }

    /// Finds the approach a of every pair that keeps its load L: Σ N(δ + a, δ̇ + ȧ) = L with ȧ = Δa/Δt, which has one solution as N
    /// rises with δ. There da = −Σ (N′ dq + c dq̇)/Σ (N′ + c/Δt).
    fn approach(
        &mut self,
        model: &TransientModel<'_>,
        [q, rate]: [&[f64]; 2],
        to: Moment<'_>,
        since: Option<Since<'_>>,
    ) {
        let all_before = since.map_or(&to.interface.approaches[..], |since| since.approaches);
        for (pair, before) in all_before.iter().copied().enumerate() {
            let Some(load) = model.held_load(pair, to.time) else {
                self.approaches[pair] = to.interface.approaches[pair];
                continue;
            };
            let own = model.points.iter().enumerate().filter(|(_, point)| point.pair == pair);
            let per_step = since.map_or(0.0, |since| 1.0 / since.duration);
            let normal = |p: usize, approach: f64| {
                let motion = ContactMotion {
                    penetration: approach - to.interface.gaps[p] + q[3 * p],
                    penetration_rate: rate[3 * p] + per_step * (approach - before),
                    slip_velocity: [model.points[p].speed * to.speeds[pair], 0.0],
                };
                let (forces, tangent) = model.points[p].law.respond(&motion, model.points[p].weight);
                (forces.normal, tangent.by_penetration[0], tangent.by_penetration_rate[0])
            };
            let points: Vec<usize> = own.map(|(p, _)| p).collect();
            let sum = |approach: f64| {
                points
                    .iter()
                    .map(|p| normal(*p, approach))
                    .fold([-load, 0.0], |[force, slope], (n, k, c)| [force + n, slope + k + per_step * c])
            };
            // Where the first point touches, the others being farther off.
            let touching =
                points.iter().map(|p| to.interface.gaps[*p] - q[3 * p]).fold(f64::INFINITY, f64::min);
            let approach = rising_root(&sum, before, touching);
            self.approaches[pair] = approach;
            let [_, slope] = sum(approach);
            self.follows[pair].clear();
            if slope > 0.0 {
                let share = |p: &usize| {
                    let (_, k, c) = normal(*p, approach);
                    (3 * p, [-k / slope, -c / slope])
                };
                self.follows[pair].extend(points.iter().map(share));
            }
        }
    }

    /// The largest part of r by which friction that is set-valued at rest differs from its iterate.
    pub(super) fn mismatch(&self, force: &[f64]) -> f64 {
        let off = (0..self.blocks.len()).filter(|p| self.holds(*p)).flat_map(|p| [3 * p + 1, 3 * p + 2]);
        let largest = self.force.iter().fold(f64::MIN_POSITIVE, |m, r| m.max(r.abs()));
        off.map(|k| (self.force[k] - force[k]).abs()).fold(0.0, f64::max) / largest
    }

    /// Calls `visit` with every row of the linearised equation in which something acts.
    pub(super) fn rows(
        &self,
        model: &TransientModel<'_>,
        rate: f64,
        visit: &mut dyn FnMut(LinearisedRow<'_>),
    ) {
        let acting = self.blocks.iter().filter(|block| block.acts() || self.holds(block.point));
        for block in acting {
            let first = 3 * block.point;
            let held = self.by_friction[block.point];
            for own in 0..3 {
                let slope = |other: usize| block.stiffness[own][other] + rate * block.damping[own][other];
                let slopes = [0, 1, 2].map(|other| (first + other, slope(other)));
                let held = match own {
                    0 => [0.0; 2],
                    _ => held[own - 1].map(|h| HELD * h),
                };
                let held = [(first + 1, held[0]), (first + 2, held[1])];
                let follows = &self.follows[model.points[block.point].pair];
                if follows.is_empty() {
                    visit(LinearisedRow { place: first + own, slopes: &slopes, held: &held });
                } else {
                    let by_approach = self.by_approach[block.point][own];
                    let along = follows
                        .iter()
                        .map(|(k, [by_q, by_rate])| (*k, by_approach * (by_q + rate * by_rate)));
                    let slopes: Vec<(usize, f64)> = slopes.into_iter().chain(along).collect();
                    visit(LinearisedRow { place: first + own, slopes: &slopes, held: &held });
                }
            }
        }
        if let Some([k, c]) = model.coupling {
            let first = 3 * model.points.len();
            for i in 0..k.nrows() {
                let slopes: Vec<(usize, f64)> =
                    (0..k.ncols()).map(|j| (first + j, k[(i, j)] + rate * c[(i, j)])).collect();
                visit(LinearisedRow { place: first + i, slopes: &slopes, held: &[] });
            }
        }
    }

    /// ∂R/∂q + c₁ ∂R/∂q̇ of a point along its directions, c₁ being `rate`, and ∂R/∂a of one whose pair keeps its load.
    pub(super) fn slopes(&self, point: usize, rate: f64) -> ([[f64; 3]; 3], [f64; 3]) {
        let block = &self.blocks[point];
        let slope = |own: usize, other: usize| block.stiffness[own][other] + rate * block.damping[own][other];
        ([0, 1, 2].map(|own| [0, 1, 2].map(|other| slope(own, other))), self.by_approach[point])
    }

    /// ∂a/∂q + c₁ ∂a/∂q̇ of a pair by direction, c₁ being `rate`; none where it keeps its approach.
    pub(super) fn following(&self, pair: usize, rate: f64) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.follows[pair].iter().map(move |(k, [by_q, by_rate])| (*k, by_q + rate * by_rate))
    }

    /// (I − ∂R/∂r)⁻¹ x of a point.
    pub(super) fn resolved(&self, point: usize, [normal, x, y]: [f64; 3]) -> [f64; 3] {
        if !self.holds(point) {
            return [normal, x, y];
        }
        let h = self.by_friction[point].map(|row| row.map(|h| HELD * h));
        let [a, b, c, d] = [1.0 - h[0][0], -h[0][1], -h[1][0], 1.0 - h[1][1]];
        let determinant = a * d - b * c;
        [normal, (d * x - b * y) / determinant, (a * y - c * x) / determinant]
    }

    pub(super) fn holds(&self, point: usize) -> bool {
        self.by_friction[point] != [[0.0; 2]; 2]
    }
}

/// ȧ of a pair \[m/s\] in a step.
fn approaching(approaches: &[f64], pair: usize, since: Option<Since<'_>>) -> f64 {
    since.map_or(0.0, |since| (approaches[pair] - since.approaches[pair]) / since.duration)
}

/// The root of a function that rises from below zero at `low` and beyond all bounds, by Newton's method from `first` within
/// a bracket; `sum` gives its value and its slope.
fn rising_root(sum: &dyn Fn(f64) -> [f64; 2], first: f64, low: f64) -> f64 {
    let (mut low, mut high) = (low, f64::INFINITY);
    let mut x = first;
    let mut stride = 0.0f64;
    for _ in 0..200 {
        let [value, slope] = sum(x);
        if value == 0.0 || !value.is_finite() {
            return x;
        }
        if value > 0.0 {
            high = high.min(x);
            if low >= x {
                // A contact that pulls, or whose dashpot presses.
                low = f64::NEG_INFINITY;
            }
        } else {
            low = low.max(x);
        }
        let newton = x - value / slope;
        let inside = newton.is_finite() && newton >= low.min(x) && newton <= high.max(x);
        let next = if inside {
            newton
        } else if high.is_finite() && low.is_finite() && low < high {
            0.5 * (low + high)
        } else {
            // Nothing touches yet, or the function pulls below: strides that double.
            stride = 2.0 * stride.max((x - low).abs()).max(f64::EPSILON * x.abs()).max(f64::MIN_POSITIVE);
            x + stride
        };
        if (next - x).abs() <= f64::EPSILON * next.abs() {
            return next;
        }
        x = next;
    }
    x
}
