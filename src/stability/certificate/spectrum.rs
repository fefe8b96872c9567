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
//! does not resonate with the modes that were found. Those beyond the band are bounded all together ([`far`](super::far)).

use super::contour::{Stopped, Winding};
use super::coupling_factor::CouplingFactor;
use super::far::Far;
use super::reach::{Reach, SpectrumWeights};
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
    /// The eigenvalues beyond the region.
    far: Far,
}

/// The discs of a contour at most.
const DISCS: usize = 1_000_000;
/// The radius of a disc by the distance of its centre from the nearest eigenvalue: 1/|s − λ| is known within a quarter.
const RADIUS: f64 = 0.2;
/// Eigenvalues further from zero than this part of the top of the band are bounded all together.
const FAR: f64 = 1.1;

/// A of the reduced model, as far as it is diagonal in the coordinates of its eigenvectors.
pub(super) struct Decomposition {
    /// Λ.
    pub(super) values: Vec<c64>,
    /// The row sums of |R| and of |F|.
    rests: Vec<[f64; 2]>,
    /// x_k, and z_k, one a column.
    pub(super) right: Mat<c64>,
    pub(super) left: Mat<c64>,
}

impl Decomposition {
    /// That of the reduced model with the numbers of an interface, scaled for frequencies up to `top` \[rad/s\]; `sizes` are those
    /// of the operator's directions.
    pub(super) fn new(
        model: &ReducedModel,
        terms: &[InterfaceTerm],
        sizes: &[f64],
        top: f64,
    ) -> Result<Self> {
        let (m, r) = (model.oscillators.len(), model.active.len());
        let place = |d: usize| model.active.binary_search(&d);
        let scale: Vec<f64> = model.active.iter().map(|d| sizes[*d].sqrt()).collect();
        let w = Mat::from_fn(m, r, |i, j| model.interface[(i, j)] * scale[j]);
        let (mut wk, mut wc) = (Mat::<f64>::zeros(m, r), Mat::<f64>::zeros(m, r));
        for term in terms {
            if let (Ok(i), Ok(j)) = (place(term.row), place(term.column)) {
                for (to, value) in [(&mut wk, term.stiffness), (&mut wc, term.damping)] {
                    let (value, to) = (value / (scale[i] * scale[j]), to.col_as_slice_mut(j));
                    to.iter_mut().zip(w.col_as_slice(i)).for_each(|(to, w)| *to += value * w);
                }
            }
        }
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
        let right = Mat::from_fn(m, 2 * m, |i, k| x[(i, k)] / omega[i]);
        let left = Mat::from_fn(m, 2 * m, |i, k| z[(k, m + i)]);
        Ok(Decomposition { values, rests, right, left })
    }
}

impl<'a> ReducedSpectrum<'a> {
    /// The spectrum of the reduced model with the numbers of an interface, as for [`Decomposition::new`].
    pub(super) fn new(
        model: &'a ReducedModel,
        terms: &[InterfaceTerm],
        sizes: &[f64],
        top: f64,
    ) -> Result<Self> {
        let Decomposition { values, rests, right, left } = Decomposition::new(model, terms, sizes, top)?;
        let remainder = model.remainder.as_ref();
        let none = || [(); 3].map(|()| Mat::zeros(0, 2 * model.oscillators.len()));
        let powers = match remainder {
            Some(remainder) => {
                let [straight, transposed] = &remainder.contact;
                let of = |contact, x| powers_of([&remainder.terms, contact], x);
                [of(straight, &right), of(transposed, &left)]
            }
            None => [none(), none()],
        };
        let reaches =
            powers.each_ref().map(|powers| (0..values.len()).map(|k| Reach::of(powers, k)).collect());
        let far = Far::new(&values, FAR * top, powers, &reaches);
        Ok(ReducedSpectrum { remainder, values, rests, reaches, far })
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
        let ratio = RADIUS / (1.0 + RADIUS);
        for edge in path.windows(2) {
            let length = (edge[1] - edge[0]).norm();
            let direction = (edge[1] - edge[0]) / length;
            let mut done = 0.0;
            let mut far = self.far.disc(edge[0], direction, ratio);
            while done < length {
                // The disc's centre lies its radius ahead; the distance there is less by that at most.
                let nearest = self.distance(edge[0] + direction * done);
                let h = (ratio * nearest)
                    .min(0.5 * (length - done))
                    .min(0.02 * region.omega[1].max((edge[0] + direction * done).norm()));
                let c = edge[0] + direction * (done + h);
                if nearest < 10.0 * resolution || points > DISCS {
                    return Err(Stopped::At(c));
                }
                // A shade more than the radius, so that rounding leaves no gap.
                if (c - far.centre).norm() + 1.001 * h > far.radius {
                    far = self.far.disc(edge[0] + direction * done, direction, 1.002 * ratio);
                }
                let bound = self.bound(c, 1.001 * h, far.bound).ok_or(Stopped::At(c))?;
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

    /// A bound on ρ at `s`.
    #[cfg(test)]
    pub(super) fn bound_at(&self, s: c64) -> Option<f64> {
        self.bound(s, 0.0, self.far.bound(s, 0.0))
    }

    /// A bound on ρ = q ‖E‖ in the disc of radius `h` about `c`, as far as the contour goes, given one on the part of the eigenvalues
    /// beyond the region; `None` where the rest of the decomposition may be an eigenvalue's.
    fn bound(&self, c: c64, h: f64, far: f64) -> Option<f64> {
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
                let own = if self.far.holds(k) { 0.0 } else { right[k] };
                self.reaches[0][k].within(&weights, h) * (own + near[k][1] * largest / (1.0 - delta))
            })
            .sum();
        let bound = q * (sum + far + remainder.missed.stiffness + reach * remainder.missed.damping);
        // A product of zero and infinity is no bound.
        Some(if bound.is_nan() { f64::INFINITY } else { bound })
    }
}

/// p₀, p₁ and p₂ of Q_ZB(s) x = p₀ + s p₁ + s² p₂ of every column x, given the terms of Q_ZBᵀ.
fn powers_of(terms: [&Vec<(CouplingFactor, Mat<f64>)>; 2], x: &Mat<c64>) -> [Mat<c64>; 3] {
    let (re, im) = (part(x, |z| z.re), part(x, |z| z.im));
    let image = |a: &Mat<f64>| {
        let (re, im) = (product(a.transpose(), re.as_ref()), product(a.transpose(), im.as_ref()));
        Mat::from_fn(re.nrows(), re.ncols(), |i, k| c64::new(re[(i, k)], im[(i, k)]))
    };
    let f = terms[0].first().map_or(0, |(_, l)| l.ncols());
    let mut powers = [(); 3].map(|()| Mat::<c64>::zeros(f, x.ncols()));
    for (factor, l) in terms.into_iter().flatten() {
        let flexible = image(l);
        let (linear, square) = (c64::new(factor.linear, 0.0), c64::new(factor.square, 0.0));
        for (power, weight) in powers.iter_mut().zip([factor.constant, linear, square]) {
            if weight.norm() > 0.0 {
                *power += &flexible * faer::Scale(weight);
            }
        }
    }
    powers
}

fn part(x: &Mat<c64>, of: fn(&c64) -> f64) -> Mat<f64> {
    Mat::from_fn(x.nrows(), x.ncols(), |i, k| of(&x[(i, k)]))
}
