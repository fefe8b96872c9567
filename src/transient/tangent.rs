//! The tangent of the condensed step.

use super::model::TransientModel;
use super::reaction::Reaction;
use crate::linalg::lu::Lu;
use faer::{Mat, MatMut, MatRef};

/// J = I − ∂R/∂r + b (∂R/∂q + c₁ ∂R/∂q̇) S, whose rows differ from those of I only where something acts: those are solved
/// for, the others are what they are. Its memory serves every step.
#[derive(Debug)]
pub(super) struct Tangent {
    /// Where something acts.
    active: Vec<usize>,
    /// The rows of J − I there, one after the other.
    rows: Vec<f64>,
    /// The active part of J.
    small: SmallLu,
    /// The solution there.
    some: Vec<f64>,
}

impl Tangent {
    pub(super) fn new() -> Self {
        let small = SmallLu { lu: Vec::new(), pivots: Vec::new(), large: None };
        Tangent { active: Vec::new(), rows: Vec::new(), small, some: Vec::new() }
    }

    /// J at the place where the reaction was evaluated last.
    pub(super) fn set(
        &mut self,
        model: &TransientModel<'_>,
        reaction: &Reaction,
        compliance: &Mat<f64>,
        (share, rate): (f64, f64),
    ) {
        let r = compliance.nrows();
        self.active.clear();
        self.rows.clear();
        let (active, rows) = (&mut self.active, &mut self.rows);
        reaction.rows(model, rate, &mut |row| {
            active.push(row.place);
            let first = rows.len();
            rows.resize(first + r, 0.0);
            for (column, slope) in row.slopes.iter().filter(|(_, slope)| *slope != 0.0) {
                // S is symmetric.
                let seen = compliance.col_as_slice(*column).iter();
                rows[first..].iter_mut().zip(seen).for_each(|(out, s)| *out += share * slope * s);
            }
            row.held.iter().for_each(|(column, held)| rows[first + column] -= held);
        });
        let own = |i: usize, place: usize| self.rows[i * r + place];
        self.small
            .factorise(self.active.len(), |i, j| own(i, self.active[j]) + if i == j { 1.0 } else { 0.0 });
    }

    /// J⁻¹ρ.
    pub(super) fn solve(&mut self, rho: &[f64], step: &mut [f64]) {
        step.copy_from_slice(rho);
        self.active.iter().for_each(|place| step[*place] = 0.0);
        self.some.clear();
        for (place, row) in self.active.iter().zip(self.rows.chunks(rho.len().max(1))) {
            let known: f64 = row.iter().zip(&*step).map(|(j, x)| j * x).sum();
            self.some.push(rho[*place] - known);
        }
        self.small.solve(&mut self.some);
        self.active.iter().zip(&self.some).for_each(|(place, value)| step[*place] = *value);
    }
}

/// L U of a matrix of the size of a contact, with partial pivoting.
#[derive(Debug)]
struct SmallLu {
    /// L and U by columns.
    lu: Vec<f64>,
    /// The row that was exchanged with row k.
    pivots: Vec<usize>,
    /// The factors of a matrix for which a library is faster.
    large: Option<Lu<f64>>,
}

/// Up to here elimination in place takes less time than a library's preparations.
const FEW: usize = 32;

impl SmallLu {
    fn factorise(&mut self, n: usize, entry: impl Fn(usize, usize) -> f64) {
        self.lu.clear();
        self.lu.extend((0..n).flat_map(|j| (0..n).map(move |i| (i, j))).map(|(i, j)| entry(i, j)));
        self.large = (n > FEW).then(|| Lu::new(MatRef::from_column_major_slice(&self.lu, n, n).to_owned()));
        if self.large.is_some() {
            return;
        }
        self.pivots.clear();
        let a = &mut self.lu;
        for k in 0..n {
            let larger = |p: usize, i: usize| if a[k * n + i].abs() > a[k * n + p].abs() { i } else { p };
            let pivot = (k + 1..n).fold(k, larger);
            self.pivots.push(pivot);
            if pivot != k {
                (0..n).for_each(|j| a.swap(j * n + k, j * n + pivot));
            }
            let inverse = 1.0 / a[k * n + k];
            a[k * n + k + 1..(k + 1) * n].iter_mut().for_each(|l| *l *= inverse);
            let (done, rest) = a.split_at_mut((k + 1) * n);
            let l = &done[k * n + k + 1..];
            for column in rest.chunks_mut(n) {
                let u = column[k];
                column[k + 1..].iter_mut().zip(l).for_each(|(x, l)| *x -= l * u);
            }
        }
    }

    fn solve(&self, x: &mut [f64]) {
        let n = x.len();
        if let Some(large) = &self.large {
            large.solve_in_place(MatMut::from_column_major_slice_mut(x, n, 1));
            return;
        }
        self.pivots.iter().enumerate().for_each(|(k, pivot)| x.swap(k, *pivot));
        for k in 0..n {
            let y = x[k];
            x[k + 1..].iter_mut().zip(&self.lu[k * n + k + 1..(k + 1) * n]).for_each(|(x, l)| *x -= l * y);
        }
        for k in (0..n).rev() {
            x[k] /= self.lu[k * n + k];
            let y = x[k];
            x[..k].iter_mut().zip(&self.lu[k * n..k * n + k]).for_each(|(x, u)| *x -= u * y);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn elimination_in_place_and_the_library_solve_the_same_equations() {
        for n in [1, 2, 3, 7, FEW, FEW + 1] {
            // A matrix that needs its rows exchanged.
            let entry = |i: usize, j: usize| {
                ((3 * i + 5 * j * j + i * j) % 11) as f64 - if i == j { 0.0 } else { 2.5 }
            };
            let mut small = SmallLu { lu: Vec::new(), pivots: Vec::new(), large: None };
            small.factorise(n, entry);
            assert_eq!(small.large.is_some(), n > FEW);
            let wanted: Vec<f64> = (0..n).map(|i| (i as f64 * 1.3).sin() + 1.0).collect();
            let mut x: Vec<f64> =
                (0..n).map(|i| wanted.iter().enumerate().map(|(j, w)| entry(i, j) * w).sum()).collect();
            small.solve(&mut x);
            let off = x.iter().zip(&wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(within(off, 1e-9, RoundOff), "{n}: {off:e}");
        }
    }
}
