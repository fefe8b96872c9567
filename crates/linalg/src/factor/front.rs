//! The elimination of one dense front: F = L B Lᵀ on its first columns, with pivots chosen for bounded growth.
//!
//! The candidates for pivots are the columns whose rows are complete. Bunch & Kaufman's rule (Math. Comp. 31 (1977)
//! 163) chooses between a 1 × 1 and a 2 × 2 block, but every bound is taken over the whole column, rows that may not
//! be pivots included: no entry of L exceeds 1/[`THRESHOLD`]. A column that has no such pivot yet is refused; its
//! turn comes again in the parent's front, where more rows are complete (Duff & Reid, ACM TOMS 9 (1983) 302).

use super::field::Field;
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::{Accum, MatMut, MatRef, Par};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// α of Bunch & Kaufman: (1 + √17)/8.
const ALPHA: f64 = 0.640_388_203_202_207_6;
/// The smallest pivot relative to its column.
const THRESHOLD: f64 = 0.01;
/// Smallest pivot that does not count as zero: its reciprocal is finite.
const SMALLEST: f64 = 1e-290;
/// Columns that are eliminated before the others are updated.
const BLOCK: usize = 32;
/// Columns of a dense update that one task works on; the split depends on nothing else.
const COLUMNS_A_TASK: usize = 128;

/// A front while it is eliminated: `rows` × `width` entries by columns, of which the lower triangle counts.
pub(super) struct Panel<'a, T> {
    /// First the assembled columns, then L without its unit diagonal.
    pub values: &'a mut [T],
    /// W = L B of the eliminated columns, as large as `values`.
    pub product: &'a mut [T],
    /// The global number of each of the `width` columns; follows the pivots.
    pub names: &'a mut [u32],
    /// The order of the front.
    pub rows: usize,
    /// B⁻¹: for each eliminated column its diagonal entry and the entry below it, nonzero where a 2 × 2 block begins.
    pub inverse: Vec<[T; 2]>,
}

/// Outcome of the pivot test of a column.
enum Pivot {
    /// The column at this place.
    Single(usize),
    /// The next column together with the one at this place.
    Double(usize),
    /// None that keeps L bounded.
    Refused,
}

impl<T: Field> Panel<'_, T> {
    /// Eliminates what can be eliminated and brings the other columns up to date.
    pub fn eliminate(&mut self) {
        let width = self.names.len();
        let (mut current, mut other) = (Vec::new(), Vec::new());
        // Columns from `end` on were refused since the last success.
        let mut end = width;
        let mut updated = 0;
        while self.done() < end {
            let pivot = self.choose(updated, end, &mut current, &mut other);
            match pivot {
                Pivot::Refused => {
                    end -= 1;
                    self.swap(self.done(), end, updated);
                }
                Pivot::Single(r) => {
                    let k = self.done();
                    self.swap(k, r, updated);
                    let column = if r == k { &mut current } else { &mut other };
                    column.swap(0, r - k);
                    self.single(column);
                    end = width;
                }
                Pivot::Double(r) => {
                    let k = self.done();
                    self.swap(k + 1, r, updated);
                    current.swap(1, r - k);
                    other.swap(1, r - k);
                    self.double(&current, &other);
                    end = width;
                }
            }
            if self.done() >= updated + BLOCK || (self.done() >= end && self.done() > updated) {
                self.update(updated);
                updated = self.done();
            }
        }
    }

    /// How many columns are eliminated.
    pub fn done(&self) -> usize {
        self.inverse.len()
    }

    /// Chooses the next pivot; `current` receives the next column, `other` the one it is compared with.
    fn choose(&self, updated: usize, end: usize, current: &mut Vec<T>, other: &mut Vec<T>) -> Pivot {
        let (k, width) = (self.done(), self.names.len());
        self.column(k, updated, current);
        let (own, inside, beyond) =
            (current[0].size(), largest(&current[1..width - k]), largest(&current[width - k..]));
        let bound = inside.max(beyond);
        if !(own.is_finite() && bound.is_finite()) || own.max(inside) < SMALLEST {
            return Pivot::Refused;
        }
        if own >= (ALPHA * bound).max(SMALLEST) {
            return Pivot::Single(k);
        }
        // The partner: the largest entry below, among the columns that are still candidates if there is one.
        let among = &current[1..end - k];
        let size = largest(among);
        if size >= SMALLEST {
            let r = k + 1 + among.iter().position(|v| v.size() == size).unwrap_or(0);
            self.column(r, updated, other);
            let theirs = other[r - k].size();
            let at = std::mem::take(&mut other[r - k]);
            let their_bound = largest(other);
            let coupling = std::mem::take(&mut other[0]);
            let their_rest = largest(other);
            (other[0], other[r - k]) = (coupling, at);
            if own * their_bound >= ALPHA * bound * bound && own >= (THRESHOLD * bound).max(SMALLEST) {
                return Pivot::Single(k);
            }
            if theirs >= (ALPHA * their_bound).max(SMALLEST) {
                return Pivot::Single(r);
            }
            let mut rest = 0.0;
            for (i, v) in current.iter().enumerate().skip(1) {
                if i != r - k && v.size() > rest {
                    rest = v.size();
                }
            }
            // |B⁻¹| times the largest entries of its two columns elsewhere bounds those of L.
            let determinant = (current[0] * at - coupling * coupling).size();
            let coupling = coupling.size();
            let worst = (theirs * rest + coupling * their_rest).max(coupling * rest + own * their_rest);
            if determinant >= SMALLEST && determinant.is_finite() && worst * THRESHOLD <= determinant {
                return Pivot::Double(r);
            }
            if theirs >= (THRESHOLD * their_bound).max(SMALLEST) {
                return Pivot::Single(r);
            }
        }
        if own >= (THRESHOLD * bound).max(SMALLEST) { Pivot::Single(k) } else { Pivot::Refused }
    }

    /// Column j of what is left, from the next pivot's row on, with the eliminations since `updated` applied.
    fn column(&self, j: usize, updated: usize, column: &mut Vec<T>) {
        let (k, m) = (self.done(), self.rows);
        column.clear();
        column.extend((k..j).map(|i| self.values[j + i * m]));
        column.extend_from_slice(&self.values[j * m + j..(j + 1) * m]);
        let at = |q: usize| (&self.values[q * m + k..(q + 1) * m], self.product[q * m + j]);
        let mut q = updated;
        while q + 4 <= k {
            let terms: [(&[T], T); 4] = std::array::from_fn(|c| at(q + c));
            Arch::new().dispatch(Subtract { column, terms });
            q += 4;
        }
        for q in q..k {
            Arch::new().dispatch(Subtract { column, terms: [at(q)] });
        }
    }

    /// Exchanges columns and rows a ≤ b of what is left, and their rows in L and W.
    fn swap(&mut self, a: usize, b: usize, updated: usize) {
        if a == b {
            return;
        }
        let (k, m) = (self.done(), self.rows);
        self.names.swap(a, b);
        let values = &mut *self.values;
        for q in 0..k {
            values.swap(q * m + a, q * m + b);
        }
        for q in updated..k {
            self.product.swap(q * m + a, q * m + b);
        }
        // Products of columns before `updated` are needed below the panel only, where nothing moves.
        for q in k..a {
            values.swap(q * m + a, q * m + b);
        }
        values.swap(a * m + a, b * m + b);
        for i in a + 1..b {
            values.swap(a * m + i, i * m + b);
        }
        for i in b + 1..m {
            values.swap(a * m + i, b * m + i);
        }
    }

    /// A 1 × 1 pivot with its column.
    fn single(&mut self, column: &[T]) {
        let (k, m) = (self.done(), self.rows);
        self.product[k * m + k..(k + 1) * m].copy_from_slice(column);
        let inverse = one::<T>() / column[0];
        for (l, v) in self.values[k * m + k + 1..(k + 1) * m].iter_mut().zip(&column[1..]) {
            *l = *v * inverse;
        }
        self.inverse.push([inverse, T::default()]);
    }

    /// A 2 × 2 pivot with its columns.
    fn double(&mut self, first: &[T], second: &[T]) {
        let (k, m) = (self.done(), self.rows);
        let (a, b, d) = (first[0], first[1], second[1]);
        let determinant = a * d - b * b;
        let (a, b, d) = (d / determinant, -b / determinant, a / determinant);
        self.product[k * m + k..(k + 1) * m].copy_from_slice(first);
        self.product[(k + 1) * m + k..(k + 2) * m].copy_from_slice(second);
        self.values[k * m + k + 1] = T::default();
        for i in 2..m - k {
            self.values[k * m + k + i] = a * first[i] + b * second[i];
            self.values[(k + 1) * m + k + i] = b * first[i] + d * second[i];
        }
        self.inverse.push([a, b]);
        self.inverse.push([d, T::default()]);
    }

    /// Subtracts the products of the columns eliminated since `updated` from the columns that are not.
    fn update(&mut self, updated: usize) {
        let (k, m, width) = (self.done(), self.rows, self.names.len());
        if k == width {
            return;
        }
        let (l, rest) = self.values.split_at_mut(k * m);
        let l = MatRef::from_column_major_slice(l, m, k).subcols(updated, k - updated);
        let w = MatRef::from_column_major_slice(&self.product[..k * m], m, k).subcols(updated, k - updated);
        let rest = MatMut::from_column_major_slice_mut(rest, m, width - k).subrows_mut(k, m - k);
        subtract_product(rest, l.subrows(k, m - k), w.subrows(k, width - k));
    }
}

/// C −= L Wᵀ on and below the diagonal of C (rows × columns, at least as many rows as columns).
pub(super) fn subtract_product<T: Field>(c: MatMut<'_, T>, l: MatRef<'_, T>, w: MatRef<'_, T>) {
    let rows = c.nrows();
    let task = |(task, c): (usize, MatMut<'_, T>)| {
        let (begin, columns) = (task * COLUMNS_A_TASK, c.ncols());
        let (l, w) = (l.subrows(begin, rows - begin), w.subrows(begin, columns).transpose());
        let (square, below) = c.subrows_mut(begin, rows - begin).split_at_row_mut(columns);
        triangular::matmul(
            square,
            BlockStructure::TriangularLower,
            Accum::Add,
            l.subrows(0, columns),
            BlockStructure::Rectangular,
            w,
            BlockStructure::Rectangular,
            -one::<T>(),
            Par::Seq,
        );
        matmul(below, Accum::Add, l.subrows(columns, rows - begin - columns), w, -one::<T>(), Par::Seq);
    };
    if c.ncols() <= COLUMNS_A_TASK {
        task((0, c));
    } else {
        c.par_col_chunks_mut(COLUMNS_A_TASK).enumerate().for_each(task);
    }
}

fn one<T: Field>() -> T {
    faer::traits::math_utils::one()
}

/// column −= Σ w l over the terms (l, w).
struct Subtract<'a, T, const Q: usize> {
    column: &'a mut [T],
    terms: [(&'a [T], T); Q],
}

impl<T: Field, const Q: usize> WithSimd for Subtract<'_, T, Q> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let column = self.column;
        let terms = self.terms.map(|(l, w)| (&l[..column.len()], w));
        for i in 0..column.len() {
            let mut sum = column[i];
            for (l, w) in &terms {
                sum = sum.minus(l[i], *w);
            }
            column[i] = sum;
        }
    }
}

/// The largest size of an entry.
fn largest<T: Field>(column: &[T]) -> f64 {
    Arch::new().dispatch(Largest(column))
}

struct Largest<'a, T>(&'a [T]);

impl<T: Field> WithSimd for Largest<'_, T> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        const PARTS: usize = 16;
        let mut parts = [0.0f64; PARTS];
        let whole = self.0.len() - self.0.len() % PARTS;
        for start in (0..whole).step_by(PARTS) {
            let chunk = &self.0[start..start + PARTS];
            for p in 0..PARTS {
                let size = chunk[p].size();
                parts[p] = if size > parts[p] { size } else { parts[p] };
            }
        }
        let mut most = 0.0;
        for size in parts {
            most = if size > most { size } else { most };
        }
        for v in &self.0[whole..] {
            most = if v.size() > most { v.size() } else { most };
        }
        most
    }
}
