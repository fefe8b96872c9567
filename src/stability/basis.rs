//! The subspace that the quadratic problem is projected on, grown by what the full order asks for.

use super::block::Block;
use super::operator::Operator;
use crate::linalg::sparse::times;
use crate::linalg::tall::{expand, gram};
use faer::{Mat, MatRef};

/// A basis B = \[Φ Z\] and the projections BᵀMB, BᵀCB, BᵀKB, BᵀHB, and BᵀW of the interface.
///
/// The real modes are M-orthonormal, what is added to them is M-orthogonal to them and orthonormal in E/τ: there, above
/// the modes, E is positive also where M is singular or K indefinite, and no direction without mass is lost.
pub(super) struct Basis<'a> {
    operator: &'a Operator<'a>,
    /// E = K + τ M measures how much a direction can matter in the band.
    tau: f64,
    /// Columns of Φ.
    modes: usize,
    pub(super) vectors: Mat<f64>,
    /// M B, K B, C B, H B: what the full order makes of the basis, kept so that a residual costs dense products only.
    mass_times: Mat<f64>,
    stiffness_times: Mat<f64>,
    damping_times: Option<Mat<f64>>,
    hysteretic_times: Option<Mat<f64>>,
    pub(super) mass: Mat<f64>,
    pub(super) damping: Mat<f64>,
    pub(super) stiffness: Mat<f64>,
    pub(super) hysteretic: Option<Mat<f64>>,
    /// BᵀW: one row a basis vector, one column a direction of the interface.
    pub(super) interface: Mat<f64>,
}

/// Complex vectors with what M, K, C and H make of them.
pub(super) struct Images {
    pub(super) vectors: Block,
    pub(super) inertia: Block,
    pub(super) elastic: Block,
    pub(super) damped: Option<Block>,
    pub(super) lossy: Option<Block>,
}

impl Images {
    /// Scales every column so that xᴴMx = 1.
    pub(super) fn normalise(mut self) -> Self {
        for j in 0..self.vectors.ncols() {
            let factor = 1.0 / self.vectors.dot(j, &self.inertia).re.sqrt();
            self.vectors.scale_column(j, factor);
            self.inertia.scale_column(j, factor);
            self.elastic.scale_column(j, factor);
            self.damped.iter_mut().chain(&mut self.lossy).for_each(|block| block.scale_column(j, factor));
        }
        self
    }
}

impl<'a> Basis<'a> {
    /// Starts from M-orthonormal real modes.
    pub(super) fn new(operator: &'a Operator<'a>, modes: MatRef<'_, f64>, tau: f64) -> Self {
        let n = operator.n();
        let mut basis = Basis {
            operator,
            tau,
            modes: modes.ncols(),
            vectors: Mat::zeros(n, 0),
            mass_times: Mat::zeros(n, 0),
            stiffness_times: Mat::zeros(n, 0),
            damping_times: None,
            hysteretic_times: None,
            mass: Mat::zeros(0, 0),
            damping: Mat::zeros(0, 0),
            stiffness: Mat::zeros(0, 0),
            hysteretic: operator.damping.hysteretic.as_ref().map(|_| Mat::zeros(0, 0)),
            interface: Mat::zeros(0, operator.interface.directions.len()),
        };
        basis.append(modes.to_owned());
        basis
    }

    pub(super) fn len(&self) -> usize {
        self.vectors.ncols()
    }

    /// x = B y of every column of `y`, with M x, K x, C x and H x.
    pub(super) fn images(&self, y: &Block) -> Images {
        let of = |times: &Mat<f64>| y.map(|y| expand(times.as_ref(), y.as_ref()));
        Images {
            vectors: of(&self.vectors),
            inertia: of(&self.mass_times),
            elastic: of(&self.stiffness_times),
            damped: self.damping_times.as_ref().map(of),
            lossy: self.hysteretic_times.as_ref().map(of),
        }
    }

    /// Adds the directions of `z` that are new: after the basis is projected out, the columns are taken in the order
    /// of their remaining size in the E-norm, until it is below `tolerance` (or round-off of where the column
    /// started), or `limit` are taken. Returns how many were added.
    pub(super) fn enrich(&mut self, mut z: Mat<f64>, tolerance: f64, limit: usize) -> usize {
        const ROUND_OFF: f64 = 1e-10;
        let before = self.energy(z.as_ref());
        self.project_out(&mut z);
        self.project_out(&mut z);
        let mut energy = self.energy(z.as_ref());
        let floor: Vec<f64> = (0..z.ncols())
            .map(|j| (tolerance * tolerance).max(ROUND_OFF * ROUND_OFF * before[(j, j)]))
            .collect();
        let chosen = pivoted_choice(&mut energy, &floor, limit);
        let mut new = Mat::<f64>::zeros(z.nrows(), chosen.len());
        let mut added = 0;
        for j in chosen {
            let mut column = z.subcols(j, 1).to_owned();
            if self.normalise_against(&mut column, new.subcols(0, added)) {
                new.subcols_mut(added, 1).copy_from(&column);
                added += 1;
            }
        }
        if added > 0 {
            self.append(new.subcols(0, added).to_owned());
        }
        added
    }

    /// zᵀ(K + τM)z.
    fn energy(&self, z: MatRef<'_, f64>) -> Mat<f64> {
        gram(z, self.energy_times(z, times(self.operator.mass, z).as_ref()).as_ref())
    }

    /// (K + τM) z, given M z.
    fn energy_times(&self, z: MatRef<'_, f64>, inertia: MatRef<'_, f64>) -> Mat<f64> {
        let mut e = times(&self.operator.stiffness, z);
        e += faer::Scale(self.tau) * inertia;
        e
    }

    /// z ← z − Φ ΦᵀM z − Z ZᵀE z / τ.
    fn project_out(&self, z: &mut Mat<f64>) {
        let inertia = times(self.operator.mass, z.as_ref());
        let modes = self.vectors.subcols(0, self.modes);
        let mut change = expand(modes, gram(modes, inertia.as_ref()).as_ref());
        if self.len() > self.modes {
            let energy = self.energy_times(z.as_ref(), inertia.as_ref());
            let added = self.vectors.subcols(self.modes, self.len() - self.modes);
            let share = faer::Scale(1.0 / self.tau) * gram(added, energy.as_ref());
            change += expand(added, share.as_ref());
        }
        *z -= change;
    }

    /// E/τ-orthonormalises `column` against the basis and the `new` vectors; false when nothing is left.
    fn normalise_against(&self, column: &mut Mat<f64>, new: MatRef<'_, f64>) -> bool {
        const LOST: f64 = 1e-12;
        for _ in 0..2 {
            let energy_times = |z: &Mat<f64>| {
                let inertia = times(self.operator.mass, z.as_ref());
                faer::Scale(1.0 / self.tau) * self.energy_times(z.as_ref(), inertia.as_ref())
            };
            let energy = energy_times(column);
            let square = gram(column.as_ref(), energy.as_ref())[(0, 0)];
            if !(square.is_finite() && square > 0.0) {
                return false;
            }
            let share = gram(new, energy.as_ref());
            *column -= expand(new, share.as_ref());
            self.project_out(column);
            let left = gram(column.as_ref(), energy_times(column).as_ref())[(0, 0)];
            if left.is_nan() || left <= LOST * LOST * square {
                return false;
            }
            *column *= faer::Scale(1.0 / left.sqrt());
        }
        true
    }

    fn append(&mut self, new: Mat<f64>) {
        let old = self.len();
        let inertia = times(self.operator.mass, new.as_ref());
        let elastic = times(&self.operator.stiffness, new.as_ref());
        let damped = self.operator.damping_times(new.as_ref());
        let lossy = self.operator.damping.hysteretic.as_ref().map(|h| times(h, new.as_ref()));
        self.vectors = beside(&self.vectors, &new);
        self.mass_times = beside(&self.mass_times, &inertia);
        self.stiffness_times = beside(&self.stiffness_times, &elastic);
        let extend = |old: &Option<Mat<f64>>, new: &Option<Mat<f64>>| {
            let n = self.vectors.nrows();
            new.as_ref().map(|new| beside(old.as_ref().unwrap_or(&Mat::zeros(n, 0)), new))
        };
        self.damping_times = extend(&self.damping_times, &damped);
        self.hysteretic_times = extend(&self.hysteretic_times, &lossy);
        let grow = |small: &Mat<f64>, times: &Mat<f64>| {
            let border = gram(self.vectors.as_ref(), times.as_ref());
            let m = border.nrows();
            Mat::from_fn(m, m, |i, j| match (i < old, j < old) {
                (true, true) => small[(i, j)],
                (_, false) => border[(i, j - old)],
                (false, true) => border[(j, i - old)],
            })
        };
        self.mass = grow(&self.mass, &inertia);
        self.stiffness = grow(&self.stiffness, &elastic);
        self.damping = match &damped {
            Some(times) => grow(&self.damping, times),
            None => Mat::zeros(self.vectors.ncols(), self.vectors.ncols()),
        };
        self.hysteretic =
            self.hysteretic.as_ref().zip(lossy.as_ref()).map(|(small, times)| grow(small, times));
        let directions = &self.operator.interface.directions;
        self.interface = Mat::from_fn(self.vectors.ncols(), directions.len(), |i, d| {
            if i < old { self.interface[(i, d)] } else { directions[d].dot(new.col_as_slice(i - old)) }
        });
    }
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

fn beside(a: &Mat<f64>, b: &Mat<f64>) -> Mat<f64> {
    let mut both = Mat::zeros(b.nrows(), a.ncols() + b.ncols());
    both.subcols_mut(0, a.ncols()).copy_from(a);
    both.subcols_mut(a.ncols(), b.ncols()).copy_from(b);
    both
}
