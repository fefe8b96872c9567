//! Half solutions of many right-hand sides, and the compliances fᵀA⁻¹g that they measure.
//!
//! With PSASPᵀ = LBLᵀ, fᵀA⁻¹g = (L⁻¹PSf)ᵀ B⁻¹ (L⁻¹PSg): the way back down the tree is not needed, and of a sparse f the way up
//! touches only what lies between its entries and the root.

use super::field::{Field, Lanes};
use super::{COLUMNS_A_TASK, Multifrontal, ROWS_A_TASK, SymmetricFactor};
use crate::linalg::room::with_room;
use crate::linalg::tall::gram;
use faer::{Mat, MatMut};
use rayon::prelude::*;

impl<T: Field> Multifrontal<T> {
    /// L⁻¹PS b of every column, as many together as there are lanes.
    pub(super) fn halves(&self, rhs: MatMut<'_, T>) {
        rhs.par_col_chunks_mut(COLUMNS_A_TASK).for_each(|columns| match columns.ncols() {
            1 => self.half::<T::Lanes<1>>(columns),
            2..=4 => self.half::<T::Lanes<4>>(columns),
            5..=8 => self.half::<T::Wide<8>>(columns),
            _ => self.half::<T::Wide<COLUMNS_A_TASK>>(columns),
        });
    }

    fn half<L: Lanes<T>>(&self, mut rhs: MatMut<'_, T>) {
        with_room(self.n(), L::ZERO, |x| {
            self.lay(rhs.as_ref(), x);
            self.substitution().up(x);
            rhs.as_mut().par_row_chunks_mut(ROWS_A_TASK).enumerate().for_each(|(task, mut rhs)| {
                let x = &x[task * ROWS_A_TASK..];
                for (k, column) in rhs.as_mut().col_iter_mut().enumerate() {
                    column.iter_mut().zip(x).for_each(|(y, x)| *y = x.get(k));
                }
            });
        });
    }
}

/// FᵀA⁻¹F of the columns of `f`, which are lost; the lower triangle is computed and mirrored.
///
/// # Panics
/// When `f` has not n rows.
pub fn compliances(factor: &dyn SymmetricFactor, mut f: MatMut<'_, f64>) -> Mat<f64> {
    /// Columns that go through the pivots together: wide enough for the products, few enough to be held twice.
    const TOGETHER: usize = 64;
    let columns = f.ncols();
    factor.forward_in_place(f.as_mut());
    let mut square = Mat::zeros(columns, columns);
    let mut room = Mat::zeros(f.nrows(), TOGETHER.min(columns));
    for start in (0..columns).step_by(TOGETHER) {
        let width = TOGETHER.min(columns - start);
        let mut turned = room.subcols_mut(0, width);
        turned.copy_from(f.as_ref().subcols(start, width));
        factor.pivots_in_place(turned.as_mut());
        let part = gram(f.as_ref().subcols(start, columns - start), turned.as_ref());
        for j in 0..width {
            for i in j..columns - start {
                square[(start + i, start + j)] = part[(i, j)];
                square[(start + j, start + i)] = part[(i, j)];
            }
        }
    }
    square
}

#[cfg(test)]
mod tests {
    use super::super::super::samples;
    use super::super::super::sparse::add_scaled;
    use super::super::factorize;
    use super::*;

    /// Against whole solutions, for numbers of columns on either side of the lanes and of those that go together.
    #[test]
    fn compliances_are_those_of_whole_solutions() {
        let (k, m) = samples::plate(24, false);
        let a = add_scaled(&[(1.0, &k), (-(std::f64::consts::TAU * 5000.0).powi(2), &m)]);
        let factor = factorize(&a).unwrap();
        assert!(factor.inertia().negative > 0);
        for columns in [1, 3, 7, 16, 83] {
            let f = Mat::from_fn(a.ncols(), columns, |i, j| {
                if j % 2 == 0 { ((i + 3 * j) as f64 * 0.7).sin() } else { f64::from(i % 97 == j) }
            });
            let mut x = f.clone();
            factor.solve_in_place(x.as_mut());
            let expected = gram(f.as_ref(), x.as_ref());
            let found = compliances(&*factor, f.clone().as_mut());
            assert!((&found - &expected).norm_max() < 1e-11 * expected.norm_max());
        }
    }

    #[test]
    fn an_analysis_knows_its_pattern() {
        let (k, m) = samples::plate(6, false);
        let symbolic = factorize(&add_scaled(&[(1.0, &k), (1.0, &m)])).unwrap().symbolic();
        assert!(symbolic.fits(add_scaled(&[(2.0, &m), (1.0, &k)]).symbolic()));
        assert!(!symbolic.fits(samples::identity(k.ncols()).symbolic()));
        assert!(!symbolic.fits(samples::plate(7, false).0.symbolic()));
    }
}
