//! P S A S Pᵀ = L U of a sparse matrix that is not symmetric, real or complex, on a symmetric pattern.
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
use super::super::sparse::{Index, Scalar};
use super::symbolic::{Plan, Task};
use super::{Field, SymbolicFactor, equilibrate, finite};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve as triangular;
use faer::prelude::*;
use faer::sparse::SparseColMat;
use faer::traits::math_utils::from_f64;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use rayon::prelude::*;
use std::sync::Arc;
use stridor_base::error::{Error, Result};

/// The backward error of a solution, ‖b − A x‖ / (‖A‖ ‖x‖ + ‖b‖) in the largest entry, that is accepted.
const ACCEPTED: f64 = 1e-11;
/// The backward error beyond which a solution is refined, and how often at most.
const REFINED: f64 = 4.0 * f64::EPSILON;
const REFINEMENTS: usize = 3;

/// A factorised matrix A, real (`f64`) or complex (`c64`).
#[derive(Debug)]
pub struct UnsymmetricFactor<T: Field = c64> {
    plan: Arc<Plan>,
    /// One for each node of the plan.
    fronts: Vec<Front<T>>,
    /// S.
    scaling: Vec<f64>,
    matrix: SparseColMat<Index, T>,
    /// The largest sum of |entries| of a row, and of a column.
    norms: [f64; 2],
}

/// L and U of one front: `width` columns above `below` rows.
#[derive(Debug)]
struct Front<T> {
    /// L11 below the unit diagonal, U11, and the rows that were exchanged.
    pivots: Lu<T>,
    /// L21, below × width.
    lower: Mat<T>,
    /// U12, width × below.
    upper: Mat<T>,
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
type Remainder<T> = Mat<T>;

/// A matrix on its way through the tree.
struct Elimination<'a, T> {
    plan: &'a Plan,
    /// A and Aᵀ.
    parts: [&'a SparseColMat<Index, T>; 2],
    scaling: &'a [f64],
}

impl<T: Field> UnsymmetricFactor<T> {
    /// Factorises A, whose pattern is the symmetric one that was analysed.
    ///
    /// # Errors
    /// [`Error::Analysis`] when A is singular, holds a NaN or an infinity, or when pivoting inside the fronts does not give
    /// factors that solve with it.
    ///
    /// # Panics
    /// When the pattern is another one.
    pub fn new(symbolic: &SymbolicFactor, matrix: SparseColMat<Index, T>) -> Result<Self> {
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
        let mut fronts: Vec<Option<Front<T>>> = (0..plan.nodes.len()).map(|_| None).collect();
        let (found, _) = elimination.run(&plan.root)?;
        found.into_iter().for_each(|(s, front)| fronts[s] = Some(front));
        let fronts: Vec<Front<T>> =
            fronts.into_iter().map(|front| front.expect("every node is eliminated")).collect();
        let usable = |pivot: T| pivot.modulus() > 0.0 && pivot.modulus().is_finite();
        if let Some(s) = fronts.iter().position(|front| !front.pivots.pivots().all(usable)) {
            return Err(singular(&plan, s));
        }
        let sums = |a: &SparseColMat<Index, T>| {
            let sum = |j: usize| a.val_of_col(j).iter().map(|v| v.modulus()).sum::<f64>();
            (0..a.ncols()).map(sum).fold(0.0, f64::max)
        };
        let norms = [sums(&transposed), sums(&matrix)];
        drop(transposed);
        let factor = UnsymmetricFactor { plan, fronts, scaling, matrix, norms };
        let mut probe = Mat::from_fn(factor.n(), 1, |i, _| from_f64(((i + 1) as f64 * 0.7).sin()));
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

    /// The bytes that the factors take.
    pub fn memory_bytes(&self) -> usize {
        let entries =
            |f: &Front<T>| f.lower.nrows() * f.lower.ncols() * 2 + f.lower.ncols() * f.lower.ncols();
        self.fronts.iter().map(entries).sum::<usize>() * size_of::<T>()
    }

    /// Replaces the columns b of `rhs` by A⁻¹b or A⁻ᴴb, refined; gives the largest backward error of a column.
    ///
    /// # Panics
    /// When `rhs` has not n rows.
    pub fn solve(&self, system: System, mut rhs: MatMut<'_, T>) -> f64 {
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
        b: MatRef<'_, T>,
        x: MatRef<'_, T>,
        residual: MatRef<'_, T>,
    ) -> f64 {
        let norm = self.norms[usize::from(system == System::Adjoint)];
        let largest = |a: MatRef<'_, T>, j: usize| a.col(j).iter().map(|v| v.modulus()).fold(0.0, f64::max);
        let error = |j: usize| {
            let scale = norm * largest(x, j) + largest(b, j);
            if scale == 0.0 { 0.0 } else { largest(residual, j) / scale }
        };
        (0..b.ncols()).map(error).fold(0.0, |worst, e| if e > worst || e.is_nan() { e } else { worst })
    }

    /// A x, or Aᴴ x.
    fn times(&self, system: System, x: MatRef<'_, T>) -> Mat<T> {
        let mut y = Mat::<T>::zeros(x.nrows(), x.ncols());
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
                    System::Adjoint => {
                        y[j] = entries.fold(<T as Scalar>::ZERO, |sum, (i, v)| sum + v.conjugate() * x[i]);
                    }
                }
            }
        }
        y
    }

    /// One substitution through the fronts.
    fn substitute(&self, system: System, b: MatRef<'_, T>) -> Mat<T> {
        let half = self.forward(system, b);
        self.backward(system, half)
    }

    /// The first half of a solution, in the order of elimination: L⁻¹PSb, or U⁻ᴴPSb with Aᴴ.
    ///
    /// A product of both halves, (U⁻ᴴPSa)ᴴ (L⁻¹PSb) = aᴴA⁻¹b, needs no second half; the half of a sparse vector has entries on its way
    /// to the root only.
    ///
    /// # Panics
    /// When b has not n rows.
    pub fn forward(&self, system: System, b: MatRef<'_, T>) -> Mat<T> {
        let order = &self.plan.order;
        assert!(b.nrows() == order.len(), "as many rows as A");
        let mut x = Mat::from_fn(b.nrows(), b.ncols(), |k, j| b[(order[k], j)] * self.scaling[order[k]]);
        for (node, front) in self.plan.nodes.iter().zip(&self.fronts) {
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
                for (i, row) in node.rows.iter().enumerate() {
                    x[(*row, j)] += -moved[(i, j)];
                }
            }
        }
        x
    }

    /// The second half of a solution: SPᵀU⁻¹y, or SPᵀL⁻ᴴy with Aᴴ.
    ///
    /// # Panics
    /// When y has not n rows.
    pub fn backward(&self, system: System, y: Mat<T>) -> Mat<T> {
        let Plan { place, nodes, .. } = &*self.plan;
        assert!(y.nrows() == place.len(), "as many rows as A");
        let mut x = y;
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
        Mat::from_fn(x.nrows(), x.ncols(), |i, j| x[(place[i], j)] * self.scaling[i])
    }
}

impl UnsymmetricFactor<c64> {
    /// det A / |det A|.
    pub fn phase(&self) -> c64 {
        let of_front = |front: &Front<c64>| front.pivots.phase().expect("no pivot is zero");
        let phase = self.fronts.iter().map(of_front).fold(c64::new(1.0, 0.0), |all, own| all * own);
        phase / phase.norm()
    }
}

/// Elimination stops in the front `s`.
fn singular(plan: &Plan, s: usize) -> Error {
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
type Eliminated<T> = (Vec<(usize, Front<T>)>, Vec<Remainder<T>>);

impl<T: Field> Elimination<'_, T> {
    /// Runs a task.
    fn run(&self, task: &Task) -> Result<Eliminated<T>> {
        let results: Vec<_> = task.subtasks.par_iter().map(|task| self.run(task)).collect();
        let mut results = task.subtasks.iter().zip(results);
        let (mut fronts, mut stack) = (Vec::new(), Vec::<(usize, Remainder<T>)>::new());
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
    fn front(
        &self,
        s: usize,
        children: &[(usize, Remainder<T>)],
        places: &mut [usize],
    ) -> (Front<T>, Remainder<T>) {
        let node = &self.plan.nodes[s];
        let (first, width, below) = (node.columns.start, node.columns.len(), node.rows.len());
        node.columns
            .clone()
            .chain(node.rows.iter().copied())
            .enumerate()
            .for_each(|(k, row)| places[row] = k);
        let mut f = Mat::<T>::zeros(width + below, width + below);
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
        matmul(rest.as_mut(), Accum::Add, lower.as_ref(), upper.as_ref(), from_f64(-1.0), Par::Seq);
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

    /// K of a plate, its skew-symmetric part random on the same pattern, at a shift.
    fn rotating<T: Field>(cells: usize, size: f64, shift: T) -> SparseColMat<Index, T> {
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
        let one = from_f64::<T>(1.0);
        add_scaled(&[(one, &k), (shift * shift, &m), (one, &skew), (-one, &t)])
    }

    #[test]
    fn solutions_and_the_phase_of_the_determinant_are_those_of_a_dense_solver() {
        for (cells, size) in [(1, 0.1), (4, 0.3), (9, 1.0), (30, 0.1)] {
            let a = rotating(cells, size, c64::new(30.0, 2e3));
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

    /// The matrix of an implicit time step, M positive and large: aᵀA⁻¹b of halves, and both halves of a solution.
    #[test]
    fn halves_of_real_solutions_measure_and_solve() {
        for (cells, size, shift) in [(1, 0.1, 1e4), (4, 3.0, 2e3), (9, 0.3, 1e4)] {
            let a = rotating(cells, size, shift);
            let n = a.ncols();
            let symbolic = SymbolicFactor::new(a.symbolic()).unwrap();
            let factor = UnsymmetricFactor::<f64>::new(&symbolic, a.clone()).unwrap();
            let wave = |phase: f64| Mat::from_fn(n, 2, |i, j| ((i * (j + 1)) as f64 * 0.7 + phase).sin());
            let (b, left) = (wave(0.1), wave(1.3));
            let half = factor.forward(System::Plain, b.as_ref());
            let measured = factor.forward(System::Adjoint, left.as_ref()).transpose() * &half;
            let x = factor.backward(System::Plain, half);
            assert!(within((&a * &x - &b).norm_max(), 1e-11 * b.norm_max(), RoundOff), "{n}");
            let expected = left.transpose() * &x;
            let scale = left.norm_l2() * x.norm_l2();
            assert!(within((measured - expected).norm_max(), 1e-11 * scale, RoundOff), "{n}");
            let y = factor.backward(System::Adjoint, factor.forward(System::Adjoint, b.as_ref()));
            assert!(within((a.transpose() * &y - &b).norm_max(), 1e-11 * b.norm_max(), RoundOff), "{n}");
        }
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        let mut a = rotating(4, 0.1, c64::new(30.0, 2e3));
        a.val_of_col_mut(5).fill(c64::new(0.0, 0.0));
        let symbolic = SymbolicFactor::new(a.symbolic()).unwrap();
        let error = UnsymmetricFactor::new(&symbolic, a.clone()).unwrap_err().to_string();
        assert!(error.contains("singular") || error.contains("backward error"), "{error}");
        a.val_of_col_mut(5)[0] = c64::new(f64::NAN, 0.0);
        let error = UnsymmetricFactor::new(&symbolic, a).unwrap_err().to_string();
        assert!(error.contains("in row"), "{error}");
    }
}
