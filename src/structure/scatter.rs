//! The sparsity pattern of a set of small matrices, and adding them up on it in parallel.
//!
//! Every entry of the result is the sum of its contributions in the order of a fixed walk over the pieces, whatever
//! the number of threads: small matrices are computed in parallel, a batch at a time, and each thread then adds
//! those of the whole batch to the columns that it owns.

use super::dofs::DofMap;
use super::users::users;
use crate::linalg::SparseMatrix;
use crate::linalg::sparse::{Index, compressed_pattern};
use faer::sparse::{SymbolicSparseColMat, SymbolicSparseColMatRef};
use nalgebra::SMatrix;
use rayon::prelude::*;

/// Pieces whose matrices are held at once.
const BATCH: usize = 8192;
/// Columns whose pattern is made by one task.
const COLUMNS: usize = 1024;

/// The free degrees of freedom that each piece couples, ascending: those of piece p are `dofs[starts[p]..starts[p + 1]]`.
#[derive(Debug)]
pub(super) struct Couplings {
    n: usize,
    starts: Vec<usize>,
    dofs: Vec<usize>,
}

impl Couplings {
    /// The couplings of pieces on the given nodes.
    pub fn new(dofs: &DofMap, piece_nodes: &[Vec<usize>]) -> Self {
        let lists: Vec<Vec<usize>> = piece_nodes.par_iter().map(|nodes| coupled_dofs(dofs, nodes)).collect();
        let (starts, all) = flattened(&lists);
        Couplings { n: dofs.n_dofs(), starts, dofs: all }
    }

    fn n_pieces(&self) -> usize {
        self.starts.len() - 1
    }

    fn dofs_of(&self, piece: usize) -> &[usize] {
        &self.dofs[self.starts[piece]..self.starts[piece + 1]]
    }

    /// The sparsity pattern of the sum of the pieces' matrices, n × n; every diagonal entry is part of it.
    pub fn pattern(&self) -> SymbolicSparseColMat<Index> {
        let n = self.n;
        // The pieces of every degree of freedom, ascending.
        let pieces = (0..self.n_pieces()).map(|piece| self.dofs_of(piece));
        let (starts, users) = users(n, pieces);
        let users_of = |k: usize| &users[starts[k]..starts[k + 1]];
        let columns: Vec<(Vec<usize>, Vec<Index>)> = (0..n.div_ceil(COLUMNS))
            .into_par_iter()
            .map(|task| {
                let (mut counts, mut rows) = (Vec::new(), Vec::new());
                let mut column: Vec<Index> = Vec::new();
                let first = task * COLUMNS;
                for k in first..n.min(first + COLUMNS) {
                    // Degrees of freedom of one node mostly have the same pieces, hence the same column.
                    if k == first || users_of(k) != users_of(k - 1) || users_of(k).is_empty() {
                        column.clear();
                        column.push(k as Index);
                        for piece in users_of(k) {
                            column.extend(self.dofs_of(*piece).iter().map(|dof| *dof as Index));
                        }
                        column.sort_unstable();
                        column.dedup();
                    }
                    counts.push(column.len());
                    rows.extend_from_slice(&column);
                }
                (counts, rows)
            })
            .collect();
        let mut column_starts = Vec::with_capacity(n + 1);
        column_starts.push(0);
        let mut rows = Vec::with_capacity(columns.iter().map(|(_, r)| r.len()).sum());
        for (counts, part) in columns {
            for count in counts {
                column_starts.push(column_starts[column_starts.len() - 1] + count);
            }
            rows.extend(part);
        }
        compressed_pattern(n, &column_starts, rows)
    }
}

/// The pattern of a sum of pieces' matrices, which stands on it; it may have more entries than they.
pub(super) struct Pattern<'a> {
    pub couplings: &'a Couplings,
    pub symbolic: SymbolicSparseColMatRef<'a, Index>,
}

impl Pattern<'_> {
    fn n_entries(&self) -> usize {
        self.symbolic.row_idx().len()
    }

    /// Where column `k` begins.
    fn start(&self, k: usize) -> usize {
        self.symbolic.col_ptr()[k] as usize
    }

    /// Adds up K matrices at once: `matrices(p)` gives those of piece p on its coupled degrees of freedom
    /// (column by column); an empty one counts as zero. A sum to which nothing was added is `None`.
    pub fn sum<const K: usize>(
        &self,
        matrices: impl Fn(usize, &[usize]) -> [Vec<f64>; K] + Sync,
    ) -> [Option<SparseMatrix>; K] {
        let mut values: [Vec<f64>; K] = std::array::from_fn(|_| Vec::new());
        // Strided batches spread each batch over all columns, so that every owner has work.
        let batches = self.couplings.n_pieces().div_ceil(BATCH).max(1);
        for batch in 0..batches {
            let computed: Vec<(usize, [Vec<f64>; K])> = (batch..self.couplings.n_pieces())
                .into_par_iter()
                .step_by(batches)
                .map(|piece| (piece, matrices(piece, self.couplings.dofs_of(piece))))
                .collect();
            for (kind, sum) in values.iter_mut().enumerate() {
                if sum.is_empty() && computed.iter().any(|(_, m)| !m[kind].is_empty()) {
                    sum.resize(self.n_entries(), 0.0);
                }
            }
            self.owners(&mut values).into_par_iter().for_each(|(first, last, mut slices)| {
                for (piece, small) in &computed {
                    self.add_columns(*piece, small, first, last, &mut slices);
                }
            });
        }
        values.map(|v| (!v.is_empty()).then(|| self.with_values(v)))
    }

    /// Ranges of columns with about equally many entries, and the values that belong to each.
    fn owners<'a, const K: usize>(
        &self,
        values: &'a mut [Vec<f64>; K],
    ) -> Vec<(usize, usize, [&'a mut [f64]; K])> {
        let count = rayon::current_num_threads().max(1) * 4;
        let mut rest: [&'a mut [f64]; K] = values.each_mut().map(|v| v.as_mut_slice());
        let mut owners = Vec::with_capacity(count);
        let mut first = 0;
        for owner in 1..=count {
            let goal = self.n_entries() * owner / count;
            let last = if owner == count {
                self.couplings.n
            } else {
                let columns = self.symbolic.col_ptr();
                columns.partition_point(|s| (*s as usize) < goal).clamp(first, self.couplings.n)
            };
            let length = self.start(last) - self.start(first);
            let mine = rest.each_mut().map(|slice| {
                let whole = std::mem::take(slice);
                let at = length.min(whole.len());
                let (head, tail) = whole.split_at_mut(at);
                *slice = tail;
                head
            });
            owners.push((first, last, mine));
            first = last;
        }
        owners
    }

    /// Adds the columns `first..last` of the small matrices of `piece` to the values of those columns.
    fn add_columns<const K: usize>(
        &self,
        piece: usize,
        small: &[Vec<f64>; K],
        first: usize,
        last: usize,
        sums: &mut [&mut [f64]; K],
    ) {
        let dofs = self.couplings.dofs_of(piece);
        let m = dofs.len();
        let base = self.start(first);
        let from = dofs.partition_point(|k| *k < first);
        for (j, column) in dofs.iter().enumerate().skip(from).take_while(|(_, k)| **k < last) {
            let start = self.start(*column);
            let rows = &self.symbolic.row_idx()[start..self.start(*column + 1)];
            let mut at = 0;
            for (i, row) in dofs.iter().enumerate() {
                let row = *row as Index;
                if rows.get(at) != Some(&row) {
                    at += rows[at..].partition_point(|r| *r < row);
                }
                for (sum, matrix) in sums.iter_mut().zip(small) {
                    if !matrix.is_empty() {
                        sum[start - base + at] += matrix[j * m + i];
                    }
                }
                at += 1;
            }
        }
    }

    /// A matrix with this pattern.
    fn with_values(&self, values: Vec<f64>) -> SparseMatrix {
        SparseMatrix::new(self.symbolic.to_owned().expect("memory for a pattern"), values)
    }

    /// The zero matrix on this pattern.
    pub fn zero(&self) -> SparseMatrix {
        self.with_values(vec![0.0; self.n_entries()])
    }
}

/// Free degrees of freedom that the nodes of a piece move with, ascending.
fn coupled_dofs(dofs: &DofMap, nodes: &[usize]) -> Vec<usize> {
    let mut list: Vec<usize> = nodes
        .iter()
        .flat_map(|node| (0..6).flat_map(|dof| dofs.terms(*node, dof).iter().map(|(k, _)| *k)))
        .collect();
    list.sort_unstable();
    list.dedup();
    list
}

/// Takes matrices on the six degrees of freedom of a piece's nodes to Tᵀ A T on the free ones that it couples.
pub(super) struct Reduction {
    size: usize,
    /// (row of A, place among the coupled degrees of freedom, coefficient) of every entry of T.
    entries: Vec<(usize, usize, f64)>,
}

impl Reduction {
    /// The rows of T of `nodes`; `coupled` are the free degrees of freedom in them, ascending.
    pub fn new(dofs: &DofMap, nodes: impl Iterator<Item = usize>, coupled: &[usize]) -> Self {
        let mut entries = Vec::with_capacity(18);
        for (corner, node) in nodes.enumerate() {
            for dof in 0..6 {
                for (k, coefficient) in dofs.terms(node, dof) {
                    entries.push((6 * corner + dof, coupled.partition_point(|c| c < k), *coefficient));
                }
            }
        }
        Reduction { size: coupled.len(), entries }
    }

    /// Tᵀ A T, column by column: symmetric to the last bit when A is.
    pub fn apply(&self, full: &SMatrix<f64, 18, 18>) -> Vec<f64> {
        let m = self.size;
        let mut small = vec![0.0; m * m];
        for (b, column, tb) in &self.entries {
            let (from, to) = (full.column(*b), &mut small[column * m..(column + 1) * m]);
            for (a, row, ta) in &self.entries {
                to[*row] += ta * tb * from[*a];
            }
        }
        // Several terms a row may add up in another order on the other side of the diagonal.
        for column in 0..m {
            for row in 0..column {
                small[row * m + column] = small[column * m + row];
            }
        }
        small
    }
}

fn flattened(lists: &[Vec<usize>]) -> (Vec<usize>, Vec<usize>) {
    let mut starts = Vec::with_capacity(lists.len() + 1);
    starts.push(0);
    let mut all = Vec::with_capacity(lists.iter().map(Vec::len).sum());
    for list in lists {
        all.extend_from_slice(list);
        starts.push(all.len());
    }
    (starts, all)
}
