//! The numbers: fronts are assembled and eliminated along the tree, its tasks side by side.

use super::super::sparse::Index;
use super::field::Field;
use super::front::{Panel, subtract_product};
use super::lower::Lower;
use super::symbolic::{Plan, Task};
use faer::sparse::SparseColMatRef;
use faer::{MatMut, MatRef};
use rayon::prelude::*;
use std::ops::Range;

/// The columns of L that one front gave.
pub(super) struct Front<'a, T> {
    /// The rows, by their place in the order of elimination: first the columns that this front eliminated, in the order
    /// of its pivots, then those that it passed on, then the others, ascending. Rows beyond the columns of the task are
    /// numbered from n on, in the order in which the task hands them on.
    pub rows: &'a [u32],
    /// L, as many rows × as many columns as were eliminated.
    pub lower: Lower<'a, T>,
    /// B⁻¹: for each eliminated column its diagonal entry and the entry below it, nonzero where a 2 × 2 block begins.
    pub inverse: &'a [[T; 2]],
}

impl<T> Front<'_, T> {
    /// The columns that this front eliminated, by their place, in the order of its pivots.
    pub fn columns(&self) -> &[u32] {
        &self.rows[..self.inverse.len()]
    }
}

/// Factors of a task: its own fronts, and those of its subtasks.
///
/// The fronts stand one behind the other. Most are small: were each a piece of memory of its own, the processor would wait
/// at the beginning of each, in every substitution.
#[derive(Debug)]
pub(super) struct Branch<T> {
    /// The columns of the task, those of its subtasks included, by their place in the order of elimination.
    pub columns: Range<usize>,
    /// Where the rows, the entries of L and the columns of each front begin, and of a next one.
    starts: Vec<[usize; 3]>,
    rows: Vec<u32>,
    lower: Vec<T>,
    /// B⁻¹ of the fronts of the task itself.
    pub inverse: Vec<[T; 2]>,
    /// The rows that the task hands on, as the fronts of the task above name them.
    pub handed_on: Vec<u32>,
    pub subtasks: Vec<Branch<T>>,
}

impl<T: Field> Branch<T> {
    /// Without fronts, with memory for those that the pattern expects.
    fn new(plan: &Plan, task: &Task, kept: Kept) -> Self {
        let expected = |size: fn(usize, usize) -> usize| -> usize {
            let of = |s: usize| {
                let (width, below) = (plan.nodes[s].columns.len(), plan.nodes[s].rows.len());
                size(width + below, width)
            };
            if kept == Kept::All { task.own_nodes().map(of).sum() } else { 0 }
        };
        Branch {
            columns: plan.first_column(task.nodes.start)..plan.first_column(task.nodes.end),
            starts: vec![[0; 3]],
            rows: Vec::with_capacity(expected(|rows, _| rows)),
            lower: Vec::with_capacity(expected(Lower::<T>::size)),
            inverse: Vec::with_capacity(task.own_nodes().map(|s| plan.nodes[s].columns.len()).sum()),
            handed_on: Vec::new(),
            subtasks: Vec::new(),
        }
    }

    /// The fronts of the task itself, in the order of elimination.
    pub fn fronts(&self) -> impl DoubleEndedIterator<Item = Front<'_, T>> {
        self.starts.windows(2).map(|ends| {
            let [rows, lower, columns] = [0, 1, 2].map(|k| ends[0][k]..ends[1][k]);
            let lower = Lower::of(&self.lower[lower], rows.len(), columns.len());
            Front { rows: &self.rows[rows], lower, inverse: &self.inverse[columns] }
        })
    }

    /// This and all that is below.
    pub fn branches(&self) -> Vec<&Branch<T>> {
        std::iter::once(self).chain(self.subtasks.iter().flat_map(Branch::branches)).collect()
    }

    /// Of the task itself.
    pub fn memory_bytes(&self) -> usize {
        let names = size_of_val(&*self.rows) + size_of_val(&*self.handed_on);
        size_of_val(&*self.lower) + size_of_val(&*self.inverse) + names
    }

    /// Puts the first rows of L, as many as columns were eliminated, behind the others: `columns` by columns.
    fn push(&mut self, rows: &[u32], columns: &[T], inverse: &[[T; 2]]) {
        self.rows.extend_from_slice(rows);
        Lower::pack(columns, rows.len(), inverse.len(), &mut self.lower);
        self.inverse.extend_from_slice(inverse);
        self.starts.push([self.rows.len(), self.lower.len(), self.inverse.len()]);
    }
}

/// The place, in the order of elimination, of a column that has no pivot.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stuck(pub usize);

/// Schur complement of a front after its columns are eliminated: a lower triangle, added to the parent.
struct Remainder<T> {
    /// The rows, by their place in the order of elimination; the first `passed_on` are columns without a pivot.
    rows: Vec<u32>,
    passed_on: usize,
    /// rows × rows by columns.
    values: Vec<T>,
}

/// A matrix on its way through the tree.
struct Elimination<'a, T> {
    plan: &'a Plan,
    a: SparseColMatRef<'a, Index, T>,
    scaling: &'a [f64],
    kept: Kept,
}

/// Work arrays of a task, used by one front after the other.
struct Scratch<T> {
    /// Where a row stands in the present front, for the rows that it has.
    places: Vec<u32>,
    /// L, by columns.
    columns: Vec<T>,
    /// W = L B.
    product: Vec<T>,
}

/// Part of the factors that is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kept {
    All,
    /// B alone, which has the inertia.
    Pivots,
}

/// Factorises S A S.
pub(super) fn factorize<T: Field>(
    plan: &Plan,
    a: SparseColMatRef<'_, Index, T>,
    scaling: &[f64],
    kept: Kept,
) -> Result<Branch<T>, Stuck> {
    Elimination { plan, a, scaling, kept }.run(&plan.root).map(|(branch, _)| branch)
}

impl<T: Field> Elimination<'_, T> {
    /// Runs a task; gives its fronts and the remainders of its last one (none is left of a whole tree).
    fn run(&self, task: &Task) -> Result<(Branch<T>, Vec<Remainder<T>>), Stuck> {
        let results: Vec<_> = task.subtasks.par_iter().map(|task| self.run(task)).collect();
        let mut results = task.subtasks.iter().zip(results);
        let mut branch = Branch::new(self.plan, task, self.kept);
        let mut stack: Vec<Remainder<T>> = Vec::new();
        let mut scratch =
            Scratch { places: vec![0; self.plan.order.len()], columns: Vec::new(), product: Vec::new() };
        let mut ready = results.next();
        let mut s = task.nodes.start;
        while s < task.nodes.end {
            if let Some((subtask, result)) = ready.take_if(|(subtask, _)| subtask.nodes.start == s) {
                let (below, remainders) = result?;
                branch.subtasks.push(below);
                stack.extend(remainders);
                s = subtask.nodes.end;
                ready = results.next();
                continue;
            }
            let children = stack.split_off(stack.len() - self.plan.nodes[s].children.len());
            stack.push(self.front(s, &children, &mut scratch, &mut branch)?);
            s += 1;
        }
        self.name_rows(&mut branch, &mut scratch.places);
        Ok((branch, stack))
    }

    /// Names the rows of the fronts of a task as they are kept, and those that its last front hands on by their place.
    fn name_rows(&self, branch: &mut Branch<T>, names: &mut [u32]) {
        let end = branch.columns.end as u32;
        let last = branch.fronts().next_back();
        branch.handed_on =
            last.map_or(Vec::new(), |last| last.rows.iter().copied().filter(|row| *row >= end).collect());
        for (row, name) in branch.handed_on.iter().zip(self.plan.order.len() as u32..) {
            names[*row as usize] = name;
        }
        let below = branch.subtasks.iter_mut().flat_map(|subtask| &mut subtask.handed_on);
        let beyond = branch.rows.iter_mut().chain(below).filter(|row| **row >= end);
        beyond.for_each(|row| *row = names[*row as usize]);
    }

    /// Assembles node s from A and its children, eliminates it and puts it into the branch. `scratch.places` then holds where
    /// each of its rows stands.
    fn front(
        &self,
        s: usize,
        children: &[Remainder<T>],
        scratch: &mut Scratch<T>,
        branch: &mut Branch<T>,
    ) -> Result<Remainder<T>, Stuck> {
        let node = &self.plan.nodes[s];
        let names = |rows: &[usize]| rows.iter().map(|row| *row as u32).collect::<Vec<u32>>();
        let mut columns: Vec<u32> = node.columns.clone().map(|column| column as u32).collect();
        children.iter().for_each(|child| columns.extend(&child.rows[..child.passed_on]));
        let (width, below) = (columns.len(), names(&node.rows));
        let m = width + below.len();
        let Scratch { places, columns: lower, product } = scratch;
        columns.iter().chain(&below).enumerate().for_each(|(k, row)| places[*row as usize] = k as u32);

        lower.clear();
        lower.resize(m * width, T::default());
        for (k, column) in node.columns.clone().enumerate() {
            let j = self.plan.order[column];
            let entries = self.a.row_idx_of_col(j).zip(self.a.val_of_col(j));
            for (i, v) in entries {
                let row = self.plan.place[i];
                if row >= column {
                    lower[k * m + places[row] as usize] = *v * (self.scaling[i] * self.scaling[j]);
                }
            }
        }
        let mut rest = vec![T::default(); below.len() * below.len()];
        for child in children {
            child.add_to(places, lower, &mut rest, m, width);
        }

        if product.len() < lower.len() {
            product.resize(lower.len(), T::default());
        }
        let before = columns.clone();
        let inverse = Vec::with_capacity(width);
        let mut panel = Panel { values: lower, product, names: &mut columns, rows: m, inverse };
        panel.eliminate();
        let inverse = panel.inverse;
        let done = inverse.len();
        if done < width && below.is_empty() {
            return Err(Stuck(columns[done] as usize));
        }
        if columns != before {
            columns.iter().enumerate().for_each(|(k, row)| places[*row as usize] = k as u32);
        }
        if !below.is_empty() {
            let part = |values| MatRef::from_column_major_slice(values, m, done).subrows(width, m - width);
            let c = MatMut::from_column_major_slice_mut(&mut rest, m - width, m - width);
            subtract_product(c, part(&lower[..m * done]), part(&product[..m * done]));
        }
        let passed_on = width - done;
        let remainder = Remainder {
            rows: columns[done..].iter().chain(&below).copied().collect(),
            passed_on,
            values: if passed_on == 0 { rest } else { joined(lower, &rest, m, width, done) },
        };
        match self.kept {
            Kept::All => {
                columns.extend(below);
                branch.push(&columns, lower, &inverse);
            }
            Kept::Pivots => branch.inverse.extend(inverse),
        }
        Ok(remainder)
    }
}

/// The remainder of a front that passes columns on: those columns, then the rest.
fn joined<T: Field>(lower: &[T], rest: &[T], m: usize, width: usize, done: usize) -> Vec<T> {
    let (size, below) = (m - done, m - width);
    let mut values = Vec::with_capacity(size * size);
    for column in done..width {
        values.extend_from_slice(&lower[column * m + done..(column + 1) * m]);
    }
    for column in 0..below {
        values.resize(values.len() + width - done, T::default());
        values.extend_from_slice(&rest[column * below..(column + 1) * below]);
    }
    values
}

impl<T: Field> Remainder<T> {
    /// Adds this to the front of the parent, whose rows stand at `places`.
    fn add_to(&self, places: &[u32], lower: &mut [T], rest: &mut [T], m: usize, width: usize) {
        let size = self.rows.len();
        let at: Vec<usize> = self.rows.iter().map(|row| places[*row as usize] as usize).collect();
        for j in 0..size {
            let source = &self.values[j * size + j..(j + 1) * size];
            if j < self.passed_on {
                // A column that was passed on stands behind the parent's own, so its entries may change sides.
                for (i, v) in at[j..].iter().zip(source) {
                    let (row, column) = (at[j].max(*i), at[j].min(*i));
                    lower[column * m + row] += *v;
                }
            } else if at[j] < width {
                let target = &mut lower[at[j] * m..(at[j] + 1) * m];
                for (i, v) in at[j..].iter().zip(source) {
                    target[*i] += *v;
                }
            } else {
                let below = m - width;
                let column = at[j] - width;
                let target = &mut rest[column * below..(column + 1) * below];
                for (i, v) in at[j..].iter().zip(source) {
                    target[*i - width] += *v;
                }
            }
        }
    }
}
