//! Forward and backward substitution along the tree, its tasks side by side, up to sixteen right-hand sides at once.
//!
//! Upwards every front solves L y = b for its columns and takes what they bring from the rows below them; downwards it takes
//! what it knows of those rows and solves Lᵀ x = y. Both happen in place, row by row, in the right-hand sides laid out in the
//! order of elimination. What a task brings to rows beyond its own columns is kept apart and handed to the task above, so that
//! tasks may run side by side and the order of every sum is that of the tree.

use super::field::{Field, Lanes};
use super::lower::Rows;
use super::numeric::{Front, parts};
use super::symbolic::{Plan, Task};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Goes up and down the tree, with one row of x for each column in the order of elimination.
pub(super) struct Substitution<'a, T> {
    pub plan: &'a Plan,
    pub fronts: &'a [Front<T>],
}

impl<T: Field> Substitution<'_, T> {
    /// L⁻¹ x.
    pub fn up<L: Lanes<T>>(&self, x: &mut [L]) {
        self.forward(&self.plan.root, x);
    }

    /// B⁻¹ x.
    pub fn pivots<L: Lanes<T>>(&self, x: &mut [L]) {
        Arch::new().dispatch(Pivots { fronts: self.fronts, x });
    }

    /// L⁻ᵀ B⁻¹ x.
    pub fn down<L: Lanes<T>>(&self, x: &mut [L]) {
        self.backward(&self.plan.root, x, Vec::new());
    }

    /// The parts of x that belong to the subtasks of a task.
    fn parts<'x, L>(&self, task: &Task, x: &'x mut [L]) -> Vec<&'x mut [L]> {
        parts(task, x, |s| self.plan.first_column(s))
    }

    /// The rows that a task hands on.
    fn handed_on(&self, task: &Task) -> &[u32] {
        self.fronts[task.nodes.clone()].last().map_or(&[], |front| &front.handed_on)
    }

    /// L y = b for the columns of a task; gives what it brings to the rows that it hands on.
    fn forward<L: Lanes<T>>(&self, task: &Task, x: &mut [L]) -> Vec<L> {
        let subtasks: Vec<_> = task.subtasks.iter().zip(self.parts(task, x)).collect();
        let results: Vec<_> = subtasks.into_par_iter().map(|(task, x)| self.forward(task, x)).collect();
        let mut beyond = vec![L::ZERO; self.handed_on(task).len()];
        let mut rows = self.rows(task, x, &mut beyond);
        for (subtask, sums) in task.subtasks.iter().zip(&results) {
            for (row, sum) in self.handed_on(subtask).iter().zip(sums) {
                rows.at(*row).add(sum);
            }
        }
        let nodes = task.own_nodes();
        Arch::new().dispatch(Walk::<T, L, _, true> { fronts: self.fronts, nodes, rows });
        beyond
    }

    /// B Lᵀ x = y for the columns of a task; `beyond` is the solution of the rows that it hands on.
    fn backward<L: Lanes<T>>(&self, task: &Task, x: &mut [L], mut beyond: Vec<L>) {
        let mut rows = self.rows(task, x, &mut beyond);
        let nodes = task.own_nodes().rev();
        Arch::new().dispatch(Walk::<T, L, _, false> { fronts: self.fronts, nodes, rows: rows.reborrow() });
        let handed = |subtask| self.handed_on(subtask).iter().map(|row| *rows.at(*row)).collect();
        let known: Vec<Vec<L>> = task.subtasks.iter().map(handed).collect();
        let parts: Vec<_> = task.subtasks.iter().zip(self.parts(task, x)).zip(known).collect();
        parts.into_par_iter().for_each(|((task, x), known)| self.backward(task, x, known));
    }

    /// The rows that the fronts of a task reach.
    fn rows<'x, L>(&self, task: &Task, x: &'x mut [L], beyond: &'x mut [L]) -> Rows<'x, L> {
        let (base, n) = (self.plan.first_column(task.nodes.start), self.plan.order.len());
        Rows { own: x, base: base as u32, beyond, n: n as u32 }
    }
}

/// Up or down through some nodes.
struct Walk<'a, T, L, I, const UP: bool> {
    fronts: &'a [Front<T>],
    nodes: I,
    rows: Rows<'a, L>,
}

impl<T: Field, L: Lanes<T>, I: Iterator<Item = usize>, const UP: bool> WithSimd for Walk<'_, T, L, I, UP> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        for s in self.nodes {
            let front = &self.fronts[s];
            if UP {
                front.lower.up(&front.rows, &mut self.rows);
            } else {
                front.apply_pivots(self.rows.own, self.rows.base);
                front.lower.down::<S, L>(&front.rows, &mut self.rows);
            }
        }
    }
}

/// x ← B⁻¹ x, front by front.
struct Pivots<'a, T, L> {
    fronts: &'a [Front<T>],
    x: &'a mut [L],
}

impl<T: Field, L: Lanes<T>> WithSimd for Pivots<'_, T, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for front in self.fronts {
            front.apply_pivots(self.x, 0);
        }
    }
}

impl<T: Field> Front<T> {
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
