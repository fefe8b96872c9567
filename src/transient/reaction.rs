//! The forces along the directions D, as functions of the motion along them.

use super::model::Model;
use crate::equilibrium::ContactBlock;
use crate::system::{ContactMotion, ContactTangent};
use faer::Mat;

/// r(q, q̇) with q = Dᵀu, on the left-hand side: (N, −F₁, −F₂) of every contact point, then k q + c q̇ of what was
/// imported; and its derivatives.
#[derive(Debug, Clone)]
pub(super) struct Reaction {
    /// r \[N\].
    pub(super) force: Vec<f64>,
    /// ∂r/∂q \[N/m\] and ∂r/∂q̇ \[N s/m\] of each point.
    blocks: Vec<ContactBlock>,
}

impl Reaction {
    pub(super) fn new(model: &Model<'_>) -> Self {
        let silent = |point| ContactBlock::new(point, &ContactTangent::default());
        Reaction {
            force: vec![0.0; model.directions.len()],
            blocks: (0..model.points.len()).map(silent).collect(),
        }
    }

    /// Evaluates at q, q̇ \[m, m/s\] while the counter-bodies slide with `speeds` \[m/s\], one a pair.
    pub(super) fn evaluate(&mut self, model: &Model<'_>, q: &[f64], rate: &[f64], speeds: &[f64]) {
        for (p, point) in model.points.iter().enumerate() {
            let at = 3 * p;
            let motion = ContactMotion {
                penetration: point.closeness + q[at],
                penetration_rate: rate[at],
                slip_velocity: [speeds[point.pair] - rate[at + 1], -rate[at + 2]],
            };
            let (forces, tangent) = point.law.respond(&motion, point.weight);
            let values = [forces.normal, -forces.friction[0], -forces.friction[1]];
            self.force[at..at + 3].copy_from_slice(&values);
            self.blocks[p] = ContactBlock::new(p, &tangent);
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

    /// The directions on whose motion r depends, and the columns of share · S (∂r/∂q + c₁ ∂r/∂q̇) there.
    pub(super) fn slopes(
        &self,
        model: &Model<'_>,
        compliance: &Mat<f64>,
        share: f64,
        rate: f64,
    ) -> (Vec<usize>, Mat<f64>) {
        let closed = self.blocks.iter().filter(|block| block.acts());
        let mut active: Vec<usize> = closed.flat_map(|b| 3 * b.point..3 * b.point + 3).collect();
        let first = 3 * model.points.len();
        let touching = active.len();
        active.extend(first..model.directions.len());
        let mut columns = Mat::<f64>::zeros(compliance.nrows(), active.len());
        let mut add = |column: usize, row: usize, slope: f64| {
            let out = columns.col_as_slice_mut(column);
            out.iter_mut().zip(compliance.col_as_slice(row)).for_each(|(out, s)| *out += slope * s);
        };
        for (column, place) in active[..touching].iter().enumerate() {
            let (p, own) = (place / 3, place % 3);
            for row in 0..3 {
                let slope = self.blocks[p].stiffness[row][own] + rate * self.blocks[p].damping[row][own];
                add(column, 3 * p + row, share * slope);
            }
        }
        if let Some([k, c]) = model.coupling {
            for j in 0..k.ncols() {
                (0..k.nrows())
                    .for_each(|i| add(touching + j, first + i, share * (k[(i, j)] + rate * c[(i, j)])));
            }
        }
        (active, columns)
    }

    /// D (∂r/∂q + c₁ ∂r/∂q̇) Dᵀ as triplets, for the tangent of the whole.
    pub(super) fn tangent(&self, model: &Model<'_>, rate: f64) -> Vec<(usize, usize, f64)> {
        let mut triplets = Vec::new();
        let mut add = |row: usize, column: usize, slope: f64| {
            if slope != 0.0 {
                for (i, a) in model.directions[row].iter() {
                    triplets.extend(model.directions[column].iter().map(|(j, b)| (i, j, a * slope * b)));
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
