//! Sparse matrices from and to nalgebra-sparse, the type that a program around this library may hold them in.

use super::SparseMatrix;
use super::sparse::{Index, compressed};
use nalgebra_sparse::CscMatrix;

/// A matrix of nalgebra-sparse as [`SparseMatrix`]; the values change hands without a copy.
///
/// ```
/// use nalgebra_sparse::CscMatrix;
/// use stridor_linalg::nalgebra::{from_nalgebra, to_nalgebra};
/// let a = CscMatrix::try_from_csc_data(2, 2, vec![0, 1, 3], vec![0, 0, 1], vec![4.0, 1.0, 3.0]).unwrap();
/// assert_eq!(to_nalgebra(from_nalgebra(a.clone())), a);
/// ```
///
/// # Panics
/// Beyond 2³² rows or entries.
pub fn from_nalgebra(matrix: CscMatrix<f64>) -> SparseMatrix {
    let n_rows = matrix.nrows();
    assert!(Index::try_from(n_rows).is_ok(), "less than 2³² rows");
    let (starts, rows, values) = matrix.disassemble();
    compressed(n_rows, &starts, rows.iter().map(|row| *row as Index).collect(), values)
}

/// A [`SparseMatrix`] as one of nalgebra-sparse; the values change hands without a copy.
///
/// # Panics
/// When the rows of a column do not ascend, as those of every matrix that this library makes do.
pub fn to_nalgebra(matrix: SparseMatrix) -> CscMatrix<f64> {
    let (pattern, values) = matrix.into_parts();
    let wide = |indices: &[Index]| indices.iter().map(|k| *k as usize).collect();
    let (starts, rows) = (wide(pattern.col_ptr()), wide(pattern.row_idx()));
    CscMatrix::try_from_csc_data(pattern.nrows(), pattern.ncols(), starts, rows, values)
        .expect("rows of a column ascend")
}
