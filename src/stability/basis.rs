//! The subspace that the quadratic problem is projected on, grown by what the full order asks for.

use crate::dynamics::{Between, Block, Operator};
use crate::linalg::SparseMatrix;
use crate::linalg::dense::{product, symmetric_eigen};
use crate::linalg::multivector::{Columns, append, combine, expand, gram, panels};
use crate::linalg::sparse::{add_scaled, times};
use faer::linalg::triangular_solve::solve_upper_triangular_in_place;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use std::sync::OnceLock;

/// Columns that are orthonormalised together.
const PANEL: usize = 32;
/// Of more columns than this the principal directions are taken.
const WIDE: usize = 48;
/// Vectors besides the real modes for which a basis has memory before it is copied to a larger place,
const CAPACITY: usize = 160;
/// and for each of the real modes where the interface has more directions than there are modes: 5.9 and 7.1 were counted.
const OF_MANY_POINTS: usize = 7;

/// A basis B = \[Φ Z\] and the projections BᵀMB, BᵀCB, BᵀKB, BᵀHB, and BᵀW of the interface.
///
/// E = K + τM measures how much a direction can matter in the band. The real modes, which are M-orthonormal, are
/// orthogonal in E too; what is added is E-orthogonal to them and orthonormal in E/τ: there, above the modes, E is
/// positive also where M is singular or K indefinite, and no direction without mass is lost. Of many columns at once it is
/// orthogonal only as far as the digits of their Gram matrix go.
pub(super) struct Basis<'a> {
    operator: &'a Operator<'a>,
    /// E, once it is requested.
    energy: OnceLock<SparseMatrix>,
    tau: f64,
    /// bᵀEb of every column.
    sizes: Vec<f64>,
    /// Φ.
    pub(super) modes: MatRef<'a, f64>,
    /// Z.
    pub(super) added: Mat<f64>,
    pub(super) mass: Mat<f64>,
    pub(super) damping: Mat<f64>,
    pub(super) stiffness: Mat<f64>,
    pub(super) hysteretic: Option<Mat<f64>>,
    /// Bᵀ(·)B of the sparse skew parts of K and C, where there are any.
    pub(super) skew: Option<[Mat<f64>; 2]>,
    /// BᵀW: one row a basis vector, one column a direction of the interface.
    pub(super) interface: Mat<f64>,
}

impl<'a> Basis<'a> {
    /// Starts from M-orthonormal real modes.
    pub(super) fn new(operator: &'a Operator<'a>, modes: MatRef<'a, f64>, tau: f64) -> Self {
        let many = operator.interface.directions.len() > modes.ncols();
        let capacity = if many { OF_MANY_POINTS * modes.ncols() } else { 0 };
        let mut added = Mat::with_capacity(operator.n(), capacity.max(CAPACITY).min(operator.n()));
        added.resize_with(operator.n(), 0, |_, _| 0.0);
        let mut basis = Basis {
            operator,
            energy: OnceLock::new(),
            tau,
            sizes: Vec::new(),
            modes,
            added,
            mass: Mat::zeros(0, 0),
            damping: Mat::zeros(0, 0),
            stiffness: Mat::zeros(0, 0),
            hysteretic: operator.damping.hysteretic.as_ref().map(|_| Mat::zeros(0, 0)),
            skew: operator.skew.map(|_| [Mat::zeros(0, 0), Mat::zeros(0, 0)]),
            interface: Mat::zeros(0, operator.interface.directions.len()),
        };
        basis.project();
        basis
    }

    fn energy(&self) -> &SparseMatrix {
        let Operator { stiffness, mass, .. } = self.operator;
        self.energy.get_or_init(|| add_scaled(&[(1.0, &**stiffness), (self.tau, mass)]))
    }

    pub(super) fn len(&self) -> usize {
        self.n_real() + self.added.ncols()
    }

    /// How many vectors can be added: beyond that they are dependent.
    fn free(&self) -> usize {
        self.operator.n().saturating_sub(self.len())
    }

    /// How many of the vectors, the first ones, are real modes.
    pub(super) fn n_real(&self) -> usize {
        self.modes.ncols()
    }

    /// B.
    pub(super) fn columns(&self) -> Columns<'_> {
        Columns::of([self.modes, self.added.as_ref()])
    }

    /// All vectors and the real modes, then all vectors and the others.
    pub(super) fn between(&self) -> [Between<'_>; 2] {
        let (n_real, added) = (self.n_real(), self.added.ncols());
        let of = |y, first: usize, count: usize| Between {
            b: self.columns(),
            y,
            mass: self.mass.subcols(first, count),
            stiffness: self.stiffness.subcols(first, count),
        };
        [of(self.modes, 0, n_real), of(self.added.as_ref(), n_real, added)]
    }

    /// |WᵀB| |y|: at least |WᵀBy| of every direction of the interface.
    pub(super) fn extents(&self, [re, im]: [&[f64]; 2]) -> Vec<f64> {
        let sizes: Vec<f64> = re.iter().zip(im).map(|(re, im)| re.hypot(*im)).collect();
        let of = |d: usize| self.interface.col_as_slice(d).iter().zip(&sizes).map(|(w, y)| w.abs() * y).sum();
        (0..self.interface.ncols()).map(of).collect()
    }

    /// B y of every column of `y`.
    pub(super) fn expand(&self, y: &Block) -> Block {
        let mut vectors = Block::default();
        self.expand_into(y, &mut vectors);
        vectors
    }

    /// B y of every column of `y`, in the memory of `vectors`.
    pub(super) fn expand_into(&self, y: &Block, vectors: &mut Block) {
        vectors.resize(self.modes.nrows(), y.ncols());
        self.columns().combine(vectors.parts_mut(), y.parts(), Accum::Replace, 1.0);
    }

    /// Adds the directions of `z` that are new. Of a few columns, after the basis is projected out, those are taken whose
    /// remaining size in the E-norm is largest, until it is below `tolerance` (or round-off of where the column started), or
    /// `limit` are taken; of many, the principal directions of what remains of all of them, down to `tolerance`. Says how
    /// many were.
    pub(super) fn enrich(&mut self, z: &Mat<f64>, tolerance: f64, limit: usize) -> usize {
        let old = self.len();
        if z.ncols() > WIDE && limit == usize::MAX {
            self.append_principal(z, tolerance);
        } else {
            let new = self.largest(z.clone(), tolerance, limit.min(self.free()));
            self.append(new.as_ref());
        }
        self.len() - old
    }

    /// The columns of `z` with the largest rest, made E/τ-orthonormal.
    fn largest(&self, mut z: Mat<f64>, tolerance: f64, limit: usize) -> Mat<f64> {
        const ROUND_OFF: f64 = 1e-10;
        let mut image = times(self.energy(), z.as_ref());
        let before = gram_diagonal(&z, &image);
        let floor: Vec<f64> =
            before.iter().map(|b| (tolerance * tolerance).max(ROUND_OFF * ROUND_OFF * b)).collect();
        for _ in 0..2 {
            self.project_out(z.as_mut(), image.as_ref());
            image = times(self.energy(), z.as_ref());
        }
        let mut energy = gram(z.as_ref(), image.as_ref());
        let open = pivoted_choice(&mut energy, &floor, limit);
        self.orthonormal(&z, &image, open)
    }

    /// Adds the principal directions of the columns of `z` in the E-norm, once the basis is projected out, that are larger
    /// than `tolerance`.
    fn append_principal(&mut self, z: &Mat<f64>, tolerance: f64) {
        let (m, count) = (self.len(), z.ncols());
        let (mut share, mut energy) = (Mat::<f64>::zeros(m, count), Mat::<f64>::zeros(count, count));
        for (start, width) in panels(0..count) {
            let image = times(self.energy(), z.subcols(start, width));
            share.subcols_mut(start, width).copy_from(self.columns().gram(image.as_ref()));
            let below = gram(z.subcols(start, count - start), image.as_ref());
            energy.submatrix_mut(start, start, count - start, width).copy_from(below);
        }
        self.append_directions(z.as_ref(), &share, energy, tolerance);
    }

    /// [`Basis::append_principal`] for columns that are E-orthogonal to the first `free` vectors of the basis, given E z. Says
    /// which combinations of the columns, of length one, were added but for what the basis had of them.
    pub(super) fn append_new(
        &mut self,
        z: MatRef<'_, f64>,
        image: MatRef<'_, f64>,
        free: usize,
        tolerance: f64,
    ) -> Mat<f64> {
        let share = self.columns().range(free..self.len()).gram(image);
        self.append_directions(z, &share, gram(z, image), tolerance)
    }

    /// Adds principal directions of z, given bᵀEz for the last vectors b of the basis and zᵀEz: by the eigenvalues of the latter
    /// less what the basis has of it, which is a small matrix. The difference is right to 1e-16 of the largest column, and the
    /// directions to what that is of their own size: they need not be orthogonal, as the projections are those of the
    /// vectors as they come out.
    fn append_directions(
        &mut self,
        z: MatRef<'_, f64>,
        share: &Mat<f64>,
        mut energy: Mat<f64>,
        tolerance: f64,
    ) -> Mat<f64> {
        const DIGITS_LEFT: f64 = 1e-14;
        let (m, first, count, added) =
            (self.len(), self.len() - share.nrows(), z.ncols(), self.added.ncols());
        let largest = (0..count).fold(0.0f64, |l, j| l.max(energy[(j, j)]));
        let weighted =
            Mat::from_fn(share.nrows(), count, |i, j| share[(i, j)] * self.inverse_size(first + i));
        energy -= product(share.transpose(), weighted.as_ref());
        let Ok((sizes, directions)) = symmetric_eigen(energy.as_ref()) else { return Mat::zeros(count, 0) };
        let floor = (tolerance * tolerance).max(DIGITS_LEFT * largest);
        let large = (0..sizes.len()).rev().filter(|j| sizes[*j] > floor);
        let kept: Vec<usize> = large.take(self.free()).collect();
        let directions = Mat::from_fn(count, kept.len(), |i, k| directions[(i, kept[k])]);
        let mix =
            Mat::from_fn(count, kept.len(), |i, k| directions[(i, k)] * (self.tau / sizes[kept[k]]).sqrt());
        let known = product(weighted.as_ref(), mix.as_ref());
        self.added.resize_with(z.nrows(), added + kept.len(), |_, _| 0.0);
        let (before, mut new) = self.added.as_mut().split_at_col_mut(added);
        combine(new.as_mut(), Accum::Replace, z, mix.as_ref(), 1.0);
        let basis = Columns::of([self.modes, before.as_ref()]);
        basis.range(first..m).combine(new, known.as_ref(), Accum::Add, -1.0);
        self.project();
        directions
    }

    /// 1 / bᵢᵀEbᵢ; zero for a mode on which E vanishes, just as stiff as −τ, which E cannot distinguish.
    fn inverse_size(&self, i: usize) -> f64 {
        if self.sizes[i].abs() > 1e-9 * self.tau { 1.0 / self.sizes[i] } else { 0.0 }
    }

    /// z ← z − B (BᵀEB)⁻¹Bᵀ E z, given E z.
    fn project_out(&self, z: MatMut<'_, f64>, image: MatRef<'_, f64>) {
        let mut share = self.columns().gram(image);
        for i in 0..self.len() {
            let factor = self.inverse_size(i);
            (0..share.ncols()).for_each(|j| share[(i, j)] *= factor);
        }
        self.columns().combine(z, share.as_ref(), Accum::Add, -1.0);
    }

    /// The columns `open` of `z`, which are E-orthogonal to the basis, made E/τ-orthonormal; `image` is E z. A panel at
    /// a time they are projected and their Gram matrix factorised, twice. Left out are those of which nothing is left;
    /// those that lie within a thousandth in the span of the others of their panel wait for the next one.
    fn orthonormal(&self, z: &Mat<f64>, image: &Mat<f64>, mut open: Vec<usize>) -> Mat<f64> {
        let n = z.nrows();
        let (mut new, mut new_image) = (Mat::<f64>::zeros(n, open.len()), Mat::<f64>::zeros(n, open.len()));
        let mut done = 0;
        while !open.is_empty() {
            let now: Vec<usize> = open.drain(..open.len().min(PANEL)).collect();
            let (mut x, mut ex) = (picked(z, &now), picked(image, &now));
            let (mut kept, mut later): (Vec<usize>, Vec<usize>) = (now, Vec::new());
            let mut before: Vec<f64> = gram_diagonal(&x, &ex).iter().map(|v| v / self.tau).collect();
            for _ in 0..2 {
                let (found, images) = (new.subcols(0, done), new_image.subcols(0, done));
                let mut share = gram(found, ex.as_ref());
                share *= faer::Scale(1.0 / self.tau);
                combine(x.as_mut(), Accum::Add, found, share.as_ref(), -1.0);
                combine(ex.as_mut(), Accum::Add, images, share.as_ref(), -1.0);
                self.project_out(x.as_mut(), ex.as_ref());
                ex = times(self.energy(), x.as_ref());
                let mut square = gram(x.as_ref(), ex.as_ref());
                square *= faer::Scale(1.0 / self.tau);
                let (mix, stay, alike) = orthonormalising(&square, &before);
                later.extend(alike.iter().map(|j| kept[*j]));
                kept = stay.iter().map(|j| kept[*j]).collect();
                (x, ex) = (expand(x.as_ref(), mix.as_ref()), expand(ex.as_ref(), mix.as_ref()));
                before = vec![1.0; kept.len()];
            }
            // Columns too much like others of the panel: once those are taken, more of them can be seen.
            if !kept.is_empty() {
                new.subcols_mut(done, kept.len()).copy_from(&x);
                new_image.subcols_mut(done, kept.len()).copy_from(&ex);
                done += kept.len();
                open.splice(..0, later);
            }
        }
        new.subcols(0, done).to_owned()
    }

    /// The real modes and E/τ-orthonormal combinations Z `mix` of the vectors added to them.
    pub(super) fn combined(&self, mix: MatRef<'_, f64>) -> Self {
        let whole = beside_modes(self.n_real(), mix);
        let form = |a: &Mat<f64>| product(whole.transpose(), product(a.as_ref(), whole.as_ref()).as_ref());
        let (mass, stiffness) = (form(&self.mass), form(&self.stiffness));
        Basis {
            operator: self.operator,
            energy: OnceLock::new(),
            tau: self.tau,
            sizes: (0..whole.ncols()).map(|j| stiffness[(j, j)] + self.tau * mass[(j, j)]).collect(),
            modes: self.modes,
            added: expand(self.added.as_ref(), mix),
            damping: form(&self.damping),
            hysteretic: self.hysteretic.as_ref().map(form),
            skew: self.skew.as_ref().map(|parts| parts.each_ref().map(form)),
            interface: product(whole.transpose(), self.interface.as_ref()),
            mass,
            stiffness,
        }
    }

    /// Adds vectors and their projections.
    fn append(&mut self, new: MatRef<'_, f64>) {
        append(&mut self.added, new);
        self.project();
    }

    /// Projects what has come to the vectors since the last time: the real modes, or some that were added.
    fn project(&mut self) {
        let (old, m, n_real) = (self.sizes.len(), self.len(), self.n_real());
        // Columns of the four projections, down to their diagonals: the rest follows from symmetry.
        let mut borders = [(); 4].map(|()| Mat::<f64>::zeros(m, m - old));
        let mut skew = self.operator.skew.map(|_| [(); 2].map(|()| Mat::<f64>::zeros(m, m - old)));
        let mut images = Vec::new();
        for (start, width) in panels(old..m) {
            let known = || self.columns().range(0..start + width);
            let new = match start < n_real {
                true => self.modes.subcols(start, width),
                false => self.added.subcols(start - n_real, width),
            };
            let forms = self.operator.forms(known(), new, &mut images);
            for (border, form) in borders.iter_mut().zip(forms) {
                border.submatrix_mut(0, start - old, start + width, width).copy_from(form);
            }
            for (border, form) in skew.iter_mut().flatten().zip(self.operator.skew_between(known(), new)) {
                border.submatrix_mut(0, start - old, start + width, width).copy_from(form);
            }
        }
        let grow = |small: &Mat<f64>, border: &Mat<f64>| {
            Mat::from_fn(m, m, |i, j| {
                let (i, j) = (i.min(j), i.max(j));
                if j < old { small[(i, j)] } else { border[(i, j - old)] }
            })
        };
        let grow_skew = |small: &Mat<f64>, border: &Mat<f64>| {
            Mat::from_fn(m, m, |i, j| match (i.max(j) < old, i <= j) {
                (true, _) => small[(i, j)],
                (_, true) => border[(i, j - old)],
                (_, false) => -border[(j, i - old)],
            })
        };
        if let (Some(small), Some(border)) = (&mut self.skew, &skew) {
            *small = [0, 1].map(|k| grow_skew(&small[k], &border[k]));
        }
        let [mass, stiffness, damping, loss] = &borders;
        self.mass = grow(&self.mass, mass);
        self.stiffness = grow(&self.stiffness, stiffness);
        self.damping = grow(&self.damping, damping);
        self.hysteretic = self.hysteretic.as_ref().map(|small| grow(small, loss));
        let directions = &self.operator.interface.directions;
        let columns = self.columns();
        self.interface = Mat::from_fn(m, directions.len(), |i, d| {
            if i < old { self.interface[(i, d)] } else { directions[d].dot(columns.column(i)) }
        });
        self.sizes.extend((old..m).map(|j| self.stiffness[(j, j)] + self.tau * self.mass[(j, j)]));
    }
}

/// \[1 0; 0 `mix`\], which leaves the first `count` vectors as they are.
fn beside_modes(count: usize, mix: MatRef<'_, f64>) -> Mat<f64> {
    let mut whole = Mat::zeros(count + mix.nrows(), count + mix.ncols());
    (0..count).for_each(|i| whole[(i, i)] = 1.0);
    whole.submatrix_mut(count, count, mix.nrows(), mix.ncols()).copy_from(mix);
    whole
}

/// Some columns of a matrix.
fn picked(a: &Mat<f64>, columns: &[usize]) -> Mat<f64> {
    let mut picked = Mat::zeros(a.nrows(), columns.len());
    columns.iter().enumerate().for_each(|(k, j)| picked.col_mut(k).copy_from(a.col(*j)));
    picked
}

/// xⱼᵀyⱼ of every column.
fn gram_diagonal(x: &Mat<f64>, y: &Mat<f64>) -> Vec<f64> {
    let dot = |j: usize| x.col_as_slice(j).iter().zip(y.col_as_slice(j)).map(|(a, b)| a * b).sum();
    (0..x.ncols()).map(dot).collect()
}

/// Matrix that makes columns with this Gram matrix orthonormal, one column for each that stays; the columns that stay; and those
/// that depend on them. `before` are the squares of their lengths before projection against the known columns.
fn orthonormalising(square: &Mat<f64>, before: &[f64]) -> (Mat<f64>, Vec<usize>, Vec<usize>) {
    const LOST: f64 = 1e-12;
    const ALIKE: f64 = 1e-3;
    let m = square.nrows();
    let (mut stay, mut alike): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
    // Rows of the Cholesky factor of the Gram matrix of the columns that stay, each column scaled to length one.
    let mut factor = Mat::<f64>::zeros(m, m);
    for j in 0..m {
        let own = square[(j, j)];
        if !(own > LOST * LOST * before[j] && own.is_finite()) {
            continue;
        }
        let row = stay.len();
        for (c, other) in stay.iter().enumerate() {
            let cosine = square[(j, *other)] / (own * square[(*other, *other)]).sqrt();
            let known: f64 = (0..c).map(|k| factor[(row, k)] * factor[(c, k)]).sum();
            factor[(row, c)] = (cosine - known) / factor[(c, c)];
        }
        let left = 1.0 - (0..row).map(|k| factor[(row, k)].powi(2)).sum::<f64>();
        if left > ALIKE * ALIKE {
            factor[(row, row)] = left.sqrt();
            stay.push(j);
        } else {
            alike.push(j);
        }
    }
    let r = stay.len();
    // L⁻ᵀ, which makes the scaled columns orthonormal.
    let mut turned = Mat::<f64>::identity(r, r);
    solve_upper_triangular_in_place(factor.submatrix(0, 0, r, r).transpose(), turned.as_mut(), Par::Seq);
    let mut mix = Mat::<f64>::zeros(m, r);
    for (c, j) in stay.iter().enumerate() {
        let length = square[(*j, *j)].sqrt();
        (0..r).for_each(|k| mix[(*j, k)] = turned[(c, k)] / length);
    }
    (mix, stay, alike)
}

/// Columns in the order of a pivoted Cholesky factorisation of their Gram matrix, which is overwritten.
fn pivoted_choice(gram: &mut Mat<f64>, floor: &[f64], limit: usize) -> Vec<usize> {
    let n = gram.nrows();
    let mut chosen = Vec::new();
    let mut open: Vec<usize> = (0..n).collect();
    while chosen.len() < limit {
        open.retain(|j| gram[(*j, *j)] > floor[*j]);
        // The first of equals, so that the choice does not depend on anything but the numbers.
        let Some(best) = open.iter().copied().reduce(|a, b| if gram[(b, b)] > gram[(a, a)] { b } else { a })
        else {
            break;
        };
        open.retain(|j| *j != best);
        let pivot = gram[(best, best)];
        for j in &open {
            let factor = gram[(best, *j)] / pivot;
            for i in &open {
                gram[(*i, *j)] -= gram[(*i, best)] * factor;
            }
        }
        chosen.push(best);
    }
    chosen
}
