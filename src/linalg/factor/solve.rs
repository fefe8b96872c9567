//! Forward and backward substitution along the tree, its tasks side by side, up to sixteen right-hand sides at once.
//!
//! Upwards every front takes its rows of the right-hand side, adds what its children pass on, solves L y = b for its
//! columns and passes the rest on. Downwards it receives the solution of the rows it passed on and solves Lᵀ x = y.
//! The order of every sum is that of the tree.

use super::field::{Field, Lanes};
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
        let mut v = Vec::new();
        for front in self.fronts {
            let columns = &front.columns[..front.width()];
            v.clear();
            v.extend(columns.iter().map(|c| x[*c as usize]));
            front.apply_pivots(&mut v);
            columns.iter().zip(&v).for_each(|(c, y)| x[*c as usize] = *y);
        }
    }

    /// L⁻ᵀ B⁻¹ x.
    pub fn down<L: Lanes<T>>(&self, x: &mut [L]) {
        self.backward(&self.plan.root, x, Vec::new());
    }

    /// The first column of node s.
    fn first(&self, s: usize) -> usize {
        self.plan.nodes.get(s).map_or(self.plan.order.len(), |node| node.columns.start)
    }

    /// L y = b for the columns of a task; gives what its last front passes on.
    fn forward<L: Lanes<T>>(&self, task: &Task, x: &mut [L]) -> Vec<L> {
        let subtasks: Vec<_> = task.subtasks.iter().zip(parts(task, x, |s| self.first(s))).collect();
        let results: Vec<_> = subtasks.into_par_iter().map(|(task, x)| self.forward(task, x)).collect();
        let mut results = task.subtasks.iter().zip(results);
        let base = self.first(task.nodes.start);
        let (mut stack, mut v) = (Vec::new(), Vec::new());
        let mut ready = results.next();
        let mut s = task.nodes.start;
        while s < task.nodes.end {
            if let Some((subtask, passed_on)) = ready.take_if(|(subtask, _)| subtask.nodes.start == s) {
                stack.extend(passed_on);
                s = subtask.nodes.end;
                ready = results.next();
                continue;
            }
            let (front, node) = (&self.fronts[s], &self.plan.nodes[s]);
            v.clear();
            v.extend(front.columns.iter().map(|column| {
                let column = *column as usize;
                // A column that a child passed on arrives with the child's sums.
                if node.columns.contains(&column) { x[column - base] } else { L::ZERO }
            }));
            v.resize(front.rows, L::ZERO);
            let arrived: usize = node.children.iter().map(|c| self.fronts[*c].above.len()).sum();
            let start = stack.len() - arrived;
            let mut sums = stack[start..].iter();
            for child in &node.children {
                for (row, sum) in self.fronts[*child].above.iter().zip(&mut sums) {
                    v[*row as usize].add(sum);
                }
            }
            stack.truncate(start);
            // Most of the tree sees nothing of a right-hand side with few entries.
            if v.iter().any(|row| (0..L::COLUMNS).any(|k| row.get(k) != T::default())) {
                Arch::new().dispatch(Forward { front, v: &mut v });
            }
            front.columns[..front.width()].iter().zip(&v).for_each(|(c, y)| x[*c as usize - base] = *y);
            stack.extend_from_slice(&v[front.width()..]);
            s += 1;
        }
        stack
    }

    /// B Lᵀ x = y for the columns of a task; `known` is the solution of the rows that its last front passed on.
    fn backward<L: Lanes<T>>(&self, task: &Task, x: &mut [L], known: Vec<L>) {
        let base = self.first(task.nodes.start);
        let (mut stack, mut v) = (known, Vec::new());
        let mut waiting: Vec<Vec<L>> = Vec::new();
        let mut subtasks = task.subtasks.iter().rev().peekable();
        let mut s = task.nodes.end;
        while s > task.nodes.start {
            let front = &self.fronts[s - 1];
            let known = stack.len() - front.above.len();
            if let Some(subtask) = subtasks.next_if(|subtask| subtask.nodes.end == s) {
                waiting.push(stack.split_off(known));
                s = subtask.nodes.start;
                continue;
            }
            s -= 1;
            let columns = &front.columns[..front.width()];
            v.clear();
            v.extend(columns.iter().map(|column| x[*column as usize - base]));
            v.extend_from_slice(&stack[known..]);
            stack.truncate(known);
            Arch::new().dispatch(Backward { front, v: &mut v });
            columns.iter().zip(&v).for_each(|(c, y)| x[*c as usize - base] = *y);
            for child in &self.plan.nodes[s].children {
                stack.extend(self.fronts[*child].above.iter().map(|row| v[*row as usize]));
            }
        }
        let parts = task.subtasks.iter().zip(parts(task, x, |s| self.first(s)));
        let parts: Vec<_> = parts.zip(waiting.into_iter().rev()).collect();
        parts.into_par_iter().for_each(|((task, x), known)| self.backward(task, x, known));
    }
}

/// Columns of L that go through the rows together.
const TOGETHER: usize = 8;
/// The same on the way back, where each has a sum in a register.
const SUMS: usize = 4;

impl<T: Field> Front<T> {
    fn column(&self, j: usize) -> &[T] {
        &self.lower[j * self.rows..(j + 1) * self.rows]
    }

    /// v ← B⁻¹ v for the eliminated columns, which v begins with.
    #[inline(always)]
    fn apply_pivots<L: Lanes<T>>(&self, v: &mut [L]) {
        let mut j = 0;
        while j < self.width() {
            let [a, b] = self.inverse[j];
            let (x, mut first) = (v[j], L::ZERO);
            first.subtract(-a, &x);
            let double = b != T::default();
            if double {
                let (y, mut second) = (v[j + 1], L::ZERO);
                first.subtract(-b, &y);
                second.subtract(-b, &x);
                second.subtract(-self.inverse[j + 1][0], &y);
                v[j + 1] = second;
            }
            v[j] = first;
            j += 1 + usize::from(double);
        }
    }
}

/// v₁ ← L₁₁⁻¹ v₁, v₂ ← v₂ − L₂₁ v₁.
struct Forward<'a, T, L> {
    front: &'a Front<T>,
    v: &'a mut [L],
}

impl<T: Field, L: Lanes<T>> WithSimd for Forward<'_, T, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (front, v) = (self.front, self.v);
        let width = front.width();
        let mut j = 0;
        while j < width {
            let count = TOGETHER.min(width - j);
            for r in 1..count {
                let mut y = v[j + r];
                for c in 0..r {
                    y.subtract(front.column(j + c)[j + r], &v[j + c]);
                }
                v[j + r] = y;
            }
            let (y, below) = v[j..].split_at_mut(count);
            L::subtract_products(below, &front.lower[j * front.rows..], front.rows, j + count, y);
            j += count;
        }
    }
}

/// v₁ ← L₁₁⁻ᵀ (B⁻¹ v₁ − L₂₁ᵀ v₂).
struct Backward<'a, T, L> {
    front: &'a Front<T>,
    v: &'a mut [L],
}

impl<T: Field, L: Lanes<T>> WithSimd for Backward<'_, T, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (front, v) = (self.front, self.v);
        front.apply_pivots(v);
        let mut j = front.width();
        while j >= SUMS {
            j -= SUMS;
            let l: [&[T]; SUMS] = std::array::from_fn(|c| front.column(j + c));
            let (head, below) = v.split_at_mut(j + SUMS);
            let mut y: [L; SUMS] = std::array::from_fn(|c| head[j + c]);
            L::subtract_dots(&mut y, l.map(|column| &column[j + SUMS..]), below);
            for c in (0..SUMS).rev() {
                for r in c + 1..SUMS {
                    let later = y[r];
                    y[c].subtract(l[c][j + r], &later);
                }
                head[j + c] = y[c];
            }
        }
        for j in (0..j).rev() {
            let (head, below) = v.split_at_mut(j + 1);
            let mut y = [head[j]];
            L::subtract_dots(&mut y, [&front.column(j)[j + 1..]], below);
            head[j] = y[0];
        }
    }
}
