//! The sparsity pattern of a set of small matrices, and adding them up on it in parallel.
//!
//! Every entry of the result is the sum of its contributions in the order of a fixed walk over the elements, whatever
//! the number of threads: small matrices are computed in parallel, a batch at a time, and each thread then adds
//! those of the whole batch to the columns that it owns.

use super::dofs::DofMap;
use super::elements::{ElementMatrix, FiniteElement};
use super::part::AnyElement;
use super::users::users;
use crate::linalg::SparseMatrix;
use crate::linalg::sparse::{Index, compressed_pattern};
use faer::sparse::{SymbolicSparseColMat, SymbolicSparseColMatRef};
use rayon::prelude::*;

/// Elements whose matrices are held at once.
const BATCH: usize = 8192;
/// Columns whose pattern is made by one task.
const COLUMNS: usize = 1024;

/// The free degrees of freedom that each element couples, ascending: those of element p are `dofs[starts[p]..starts[p + 1]]`.
#[derive(Debug)]
pub(super) struct Couplings {
    n: usize,
    starts: Vec<usize>,
    dofs: Vec<usize>,
}

impl Couplings {
    /// The couplings of `elements`.
    pub fn new(dofs: &DofMap, elements: &[AnyElement]) -> Self {
        let lists: Vec<Vec<usize>> = elements.par_iter().map(|e| coupled_dofs(dofs, e.as_ref())).collect();
        let (starts, all) = flattened(&lists);
        Couplings { n: dofs.n_dofs(), starts, dofs: all }
    }

    fn n_elements(&self) -> usize {
        self.starts.len() - 1
    }

    fn dofs_of(&self, element: usize) -> &[usize] {
        &self.dofs[self.starts[element]..self.starts[element + 1]]
    }

    /// The sparsity pattern of the sum of the elements' matrices, n × n; every diagonal entry is part of it.
    pub fn pattern(&self) -> SymbolicSparseColMat<Index> {
        let n = self.n;
        // The elements of every degree of freedom, ascending.
        let lists = (0..self.n_elements()).map(|element| self.dofs_of(element));
        let (starts, users) = users(n, lists);
        let users_of = |k: usize| &users[starts[k]..starts[k + 1]];
        let columns: Vec<(Vec<usize>, Vec<Index>)> = (0..n.div_ceil(COLUMNS))
            .into_par_iter()
            .map(|task| {
                let (mut counts, mut rows) = (Vec::new(), Vec::new());
                let mut column: Vec<Index> = Vec::new();
                let first = task * COLUMNS;
                for k in first..n.min(first + COLUMNS) {
                    // Degrees of freedom of one node mostly have the same elements, hence the same column.
                    if k == first || users_of(k) != users_of(k - 1) || users_of(k).is_empty() {
                        column.clear();
                        column.push(k as Index);
                        for element in users_of(k) {
                            column.extend(self.dofs_of(*element).iter().map(|dof| *dof as Index));
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

/// The pattern of a sum of elements' matrices, which stands on it; it may have more entries than they.
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

    /// Adds up K matrices at once: `matrices(workspace, p, coupled, small)` adds those of element p on its `coupled` degrees of
    /// freedom (column by column) to `small`, which holds zeros. Those not `wanted` are `None`, and empty in `small`.
    pub fn sum<const K: usize, W: Default>(
        &self,
        wanted: [bool; K],
        matrices: impl Fn(&mut W, usize, &[usize], &mut [&mut [f64]; K]) + Sync,
    ) -> [Option<SparseMatrix>; K] {
        let mut sums = wanted.map(|wanted| vec![0.0; if wanted { self.n_entries() } else { 0 }]);
        // Strided batches spread each batch over all columns, so that every owner has work.
        let batches = self.couplings.n_elements().div_ceil(BATCH).max(1);
        let (mut small, mut pieces): ([Vec<f64>; K], Vec<(usize, usize)>) =
            (wanted.map(|_| Vec::new()), Vec::new());
        for batch in 0..batches {
            let mut length = 0;
            pieces.clear();
            for piece in (batch..self.couplings.n_elements()).step_by(batches) {
                pieces.push((piece, length));
                length += self.couplings.dofs_of(piece).len().pow(2);
            }
            for (values, _) in small.iter_mut().zip(wanted).filter(|(_, wanted)| *wanted) {
                values.clear();
                values.resize(length, 0.0);
            }
            self.parts(&pieces, &mut small).into_par_iter().with_min_len(16).for_each_init(
                W::default,
                |workspace, (piece, mut own)| {
                    matrices(workspace, piece, self.couplings.dofs_of(piece), &mut own);
                },
            );
            self.owners(&mut sums).into_par_iter().for_each(|(first, last, mut slices)| {
                for (piece, start) in &pieces {
                    let end = start + self.couplings.dofs_of(*piece).len().pow(2);
                    let own = small.each_ref().map(|values| values.get(*start..end).unwrap_or_default());
                    self.add_columns(*piece, &own, first, last, &mut slices);
                }
            });
        }
        let mut wanted = wanted.into_iter();
        sums.map(|values| (wanted.next() == Some(true)).then(|| self.with_values(values)))
    }

    /// The values of each of `pieces` among those of a batch.
    fn parts<'a, const K: usize>(
        &self,
        pieces: &[(usize, usize)],
        small: &'a mut [Vec<f64>; K],
    ) -> Vec<(usize, [&'a mut [f64]; K])> {
        let mut rest: [&'a mut [f64]; K] = small.each_mut().map(|values| values.as_mut_slice());
        let part = |(piece, _): &(usize, usize)| {
            (*piece, split_off(&mut rest, self.couplings.dofs_of(*piece).len().pow(2)))
        };
        pieces.iter().map(part).collect()
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
            owners.push((first, last, split_off(&mut rest, length)));
            first = last;
        }
        owners
    }

    /// Adds the columns `first..last` of the small matrices of `piece` to the values of those columns.
    fn add_columns<const K: usize>(
        &self,
        piece: usize,
        small: &[&[f64]; K],
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

/// Takes the first `length` values off each slice, fewer where there are not as many.
fn split_off<'a, const K: usize>(rest: &mut [&'a mut [f64]; K], length: usize) -> [&'a mut [f64]; K] {
    rest.each_mut().map(|slice| {
        let whole = std::mem::take(slice);
        let at = length.min(whole.len());
        let (head, tail) = whole.split_at_mut(at);
        *slice = tail;
        head
    })
}

/// Free degrees of freedom that an element couples, ascending.
pub(super) fn coupled_dofs(dofs: &DofMap, element: &dyn FiniteElement) -> Vec<usize> {
    let components = element.components();
    let freedoms = element.nodes().iter().flat_map(|node| components.iter().map(|dof| (*node, *dof)));
    let mut list: Vec<usize> = freedoms
        .flat_map(|(node, dof)| dofs.terms_of(element.nodes(), node, dof).iter().map(|(k, _)| *k))
        .collect();
    list.sort_unstable();
    list.dedup();
    list
}

/// Takes matrices on the freedoms of an element to Tᵀ A T on the free degrees of freedom that it couples.
#[derive(Debug, Default)]
pub(super) struct Reduction {
    size: usize,
    /// (row of A, place among the coupled degrees of freedom, coefficient) of every entry of T.
    entries: Vec<(usize, usize, f64)>,
}

impl Reduction {
    /// Becomes that of `element`; `coupled` are the free degrees of freedom that it couples, ascending.
    pub fn set(&mut self, dofs: &DofMap, element: &dyn FiniteElement, coupled: &[usize]) {
        self.size = coupled.len();
        self.entries.clear();
        let components = element.components();
        let freedoms = element.nodes().iter().flat_map(|node| components.iter().map(|dof| (*node, *dof)));
        for (row, (node, dof)) in freedoms.enumerate() {
            for (k, coefficient) in dofs.terms_of(element.nodes(), node, dof) {
                self.entries.push((row, coupled.partition_point(|c| c < k), *coefficient));
            }
        }
    }

    /// Adds Tᵀ A T of a symmetric A, column by column, to `small`, which holds zeros: symmetric to the last bit.
    pub fn apply(&self, full: &ElementMatrix, small: &mut [f64]) {
        self.add(full, small, 1.0);
    }

    /// The same of a skew-symmetric A.
    pub fn apply_skew(&self, full: &ElementMatrix, small: &mut [f64]) {
        self.add(full, small, -1.0);
    }

    /// `mirrored` is a_ji / a_ij.
    fn add(&self, full: &ElementMatrix, small: &mut [f64], mirrored: f64) {
        let m = self.size;
        for (b, column, tb) in &self.entries {
            let (from, to) = (full.column(*b), &mut small[column * m..(column + 1) * m]);
            for (a, row, ta) in &self.entries {
                to[*row] += ta * tb * from[*a];
            }
        }
        // Several terms a row may add up in another order on the other side of the diagonal.
        for column in 0..m {
            for row in 0..column {
                small[row * m + column] = mirrored * small[column * m + row];
            }
        }
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
