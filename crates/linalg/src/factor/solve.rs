//! Forward and backward substitution along the tree, its tasks side by side, up to sixteen right-hand sides at once.
//!
//! Upwards every front solves L y = b for its columns and takes what they bring from the rows below them; downwards it takes
//! what it knows of those rows and solves Lᵀ x = y. Both happen in place, row by row, in the right-hand sides packed in the
//! order of elimination. What a task brings to rows beyond its own columns is kept apart and handed to the task above, so that
//! tasks may run side by side and the order of every sum is that of the tree.

use super::field::{Field, Lanes};
use super::lower::Rows;
use super::numeric::{Branch, Front};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::ops::Range;

/// Goes up and down the tree, with one row of x for each column in the order of elimination.
pub(super) struct Substitution<'a, T> {
    /// The whole tree.
    pub branch: &'a Branch<T>,
}

impl<T: Field> Substitution<'_, T> {
    /// L⁻¹ x.
    pub fn up<L: Lanes<T>>(&self, x: &mut [L]) {
        self.forward(self.branch, x);
    }

    /// B⁻¹ x.
    pub fn pivots<L: Lanes<T>>(&self, x: &mut [L]) {
        for branch in self.branch.branches() {
            Arch::new().dispatch(Pivots { fronts: branch.fronts(), x });
        }
    }

    /// L⁻ᵀ B⁻¹ x.
    pub fn down<L: Lanes<T>>(&self, x: &mut [L]) {
        self.backward(self.branch, x, Vec::new());
    }

    /// L y = b for the columns of a task; gives what it brings to the rows that it hands on.
    fn forward<L: Lanes<T>>(&self, branch: &Branch<T>, x: &mut [L]) -> Vec<L> {
        let subtasks = subtasks(branch, x).into_par_iter();
        let results: Vec<_> = subtasks.map(|(branch, x)| self.forward(branch, x)).collect();
        let mut beyond = vec![L::ZERO; branch.handed_on.len()];
        let mut rows = self.rows(branch, x, &mut beyond);
        for (subtask, sums) in branch.subtasks.iter().zip(&results) {
            for (row, sum) in subtask.handed_on.iter().zip(sums) {
                rows.at(*row).add(sum);
            }
        }
        Arch::new().dispatch(Walk::<_, _, true> { fronts: branch.fronts(), rows });
        beyond
    }

    /// B Lᵀ x = y for the columns of a task; `beyond` is the solution of the rows that it hands on.
    fn backward<L: Lanes<T>>(&self, branch: &Branch<T>, x: &mut [L], mut beyond: Vec<L>) {
        let mut rows = self.rows(branch, x, &mut beyond);
        Arch::new().dispatch(Walk::<_, _, false> { fronts: branch.fronts().rev(), rows: rows.reborrow() });
        let handed = |subtask: &Branch<T>| subtask.handed_on.iter().map(|row| *rows.at(*row)).collect();
        let known: Vec<Vec<L>> = branch.subtasks.iter().map(handed).collect();
        let subtasks = subtasks(branch, x).into_par_iter().zip(known);
        subtasks.for_each(|((branch, x), known)| self.backward(branch, x, known));
    }

    /// The rows that the fronts of a task reach.
    fn rows<'x, L>(&self, branch: &Branch<T>, x: &'x mut [L], beyond: &'x mut [L]) -> Rows<'x, L> {
        Rows { own: x, base: branch.columns.start as u32, beyond, n: self.branch.columns.end as u32 }
    }
}

/// Factors of the subtasks of a task, and the parts of x that belong to them.
fn subtasks<'x, T, L>(branch: &'x Branch<T>, x: &'x mut [L]) -> Vec<(&'x Branch<T>, &'x mut [L])> {
    let (mut rest, mut at) = (x, branch.columns.start);
    let part = |subtask: &'x Branch<T>| {
        let Range { start, end } = subtask.columns;
        let (part, after) = std::mem::take(&mut rest)[start - at..].split_at_mut(end - start);
        (rest, at) = (after, end);
        (subtask, part)
    };
    branch.subtasks.iter().map(part).collect()
}

/// Up or down through the fronts of a task.
struct Walk<'a, L, I, const UP: bool> {
    fronts: I,
    rows: Rows<'a, L>,
}

impl<'a, T: Field, L: Lanes<T>, I: Iterator<Item = Front<'a, T>>, const UP: bool> WithSimd
    for Walk<'_, L, I, UP>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        for front in self.fronts {
            if UP {
                front.lower.up::<S, L>(front.rows, &mut self.rows);
            } else {
                front.apply_pivots(self.rows.own, self.rows.base);
                front.lower.down::<S, L>(front.rows, &mut self.rows);
            }
        }
    }
}

/// x ← B⁻¹ x, front by front.
struct Pivots<'a, L, I> {
    fronts: I,
    x: &'a mut [L],
}

impl<'a, T: Field, L: Lanes<T>, I: Iterator<Item = Front<'a, T>>> WithSimd for Pivots<'_, L, I> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for front in self.fronts {
            front.apply_pivots(self.x, 0);
        }
    }
}

impl<T: Field> Front<'_, T> {
    /// x ← B⁻¹ x for the eliminated columns, where x begins with column `base`.
    #[inline(always)]
    fn apply_pivots<L: Lanes<T>>(&self, x: &mut [L], base: u32) {
        let (columns, mut j) = (self.columns(), 0);
        while j < columns.len() {
            let [a, b] = self.inverse[j];
            let at = (columns[j] - base) as usize;
            let (own, mut first) = (x[at], L::ZERO);
            first.subtract(-a, &own);
            let double = b != T::default();
            if double {
                let next = (columns[j + 1] - base) as usize;
                let (other, mut second) = (x[next], L::ZERO);
                first.subtract(-b, &other);
                second.subtract(-b, &own);
                second.subtract(-self.inverse[j + 1][0], &other);
                x[next] = second;
            }
            x[at] = first;
            j += 1 + usize::from(double);
        }
    }
}
