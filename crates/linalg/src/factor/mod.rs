//! P S A S Pᵀ = L B Lᵀ of a sparse symmetric matrix A = Aᵀ, real or complex, definite or not; real ones with their
//! inertia.
//!
//! S is a diagonal of powers of two that brings the diagonal of A near ±1, so that metres and radians weigh the
//! same when a pivot is chosen, without a rounding error. P reduces fill. B has 1 × 1 and 2 × 2 blocks. By Sylvester's
//! law B has the inertia of a real A. A complex A is symmetric, not Hermitian: nothing is conjugated.
//!
//! The method is multifrontal (Duff & Reid, ACM TOMS 9 (1983) 302):
//! 1. `ordering` takes equal rows together and orders what remains for little fill;
//! 2. `symbolic` finds the fronts and their tree, and splits it into tasks: all that the pattern decides, done once;
//! 3. `numeric` assembles front after front, `front` eliminates each of them with pivots that bound the growth, and
//!    what cannot be eliminated yet is passed on to the parent;
//! 4. `solve` goes up and down the tree with up to sixteen right-hand sides at once.
//!
//! `unsymmetric` factorises a matrix of a symmetric pattern that is not symmetric, on the same fronts.
//!
//! `engine` lets another library factorise real matrices, over several processes.
//!
//! `field` holds what real and complex numbers have in common. Tasks run on all threads; the order of every sum is
//! that of the tree, so the bits do not depend on how many there are.

mod compliances;
mod engine;
mod field;
mod front;
mod lower;
mod numeric;
mod ordering;
mod partition;
mod refused;
mod solve;
mod symbolic;
mod unsymmetric;

pub use compliances::compliances;
pub use engine::{
    Backend, DistributedPattern, EigenSolver, Engine, QuadraticProblem, QuadraticSolver, engine_names,
};
pub use field::Field;
pub use partition::partition;
pub use refused::{is_singular, singular};
pub use unsymmetric::{System, UnsymmetricFactor};

use super::SparseMatrix;
use super::c64;
use super::sparse::{Index, multiply, norm_1};
use super::workspace::with_workspace;
use faer::sparse::{SparseColMat, SymbolicSparseColMatRef};
use faer::{ColRef, Mat, MatMut, MatRef};
use field::Lanes;
use numeric::{Branch, Kept};
use rayon::prelude::*;
use solve::Substitution;
use std::fmt::Debug;
use std::sync::Arc;
use stridor_base::error::{Error, Result};
use symbolic::{Plan, fingerprint};

/// The numbers of negative, zero and positive eigenvalues.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Inertia {
    /// Negative eigenvalues.
    pub negative: usize,
    /// Eigenvalues that are zero to rounding: those of B below 1e-14, the diagonal of S A S being ±1.
    pub zero: usize,
    /// Positive eigenvalues.
    pub positive: usize,
}

/// A factorised symmetric matrix A, real (`f64`) or complex (`c64`).
pub trait SymmetricFactor<T: Field = f64>: Debug + Send + Sync {
    /// The order of A.
    fn n(&self) -> usize;

    /// Replaces the columns B of `rhs` (n × k) by A⁻¹B = A⁻ᵀB; one column uses several threads, too.
    ///
    /// # Panics
    /// When `rhs` has not n rows.
    fn solve_in_place(&self, rhs: MatMut<'_, T>);

    /// The same factors, where they give solutions in two halves.
    fn halves(&self) -> Option<&dyn HalfSolutions<T>>;

    /// The eigensolver of the library behind these factors, where real modes are to be found by that.
    fn eigensolver(&self) -> Option<&dyn EigenSolver> {
        None
    }

    /// The analysis of the pattern, which serves other matrices of the same one.
    fn symbolic(&self) -> SymbolicFactor;

    /// How many eigenvalues of a real A are negative, zero, positive. For a complex A the signs of the real parts of
    /// the eigenvalues of B are counted, which say something only when A is nearly real.
    fn inertia(&self) -> Inertia;

    /// The bytes that the factors take.
    fn memory_bytes(&self) -> usize;
}

/// Factors that give a solution in two halves.
pub trait HalfSolutions<T: Field = f64>: SymmetricFactor<T> {
    /// y = L⁻¹ P S b: the first half of a solution, in the order of elimination.
    ///
    /// Together with [`HalfSolutions::pivots`] it measures aᵀA⁻¹b = (L⁻¹PSa)ᵀ B⁻¹ (L⁻¹PSb) without the second half, and the
    /// half of a sparse vector has entries on its way to the root only.
    ///
    /// # Panics
    /// When a length is not n.
    fn forward(&self, b: &[T], y: &mut [T]);

    /// y ← B⁻¹ y.
    fn pivots(&self, y: &mut [T]);

    /// x = S Pᵀ L⁻ᵀ B⁻¹ y, the second half; y is lost.
    ///
    /// # Panics
    /// When a length is not n.
    fn backward(&self, y: &mut [T], x: &mut [T]);

    /// The columns b of `rhs` (n × k) become L⁻¹PSb, in the order of elimination: [`HalfSolutions::forward`] of many.
    ///
    /// # Panics
    /// When `rhs` has not n rows.
    fn forward_in_place(&self, rhs: MatMut<'_, T>);

    /// The columns y of `rhs` become B⁻¹y.
    ///
    /// # Panics
    /// When `rhs` has not n rows, or a column is in pieces.
    fn pivots_in_place(&self, rhs: MatMut<'_, T>);
}

/// The order of elimination and the place of every entry of L, found once for a sparsity pattern.
#[derive(Debug, Clone)]
pub struct SymbolicFactor {
    plan: Arc<Plan>,
    /// Where its matrices are factorised.
    engine: Engine,
    /// The pattern as the library of that engine knows it.
    distributed: Option<Arc<dyn DistributedPattern>>,
}

impl SymbolicFactor {
    /// Analyses a symmetric pattern stored whole.
    ///
    /// # Errors
    /// [`Error::Analysis`] when memory does not suffice.
    ///
    /// # Panics
    /// When the pattern is not square.
    pub fn new(pattern: SymbolicSparseColMatRef<'_, Index>) -> Result<Self> {
        assert!(pattern.nrows() == pattern.ncols(), "a symmetric matrix is square");
        Ok(SymbolicFactor::in_this_process(Arc::new(Plan::new(pattern)?)))
    }

    fn in_this_process(plan: Arc<Plan>) -> Self {
        SymbolicFactor { plan, engine: Engine::default(), distributed: None }
    }

    /// The entries of L, diagonal included, as far as the pattern decides.
    pub fn fill(&self) -> usize {
        self.plan.fill
    }

    /// The multiplications of an unsymmetric factorisation, about.
    pub fn multiplications(&self) -> f64 {
        let of = |width: f64, below: f64| width * (width + below) * (width + below);
        self.plan.nodes.iter().map(|node| of(node.columns.len() as f64, node.rows.len() as f64)).sum()
    }

    /// Whether this is the analysis of `pattern`.
    pub fn fits(&self, pattern: SymbolicSparseColMatRef<'_, Index>) -> bool {
        self.plan.fingerprint == fingerprint(pattern)
    }

    /// Factorises a matrix that has the analysed pattern.
    ///
    /// # Errors
    /// [`Error::Analysis`] when the matrix is exactly singular, or holds a NaN or an infinity.
    ///
    /// # Panics
    /// When the pattern is another one.
    pub fn factorize(&self, a: &SparseMatrix) -> Result<Box<dyn SymmetricFactor>> {
        match &self.distributed {
            Some(distributed) => {
                self.check(a)?;
                distributed.factorize(a, self.clone())
            }
            None => self.factorize_here(a).map(|factor| factor as Box<dyn SymmetricFactor>),
        }
    }

    /// Factorises a real or complex matrix that has the analysed pattern, in this process.
    ///
    /// # Errors
    /// As [`SymbolicFactor::factorize`].
    ///
    /// # Panics
    /// When the pattern is another one.
    pub fn factorize_here<T: Factorizable>(
        &self,
        a: &SparseColMat<Index, T>,
    ) -> Result<Box<dyn HalfSolutions<T>>> {
        T::factorize(self, a)
    }

    fn factorize_as<T: Field>(&self, a: &SparseColMat<Index, T>) -> Result<Box<dyn HalfSolutions<T>>> {
        let (branch, scaling) = self.eliminate(a, Kept::All)?;
        Ok(Box::new(Multifrontal { plan: Arc::clone(&self.plan), branch, scaling }))
    }

    /// The inertia of a matrix that has the analysed pattern, by factors that are not kept.
    ///
    /// # Errors
    /// As [`SymbolicFactor::factorize`].
    ///
    /// # Panics
    /// When the pattern is another one.
    pub fn inertia(&self, a: &SparseMatrix) -> Result<Inertia> {
        match &self.distributed {
            Some(distributed) => {
                self.check(a)?;
                distributed.inertia(a)
            }
            None => self.eliminate(a, Kept::Pivots).map(|(branch, _)| inertia(&branch)),
        }
    }

    /// That a matrix has the analysed pattern, and numbers in it.
    fn check<T: Field>(&self, a: &SparseColMat<Index, T>) -> Result<()> {
        assert!(
            a.ncols() == self.plan.order.len() && a.compute_nnz() == self.plan.entries,
            "the pattern was not the analysed one"
        );
        finite(a)
    }

    /// The fronts of S A S, and S.
    fn eliminate<T: Field>(&self, a: &SparseColMat<Index, T>, kept: Kept) -> Result<(Branch<T>, Vec<f64>)> {
        self.check(a)?;
        let scaling = equilibrate(a);
        let branch = numeric::factorize(&self.plan, a.as_ref(), &scaling, kept).map_err(|stuck| {
            let (row, n) = (self.plan.order[stuck.0], a.ncols());
            singular(format!("elimination stops at row {row} of {n}"))
        })?;
        Ok((branch, scaling))
    }
}

/// A number whose matrices are factorised. The factorisation is compiled here for each, not where it is called: with all that it calls
/// beside it.
pub trait Factorizable: Field {
    #[doc(hidden)]
    fn factorize(
        symbolic: &SymbolicFactor,
        a: &SparseColMat<Index, Self>,
    ) -> Result<Box<dyn HalfSolutions<Self>>>;
}

impl Factorizable for f64 {
    fn factorize(
        symbolic: &SymbolicFactor,
        a: &SparseColMat<Index, f64>,
    ) -> Result<Box<dyn HalfSolutions<f64>>> {
        symbolic.factorize_as(a)
    }
}

impl Factorizable for c64 {
    fn factorize(
        symbolic: &SymbolicFactor,
        a: &SparseColMat<Index, c64>,
    ) -> Result<Box<dyn HalfSolutions<c64>>> {
        symbolic.factorize_as(a)
    }
}

/// Analyses and factorises in one go, in this process.
///
/// # Errors
/// Those of [`SymbolicFactor::new`] and [`SymbolicFactor::factorize_here`].
pub fn factorize<T: Factorizable>(a: &SparseColMat<Index, T>) -> Result<Box<dyn HalfSolutions<T>>> {
    SymbolicFactor::new(a.symbolic())?.factorize_here(a)
}

/// The inertia of `a`, with the analysis of a matrix factorised before where both have the same pattern.
///
/// # Errors
/// Those of [`SymbolicFactor::new`] and [`SymbolicFactor::inertia`].
pub fn inertia_like(known: &dyn SymmetricFactor, a: &SparseMatrix) -> Result<Inertia> {
    let symbolic = known.symbolic();
    if symbolic.fits(a.symbolic()) {
        symbolic.inertia(a)
    } else {
        symbolic.engine.analyse(a.symbolic())?.inertia(a)
    }
}

/// Solves A X = B with iterative refinement (at most three rounds), and returns the largest
/// ‖b − A x‖ / (‖A‖₁ ‖x‖ + ‖b‖) of the columns: 1e-16 when all is well.
///
/// # Panics
/// When the shapes do not agree.
pub fn solve_refined(a: &SparseMatrix, factor: &dyn SymmetricFactor, rhs: MatMut<'_, f64>) -> f64 {
    let (norm, b) = (norm_1(a), rhs.to_owned());
    let mut x = rhs;
    factor.solve_in_place(x.as_mut());
    let residual_of = |x: MatRef<'_, f64>| {
        let mut ax = Mat::zeros(x.nrows(), x.ncols());
        multiply(a, x, ax.as_mut());
        let residual = &b - ax;
        let error = (0..x.ncols())
            .map(|j| {
                residual.col(j).norm_l2()
                    / (norm * x.col(j).norm_l2() + b.col(j).norm_l2()).max(f64::MIN_POSITIVE)
            })
            .fold(0.0, f64::max);
        (residual, error)
    };
    let (mut residual, mut error) = residual_of(x.as_ref());
    for _ in 0..3 {
        if error <= f64::EPSILON {
            break;
        }
        factor.solve_in_place(residual.as_mut());
        let better = &x + &residual;
        let (next, next_error) = residual_of(better.as_ref());
        if next_error >= error || next_error.is_nan() {
            break;
        }
        x.copy_from(&better);
        (residual, error) = (next, next_error);
    }
    error
}

/// L B Lᵀ, front by front.
#[derive(Debug)]
struct Multifrontal<T> {
    plan: Arc<Plan>,
    branch: Branch<T>,
    /// S.
    scaling: Vec<f64>,
}

/// Right-hand sides that go through the tree together: the time is that of reading L for one and for eight, and little
/// more for sixteen, as two vectors a row keep the arithmetic units busy.
const COLUMNS_A_TASK: usize = 16;
/// Rows that one task brings into the order of elimination.
const ROWS_A_TASK: usize = 8192;

impl<T: Field> Multifrontal<T> {
    fn substitution(&self) -> Substitution<'_, T> {
        Substitution { branch: &self.branch }
    }

    /// Goes up the tree with the columns of `rhs`, a few together, and back where `whole` solutions are wanted.
    fn substitute(&self, rhs: MatMut<'_, T>, whole: bool) {
        assert!(rhs.nrows() == self.n(), "right-hand sides of the wrong length");
        rhs.par_col_chunks_mut(COLUMNS_A_TASK).for_each(|columns| match columns.ncols() {
            1 => self.substitute_lanes::<T>(columns, whole),
            2..=4 => self.substitute_lanes::<T::Lanes<4>>(columns, whole),
            5..=8 => self.substitute_lanes::<T::Wide<8>>(columns, whole),
            _ => self.substitute_lanes::<T::Wide<COLUMNS_A_TASK>>(columns, whole),
        });
    }

    /// [`Multifrontal::substitute`] for up to as many columns as `L` has.
    fn substitute_lanes<L: Lanes<T>>(&self, rhs: MatMut<'_, T>, whole: bool) {
        with_workspace(self.n(), L::ZERO, |x| {
            self.pack(rhs.as_ref(), x);
            self.substitution().up(x);
            if whole {
                self.substitution().down(x);
            }
            rhs.par_row_chunks_mut(ROWS_A_TASK).enumerate().for_each(|(task, mut rhs)| {
                for i in 0..rhs.nrows() {
                    let row = task * ROWS_A_TASK + i;
                    let (place, scale) =
                        if whole { (self.plan.place[row], self.scaling[row]) } else { (row, 1.0) };
                    for k in 0..rhs.ncols() {
                        rhs[(i, k)] = x[place].get(k) * scale;
                    }
                }
            });
        });
    }

    /// The rows of P S B. They are taken as they come, so that only whole rows of x are met out of order.
    fn pack<L: Lanes<T>>(&self, b: MatRef<'_, T>, x: &mut [L]) {
        if b.ncols() < L::COLUMNS {
            x.fill(L::ZERO);
        }
        let columns: Vec<ColRef<'_, T>> = b.col_iter().collect();
        for (row, (place, scale)) in self.plan.place.iter().zip(&self.scaling).enumerate() {
            let x = &mut x[*place];
            columns.iter().enumerate().for_each(|(k, b)| x.set(k, b[row] * *scale));
        }
    }
}

impl<T: Field> SymmetricFactor<T> for Multifrontal<T> {
    fn n(&self) -> usize {
        self.scaling.len()
    }

    fn solve_in_place(&self, rhs: MatMut<'_, T>) {
        self.substitute(rhs, true);
    }

    fn halves(&self) -> Option<&dyn HalfSolutions<T>> {
        Some(self)
    }

    fn symbolic(&self) -> SymbolicFactor {
        SymbolicFactor::in_this_process(Arc::clone(&self.plan))
    }

    fn inertia(&self) -> Inertia {
        inertia(&self.branch)
    }

    fn memory_bytes(&self) -> usize {
        8 * self.n() + self.branch.branches().into_iter().map(Branch::memory_bytes).sum::<usize>()
    }
}

impl<T: Field> HalfSolutions<T> for Multifrontal<T> {
    fn forward_in_place(&self, rhs: MatMut<'_, T>) {
        self.substitute(rhs, false);
    }

    fn pivots_in_place(&self, rhs: MatMut<'_, T>) {
        assert!(rhs.nrows() == self.n(), "right-hand sides of the wrong length");
        rhs.par_col_iter_mut().for_each(|column| {
            let column = column.try_as_col_major_mut().expect("columns in one piece");
            self.substitution().pivots(column.as_slice_mut());
        });
    }

    fn forward(&self, b: &[T], y: &mut [T]) {
        assert!(b.len() == self.n() && y.len() == self.n(), "vectors of the wrong length");
        y.par_chunks_mut(ROWS_A_TASK).zip(self.plan.order.par_chunks(ROWS_A_TASK)).for_each(|(y, order)| {
            y.iter_mut().zip(order).for_each(|(y, row)| *y = b[*row] * self.scaling[*row]);
        });
        self.substitution().up(y);
    }

    fn pivots(&self, y: &mut [T]) {
        self.substitution().pivots(y);
    }

    fn backward(&self, y: &mut [T], x: &mut [T]) {
        assert!(x.len() == self.n() && y.len() == self.n(), "vectors of the wrong length");
        self.substitution().down(y);
        x.par_chunks_mut(ROWS_A_TASK).enumerate().for_each(|(task, x)| {
            let first = task * ROWS_A_TASK;
            let rows = first..first + x.len();
            let places = self.plan.place[rows.clone()].iter().zip(&self.scaling[rows]);
            x.iter_mut().zip(places).for_each(|(x, (place, scale))| *x = y[*place] * *scale);
        });
    }
}

/// The inertia of B.
fn inertia<T: Field>(branch: &Branch<T>) -> Inertia {
    let mut inertia = Inertia::default();
    // The eigenvalues of B⁻¹ are at hand.
    let mut note = |eigenvalue: f64| match eigenvalue {
        // Neither is a number that overflowed.
        e if e.is_nan() || e.abs() >= 1e14 => inertia.zero += 1,
        e if e < 0.0 => inertia.negative += 1,
        _ => inertia.positive += 1,
    };
    for branch in branch.branches() {
        let mut blocks =
            branch.inverse.iter().map(|[a, b]| (a.real_part(), b.real_part(), *b != T::default()));
        while let Some((p, below, double)) = blocks.next() {
            let (q, _, _) =
                if double { blocks.next().expect("a block has two columns") } else { (p, 0.0, false) };
            if !double {
                note(p);
                continue;
            }
            // det = product and trace = sum of the two eigenvalues; the larger one first, without cancellation.
            let (half, det) = (0.5 * (p + q), p * q - below * below);
            let radius = (0.5 * (p - q)).hypot(below);
            let larger = if half >= 0.0 { half + radius } else { half - radius };
            note(larger);
            note(det / larger);
        }
    }
    inertia
}

/// That every entry is a number.
fn finite<T: Field>(a: &SparseColMat<Index, T>) -> Result<()> {
    if let Some(k) = a.val().iter().position(|v| !v.size().is_finite()) {
        let (row, column) = (a.row_idx()[k], a.col_ptr().partition_point(|start| *start as usize <= k) - 1);
        return Err(Error::analysis(
            "factorisation",
            format!("the matrix has {:?} in row {row}, column {column}", a.val()[k]),
            "Look for a length, stiffness or density of zero or beyond 1e150 in the model",
        ));
    }
    Ok(())
}

/// S: s_i = 2^-round(½ log₂ |a_ii|), the largest entry of the row standing in where the diagonal is too small.
fn equilibrate<T: Field>(a: &SparseColMat<Index, T>) -> Vec<f64> {
    (0..a.ncols())
        .map(|j| {
            let (mut diagonal, mut largest) = (0.0f64, 0.0f64);
            for (i, v) in a.row_idx_of_col(j).zip(a.val_of_col(j)) {
                largest = largest.max(v.size());
                if i == j {
                    diagonal = v.size();
                }
            }
            let size = diagonal.max(1e-6 * largest);
            if size > 0.0 { (-(0.5 * size.log2()).round()).exp2() } else { 1.0 }
        })
        .collect()
}

#[cfg(test)]
mod tests;
