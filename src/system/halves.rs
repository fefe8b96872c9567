//! The symmetric and the skew part of a matrix, without what is rounding.

use crate::linalg::SparseMatrix;
use crate::linalg::sparse::add_scaled;

/// |a_ij − a_ji| / 2 up to this part of √(r_i r_j), r the largest entry of a row, is rounding of the exporting program.
pub(super) const ROUND_OFF: f64 = 1e-14;
/// The same where it is found in a quarter of all rows or more: sums in another order, or a file with few digits.
const SPREAD_ROUND_OFF: f64 = 1e-10;
const SPREAD: usize = 4;

/// max_j |a_ij|, |a_ji| of every row i.
pub(super) fn row_sizes(a: &SparseMatrix) -> Vec<f64> {
    let mut size = vec![0.0f64; a.nrows()];
    for j in 0..a.ncols() {
        for (i, v) in a.row_idx_of_col(j).zip(a.val_of_col(j)) {
            size[i] = size[i].max(v.abs());
            size[j] = size[j].max(v.abs());
        }
    }
    size
}

/// Row, column and value.
pub(super) type Entry = (usize, usize, f64);

/// ½(A + Aᵀ), and the entries below the diagonal of ½(A − Aᵀ) that are more than rounding.
pub(super) struct Halves {
    pub(super) symmetric: SparseMatrix,
    pub(super) skew: Vec<Entry>,
}

impl Halves {
    pub(super) fn of(a: &SparseMatrix) -> Self {
        let Ok(t) = a.transpose().to_col_major() else {
            // Only memory can fail here, and add_scaled would need more of it.
            return Halves { symmetric: a.clone(), skew: Vec::new() };
        };
        if t.col_ptr() == a.col_ptr() && t.row_idx() == a.row_idx() && t.val() == a.val() {
            return Halves { symmetric: t, skew: Vec::new() };
        }
        let size = row_sizes(a);
        let half = add_scaled(&[(0.5, a), (-0.5, &t)]);
        let mut skew = Vec::new();
        for j in 0..half.ncols() {
            for (i, v) in half.row_idx_of_col(j).zip(half.val_of_col(j)) {
                if i > j && v.abs() > ROUND_OFF * (size[i] * size[j]).sqrt() {
                    skew.push((i, j, *v));
                }
            }
        }
        Halves { symmetric: add_scaled(&[(0.5, a), (0.5, &t)]), skew }
    }
}

impl Halves {
    /// Drops a skew part that is rounding all over the matrix, and says so; `size` are the largest entries of the rows.
    pub(super) fn without_rounding(&mut self, size: &[f64], place: &str) -> Option<String> {
        let mut touched: Vec<usize> = self.skew.iter().flat_map(|(i, j, _)| [*i, *j]).collect();
        touched.sort_unstable();
        touched.dedup();
        let relative = |(i, j, v): &(usize, usize, f64)| 2.0 * v.abs() / (size[*i] * size[*j]).sqrt();
        let largest = self.skew.iter().map(relative).fold(0.0, f64::max);
        if touched.len() * SPREAD < size.len() || largest == 0.0 || largest > SPREAD_ROUND_OFF {
            return None;
        }
        self.skew.clear();
        let (rows, n) = (touched.len(), size.len());
        Some(format!(
            "{place} is not symmetric in {rows} of {n} rows, by up to {largest:.1e} of the largest entries there: taken as rounding, half of the sum with its transpose is used"
        ))
    }
}

/// The entries of a skew matrix, given those below its diagonal.
pub(super) fn mirrored(below: &[Entry]) -> Vec<Entry> {
    below.iter().flat_map(|(i, j, v)| [(*i, *j, *v), (*j, *i, -*v)]).collect()
}
