//! Where real symmetric matrices are factorised: in this process, or by another library over several processes.

use super::{Inertia, SymbolicFactor, SymmetricFactor};
use crate::sparse::Index;
use crate::{SparseMatrix, c64};
use faer::sparse::{SparseColMat, SymbolicSparseColMatRef};
use faer::{Mat, MatRef};
use std::fmt::Debug;
use std::sync::Arc;
use stridor_base::error::Result;

/// Names of engines, as the option `--engine` takes them and results give them.
pub mod engine_names {
    /// This process alone.
    pub const DEFAULT: &str = "default";
    /// Matrices shared out over ranks.
    pub const SLEPC: &str = "slepc";
    /// The same, with real modes by the Krylov–Schur method.
    pub const SLEPC_KRYLOV_SCHUR: &str = "slepc-krylov-schur";
    /// Points of studies shared out over ranks.
    pub const MPI: &str = "mpi";
}

/// Library that factorises over several processes.
pub trait Backend: Debug + Send + Sync {
    /// Its name.
    fn name(&self) -> &'static str;

    /// The number of processes.
    fn ranks(&self) -> usize;

    /// That it takes matrices of this order.
    ///
    /// # Errors
    /// Input: too few rows or too many.
    fn check_order(&self, n: usize) -> Result<()>;

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

/// Eigensolver of a library that has factorised A = K − σM.
pub trait EigenSolver: Debug {
    /// The `count` eigenpairs of K x = θ M x nearest σ, θ ascending, with ‖A⁻¹M x − ν x‖ ≤ `tolerance` |ν|, ν = 1/(θ − σ), and
    /// xᵀMx = 1.
    ///
    /// # Errors
    /// They do not converge.
    fn nearest(
        &self,
        pencil: [&SparseMatrix; 2],
        shift: f64,
        count: usize,
        tolerance: f64,
    ) -> Result<(Vec<f64>, Mat<f64>)>;
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

    /// Its name: that of the other library, or `default`.
    pub fn name(&self) -> &'static str {
        self.backend().map_or(engine_names::DEFAULT, Backend::name)
    }

    /// The number of processes that factorise.
    pub fn ranks(&self) -> usize {
        self.backend().map_or(1, Backend::ranks)
    }

    /// That matrices of this order can be factorised.
    ///
    /// # Errors
    /// Those of [`Backend::check_order`].
    pub fn check_order(&self, n: usize) -> Result<()> {
        self.backend().map_or(Ok(()), |backend| backend.check_order(n))
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

#[cfg(test)]
mod tests {
    use super::super::{HalfSolutions, compliances, factorize, inertia_like};
    use super::*;
    use crate::samples;
    use crate::sparse::add_scaled;
    use crate::{Wanted, lowest_eigenpairs, lowest_eigenpairs_by};
    use faer::MatMut;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use stridor_base::bounds::{Origin::*, within};

    /// A library that factorises with the factors of this program, without half solutions, and counts how often.
    #[derive(Debug, Default)]
    struct Library(Arc<AtomicUsize>);

    #[derive(Debug)]
    struct Pattern(Arc<AtomicUsize>);

    #[derive(Debug)]
    struct Factor {
        inner: Box<dyn HalfSolutions>,
        symbolic: SymbolicFactor,
    }

    impl Backend for Library {
        fn name(&self) -> &'static str {
            "stand-in"
        }

        fn ranks(&self) -> usize {
            3
        }

        fn check_order(&self, _: usize) -> Result<()> {
            Ok(())
        }

        fn analyse(
            &self,
            pattern: SymbolicSparseColMatRef<'_, Index>,
            place: &[usize],
        ) -> Result<Arc<dyn DistributedPattern>> {
            let mut rows = place.to_vec();
            rows.sort_unstable();
            assert!(rows.into_iter().eq(0..pattern.ncols()), "every row has a place");
            Ok(Arc::new(Pattern(Arc::clone(&self.0))))
        }

        fn quadratic(&self, _: &QuadraticProblem<'_>) -> Result<Box<dyn QuadraticSolver>> {
            unreachable!("no quadratic problem here")
        }
    }

    impl DistributedPattern for Pattern {
        fn factorize(&self, a: &SparseMatrix, symbolic: SymbolicFactor) -> Result<Box<dyn SymmetricFactor>> {
            self.0.fetch_add(1, Ordering::Relaxed);
            Ok(Box::new(Factor { inner: factorize(a)?, symbolic }))
        }

        fn inertia(&self, a: &SparseMatrix) -> Result<Inertia> {
            self.0.fetch_add(1, Ordering::Relaxed);
            Ok(factorize(a)?.inertia())
        }
    }

    impl SymmetricFactor for Factor {
        fn n(&self) -> usize {
            self.inner.n()
        }

        fn solve_in_place(&self, rhs: MatMut<'_, f64>) {
            self.inner.solve_in_place(rhs);
        }

        fn halves(&self) -> Option<&dyn HalfSolutions> {
            None
        }

        fn symbolic(&self) -> SymbolicFactor {
            self.symbolic.clone()
        }

        fn inertia(&self) -> Inertia {
            self.inner.inertia()
        }

        fn memory_bytes(&self) -> usize {
            self.inner.memory_bytes()
        }
    }

    #[test]
    fn all_that_is_factorised_goes_to_the_library() {
        let (k, m) = samples::plate(12, false);
        let calls = Arc::new(AtomicUsize::new(0));
        let engine = Engine::new(Arc::new(Library(Arc::clone(&calls))));
        assert_eq!((engine.name(), engine.ranks()), ("stand-in", 3));
        assert_eq!((Engine::default().name(), Engine::default().ranks()), ("default", 1));
        let seen = || calls.swap(0, Ordering::Relaxed);
        for wanted in [Wanted::Count(8), Wanted::Below(1e7)] {
            let own = lowest_eigenpairs(&k, &m, wanted, &()).unwrap();
            let found = lowest_eigenpairs_by(&engine, &k, &m, wanted, &()).unwrap();
            assert_eq!(found.values, own.values);
            assert!(seen() >= 2, "a shift and a count");
        }
        let a = add_scaled(&[(1.0, &k), (-1e6, &m)]);
        let (factor, own) = (engine.factorize(&a).unwrap(), factorize(&a).unwrap());
        // The same pattern, and another one.
        for b in [&a, &samples::identity(a.ncols())] {
            assert_eq!(inertia_like(&*factor, b).unwrap(), inertia_like(&*own, b).unwrap());
        }
        assert_eq!(seen(), 3);
        let f = Mat::from_fn(a.ncols(), 5, |i, j| ((i + 3 * j) as f64 * 0.7).sin());
        let [whole, halves] =
            [&*factor, &*own as &dyn SymmetricFactor].map(|factor| compliances(factor, f.clone().as_mut()));
        assert!(within((&whole - &halves).norm_max(), 1e-11 * halves.norm_max(), RoundOff));
    }
}
