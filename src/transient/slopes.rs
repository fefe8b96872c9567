//! The derivatives of the contact forces that a tangent was made of.

use super::model::TransientModel;
use super::reaction::Reaction;

/// Numbers of a point: ∂r/∂q + c₁ ∂r/∂q̇ along its directions, friction at rest eliminated, ∂r/∂a, and ∂a/∂q + c₁ ∂a/∂q̇ along its normal.
const EACH: usize = 9 + 3 + 1;

/// The derivatives at one iterate, those by the approach a of pairs that keep their load. A step begins with the tangent that the one before it
/// ended with; it is of the state, so that a run which resumes makes the same iterations.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PointSlopes {
    /// c₁ \[1/s\], then the numbers of each point.
    pub(super) numbers: Vec<f64>,
}

impl PointSlopes {
    /// How many numbers those of a model are.
    pub(super) fn count(model: &TransientModel<'_>) -> usize {
        1 + EACH * model.points.len()
    }

    /// At the place where the reaction was evaluated last.
    pub(super) fn new(model: &TransientModel<'_>, reaction: &Reaction, rate: f64) -> Self {
        let mut numbers = Vec::with_capacity(PointSlopes::count(model));
        numbers.push(rate);
        for point in 0..model.points.len() {
            let (own, by_approach) = reaction.slopes(point, rate);
            let columns = [0, 1, 2].map(|c| reaction.resolved(point, own.map(|row| row[c])));
            numbers.extend((0..3).flat_map(|row| columns.map(|column| column[row])));
            numbers.extend(reaction.resolved(point, by_approach));
            numbers.push(0.0);
        }
        for pair in 0..model.velocities.len() {
            for (direction, slope) in reaction.following(pair, rate) {
                numbers[EACH * (direction / 3 + 1)] = slope;
            }
        }
        PointSlopes { numbers }
    }

    /// c₁ \[1/s\].
    pub(super) fn rate(&self) -> f64 {
        self.numbers[0]
    }

    /// Whether a point answers to no motion.
    pub(super) fn is_silent(&self, point: usize) -> bool {
        self.of(point)[..12].iter().all(|slope| *slope == 0.0)
    }

    /// By how much the approach of each pair follows a motion along the directions.
    pub(super) fn follow(&self, model: &TransientModel<'_>, along: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut follows = vec![0.0; model.velocities.len()];
        for (point, touch) in model.points.iter().enumerate().filter(|(p, _)| self.of(*p)[12] != 0.0) {
            follows[touch.pair] += self.of(point)[12] * along(3 * point);
        }
        follows
    }

    /// The change of the forces of a point with the motion along its directions and with the approach of its pair.
    pub(super) fn change(&self, point: usize, along: [f64; 3], follow: f64) -> [f64; 3] {
        let of = self.of(point);
        [0, 1, 2].map(|row| {
            let own = of[3 * row..3 * row + 3].iter().zip(along).map(|(slope, x)| slope * x).sum::<f64>();
            own + of[9 + row] * follow
        })
    }

    fn of(&self, point: usize) -> &[f64] {
        &self.numbers[1 + EACH * point..1 + EACH * (point + 1)]
    }
}
