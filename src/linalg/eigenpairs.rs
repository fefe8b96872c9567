//! The lowest eigenpairs of K x = θ M x, with the proof that none is missing.
//!
//! K is symmetric (singular and even indefinite are allowed), M symmetric positive semidefinite; what M does not see
//! has no finite eigenvalue and does not appear. By Sylvester's law the negative pivots of K − σM are the number of
//! eigenvalues below σ. That count is taken at the shift of the iteration, which tells Lanczos how many to find on
//! either side of it, and at two shifts that enclose the upper bound, which certify the result.

use super::SparseMatrix;
use super::dense::{definite_pencil, symmetric_eigen};
use super::factor::{SymbolicFactor, SymmetricFactor};
use super::lanczos::{BlockLanczos, Ritz, Window, combine, gram};
use super::sparse::{add_scaled, diagonal, multiply, norm_1};
use crate::error::{Error, Result};
use crate::progress::Observer;
use faer::{Accum, Mat, MatRef};

/// Which eigenpairs are wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wanted {
    /// All with θ below this positive bound.
    Below(f64),
    /// This many of the lowest; a cluster that would be cut is taken whole.
    Count(usize),
}

/// Eigenpairs with the measures of their error.
#[derive(Debug)]
pub struct Eigenpairs {
    /// θ, ascending.
    pub values: Vec<f64>,
    /// X with XᵀMX = I, one vector a column.
    pub vectors: Mat<f64>,
    /// ‖K x − θ M x‖ / ((‖K‖₁ + |θ| ‖M‖₁) ‖x‖), one a pair.
    pub backward_errors: Vec<f64>,
    /// The count that certifies them.
    pub sturm: SturmCount,
    /// The shift σ of the iteration.
    pub shift: f64,
    /// K − σM, factorised.
    pub factor: Box<dyn SymmetricFactor>,
}

/// How many eigenvalues lie below a bound, counted at two shifts that enclose it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SturmCount {
    /// The bound: the wanted one, moved up when an eigenvalue sits on it.
    pub bound: f64,
    /// Two shifts, one either side of the bound, with no eigenvalue between.
    pub shifts: [f64; 2],
    /// Negative pivots of K − shift · M.
    pub counted: [usize; 2],
}

/// Problems up to this size are solved densely.
const DENSE: usize = 300;
/// Half the distance of the two certifying shifts, relative to the bound.
const APART: f64 = 1e-5;
/// Eigenvalues nearer to each other than this, relative to their size, are one cluster.
const CLUSTER: f64 = 1e-7;

/// Finds the lowest eigenpairs of K x = θ M x, both symmetric n × n and stored whole.
///
/// `Wanted::Count` gives fewer when M has a lower rank, and a few more rather than cut a cluster.
///
/// # Errors
/// [`Error::Analysis`] when a pencil K − σM is singular for every σ (a degree of freedom with neither stiffness nor
/// mass), when Lanczos does not converge, or when the inertia counts eigenvalues that were not found.
///
/// # Panics
/// When the matrices are not square and of one size.
pub fn lowest_eigenpairs(
    k: &SparseMatrix,
    m: &SparseMatrix,
    wanted: Wanted,
    observer: &dyn Observer,
) -> Result<Eigenpairs> {
    let n = k.ncols();
    if n == 0 {
        return Err(Error::analysis(
            "eigenvalues",
            "there is no degree of freedom",
            "Free some of the supports",
        ));
    }
    assert!(k.nrows() == n && m.nrows() == n && m.ncols() == n, "K and M are of one size");
    match wanted {
        Wanted::Below(bound) if !(bound > 0.0 && bound.is_finite()) => {
            return Err(Error::analysis(
                "eigenvalues",
                format!("the bound is {bound}"),
                "Ask for those below a positive, finite bound",
            ));
        }
        Wanted::Count(0) => {
            return Err(Error::analysis("eigenvalues", "none was asked for", "Ask for at least one"));
        }
        _ => {}
    }
    let pencil = Pencil::new(k, m)?;
    observer.begin("eigenvalues", None);
    let result = if n <= DENSE {
        pencil.solve_densely(wanted)
    } else {
        match wanted {
            Wanted::Below(bound) => pencil.below(bound, observer),
            Wanted::Count(count) => pencil.count(count.min(n), observer),
        }
    };
    observer.end();
    result
}

/// ‖K x − θ M x‖₂ / ((‖K‖₁ + |θ| ‖M‖₁) ‖x‖₂) of each pair.
pub fn backward_errors(
    k: &SparseMatrix,
    m: &SparseMatrix,
    values: &[f64],
    vectors: MatRef<'_, f64>,
) -> Vec<f64> {
    let (k_norm, m_norm) = (norm_1(k), norm_1(m));
    let (mut kx, mut mx) = (Mat::zeros(k.ncols(), values.len()), Mat::zeros(k.ncols(), values.len()));
    multiply(k, vectors, kx.as_mut());
    multiply(m, vectors, mx.as_mut());
    let error = |(j, theta): (usize, &f64)| {
        let residual = (0..k.ncols()).map(|i| (kx[(i, j)] - theta * mx[(i, j)]).powi(2)).sum::<f64>().sqrt();
        residual / ((k_norm + theta.abs() * m_norm) * vectors.col(j).norm_l2()).max(f64::MIN_POSITIVE)
    };
    values.iter().enumerate().map(error).collect()
}

/// K − σM with the analysis of its pattern.
struct Pencil<'a> {
    k: &'a SparseMatrix,
    m: &'a SparseMatrix,
    symbolic: SymbolicFactor,
}

type Factor = Box<dyn SymmetricFactor>;

/// Pairs found at a shift.
struct Found {
    values: Vec<f64>,
    vectors: Mat<f64>,
    shift: f64,
    factor: Factor,
}

impl<'a> Pencil<'a> {
    fn new(k: &'a SparseMatrix, m: &'a SparseMatrix) -> Result<Self> {
        let union = add_scaled(&[(1.0, k), (1.0, m)]);
        Ok(Pencil { k, m, symbolic: SymbolicFactor::new(union.symbolic())? })
    }

    fn factorize(&self, shift: f64) -> Result<Factor> {
        self.symbolic.factorize(&add_scaled(&[(1.0, self.k), (-shift, self.m)]))
    }

    /// The factors at the first of `shifts` that does not sit on an eigenvalue.
    fn factorize_near(&self, shifts: [f64; 3]) -> Result<(f64, Factor)> {
        let mut refused = None;
        for shift in shifts {
            match self.factorize(shift) {
                Ok(factor) if factor.inertia().zero == 0 => return Ok((shift, factor)),
                Ok(_) => {}
                Err(error) => refused = Some(error),
            }
        }
        Err(refused.unwrap_or_else(|| {
            Error::analysis(
                "eigenvalues",
                format!("K − σM is singular to rounding for σ = {shifts:?}"),
                "A degree of freedom with neither stiffness nor mass does this",
            )
        }))
    }

    /// The number of eigenvalues below each of two shifts, factorised side by side.
    fn count_at(&self, shifts: [f64; 2]) -> Result<[usize; 2]> {
        // A shift that sits on an eigenvalue is nudged; the pair stays on its side of the bound.
        let nudge = 0.01 * (shifts[1] - shifts[0]);
        let at = |s: f64| self.factorize_near([s, s - nudge, s + nudge]).map(|(_, f)| f.inertia().negative);
        let (low, high) = rayon::join(|| at(shifts[0]), || at(shifts[1]));
        Ok([low?, high?])
    }

    fn below(&self, bound: f64, observer: &dyn Observer) -> Result<Eigenpairs> {
        let mut shifts = [bound * (1.0 - APART), bound * (1.0 + APART)];
        // In the middle the two ends of the wanted range are equally far.
        let middle = [0.5, 0.47, 0.53].map(|part| part * bound);
        let (counted, middle) = rayon::join(|| self.count_at(shifts), || self.factorize_near(middle));
        let (mut counted, (shift, factor)) = (counted?, middle?);
        let negative = factor.inertia().negative;
        let window = Window {
            negative,
            largest: counted[1].saturating_sub(negative),
            floor: 1.0 / (shifts[1] - shift),
        };
        let mut lanczos = BlockLanczos::new(self.m, &*factor, capacity(counted[1]));
        let ritz = lanczos.converge(window, observer)?.ok_or_else(|| missing(0, counted[1], shifts[1]))?;
        let (values, vectors) = lanczos.pairs(&ritz, window, shift);
        let mut found = Found { values, vectors, shift, factor };
        let mut bound = bound;
        if counted[0] != counted[1] {
            let first_above = found.values.partition_point(|v| *v < bound);
            (bound, shifts) = gap(&found.values, first_above, bound, shifts[1]);
            counted = self.count_at(shifts)?;
            found.truncate(found.values.partition_point(|v| *v < bound));
        }
        self.certify(found, SturmCount { bound, shifts, counted })
    }

    fn count(&self, count: usize, observer: &dyn Observer) -> Result<Eigenpairs> {
        let (shift, factor) = self.shift_for(count, observer)?;
        let negative = factor.inertia().negative;
        let mut lanczos = BlockLanczos::new(self.m, &*factor, capacity(count + 1));
        // One more than wanted shows the gap above them.
        let mut total = (count + 1).max(negative + 1);
        for _ in 0..20 {
            let window = Window { negative, largest: total - negative, floor: 0.0 };
            let ritz = lanczos.converge(window, observer)?;
            let all = ritz.is_none();
            let ritz = ritz.map_or_else(|| lanczos.ritz(), Ok)?;
            let window = if all { lanczos.everything(&ritz) } else { window };
            let mut values: Vec<f64> = ritz_values(&ritz, window, shift);
            values.sort_by(f64::total_cmp);
            let last = values[values.len() - 1];
            let cut = if values.len() <= count {
                values.len()
            } else {
                match (count..values.len())
                    .find(|c| values[*c] - values[*c - 1] > CLUSTER * (values[*c] - shift).abs())
                {
                    Some(cut) => cut,
                    None => {
                        total += 2;
                        continue;
                    }
                }
            };
            let (low, high) = match values.get(cut) {
                Some(next) => (values[cut - 1], *next),
                None => (last, last + 0.2 * last.abs().max((last - shift).abs())),
            };
            let shifts = [low + 0.3 * (high - low), low + 0.7 * (high - low)];
            let counted = self.count_at(shifts)?;
            if counted[0] > cut && !all {
                // Copies of a multiple eigenvalue that the block has not seen yet.
                total += counted[0] - cut;
                lanczos.look_again();
                continue;
            }
            let (values, vectors) = lanczos.pairs(&ritz, window, shift);
            let mut found = Found { values, vectors, shift, factor };
            found.truncate(cut);
            return self.certify(found, SturmCount { bound: 0.5 * (shifts[0] + shifts[1]), shifts, counted });
        }
        Err(missing(total, total + 1, shift))
    }

    /// A shift in the middle of the lowest `count` eigenvalues, from Ritz values of a short run at a small negative one.
    fn shift_for(&self, count: usize, observer: &dyn Observer) -> Result<(f64, Factor)> {
        let scale = self.local_scale();
        let guess = [1e-9, 1e-7, 1e-5].map(|part| -part * scale);
        let (mut shift, mut factor) = self.factorize_near(guess)?;
        for _ in 0..6 {
            let estimate = {
                let mut lanczos = BlockLanczos::new(self.m, &*factor, count + 40);
                let ritz = lanczos.explore(count + 32, observer)?;
                let mut values: Vec<f64> = ritz.values.iter().map(|v| shift + 1.0 / v).collect();
                values.sort_by(f64::total_cmp);
                values.get(count - 1).or(values.last()).copied().unwrap_or(scale)
            };
            if estimate <= 0.0 {
                return Ok((shift, factor));
            }
            (shift, factor) = self.factorize_near([0.5, 0.47, 0.53].map(|part| part * estimate))?;
            if factor.inertia().negative <= count + 8 {
                break;
            }
        }
        Ok((shift, factor))
    }

    /// The median of K_ii / M_ii: how fast single degrees of freedom would vibrate, far above the lowest eigenvalues.
    fn local_scale(&self) -> f64 {
        let (k, m) = (diagonal(self.k), diagonal(self.m));
        let mut ratios: Vec<f64> =
            k.iter().zip(m).filter(|(k, m)| **k > 0.0 && *m > 0.0).map(|(k, m)| k / m).collect();
        ratios.sort_by(f64::total_cmp);
        ratios.get(ratios.len() / 2).copied().unwrap_or(1.0)
    }

    fn solve_densely(&self, wanted: Wanted) -> Result<Eigenpairs> {
        let all = match wanted {
            Wanted::Below(bound) => self.dense_pairs(-0.01 * bound)?,
            Wanted::Count(count) => {
                let first = self.dense_pairs(-1e-4 * self.local_scale())?;
                let highest = first.values.get(count - 1).or(first.values.last()).copied().unwrap_or(0.0);
                if highest > 0.0 { self.dense_pairs(-0.01 * highest)? } else { first }
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
                let cut = (count.min(values.len())..values.len())
                    .find(|c| *c > 0 && values[*c] - values[*c - 1] > CLUSTER * size(values[*c]))
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
        self.certify(found, SturmCount { bound, shifts, counted })
    }

    /// All finite eigenpairs by M y = ν (K − σM) y with σ below them all, where K − σM is positive definite; σ is the
    /// given one or lower. A distance of a hundredth of the highest wanted θ serves both ends of the range.
    fn dense_pairs(&self, shift: f64) -> Result<Found> {
        let n = self.k.ncols();
        let near = |shift: f64| self.factorize_near([1.0, 1.1, 1.2].map(|part| part * shift));
        let (mut shift, mut factor) = near(shift)?;
        for _ in 0..40 {
            if factor.inertia().negative == 0 {
                break;
            }
            (shift, factor) = near(4.0 * shift)?;
        }
        let definite = add_scaled(&[(1.0, self.k), (-shift, self.m)]);
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
                    for (r, v) in a.row_idx_of_col_raw(c).iter().zip(a.val_of_col(c)) {
                        *sum += x[(*r, j)] * v * x[(c, j)];
                        size +=
                            if std::ptr::eq(a, self.k) { (x[(*r, j)] * v * x[(c, j)]).abs() } else { 0.0 };
                    }
                }
            }
            if size / xmx < (theta - shift).powi(2) * largest { xkx / xmx } else { *theta }
        };
        inverted.iter().enumerate().map(one).collect()
    }

    /// Orthonormalises, measures the errors, refines where they are large, and compares the counts.
    fn certify(&self, mut found: Found, sturm: SturmCount) -> Result<Eigenpairs> {
        let count = found.values.len();
        if sturm.counted != [count; 2] {
            let [low, high] = sturm.counted;
            return Err(missing(count, if low == count { high } else { low }, sturm.bound));
        }
        let mut errors = Vec::new();
        for round in 0..2 {
            orthonormalise(self.m, &mut found.vectors)?;
            errors = backward_errors(self.k, self.m, &found.values, found.vectors.as_ref());
            if round == 1 || errors.iter().all(|e| *e <= 1e-14) {
                break;
            }
            let mut y = Mat::zeros(found.vectors.nrows(), count);
            multiply(self.m, found.vectors.as_ref(), y.as_mut());
            found.factor.solve_in_place(y.as_mut());
            for (j, theta) in found.values.iter().enumerate() {
                y.col_mut(j).iter_mut().for_each(|v| *v *= theta - found.shift);
            }
            found.vectors = y;
        }
        if let Some(worst) = errors.iter().copied().find(|e| !(*e <= 1e-10)) {
            return Err(Error::analysis(
                "eigenvalues",
                format!("an eigenpair has a backward error of {worst:.1e}"),
                "The matrices span too many orders of magnitude: check units, thicknesses and stiffnesses",
            ));
        }
        Ok(Eigenpairs {
            values: found.values,
            vectors: found.vectors,
            backward_errors: errors,
            sturm,
            shift: found.shift,
            factor: found.factor,
        })
    }
}

impl Found {
    fn truncate(&mut self, count: usize) {
        self.values.truncate(count);
        self.vectors.resize_with(self.vectors.nrows(), count, |_, _| 0.0);
    }
}

/// X ← X (XᵀMX)^-½, which moves the vectors least.
fn orthonormalise(m: &SparseMatrix, x: &mut Mat<f64>) -> Result<()> {
    let mut mx = Mat::zeros(x.nrows(), x.ncols());
    multiply(m, x.as_ref(), mx.as_mut());
    let (values, u) = symmetric_eigen(gram(x.as_ref(), mx.as_ref()).as_ref())?;
    if values.iter().any(|v| !(*v > 0.0)) {
        return Err(Error::analysis(
            "eigenvalues",
            "two eigenvectors fell together",
            "Ask for fewer modes, or move the bound",
        ));
    }
    let n = values.len();
    let scaled = Mat::from_fn(n, n, |i, k| u[(i, k)] / values[k].sqrt());
    let root = super::dense::product(scaled.as_ref(), u.transpose());
    let mut y = Mat::zeros(x.nrows(), n);
    combine(y.as_mut(), Accum::Replace, x.as_ref(), root.as_ref(), 1.0);
    *x = y;
    Ok(())
}

/// A bound next to the wanted one with room for two shifts around it: the wanted bound itself unless an eigenvalue
/// sits on it, else the middle of the next gap above. `values` ascend; those from `first_above` on are not below the
/// bound, and nothing else lies below `beyond`.
fn gap(values: &[f64], first_above: usize, bound: f64, beyond: f64) -> (f64, [f64; 2]) {
    let near = 1e-9 * bound;
    let reach = APART * bound;
    let mut k = first_above;
    loop {
        let low = if k > 0 { values[k - 1] } else { 0.0 };
        let high = values.get(k).copied().unwrap_or(beyond);
        let at = if bound - low > near { bound } else { 0.5 * (low + high) };
        if (at - low > near && high - at > near) || k >= values.len() {
            return (at, [at - reach.min(0.5 * (at - low)), at + reach.min(0.5 * (high - at))]);
        }
        k += 1;
    }
}

/// Columns of the basis for `count` eigenpairs.
fn capacity(count: usize) -> usize {
    2 * count + 64
}

fn ritz_values(ritz: &Ritz, window: Window, shift: f64) -> Vec<f64> {
    window.indices(ritz).into_iter().map(|k| shift + 1.0 / ritz.values[k]).collect()
}

fn missing(found: usize, counted: usize, bound: f64) -> Error {
    Error::analysis(
        "eigenvalues",
        format!("the inertia counts {counted} below θ = {bound:.9e}, {found} were found"),
        "Move the bound a little; if that does not help the matrices are not symmetric or M is not positive semidefinite",
    )
}

impl BlockLanczos<'_> {
    /// The pairs (θ, x) of a window, θ ascending.
    fn pairs(&self, ritz: &Ritz, window: Window, shift: f64) -> (Vec<f64>, Mat<f64>) {
        let mut which: Vec<(f64, usize)> =
            window.indices(ritz).into_iter().map(|k| (shift + 1.0 / ritz.values[k], k)).collect();
        which.sort_by(|a, b| a.0.total_cmp(&b.0));
        let columns: Vec<usize> = which.iter().map(|(_, k)| *k).collect();
        (which.into_iter().map(|(theta, _)| theta).collect(), self.vectors(ritz, &columns))
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples;
    use super::*;

    fn check(k: &SparseMatrix, m: &SparseMatrix, pairs: &Eigenpairs) {
        let mut mx = Mat::zeros(m.ncols(), pairs.values.len());
        multiply(m, pairs.vectors.as_ref(), mx.as_mut());
        let g = gram(pairs.vectors.as_ref(), mx.as_ref());
        let count = pairs.values.len();
        assert!((g - Mat::<f64>::identity(count, count)).norm_max() < 1e-12, "M-orthonormal");
        assert!(pairs.backward_errors.iter().all(|e| *e < 1e-13), "{:?}", pairs.backward_errors);
        assert_eq!(pairs.sturm.counted, [count; 2]);
        assert!(pairs.sturm.shifts[0] < pairs.sturm.bound && pairs.sturm.bound < pairs.sturm.shifts[1]);
        let _ = k;
    }

    #[test]
    fn membrane_with_double_eigenvalues() {
        let (k, m) = samples::membrane(40);
        let exact = samples::membrane_eigenvalues(40);
        for wanted in [Wanted::Below(0.5), Wanted::Count(61)] {
            let pairs = lowest_eigenpairs(&k, &m, wanted, &()).unwrap();
            check(&k, &m, &pairs);
            for (value, exact) in pairs.values.iter().zip(&exact) {
                assert!((value - exact).abs() < 1e-12 * exact, "{value} {exact}");
            }
            match wanted {
                Wanted::Below(bound) => {
                    assert_eq!(pairs.values.len(), exact.iter().filter(|v| **v < bound).count())
                }
                Wanted::Count(count) => {
                    assert!(pairs.values.len() >= count && pairs.values.len() < count + 3)
                }
            }
        }
    }

    #[test]
    fn free_chain_has_its_rigid_body_mode() {
        for n in [1, 2, 5, 50, 400] {
            let (k, m) = samples::free_chain(n);
            let pairs = lowest_eigenpairs(&k, &m, Wanted::Count(n.min(12)), &()).unwrap();
            check(&k, &m, &pairs);
            for (j, value) in pairs.values.iter().enumerate() {
                let exact = 4.0 * (j as f64 * std::f64::consts::PI / (2 * n) as f64).sin().powi(2);
                assert!((value - exact).abs() < 1e-13, "{n} {j} {value} {exact}");
            }
        }
    }

    #[test]
    fn a_bound_on_an_eigenvalue_moves_up() {
        let (k, m) = samples::membrane(20);
        let exact = samples::membrane_eigenvalues(20);
        let pairs = lowest_eigenpairs(&k, &m, Wanted::Below(exact[10]), &()).unwrap();
        check(&k, &m, &pairs);
        assert!(pairs.values.len() >= 10 && pairs.sturm.bound >= exact[10]);
    }

    #[test]
    fn free_plate_agrees_with_the_dense_solver() {
        let (k, m) = samples::plate(14, false);
        let (values, _) = definite_pencil(k.to_dense().as_ref(), m.to_dense().as_ref()).unwrap();
        let bound = 0.5 * (values[40] + values[41]);
        let pairs = lowest_eigenpairs(&k, &m, Wanted::Below(bound), &()).unwrap();
        check(&k, &m, &pairs);
        assert_eq!(pairs.values.len(), 41);
        for (value, dense) in pairs.values.iter().zip(&values) {
            assert!((value - dense).abs() < 1e-14 * values[values.len() - 1], "{value} {dense}");
        }
        assert!(pairs.values[..3].iter().all(|v| v.abs() < 1e-6 * pairs.values[3]), "three rigid-body modes");
    }

    #[test]
    fn massless_degrees_of_freedom_have_no_finite_eigenvalue() {
        // A chain in which only every tenth point has mass: stiffness of ten springs in series between them.
        for n in [100, 1000] {
            let (k, _) = samples::free_chain(n);
            let entries: Vec<_> = (0..n).step_by(10).map(|p| faer::sparse::Triplet::new(p, p, 1.0)).collect();
            let m = SparseMatrix::try_new_from_triplets(n, n, &entries).unwrap();
            let masses = n / 10;
            let exact =
                |j: usize| 0.4 * (j as f64 * std::f64::consts::PI / (2 * masses) as f64).sin().powi(2);
            let few = lowest_eigenpairs(&k, &m, Wanted::Count(6), &()).unwrap();
            let all = lowest_eigenpairs(&k, &m, Wanted::Count(n), &()).unwrap();
            let below = lowest_eigenpairs(&k, &m, Wanted::Below(0.5 * (exact(4) + exact(5))), &()).unwrap();
            assert_eq!((few.values.len(), below.values.len(), all.values.len()), (6, 5, masses));
            for pairs in [&few, &below, &all] {
                check(&k, &m, pairs);
                assert!(pairs.values.iter().enumerate().all(|(j, v)| (v - exact(j)).abs() < 1e-12));
            }
        }
    }

    #[test]
    fn a_withheld_mode_is_noticed() {
        let (k, m) = samples::membrane(12);
        let pencil = Pencil::new(&k, &m).unwrap();
        let whole = lowest_eigenpairs(&k, &m, Wanted::Count(7), &()).unwrap();
        let count = whole.values.len();
        let mut found =
            Found { values: whole.values, vectors: whole.vectors, shift: whole.shift, factor: whole.factor };
        found.values.remove(3);
        found.vectors =
            Mat::from_fn(144, count - 1, |i, j| found.vectors[(i, if j < 3 { j } else { j + 1 })]);
        let error = pencil.certify(found, whole.sturm).unwrap_err().to_string();
        assert!(
            error.contains(&format!("counts {count}"))
                && error.contains(&format!("{} were found", count - 1))
        );
    }

    #[test]
    fn many_copies_are_all_found() {
        // Twenty equal chains side by side: every eigenvalue twenty times, more than a block holds.
        let (n, copies) = (30, 20);
        let (k, _) = samples::free_chain(n);
        let mut entries = Vec::new();
        for c in 0..copies {
            for j in 0..n {
                for (i, v) in k.row_idx_of_col_raw(j).iter().zip(k.val_of_col(j)) {
                    entries.push(faer::sparse::Triplet::new(c * n + i, c * n + j, *v));
                }
            }
        }
        let k = SparseMatrix::try_new_from_triplets(n * copies, n * copies, &entries).unwrap();
        let m = samples::identity(n * copies);
        for (wanted, expected) in [(Wanted::Below(0.03), 40), (Wanted::Count(45), 60)] {
            let pairs = lowest_eigenpairs(&k, &m, wanted, &()).unwrap();
            check(&k, &m, &pairs);
            assert_eq!(pairs.values.len(), expected, "{wanted:?}");
        }
    }

    #[test]
    fn results_do_not_depend_on_the_number_of_threads() {
        let (k, m) = samples::plate(18, true);
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| lowest_eigenpairs(&k, &m, Wanted::Count(30), &()).unwrap())
        };
        let (one, three) = (with(1), with(3));
        assert!(one.values == three.values && one.vectors == three.vectors);
    }

    #[test]
    fn senseless_requests_are_refused() {
        let (k, m) = samples::free_chain(4);
        for wanted in [Wanted::Below(-1.0), Wanted::Below(f64::NAN), Wanted::Count(0)] {
            assert!(lowest_eigenpairs(&k, &m, wanted, &()).is_err());
        }
        let none = lowest_eigenpairs(&samples::identity(4), &m, Wanted::Below(0.5), &()).unwrap();
        assert!(none.values.is_empty() && none.sturm.counted == [0, 0]);
    }

    #[test]
    #[ignore = "a measurement: cargo test --release --lib eigenpairs::tests::timing -- --ignored --nocapture"]
    fn timing() {
        let cpu = || {
            let stat = std::fs::read_to_string("/proc/self/stat").unwrap();
            let fields: Vec<&str> = stat.rsplit(')').next().unwrap().split_whitespace().collect();
            (fields[11].parse::<f64>().unwrap() + fields[12].parse::<f64>().unwrap()) / 100.0
        };
        for (m, hz) in [(81, 9000.0), (257, 6000.0)] {
            let (k, mass) = samples::plate(m, false);
            for wanted in [Wanted::Below((std::f64::consts::TAU * hz as f64).powi(2)), Wanted::Count(50)] {
                let (wall, before) = (std::time::Instant::now(), cpu());
                let pairs = lowest_eigenpairs(&k, &mass, wanted, &()).unwrap();
                let worst = pairs.backward_errors.iter().fold(0.0f64, |m, e| m.max(*e));
                println!(
                    "{} dof, {} pairs: {:.2} s wall, {:.2} s CPU, backward error {worst:.1e}",
                    k.nrows(),
                    pairs.values.len(),
                    wall.elapsed().as_secs_f64(),
                    cpu() - before
                );
                check(&k, &mass, &pairs);
            }
        }
    }
}
