//! Small problems, solved densely and certified by the same counts.

use super::super::SparseMatrix;
use super::super::dense::definite_pencil;
use super::super::sparse::diagonal;
use super::{CLUSTER, Eigenpairs, Found, Pencil, SturmCount, Wanted, gap, orthonormalise};
use faer::{Mat, MatRef};
use stridor_base::error::Result;

/// Problems up to this size are solved densely.
const DENSE: usize = 300;
/// Up to this size those are that an iteration does not find, as where most eigenvalues are equal, or none is positive.
const STILL_DENSE: usize = 1000;
/// How many times farther away a shift is tried where one is on rounding.
const FARTHER: [f64; 4] = [1e3, 1e6, 1e9, 1e12];

impl Pencil<'_> {
    /// The wanted pairs: densely where there are few rows, or where there are not many and an iteration does not find them.
    pub(super) fn solve(
        &self,
        wanted: Wanted,
        iterated: impl FnOnce() -> Result<Eigenpairs>,
    ) -> Result<Eigenpairs> {
        match self.k.ncols() {
            n if n <= DENSE => self.solve_densely(wanted),
            n if n <= STILL_DENSE => iterated().or_else(|_| self.solve_densely(wanted)),
            _ => iterated(),
        }
    }

    /// All finite eigenpairs densely, of which the wanted ones are kept.
    fn solve_densely(&self, wanted: Wanted) -> Result<Eigenpairs> {
        let all = match wanted {
            // Below a bound far above all eigenvalues rounding at the shift would be large beside K.
            Wanted::Below(bound) => self.dense_pairs(-0.01 * bound.min(self.largest_scale()))?,
            Wanted::Count(count) => {
                let mut first = self.dense_pairs(-1e-4 * self.local_scale())?;
                // Eigenvalues far above the shift look as if they had no mass.
                if first.values.len() < count.min(self.k.ncols())
                    && let Ok(far) = self.dense_pairs(-1e-4 * self.largest_scale())
                    && far.values.len() > first.values.len()
                {
                    first = far;
                }
                let highest = first.values.iter().take(count).fold(0.0f64, |most, v| most.max(v.abs()));
                let better = (highest > self.rigid_below()).then(|| self.dense_pairs(-0.01 * highest));
                match better {
                    Some(Ok(better)) if better.values.len() >= first.values.len() => better,
                    _ => first,
                }
            }
        };
        let Found { values, vectors, shift, factor } = all;
        let size = |v: f64| v.abs().max((v - shift).abs());
        let (cut, bound, shifts) = match wanted {
            Wanted::Below(bound) => {
                let first_above = values.partition_point(|v| *v < bound);
                let beyond = 2.0 * bound.max(values.last().copied().unwrap_or(bound));
                let (bound, shifts) = gap(&values, first_above, bound, beyond);
                (values.partition_point(|v| *v < bound), bound, shifts)
            }
            Wanted::Count(count) => {
                let least = |v: f64| (CLUSTER * size(v)).max(self.rigid_below());
                let cut = (count.min(values.len())..values.len())
                    .find(|c| *c > 0 && values[*c] - values[*c - 1] > least(values[*c]))
                    .unwrap_or(values.len());
                let low = if cut > 0 { values[cut - 1] } else { 0.0 };
                let high = values.get(cut).copied().unwrap_or(low + 0.2 * size(low));
                let shifts = [low + 0.3 * (high - low), low + 0.7 * (high - low)];
                (cut, 0.5 * (low + high), shifts)
            }
        };
        let counted = self.count_at(shifts)?;
        let mut found = Found { values, vectors, shift, factor };
        found.truncate(cut);
        orthonormalise(self.m, &mut found.vectors)?;
        self.certify(found, SturmCount { bound, shifts, counted })
    }

    /// [`Pencil::dense_pairs_at`] `shift`, or, where K − σM is singular to the rounding of a K that is far stiffer elsewhere, at one
    /// farther away.
    fn dense_pairs(&self, shift: f64) -> Result<Found> {
        FARTHER.iter().fold(self.dense_pairs_at(shift), |found, factor| {
            found.or_else(|error| self.dense_pairs_at(factor * shift).map_err(|_| error))
        })
    }

    /// All finite eigenpairs by M y = ν (K − σM) y with σ below them all, where K − σM is positive definite; σ is the
    /// given one or lower. A distance of a hundredth of the highest wanted θ serves both ends of the range.
    fn dense_pairs_at(&self, shift: f64) -> Result<Found> {
        let n = self.k.ncols();
        let near = |shift: f64| self.factorize_near([1.0, 1.1, 1.2].map(|part| part * shift));
        let (mut shift, mut factor) = near(shift)?;
        let first = shift;
        for _ in 0..40 {
            if factor.inertia().negative == 0 {
                break;
            }
            (shift, factor) = near(4.0 * shift)?;
        }
        if shift < first {
            // The lowest θ may sit right above: keep a distance of the size of θ.
            (shift, factor) = near(2.0 * shift)?;
        }
        let definite = self.shifted(shift);
        let s: Vec<f64> = diagonal(&definite).iter().map(|d| 1.0 / d.abs().sqrt()).collect();
        let scaled = |a: &SparseMatrix| {
            let a = a.to_dense();
            Mat::from_fn(n, n, |i, j| s[i] * a[(i, j)] * s[j])
        };
        let (nu, y) = definite_pencil(scaled(self.m).as_ref(), scaled(&definite).as_ref())?;
        let largest = nu.last().copied().unwrap_or(0.0);
        let finite: Vec<usize> = (0..n).rev().filter(|k| nu[*k] > 1e-14 * n as f64 * largest).collect();
        let x = Mat::from_fn(n, finite.len(), |i, k| s[i] * y[(i, finite[k])] / nu[finite[k]].sqrt());
        let inverted: Vec<f64> = finite.iter().map(|k| shift + 1.0 / nu[*k]).collect();
        let values = self.sharpen(&inverted, x.as_ref(), shift, largest);
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        Ok(Found {
            vectors: Mat::from_fn(n, order.len(), |i, k| x[(i, order[k])]),
            values: order.iter().map(|k| values[*k]).collect(),
            shift,
            factor,
        })
    }

    /// Takes the Rayleigh quotient xᵀKx of an M-normal x where rounding hurts it less than σ + 1/ν.
    fn sharpen(&self, inverted: &[f64], x: MatRef<'_, f64>, shift: f64, largest: f64) -> Vec<f64> {
        let one = |(j, theta): (usize, &f64)| {
            let (mut xkx, mut xmx, mut size) = (0.0, 0.0, 0.0);
            for (a, sum) in [(self.k, &mut xkx), (self.m, &mut xmx)] {
                for c in 0..a.ncols() {
                    for (r, v) in a.row_idx_of_col(c).zip(a.val_of_col(c)) {
                        *sum += x[(r, j)] * v * x[(c, j)];
                        size += if std::ptr::eq(a, self.k) { (x[(r, j)] * v * x[(c, j)]).abs() } else { 0.0 };
                    }
                }
            }
            if size / xmx < (theta - shift).powi(2) * largest { xkx / xmx } else { *theta }
        };
        inverted.iter().enumerate().map(one).collect()
    }
}
