//! Block Lanczos for the shift-inverted pencil: A = (K − σM)⁻¹ M, whose eigenvalues ν = 1/(θ − σ) are largest for
//! the θ next to σ. A is self-adjoint in the semi-inner product xᵀMy, in which the basis V is kept orthonormal:
//!
//!   A V = V H + X R,   H = Vᵀ M A V,   X the next block, M-orthonormal to V.
//!
//! A pair (ν, s) of H gives the Ritz vector V s with the residual ‖R s_last‖_M. Full orthogonalisation in two
//! steps (first against the columns that H couples, then against all) keeps V orthonormal to rounding, and lets H be
//! read off the orthogonalisation, so that a thick restart needs no special case: Wu & Simon, SIAM J. Matrix Anal.
//! Appl. 22 (2000) 602. The block: Grimes, Lewis & Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228.

use super::SparseMatrix;
use super::dense::{inverse_root, product, symmetric_eigen};
use super::factor::SymmetricFactor;
use super::multivector::{combine, expand, gram, rotate};
use super::random::Random;
use super::sparse::multiply;
use faer::{Accum, Mat, MatRef};
use stridor_base::error::{Error, Result};
use stridor_base::progress::Observer;

/// Columns of a block: as many right-hand sides as one solve takes at little more than the price of one, and more
/// than the multiplicity of any eigenvalue but the rigid-body ones of two free parts.
const BLOCK: usize = 8;
/// The relative error of M X that is let stand, as a part of the residual that is accepted.
const LAG: f64 = 1e-5;
/// Rounding of the solves is no excuse for more than this.
const UNACCEPTABLE: f64 = 1e-5;
/// The most blocks for one search.
const MOST_STEPS: usize = 1000;

/// The growing basis.
pub struct BlockLanczos<'a> {
    mass: &'a SparseMatrix,
    factor: &'a dyn SymmetricFactor,
    /// V in the first `len` columns, X in the `width` columns after them.
    basis: Mat<f64>,
    /// The columns that the basis has memory for.
    capacity: usize,
    projected: Mat<f64>,
    len: usize,
    width: usize,
    /// M X.
    mass_next: Mat<f64>,
    /// The memory of W.
    solved: Mat<f64>,
    /// M times the columns of V from `coupled_from` on; empty when they are not just the block before.
    mass_last: Mat<f64>,
    /// R, `width` × (columns of the block before).
    coupling: Mat<f64>,
    /// The first column of V that X is coupled to by A.
    coupled_from: usize,
    /// A Ritz pair is accepted at ‖residual‖_M ≤ this · |ν|, or when it has sunk into the rounding of the solves.
    /// The error of ν is quadratic in it, and the vectors get one more application of A.
    accepted: f64,
    /// The largest coefficient that is zero but for the rounding of the solves: fine meshes have
    /// ‖K‖ ‖(K − σM)⁻¹‖ of 1e8 and more.
    noise: f64,
    random: Random,
}

/// Eigenvalues ν of A with their coefficients s.
pub struct Ritz {
    /// ν, ascending.
    pub values: Vec<f64>,
    /// Coefficients on V, one pair a column.
    pub coefficients: Mat<f64>,
    /// ‖A V s − ν V s‖_M.
    pub residuals: Vec<f64>,
}

/// Which part of the spectrum of A must be complete.
#[derive(Debug, Clone, Copy)]
pub struct Window {
    /// How many eigenvalues ν are negative (θ < σ), all of them wanted; counted by the inertia of K − σM.
    pub negative: usize,
    /// How many of the largest ν are wanted (the next θ > σ).
    pub largest: usize,
    /// All of the largest are known to be at least this, when a count above the window says so.
    pub floor: f64,
}

impl Window {
    /// The pairs of `ritz` that the window holds: every negative ν and the largest ones.
    pub fn indices(&self, ritz: &Ritz) -> Vec<usize> {
        let n = ritz.values.len();
        (0..n).filter(|k| ritz.values[*k] < 0.0 || k + self.largest >= n).collect()
    }
}

impl<'a> BlockLanczos<'a> {
    /// An empty basis with memory for `capacity` columns, started with vectors that are the same in every run. Ritz pairs
    /// are accepted at ‖A x − ν x‖_M ≤ `accepted` |ν|.
    pub fn new(
        mass: &'a SparseMatrix,
        factor: &'a dyn SymmetricFactor,
        capacity: usize,
        accepted: f64,
    ) -> Self {
        let mut lanczos = BlockLanczos {
            mass,
            factor,
            basis: Mat::zeros(mass.ncols(), 0),
            capacity: 0,
            projected: Mat::zeros(0, 0),
            len: 0,
            width: 0,
            mass_next: Mat::zeros(mass.ncols(), 0),
            mass_last: Mat::zeros(mass.ncols(), 0),
            solved: Mat::new(),
            coupling: Mat::zeros(0, 0),
            coupled_from: 0,
            accepted,
            noise: 0.0,
            random: Random::new(),
        };
        lanczos.reserve(capacity);
        lanczos.inject();
        lanczos
    }

    /// Reserves memory for `capacity` columns and two blocks.
    pub fn reserve(&mut self, capacity: usize) {
        let total = capacity.max(4 * BLOCK) + 2 * BLOCK;
        if total > self.capacity {
            self.capacity = total;
            self.basis.reserve(self.mass.ncols(), total);
            self.projected.resize_with(total, total, |_, _| 0.0);
        }
    }

    /// Puts X into the basis, from column `first` on.
    fn put(&mut self, first: usize, x: &Mat<f64>) {
        let columns: Vec<&[f64]> = (0..x.ncols()).map(|j| x.col_as_slice(j)).collect();
        self.basis.truncate(x.nrows(), first.min(self.basis.ncols()));
        self.basis.resize_with(x.nrows(), first + x.ncols(), |i, j| columns[j - first][i]);
    }

    /// Extends the basis, restarting when it is full, until the window is complete and its pairs are accepted.
    /// `None` when the basis spans all that M reaches and still there are fewer: then M has a lower rank.
    ///
    /// # Errors
    /// [`Error::Analysis`] when that does not happen within a great number of blocks.
    pub fn converge(&mut self, window: Window, observer: &dyn Observer) -> Result<Option<Ritz>> {
        for _ in 0..MOST_STEPS {
            let complete = self.width == 0 && !self.inject();
            if !complete {
                let extra = 3 * self.width.max(BLOCK);
                self.reserve(window.negative + window.largest + 2 * extra);
                if self.len + extra > self.capacity {
                    self.restart(window, extra)?;
                }
                self.step()?;
                observer.advance(1);
                if self.len < window.negative + window.largest {
                    continue;
                }
            }
            let ritz = self.ritz()?;
            let found_negative = ritz.values.iter().filter(|v| **v < 0.0).count();
            let accepted = window.indices(&ritz).iter().all(|k| {
                let size = ritz.values[*k].abs();
                ritz.residuals[*k] <= (self.accepted * size).max(self.noise.min(UNACCEPTABLE * size))
            });
            let missing = found_negative < window.negative
                || self.len < window.largest
                || (window.largest > 0 && ritz.values[self.len - window.largest] < window.floor);
            match (complete, accepted, missing) {
                (true, _, true) => return Ok(None),
                (true, _, false) | (_, true, false) => return Ok(Some(ritz)),
                // All that the block can see is there, yet the count says there is more: look in new directions.
                (_, true, true) => {
                    self.inject();
                }
                _ => {}
            }
        }
        Err(Error::analysis(
            "block Lanczos",
            format!(
                "{} eigenvalues did not converge in {MOST_STEPS} blocks",
                window.negative + window.largest
            ),
            "Ask for fewer modes or a lower frequency; if the model mixes very soft and very stiff parts, check its units",
        ))
    }

    /// Extends the basis to about `columns` columns, without a restart, for a first look at the spectrum.
    ///
    /// # Errors
    /// [`Error::Analysis`] when numbers overflow.
    pub fn explore(&mut self, columns: usize, observer: &dyn Observer) -> Result<Ritz> {
        self.reserve(columns + BLOCK);
        while self.len < columns && (self.width > 0 || self.inject()) {
            self.step()?;
            observer.advance(1);
        }
        self.ritz()
    }

    /// Looks in new directions too, for copies of multiple eigenvalues.
    pub fn look_again(&mut self) {
        self.inject();
    }

    /// The window of all eigenvalues that M sees, for a basis that spans them: rounding aside, every ν ≠ 0.
    pub fn everything(&self, ritz: &Ritz) -> Window {
        let size = ritz.values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let negative = ritz.values.iter().filter(|v| **v < 0.0).count();
        let largest = ritz.values.iter().filter(|v| **v > 1e-14 * size).count();
        Window { negative, largest, floor: 0.0 }
    }

    /// The eigenpairs of H with the norms of their residuals.
    pub fn ritz(&self) -> Result<Ritz> {
        let (values, coefficients) =
            symmetric_eigen(self.projected.as_ref().submatrix(0, 0, self.len, self.len))?;
        let tail = self.coupling.ncols();
        let residuals = product(self.coupling.as_ref(), coefficients.subrows(self.len - tail, tail));
        let residuals = (0..self.len).map(|k| residuals.col(k).norm_l2()).collect();
        Ok(Ritz { values, coefficients, residuals })
    }

    /// The Ritz vectors of the pairs `which`, one a column, after one more application of A:
    /// A V s / ν = V s + X R s_last / ν, which also clears what M does not see. They are made M-orthonormal by their
    /// coefficients, as V and X are.
    ///
    /// # Errors
    /// [`Error::Analysis`] when two of them fall together.
    pub fn vectors(&self, ritz: &Ritz, which: &[usize]) -> Result<Mat<f64>> {
        let tail = self.coupling.ncols();
        let mut s = Mat::zeros(self.len + self.width, which.len());
        for (column, k) in which.iter().enumerate() {
            s.col_mut(column).subrows_mut(0, self.len).copy_from(ritz.coefficients.col(*k));
        }
        let rest = product(self.coupling.as_ref(), s.as_ref().subrows(self.len - tail, tail));
        for (column, k) in which.iter().enumerate() {
            for i in 0..self.width {
                s[(self.len + i, column)] = rest[(i, column)] / ritz.values[*k];
            }
        }
        let s = product(s.as_ref(), inverse_root(product(s.transpose(), s.as_ref()).as_ref())?.as_ref());
        Ok(expand(self.basis.subcols(0, self.len + self.width), s.as_ref()))
    }

    /// One block: W = A X, orthogonalised; its coefficients go into H, what is left is the next X.
    fn step(&mut self) -> Result<()> {
        let (begin, end) = (self.len, self.len + self.width);
        let mut w = std::mem::replace(&mut self.solved, Mat::new());
        resize(&mut w, self.mass_next.nrows(), self.width);
        w.copy_from(&self.mass_next);
        self.factor.solve_in_place(w.as_mut());
        let from = self.coupled_from;
        let mut mw = std::mem::replace(&mut self.mass_last, Mat::new());
        let near = if mw.ncols() == begin - from {
            // VᵀMW = (MV)ᵀW, and the M V of the last two blocks are at hand.
            let h = stacked(gram(mw.as_ref(), w.as_ref()), gram(self.mass_next.as_ref(), w.as_ref()));
            combine(w.as_mut(), Accum::Add, self.basis.subcols(from, end - from), h.as_ref(), -1.0);
            h
        } else {
            self.weigh(&w, &mut mw);
            self.orthogonalise(&mut w, &mw, from, end)
        };
        self.weigh(&w, &mut mw);
        let all = self.orthogonalise(&mut w, &mw, 0, end);
        let square = gram(w.as_ref(), mw.as_ref());
        let rest = lengths(&square);
        // By Pythagoras: what was taken out is M-orthonormal.
        let before = |j: usize| near.col(j).norm_l2().hypot(rest[j]);
        let scale = (0..self.width).map(before).fold(0.0, f64::max);
        let smallest = rest.iter().copied().fold(scale, f64::min);
        // M W lags behind by what was taken out just now, which lies in the span of V: it comes back in the coefficients
        // of the next block, which may be wrong by as little.
        if all.norm_max() > LAG * self.accepted * smallest {
            self.weigh(&w, &mut mw);
        }
        for j in 0..self.width {
            for i in 0..end {
                let first = if i >= from { near[(i - from, j)] } else { 0.0 };
                self.projected[(i, begin + j)] = first + all[(i, j)];
            }
        }
        let beyond = all.subrows(0, from).norm_max();
        self.noise = self.noise.max(beyond);
        for j in begin..end {
            for i in 0..j {
                let value = if i < begin {
                    self.projected[(i, j)]
                } else {
                    0.5 * (self.projected[(i, j)] + self.projected[(j, i)])
                };
                self.projected[(i, j)] = value;
                self.projected[(j, i)] = value;
            }
        }
        self.coupled_from = begin;
        self.len = end;
        self.coupling = self.orthonormalise(&mut w, &mut mw, square, scale)?;
        self.width = w.ncols();
        self.put(end, &w);
        self.mass_last = std::mem::replace(&mut self.mass_next, mw);
        self.solved = w;
        Ok(())
    }

    /// W = X R with XᵀMX = I. Directions below rounding (1e-15 of `scale`) are dropped: there X has fewer columns.
    ///
    /// By the eigenvalues of the Gram matrix WᵀMW. Those too small to be trusted are only scaled up in this round and
    /// resolved in the next. W and M W become X and M X; R is returned.
    fn orthonormalise(
        &self,
        w: &mut Mat<f64>,
        mw: &mut Mat<f64>,
        mut square: Mat<f64>,
        scale: f64,
    ) -> Result<Mat<f64>> {
        let mut r = Mat::<f64>::identity(w.ncols(), w.ncols());
        for _ in 0..5 {
            let (values, u) = symmetric_eigen(square.as_ref())?;
            let largest = values.last().copied().unwrap_or(0.0);
            if largest <= 0.0 {
                [w, mw].into_iter().for_each(|a| a.truncate(a.nrows(), 0));
                return Ok(Mat::zeros(0, r.ncols()));
            }
            let size: Vec<f64> = values.iter().map(|v| v.max(1e-13 * largest).sqrt()).collect();
            let up = Mat::from_fn(size.len(), size.len(), |k, i| u[(i, k)] * size[k]);
            let next = product(up.as_ref(), r.as_ref());
            let kept: Vec<usize> =
                (0..size.len()).filter(|k| next.row(*k).norm_l2() > 1e-15 * scale).collect();
            let down = Mat::from_fn(size.len(), kept.len(), |i, k| u[(i, kept[k])] / size[kept[k]]);
            r = Mat::from_fn(kept.len(), r.ncols(), |k, j| next[(kept[k], j)]);
            for a in [&mut *w, &mut *mw] {
                rotate(a.as_mut(), down.as_ref());
                a.truncate(a.nrows(), kept.len());
            }
            // The error left by this round is rounding over the spread of the eigenvalues.
            if kept.first().is_none_or(|first| values[*first] > 1e-2 * largest) {
                break;
            }
            if (0..r.nrows()).any(|k| r.row(k).norm_l2() < 1e-4 * scale) {
                self.weigh(w, mw);
                self.orthogonalise(w, mw, 0, self.len);
            }
            self.weigh(w, mw);
            square = gram(w.as_ref(), mw.as_ref());
        }
        Ok(r)
    }

    /// Adds new random directions to X, as A maps them; false when M reaches nothing outside the basis.
    fn inject(&mut self) -> bool {
        let n = self.mass.ncols();
        self.reserve(self.len + self.width + BLOCK);
        let start = Mat::from_fn(n, BLOCK, |_, _| self.random.next());
        let mut w = self.mass_times(start.as_ref());
        self.factor.solve_in_place(w.as_mut());
        let mut mw = self.mass_times(w.as_ref());
        let scale = lengths(&gram(w.as_ref(), mw.as_ref())).into_iter().fold(0.0, f64::max);
        let (len, held) = (self.len, self.len + self.width);
        let rounds = if held > 0 { 2 } else { 0 };
        for _ in 0..rounds {
            self.orthogonalise(&mut w, &mw, 0, held);
            mw = self.mass_times(w.as_ref());
        }
        // Against X as well as V: for a moment X counts as part of V.
        self.len = held;
        let square = gram(w.as_ref(), mw.as_ref());
        let result = self.orthonormalise(&mut w, &mut mw, square, 1e5 * scale);
        self.len = len;
        if result.is_err() || w.ncols() == 0 {
            return false;
        }
        self.put(held, &w);
        let width = self.width;
        self.width += w.ncols();
        self.mass_next.resize_with(n, self.width, |i, j| mw[(i, j - width)]);
        let tail = self.coupling.ncols();
        self.coupling.resize_with(self.width, tail, |_, _| 0.0);
        true
    }

    /// Keeps the Ritz vectors of the window and the best of the rest as the new V, with memory for more columns.
    fn restart(&mut self, window: Window, extra: usize) -> Result<()> {
        let ritz = self.ritz()?;
        let mut order: Vec<usize> = (0..self.len).collect();
        order.sort_by(|a, b| ritz.values[*b].abs().total_cmp(&ritz.values[*a].abs()));
        let wanted = (window.negative + window.largest).min(self.len);
        let keep = (wanted + (self.len - wanted) / 2).min(self.capacity - extra);
        let mut kept = order[..keep].to_vec();
        kept.sort_unstable();
        let s = Mat::from_fn(self.len, keep, |i, k| ritz.coefficients[(i, kept[k])]);
        let next = self.basis.subcols(self.len, self.width).to_owned();
        rotate(self.basis.subcols_mut(0, self.len), s.as_ref());
        self.put(keep, &next);
        let tail = self.coupling.ncols();
        self.coupling = product(self.coupling.as_ref(), s.subrows(self.len - tail, tail));
        self.projected.fill(0.0);
        for (k, which) in kept.iter().enumerate() {
            self.projected[(k, k)] = ritz.values[*which];
        }
        self.len = keep;
        self.coupled_from = 0;
        self.mass_last = Mat::zeros(self.mass.ncols(), 0);
        Ok(())
    }

    fn mass_times(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        let mut y = Mat::zeros(x.nrows(), x.ncols());
        multiply(self.mass, x, y.as_mut());
        y
    }

    /// M W in the memory at hand.
    fn weigh(&self, w: &Mat<f64>, mw: &mut Mat<f64>) {
        resize(mw, w.nrows(), w.ncols());
        multiply(self.mass, w.as_ref(), mw.as_mut());
    }

    /// W ← W − V Vᵀ(M W) for the columns `from..to` of the basis; returns Vᵀ M W.
    fn orthogonalise(&self, w: &mut Mat<f64>, mw: &Mat<f64>, from: usize, to: usize) -> Mat<f64> {
        let v = self.basis.subcols(from, to - from);
        let h = gram(v, mw.as_ref());
        combine(w.as_mut(), Accum::Add, v, h.as_ref(), -1.0);
        h
    }
}

/// A above B.
fn stacked(a: Mat<f64>, b: Mat<f64>) -> Mat<f64> {
    let above = a.nrows();
    Mat::from_fn(above + b.nrows(), a.ncols(), |i, j| if i < above { a[(i, j)] } else { b[(i - above, j)] })
}

/// (xᵀ M x)^½ of each column of a Gram matrix.
fn lengths(square: &Mat<f64>) -> Vec<f64> {
    (0..square.ncols()).map(|j| square[(j, j)].max(0.0).sqrt()).collect()
}

/// Resizes `a` to `n` × `columns`; its values are undefined.
fn resize(a: &mut Mat<f64>, n: usize, columns: usize) {
    a.resize_with(n, columns, |_, _| 0.0);
}

#[cfg(test)]
mod tests {
    use super::super::factor::SymbolicFactor;
    use super::super::samples;
    use super::super::sparse::add_scaled;
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn relation_and_orthogonality_hold() {
        let (k, m) = samples::plate(20, false);
        let shift = (std::f64::consts::TAU * 3000.0).powi(2);
        let a = add_scaled(&[(1.0, &k), (-shift, &m)]);
        let factor = SymbolicFactor::new(a.symbolic()).unwrap().factorize(&a).unwrap();
        let mut lanczos = BlockLanczos::new(&m, &*factor, 120, 1e-12);
        for step in 0..30 {
            if step == 14 {
                let negative = factor.inertia().negative;
                lanczos.restart(Window { negative, largest: 10, floor: 0.0 }, 3 * BLOCK).unwrap();
            }
            lanczos.step().unwrap();
            if lanczos.len + 3 * BLOCK > lanczos.capacity {
                break;
            }
        }
        let (len, width, tail) = (lanczos.len, lanczos.width, lanczos.coupling.ncols());
        let v = lanczos.basis.subcols(0, len + width);
        let mut residual = gram(v, lanczos.mass_times(v).as_ref());
        residual -= Mat::<f64>::identity(len + width, len + width);
        // ε for each of the products that a basis vector is projected by, one with every vector before it.
        let bound = 10.0 * (len + width) as f64 * f64::EPSILON;
        assert!(within(residual.norm_max(), bound, RoundOff), "VᵀMV = I");
        let mut r = lanczos.mass_times(v.subcols(0, len));
        factor.solve_in_place(r.as_mut());
        let h = lanczos.projected.as_ref().submatrix(0, 0, len, len);
        combine(r.as_mut(), Accum::Add, v.subcols(0, len), h, -1.0);
        let last = r.as_mut().subcols_mut(len - tail, tail);
        combine(last, Accum::Add, v.subcols(len, width), lanczos.coupling.as_ref(), -1.0);
        let error = lengths(&gram(r.as_ref(), lanczos.mass_times(r.as_ref()).as_ref()));
        assert!(error.iter().all(|e| within(*e, 1e-12 * h.norm_max(), RoundOff)), "AV = VH + XR");
    }
}
