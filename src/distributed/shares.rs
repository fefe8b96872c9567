//! The rows of a matrix shared out among the ranks.

use crate::linalg::c64;
use crate::linalg::factor::partition;
use crate::linalg::sparse::Index;
use crate::slepc::{Entries, Rows};
use faer::sparse::{SparseColMat, SymbolicSparseColMatRef};

/// Which rows lie on which rank. Distributed matrices are numbered by rank: first the rows of rank 0.
#[derive(Debug)]
pub struct Shares {
    /// The rows of each rank, ascending.
    pub rows: Vec<Vec<Index>>,
    /// The number of every row in distributed matrices.
    place: Vec<i64>,
}

/// A number as a message carries it.
pub trait Value: Copy {
    /// Adds its parts.
    fn push(self, to: &mut Vec<f64>);
}

impl Value for f64 {
    fn push(self, to: &mut Vec<f64>) {
        to.push(self);
    }
}

impl Value for c64 {
    fn push(self, to: &mut Vec<f64>) {
        to.extend([self.re, self.im]);
    }
}

impl Shares {
    /// About as many rows for each of `ranks`, and few entries of a symmetric pattern between them.
    pub fn new(pattern: SymbolicSparseColMatRef<'_, Index>, ranks: usize) -> Self {
        let part = partition(pattern, ranks);
        let mut rows = vec![Vec::new(); ranks];
        part.iter().enumerate().for_each(|(row, own)| rows[*own].push(row as Index));
        let mut place = vec![0; part.len()];
        rows.iter().flatten().enumerate().for_each(|(k, row)| place[*row as usize] = k as i64);
        Shares { rows, place }
    }

    /// The row that has each number in distributed matrices.
    pub fn order(&self) -> Vec<i32> {
        self.rows.iter().flatten().map(|row| *row as i32).collect()
    }

    /// Places of the entries of the lower triangle in the columns of a rank.
    pub fn entries(
        &self,
        pattern: SymbolicSparseColMatRef<'_, Index>,
        rank: usize,
        place: Vec<i32>,
    ) -> Entries {
        let (mut rows, mut columns) = (Vec::new(), Vec::new());
        for j in self.rows[rank].iter().map(|j| *j as usize) {
            for i in pattern.row_idx_of_col(j).filter(|i| *i >= j) {
                rows.push(i as i32 + 1);
                columns.push(j as i32 + 1);
            }
        }
        Entries { n: pattern.ncols() as i32, rows, columns, place }
    }

    /// Their values in a matrix of the pattern.
    pub fn values(&self, a: &SparseColMat<Index, f64>, rank: usize) -> Vec<f64> {
        let of_column = |j: usize| {
            let entries = a.row_idx_of_col(j).zip(a.val_of_col(j));
            entries.filter(move |(i, _)| *i >= j).map(|(_, v)| *v)
        };
        self.rows[rank].iter().flat_map(|j| of_column(*j as usize)).collect()
    }

    /// The rows of Aᵀ that lie on a rank: those of A where that is symmetric.
    pub fn rows_of_transpose<T: Value>(&self, a: &SparseColMat<Index, T>, rank: usize) -> Rows {
        let mut rows = Rows { starts: vec![0], ..Rows::default() };
        for row in self.rows[rank].iter().map(|row| *row as usize) {
            rows.columns.extend(a.row_idx_of_col(row).map(|j| self.place[j]));
            a.val_of_col(row).iter().for_each(|v| v.push(&mut rows.values));
            rows.starts.push(rows.columns.len() as i64);
        }
        rows
    }
}
