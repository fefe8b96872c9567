//! The lowest eigenpairs of K x = θ M x, with the proof that none is missing.
//!
//! K is symmetric (singular and even indefinite are allowed), M symmetric positive semidefinite; what M does not see
//! has no finite eigenvalue and does not appear. By Sylvester's law the negative pivots of K − σM are the number of
//! eigenvalues below σ. That count is taken at the shift of the iteration, which tells Lanczos how many to find on
//! either side of it, and at two shifts that enclose the upper bound, which certify the result.

mod bounds;
mod counted;
mod iteration;
mod small;
#[cfg(test)]
mod tests;

use super::SparseMatrix;
use super::dense::inverse_root;
use super::factor::{Engine, SymbolicFactor, SymmetricFactor, is_singular};
use super::lanczos::Window;
use super::multivector::{gram, panels, rotate};
use super::shared_pattern::SharedPattern;
use super::sparse::{add_scaled, diagonal, norm_1, times};
use bounds::{APART, gap};
use faer::{Mat, MatRef};
use iteration::Iteration;
use stridor_base::error::{Error, Result};
use stridor_base::progress::Observer;

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
    /// Two shifts, one either side of the bound, with no eigenvalue between; both are the bound when that was put in
    /// the middle of a gap.
    pub shifts: [f64; 2],
    /// Negative pivots of K − shift · M.
    pub counted: [usize; 2],
}

/// How exact pairs are to be.
#[derive(Debug, Clone, Copy)]
struct Aim {
    /// The backward error that is aimed at.
    backward_error: f64,
    /// The most that ‖A x − ν x‖_M / |ν| may be, however fine the mesh.
    residual: f64,
}

/// For pairs as results.
const RESULT: Aim = Aim { backward_error: 1e-14, residual: 1e-9 };
/// For vectors that span a larger problem, whose own errors are measured there, and for eigenvalues right to the square of
/// the residual.
const BASIS: Aim = Aim { backward_error: 1e-11, residual: 1e-6 };

/// Where in the range the shift lies, with two places to evade to: the ends are about equally far in blocks of
/// Lanczos, as modes of plates lie denser towards the lower one.
const INSIDE: [f64; 3] = [0.4, 0.38, 0.42];
/// The first look at the spectrum sees about this many of the lowest eigenvalues; where the others lie is extrapolated.
const EXPLORED: usize = 16;
/// Ritz values with ‖A x − ν x‖_M below this part of |ν| are taken for eigenvalues in the first look.
const SETTLED: f64 = 1e-2;
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
    lowest_eigenpairs_by(&Engine::default(), k, m, wanted, observer)
}

/// [`lowest_eigenpairs`] with K − σM factorised by `engine`.
///
/// # Errors
/// As [`lowest_eigenpairs`].
///
/// # Panics
/// When the matrices are not square and of one size.
pub fn lowest_eigenpairs_by(
    engine: &Engine,
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
        Wanted::Below(bound) => check_bound(bound)?,
        Wanted::Count(0) => {
            return Err(Error::analysis("eigenvalues", "none was asked for", "Ask for at least one"));
        }
        Wanted::Count(_) => {}
    }
    let pencil = Pencil::new(k, m, engine)?;
    observer.begin("eigenvalues", None);
    let result = pencil.solve(wanted, || match wanted {
        Wanted::Below(bound) => pencil.below(bound, observer),
        Wanted::Count(count) => pencil.count(count.min(n), observer),
    });
    observer.end();
    result
}

/// The eigenpairs below `bound`, or a shade above it, where K − σM is factorised already at a shift σ below the bound: it is
/// taken for the iteration, and the analysis of its pattern for the count. They are to span a larger problem: backward errors
/// of 1e-11 are aimed at, not of 1e-14.
///
/// # Errors
/// As [`lowest_eigenpairs`].
///
/// # Panics
/// When the matrices are not square and of one size.
pub fn eigenpairs_below(
    k: &SparseMatrix,
    m: &SparseMatrix,
    bound: f64,
    start: (f64, Box<dyn SymmetricFactor>),
    observer: &dyn Observer,
) -> Result<Eigenpairs> {
    check_bound(bound)?;
    let pencil = Pencil { k, m, symbolic: start.1.symbolic(), aim: BASIS };
    observer.begin("eigenvalues", None);
    let result =
        pencil.solve(Wanted::Below(bound), || pencil.below_from(start, bound * (1.0 + APART), observer));
    observer.end();
    result
}

fn check_bound(bound: f64) -> Result<()> {
    if bound > 0.0 && bound.is_finite() {
        return Ok(());
    }
    let found = format!("the bound is {bound}");
    Err(Error::analysis("eigenvalues", found, "Ask for those below a positive, finite bound"))
}

/// ‖K x − θ M x‖₂ / ((‖K‖₁ + |θ| ‖M‖₁) ‖x‖₂) of each pair.
pub fn backward_errors(
    k: &SparseMatrix,
    m: &SparseMatrix,
    values: &[f64],
    vectors: MatRef<'_, f64>,
) -> Vec<f64> {
    let (k_norm, m_norm) = (norm_1(k), norm_1(m));
    let both = SharedPattern::new(&[k, m]);
    let (mut errors, mut images) = (Vec::new(), Vec::new());
    for (start, width) in panels(0..values.len()) {
        let (x, values) = (vectors.subcols(start, width), &values[start..start + width]);
        both.times(x, &mut images);
        let error = |(j, theta): (usize, &f64)| {
            let [kx, mx] = [0, 1].map(|a: usize| images[a].col_as_slice(j));
            let residual = kx.iter().zip(mx).map(|(k, m)| (k - theta * m).powi(2)).sum::<f64>().sqrt();
            residual / ((k_norm + theta.abs() * m_norm) * x.col(j).norm_l2()).max(f64::MIN_POSITIVE)
        };
        errors.extend(values.iter().enumerate().map(error));
    }
    errors
}

/// K − σM with the analysis of its pattern.
struct Pencil<'a> {
    k: &'a SparseMatrix,
    m: &'a SparseMatrix,
    symbolic: SymbolicFactor,
    aim: Aim,
}

type Factor = Box<dyn SymmetricFactor>;

/// The first of `shifts` for which `f` gives something, and that; nothing, or a singular matrix, stands for a shift on an eigenvalue.
/// Memory that does not suffice for one shift does not for another.
fn off_eigenvalues<T>(shifts: [f64; 3], f: impl Fn(f64) -> Result<Option<T>>) -> Result<(f64, T)> {
    let mut refused = None;
    for shift in shifts {
        match f(shift) {
            Ok(Some(found)) => return Ok((shift, found)),
            Ok(None) => {}
            Err(error) if is_singular(&error) => refused = Some(error),
            Err(error) => return Err(error),
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

/// Pairs found at a shift.
struct Found {
    values: Vec<f64>,
    vectors: Mat<f64>,
    shift: f64,
    factor: Factor,
}

impl<'a> Pencil<'a> {
    fn new(k: &'a SparseMatrix, m: &'a SparseMatrix, engine: &Engine) -> Result<Self> {
        if norm_1(m) == 0.0 {
            let help = "Give a part a density, or put a mass on a node";
            return Err(Error::analysis("eigenvalues", "the mass matrix is zero", help));
        }
        let union = add_scaled(&[(1.0, k), (1.0, m)]);
        Ok(Pencil { k, m, symbolic: engine.analyse(union.symbolic())?, aim: RESULT })
    }

    /// K − σM.
    fn shifted(&self, shift: f64) -> SparseMatrix {
        add_scaled(&[(1.0, self.k), (-shift, self.m)])
    }

    /// The factors at the first of `shifts` that does not sit on an eigenvalue.
    fn factorize_near(&self, shifts: [f64; 3]) -> Result<(f64, Factor)> {
        let factorize = |shift| {
            let factor = self.symbolic.factorize(&self.shifted(shift))?;
            Ok((factor.inertia().zero == 0).then_some(factor))
        };
        off_eigenvalues(shifts, factorize)
    }

    /// How many eigenvalues lie below the first of `shifts` that does not sit on one, and that shift.
    fn count_near(&self, shifts: [f64; 3]) -> Result<(f64, usize)> {
        let count = |shift| {
            let inertia = self.symbolic.inertia(&self.shifted(shift))?;
            Ok((inertia.zero == 0).then_some(inertia.negative))
        };
        off_eigenvalues(shifts, count)
    }

    /// The number of eigenvalues below each of two shifts, factorised side by side.
    fn count_at(&self, shifts: [f64; 2]) -> Result<[usize; 2]> {
        // A shift that sits on an eigenvalue is nudged; the pair stays on its side of the bound.
        let nudge = 0.01 * (shifts[1] - shifts[0]);
        let at = |s: f64| self.count_near([s, s - nudge, s + nudge]).map(|(_, count)| count);
        let (low, high) = rayon::join(|| at(shifts[0]), || at(shifts[1]));
        Ok([low?, high?])
    }

    fn below(&self, bound: f64, observer: &dyn Observer) -> Result<Eigenpairs> {
        let mut shifts = [bound * (1.0 - APART), bound * (1.0 + APART)];
        let middle = INSIDE.map(|part| part * bound);
        let (counted, middle) = rayon::join(|| self.count_at(shifts), || self.factorize_near(middle));
        let mut counted = counted?;
        let mut found = self.found_below(middle?, shifts[1], counted[1], observer)?;
        let mut bound = bound;
        if counted[0] != counted[1] {
            let first_above = found.values.partition_point(|v| *v < bound);
            (bound, shifts) = gap(&found.values, first_above, bound, shifts[1]);
            counted = self.count_at(shifts)?;
            found.truncate(found.values.partition_point(|v| *v < bound));
        }
        self.certify(found, SturmCount { bound, shifts, counted })
    }

    /// The pairs below `bound`, where one count says all unless an eigenvalue that was found sits on it.
    fn below_from(
        &self,
        start: (f64, Factor),
        mut bound: f64,
        observer: &dyn Observer,
    ) -> Result<Eigenpairs> {
        let (mut above, mut counted) =
            self.count_near([bound, bound * (1.0 + 0.1 * APART), bound * (1.0 + 0.2 * APART)])?;
        let mut found = self.found_below(start, above, counted, observer)?;
        let near = |v: &f64| above - v < 1e-9 * bound;
        if found.values.last().is_some_and(near) {
            let first_above = found.values.partition_point(|v| above - v >= 1e-9 * bound);
            let below = first_above.checked_sub(1).map_or(0.0, |k| found.values[k]);
            let next = found.values.get(first_above).copied().unwrap_or(above);
            bound = 0.5 * (below + next);
            (above, counted) = self.count_near([bound; 3])?;
            found.truncate(first_above);
        }
        self.certify(found, SturmCount { bound: above, shifts: [above; 2], counted: [counted; 2] })
    }

    /// The pairs below `above`, `counted` in number, by an iteration at a shift.
    fn found_below(
        &self,
        (shift, factor): (f64, Factor),
        above: f64,
        counted: usize,
        observer: &dyn Observer,
    ) -> Result<Found> {
        let accepted = self.accepted(above - shift);
        let mut iteration = Iteration::new([self.k, self.m], (shift, &*factor), capacity(counted), accepted);
        let negative = factor.inertia().negative;
        let window =
            Window { negative, largest: counted.saturating_sub(negative), floor: 1.0 / (above - shift) };
        if let (found, true) = iteration.values(window, observer)? {
            return Err(missing(found.len(), counted, above));
        }
        let (values, vectors) = iteration.pairs()?;
        Ok(Found { values, vectors, shift, factor })
    }

    /// For pairs with |θ − σ| up to `reach`, the residual ‖A x − ν x‖_M / |ν| at which the backward error
    /// ‖K x − θ M x‖ / ‖K‖ ‖x‖ is near the one aimed at: residuals are made of modes not far above the wanted ones, for
    /// which ‖K‖ is the larger the finer the mesh.
    fn accepted(&self, reach: f64) -> f64 {
        let Aim { backward_error, residual } = self.aim;
        (backward_error * norm_1(self.k) / (reach * norm_1(self.m))).clamp(1e-12, residual)
    }

    /// |K_ii| / M_ii, ascending, without zeros: how fast single degrees of freedom would vibrate.
    fn local_scales(&self) -> Vec<f64> {
        let (k, m) = (diagonal(self.k), diagonal(self.m));
        let mut ratios: Vec<f64> =
            k.iter().zip(m).filter(|(k, m)| **k != 0.0 && *m > 0.0).map(|(k, m)| k.abs() / m).collect();
        ratios.sort_by(f64::total_cmp);
        ratios
    }

    /// The median of [`Pencil::local_scales`], far above the lowest eigenvalues.
    fn local_scale(&self) -> f64 {
        let ratios = self.local_scales();
        ratios.get(ratios.len() / 2).copied().unwrap_or(1.0)
    }

    /// The largest of [`Pencil::local_scales`].
    fn largest_scale(&self) -> f64 {
        self.local_scales().last().copied().unwrap_or(1.0)
    }

    /// Eigenvalues up to this size are rigid-body motions, zero but for rounding.
    fn rigid_below(&self) -> f64 {
        1e-12 * self.local_scale()
    }

    /// Measures the errors of pairs whose vectors are M-orthonormal, refines where they are large, and compares the counts.
    fn certify(&self, mut found: Found, sturm: SturmCount) -> Result<Eigenpairs> {
        let count = found.values.len();
        if sturm.counted != [count; 2] {
            let [low, high] = sturm.counted;
            return Err(missing(count, if low == count { high } else { low }, sturm.bound));
        }
        let mut errors = Vec::new();
        for round in 0..2 {
            errors = backward_errors(self.k, self.m, &found.values, found.vectors.as_ref());
            if round == 1 || errors.iter().all(|e| *e <= self.aim.backward_error) {
                break;
            }
            let mut y = times(self.m, found.vectors.as_ref());
            found.factor.solve_in_place(y.as_mut());
            for (j, theta) in found.values.iter().enumerate() {
                y.col_mut(j).iter_mut().for_each(|v| *v *= theta - found.shift);
            }
            found.vectors = y;
            orthonormalise(self.m, &mut found.vectors)?;
        }
        if let Some(worst) = errors.iter().copied().find(|e| *e > 1e-10 || e.is_nan()) {
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

/// X ← X (XᵀMX)^-½.
fn orthonormalise(m: &SparseMatrix, x: &mut Mat<f64>) -> Result<()> {
    let mut square = Mat::zeros(x.ncols(), x.ncols());
    for (start, width) in panels(0..x.ncols()) {
        let mx = times(m, x.subcols(start, width));
        square.subcols_mut(start, width).copy_from(gram(x.as_ref(), mx.as_ref()));
    }
    rotate(x.as_mut(), inverse_root(square.as_ref())?.as_ref());
    Ok(())
}

/// Columns of the basis for `count` eigenpairs.
fn capacity(count: usize) -> usize {
    2 * count + 64
}

fn none_found(scale: f64) -> Error {
    Error::analysis(
        "eigenvalues",
        format!("no finite eigenvalue was found; typical of K and M is θ = {scale:.1e}"),
        "Check the densities, masses and stiffnesses: the mass may be nothing beside the stiffness",
    )
}

fn missing(found: usize, counted: usize, bound: f64) -> Error {
    Error::analysis(
        "eigenvalues",
        format!("the inertia counts {counted} below θ = {bound:.9e}, {found} were found"),
        "Move the bound a little; if that does not help the matrices are not symmetric or M is not positive semidefinite",
    )
}
