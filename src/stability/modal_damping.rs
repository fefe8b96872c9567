//! How modal damping C = M Φ diag(2ζω) Φᵀ M answers a change of the structure: the real modes Φ, ω move with it.
//!
//! With all real modes φⱼ, F = Σ f(θⱼ) φⱼφⱼᵀ and θ = ω², C is M F M, where f = 2ζω for the modes in C and 0 for the rest.
//! For a change δK, δM (Daleckii and Krein's formula for a symmetric pencil)
//!
//! φⱼᵀ M δF M φₖ = f\[θⱼ,θₖ\] φⱼᵀδKφₖ − (θf)\[θⱼ,θₖ\] φⱼᵀδMφₖ,   f\[x,y\] = (f(x) − f(y))/(x − y),
//!
//! and f′ where x = y. Double modes need no care: between modes of one ζ, f\[x,y\] = 2ζ/(ωⱼ + ωₖ). The rest of the modes
//! enters only by what φ and ψ have of them; a few block Krylov steps on those parts give Ritz vectors that represent
//! them, and nothing else of the spectrum is needed.

use crate::dynamics::{Block, Operator};
use crate::error::Result;
use crate::linalg::dense::symmetric_eigen;
use crate::linalg::multivector::{beside, expand, gram};
use crate::linalg::sparse::times;
use crate::linalg::{SparseMatrix, SparseVector, SymmetricFactor, c64};
use crate::modal::RealModes;
use crate::system::ModalDamping;
use faer::{Mat, MatRef};

/// Krylov blocks for the rest of the spectrum. Each gains about a decade where the modes in C reach well above the band.
const BLOCKS: usize = 10;

/// The linear form (δK, δM) → ψᴴ δC φ of every chosen mode.
pub(super) struct ModalChange {
    /// E: the modes in C, then the Ritz vectors of the rest; M-orthonormal.
    shapes: Mat<f64>,
    /// How many of the columns of E are in C.
    inside: usize,
    /// φ, ψ, F M φ and F M ψ.
    phi: Block,
    psi: Block,
    damped_phi: Block,
    damped_psi: Block,
    /// For each complex mode two complex matrices, columns of E × modes in C: ψᴴδCφ has the parts Σ Wⱼₖ φⱼᵀδKφₖ …
    by_stiffness: Vec<Block>,
    /// … and Σ Wⱼₖ φⱼᵀδMφₖ.
    by_mass: Vec<Block>,
}

impl ModalChange {
    /// Prepares the form for the modes with the vectors `phi` and `psi`; `factor` is one of K + K_σ − s M.
    pub(super) fn new(
        operator: &Operator<'_>,
        real: &RealModes,
        damping: &ModalDamping,
        factor: &dyn SymmetricFactor,
        phi: &Block,
        psi: &Block,
    ) -> Result<Self> {
        let inside = real.len();
        let amplitudes = |x: &Block| x.map(|x| gram(damping.basis.as_ref(), x));
        let (a, b) = (amplitudes(phi), amplitudes(psi));
        let (rest, ritz) = rest_of_spectrum(operator, real, &damping.basis, factor, [phi, psi])?;
        let momenta = times(operator.mass, rest.as_ref());
        let extend = |x: &Block, inner: &Block| {
            inner.map(|inner| above(inner, gram(momenta.as_ref(), x.parts()).as_ref()))
        };
        let (all_a, all_b) = (extend(phi, &a), extend(psi, &b));
        let spectrum = DampedModes {
            omega: real.eigenvalues.iter().chain(&ritz).map(|w| w.max(0.0).sqrt()).collect(),
            f: damping.coefficients.iter().copied().chain(ritz.iter().map(|_| 0.0)).collect(),
        };
        let mut form = ModalChange {
            shapes: beside(real.shapes.as_ref(), rest.as_ref()),
            inside,
            phi: phi.clone(),
            psi: psi.clone(),
            damped_phi: filtered(real, damping, &a),
            damped_psi: filtered(real, damping, &b),
            by_stiffness: Vec::new(),
            by_mass: Vec::new(),
        };
        for i in 0..phi.ncols() {
            let weigh = |kernel: &dyn Fn(usize, usize) -> f64| {
                let total = spectrum.omega.len();
                let pair = |j: usize, k: usize| all_b.get(j, i).conj() * all_a.get(k, i);
                // A pair with one mode outside also represents its transpose, which is not among (j, k).
                let both = |j, k| if j < inside { pair(j, k) } else { pair(j, k) + pair(k, j) };
                Block::from_fn(total, inside, |j, k| both(j, k) * kernel(j, k))
            };
            form.by_stiffness.push(weigh(&|j, k| spectrum.difference(j, k)));
            form.by_mass.push(weigh(&|j, k| -spectrum.weighted_difference(j, k)));
        }
        Ok(form)
    }

    /// ψᴴ δC φ of every mode.
    pub(super) fn of_matrices(&self, dk: Option<&SparseMatrix>, dm: Option<&SparseMatrix>) -> Vec<c64> {
        let inside = self.shapes.subcols(0, self.inside);
        let projected = |d: &SparseMatrix| gram(self.shapes.as_ref(), times(d, inside).as_ref());
        let mut sums = vec![c64::new(0.0, 0.0); self.phi.ncols()];
        let mut add = |weights: &[Block], small: Mat<f64>| {
            for (sum, w) in sums.iter_mut().zip(weights) {
                *sum += entrywise(w, &small);
            }
        };
        if let Some(dk) = dk {
            add(&self.by_stiffness, projected(dk));
        }
        if let Some(dm) = dm {
            add(&self.by_mass, projected(dm));
            let of = |x: &Block| x.map(|x| times(dm, x));
            let (phi, damped_phi) = (of(&self.phi), of(&self.damped_phi));
            for (i, sum) in sums.iter_mut().enumerate() {
                *sum += self.psi.dot(i, &damped_phi) + self.damped_psi.dot(i, &phi);
            }
        }
        sums
    }

    /// ψᴴ δC φ of every mode for δK = d dᵀ and for δM = d dᵀ, with every row d: \[mode\]\[row\].
    pub(super) fn of_rows(&self, rows: &[SparseVector]) -> Vec<Vec<[c64; 2]>> {
        let total = self.shapes.ncols();
        let mut seen = Mat::<f64>::zeros(rows.len(), total);
        for (r, row) in rows.iter().enumerate() {
            for (i, v) in row.iter() {
                (0..total).for_each(|j| seen[(r, j)] += v * self.shapes[(i, j)]);
            }
        }
        let inner = seen.subcols(0, self.inside);
        let quadratic = |weights: &Block| -> Vec<c64> {
            let seen = weights.map(|weights| expand(seen.as_ref(), weights));
            (0..rows.len()).map(|r| (0..self.inside).map(|k| seen.get(r, k) * inner[(r, k)]).sum()).collect()
        };
        (0..self.phi.ncols())
            .map(|i| {
                let (by_k, by_m) = (quadratic(&self.by_stiffness[i]), quadratic(&self.by_mass[i]));
                let at = |r: usize| {
                    let of = |x: &Block| x.along(i, &rows[r]);
                    let direct = of(&self.psi).conj() * of(&self.damped_phi)
                        + of(&self.damped_psi).conj() * of(&self.phi);
                    [by_k[r], by_m[r] + direct]
                };
                (0..rows.len()).map(at).collect()
            })
            .collect()
    }
}

/// ω and f = 2ζω of the modes in C, then of the rest, where f = 0.
struct DampedModes {
    omega: Vec<f64>,
    f: Vec<f64>,
}

impl DampedModes {
    /// 2ζ, when both modes have the same.
    fn common(&self, j: usize, k: usize) -> Option<f64> {
        let ratio = |i: usize| if self.omega[i] > 0.0 { self.f[i] / self.omega[i] } else { 0.0 };
        let close = (self.omega[j] - self.omega[k]).abs() <= 1e-9 * self.omega[j];
        let (x, y) = (ratio(j), ratio(k));
        // Two ratios at one frequency leave C without a derivative: their mean is as good as any.
        (close || (x - y).abs() <= 1e-12 * x.abs()).then_some(0.5 * (x + y))
    }

    /// f\[θⱼ,θₖ\].
    fn difference(&self, j: usize, k: usize) -> f64 {
        let (x, y) = (self.omega[j], self.omega[k]);
        match self.common(j, k) {
            _ if x + y == 0.0 => 0.0,
            Some(twice) => twice / (x + y),
            None => (self.f[j] - self.f[k]) / (x * x - y * y),
        }
    }

    /// (θf)\[θⱼ,θₖ\].
    fn weighted_difference(&self, j: usize, k: usize) -> f64 {
        let (x, y) = (self.omega[j], self.omega[k]);
        match self.common(j, k) {
            _ if x + y == 0.0 => 0.0,
            Some(twice) => twice * (x * x + x * y + y * y) / (x + y),
            None => (x * x * self.f[j] - y * y * self.f[k]) / (x * x - y * y),
        }
    }
}

/// Φ diag(f) a.
fn filtered(real: &RealModes, damping: &ModalDamping, a: &Block) -> Block {
    a.map(|a| {
        let scaled = Mat::from_fn(a.nrows(), a.ncols(), |k, i| damping.coefficients[k] * a[(k, i)]);
        expand(real.shapes.as_ref(), scaled.as_ref())
    })
}

/// Ritz vectors and values of K + K_σ outside the modes in C, from the parts of φ and ψ out there.
fn rest_of_spectrum(
    operator: &Operator<'_>,
    real: &RealModes,
    momenta: &Mat<f64>,
    factor: &dyn SymmetricFactor,
    [phi, psi]: [&Block; 2],
) -> Result<(Mat<f64>, Vec<f64>)> {
    let n = operator.n();
    let mut block = beside(phi.parts(), psi.parts());
    let mut found = Mat::<f64>::zeros(n, 0);
    let mut found_momenta = Mat::<f64>::zeros(n, 0);
    for step in 0..=BLOCKS {
        let before = squares(operator, &block);
        // Twice is enough: what the first pass leaves is round-off of what it took away.
        for _ in 0..2 {
            block -= expand(real.shapes.as_ref(), gram(momenta.as_ref(), block.as_ref()).as_ref());
            block -= expand(found.as_ref(), gram(found_momenta.as_ref(), block.as_ref()).as_ref());
        }
        let new = orthonormal(operator, block, &before)?;
        if new.ncols() == 0 {
            break;
        }
        let inertia = times(operator.mass, new.as_ref());
        found = beside(found.as_ref(), new.as_ref());
        found_momenta = beside(found_momenta.as_ref(), inertia.as_ref());
        if step == BLOCKS {
            break;
        }
        block = inertia;
        factor.solve_in_place(block.as_mut());
    }
    let elastic = gram(found.as_ref(), times(&operator.stiffness, found.as_ref()).as_ref());
    let (ritz, rotation) = symmetric_eigen(elastic.as_ref())?;
    Ok((expand(found.as_ref(), rotation.as_ref()), ritz))
}

/// xᵀMx of every column.
fn squares(operator: &Operator<'_>, x: &Mat<f64>) -> Vec<f64> {
    let inertia = times(operator.mass, x.as_ref());
    (0..x.ncols()).map(|j| dot(x.col_as_slice(j), inertia.col_as_slice(j))).collect()
}

/// M-orthonormal columns that span those of `block`; directions at round-off of what the columns were `before` are left
/// out.
fn orthonormal(operator: &Operator<'_>, block: Mat<f64>, before: &[f64]) -> Result<Mat<f64>> {
    const ROUND_OFF: f64 = 1e-12;
    let masses = gram(block.as_ref(), times(operator.mass, block.as_ref()).as_ref());
    let scale: Vec<f64> = (0..block.ncols())
        .map(|j| {
            if masses[(j, j)] > ROUND_OFF * ROUND_OFF * before[j] { 1.0 / masses[(j, j)].sqrt() } else { 0.0 }
        })
        .collect();
    let masses = Mat::from_fn(block.ncols(), block.ncols(), |i, j| scale[i] * masses[(i, j)] * scale[j]);
    let (sizes, directions) = symmetric_eigen(masses.as_ref())?;
    let kept: Vec<usize> = (0..sizes.len()).filter(|j| sizes[*j] > ROUND_OFF).collect();
    let combine = Mat::from_fn(block.ncols(), kept.len(), |i, j| {
        scale[i] * directions[(i, kept[j])] / sizes[kept[j]].sqrt()
    });
    let once = expand(block.as_ref(), combine.as_ref());
    // The Gram matrix squares the condition: a second pass leaves orthonormal columns.
    let masses = gram(once.as_ref(), times(operator.mass, once.as_ref()).as_ref());
    let (sizes, directions) = symmetric_eigen(masses.as_ref())?;
    let combine =
        Mat::from_fn(sizes.len(), sizes.len(), |i, j| directions[(i, j)] / sizes[j].max(0.5).sqrt());
    Ok(expand(once.as_ref(), combine.as_ref()))
}

fn entrywise(a: &Block, b: &Mat<f64>) -> c64 {
    let column = |j: usize| a.vector(j).map(|part| dot(part, b.col_as_slice(j)));
    (0..a.ncols()).map(column).map(|[re, im]| c64::new(re, im)).sum()
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

fn above(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    let rows = a.nrows();
    Mat::from_fn(rows + b.nrows(), a.ncols(), |i, j| if i < rows { a[(i, j)] } else { b[(i - rows, j)] })
}
