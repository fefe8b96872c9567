//! Symmetric matrices with entries in a few rows, such as the dashpots of a structure: products touch those rows only.

use super::SparseMatrix;
use super::factor::SymbolicFactor;
use super::sparse::{add_scaled, diagonal, diagonal_matrix, entry, times};
use faer::{Mat, MatRef};

/// A symmetric matrix, as its rows that have entries and what stands between them.
#[derive(Debug, Clone)]
pub struct RowSparse {
    rows: Vec<usize>,
    own: SparseMatrix,
}

impl RowSparse {
    /// Of a symmetric matrix stored whole.
    pub fn new(d: &SparseMatrix) -> Self {
        let rows: Vec<usize> = (0..d.ncols()).filter(|j| !d.row_idx_of_col_raw(*j).is_empty()).collect();
        let place = |row: usize| rows.partition_point(|r| *r < row);
        let entries = rows.iter().enumerate().flat_map(|(j, column)| {
            let entries = d.row_idx_of_col(*column).zip(d.val_of_col(*column));
            entries.map(move |(i, v)| (i, j, *v))
        });
        let triplets: Vec<_> = entries.map(|(i, j, v)| entry(place(i), j, v)).collect();
        let own = SparseMatrix::try_new_from_triplets(rows.len(), rows.len(), &triplets);
        RowSparse { own: own.expect("indices of the rows"), rows }
    }

    /// Whether products with the rows alone cost little beside those with a matrix that has entries in all `n` rows.
    pub fn are_few(&self, n: usize) -> bool {
        8 * self.rows.len() <= n
    }

    /// The rows with entries, ascending.
    pub fn rows(&self) -> &[usize] {
        &self.rows
    }

    /// Whether D has no negative eigenvalue, but for the rounding of its entries.
    pub fn is_semidefinite(&self) -> bool {
        /// A part of the diagonal, which D is stiffened by: dashpots between two points are singular.
        const ROUNDING: f64 = 1e-12;
        let sizes: Vec<f64> = diagonal(&self.own).iter().map(|v| v.abs()).collect();
        let stiffened = add_scaled(&[(1.0, &self.own), (ROUNDING, &diagonal_matrix(&sizes))]);
        let inertia = SymbolicFactor::new(stiffened.symbolic()).and_then(|s| s.inertia(&stiffened));
        inertia.is_ok_and(|inertia| inertia.negative == 0)
    }

    /// The rows of D x that are not zero: one for each of [`RowSparse::rows`].
    ///
    /// # Panics
    /// When x has fewer rows than D.
    pub fn times(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        self.times_picked(picked(x, &self.rows).as_ref())
    }

    /// [`RowSparse::times`], given those rows of x only.
    pub fn times_picked(&self, rows_of_x: MatRef<'_, f64>) -> Mat<f64> {
        times(&self.own, rows_of_x)
    }

    /// y += D x.
    ///
    /// # Panics
    /// When y has fewer rows than D.
    pub fn add_times(&self, x: MatRef<'_, f64>, y: &mut Mat<f64>) {
        let image = self.times(x);
        for j in 0..image.ncols() {
            let y = y.col_as_slice_mut(j);
            self.rows.iter().zip(image.col_as_slice(j)).for_each(|(i, v)| y[*i] += v);
        }
    }
}

/// Some rows of a multivector.
pub fn picked(v: MatRef<'_, f64>, rows: &[usize]) -> Mat<f64> {
    Mat::from_fn(rows.len(), v.ncols(), |i, j| v[(rows[i], j)])
}

#[cfg(test)]
mod tests {
    use super::super::samples;
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn dashpots_are_semidefinite_unless_one_is_negative() {
        // Between pairs of points, each a row of two, and one that gives a little energy.
        let of = |worst: f64| {
            let mut triplets = Vec::new();
            for k in 0..30usize {
                let (i, j, c) =
                    (7 * k, 7 * k + 3, if k == 11 { worst } else { 10f64.powi(k as i32 % 9 - 4) });
                for (a, b, sign) in [(i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)] {
                    triplets.push(entry(a, b, sign * c));
                }
            }
            RowSparse::new(&SparseMatrix::try_new_from_triplets(300, 300, &triplets).unwrap())
        };
        assert!(of(1.0).is_semidefinite());
        assert!(of(1e-9).is_semidefinite());
        assert!(!of(-1e-9).is_semidefinite());
        let swapped = [entry(2, 5, 1.0), entry(5, 2, 1.0)];
        assert!(
            !RowSparse::new(&SparseMatrix::try_new_from_triplets(9, 9, &swapped).unwrap()).is_semidefinite()
        );
    }

    #[test]
    fn products_are_those_of_the_whole_matrix() {
        let n = 60;
        let whole = Mat::from_fn(n, n, |i, j| {
            let seldom = i % 7 == 3 && j % 7 == 3;
            if seldom { ((i * j) as f64).cos() } else { 0.0 }
        });
        let few = RowSparse::new(&samples::from_dense(whole.as_ref()));
        assert_eq!(few.rows(), (0..n).filter(|i| i % 7 == 3).collect::<Vec<_>>());
        let x = Mat::from_fn(n, 11, |i, j| ((3 * i + 5 * j) as f64).sin());
        let expected = &whole * &x;
        assert!(within(
            (few.times(x.as_ref()) - picked(expected.as_ref(), few.rows())).norm_max(),
            1e-13,
            RoundOff
        ));
        let mut y = x.clone();
        few.add_times(x.as_ref(), &mut y);
        assert!(within((y - &x - expected).norm_max(), 1e-13, RoundOff));
    }
}
