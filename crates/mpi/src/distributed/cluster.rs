//! Rank 0: shares out the matrices and leads the other ranks.

use super::command::Command;
use super::rank::{Factorized, QuadraticPart, Rank, send_rows};
use super::shares::Shares;
use crate::slepc::{Entries, World};
use faer::sparse::{SparseColMat, SymbolicSparseColMatRef};
use faer::{Mat, MatMut};
use std::sync::{Arc, Mutex, MutexGuard};
use stridor_base::error::{Error, Fault, Result};
use stridor_linalg::factor::{
    Backend, DistributedPattern, EigenSolver, HalfSolutions, QuadraticProblem, QuadraticSolver, engine_names,
};
use stridor_linalg::sparse::Index;
use stridor_linalg::{Inertia, SparseMatrix, SymbolicFactor, SymmetricFactor, c64};

/// What finds the real modes with the distributed factors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RealModesMethod {
    /// The block Lanczos method of this program, with its basis on rank 0.
    BlockLanczos,
    /// The Krylov–Schur method of SLEPc, with its basis shared out.
    KrylovSchur,
}

/// All ranks, led by this one. Clones lead the same ranks.
#[derive(Debug, Clone)]
pub struct Cluster(Arc<Ranks>);

#[derive(Debug)]
struct Ranks {
    size: usize,
    method: RealModesMethod,
    /// None once it has ended.
    state: Mutex<Option<State>>,
}

#[derive(Debug)]
struct State {
    rank: Rank,
    /// The number of the next pattern or factor.
    next: u64,
}

impl State {
    fn number(&mut self) -> u64 {
        self.next += 1;
        self.next
    }
}

impl Drop for Ranks {
    fn drop(&mut self) {
        // Where the analysis has not ended it has failed.
        self.end();
    }
}

impl Cluster {
    pub(super) fn new(world: World, method: RealModesMethod) -> Self {
        let size = world.size();
        let state = Mutex::new(Some(State { rank: Rank::new(world), next: 0 }));
        Cluster(Arc::new(Ranks { size, method, state }))
    }

    /// Ends the other ranks, and MPI; once.
    pub fn end(&self) {
        self.0.end();
    }
}

impl Ranks {
    fn end(&self) {
        if let Some(state) = self.lock().take() {
            let _ = Command::announce(state.rank.world(), Some(Command::End));
        }
    }

    /// One thread at a time leads the ranks. What it does meanwhile uses no thread pool, whose other work might lead them, too.
    fn lock(&self) -> MutexGuard<'_, Option<State>> {
        self.state.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    fn with<T>(&self, act: impl FnOnce(&mut State) -> Result<T>) -> Result<T> {
        match &mut *self.lock() {
            Some(state) => act(state),
            None => {
                Err(Error::analysis("MPI", "the ranks have ended", "Report this: the program is at fault"))
            }
        }
    }
}

impl Backend for Cluster {
    fn name(&self) -> &'static str {
        match self.0.method {
            RealModesMethod::BlockLanczos => engine_names::SLEPC,
            RealModesMethod::KrylovSchur => engine_names::SLEPC_KRYLOV_SCHUR,
        }
    }

    fn ranks(&self) -> usize {
        self.0.size
    }

    fn check_order(&self, n: usize) -> Result<()> {
        let (option, dofs) = (format!("--engine {}", self.name()), format!("{n} degrees of freedom"));
        if i32::try_from(n).is_err() {
            let expected = format!("at most {}", i32::MAX);
            return Err(Error::input(Fault::new(option, dofs, expected)));
        }
        if n < self.0.size {
            let expected = format!("at most {n}, for the model has {dofs}");
            let fault = Fault::new(option, format!("{} ranks", self.0.size), expected);
            return Err(Error::input(fault.with_help("Start fewer ranks")));
        }
        Ok(())
    }

    fn analyse(
        &self,
        pattern: SymbolicSparseColMatRef<'_, Index>,
        place: &[usize],
    ) -> Result<Arc<dyn DistributedPattern>> {
        let n = pattern.ncols();
        self.check_order(n)?;
        let shares = Arc::new(Shares::new(pattern, self.0.size));
        let place = place.iter().map(|p| *p as i32 + 1).collect();
        let id = self.0.with(|state| {
            let id = state.number();
            let rank = &mut state.rank;
            Command::announce(rank.world(), Some(Command::Pattern { id, n: n as u64 }))?;
            for other in 1..self.0.size {
                let Entries { rows, columns, .. } = shares.entries(pattern, other, Vec::new());
                rank.world().send(&rows, other)?;
                rank.world().send(&columns, other)?;
            }
            rank.add_pattern(id, shares.entries(pattern, 0, place));
            Ok(id)
        })?;
        Ok(Arc::new(SharedPattern { own: Numbered { cluster: self.clone(), id }, shares }))
    }

    fn quadratic(&self, problem: &QuadraticProblem<'_>) -> Result<Box<dyn QuadraticSolver>> {
        let n = problem.mass.ncols();
        let shares = Shares::new(problem.couples.symbolic(), self.0.size);
        let stiffness = transposed(&problem.stiffness);
        let damping = transposed(&problem.damping);
        let (basis, coefficients) = problem.low_rank;
        let part = |rank: usize| QuadraticPart {
            n,
            matrices: [
                shares.rows_of_transpose(&stiffness, rank),
                shares.rows_of_transpose(&damping, rank),
                shares.rows_of_transpose(problem.mass, rank),
            ],
            basis: basis
                .col_iter()
                .flat_map(|column| shares.rows[rank].iter().map(move |row| column[*row as usize]))
                .collect(),
            coefficients: coefficients.to_vec(),
        };
        let id = self.0.with(|state| {
            let id = state.number();
            let rank = &mut state.rank;
            let world = rank.world();
            Command::announce(world, Some(Command::Quadratic { id, n: n as u64 }))?;
            for other in 1..self.0.size {
                let QuadraticPart { matrices, basis, coefficients, .. } = part(other);
                matrices.iter().try_for_each(|rows| send_rows(world, rows, other))?;
                world.send(&basis, other)?;
                world.send(&coefficients, other)?;
            }
            rank.add_quadratic(id, part(0)).map(|()| id)
        })?;
        Ok(Box::new(SharedQuadratic { own: Numbered { cluster: self.clone(), id }, n }))
    }
}

/// Aᵀ.
fn transposed<T: faer::traits::ComplexField>(a: &SparseColMat<Index, T>) -> SparseColMat<Index, T> {
    a.as_ref().transpose().to_col_major().expect("as much memory as for the matrix")
}

/// What all ranks hold a part of, by its number; they forget it when this is dropped.
#[derive(Debug)]
struct Numbered {
    cluster: Cluster,
    id: u64,
}

impl Drop for Numbered {
    fn drop(&mut self) {
        // Where the ranks have ended there is nothing left to forget.
        let _ = self.cluster.0.with(|State { rank, .. }| {
            Command::announce(rank.world(), Some(Command::Free(self.id)))?;
            rank.free(self.id);
            Ok(())
        });
    }
}

/// A pattern whose rows are shared out.
#[derive(Debug)]
struct SharedPattern {
    own: Numbered,
    shares: Arc<Shares>,
}

impl SharedPattern {
    fn factorize_as(&self, a: &SparseMatrix, keep: bool) -> Result<(u64, Factorized)> {
        self.own.cluster.0.with(|state| {
            let (pattern, id) = (self.own.id, state.number());
            let (kept, rank) = (keep.then_some(id), &mut state.rank);
            Command::announce(rank.world(), Some(Command::Factorize { pattern, kept }))?;
            for other in 1..self.own.cluster.0.size {
                rank.world().send(&self.shares.values(a, other), other)?;
            }
            rank.factorize(pattern, kept, self.shares.values(a, 0)).map(|figures| (id, figures))
        })
    }
}

impl DistributedPattern for SharedPattern {
    fn factorize(&self, a: &SparseMatrix, symbolic: SymbolicFactor) -> Result<Box<dyn SymmetricFactor>> {
        let (id, figures) = self.factorize_as(a, true)?;
        let own = Numbered { cluster: self.own.cluster.clone(), id };
        Ok(Box::new(SharedFactor { own, n: a.ncols(), figures, symbolic, shares: Arc::clone(&self.shares) }))
    }

    fn inertia(&self, a: &SparseMatrix) -> Result<Inertia> {
        self.factorize_as(a, false).map(|(_, figures)| figures.inertia)
    }
}

/// A quadratic problem on all ranks.
#[derive(Debug)]
struct SharedQuadratic {
    own: Numbered,
    n: usize,
}

impl QuadraticSolver for SharedQuadratic {
    fn nearest(&self, shift: c64, count: usize, tolerance: f64) -> Result<Vec<c64>> {
        let (quadratic, count) = (self.own.id, count.min(2 * self.n));
        self.own.cluster.0.with(|State { rank, .. }| {
            let command = Command::Nearest { quadratic, shift, count: count as u64, tolerance };
            Command::announce(rank.world(), Some(command))?;
            rank.nearest(quadratic, shift, count, tolerance)
        })
    }
}

/// Factors on all ranks.
#[derive(Debug)]
struct SharedFactor {
    own: Numbered,
    n: usize,
    figures: Factorized,
    symbolic: SymbolicFactor,
    shares: Arc<Shares>,
}

impl SymmetricFactor for SharedFactor {
    fn n(&self) -> usize {
        self.n
    }

    fn solve_in_place(&self, mut rhs: MatMut<'_, f64>) {
        /// Columns that are sent together.
        const TOGETHER: usize = 32;
        assert!(rhs.nrows() == self.n, "right-hand sides of the wrong length");
        let mut columns = Vec::with_capacity(self.n * TOGETHER.min(rhs.ncols()));
        for start in (0..rhs.ncols()).step_by(TOGETHER) {
            let count = TOGETHER.min(rhs.ncols() - start);
            let some = rhs.as_mut().subcols_mut(start, count);
            columns.clear();
            some.as_ref().col_iter().for_each(|column| columns.extend(column.iter()));
            let solved = self.own.cluster.0.with(|State { rank, .. }| {
                let command = Command::Solve { factor: self.own.id, count: count as u64 };
                Command::announce(rank.world(), Some(command))?;
                let solved = rank.solve(self.own.id, &mut columns, count);
                if let Err(error) = &solved {
                    // A solution has no error of its own to give, and nothing can go on without it.
                    eprintln!("error: {error}");
                    rank.world().abort(error.exit_code());
                }
                solved
            });
            solved.expect("ranks that work until they are ended");
            for (j, column) in some.col_iter_mut().enumerate() {
                column.iter_mut().zip(&columns[j * self.n..]).for_each(|(x, solved)| *x = *solved);
            }
        }
    }

    fn halves(&self) -> Option<&dyn HalfSolutions> {
        None
    }

    fn eigensolver(&self) -> Option<&dyn EigenSolver> {
        (self.own.cluster.0.method == RealModesMethod::KrylovSchur).then_some(self)
    }

    fn symbolic(&self) -> SymbolicFactor {
        self.symbolic.clone()
    }

    fn inertia(&self) -> Inertia {
        self.figures.inertia
    }

    fn memory_bytes(&self) -> usize {
        self.figures.memory_bytes
    }
}

impl EigenSolver for SharedFactor {
    fn nearest(
        &self,
        pencil: [&SparseMatrix; 2],
        shift: f64,
        count: usize,
        tolerance: f64,
    ) -> Result<(Vec<f64>, Mat<f64>)> {
        let (factor, ranks) = (self.own.id, self.own.cluster.0.size);
        let rows = |rank: usize| pencil.map(|a| self.shares.rows_of_transpose(a, rank));
        let (values, columns) = self.own.cluster.0.with(|State { rank, .. }| {
            let command = Command::Eigenpairs { factor, shift, count: count as u64, tolerance };
            Command::announce(rank.world(), Some(command))?;
            for other in 1..ranks {
                rows(other).iter().try_for_each(|rows| send_rows(rank.world(), rows, other))?;
            }
            rank.eigenpairs(rows(0), (factor, shift), &self.shares.order(), count, tolerance)
        })?;
        let mut ascending: Vec<usize> = (0..count).collect();
        ascending.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        let vectors = Mat::from_fn(self.n, count, |i, j| columns[ascending[j] * self.n + i]);
        Ok((ascending.iter().map(|j| values[*j]).collect(), vectors))
    }
}
