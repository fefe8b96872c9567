//! Rank 0: shares out the matrices and leads the other ranks.

use super::command::Command;
use super::rank::{Factorized, Rank};
use crate::error::{Error, Fault, Result};
use crate::linalg::factor::{Backend, DistributedPattern, HalfSolutions, partition};
use crate::linalg::sparse::Index;
use crate::linalg::{Inertia, SparseMatrix, SymbolicFactor, SymmetricFactor};
use crate::slepc::{Entries, World};
use faer::MatMut;
use faer::sparse::SymbolicSparseColMatRef;
use std::sync::{Arc, Mutex, MutexGuard};

/// All ranks, led by this one.
#[derive(Debug)]
pub struct Cluster {
    size: usize,
    /// None once it has ended.
    state: Mutex<Option<State>>,
}

#[derive(Debug)]
struct State {
    rank: Rank,
    /// The number of the next pattern or factor.
    next: u64,
}

impl Cluster {
    pub(super) fn new(world: World) -> Self {
        let size = world.size();
        Cluster { size, state: Mutex::new(Some(State { rank: Rank::new(world), next: 0 })) }
    }

    /// How many ranks there are.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Ends the other ranks with an exit code, and MPI; once.
    pub fn end(&self, code: u8) {
        if let Some(state) = self.lock().take() {
            let _ = Command::announce(state.rank.world(), Some(Command::End(code)));
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

impl Backend for Arc<Cluster> {
    fn analyse(
        &self,
        pattern: SymbolicSparseColMatRef<'_, Index>,
        place: &[usize],
    ) -> Result<Arc<dyn DistributedPattern>> {
        let n = pattern.ncols();
        if i32::try_from(n).is_err() {
            let expected = format!("at most {} degrees of freedom", i32::MAX);
            return Err(Error::input(Fault::new("--engine slepc", n.to_string(), expected)));
        }
        if n < self.size {
            let fault = Fault::new("--engine slepc", format!("{} ranks", self.size), format!("at most {n}"));
            return Err(Error::input(
                fault.with_help(format!("The model has {n} degrees of freedom: start fewer ranks")),
            ));
        }
        let part = partition(pattern, self.size);
        let columns: Vec<Vec<Index>> = (0..self.size)
            .map(|own| (0..n as Index).filter(|j| part[*j as usize] == own).collect())
            .collect();
        let from_one = |i: usize| i as i32 + 1;
        let entries = |own: &[Index], place: Vec<i32>| {
            let (mut rows, mut of_columns) = (Vec::new(), Vec::new());
            for j in own.iter().map(|j| *j as usize) {
                for i in pattern.row_idx_of_col(j).filter(|i| *i >= j) {
                    rows.push(from_one(i));
                    of_columns.push(from_one(j));
                }
            }
            Entries { n: n as i32, rows, columns: of_columns, place }
        };
        let own = entries(&columns[0], place.iter().map(|p| from_one(*p)).collect());
        let id = self.with(|State { rank, next }| {
            let id = *next;
            *next += 1;
            Command::announce(rank.world(), Some(Command::Pattern { id, n: n as u64 }))?;
            for (other, columns) in columns.iter().enumerate().skip(1) {
                let Entries { rows, columns, .. } = entries(columns, Vec::new());
                rank.world().send(&rows, other)?;
                rank.world().send(&columns, other)?;
            }
            rank.add_pattern(id, own);
            Ok(id)
        })?;
        Ok(Arc::new(SharedPattern { cluster: Arc::clone(self), id, columns }))
    }
}

/// A pattern whose columns are shared out.
#[derive(Debug)]
struct SharedPattern {
    cluster: Arc<Cluster>,
    id: u64,
    /// The columns of each rank.
    columns: Vec<Vec<Index>>,
}

impl SharedPattern {
    /// The entries of the lower triangle in some columns.
    fn values(a: &SparseMatrix, columns: &[Index]) -> Vec<f64> {
        let of_column = |j: usize| {
            let entries = a.row_idx_of_col(j).zip(a.val_of_col(j));
            entries.filter(move |(i, _)| *i >= j).map(|(_, v)| *v)
        };
        columns.iter().flat_map(|j| of_column(*j as usize)).collect()
    }

    fn factorize_as(&self, a: &SparseMatrix, keep: bool) -> Result<(u64, Factorized)> {
        self.cluster.with(|State { rank, next }| {
            let id = *next;
            *next += 1;
            let kept = keep.then_some(id);
            Command::announce(rank.world(), Some(Command::Factorize { pattern: self.id, kept }))?;
            for (other, columns) in self.columns.iter().enumerate().skip(1) {
                rank.world().send(&Self::values(a, columns), other)?;
            }
            rank.factorize(self.id, kept, Self::values(a, &self.columns[0])).map(|figures| (id, figures))
        })
    }
}

impl DistributedPattern for SharedPattern {
    fn factorize(&self, a: &SparseMatrix, symbolic: SymbolicFactor) -> Result<Box<dyn SymmetricFactor>> {
        let (id, figures) = self.factorize_as(a, true)?;
        Ok(Box::new(SharedFactor { cluster: Arc::clone(&self.cluster), id, n: a.ncols(), figures, symbolic }))
    }

    fn inertia(&self, a: &SparseMatrix) -> Result<Inertia> {
        self.factorize_as(a, false).map(|(_, figures)| figures.inertia)
    }
}

impl Drop for SharedPattern {
    fn drop(&mut self) {
        // Where the ranks have ended there is nothing left to forget.
        let _ = self.cluster.with(|State { rank, .. }| {
            Command::announce(rank.world(), Some(Command::FreePattern(self.id)))?;
            rank.free_pattern(self.id);
            Ok(())
        });
    }
}

/// Factors on all ranks.
#[derive(Debug)]
struct SharedFactor {
    cluster: Arc<Cluster>,
    id: u64,
    n: usize,
    figures: Factorized,
    symbolic: SymbolicFactor,
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
            let solved = self.cluster.with(|State { rank, .. }| {
                let command = Command::Solve { factor: self.id, count: count as u64 };
                Command::announce(rank.world(), Some(command))?;
                let solved = rank.solve(self.id, &mut columns, count);
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

impl Drop for SharedFactor {
    fn drop(&mut self) {
        // Where the ranks have ended there is nothing left to forget.
        let _ = self.cluster.with(|State { rank, .. }| {
            Command::announce(rank.world(), Some(Command::FreeFactor(self.id)))?;
            rank.free_factor(self.id);
            Ok(())
        });
    }
}
