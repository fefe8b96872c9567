//! P S A S Pᵀ = L U of a sparse complex matrix that is not symmetric, on a symmetric pattern.
//!
//! The fronts, their tree and its tasks are those of the symmetric factorisation: what the pattern decides is the same. Rows
//! are exchanged inside the pivot block of a front only (partial pivoting), so that the pattern holds; what this loses
//! beside pivoting over whole columns is won back by iterative refinement, and it is measured: a factorisation that does
//! not solve to a backward error of [`ACCEPTED`] is refused.
//!
//! Of A11 = Qᵀ L11 U11, A12 = Qᵀ L11 U12, A21 = L21 U11 of each front U's diagonal and the exchanges Q give det A / |det A|,
//! as P and S > 0 act on both sides.

use super::super::c64;
use super::super::lu::Lu;
use super::super::sparse::Index;
use super::symbolic::{Plan, Task};
use super::{SymbolicFactor, equilibrate, finite};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve as triangular;
use faer::prelude::*;
use faer::sparse::SparseColMat;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use rayon::prelude::*;
use std::sync::Arc;
use stridor_base::error::{Error, Result};

/// The backward error of a solution, ‖b − A x‖ / (‖A‖ ‖x‖ + ‖b‖) in the largest entry, that is accepted.
const ACCEPTED: f64 = 1e-11;
/// The backward error beyond which a solution is refined, and how often at most.
const REFINED: f64 = 4.0 * f64::EPSILON;
const REFINEMENTS: usize = 3;

/// A factorised complex matrix.
#[derive(Debug)]
pub struct UnsymmetricFactor {
    plan: Arc<Plan>,
    /// One for each node of the plan.
    fronts: Vec<Front>,
    /// S.
    scaling: Vec<f64>,
    matrix: SparseColMat<Index, c64>,
    /// The largest sum of |entries| of a row, and of a column.
    norms: [f64; 2],
    phase: c64,
}

/// L and U of one front: `width` columns above `below` rows.
#[derive(Debug)]
struct Front {
    /// L11 below the unit diagonal, U11, and the rows that were exchanged.
    pivots: Lu<c64>,
    /// L21, below × width.
    lower: Mat<c64>,
    /// U12, width × below.
    upper: Mat<c64>,
}

/// A x = b or Aᴴ x = b.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum System {
    /// With A.
    Plain,
    /// With Aᴴ.
    Adjoint,
}

/// Schur complement of a front for its parent, shape (below, below).
type Remainder = Mat<c64>;

/// A matrix on its way through the tree.
struct Elimination<'a> {
    plan: &'a Plan,
    /// A and Aᵀ.
    parts: [&'a SparseColMat<Index, c64>; 2],
    scaling: &'a [f64],
}

impl UnsymmetricFactor {
    /// Factorises A, whose pattern is the symmetric one that was analysed.
    ///
    /// # Errors
    /// [`Error::Analysis`] when A is singular, holds a NaN or an infinity, or when pivoting inside the fronts does not give
    /// factors that solve with it.
    ///
    /// # Panics
    /// When the pattern is another one.
    pub fn new(symbolic: &SymbolicFactor, matrix: SparseColMat<Index, c64>) -> Result<Self> {
        let plan = Arc::clone(&symbolic.plan);
        assert!(symbolic.fits(matrix.symbolic()), "the pattern was not the analysed one");
        finite(&matrix)?;
        let scaling = equilibrate(&matrix);
        let transposed = matrix.transpose().to_col_major().map_err(|e| {
            Error::analysis(
                "factorisation",
                format!("memory does not suffice ({e:?})"),
                "Take a coarser mesh, or a machine with more memory",
            )
        })?;
        let elimination = Elimination { plan: &plan, parts: [&matrix, &transposed], scaling: &scaling };
        let mut fronts: Vec<Option<Front>> = (0..plan.nodes.len()).map(|_| None).collect();
        let (found, _) = elimination.run(&plan.root)?;
        found.into_iter().for_each(|(s, front)| fronts[s] = Some(front));
        let fronts: Vec<Front> =
            fronts.into_iter().map(|front| front.expect("every node is eliminated")).collect();
        let mut phase = c64::new(1.0, 0.0);
        for front in &fronts {
            let of_front = front.pivots.phase().ok_or_else(|| singular(&plan, &fronts, front))?;
            phase *= of_front;
        }
        let sums = |a: &SparseColMat<Index, c64>| {
            (0..a.ncols()).map(|j| a.val_of_col(j).iter().map(|v| v.norm()).sum::<f64>()).fold(0.0, f64::max)
        };
        let norms = [sums(&transposed), sums(&matrix)];
        drop(transposed);
        let factor = UnsymmetricFactor { plan, fronts, scaling, matrix, norms, phase: phase / phase.norm() };
        let probe =
            |i: usize, j: usize| c64::new(((i + 1) as f64 * (0.7 + j as f64)).sin(), (1.3 * i as f64).cos());
        let mut probe = Mat::from_fn(factor.n(), 1, probe);
        let error = factor.solve(System::Plain, probe.as_mut());
        if error.is_nan() || error > ACCEPTED {
            return Err(Error::analysis(
                "factorisation",
                format!("the factors solve with a backward error of {error:.1e}, more than {ACCEPTED:.0e}"),
                "Degrees of freedom without stiffness and mass of their own, such as Lagrange multipliers, do this: eliminate them, or move the band a little",
            ));
        }
        Ok(factor)
    }

    /// The analysis of the pattern, which serves other matrices of the same one.
    pub fn symbolic(&self) -> SymbolicFactor {
        SymbolicFactor::in_this_process(Arc::clone(&self.plan))
    }

    /// The order of A.
    pub fn n(&self) -> usize {
        self.matrix.ncols()
    }

    /// det A / |det A|.
    pub fn phase(&self) -> c64 {
        self.phase
    }

    /// The bytes that the factors take.
    pub fn memory_bytes(&self) -> usize {
        let entries = |f: &Front| f.lower.nrows() * f.lower.ncols() * 2 + f.lower.ncols() * f.lower.ncols();
        self.fronts.iter().map(entries).sum::<usize>() * size_of::<c64>()
    }

    /// Replaces the columns b of `rhs` by A⁻¹b or A⁻ᴴb, refined; gives the largest backward error of a column.
    ///
    /// # Panics
    /// When `rhs` has not n rows.
    pub fn solve(&self, system: System, mut rhs: MatMut<'_, c64>) -> f64 {
        let b = rhs.rb().to_owned();
        rhs.copy_from(self.substitute(system, b.as_ref()));
        let mut error = f64::INFINITY;
        for refinement in 0..=REFINEMENTS {
            let residual = &b - self.times(system, rhs.rb());
            let new = self.backward_error(system, b.as_ref(), rhs.rb(), residual.as_ref());
            // Where it does not fall any more, rounding is all that is left.
            if new <= REFINED || refinement == REFINEMENTS || new.is_nan() || new > 0.5 * error {
                return new.min(error);
            }
            error = new;
            let correction = self.substitute(system, residual.as_ref());
            rhs += &correction;
        }
        error
    }

    fn backward_error(
        &self,
        system: System,
        b: MatRef<'_, c64>,
        x: MatRef<'_, c64>,
        residual: MatRef<'_, c64>,
    ) -> f64 {
        let norm = self.norms[usize::from(system == System::Adjoint)];
        let largest = |a: MatRef<'_, c64>, j: usize| a.col(j).iter().map(|v| v.norm()).fold(0.0, f64::max);
        let error = |j: usize| {
            let scale = norm * largest(x, j) + largest(b, j);
            if scale == 0.0 { 0.0 } else { largest(residual, j) / scale }
        };
        (0..b.ncols()).map(error).fold(0.0, |worst, e| if e > worst || e.is_nan() { e } else { worst })
    }

    /// A x, or Aᴴ x.
    fn times(&self, system: System, x: MatRef<'_, c64>) -> Mat<c64> {
        let mut y = Mat::<c64>::zeros(x.nrows(), x.ncols());
        let a = &self.matrix;
        for c in 0..x.ncols() {
            let (x, mut y) = (x.col(c), y.col_mut(c));
            for j in 0..a.ncols() {
                let entries = a.row_idx_of_col(j).zip(a.val_of_col(j));
                match system {
                    System::Plain => {
                        let xj = x[j];
                        entries.for_each(|(i, v)| y[i] += *v * xj);
                    }
                    System::Adjoint => y[j] = entries.map(|(i, v)| v.conj() * x[i]).sum(),
                }
            }
        }
        y
    }

    /// One substitution through the fronts.
    fn substitute(&self, system: System, b: MatRef<'_, c64>) -> Mat<c64> {
        let Plan { order, place, nodes, .. } = &*self.plan;
        let mut x = Mat::from_fn(b.nrows(), b.ncols(), |k, j| b[(order[k], j)] * self.scaling[order[k]]);
        for (node, front) in nodes.iter().zip(&self.fronts) {
            let first = node.columns.start;
            let mut own = x.subrows(first, node.columns.len()).to_owned();
            let moved = match system {
                System::Plain => {
                    front.pivots.solve_lower(own.as_mut());
                    x.subrows_mut(first, own.nrows()).copy_from(&own);
                    &front.lower * &own
                }
                System::Adjoint => {
                    front.pivots.solve_upper_adjoint(own.as_mut());
                    x.subrows_mut(first, own.nrows()).copy_from(&own);
                    front.upper.adjoint() * &own
                }
            };
            for j in 0..x.ncols() {
                node.rows.iter().enumerate().for_each(|(i, row)| x[(*row, j)] -= moved[(i, j)]);
            }
        }
        for (node, front) in nodes.iter().zip(&self.fronts).rev() {
            let (first, width) = (node.columns.start, node.columns.len());
            let beyond = Mat::from_fn(node.rows.len(), x.ncols(), |i, j| x[(node.rows[i], j)]);
            let mut own = x.subrows_mut(first, width);
            match system {
                System::Plain => {
                    own -= &front.upper * beyond;
                    front.pivots.solve_upper(own);
                }
                System::Adjoint => {
                    own -= front.lower.adjoint() * beyond;
                    front.pivots.solve_lower_adjoint(own);
                }
            }
        }
        Mat::from_fn(b.nrows(), b.ncols(), |i, j| x[(place[i], j)] * self.scaling[i])
    }
}

fn singular(plan: &Plan, fronts: &[Front], front: &Front) -> Error {
    let s = fronts.iter().position(|other| std::ptr::eq(other, front)).unwrap_or(0);
    Error::analysis(
        "factorisation",
        format!(
            "the matrix is singular: elimination stops at row {} of {}",
            plan.order[plan.nodes[s].columns.start],
            plan.order.len()
        ),
        "A part that nothing holds, a degree of freedom without stiffness and mass, or a shift on an eigenvalue does this",
    )
}

/// The fronts of a task with their nodes, and the remainders of its last ones.
type Eliminated = (Vec<(usize, Front)>, Vec<Remainder>);

impl Elimination<'_> {
    /// Runs a task.
    fn run(&self, task: &Task) -> Result<Eliminated> {
        let results: Vec<_> = task.subtasks.par_iter().map(|task| self.run(task)).collect();
        let mut results = task.subtasks.iter().zip(results);
        let (mut fronts, mut stack) = (Vec::new(), Vec::<(usize, Remainder)>::new());
        let mut places = vec![0; self.plan.order.len()];
        let mut ready = results.next();
        let mut s = task.nodes.start;
        while s < task.nodes.end {
            if let Some((subtask, result)) = ready.take_if(|(subtask, _)| subtask.nodes.start == s) {
                let (below, remainders) = result?;
                fronts.extend(below);
                stack.extend(remainders.into_iter().map(|r| (subtask.nodes.end - 1, r)));
                s = subtask.nodes.end;
                ready = results.next();
                continue;
            }
            let children = stack.split_off(stack.len() - self.plan.nodes[s].children.len());
            let (front, remainder) = self.front(s, &children, &mut places);
            fronts.push((s, front));
            stack.push((s, remainder));
            s += 1;
        }
        Ok((fronts, stack.into_iter().map(|(_, remainder)| remainder).collect()))
    }

    /// Assembles node s from A and its children, and eliminates its columns.
    fn front(&self, s: usize, children: &[(usize, Remainder)], places: &mut [usize]) -> (Front, Remainder) {
        let node = &self.plan.nodes[s];
        let (first, width, below) = (node.columns.start, node.columns.len(), node.rows.len());
        node.columns
            .clone()
            .chain(node.rows.iter().copied())
            .enumerate()
            .for_each(|(k, row)| places[row] = k);
        let mut f = Mat::<c64>::zeros(width + below, width + below);
        for (k, column) in node.columns.clone().enumerate() {
            let j = self.plan.order[column];
            for (which, part) in self.parts.iter().enumerate() {
                for (i, v) in part.row_idx_of_col(j).zip(part.val_of_col(j)) {
                    let row = self.plan.place[i];
                    let value = *v * (self.scaling[i] * self.scaling[j]);
                    match which {
                        0 if row >= first => f[(places[row], k)] = value,
                        1 if row >= node.columns.end => f[(k, places[row])] = value,
                        _ => {}
                    }
                }
            }
        }
        for (child, remainder) in children {
            let rows = &self.plan.nodes[*child].rows;
            for (j, column) in rows.iter().enumerate() {
                let (source, mut target) = (remainder.col(j), f.col_mut(places[*column]));
                rows.iter().zip(source.iter()).for_each(|(row, v)| target[places[*row]] += *v);
            }
        }
        let pivots = Lu::new(f.submatrix(0, 0, width, width).to_owned());
        let mut upper = f.submatrix(0, width, width, below).to_owned();
        pivots.solve_lower(upper.as_mut());
        let mut lower = f.submatrix(width, 0, below, width).to_owned();
        triangular::solve_lower_triangular_in_place(
            pivots.factors().transpose(),
            lower.as_mut().transpose_mut(),
            Par::Seq,
        );
        let mut rest = f.submatrix(width, width, below, below).to_owned();
        matmul(rest.as_mut(), Accum::Add, lower.as_ref(), upper.as_ref(), c64::new(-1.0, 0.0), Par::Seq);
        (Front { pivots, lower, upper }, rest)
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::random::Random;
    use super::super::super::samples;
    use super::super::super::sparse::add_scaled;
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    /// K of a plate, its skew-symmetric part random on the same pattern, at a complex shift.
    fn rotating(cells: usize, size: f64) -> SparseColMat<Index, c64> {
        let (k, m) = samples::plate(cells, false);
        let mut skew = add_scaled(&[(0.0, &k)]);
        let mut random = Random::seeded(7);
        for j in 0..k.ncols() {
            let rows: Vec<usize> = k.row_idx_of_col(j).collect();
            for (v, i) in skew.val_of_col_mut(j).iter_mut().zip(rows) {
                *v = if i > j { size * random.next() * (k[(i, i)] * k[(j, j)]).sqrt() } else { 0.0 };
            }
        }
        let t = skew.transpose().to_col_major().unwrap();
        let (one, s) = (c64::new(1.0, 0.0), c64::new(30.0, 2e3));
        add_scaled(&[(one, &k), (s * s, &m), (one, &skew), (-one, &t)])
    }

    #[test]
    fn solutions_and_the_phase_of_the_determinant_are_those_of_a_dense_solver() {
        for (cells, size) in [(1, 0.1), (4, 0.3), (9, 1.0), (30, 0.1)] {
            let a = rotating(cells, size);
            let n = a.ncols();
            let symbolic = SymbolicFactor::new(a.symbolic()).unwrap();
            let factor = UnsymmetricFactor::new(&symbolic, a.clone()).unwrap();
            let x = Mat::from_fn(n, 3, |i, j| c64::new((i as f64 * 0.7).sin(), (i * j) as f64 * 1e-3));
            for (system, b) in [(System::Plain, &a * &x), (System::Adjoint, a.adjoint() * &x)] {
                let mut found = b;
                let error = factor.solve(system, found.as_mut());
                assert!(within(error, 1e-14, RoundOff), "{n} {system:?}: {error:e}");
                assert!(within((&found - &x).norm_max(), 1e-8 * x.norm_max(), RoundOff), "{n} {system:?}");
            }
            if n < 400 {
                let (_, phase) = super::super::super::lu::inverse_and_phase(a.to_dense()).unwrap();
                assert!(
                    within((factor.phase() - phase).norm(), 1e-9, RoundOff),
                    "{n}: {} {phase}",
                    factor.phase()
                );
            }
            assert!(factor.memory_bytes() >= 16 * n);
        }
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        let mut a = rotating(4, 0.1);
        a.val_of_col_mut(5).fill(c64::new(0.0, 0.0));
        let symbolic = SymbolicFactor::new(a.symbolic()).unwrap();
        let error = UnsymmetricFactor::new(&symbolic, a.clone()).unwrap_err().to_string();
        assert!(error.contains("singular") || error.contains("backward error"), "{error}");
        a.val_of_col_mut(5)[0] = c64::new(f64::NAN, 0.0);
        let error = UnsymmetricFactor::new(&symbolic, a).unwrap_err().to_string();
        assert!(error.contains("in row"), "{error}");
    }
}
