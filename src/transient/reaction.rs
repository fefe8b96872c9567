//! The forces along the directions D, as functions of the motion along them.

use super::interface::Interface;
use super::model::Model;
use super::state::State;
use crate::equilibrium::ContactBlock;
use crate::system::{ContactMotion, ContactTangent, SlipAnswer, SlipStep};
use faer::Mat;

/// r(q, q̇) with q = Dᵀu, on the left-hand side: (N, −F₁, −F₂) of every contact point, then k q + c q̇ of what was
/// imported; and its derivatives.
#[derive(Debug, Clone)]
pub(super) struct Reaction {
    /// r \[N\].
    pub(super) force: Vec<f64>,
    /// What each point remembers.
    pub(super) bristles: Vec<Bristles>,
    /// ∂r/∂q \[N/m\] and ∂r/∂q̇ \[N s/m\] of each point.
    blocks: Vec<ContactBlock>,
}

/// What a contact point remembers from step to step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Bristles {
    /// How far they are bent along t₁ and t₂ \[m\].
    pub(super) bent: [f64; 2],
    /// Whether the point did not slip in the step that ended here.
    pub(super) stick: bool,
}

/// Takes a column and its entries, each with its row.
pub(super) type TellColumn<'a> = dyn FnMut(usize, &[(usize, f64)]) + 'a;

/// The step that a reaction ends: where it began, and how long it is \[s\].
pub(super) type Since<'a> = (&'a State, f64);

impl Reaction {
    pub(super) fn new(model: &Model<'_>) -> Self {
        let silent = |point| ContactBlock::new(point, &ContactTangent::default());
        Reaction {
            force: vec![0.0; model.n_directions()],
            bristles: vec![Bristles::default(); model.points.len()],
            blocks: (0..model.points.len()).map(silent).collect(),
        }
    }

    /// Evaluates at q, q̇ \[m, m/s\] with what acts at the time of `to`, at the end of a step; or without one, at the start
    /// of all, as in steady sliding.
    pub(super) fn evaluate(
        &mut self,
        model: &Model<'_>,
        [q, rate]: [&[f64]; 2],
        to: &State,
        since: Option<Since<'_>>,
    ) {
        for (p, point) in model.points.iter().enumerate() {
            let at = 3 * p;
            let motion = ContactMotion {
                penetration: to.interface.closeness[p] + q[at],
                penetration_rate: rate[at],
                slip_velocity: [to.speeds[point.pair] - rate[at + 1], -rate[at + 2]],
            };
            let answer = match since {
                Some((from, duration)) => {
                    let travel = to.interface.travel[point.pair] - from.interface.travel[point.pair];
                    let moved = [1, 2].map(|c| q[at + c] - to.before[(at + c, 0)]);
                    let since = SlipStep {
                        bristle: from.bristles[p].bent,
                        slid: [travel - moved[0], -moved[1]],
                        duration,
                    };
                    point.law.advance(&motion, &since, point.weight)
                }
                None => {
                    let (forces, tangent) = point.law.respond(&motion, point.weight);
                    let bristle = point.law.bent(forces.friction, point.weight);
                    SlipAnswer { forces, tangent, bristle, ..SlipAnswer::default() }
                }
            };
            let SlipAnswer { forces, tangent, by_slid, .. } = answer;
            let values = [forces.normal, -forces.friction[0], -forces.friction[1]];
            self.force[at..at + 3].copy_from_slice(&values);
            self.bristles[p] = Bristles { bent: answer.bristle, stick: answer.sticks };
            let mut block = ContactBlock::new(p, &tangent);
            for (i, row) in by_slid.iter().enumerate() {
                // Both −F and −Δ: the signs cancel.
                (0..2).for_each(|j| block.stiffness[1 + i][1 + j] += row[j]);
            }
            self.blocks[p] = block;
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

    /// Tells of every direction on whose motion r depends, with the entries of ∂r/∂q + c₁ ∂r/∂q̇ in its column.
    pub(super) fn slopes(&self, model: &Model<'_>, rate: f64, tell: &mut TellColumn<'_>) {
        for block in self.blocks.iter().filter(|block| block.acts()) {
            let first = 3 * block.point;
            for own in 0..3 {
                let slope = |row: usize| block.stiffness[row][own] + rate * block.damping[row][own];
                tell(first + own, &[0, 1, 2].map(|row| (first + row, slope(row))));
            }
        }
        if let Some([k, c]) = model.coupling {
            let first = 3 * model.points.len();
            for j in 0..k.ncols() {
                let column = (0..k.nrows()).map(|i| (first + i, k[(i, j)] + rate * c[(i, j)]));
                tell(first + j, &column.collect::<Vec<_>>());
            }
        }
    }

    /// D (∂r/∂q + c₁ ∂r/∂q̇) Dᵀ as triplets, for the tangent of the whole.
    pub(super) fn tangent(&self, model: &Model<'_>, at: &Interface, rate: f64) -> Vec<(usize, usize, f64)> {
        let mut triplets = Vec::new();
        let directions: Vec<_> = (0..model.n_directions()).map(|k| at.direction(model, k)).collect();
        let mut add = |row: usize, column: usize, slope: f64| {
            if slope != 0.0 {
                for (i, a) in directions[row].iter() {
                    triplets.extend(directions[column].iter().map(|(j, b)| (i, j, a * slope * b)));
                }
            }
        };
        for p in 0..model.points.len() {
            for (row, column) in (0..3).flat_map(|row| (0..3).map(move |column| (row, column))) {
                let slope =
                    self.blocks[p].stiffness[row][column] + rate * self.blocks[p].damping[row][column];
                add(3 * p + row, 3 * p + column, slope);
            }
        }
        let first = 3 * model.points.len();
        if let Some([k, c]) = model.coupling {
            for (row, column) in (0..k.nrows()).flat_map(|row| (0..k.ncols()).map(move |c| (row, c))) {
                add(first + row, first + column, k[(row, column)] + rate * c[(row, column)]);
            }
        }
        triplets
    }
}
