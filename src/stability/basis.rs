//! The subspace that the quadratic problem is projected on, grown by what the full order asks for.

use super::block::Block;
use super::operator::Operator;
use crate::linalg::sparse::times;
use crate::linalg::tall::{expand, gram};
use faer::{Mat, MatRef};

/// Columns that are orthonormalised together.
const PANEL: usize = 32;

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
    pub(super) mass_times: Mat<f64>,
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

/// What an enrichment came to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Enriched {
    /// The directions that were added.
    pub(super) added: usize,
    /// The squared E-norms, added up, of what the basis still misses of the columns that were not taken.
    pub(super) left_out: f64,
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
    /// started), or `limit` are taken.
    pub(super) fn enrich(&mut self, mut z: Mat<f64>, tolerance: f64, limit: usize) -> Enriched {
        const ROUND_OFF: f64 = 1e-10;
        let before = self.energy(z.as_ref());
        self.project_out(&mut z);
        self.project_out(&mut z);
        let mut energy = self.energy(z.as_ref());
        let floor: Vec<f64> = (0..z.ncols())
            .map(|j| (tolerance * tolerance).max(ROUND_OFF * ROUND_OFF * before[(j, j)]))
            .collect();
        let mut open = pivoted_choice(&mut energy, &floor, limit);
        let left_out = (0..z.ncols()).filter(|j| !open.contains(j)).map(|j| energy[(j, j)].max(0.0)).sum();
        let first = self.len();
        while !open.is_empty() {
            let now: Vec<usize> = open.drain(..open.len().min(PANEL)).collect();
            let columns = Mat::from_fn(z.nrows(), now.len(), |i, j| z[(i, now[j])]);
            let (new, later) = self.orthonormal(columns);
            // Columns too much like others of the panel: once those are in the basis, more of them can be seen.
            if new.ncols() > 0 {
                open.splice(..0, later.iter().map(|j| now[*j]));
                self.append(new);
            }
        }
        Enriched { added: self.len() - first, left_out }
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

    /// The columns E/τ-orthonormalised against the basis and each other, by two rounds of projection and Cholesky
    /// factorisation of their Gram matrix. Left out are those of which nothing is left, and, returned as indices,
    /// those that lie within a thousandth in the span of the others.
    fn orthonormal(&self, mut columns: Mat<f64>) -> (Mat<f64>, Vec<usize>) {
        const LOST: f64 = 1e-12;
        const ALIKE: f64 = 1e-3;
        let energy = |z: &Mat<f64>| faer::Scale(1.0 / self.tau) * self.energy(z.as_ref());
        let before = energy(&columns);
        let (mut kept, mut later): (Vec<usize>, Vec<usize>) = ((0..columns.ncols()).collect(), Vec::new());
        for round in 0..2 {
            self.project_out(&mut columns);
            let gram = energy(&columns);
            let m = columns.ncols();
            // Rows of the Cholesky factor of the Gram matrix of the columns that stay, each column scaled to length one.
            let mut stay: Vec<usize> = Vec::new();
            let mut factor = Mat::<f64>::zeros(m, m);
            for j in 0..m {
                let square = gram[(j, j)];
                let was = if round == 0 { before[(j, j)] } else { 1.0 };
                if !(square > LOST * LOST * was && square.is_finite()) {
                    continue;
                }
                let row = stay.len();
                for (c, other) in stay.iter().enumerate() {
                    let cosine = gram[(j, *other)] / (square * gram[(*other, *other)]).sqrt();
                    let known: f64 = (0..c).map(|k| factor[(row, k)] * factor[(c, k)]).sum();
                    factor[(row, c)] = (cosine - known) / factor[(c, c)];
                }
                let left = 1.0 - (0..row).map(|k| factor[(row, k)].powi(2)).sum::<f64>();
                if left > ALIKE * ALIKE {
                    factor[(row, row)] = left.sqrt();
                    stay.push(j);
                } else {
                    later.push(kept[j]);
                }
            }
            let r = stay.len();
            // L⁻ᵀ, which makes the scaled columns orthonormal.
            let mut turned = Mat::<f64>::identity(r, r);
            factor
                .as_ref()
                .submatrix(0, 0, r, r)
                .transpose()
                .solve_upper_triangular_in_place(turned.as_mut());
            let mut mix = Mat::<f64>::zeros(m, r);
            for (c, j) in stay.iter().enumerate() {
                let length = gram[(*j, *j)].sqrt();
                (0..r).for_each(|k| mix[(*j, k)] = turned[(c, k)] / length);
            }
            columns = expand(columns.as_ref(), mix.as_ref());
            kept = stay.iter().map(|j| kept[*j]).collect();
            if round == 0 && r == 0 {
                break;
            }
        }
        (columns, later)
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
