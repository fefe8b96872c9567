//! L of one front: where its entries stand, and the substitutions with it.
//!
//! A few columns at a time stand row by row, so that the way up and the way down both read memory from front to back: the
//! columns of most fronts are too short for the processor to fetch them ahead of their use.

use super::field::{Field, Lanes};
use pulp::Simd;

/// `rows` × `width`, unit lower trapezoidal. Above the diagonal stands what has no meaning.
pub(super) struct Lower<'a, T> {
    rows: usize,
    width: usize,
    /// Panel after panel, each from its own diagonal on, row by row.
    values: &'a [T],
}

/// The columns of a panel; of those that are left over, four make one, and then each its own.
const WIDE: usize = 8;
const NARROW: usize = 4;

/// First column and count of columns of every panel.
fn panels(width: usize) -> impl DoubleEndedIterator<Item = (usize, usize)> {
    let wide = width - width % WIDE;
    let narrow = width - width % NARROW;
    let part = |from: usize, to: usize, step: usize| (from..to).step_by(step).map(move |j| (j, step));
    part(0, wide, WIDE).chain(part(wide, narrow, NARROW)).chain(part(narrow, width, 1))
}

impl<'a, T: Field> Lower<'a, T> {
    /// How many values it is made of.
    pub(super) fn size(rows: usize, width: usize) -> usize {
        panels(width).map(|(first, count)| (rows - first) * count).sum()
    }

    /// The packed values that [`Lower::pack`] wrote.
    pub(super) fn of(values: &'a [T], rows: usize, width: usize) -> Self {
        Lower { rows, width, values }
    }

    /// Puts the first `width` columns of `columns`, each with `rows` entries, behind `values`.
    pub(super) fn pack(columns: &[T], rows: usize, width: usize, values: &mut Vec<T>) {
        let columns = |first: usize| &columns[first * rows..];
        for (first, count) in panels(width) {
            match count {
                WIDE => pack::<T, WIDE>(columns(first), rows, first, values),
                NARROW => pack::<T, NARROW>(columns(first), rows, first, values),
                _ => pack::<T, 1>(columns(first), rows, first, values),
            }
        }
    }

    /// v₁ ← L₁₁⁻¹ v₁, v₂ ← v₂ − L₂₁ v₁, with the registers of S, where row i of v stands at `names[i]` of `v`.
    #[inline(always)]
    pub(super) fn up<S: Simd, L: Lanes<T>>(&self, names: &[u32], v: &mut Rows<'_, L>) {
        let mut rest = self.values;
        for (first, count) in panels(self.width) {
            let (panel, after) = rest.split_at((self.rows - first) * count);
            let names = &names[first..];
            match count {
                WIDE => up::<S, T, L, WIDE>(panel, names, v),
                NARROW => up::<S, T, L, NARROW>(panel, names, v),
                _ => up::<S, T, L, 1>(panel, names, v),
            }
            rest = after;
        }
    }

    /// v₁ ← L₁₁⁻ᵀ (v₁ − L₂₁ᵀ v₂), likewise.
    #[inline(always)]
    pub(super) fn down<S: Simd, L: Lanes<T>>(&self, names: &[u32], v: &mut Rows<'_, L>) {
        let mut rest = self.values;
        for (first, count) in panels(self.width).rev() {
            let (before, panel) = rest.split_at(rest.len() - (self.rows - first) * count);
            let names = &names[first..];
            match count {
                WIDE if rows_in_registers::<S, L>() >= WIDE => down::<T, L, WIDE, WIDE>(panel, names, v),
                WIDE if rows_in_registers::<S, L>() >= NARROW => down::<T, L, WIDE, NARROW>(panel, names, v),
                WIDE => down::<T, L, WIDE, 2>(panel, names, v),
                NARROW if rows_in_registers::<S, L>() >= NARROW => {
                    down::<T, L, NARROW, NARROW>(panel, names, v);
                }
                NARROW => down::<T, L, NARROW, 2>(panel, names, v),
                _ => down::<T, L, 1, 1>(panel, names, v),
            }
            rest = before;
        }
    }
}

/// How many rows can be summed in registers while others are read. With sums in half of the registers, sixteen right-hand
/// sides take a quarter less time than with sums in all of them.
const fn rows_in_registers<S: Simd, L>() -> usize {
    (S::REGISTER_COUNT / 2) * size_of::<S::f64s>() / size_of::<L>()
}

/// Of C columns, each with `rows` entries, what stands from row `first` on, row by row.
fn pack<T: Field, const C: usize>(columns: &[T], rows: usize, first: usize, values: &mut Vec<T>) {
    let columns: [&[T]; C] = std::array::from_fn(|c| &columns[c * rows..][first..rows]);
    values.extend((0..rows - first).flat_map(|i| columns.map(|column| column[i])));
}

/// The rows of right-hand sides that the fronts of a task reach, by their names.
pub(super) struct Rows<'a, L> {
    /// Those of the columns of the task, named from `base` on.
    pub own: &'a mut [L],
    pub base: u32,
    /// Those that it hands on, named from `n` on.
    pub beyond: &'a mut [L],
    pub n: u32,
}

impl<L> Rows<'_, L> {
    /// One of them.
    pub fn at(&mut self, name: u32) -> &mut L {
        match name.checked_sub(self.n) {
            Some(k) => &mut self.beyond[k as usize],
            None => &mut self.own[(name - self.base) as usize],
        }
    }

    /// The same for a while.
    pub fn reborrow(&mut self) -> Rows<'_, L> {
        Rows { own: self.own, base: self.base, beyond: self.beyond, n: self.n }
    }
}

#[inline(always)]
fn up<S: Simd, T: Field, L: Lanes<T>, const C: usize>(l: &[T], names: &[u32], v: &mut Rows<'_, L>) {
    let (l, _) = l.as_chunks::<C>();
    let mut known: [L; C] = std::array::from_fn(|c| v.own[(names[c] - v.base) as usize]);
    // Most of the tree sees nothing of a right-hand side with few entries.
    if known.iter().all(|row| row.is_zero()) {
        return;
    }
    for r in 1..C {
        let mut own = known[r];
        for c in 0..r {
            own.subtract(l[r][c], &known[c]);
        }
        known[r] = own;
        v.own[(names[r] - v.base) as usize] = own;
    }
    let inside = names.partition_point(|name| *name < v.n);
    let own = (&l[C..inside], &names[C..inside], &mut *v.own, v.base);
    let beyond = (&l[inside..], &names[inside..], &mut *v.beyond, v.n);
    for (l, names, rows, base) in [own, beyond] {
        if rows_in_registers::<S, L>() >= 4 {
            subtract::<T, L, C, 4>(l, &known, names, rows, base);
        } else {
            subtract::<T, L, C, 2>(l, &known, names, rows, base);
        }
    }
}

/// v ← v − L y for rows named from `base` on, R rows at a time.
#[inline(always)]
fn subtract<T: Field, L: Lanes<T>, const C: usize, const R: usize>(
    l: &[[T; C]],
    y: &[L; C],
    names: &[u32],
    v: &mut [L],
    base: u32,
) {
    let ((groups, rest), (names, names_rest)) = (l.as_chunks::<R>(), names.as_chunks::<R>());
    for (l, names) in groups.iter().zip(names) {
        let at = names.map(|name| (name - base) as usize);
        let mut sums = at.map(|at| v[at]);
        for c in 0..C {
            for r in 0..R {
                sums[r].subtract(l[r][c], &y[c]);
            }
        }
        for r in 0..R {
            v[at[r]] = sums[r];
        }
    }
    for (l, name) in rest.iter().zip(names_rest) {
        let at = (name - base) as usize;
        let mut sum = v[at];
        for c in 0..C {
            sum.subtract(l[c], &y[c]);
        }
        v[at] = sum;
    }
}

/// C columns, P sums at a time.
#[inline(always)]
fn down<T: Field, L: Lanes<T>, const C: usize, const P: usize>(l: &[T], names: &[u32], v: &mut Rows<'_, L>) {
    let (l, _) = l.as_chunks::<C>();
    let mut own: [L; C] = std::array::from_fn(|c| v.own[(names[c] - v.base) as usize]);
    let inside = names.partition_point(|name| *name < v.n);
    for part in (0..C).step_by(P) {
        let mut sums: [L; P] = std::array::from_fn(|p| own[part + p]);
        for (name, l) in names[inside..].iter().zip(&l[inside..]).rev() {
            let known = &v.beyond[(name - v.n) as usize];
            for p in 0..P {
                sums[p].subtract(l[part + p], known);
            }
        }
        for (name, l) in names[C..inside].iter().zip(&l[C..inside]).rev() {
            let known = &v.own[(name - v.base) as usize];
            for p in 0..P {
                sums[p].subtract(l[part + p], known);
            }
        }
        own[part..part + P].copy_from_slice(&sums);
    }
    for c in (0..C).rev() {
        let mut sum = own[c];
        for r in c + 1..C {
            sum.subtract(l[r][c], &own[r]);
        }
        own[c] = sum;
        v.own[(names[c] - v.base) as usize] = sum;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn substitutions_equal_sums_over_columns() {
        // Panels of all three widths, and a front without rows below them.
        for (rows, width) in [(40, 29), (13, 13), (5, 1), (9, 0)] {
            let l = |i: usize, j: usize| if i > j { 0.1 * ((3 * i + 5 * j) as f64).sin() } else { 7.0 };
            let columns: Vec<f64> = (0..width * rows).map(|k| l(k % rows, k / rows)).collect();
            let mut values = vec![0.5];
            Lower::pack(&columns, rows, width, &mut values);
            assert_eq!(values.len(), 1 + Lower::<f64>::size(rows, width));
            let lower = Lower::of(&values[1..], rows, width);
            let start: Vec<[f64; 2]> = (0..rows).map(|i| [i as f64, (i as f64).cos()]).collect();
            // The last rows lie beyond the columns of the task, the others stand backwards in it.
            let (beyond, base, n) = ((rows - width).min(7), 100, 1000);
            let inside = rows - beyond;
            let names: Vec<u32> = (0..rows)
                .map(|i| if i < inside { base + inside - 1 - i } else { n + i - inside } as u32)
                .collect();
            let through = |step: &dyn Fn(&mut Rows<'_, [f64; 2]>)| {
                let mut own: Vec<[f64; 2]> = start[..inside].iter().rev().copied().collect();
                let mut beyond = start[inside..].to_vec();
                step(&mut Rows { own: &mut own, base: base as u32, beyond: &mut beyond, n: n as u32 });
                own.into_iter().rev().chain(beyond).collect::<Vec<_>>()
            };
            let up = through(&|v| lower.up::<pulp::Scalar, _>(&names, v));
            let down = through(&|v| lower.down::<pulp::Scalar, _>(&names, v));
            let (mut up_expected, mut down_expected) = (start.clone(), start);
            for j in 0..width {
                for i in j + 1..rows {
                    (0..2).for_each(|k| up_expected[i][k] -= l(i, j) * up_expected[j][k]);
                }
            }
            for j in (0..width).rev() {
                for i in j + 1..rows {
                    (0..2).for_each(|k| down_expected[j][k] -= l(i, j) * down_expected[i][k]);
                }
            }
            for (found, expected) in up.iter().chain(&down).zip(up_expected.iter().chain(&down_expected)) {
                (0..2).for_each(|k| {
                    assert!(within(
                        (found[k] - expected[k]).abs(),
                        1e-10 * expected[k].abs().max(1.0),
                        RoundOff
                    ))
                });
            }
        }
    }
}
