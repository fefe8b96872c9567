//! Where real symmetric matrices are factorised: in this process, or by another library over several processes.

use super::{Inertia, SymbolicFactor, SymmetricFactor};
use crate::error::Result;
use crate::linalg::sparse::Index;
use crate::linalg::{SparseMatrix, c64};
use faer::MatRef;
use faer::sparse::{SparseColMat, SymbolicSparseColMatRef};
use std::fmt::Debug;
use std::sync::Arc;

/// Library that factorises over several processes.
pub trait Backend: Debug + Send + Sync {
    /// Prepares for the matrices of a symmetric pattern stored whole; `place` is the place of every row in the order of
    /// elimination.
    ///
    /// # Errors
    /// The library refuses.
    fn analyse(
        &self,
        pattern: SymbolicSparseColMatRef<'_, Index>,
        place: &[usize],
    ) -> Result<Arc<dyn DistributedPattern>>;

    /// Takes a quadratic eigenvalue problem.
    ///
    /// # Errors
    /// The library refuses.
    fn quadratic(&self, problem: &QuadraticProblem<'_>) -> Result<Box<dyn QuadraticSolver>>;
}

/// (λ² M + λ (C + B diag(c) Bᵀ) + K) x = 0, all n × n.
#[derive(Debug)]
pub struct QuadraticProblem<'a> {
    /// M, symmetric.
    pub mass: &'a SparseMatrix,
    /// C.
    pub damping: SparseMatrix,
    /// K.
    pub stiffness: SparseColMat<Index, c64>,
    /// B (n × m) and c; of no columns where there is none.
    pub low_rank: (MatRef<'a, f64>, &'a [f64]),
    /// A symmetric matrix that couples about the same rows as K.
    pub couples: &'a SparseMatrix,
}

/// Quadratic eigenvalue problem that a library has taken.
pub trait QuadraticSolver: Debug {
    /// The `count` eigenvalues nearest `shift`, to a relative residual of `tolerance`; fewer where there are fewer.
    ///
    /// # Errors
    /// They do not converge.
    fn nearest(&self, shift: c64, count: usize, tolerance: f64) -> Result<Vec<c64>>;
}

/// Pattern that such a library has analysed.
pub trait DistributedPattern: Debug + Send + Sync {
    /// Factorises a matrix of the pattern; `symbolic` is this analysis, which the factors give back.
    ///
    /// # Errors
    /// The matrix is singular; memory does not suffice.
    fn factorize(&self, a: &SparseMatrix, symbolic: SymbolicFactor) -> Result<Box<dyn SymmetricFactor>>;

    /// The inertia of a matrix of the pattern, by factors that are not kept.
    ///
    /// # Errors
    /// As [`DistributedPattern::factorize`].
    fn inertia(&self, a: &SparseMatrix) -> Result<Inertia>;
}

/// Where the matrices of an analysis are factorised; in this process by default.
#[derive(Debug, Clone, Default)]
pub struct Engine(Option<Arc<dyn Backend>>);

impl Engine {
    /// That of another library.
    pub fn new(backend: Arc<dyn Backend>) -> Self {
        Engine(Some(backend))
    }

    /// The other library, where there is one.
    pub fn backend(&self) -> Option<&dyn Backend> {
        self.0.as_deref()
    }

    /// Analyses a symmetric pattern stored whole.
    ///
    /// # Errors
    /// Memory does not suffice; the library refuses.
    pub fn analyse(&self, pattern: SymbolicSparseColMatRef<'_, Index>) -> Result<SymbolicFactor> {
        let mut symbolic = SymbolicFactor::new(pattern)?;
        if let Some(backend) = &self.0 {
            symbolic.distributed = Some(backend.analyse(pattern, &symbolic.plan.place)?);
            symbolic.engine = self.clone();
        }
        Ok(symbolic)
    }

    /// Analyses and factorises in one go.
    ///
    /// # Errors
    /// Those of [`Engine::analyse`] and [`SymbolicFactor::factorize`].
    pub fn factorize(&self, a: &SparseMatrix) -> Result<Box<dyn SymmetricFactor>> {
        self.analyse(a.symbolic())?.factorize(a)
    }
}
