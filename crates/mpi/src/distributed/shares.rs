//! The rows of a matrix shared out among the ranks.

use crate::slepc::{Entries, Rows};
use faer::sparse::{SparseColMat, SymbolicSparseColMatRef};
use stridor_linalg::c64;
use stridor_linalg::factor::partition;
use stridor_linalg::sparse::Index;

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

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use stridor_linalg::samples::plate;

    /// Each rank has the rows of its own part and nothing of the others'; all of them together have every entry once.
    #[test]
    fn each_rank_has_its_own_part_of_the_matrix_and_no_more() {
        let (matrix, _) = plate(20, false);
        let n = matrix.ncols();
        let of_column = |j: usize| matrix.row_idx_of_col(j).map(move |i| (i as i32 + 1, j as i32 + 1));
        let lower: BTreeSet<(i32, i32)> = (0..n).flat_map(of_column).filter(|(i, j)| i >= j).collect();
        for ranks in [1, 2, 3, 4, 7] {
            let shares = Shares::new(matrix.symbolic(), ranks);
            let most = shares.rows.iter().map(Vec::len).max().unwrap();
            assert!(most <= n.div_ceil(ranks) * 11 / 10, "{most} of {n} rows on one of {ranks} ranks");
            let (mut found, mut rows_found, mut across) = (BTreeSet::new(), BTreeSet::new(), 0);
            for rank in 0..ranks {
                let own: BTreeSet<i32> = shares.rows[rank].iter().map(|row| *row as i32 + 1).collect();
                let entries = shares.entries(matrix.symbolic(), rank, Vec::new());
                let values = shares.values(&matrix, rank);
                assert_eq!(entries.rows.len(), values.len());
                for ((i, j), value) in entries.rows.iter().zip(&entries.columns).zip(values) {
                    assert!(
                        own.contains(j) && found.insert((*i, *j)),
                        "({i}, {j}) twice, or of another rank"
                    );
                    let (i, j) = (*i as usize - 1, *j as usize - 1);
                    assert_eq!(matrix.as_ref().get(i, j), Some(&value));
                    across += usize::from(!own.contains(&(i as i32 + 1)));
                }
                let rows = shares.rows_of_transpose(&matrix, rank);
                assert_eq!(rows.starts.len(), own.len() + 1);
                rows_found.extend(own);
            }
            assert!(found == lower && rows_found.len() == n);
            // Parts of a mesh: few entries between them.
            assert!(across <= lower.len() * (ranks - 1) / 20, "{across} of {} between {ranks}", lower.len());
        }
    }
}
