//! The few sparse operations that equilibrium and stability need, behind one door.

use crate::linalg::SparseMatrix;
use faer::linalg::solvers::Solve;
use faer::sparse::Triplet;
use faer::sparse::linalg::solvers::Lu;
use faer::{Mat, MatMut, MatRef};

/// A factorised sparse symmetric matrix, definite or not.
pub(crate) struct Factor(Lu<usize, f64>);

impl Factor {
    /// Factorises `a`; `None` when it is exactly singular.
    pub(crate) fn new(a: &SparseMatrix) -> Option<Self> {
        a.sp_lu().ok().map(Factor)
    }

    /// x ← A⁻¹ x for every column.
    pub(crate) fn solve_in_place(&self, x: MatMut<'_, f64>) {
        self.0.solve_in_place(x);
    }
}

/// y = A x for every column; `a` symmetric and stored whole.
pub(crate) fn multiply(a: &SparseMatrix, x: MatRef<'_, f64>) -> Mat<f64> {
    let (columns, rows, values) = (a.col_ptr(), a.row_idx(), a.val());
    Mat::from_fn(x.nrows(), x.ncols(), |i, j| {
        let range = columns[i]..columns[i + 1];
        range.map(|slot| values[slot] * x[(rows[slot], j)]).sum()
    })
}

/// Σ factor · matrix on the union of the patterns.
pub(crate) fn add_scaled(
    n: usize,
    terms: &[(f64, &SparseMatrix)],
    extra: &[Triplet<usize, usize, f64>],
) -> SparseMatrix {
    let mut triplets = Vec::new();
    for (factor, matrix) in terms {
        let (columns, rows, values) = (matrix.col_ptr(), matrix.row_idx(), matrix.val());
        for j in 0..matrix.ncols() {
            triplets
                .extend((columns[j]..columns[j + 1]).map(|s| Triplet::new(rows[s], j, factor * values[s])));
        }
    }
    triplets.extend_from_slice(extra);
    SparseMatrix::try_new_from_triplets(n, n, &triplets).expect("indices are those of matrices of this size")
}

/// ‖A‖₁, which is ‖A‖_∞ too.
pub(crate) fn norm_1(a: &SparseMatrix) -> f64 {
    let columns = a.col_ptr();
    let sums =
        (0..a.ncols()).map(|j| a.val()[columns[j]..columns[j + 1]].iter().map(|v| v.abs()).sum::<f64>());
    sums.fold(0.0, f64::max)
}

/// ‖x‖₂.
pub(crate) fn norm_2(x: &[f64]) -> f64 {
    x.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Aᵀ B of two tall matrices, on one thread: the same numbers whatever the number of threads.
pub(crate) fn gram(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    product(a.transpose(), b)
}

/// A B, on one thread.
pub(crate) fn product(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    let mut c = Mat::zeros(a.nrows(), b.ncols());
    faer::linalg::matmul::matmul(c.as_mut(), faer::Accum::Replace, a, b, 1.0, faer::Par::Seq);
    c
}
