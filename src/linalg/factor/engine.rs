//! Where real symmetric matrices are factorised: in this process, or by another library over several processes.

use super::{Inertia, SymbolicFactor, SymmetricFactor};
use crate::error::Result;
use crate::linalg::SparseMatrix;
use crate::linalg::sparse::Index;
use faer::sparse::SymbolicSparseColMatRef;
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
