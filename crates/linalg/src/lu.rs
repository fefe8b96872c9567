//! P A = L U of small dense matrices, on one thread.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, inverse, solve};
use faer::linalg::triangular_solve;
use faer::perm::PermRef;
use faer::prelude::*;
use faer::traits::ComplexField;
use faer::{Conj, Mat, MatMut, MatRef, Par, c64};

/// The factors of a square matrix, with partial pivoting. Those of a singular one give infinities and NaN.
#[derive(Debug)]
pub struct Lu<T> {
    /// U, and below its diagonal L but for the ones on its own.
    factors: Mat<T>,
    rows: [Vec<usize>; 2],
    exchanges: usize,
}

impl<T: ComplexField> Lu<T> {
    /// The factors of A, in its memory.
    ///
    /// ```
    /// use stridor_linalg::lu::Lu;
    /// let lu = Lu::new(faer::mat![[0.0, 2.0], [4.0, 1.0]]);
    /// assert_eq!(lu.solve(faer::mat![[2.0], [5.0]]), faer::mat![[1.0], [1.0]]);
    /// ```
    ///
    /// # Panics
    /// When A is not square.
    pub fn new(mut a: Mat<T>) -> Self {
        let n = a.nrows();
        assert!(a.ncols() == n, "a square matrix");
        let mut rows = [vec![0; n], vec![0; n]];
        let [forward, backward] = &mut rows;
        let scratch = factor::lu_in_place_scratch::<usize, T>(n, n, Par::Seq, Default::default());
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        let (info, _) =
            factor::lu_in_place(a.as_mut(), forward, backward, Par::Seq, stack, Default::default());
        Lu { factors: a, rows, exchanges: info.transposition_count }
    }

    fn order(&self) -> PermRef<'_, usize> {
        PermRef::new_checked(&self.rows[0], &self.rows[1], self.factors.nrows())
    }

    /// A⁻¹b of every column.
    pub fn solve(&self, mut b: Mat<T>) -> Mat<T> {
        self.solve_in_place(b.as_mut());
        b
    }

    /// A⁻¹b of every column, in the place of b.
    ///
    /// # Panics
    /// When b has not as many rows as A.
    pub fn solve_in_place(&self, b: MatMut<'_, T>) {
        let lu = self.factors.as_ref();
        self.with_stack(b.ncols(), |stack| {
            solve::solve_in_place_with_conj(lu, lu, self.order(), Conj::No, b, Par::Seq, stack);
        });
    }

    /// A⁻ᵀb of every column, or with [`Conj::Yes`] A⁻ᴴb, in the place of b.
    ///
    /// # Panics
    /// When b has not as many rows as A.
    pub fn solve_transpose_in_place(&self, conj: Conj, b: MatMut<'_, T>) {
        let lu = self.factors.as_ref();
        self.with_stack(b.ncols(), |stack| {
            solve::solve_transpose_in_place_with_conj(lu, lu, self.order(), conj, b, Par::Seq, stack);
        });
    }

    /// U, and below its diagonal L but for the ones on its own.
    pub(super) fn factors(&self) -> MatRef<'_, T> {
        self.factors.as_ref()
    }

    /// L⁻¹P b of every column, in the place of b.
    pub(super) fn solve_lower(&self, mut b: MatMut<'_, T>) {
        let unordered = b.rb().to_owned();
        for j in 0..b.ncols() {
            let target = b.rb_mut().col_mut(j);
            target.iter_mut().zip(&self.rows[0]).for_each(|(v, row)| *v = unordered[(*row, j)].clone());
        }
        triangular_solve::solve_unit_lower_triangular_in_place(self.factors(), b, Par::Seq);
    }

    /// U⁻¹b of every column, in the place of b.
    pub(super) fn solve_upper(&self, b: MatMut<'_, T>) {
        triangular_solve::solve_upper_triangular_in_place(self.factors(), b, Par::Seq);
    }

    /// U⁻ᴴb of every column, in the place of b.
    pub(super) fn solve_upper_adjoint(&self, b: MatMut<'_, T>) {
        triangular_solve::solve_lower_triangular_in_place(self.factors().adjoint(), b, Par::Seq);
    }

    /// PᵀL⁻ᴴb of every column, in the place of b.
    pub(super) fn solve_lower_adjoint(&self, mut b: MatMut<'_, T>) {
        triangular_solve::solve_unit_upper_triangular_in_place(
            self.factors().adjoint(),
            b.rb_mut(),
            Par::Seq,
        );
        let ordered = b.rb().to_owned();
        for j in 0..b.ncols() {
            let mut target = b.rb_mut().col_mut(j);
            self.rows[0].iter().enumerate().for_each(|(i, row)| target[*row] = ordered[(i, j)].clone());
        }
    }

    /// The pivots: the diagonal of U.
    pub(super) fn pivots(&self) -> impl Iterator<Item = T> + '_ {
        (0..self.factors.nrows()).map(|i| self.factors[(i, i)].clone())
    }

    fn with_stack(&self, columns: usize, solve: impl FnOnce(&mut MemStack)) {
        let n = self.factors.nrows();
        let scratch = solve::solve_in_place_scratch::<usize, T>(n, columns, Par::Seq)
            .or(solve::solve_transpose_in_place_scratch::<usize, T>(n, columns, Par::Seq));
        solve(MemStack::new(&mut MemBuffer::new(scratch)));
    }
}

impl Lu<c64> {
    /// det A / |det A|; `None` when a pivot is zero or not finite. The pivots are never multiplied by their size, so that
    /// nothing overflows.
    pub fn phase(&self) -> Option<c64> {
        let mut phase = c64::new(if self.exchanges.is_multiple_of(2) { 1.0 } else { -1.0 }, 0.0);
        for pivot in self.pivots() {
            let size = pivot.norm();
            if !(size > 0.0 && size.is_finite()) {
                return None;
            }
            phase *= pivot / size;
        }
        Some(phase / phase.norm())
    }
}

/// A⁻¹ and det A / |det A| of a square complex matrix; `None` when a pivot is zero or not finite.
pub fn inverse_and_phase(a: Mat<c64>) -> Option<(Mat<c64>, c64)> {
    let n = a.nrows();
    let lu = Lu::new(a);
    let phase = lu.phase()?;
    let (mut result, factors) = (Mat::zeros(n, n), lu.factors.as_ref());
    let scratch = inverse::inverse_scratch::<usize, c64>(n, Par::Seq);
    let mut memory = MemBuffer::new(scratch);
    inverse::inverse(result.as_mut(), factors, factors, lu.order(), Par::Seq, MemStack::new(&mut memory));
    Some((result, phase))
}

#[cfg(test)]
mod tests {
    use super::super::samples::random_symmetric;
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    fn random(n: usize, seed: u64, size: f64) -> Mat<c64> {
        let (re, im) = (random_symmetric(n, seed).to_dense(), random_symmetric(n, seed + 1).to_dense());
        Mat::from_fn(n, n, |i, j| c64::new(re[(i, j)] + (i * j) as f64, im[(i, j)] - j as f64) * size)
    }

    #[test]
    fn factors_solve_with_the_matrix_its_transpose_and_its_adjoint() {
        for n in [0, 1, 9, 70] {
            let a = random(n, 3, 1.0);
            let x = Mat::from_fn(n, 3, |i, j| c64::new((i as f64 * 0.7).sin(), (i * j) as f64 * 0.1));
            let lu = Lu::new(a.clone());
            // The residual, which unlike the error does not depend on the condition of A: n ε ‖A‖ ‖x‖, times ten.
            let near = |a: Mat<c64>, solve: &dyn Fn(Mat<c64>) -> Mat<c64>| {
                let b = &a * &x;
                let found = solve(b.clone());
                let bound = 10.0 * n as f64 * f64::EPSILON * a.norm_l2() * found.norm_l2();
                within((a * found - b).norm_l2(), bound, RoundOff)
            };
            let transposed = |conj: Conj| {
                let lu = &lu;
                move |mut b: Mat<c64>| {
                    lu.solve_transpose_in_place(conj, b.as_mut());
                    b
                }
            };
            assert!(near(a.clone(), &|b| lu.solve(b)), "{n}");
            assert!(near(a.transpose().to_owned(), &transposed(Conj::No)), "{n} transposed");
            assert!(near(a.adjoint().to_owned(), &transposed(Conj::Yes)), "{n} adjoint");
        }
    }

    #[test]
    fn inverse_and_phase_are_those_of_the_determinant() {
        let a = random(9, 3, 1e60);
        let (inverse, phase) = inverse_and_phase(a.clone()).unwrap();
        let identity = Mat::from_fn(9, 9, |i, j| c64::new(f64::from(i == j), 0.0));
        assert!(within((&a * &inverse - identity).norm_max(), 1e-10, RoundOff));
        let small = a * faer::Scale(c64::new(1e-60, 0.0));
        let det = small.determinant();
        assert!(within((phase - det / det.norm()).norm(), 1e-12, RoundOff), "{phase} {det}");
        assert!(inverse_and_phase(Mat::zeros(2, 2)).is_none());
        assert_eq!(inverse_and_phase(Mat::zeros(0, 0)).unwrap().1, c64::new(1.0, 0.0));
    }
}
