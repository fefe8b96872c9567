//! The sparse matrix of the whole program, its products and norms, and sparse vectors for contact directions.

pub use super::scalar::Scalar;

use super::lanes::{Aligned, Row, pack, unpack};
use super::workspace::with_workspace;
use faer::sparse::{SparseColMat, SymbolicSparseColMat, Triplet};
use faer::{Mat, MatMut, MatRef, c64};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// A row or column of a sparse matrix, or the place of one of its entries: half as long as a machine word, as products are bound
/// by reading them.
pub type Index = u32;

/// A sparse matrix in compressed columns. Symmetric matrices are stored whole (both triangles), so that a
/// column is also a row and products run over rows in parallel.
pub type SparseMatrix = faer::sparse::SparseColMat<Index, f64>;

/// An entry for [`SparseMatrix::try_new_from_triplets`], which adds up those with the same place.
///
/// # Panics
/// Beyond 2³² rows or columns.
pub fn entry(row: usize, column: usize, value: f64) -> Triplet<Index, Index, f64> {
    let index = |i: usize| Index::try_from(i).expect("less than 2³² rows and columns");
    Triplet::new(index(row), index(column), value)
}

/// A sparse vector: `values[k]` stands at `indices[k]`; indices ascend and do not repeat.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SparseVector {
    indices: Vec<usize>,
    values: Vec<f64>,
}

impl SparseVector {
    /// Sorts `entries`, adds up those with the same index, and drops exact zeros.
    ///
    /// ```
    /// let v = stridor_linalg::SparseVector::from_entries([(4, 1.0), (2, 3.0), (4, 0.5)]);
    /// assert_eq!(v.indices(), [2, 4]);
    /// assert_eq!(v.dot(&[0.0, 0.0, 1.0, 0.0, 2.0]), 6.0);
    /// ```
    pub fn from_entries(entries: impl IntoIterator<Item = (usize, f64)>) -> Self {
        let mut entries: Vec<(usize, f64)> = entries.into_iter().collect();
        entries.sort_by_key(|(index, _)| *index);
        let mut vector = SparseVector::default();
        for (index, value) in entries {
            if vector.indices.last() == Some(&index) {
                *vector.values.last_mut().expect("as long as indices") += value;
            } else {
                vector.indices.push(index);
                vector.values.push(value);
            }
        }
        let keep: Vec<bool> = vector.values.iter().map(|v| *v != 0.0).collect();
        let mut k = keep.iter();
        vector.indices.retain(|_| *k.next().expect("same length"));
        vector.values.retain(|v| *v != 0.0);
        vector
    }

    /// The entries of a dense vector that are not zero.
    pub fn from_dense(dense: &[f64]) -> Self {
        let entries = dense.iter().enumerate().filter(|(_, v)| **v != 0.0);
        let (indices, values) = entries.map(|(i, v)| (i, *v)).unzip();
        SparseVector { indices, values }
    }

    /// The places of the entries, ascending.
    pub fn indices(&self) -> &[usize] {
        &self.indices
    }

    /// The entries, in the order of [`SparseVector::indices`].
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Index and value of every entry.
    pub fn iter(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.indices.iter().copied().zip(self.values.iter().copied())
    }

    /// Where its entries begin, if there is no gap between them.
    fn run(&self) -> Option<usize> {
        let (first, last) = (*self.indices.first()?, *self.indices.last()?);
        (last - first + 1 == self.indices.len()).then_some(first)
    }

    /// The scalar product with a dense vector.
    pub fn dot(&self, dense: &[f64]) -> f64 {
        match self.run() {
            Some(first) => dot(&self.values, &dense[first..first + self.values.len()]),
            None => self.iter().map(|(i, v)| v * dense[i]).sum(),
        }
    }

    /// `dense += factor · self`.
    pub fn add_to(&self, factor: f64, dense: &mut [f64]) {
        if let Some(first) = self.run() {
            let places = dense[first..first + self.values.len()].iter_mut();
            places.zip(&self.values).for_each(|(x, v)| *x += factor * v);
            return;
        }
        for (i, v) in self.iter() {
            dense[i] += factor * v;
        }
    }
}

/// Σ x y, in sums side by side.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    const SUMS: usize = 8;
    let ((x, x_rest), (y, y_rest)) = (x.as_chunks::<SUMS>(), y.as_chunks::<SUMS>());
    let mut sums = [0.0; SUMS];
    for (x, y) in x.iter().zip(y) {
        (0..SUMS).for_each(|k| sums[k] += x[k] * y[k]);
    }
    let rest: f64 = x_rest.iter().zip(y_rest).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + rest
}

/// Rows that one task works on; fixed, so that the split does not depend on the number of threads.
pub(super) const ROWS_A_TASK: usize = 4096;
/// Columns that go through the matrix together.
const PANEL: usize = 8;

/// y = A x for a symmetric `a` stored whole: n × n times n × k, real or complex.
///
/// Row i of A is read from column i, so every entry of y is one sum in a fixed order: the same bits for any number
/// of threads.
///
/// # Panics
/// When the shapes do not agree.
pub fn multiply<T: Factor>(a: &SparseMatrix, x: MatRef<'_, T>, y: MatMut<'_, T>) {
    T::multiply(a, x, y);
}

/// A number of x in A x. The product is compiled here for each, not where it is called: with all that it calls beside it.
pub trait Factor: Scalar {
    #[doc(hidden)]
    fn multiply(a: &SparseMatrix, x: MatRef<'_, Self>, y: MatMut<'_, Self>);
}

impl Factor for f64 {
    fn multiply(a: &SparseMatrix, x: MatRef<'_, f64>, y: MatMut<'_, f64>) {
        multiply_panels(a, x, y);
    }
}

impl Factor for c64 {
    fn multiply(a: &SparseMatrix, x: MatRef<'_, c64>, y: MatMut<'_, c64>) {
        multiply_panels(a, x, y);
    }
}

fn multiply_panels<T: Scalar>(a: &SparseMatrix, x: MatRef<'_, T>, mut y: MatMut<'_, T>) {
    let (n, k) = (a.ncols(), x.ncols());
    assert!(
        a.nrows() == n && x.nrows() == n && y.nrows() == n && y.ncols() == k,
        "shapes of A, x, y disagree"
    );
    for start in (0..k).step_by(PANEL) {
        let width = PANEL.min(k - start);
        let x = x.subcols(start, width);
        let y = y.as_mut().subcols_mut(start, width);
        match width {
            1 => panel::<T, [T; 1], 1>(a, x, y),
            2 => panel::<T, [T; 2], 2>(a, x, y),
            3 | 4 => panel::<T, [T; 4], 4>(a, x, y),
            _ => panel::<T, Aligned<[T; PANEL]>, PANEL>(a, x, y),
        }
    }
}

/// y = A x for W columns. They are first packed side by side, row by row, so that an entry of A meets all its
/// W factors in one place of memory.
fn panel<T: Scalar, R: Row<T, W>, const W: usize>(a: &SparseMatrix, x: MatRef<'_, T>, y: MatMut<'_, T>) {
    let width = x.ncols();
    with_packed(x, |packed: &[R]| {
        y.par_row_chunks_mut(ROWS_A_TASK).enumerate().for_each(|(task, mut y)| {
            let mut sums = vec![[T::ZERO; W]; y.nrows()];
            Arch::new().dispatch(Rows { a, first: task * ROWS_A_TASK, packed, sums: &mut sums });
            match columns_mut(y.as_mut()) {
                Some(mut columns) => unpack(|i| &sums[i], &mut columns),
                None => (0..width).for_each(|c| {
                    y.as_mut().col_mut(c).iter_mut().zip(&sums).for_each(|(y, sum)| *y = sum[c]);
                }),
            }
        });
    });
}

/// xⱼᵀA xⱼ of the columns of x (n × k), for a symmetric `a` stored whole: a product that is not written down.
///
/// # Panics
/// When the shapes do not agree.
pub fn quadratic_forms(a: &SparseMatrix, x: MatRef<'_, f64>) -> Vec<f64> {
    assert!(a.nrows() == a.ncols() && x.nrows() == a.ncols(), "shapes of A and x disagree");
    let of_panel = |start: usize| {
        let width = FORMED.min(x.ncols() - start);
        let forms = with_packed(x.subcols(start, width), |packed: &[Aligned<[f64; FORMED]>]| {
            let of_rows = |first: usize| {
                let mut sums = [[0.0; FORMED]; ROWS_FORMED];
                let sums = &mut sums[..ROWS_FORMED.min(packed.len() - first)];
                Arch::new().dispatch(Rows { a, first, packed, sums });
                let mut forms = [0.0; FORMED];
                for (x, y) in packed[first..].iter().zip(&*sums) {
                    (0..FORMED).for_each(|c| forms[c] += x.values()[c] * y[c]);
                }
                forms
            };
            let parts: Vec<_> = (0..packed.len()).into_par_iter().step_by(ROWS_FORMED).map(of_rows).collect();
            parts.into_iter().fold([0.0; FORMED], |sum, part| std::array::from_fn(|c| sum[c] + part[c]))
        });
        forms.into_iter().take(width)
    };
    (0..x.ncols()).step_by(FORMED).flat_map(of_panel).collect()
}

/// Columns and rows of a product that is not written down: as much as stays at hand.
const FORMED: usize = 16;
const ROWS_FORMED: usize = 128;

/// The columns, where each is in one piece.
pub(super) fn columns<T>(a: MatRef<'_, T>) -> Option<Vec<&[T]>> {
    a.col_iter().map(|column| column.try_as_col_major().map(|column| column.as_slice())).collect()
}

/// [`columns`], to be written.
pub(super) fn columns_mut<T>(a: MatMut<'_, T>) -> Option<Vec<&mut [T]>> {
    a.col_iter_mut().map(|column| column.try_as_col_major_mut().map(|column| column.as_slice_mut())).collect()
}

/// Result of `f` on columns packed row by row, `W` a row; missing columns have undefined values.
pub(super) fn with_packed<T: Scalar, R: Row<T, W>, const W: usize, Y>(
    x: MatRef<'_, T>,
    f: impl FnOnce(&[R]) -> Y,
) -> Y {
    if let Some(columns) = columns(x) {
        return with_packed_columns(&columns, x.nrows(), f);
    }
    with_workspace(x.nrows(), R::ZERO, |packed: &mut [R]| {
        for (i, row) in packed.iter_mut().enumerate() {
            (0..x.ncols()).for_each(|c| row.values_mut()[c] = x[(i, c)]);
        }
        f(packed)
    })
}

/// [`with_packed`] of columns of `n` rows that are each in one piece.
pub(super) fn with_packed_columns<T: Scalar, R: Row<T, W>, const W: usize, Y>(
    columns: &[&[T]],
    n: usize,
    f: impl FnOnce(&[R]) -> Y,
) -> Y {
    with_workspace(n, R::ZERO, |packed: &mut [R]| {
        packed.par_chunks_mut(ROWS_A_TASK).enumerate().for_each(|(task, packed)| {
            let rows = task * ROWS_A_TASK..task * ROWS_A_TASK + packed.len();
            pack(&columns.iter().map(|column| &column[rows.clone()]).collect::<Vec<_>>(), packed);
        });
        f(packed)
    })
}

/// The rows of A from `first` on, times packed columns.
struct Rows<'a, T, R, const W: usize> {
    a: &'a SparseMatrix,
    first: usize,
    packed: &'a [R],
    sums: &'a mut [[T; W]],
}

impl<T: Scalar, R: Row<T, W>, const W: usize> WithSimd for Rows<'_, T, R, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (starts, rows_of, values) = (self.a.col_ptr(), self.a.row_idx(), self.a.val());
        for (i, sum) in self.sums.iter_mut().enumerate() {
            let entries = starts[self.first + i] as usize..starts[self.first + i + 1] as usize;
            let mut own = [T::ZERO; W];
            for (j, v) in rows_of[entries.clone()].iter().zip(&values[entries]) {
                let x = self.packed[*j as usize].values();
                for c in 0..W {
                    own[c] += x[c] * *v;
                }
            }
            *sum = own;
        }
    }
}

/// A X as a new matrix, for a symmetric `a` stored whole; the allocating form of [`multiply`].
pub fn times(a: &SparseMatrix, x: MatRef<'_, f64>) -> Mat<f64> {
    let mut y = Mat::zeros(a.ncols(), x.ncols());
    multiply(a, x, y.as_mut());
    y
}

/// Sparse vectors as the columns of a dense matrix of `n` rows.
pub fn dense_columns(n: usize, vectors: &[&SparseVector]) -> Mat<f64> {
    let mut dense = Mat::zeros(n, vectors.len());
    vectors.iter().enumerate().for_each(|(j, v)| v.add_to(1.0, dense.col_as_slice_mut(j)));
    dense
}

/// Whether the stiffness A answers the motion x, one column, with no force: max |A x| is no more than 1e-14 of max (|A| |x|), the
/// round-off of forming it. (The softest elastic motion of a fine plate stands four decades above that.)
pub fn is_unresisted(a: &SparseMatrix, x: MatRef<'_, f64>) -> bool {
    const ROUND_OFF: f64 = 1e-14;
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |s: f64, v| s.max(v.abs()));
    let force = times(a, x);
    let mut terms = vec![0.0; x.nrows()];
    for j in 0..a.ncols() {
        let entries = a.row_idx_of_col(j).zip(a.val_of_col(j));
        entries.for_each(|(i, v)| terms[i] += (v * x[(j, 0)]).abs());
    }
    largest(&mut force.col_as_slice(0).iter().copied()) <= ROUND_OFF * largest(&mut terms.into_iter())
}

/// Σ d v vᵀ of order `n`, both triangles stored.
///
/// # Panics
/// When an index of a vector is not below `n`.
pub fn sum_of_squares<'a>(
    n: usize,
    terms: impl IntoIterator<Item = (f64, &'a SparseVector)>,
) -> SparseMatrix {
    let mut triplets = Vec::new();
    for (d, v) in terms {
        for (i, a) in v.iter() {
            triplets.extend(v.iter().map(|(j, b)| entry(i, j, d * (a * b))));
        }
    }
    SparseMatrix::try_new_from_triplets(n, n, &triplets).expect("indices are below n")
}

/// A x as a new vector, for a symmetric `a` stored whole.
pub fn multiply_vector<T: Factor>(a: &SparseMatrix, x: &[T]) -> Vec<T> {
    let mut y = vec![T::default(); x.len()];
    multiply(
        a,
        MatRef::from_column_major_slice(x, x.len(), 1),
        MatMut::from_column_major_slice_mut(&mut y, x.len(), 1),
    );
    y
}

/// Σ factor · matrix on the union of the patterns; entries that cancel stay as stored zeros.
///
/// # Panics
/// When there is no term, or the shapes do not agree.
pub fn add_scaled<T: Scalar>(terms: &[(T, &SparseMatrix)]) -> SparseColMat<Index, T> {
    let (first, rest) = terms.split_first().expect("a sum has a term");
    let (nrows, ncols) = (first.1.nrows(), first.1.ncols());
    assert!(
        rest.iter().all(|(_, a)| a.nrows() == nrows && a.ncols() == ncols),
        "shapes of the terms disagree"
    );
    let same = rest.iter().all(|(_, a)| a.col_ptr() == first.1.col_ptr() && a.row_idx() == first.1.row_idx());
    if same {
        let mut values: Vec<T> = first.1.val().iter().map(|v| first.0 * *v).collect();
        for (factor, a) in rest {
            values.iter_mut().zip(a.val()).for_each(|(sum, v)| *sum += *factor * *v);
        }
        let pattern = first.1.symbolic().to_owned().expect("memory for a pattern");
        return SparseColMat::new(pattern, values);
    }
    let matrices: Vec<&SparseMatrix> = terms.iter().map(|(_, a)| *a).collect();
    let (starts, rows, values) = union(&matrices, 1, |entries, value: &mut [T]| {
        terms.iter().zip(entries).for_each(|((factor, _), v)| value[0] += *factor * *v);
    });
    SparseColMat::new(SymbolicSparseColMat::new_checked(nrows, ncols, starts, None, rows), values)
}

/// The same two matrices, each on the union of their patterns with zeros where it has no entry, as long as that adds no more than
/// a twentieth to either: sums of matrices on one pattern are those of their values.
///
/// # Panics
/// When the shapes do not agree.
pub fn on_one_pattern(a: SparseMatrix, b: SparseMatrix) -> [SparseMatrix; 2] {
    let wider = add_scaled(&[(1.0, &a), (0.0, &b)]);
    if [&a, &b].iter().any(|own| 20 * wider.compute_nnz() > 21 * own.compute_nnz()) {
        return [a, b];
    }
    let other = add_scaled(&[(0.0, &a), (1.0, &b)]);
    [wider, other]
}

/// A matrix of compressed columns: column j has the entries `starts[j]..starts[j + 1]`, their `rows` ascending.
///
/// # Panics
/// When the columns are none, or beyond 2³² entries.
pub fn compressed(nrows: usize, starts: &[usize], rows: Vec<Index>, values: Vec<f64>) -> SparseMatrix {
    SparseMatrix::new(compressed_pattern(nrows, starts, rows), values)
}

/// The pattern of a matrix of compressed columns.
///
/// # Panics
/// Those of [`compressed`].
pub fn compressed_pattern(nrows: usize, starts: &[usize], rows: Vec<Index>) -> SymbolicSparseColMat<Index> {
    SymbolicSparseColMat::new_checked(nrows, starts.len() - 1, places(starts), None, rows)
}

/// Places of entries.
///
/// # Panics
/// Beyond 2³².
fn places(starts: &[usize]) -> Vec<Index> {
    assert!(starts.last().is_none_or(|end| Index::try_from(*end).is_ok()), "less than 2³² entries");
    starts.iter().map(|start| *start as Index).collect()
}

/// Where the columns of matrices of one size begin on the union of their patterns, and for each of its entries the
/// row and what `fill` makes of the entries that the matrices have there (zero where one has none): `width` values.
pub(super) fn union<V>(
    matrices: &[&SparseMatrix],
    width: usize,
    fill: impl Fn(&[f64], &mut [V]) + Sync,
) -> (Vec<Index>, Vec<Index>, Vec<V>)
where
    V: Clone + Default + Send,
{
    let ncols = matrices[0].ncols();
    let columns = (0..ncols).into_par_iter().with_min_len(ROWS_A_TASK);
    let lengths: Vec<usize> =
        columns.map_init(|| Joined::new(matrices), |joined, j| joined.count(j)).collect();
    let mut starts = vec![0];
    starts.extend(lengths.iter().scan(0, |end, length| {
        *end += length;
        Some(*end)
    }));
    let (mut rows, mut values) = (vec![0; starts[ncols]], vec![V::default(); width * starts[ncols]]);
    let mut tasks = Vec::new();
    let (mut rows_left, mut values_left) = (&mut rows[..], &mut values[..]);
    for first in (0..ncols).step_by(ROWS_A_TASK) {
        let end = ncols.min(first + ROWS_A_TASK);
        let entries = starts[end] - starts[first];
        let (rows, values);
        (rows, rows_left) = rows_left.split_at_mut(entries);
        (values, values_left) = values_left.split_at_mut(width * entries);
        tasks.push((first..end, rows, values));
    }
    tasks.into_par_iter().for_each(|(columns, rows, values)| {
        let (mut joined, mut places) = (Joined::new(matrices), rows.iter_mut().zip(values.chunks_mut(width)));
        for j in columns {
            joined.column(j, |i, entries| {
                let (row, values) = places.next().expect("counted before");
                *row = i;
                fill(entries, values);
            });
        }
    });
    (places(&starts), rows, values)
}

/// Matrices of one size, met column by column on the union of their patterns.
struct Joined<'a> {
    matrices: &'a [&'a SparseMatrix],
    /// Remaining entries of a column of each matrix.
    open: Vec<(&'a [Index], &'a [f64])>,
    entries: Vec<f64>,
}

impl<'a> Joined<'a> {
    fn new(matrices: &'a [&'a SparseMatrix]) -> Self {
        Joined { matrices, open: Vec::new(), entries: vec![0.0; matrices.len()] }
    }

    /// The rows of column `j`, where all matrices have the same: most have.
    fn common(&self, j: usize) -> Option<&'a [Index]> {
        let rows = self.matrices[0].row_idx_of_col_raw(j);
        self.matrices[1..].iter().all(|a| a.row_idx_of_col_raw(j) == rows).then_some(rows)
    }

    /// Hands on every row of column `j`, ascending, with the entry that each matrix has there, or zero.
    fn column(&mut self, j: usize, mut take: impl FnMut(Index, &[f64])) {
        self.open.clear();
        self.open.extend(self.matrices.iter().map(|a| (a.row_idx_of_col_raw(j), a.val_of_col(j))));
        if let Some(rows) = self.common(j) {
            for (k, row) in rows.iter().enumerate() {
                self.entries.iter_mut().zip(&self.open).for_each(|(entry, (_, values))| *entry = values[k]);
                take(*row, &self.entries);
            }
            return;
        }
        let next =
            |open: &[(&[Index], &[f64])]| open.iter().filter_map(|(rows, _)| rows.first()).min().copied();
        while let Some(row) = next(&self.open) {
            for ((rows, values), entry) in self.open.iter_mut().zip(&mut self.entries) {
                let there = rows.first() == Some(&row);
                *entry = if there { values[0] } else { 0.0 };
                if there {
                    (*rows, *values) = (&rows[1..], &values[1..]);
                }
            }
            take(row, &self.entries);
        }
    }

    /// How many rows column `j` has.
    fn count(&mut self, j: usize) -> usize {
        if let Some(rows) = self.common(j) {
            return rows.len();
        }
        let mut count = 0;
        self.column(j, |_, _| count += 1);
        count
    }
}

/// ‖A‖₁ = max_j Σ_i |a_ij|, which is also ‖A‖_∞ for a symmetric matrix.
pub fn norm_1(a: &SparseMatrix) -> f64 {
    (0..a.ncols()).map(|j| a.val_of_col(j).iter().map(|v| v.abs()).sum()).fold(0.0, f64::max)
}

/// The entries on the diagonal; zero where none is stored.
pub fn diagonal(a: &SparseMatrix) -> Vec<f64> {
    (0..a.ncols())
        .map(|j| a.row_idx_of_col(j).position(|i| i == j).map_or(0.0, |k| a.val_of_col(j)[k]))
        .collect()
}

/// diag(`values`).
pub fn diagonal_matrix(values: &[f64]) -> SparseMatrix {
    let entries: Vec<_> = values.iter().enumerate().map(|(i, v)| entry(i, i, *v)).collect();
    SparseMatrix::try_new_from_triplets(values.len(), values.len(), &entries).expect("indices of the values")
}

#[cfg(test)]
mod tests;
