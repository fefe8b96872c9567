//! One implicit step by Newton's method on the whole system: slow and plain, to compare with.

use super::along::moved_most;
use super::interface::column;
use super::model::TransientModel;
use super::reaction::{Reaction, Since, resistance};
use super::scheme::Weights;
use super::solver::{ITERATIONS, ROUND_OFF, Solver, StepFailure, UNMATCHED};
use super::state::State;
use crate::linalg::multivector::{expand, gram};
use crate::linalg::sparse::{entry, multiply_vector};
use crate::linalg::{SparseMatrix, SparseVector};
use faer::Mat;
use faer::linalg::solvers::Solve;

/// A₀Δ + B E BᵀΔ + b D r − h − B w = 0 and r − R(r, u_t + Δ, v_t + c₁Δ) = 0 for Δ and r together, with the tangent
///
/// A₀  b D;  −(∂R/∂q + c₁ ∂R/∂q̇) Dᵀ  I − ∂R/∂r.
///
/// The modal part B E Bᵀ, dense but small beside A₀, is left to the iteration.
#[derive(Debug)]
pub(super) struct FullNewton<'a> {
    model: &'a TransientModel<'a>,
    weights: Weights,
    linear: SparseMatrix,
    /// A₀ᵀ: a product with a matrix stored by columns is that with its transpose.
    transposed: SparseMatrix,
    /// The diagonal of A₀.
    diagonal: Vec<f64>,
    reaction: Reaction,
}

impl<'a> FullNewton<'a> {
    pub(super) fn new(model: &'a TransientModel<'a>, weights: Weights) -> Self {
        let linear = model.effective(&weights);
        let transposed = linear.transpose().to_col_major().expect("memory for as many entries once more");
        let diagonal = diagonal(&linear);
        FullNewton { model, weights, linear, transposed, diagonal, reaction: Reaction::new(model) }
    }

    /// ρ of each point, as if every degree of freedom moved by itself.
    fn resistances(&self, directions: &[SparseVector]) -> Vec<f64> {
        let compliance =
            |t: &SparseVector| t.iter().map(|(i, t)| t * t / self.diagonal[i].abs()).sum::<f64>();
        let factor = self.weights.share() * self.weights.rate;
        let points = 0..self.model.points.len();
        points.map(|p| resistance([1, 2].map(|k| compliance(&directions[3 * p + k])), factor)).collect()
    }

    /// Residual of both equations at Δ and r.
    fn residual(
        &mut self,
        [delta, force]: [&[f64]; 2],
        h: &[f64],
        at: &[Vec<f64>; 2],
        [from, to]: [&State; 2],
        resistance: &[f64],
    ) -> Vec<f64> {
        let model = self.model;
        let mut along = Mat::zeros(model.n_directions(), 1);
        to.interface.motions(model, column(delta), along.as_mut());
        let along = along.col_as_slice(0);
        let q: Vec<f64> = along.iter().zip(&at[0]).map(|(x, p)| p + x).collect();
        let rate: Vec<f64> = along.iter().zip(&at[1]).map(|(x, v)| v + self.weights.rate * x).collect();
        let duration = self.weights.step;
        let (travel, bristles) = (&from.interface.travel, &from.bristles);
        let approaches = &from.interface.approaches;
        self.reaction.evaluate(
            model,
            [&q, &rate],
            to.moment(),
            Some(Since { travel, approaches, bristles, duration, force, resistance }),
        );
        let mut rho = multiply_vector(&self.transposed, delta);
        if let Some(own) = &model.damping.modal {
            let [_, c, _] = self.weights.effective();
            let column = Mat::from_fn(delta.len(), 1, |i, _| delta[i]);
            let mut share = gram(own.basis.as_ref(), column.as_ref());
            own.coefficients.iter().enumerate().for_each(|(i, own)| share[(i, 0)] *= c * own);
            let part = expand(own.basis.as_ref(), share.as_ref());
            rho.iter_mut().zip(part.col_as_slice(0)).for_each(|(rho, p)| *rho += p);
        }
        rho.iter_mut().zip(h).for_each(|(rho, h)| *rho -= h);
        to.interface.add_reactions(model, self.weights.share(), force, &mut rho);
        rho.extend(force.iter().zip(&self.reaction.force).map(|(r, answer)| r - answer));
        rho
    }

    /// The tangent of both equations.
    fn tangent(&self, directions: &[SparseVector]) -> Result<SparseMatrix, StepFailure> {
        let (n, r) = (self.model.n(), directions.len());
        let mut entries = Vec::new();
        for j in 0..n {
            for place in self.linear.col_ptr()[j]..self.linear.col_ptr()[j + 1] {
                let place = place as usize;
                entries.push(entry(self.linear.row_idx()[place] as usize, j, self.linear.val()[place]));
            }
        }
        for (k, direction) in directions.iter().enumerate() {
            entries.extend(direction.iter().map(|(i, d)| entry(i, n + k, self.weights.share() * d)));
            entries.push(entry(n + k, n + k, 1.0));
        }
        self.reaction.rows(self.model, self.weights.rate, &mut |row| {
            for (k, slope) in row.slopes.iter().filter(|(_, slope)| *slope != 0.0) {
                entries.extend(directions[*k].iter().map(|(j, d)| entry(n + row.place, j, -slope * d)));
            }
            entries.extend(row.held.iter().map(|(k, held)| entry(n + row.place, n + k, -held)));
        });
        SparseMatrix::try_new_from_triplets(n + r, n + r, &entries).map_err(|_| StepFailure::NotFinite)
    }
}

impl Solver for FullNewton<'_> {
    fn increment(
        &mut self,
        h: &mut Mat<f64>,
        modal: &mut Mat<f64>,
        from: &State,
        to: &mut State,
    ) -> Result<(), StepFailure> {
        let (model, weights) = (self.model, self.weights);
        let n = model.n();
        let mut at = [0, 1].map(|_| vec![0.0; model.n_directions()]);
        to.predict_along(&weights, &mut at);
        let directions: Vec<_> =
            (0..model.n_directions()).map(|k| to.interface.direction(model, k)).collect();
        let resistance = self.resistances(&directions);
        let mut given = h.col_as_slice(0).to_vec();
        if let Some(own) = &model.damping.modal {
            let part = expand(own.basis.as_ref(), modal.as_ref());
            given.iter_mut().zip(part.col_as_slice(0)).for_each(|(h, p)| *h += p);
        }
        // From where the last acceleration would lead, and the last forces.
        let mut delta: Vec<f64> = from.motion.col_as_slice(2).iter().map(|a| a / weights.inertia).collect();
        let mut force = from.reaction.clone();
        let mut length = 0.0;
        let mut moved = Mat::zeros(model.n_directions(), 1);
        let mut rho = self.residual([&delta, &force], &given, &at, [from, to], &resistance);
        for iteration in 1..=ITERATIONS {
            to.iterations = iteration;
            let lu = self.tangent(&directions)?.sp_lu().map_err(|_| StepFailure::NotFinite)?;
            let newton = |rho: &[f64]| lu.solve(Mat::from_fn(rho.len(), 1, |i, _| rho[i]));
            let step = newton(&rho);
            length = step.subrows(0, n).norm_max();
            if !step.norm_max().is_finite() {
                return Err(StepFailure::NotFinite);
            }
            to.interface.motions(model, step.subrows(0, n), moved.as_mut());
            let last = [delta.clone(), force.clone()];
            let mut damping = 1.0;
            // Halved while the next step, with this tangent, would not be shorter: Deuflhard's natural monotonicity test.
            loop {
                delta.iter_mut().enumerate().for_each(|(i, x)| *x = last[0][i] - damping * step[(i, 0)]);
                force.iter_mut().enumerate().for_each(|(k, r)| *r = last[1][k] - damping * step[(n + k, 0)]);
                rho = self.residual([&delta, &force], &given, &at, [from, to], &resistance);
                let left = newton(&rho).subrows(0, n).norm_max();
                if left <= (1.0 - 0.25 * damping) * length || damping < 1e-3 {
                    break;
                }
                damping *= 0.5;
            }
            let largest = |x: &[f64]| x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let scale = from.motion.col(0).norm_max().max(largest(&delta));
            if length <= ROUND_OFF * scale && self.reaction.mismatch(&force) <= UNMATCHED {
                to.answer(&self.reaction);
                h.col_as_slice_mut(0).copy_from_slice(&delta);
                if let Some(own) = &model.damping.modal {
                    *modal = gram(own.basis.as_ref(), h.as_ref());
                }
                return Ok(());
            }
        }
        Err(StepFailure::Newton { length, point: moved_most(moved.col_as_slice(0), model) })
    }
}

/// The diagonal of a matrix.
fn diagonal(a: &SparseMatrix) -> Vec<f64> {
    let own = |j: usize| {
        let column = a.col_ptr()[j] as usize..a.col_ptr()[j + 1] as usize;
        column.filter(|place| a.row_idx()[*place] as usize == j).map(|place| a.val()[place]).sum()
    };
    (0..a.ncols()).map(own).collect()
}
