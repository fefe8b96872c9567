//! P S A S Pᵀ = L B Lᵀ of a sparse symmetric matrix A, definite or not, with its inertia.
//!
//! S is a diagonal of powers of two that brings the diagonal of A near ±1, so that metres and radians weigh the
//! same when a pivot is chosen, without a rounding error. P reduces fill (approximate minimum degree). B has 1 × 1
//! and 2 × 2 blocks: Bunch–Kaufman pivoting inside each supernode, which keeps the factors of an indefinite K − σM
//! bounded where plain LDLᵀ does not. By Sylvester's law B has the inertia of A.
//!
//! This file alone knows which library factorises.

use super::SparseMatrix;
use super::sparse::{multiply, norm_1};
use crate::error::{Error, Result};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::SupernodalIntranodeLbltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, IntranodeLbltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::{Conj, Mat, MatMut, MatRef, Par, Side};
use rayon::prelude::*;
use std::fmt::Debug;
use std::sync::Arc;

/// The numbers of negative, zero and positive eigenvalues.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Inertia {
    /// Negative eigenvalues.
    pub negative: usize,
    /// Eigenvalues that are zero to rounding: pivots below 1e-14 of the scaled diagonal.
    pub zero: usize,
    /// Positive eigenvalues.
    pub positive: usize,
}

/// A factorised symmetric matrix A.
pub trait SymmetricFactor: Debug + Send + Sync {
    /// The order of A.
    fn n(&self) -> usize;

    /// Replaces the columns B of `rhs` (n × k) by A⁻¹B; several columns use several threads.
    ///
    /// # Panics
    /// When `rhs` has not n rows.
    fn solve_in_place(&self, rhs: MatMut<'_, f64>);

    /// How many eigenvalues of A are negative, zero, positive.
    fn inertia(&self) -> Inertia;

    /// The bytes that the factors take.
    fn memory_bytes(&self) -> usize;
}

/// The order of elimination and the place of every entry of L, found once for a sparsity pattern.
#[derive(Debug, Clone)]
pub struct SymbolicFactor {
    symbolic: Arc<SymbolicCholesky<usize>>,
    entries: usize,
}

impl SymbolicFactor {
    /// Analyses a symmetric pattern stored whole.
    ///
    /// # Errors
    /// [`Error::Analysis`] when memory does not suffice.
    ///
    /// # Panics
    /// When the pattern is not square.
    pub fn new(pattern: SymbolicSparseColMatRef<'_, usize>) -> Result<Self> {
        let parameters = CholeskySymbolicParams {
            // Below zero: supernodes also where nothing is below the diagonal.
            supernodal_flop_ratio_threshold: SupernodalThreshold(-1.0),
            ..Default::default()
        };
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, SymmetricOrdering::Amd, parameters)
            .map_err(|e| out_of_memory(pattern.ncols(), &format!("{e:?}")))?;
        Ok(SymbolicFactor { symbolic: Arc::new(symbolic), entries: pattern.compute_nnz() })
    }

    /// Factorises a matrix that has the analysed pattern.
    ///
    /// # Errors
    /// [`Error::Analysis`] when the matrix is exactly singular, holds a NaN or an infinity, or does not fit in memory.
    ///
    /// # Panics
    /// When the pattern is another one.
    pub fn factorize(&self, a: &SparseMatrix) -> Result<Box<dyn SymmetricFactor>> {
        let n = a.ncols();
        assert!(
            n == self.symbolic.nrows() && a.compute_nnz() == self.entries,
            "the pattern was not the analysed one"
        );
        if let Some(k) = a.val().iter().position(|v| !v.is_finite()) {
            let (row, column) = (a.row_idx()[k], a.col_ptr().partition_point(|start| *start <= k) - 1);
            return Err(Error::analysis(
                "factorisation",
                format!("the matrix has {} in row {row}, column {column}", a.val()[k]),
                "Look for a length, stiffness or density of zero or beyond 1e150 in the model",
            ));
        }
        let scaling = equilibrate(a);
        let scaled = scale(a, &scaling);
        let parallel = Par::Seq;
        let mut memory = MemBuffer::try_new(
            self.symbolic.factorize_numeric_intranode_lblt_scratch::<f64>(parallel, Default::default()),
        )
        .map_err(|e| out_of_memory(n, &format!("{e:?}")))?;
        let mut factor = BlockFactor {
            symbolic: Arc::clone(&self.symbolic),
            values: vec![0.0; self.symbolic.len_val()],
            subdiagonal: vec![0.0; n],
            forward: (0..n).collect(),
            inverse: (0..n).collect(),
            scaling,
            inertia: Inertia::default(),
        };
        self.symbolic.factorize_numeric_intranode_lblt(
            &mut factor.values,
            &mut factor.subdiagonal,
            &mut factor.forward,
            &mut factor.inverse,
            scaled.as_ref(),
            Side::Lower,
            parallel,
            MemStack::new(&mut memory),
            Default::default(),
        );
        factor.inertia = factor.count_signs()?;
        Ok(Box::new(factor))
    }
}

/// Analyses and factorises in one go.
///
/// # Errors
/// Those of [`SymbolicFactor::new`] and [`SymbolicFactor::factorize`].
pub fn factorize(a: &SparseMatrix) -> Result<Box<dyn SymmetricFactor>> {
    SymbolicFactor::new(a.symbolic())?.factorize(a)
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

/// L B Lᵀ in faer's storage.
#[derive(Debug)]
struct BlockFactor {
    symbolic: Arc<SymbolicCholesky<usize>>,
    values: Vec<f64>,
    /// Below the diagonal of B; nonzero where a 2 × 2 block begins.
    subdiagonal: Vec<f64>,
    /// Pivoting inside the supernodes, and its inverse.
    forward: Vec<usize>,
    inverse: Vec<usize>,
    /// S.
    scaling: Vec<f64>,
    inertia: Inertia,
}

/// Columns solved together by one task: the time is that of reading L, whether for one column or for eight.
const COLUMNS_A_TASK: usize = 8;

impl BlockFactor {
    fn pivots(&self) -> PermRef<'_, usize> {
        PermRef::new_checked(&self.forward, &self.inverse, self.forward.len())
    }

    /// Signs of the eigenvalues of B. A pivot that is exactly zero, or not a number, ends the factorisation.
    fn count_signs(&self) -> Result<Inertia> {
        const ZERO: f64 = 1e-14;
        let SymbolicCholeskyRaw::Supernodal(symbolic) = self.symbolic.raw() else {
            unreachable!("the analysis was told to make supernodes")
        };
        let factor =
            SupernodalIntranodeLbltRef::new(symbolic, &self.values, &self.subdiagonal, self.pivots());
        let mut inertia = Inertia::default();
        let mut note = |eigenvalue: f64| match eigenvalue {
            e if e.abs() <= ZERO => inertia.zero += 1,
            e if e < 0.0 => inertia.negative += 1,
            _ => inertia.positive += 1,
        };
        for s in 0..symbolic.n_supernodes() {
            let supernode = factor.supernode(s);
            let block = supernode.val();
            let mut k = 0;
            while k < block.ncols() {
                let row = supernode.start() + k;
                let below = self.subdiagonal[row];
                let wrong = if below == 0.0 {
                    note(block[(k, k)]);
                    k += 1;
                    block[(k - 1, k - 1)] == 0.0 || !block[(k - 1, k - 1)].is_finite()
                } else {
                    // det = product and trace = sum of the two eigenvalues; the larger one first, without cancellation.
                    let (p, q) = (block[(k, k)], block[(k + 1, k + 1)]);
                    let (half, det) = (0.5 * (p + q), p * q - below * below);
                    let radius = (0.5 * (p - q)).hypot(below);
                    let larger = if half >= 0.0 { half + radius } else { half - radius };
                    note(larger);
                    note(det / larger);
                    k += 2;
                    det == 0.0 || !det.is_finite()
                };
                if wrong {
                    let eliminated = self.forward[row];
                    let place = self.symbolic.perm().map_or(eliminated, |p| p.arrays().0[eliminated]);
                    return Err(Error::analysis(
                        "factorisation",
                        format!(
                            "the matrix is singular: elimination stops at row {place} of {}",
                            self.forward.len()
                        ),
                        "A part that nothing holds, a degree of freedom without stiffness and mass, or a shift on an \
                         eigenvalue does this",
                    ));
                }
            }
        }
        Ok(inertia)
    }
}

impl SymmetricFactor for BlockFactor {
    fn n(&self) -> usize {
        self.scaling.len()
    }

    fn solve_in_place(&self, rhs: MatMut<'_, f64>) {
        assert!(rhs.nrows() == self.n(), "right-hand sides of the wrong length");
        let factor = IntranodeLbltRef::new(&self.symbolic, &self.values, &self.subdiagonal, self.pivots());
        rhs.par_col_chunks_mut(COLUMNS_A_TASK).for_each(|mut columns| {
            let scale = |columns: &mut MatMut<'_, f64>| {
                for j in 0..columns.ncols() {
                    for (i, s) in self.scaling.iter().enumerate() {
                        columns[(i, j)] *= s;
                    }
                }
            };
            let mut memory =
                MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(columns.ncols(), Par::Seq));
            scale(&mut columns);
            factor.solve_in_place_with_conj(Conj::No, columns.as_mut(), Par::Seq, MemStack::new(&mut memory));
            scale(&mut columns);
        });
    }

    fn inertia(&self) -> Inertia {
        self.inertia
    }

    fn memory_bytes(&self) -> usize {
        8 * (self.values.len() + 4 * self.n())
    }
}

/// S: s_i = 2^-round(½ log₂ |a_ii|), the largest entry of the row standing in where the diagonal is too small.
fn equilibrate(a: &SparseMatrix) -> Vec<f64> {
    (0..a.ncols())
        .map(|j| {
            let (mut diagonal, mut largest) = (0.0f64, 0.0f64);
            for (i, v) in a.row_idx_of_col_raw(j).iter().zip(a.val_of_col(j)) {
                largest = largest.max(v.abs());
                if *i == j {
                    diagonal = v.abs();
                }
            }
            let size = diagonal.max(1e-6 * largest);
            if size > 0.0 { (-(0.5 * size.log2()).round()).exp2() } else { 1.0 }
        })
        .collect()
}

/// S A S.
fn scale(a: &SparseMatrix, s: &[f64]) -> SparseMatrix {
    let mut scaled = a.clone();
    for j in 0..a.ncols() {
        for (i, v) in a.row_idx_of_col_raw(j).iter().zip(scaled.val_of_col_mut(j)) {
            *v *= s[*i] * s[j];
        }
    }
    scaled
}

fn out_of_memory(n: usize, said: &str) -> Error {
    Error::analysis(
        format!("factorisation of {n} unknowns"),
        format!("memory does not suffice ({said})"),
        "Take a coarser mesh, or a machine with more memory",
    )
}

#[cfg(test)]
mod tests {
    use super::super::samples;
    use super::super::sparse::add_scaled;
    use super::*;

    #[test]
    fn inertia_equals_the_signs_of_the_eigenvalues() {
        for (n, seed) in [(1, 1), (2, 2), (5, 3), (30, 4), (90, 5)] {
            let a = samples::random_symmetric(n, seed);
            let (values, _) = super::super::dense::symmetric_eigen(a.to_dense().as_ref()).unwrap();
            let negative = values.iter().filter(|v| **v < 0.0).count();
            let factor = factorize(&a).unwrap();
            assert_eq!(factor.inertia(), Inertia { negative, zero: 0, positive: n - negative });
            assert!(factor.n() == n && factor.memory_bytes() >= 8 * n);
        }
        // Only 2 × 2 pivots can do this one.
        let swap = samples::from_dense(faer::mat![[0.0, 1.0], [1.0, 0.0]].as_ref());
        assert_eq!(factorize(&swap).unwrap().inertia(), Inertia { negative: 1, zero: 0, positive: 1 });
    }

    #[test]
    fn an_indefinite_plate_is_solved_backward_stably() {
        let (k, m) = samples::plate(24, false);
        for hz in [500.0, 3000.0, 9000.0f64] {
            let a = add_scaled(&[(1.0, &k), (-(std::f64::consts::TAU * hz).powi(2), &m)]);
            let factor = factorize(&a).unwrap();
            for columns in [1, 3, 16] {
                let mut x = Mat::from_fn(a.ncols(), columns, |i, j| ((i * i + 7 * j) as f64).sin());
                assert!(solve_refined(&a, &*factor, x.as_mut()) < 1e-16);
            }
        }
    }

    #[test]
    fn metres_and_radians_may_differ_by_many_orders() {
        let mut a = samples::random_definite(20, 9).to_dense();
        let size = |i: usize| if i.is_multiple_of(2) { 1e9 } else { 1e-9 };
        a = Mat::from_fn(20, 20, |i, j| a[(i, j)] * size(i) * size(j));
        let factor = factorize(&samples::from_dense(a.as_ref())).unwrap();
        assert_eq!(factor.inertia(), Inertia { negative: 0, zero: 0, positive: 20 });
    }

    #[test]
    fn singular_and_non_finite_matrices_are_refused() {
        let zero =
            samples::from_dense(faer::mat![[1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 2.0]].as_ref());
        assert!(factorize(&zero).unwrap_err().to_string().contains("row 1"));
        let nan = samples::from_dense(faer::mat![[1.0, f64::NAN], [f64::NAN, 1.0]].as_ref());
        assert!(factorize(&nan).unwrap_err().to_string().contains("NaN"));
        let (free, _) = samples::free_chain(6);
        match factorize(&free) {
            Ok(factor) => assert_eq!(factor.inertia(), Inertia { negative: 0, zero: 1, positive: 5 }),
            Err(error) => assert!(error.to_string().contains("singular")),
        }
    }

    #[test]
    fn a_pattern_is_analysed_once() {
        let (k, m) = samples::plate(6, false);
        let sum = |s: f64| add_scaled(&[(1.0, &k), (-s, &m)]);
        let symbolic = SymbolicFactor::new(k.symbolic()).unwrap();
        let (low, high) = (symbolic.factorize(&sum(-1e4)).unwrap(), symbolic.factorize(&sum(1e9)).unwrap());
        assert!(low.inertia().negative == 0 && high.inertia().negative > 3);
    }

    #[test]
    #[ignore = "a measurement: cargo test --release --lib factor::tests::timing -- --ignored --nocapture"]
    fn timing() {
        for m in [81, 257] {
            let (k, mass) = samples::plate(m, false);
            let a = add_scaled(&[(1.0, &k), (-(std::f64::consts::TAU * 3000f64).powi(2), &mass)]);
            let time = std::time::Instant::now;
            let start = time();
            let symbolic = SymbolicFactor::new(a.symbolic()).unwrap();
            println!("{} dof: analysis {:.3} s", a.nrows(), start.elapsed().as_secs_f64());
            let start = time();
            let factor = symbolic.factorize(&a).unwrap();
            println!(
                "  factorisation {:.3} s, {} MB",
                start.elapsed().as_secs_f64(),
                factor.memory_bytes() >> 20
            );
            for columns in [1, 4, 8, 16] {
                let mut x = Mat::from_fn(a.nrows(), columns, |i, j| ((i * 3 + j) as f64).sin());
                let b = x.clone();
                let start = time();
                factor.solve_in_place(x.as_mut());
                let solved = start.elapsed().as_secs_f64();
                let start = time();
                multiply(&a, b.as_ref(), x.as_mut());
                println!(
                    "  {columns} columns: solve {solved:.4} s, product {:.4} s",
                    start.elapsed().as_secs_f64()
                );
            }
        }
    }
}
