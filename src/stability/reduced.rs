//! A reduced model that serves a whole family of sliding states: between them a few numbers differ.

use crate::dynamics::InterfaceTerm;
use crate::error::Result;
use crate::linalg::c64;
use crate::linalg::dense::{definite_pencil, product};
use crate::linalg::unsymmetric::{Eigenvalues, complex_eigenvalues, complex_spectrum, eigenvalues, spectrum};
use faer::{Mat, MatRef};

/// (λ² + λ (Σ wᵢCᵢ + G + B c Bᵀ) + K + N + i Σ wᵢHᵢ + B k Bᵀ) y = 0 in M-orthonormal coordinates, m of them; G and N are skew.
pub(super) struct FamilyMatrices {
    /// From these coordinates to those of the basis.
    pub(super) rotation: Mat<f64>,
    stiffness: Mat<f64>,
    /// d \[rad/s\]: the frequencies of the reference stiffness, by which the first-order form is balanced.
    frequencies: Vec<f64>,
    damping: Vec<Mat<f64>>,
    hysteretic: Vec<Option<Mat<f64>>>,
    /// The sparse skew parts of K and C.
    skew: Option<[Mat<f64>; 2]>,
    /// B = VᵀW.
    interface: Mat<f64>,
}

/// The matrices of a projection, in the coordinates of the basis.
pub(super) struct Projection {
    pub(super) mass: Mat<f64>,
    pub(super) stiffness: Mat<f64>,
    pub(super) damping: Vec<Mat<f64>>,
    pub(super) hysteretic: Vec<Option<Mat<f64>>>,
    pub(super) skew: Option<[Mat<f64>; 2]>,
    pub(super) interface: Mat<f64>,
}

impl Projection {
    /// K + τ M.
    pub(super) fn energy(&self, tau: f64) -> Mat<f64> {
        &self.stiffness + faer::Scale(tau) * &self.mass
    }

    /// The projection on the columns of `basis`.
    pub(super) fn onto(&self, basis: MatRef<'_, f64>) -> Projection {
        let form = |a: &Mat<f64>| product(basis.transpose(), product(a.as_ref(), basis).as_ref());
        Projection {
            mass: form(&self.mass),
            stiffness: form(&self.stiffness),
            damping: self.damping.iter().map(form).collect(),
            hysteretic: self.hysteretic.iter().map(|h| h.as_ref().map(form)).collect(),
            skew: self.skew.as_ref().map(|parts| parts.each_ref().map(form)),
            interface: product(basis.transpose(), self.interface.as_ref()),
        }
    }
}

/// The modes of a reduced model, ascending in (Im λ, Re λ).
#[derive(Debug, Clone)]
pub(super) struct ReducedModes {
    pub(super) eigenvalues: Vec<c64>,
    /// Unit right vectors; their scalar products are those of the full order with M.
    pub(super) right: Mat<c64>,
    /// Unit left vectors.
    pub(super) left: Mat<c64>,
    /// ψᴴQ′(λ)φ.
    pub(super) steepness: Vec<c64>,
}

/// All eigenvalues of a state and their vectors, in the first-order form.
pub(super) struct ReducedSpectrum<'a> {
    of: &'a FamilyMatrices,
    damping: Mat<f64>,
    stiffness: Mat<f64>,
    losses: Option<Mat<f64>>,
    all: Eigenvalues,
}

impl FamilyMatrices {
    /// Goes to the coordinates in which M = 1 and the reference stiffness K + Σ `springs` · bbᵀ is diagonal; `floor`
    /// \[rad/s\] is the least frequency to balance by.
    pub(super) fn new(p: &Projection, springs: &[(usize, f64)], floor: f64) -> Result<Self> {
        let mut reference = p.stiffness.clone();
        for (column, d) in springs {
            let b = p.interface.col(*column);
            reference += faer::Scale(*d) * (b * b.transpose());
        }
        let (squares, rotation) = definite_pencil(reference.as_ref(), p.mass.as_ref())?;
        let into =
            |a: &Mat<f64>| product(rotation.transpose(), product(a.as_ref(), rotation.as_ref()).as_ref());
        Ok(FamilyMatrices {
            stiffness: into(&p.stiffness),
            frequencies: squares.iter().map(|s| s.max(0.0).sqrt().max(floor)).collect(),
            damping: p.damping.iter().map(into).collect(),
            hysteretic: p.hysteretic.iter().map(|h| h.as_ref().map(into)).collect(),
            skew: p.skew.as_ref().map(|parts| parts.each_ref().map(into)),
            interface: product(rotation.transpose(), p.interface.as_ref()),
            rotation,
        })
    }

    /// The modes that are `wanted` of a state.
    pub(super) fn solve(
        &self,
        terms: &[InterfaceTerm],
        weights: &[f64],
        wanted: impl Fn(c64) -> bool,
    ) -> Result<ReducedModes> {
        Ok(self.spectrum(terms, weights)?.modes(wanted))
    }

    /// All eigenvalues of a state.
    ///
    /// With D = diag(d) and x = (D y, λ y) the problem is λx = \[0 D; −K D⁻¹ −C\]x, whose entries are of the size of
    /// the frequencies, not of their squares: the error of the QR algorithm is then about 1e-15 d_max. The lower
    /// half of its left vector is that of Q.
    pub(super) fn spectrum(&self, terms: &[InterfaceTerm], weights: &[f64]) -> Result<ReducedSpectrum<'_>> {
        let (c, k) = self.matrices(terms, weights);
        let h = self.losses(weights);
        let companion = self.companion(&c, &k);
        let all = match &h {
            None => spectrum(companion.as_ref())?,
            Some(h) => complex_spectrum(self.lossy(&companion, h).as_ref())?,
        };
        Ok(ReducedSpectrum { of: self, damping: c, stiffness: k, losses: h, all })
    }

    /// The eigenvalues that are `wanted`, in no order and without the correction of [`FamilyMatrices::solve`], at a third of its
    /// cost or less.
    /// Fails where numbers are not finite.
    pub(super) fn eigenvalues(
        &self,
        terms: &[InterfaceTerm],
        weights: &[f64],
        wanted: impl Fn(c64) -> bool,
    ) -> Result<Vec<c64>> {
        let (c, k) = self.matrices(terms, weights);
        let companion = self.companion(&c, &k);
        let all = match self.losses(weights) {
            None => eigenvalues(companion.as_ref())?,
            Some(h) => complex_eigenvalues(self.lossy(&companion, &h).as_ref())?,
        };
        Ok(all.into_iter().filter(|z| wanted(*z)).collect())
    }

    /// C and K with the interface.
    fn matrices(&self, terms: &[InterfaceTerm], weights: &[f64]) -> (Mat<f64>, Mat<f64>) {
        let mut c = self.between(terms, |t| t.damping);
        let mut k = self.between(terms, |t| t.stiffness);
        k += &self.stiffness;
        if let Some([circulatory, gyroscopic]) = &self.skew {
            k += circulatory;
            c += gyroscopic;
        }
        self.damping.iter().zip(weights).for_each(|(part, w)| c += faer::Scale(*w) * part);
        (c, k)
    }

    /// H, where there is one.
    fn losses(&self, weights: &[f64]) -> Option<Mat<f64>> {
        let m = self.frequencies.len();
        let mut sum = None;
        for (part, w) in self.hysteretic.iter().zip(weights) {
            if let Some(part) = part {
                *sum.get_or_insert_with(|| Mat::zeros(m, m)) += faer::Scale(*w) * part;
            }
        }
        sum
    }

    /// \[0 D; −K D⁻¹ −C\].
    fn companion(&self, c: &Mat<f64>, k: &Mat<f64>) -> Mat<f64> {
        let (m, d) = (self.frequencies.len(), &self.frequencies);
        Mat::from_fn(2 * m, 2 * m, |i, j| match (i < m, j < m) {
            (true, true) => 0.0,
            (true, false) => f64::from(i == j - m) * d[i],
            (false, true) => -k[(i - m, j)] / d[j],
            (false, false) => -c[(i - m, j - m)],
        })
    }

    /// \[0 D; −(K + iH) D⁻¹ −C\].
    fn lossy(&self, companion: &Mat<f64>, h: &Mat<f64>) -> Mat<c64> {
        let (m, d) = (self.frequencies.len(), &self.frequencies);
        let loss = |i: usize, j: usize| if i >= m && j < m { -h[(i - m, j)] / d[j] } else { 0.0 };
        Mat::from_fn(2 * m, 2 * m, |i, j| c64::new(companion[(i, j)], loss(i, j)))
    }

    /// Σ b_row value b_columnᵀ over the terms.
    fn between(&self, terms: &[InterfaceTerm], value: impl Fn(&InterfaceTerm) -> f64) -> Mat<f64> {
        let m = self.interface.nrows();
        let mut used: Vec<usize> = terms.iter().filter(|t| value(t) != 0.0).map(|t| t.column).collect();
        used.sort_unstable();
        used.dedup();
        if used.is_empty() {
            return Mat::zeros(m, m);
        }
        let mut by_column = Mat::<f64>::zeros(m, used.len());
        for term in terms.iter().filter(|t| value(t) != 0.0) {
            let at = used.binary_search(&term.column).expect("listed above");
            let (factor, row) = (value(term), self.interface.col_as_slice(term.row));
            by_column.col_as_slice_mut(at).iter_mut().zip(row).for_each(|(sum, b)| *sum += factor * b);
        }
        let columns = Mat::from_fn(m, used.len(), |i, j| self.interface[(i, used[j])]);
        product(by_column.as_ref(), columns.transpose())
    }
}

impl ReducedSpectrum<'_> {
    /// The modes whose eigenvalues are `wanted`, each corrected by the two-sided Rayleigh quotient of Q.
    pub(super) fn modes(&self, wanted: impl Fn(c64) -> bool) -> ReducedModes {
        let (all, d) = (&self.all, &self.of.frequencies);
        let m = d.len();
        let mut chosen: Vec<usize> = (0..2 * m).filter(|j| wanted(all.values[*j])).collect();
        let before = |a: &usize, b: &usize| {
            let (a, b) = (all.values[*a], all.values[*b]);
            a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re))
        };
        chosen.sort_by(before);
        let right = unit(Mat::from_fn(m, chosen.len(), |i, j| all.right[(i, chosen[j])] / d[i]));
        let left = unit(Mat::from_fn(m, chosen.len(), |i, j| all.left[(m + i, chosen[j])]));
        let (damped, mut elastic) = (real_times(&self.damping, &right), real_times(&self.stiffness, &right));
        if let Some(h) = &self.losses {
            elastic += faer::Scale(c64::new(0.0, 1.0)) * real_times(h, &right);
        }
        let corrected = |j: usize| {
            let lambda = all.values[chosen[j]];
            let (mut rise, mut slope) = (c64::new(0.0, 0.0), c64::new(0.0, 0.0));
            for i in 0..m {
                let (z, y) = (left[(i, j)].conj(), right[(i, j)]);
                rise += z * (lambda * lambda * y + lambda * damped[(i, j)] + elastic[(i, j)]);
                slope += z * (lambda * 2.0 * y + damped[(i, j)]);
            }
            let step = rise / slope;
            // At a coalescence the quotient says nothing.
            (if step.norm() <= 1e-8 * lambda.norm() { lambda - step } else { lambda }, slope)
        };
        let (eigenvalues, steepness) = (0..chosen.len()).map(corrected).unzip();
        ReducedModes { eigenvalues, right, left, steepness }
    }
}

/// Columns scaled to ‖y‖₂ = 1.
fn unit(mut y: Mat<c64>) -> Mat<c64> {
    for j in 0..y.ncols() {
        let norm = y.col_as_slice(j).iter().map(|z| z.norm_sqr()).sum::<f64>().sqrt();
        y.col_as_slice_mut(j).iter_mut().for_each(|z| *z /= norm);
    }
    y
}

/// A Y of a real A, on one thread.
pub(super) fn real_times(a: &Mat<f64>, y: &Mat<c64>) -> Mat<c64> {
    let part = |f: fn(&c64) -> f64| Mat::from_fn(y.nrows(), y.ncols(), |i, j| f(&y[(i, j)]));
    let times = |y: MatRef<'_, f64>| product(a.as_ref(), y);
    let (re, im) = (times(part(|z| z.re).as_ref()), times(part(|z| z.im).as_ref()));
    Mat::from_fn(a.nrows(), y.ncols(), |i, j| c64::new(re[(i, j)], im[(i, j)]))
}
