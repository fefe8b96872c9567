//! The eigenvalues of the reduced model counted one by one, where the interface is too large for its determinant.
//!
//! With u = Ω x and v = ẋ (Ω diagonal, about the frequencies of the oscillators) Q_B(s) x = f reads (s − A) \[u v\]ᵀ = \[0 f\]ᵀ,
//!
//! A = \[0 Ω; −K̃Ω⁻¹ −C̃\], K̃ = diag(θ + ih) + iH_r + W_B k W_Bᵀ, C̃ = diag(a) + C_r + W_B c W_Bᵀ.
//!
//! Of the matrix X of A's eigenvectors and Z ≈ X⁻¹ nothing is believed: with ZAX = Λ + R (Λ its diagonal) and ZX = I + F
//!
//! det Z det(s − A) det X = det(s − Λ) det(I − D(R − sF)), D = (s − Λ)⁻¹.
//!
//! Where no row sum of |D|(|R| + |s||F|) reaches one the last determinant is not zero, nor is it for any part t(R − sF) of
//! the rest: on a contour like that as many eigenvalues of A lie inside as entries of Λ. The same rows bound
//!
//! Q_B⁻¹ = Ω⁻¹X_u (I − D(R − sF))⁻¹ D Z_v = Σ x_k z_kᵀ / (s − λ_k) + what R and F add,
//!
//! x_k the columns of Ω⁻¹X_u and z_kᵀ the rows of Z_v, and with it what the basis leaves out ([`remainder`](super::remainder)):
//!
//! E = Q_ZB Q_B⁻¹ Q_BZ − W_Z κ W_Zᵀ, Q_ZB = Γ + W_Z κ W_Bᵀ.
//!
//! Q_ZB(s) x_k is a polynomial in s that all but vanishes at λ_k, as the basis was refined until it did: what is left out
//! does not resonate with the modes that were found.

use super::contour::{Stopped, Winding};
use super::reduced::ReducedModel;
use super::region::CountedRegion;
use super::remainder::Remainder;
use crate::dynamics::InterfaceTerm;
use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::linalg::dense::product;
use crate::linalg::lu::inverse_and_phase;
use crate::linalg::unsymmetric::{complex_spectrum, spectrum};
use faer::Mat;

/// Floating-point operations for a basis of `m` vectors and `r` directions of contact: about 60 (2m)³ for the vectors, their inverse
/// and the check, and 25 r³ for the bound on what the basis leaves out. Counts of 135 to 2,091 directions in bases of 121 to 241
/// vectors took 4e9 to 6e9 of these a second, on one core.
pub(super) fn work(m: usize, r: usize) -> f64 {
    60.0 * (2.0 * m as f64).powi(3) + 25.0 * (r as f64).powi(3)
}

/// The eigenvalues of the reduced model, each with what it contributes to a bound on E.
#[derive(Debug)]
pub(super) struct ReducedSpectrum<'a> {
    remainder: Option<&'a Remainder>,
    /// Λ.
    values: Vec<c64>,
    /// The row sums of |R| and of |F|.
    rests: Vec<[f64; 2]>,
    /// Q_ZB x_k and Q_ZBᵀ of z_k.
    reaches: [Vec<Reach>; 2],
    /// Bounds on ‖W_Z k W_Zᵀ‖ and ‖W_Z c W_Zᵀ‖.
    missed: [f64; 2],
}

/// The size of a vector p₀ + s p₁ + s² p₂, by the products pᵢᴴpⱼ.
#[derive(Debug, Clone, Copy)]
struct Reach {
    /// pᵢᴴpⱼ.
    products: [[c64; 3]; 3],
    /// ‖pᵢ‖.
    sizes: [f64; 3],
}

/// Factors of p₀, p₁ and p₂, and their magnitudes.
struct SpectrumWeights([c64; 3], [f64; 3]);

impl SpectrumWeights {
    fn new(weights: [c64; 3]) -> Self {
        SpectrumWeights(weights, weights.map(|w| w.norm()))
    }

    /// Those of the value at `c`, the slope there, and the curvature.
    fn at(c: c64) -> [Self; 3] {
        let (zero, one) = (c64::new(0.0, 0.0), c64::new(1.0, 0.0));
        [[one, c, c * c], [zero, one, c * 2.0], [zero, zero, one]].map(SpectrumWeights::new)
    }
}

impl Reach {
    fn new(products: [[c64; 3]; 3]) -> Self {
        Reach { products, sizes: [0, 1, 2].map(|i| products[i][i].re.sqrt()) }
    }

    /// ‖Σ wᵢ pᵢ‖, not less in spite of rounding.
    fn size(&self, SpectrumWeights(weights, magnitudes): &SpectrumWeights) -> f64 {
        let (mut square, mut terms) = (0.0, 0.0);
        for i in 0..3 {
            let term = magnitudes[i] * self.sizes[i];
            square += term * term;
            terms += term;
            for j in 0..i {
                square += 2.0 * (weights[i].conj() * self.products[i][j] * weights[j]).re;
            }
        }
        (square.max(0.0) + 8.0 * f64::EPSILON * terms * terms).sqrt()
    }

    /// A bound on the size within `h` of a point, whose weights are given.
    fn within(&self, [value, slope, curvature]: &[SpectrumWeights; 3], h: f64) -> f64 {
        self.size(value) + h * (self.size(slope) + h * self.size(curvature))
    }
}

/// The discs of a contour at most.
const DISCS: usize = 1_000_000;
/// The radius of a disc by the distance of its centre from the nearest eigenvalue: 1/|s − λ| is known within a quarter.
const RADIUS: f64 = 0.2;

impl<'a> ReducedSpectrum<'a> {
    /// The reduced model with the numbers of an interface, scaled for frequencies up to `top` \[rad/s\]; `sizes` are those
    /// of the operator's directions.
    pub(super) fn new(
        model: &'a ReducedModel,
        terms: &[InterfaceTerm],
        sizes: &[f64],
        top: f64,
    ) -> Result<Self> {
        let (m, r) = (model.oscillators.len(), model.active.len());
        let place = |d: usize| model.active.iter().position(|a| *a == d);
        let scale: Vec<f64> = model.active.iter().map(|d| sizes[*d].sqrt()).collect();
        let w = Mat::from_fn(m, r, |i, j| model.interface[(i, j)] * scale[j]);
        let (mut k, mut c) = (Mat::<f64>::zeros(r, r), Mat::<f64>::zeros(r, r));
        for term in terms {
            if let (Some(i), Some(j)) = (place(term.row), place(term.column)) {
                k[(i, j)] += term.stiffness / (scale[i] * scale[j]);
                c[(i, j)] += term.damping / (scale[i] * scale[j]);
            }
        }
        let (wk, wc) = (product(w.as_ref(), k.as_ref()), product(w.as_ref(), c.as_ref()));
        let (wkt, wct) = (product(w.as_ref(), k.transpose()), product(w.as_ref(), c.transpose()));
        let mut stiffness = product(wk.as_ref(), w.transpose());
        let mut damping = product(wc.as_ref(), w.transpose());
        let mut loss = model.coupled_loss.clone().unwrap_or_else(|| Mat::zeros(m, m));
        for (i, oscillator) in model.oscillators.iter().enumerate() {
            stiffness[(i, i)] += oscillator.stiffness;
            damping[(i, i)] += oscillator.damping;
            loss[(i, i)] += oscillator.loss;
        }
        if let Some(coupled) = &model.coupled_damping {
            damping += coupled;
        }
        let omega: Vec<f64> =
            model.oscillators.iter().map(|o| o.stiffness.abs().sqrt().max(1e-3 * top)).collect();
        let entry = |i: usize, j: usize| match (i < m, j < m) {
            (true, true) => 0.0,
            (true, false) => {
                if i + m == j {
                    omega[i]
                } else {
                    0.0
                }
            }
            (false, true) => -stiffness[(i - m, j)] / omega[j],
            (false, false) => -damping[(i - m, j - m)],
        };
        let lost = |i: usize, j: usize| if i >= m && j < m { -loss[(i - m, j)] / omega[j] } else { 0.0 };
        let a = Mat::from_fn(2 * m, 2 * m, |i, j| c64::new(entry(i, j), lost(i, j)));
        let x = match loss.norm_max() > 0.0 {
            true => complex_spectrum(a.as_ref())?.right,
            false => spectrum(Mat::from_fn(2 * m, 2 * m, entry).as_ref())?.right,
        };
        let (z, _) = inverse_and_phase(x.clone()).ok_or_else(|| {
            Error::analysis(
                "eigenvectors of the reduced model",
                "they do not span it",
                "Change a number of the contact a little: two modes coalesce",
            )
        })?;
        let mut rest = product(z.as_ref(), product(a.as_ref(), x.as_ref()).as_ref());
        let values: Vec<c64> = (0..2 * m).map(|i| std::mem::take(&mut rest[(i, i)])).collect();
        let mut defect = product(z.as_ref(), x.as_ref());
        (0..2 * m).for_each(|i| defect[(i, i)] -= c64::new(1.0, 0.0));
        let row = |a: &Mat<c64>, i: usize| (0..2 * m).map(|j| a[(i, j)].norm()).sum::<f64>();
        let rests = (0..2 * m).map(|i| [row(&rest, i), row(&defect, i)]).collect();
        let x = Mat::from_fn(m, 2 * m, |i, k| x[(i, k)] / omega[i]);
        let z = Mat::from_fn(m, 2 * m, |i, k| z[(k, m + i)]);
        let remainder = model.remainder.as_ref();
        let (mut reaches, mut missed) = ([Vec::new(), Vec::new()], [0.0; 2]);
        if let Some(remainder) = remainder {
            let through = |a: &Mat<f64>| product(a.as_ref(), remainder.missed.as_ref());
            reaches = [
                reaches_of(remainder, &through(&wkt), &through(&wct), &x),
                reaches_of(remainder, &through(&wk), &through(&wc), &z),
            ];
            missed = [&k, &c].map(|a| product(remainder.missed.transpose(), through(a).as_ref()).norm_l2());
        }
        Ok(ReducedSpectrum { remainder, values, rests, reaches, missed })
    }

    /// Covers the boundary of `region` with discs and counts what lies inside; given up where ρ is above `largest_defect`.
    pub(super) fn count(
        &self,
        region: &CountedRegion,
        largest_defect: f64,
    ) -> std::result::Result<Winding, Stopped> {
        let resolution = 1e-11 * region.omega[1];
        let (mut points, mut defect) = (0, 0.0);
        let path = region.path();
        let mut worst = path[0];
        for edge in path.windows(2) {
            let length = (edge[1] - edge[0]).norm();
            let direction = (edge[1] - edge[0]) / length;
            let mut done = 0.0;
            while done < length {
                // The disc's centre lies its radius ahead; the distance there is less by that at most.
                let nearest = self.distance(edge[0] + direction * done);
                let h = (RADIUS / (1.0 + RADIUS) * nearest)
                    .min(0.5 * (length - done))
                    .min(0.02 * region.omega[1].max((edge[0] + direction * done).norm()));
                let c = edge[0] + direction * (done + h);
                if nearest < 10.0 * resolution || points > DISCS {
                    return Err(Stopped::At(c));
                }
                // A shade more than the radius, so that rounding leaves no gap.
                let bound = self.bound(c, 1.001 * h).ok_or(Stopped::At(c))?;
                if bound > defect {
                    (defect, worst) = (bound, c);
                }
                if bound > largest_defect {
                    return Err(Stopped::Weak);
                }
                done += 2.0 * h.max(resolution);
                points += 1;
            }
        }
        let zeros = self.values.iter().filter(|z| region.contains(**z)).count() as i64;
        Ok(Winding { zeros, points, defect, worst })
    }

    fn distance(&self, s: c64) -> f64 {
        self.values.iter().fold(f64::INFINITY, |d, value| d.min((s - value).norm_sqr())).sqrt()
    }

    /// A bound on ρ = q ‖E‖ in the disc of radius `h` about `c`, as far as the contour goes; `None` where the rest of the
    /// decomposition may be an eigenvalue's.
    pub(super) fn bound(&self, c: c64, h: f64) -> Option<f64> {
        let reach = c.norm() + h;
        // Of every eigenvalue |D| and |D|(|R| + |s||F|).
        let near: Vec<[f64; 2]> = self
            .values
            .iter()
            .zip(&self.rests)
            .map(|(value, [r, f])| {
                // Not `norm`, which is careful of overflow and takes most of the time.
                let d = 1.0 / ((c - value).norm_sqr().sqrt() - h).max(0.0);
                [d, d * (r + reach * f)]
            })
            .collect();
        let delta = near.iter().fold(0.0f64, |l, [_, rest]| l.max(*rest));
        if delta >= 0.5 || near.iter().any(|[d, rest]| !d.is_finite() || rest.is_nan()) {
            return None;
        }
        let Some(remainder) = self.remainder else { return Some(0.0) };
        let omega = (c.im.abs() + h).min(remainder.tau.sqrt());
        let q = remainder.amplification([(c.re - h).max(0.0), c.re + h], omega);
        let weights = SpectrumWeights::at(c);
        let right: Vec<f64> =
            (0..near.len()).map(|k| near[k][0] * self.reaches[1][k].within(&weights, h)).collect();
        let largest = right.iter().fold(0.0f64, |l, v| l.max(*v));
        let sum: f64 = (0..near.len())
            .map(|k| {
                self.reaches[0][k].within(&weights, h) * (right[k] + near[k][1] * largest / (1.0 - delta))
            })
            .sum();
        let bound = q * (sum + self.missed[0] + reach * self.missed[1]);
        // A product of zero and infinity is no bound.
        Some(if bound.is_nan() { f64::INFINITY } else { bound })
    }
}

/// (Γ + W_Z (k + s c) W_Bᵀ) x of every column x, with `stiff` and `damped` W_B kᵀ W_Zᵀ and W_B cᵀ W_Zᵀ.
fn reaches_of(remainder: &Remainder, stiff: &Mat<f64>, damped: &Mat<f64>, x: &Mat<c64>) -> Vec<Reach> {
    let (re, im) = (part(x, |z| z.re), part(x, |z| z.im));
    let image = |a: &Mat<f64>| {
        let (re, im) = (product(a.transpose(), re.as_ref()), product(a.transpose(), im.as_ref()));
        Mat::from_fn(re.nrows(), re.ncols(), |i, k| c64::new(re[(i, k)], im[(i, k)]))
    };
    let mut powers = [image(stiff), image(damped), Mat::zeros(stiff.ncols(), x.ncols())];
    for (factor, l) in &remainder.terms {
        let flexible = image(l);
        let (linear, square) = (c64::new(factor.linear, 0.0), c64::new(factor.square, 0.0));
        for (power, weight) in powers.iter_mut().zip([factor.constant, linear, square]) {
            *power += &flexible * faer::Scale(weight);
        }
    }
    let dot = |k: usize, i: usize, j: usize| -> c64 {
        let (a, b) = (powers[i].col_as_slice(k), powers[j].col_as_slice(k));
        a.iter().zip(b).map(|(a, b)| a.conj() * b).sum()
    };
    let reach = |k: usize| Reach::new([0, 1, 2].map(|i| [0, 1, 2].map(|j| dot(k, i, j))));
    (0..x.ncols()).map(reach).collect()
}

fn part(x: &Mat<c64>, of: fn(&c64) -> f64) -> Mat<f64> {
    Mat::from_fn(x.nrows(), x.ncols(), |i, k| of(&x[(i, k)]))
}
