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
        Arch::new().dispatch(Pivots { fronts: self.fronts, x });
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
            Arch::new().dispatch(Step::<T, L, true> {
                tree: self,
                s,
                base,
                x: &mut *x,
                stack: &mut stack,
                v: &mut v,
            });
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
            Arch::new().dispatch(Step::<T, L, false> {
                tree: self,
                s,
                base,
                x: &mut *x,
                stack: &mut stack,
                v: &mut v,
            });
        }
        let parts = task.subtasks.iter().zip(parts(task, x, |s| self.first(s)));
        let parts: Vec<_> = parts.zip(waiting.into_iter().rev()).collect();
        parts.into_par_iter().for_each(|((task, x), known)| self.backward(task, x, known));
    }
}

/// One node on the way up, or on the way down.
struct Step<'a, T, L, const UP: bool> {
    tree: &'a Substitution<'a, T>,
    s: usize,
    /// The column that `x` begins with.
    base: usize,
    x: &'a mut [L],
    stack: &'a mut Vec<L>,
    /// Memory for the rows of the front.
    v: &'a mut Vec<L>,
}

impl<T: Field, L: Lanes<T>, const UP: bool> WithSimd for Step<'_, T, L, UP> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        if UP { self.rise() } else { self.descend::<S>() }
    }
}

impl<T: Field, L: Lanes<T>, const UP: bool> Step<'_, T, L, UP> {
    /// What the children passed on is taken from the stack, what the node passes on is put there.
    #[inline(always)]
    fn rise(self) {
        let Step { tree, s, base, x, stack, v } = self;
        let (front, node) = (&tree.fronts[s], &tree.plan.nodes[s]);
        v.clear();
        v.extend(front.columns.iter().map(|column| {
            let column = *column as usize;
            // A column that a child passed on arrives with the child's sums.
            if node.columns.contains(&column) { x[column - base] } else { L::ZERO }
        }));
        v.resize(front.rows, L::ZERO);
        let arrived: usize = node.children.iter().map(|c| tree.fronts[*c].above.len()).sum();
        let start = stack.len() - arrived;
        let mut sums = stack[start..].iter();
        for child in &node.children {
            for (row, sum) in tree.fronts[*child].above.iter().zip(&mut sums) {
                v[*row as usize].add(sum);
            }
        }
        stack.truncate(start);
        // Most of the tree sees nothing of a right-hand side with few entries.
        if v.iter().any(|row| (0..L::COLUMNS).any(|k| row.get(k) != T::default())) {
            front.lower.up(v);
        }
        front.columns[..front.width()].iter().zip(&*v).for_each(|(c, y)| x[*c as usize - base] = *y);
        stack.extend_from_slice(&v[front.width()..]);
    }

    /// The solution of the rows that the node passed on is taken from the stack, that of the rows of its children is put
    /// there.
    #[inline(always)]
    fn descend<S: Simd>(self) {
        let Step { tree, s, base, x, stack, v } = self;
        let front = &tree.fronts[s];
        let columns = &front.columns[..front.width()];
        let known = stack.len() - front.above.len();
        v.clear();
        v.extend(columns.iter().map(|column| x[*column as usize - base]));
        v.extend_from_slice(&stack[known..]);
        stack.truncate(known);
        front.apply_pivots(v);
        front.lower.down::<S, L>(v);
        columns.iter().zip(&*v).for_each(|(c, y)| x[*c as usize - base] = *y);
        for child in &tree.plan.nodes[s].children {
            stack.extend(tree.fronts[*child].above.iter().map(|row| v[*row as usize]));
        }
    }
}

/// v ← B⁻¹ v, front by front.
struct Pivots<'a, T, L> {
    fronts: &'a [Front<T>],
    x: &'a mut [L],
}

impl<T: Field, L: Lanes<T>> WithSimd for Pivots<'_, T, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut v = Vec::new();
        for front in self.fronts {
            let columns = &front.columns[..front.width()];
            v.clear();
            v.extend(columns.iter().map(|c| self.x[*c as usize]));
            front.apply_pivots(&mut v);
            columns.iter().zip(&v).for_each(|(c, y)| self.x[*c as usize] = *y);
        }
    }
}

impl<T: Field> Front<T> {
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
