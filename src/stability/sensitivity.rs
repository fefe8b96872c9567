//! Sensitivities dλ/dp = −ψᴴ (∂Q/∂p) φ / ψᴴ Q′(λ) φ of complex eigenvalues, with the *total* ∂Q/∂p.
//!
//! Q depends on p directly and through steady sliding: u₀, N₀, N′ and K_σ move with p, and so do the real modes of modal
//! damping. So ∂Q/∂p is taken between neighbouring systems, each at a steady state of its own. Differences are formed of
//! Q(λ)φ with λ, φ, ψ held, never of λ: no eigenproblem is solved again, and branches cannot be mistaken.

use super::ComplexMode;
use super::analysis::shifted_factor;
use super::modal_damping::ModalChange;
use crate::dynamics::{Block, Interface, Operator, Side};
use crate::equilibrium::{Nearby, SteadySliding, tangent_stiffness};
use crate::error::{Error, Fault, Result};
use crate::linalg::multivector::gram;
use crate::linalg::sparse::{add_scaled, times};
use crate::linalg::{SparseMatrix, c64};
use crate::modal::RealModes;
use crate::system::{Skew, System};

/// Chosen complex modes of a system, ready to be asked how they answer changes of it.
pub struct Sensitivity<'a> {
    pub(super) operator: Operator<'a>,
    nearby: Nearby<'a>,
    pub(super) lambda: Vec<c64>,
    pub(super) phi: Block,
    pub(super) psi: Block,
    /// ψᴴ Q′(λ) φ.
    pub(super) steepness: Vec<c64>,
    pub(super) modal: Option<ModalChange>,
    /// (ψᴴMφₖ)(φₖᵀMφ) 2ωₖ of every mode and real mode φₖ: ψᴴCφ per unit of the ratio ζₖ.
    by_ratio: Vec<Vec<c64>>,
}

/// Where a scalar may go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Domain {
    /// Both ways: central differences.
    Inside,
    /// Only upwards, as at zero of what may not be negative: one-sided differences.
    AtLowerBound,
}

/// dλ/dp of one mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rate {
    /// dλ/dp \[1/s per unit of p\]: dσ/dp and dω/dp.
    pub value: c64,
    /// Estimated |error| of it, from the two step sizes; at a kink half of what the two slopes differ by.
    pub error: f64,
    /// Whether λ(p) has a kink here, such as where a contact point passes from one element to the next: the slopes to
    /// the two sides differ, and `value` is their mean.
    pub kink: bool,
}

impl<'a> Sensitivity<'a> {
    /// Prepares the `modes` of `system` at its steady state. `real` are the modes of K + K_σ and M that the complex modes
    /// were computed with, the basis of modal damping where there is some.
    ///
    /// # Errors
    /// Vectors of another length, or left ones that were not kept; a structure that nothing holds.
    pub fn new(
        system: &'a System,
        steady: &'a SteadySliding,
        real: &RealModes,
        modes: &[&ComplexMode],
    ) -> Result<Self> {
        let n = system.n_dofs();
        let modal_fits =
            system.structure.damping.modal.as_ref().is_none_or(|d| d.coefficients.len() == real.len());
        if !modes.iter().all(|mode| mode.of_size(n))
            || steady.displacement.len() != n
            || real.shapes.nrows() != n
            || !modal_fits
        {
            return Err(Error::input(Fault::new(
                "sensitivities",
                "modes or a steady state of another system, or modes without left vectors",
                format!("those of the system, of {n} degrees of freedom"),
            )));
        }
        let operator = Operator::new(system, steady)?;
        let nearby = Nearby::new(system, steady)?;
        let columns = |pick: fn(&ComplexMode) -> &Vec<c64>| {
            let all: Vec<&[c64]> = modes.iter().map(|mode| pick(mode).as_slice()).collect();
            Block::from_columns(n, &all)
        };
        let (mut phi, mut psi) = (columns(|m| &m.right), columns(|m| &m.left));
        let lambda: Vec<c64> = modes.iter().map(|m| m.eigenvalue).collect();
        sharpen(&operator, real, &lambda, [(Side::Right, &mut phi), (Side::Left, &mut psi)])?;
        let steepness = operator.steepness(&lambda, &psi, &phi);
        let modal = match &system.structure.damping.modal {
            Some(damping) if damping.coefficients.iter().any(|c| *c != 0.0) && !modes.is_empty() => {
                let sizes = || lambda.iter().map(|l| l.norm());
                let band = [sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max)];
                let (factor, _) = shifted_factor(&operator, real, band)?;
                Some(ModalChange::new(&operator, real, damping, &*factor, &phi, &psi)?)
            }
            _ => None,
        };
        let amplitudes = |x: &Block| x.map(|x| gram(real.shapes.as_ref(), times(operator.mass, x).as_ref()));
        let (a, b) = (amplitudes(&phi), amplitudes(&psi));
        let by_ratio = (0..lambda.len())
            .map(|i| {
                let weight = |k: usize| 2.0 * real.eigenvalues[k].max(0.0).sqrt();
                (0..real.len()).map(|k| b.get(k, i).conj() * a.get(k, i) * weight(k)).collect()
            })
            .collect();
        Ok(Sensitivity { operator, nearby, lambda, phi, psi, steepness, modal, by_ratio })
    }

    /// The eigenvalues λ, in the order of the modes.
    pub fn eigenvalues(&self) -> &[c64] {
        &self.lambda
    }

    /// −ψᴴ \[Q_other(λ) − Q(λ)\] φ / ψᴴ Q′(λ) φ of every mode: the change of λ to first order when the system becomes
    /// `other`, which has the same degrees of freedom and contact points, and slides steadily in its own way.
    ///
    /// Modal damping keeps its ratios ζ, on the real modes that `other` has; its own C is not used.
    ///
    /// # Errors
    /// A system of another size; one without a steady state.
    pub fn change(&self, other: &System) -> Result<Vec<c64>> {
        let steady = self.nearby.solve(other)?;
        let stiffness = tangent_stiffness(other, &steady.displacement)?;
        let (structure, damping) = (&other.structure, &other.structure.damping);
        let own = self.operator.damping;
        let dk = difference(Some(&*stiffness), Some(&*self.operator.stiffness));
        let dm = difference(Some(&structure.mass), Some(self.operator.mass));
        let dc = difference(damping.viscous.as_deref(), own.viscous.as_deref());
        let dh = difference(damping.hysteretic.as_deref(), own.hysteretic.as_deref());
        let mut rise = self.rise_of_interface(&Interface::new(other, &steady));
        let i = c64::new(0.0, 1.0);
        let one = c64::new(1.0, 0.0);
        for (matrix, factor) in
            [(&dk, &(|_| one) as &dyn Fn(c64) -> c64), (&dm, &|s| s * s), (&dc, &|s| s), (&dh, &|_| i)]
        {
            let Some(matrix) = matrix else { continue };
            let forces = self.phi.map(|part| times(matrix, part.as_ref()));
            for (j, rise) in rise.iter_mut().enumerate() {
                *rise += factor(self.lambda[j]) * self.psi.dot(j, &forces);
            }
        }
        self.add_rise_of_skew(other.skew(), &mut rise);
        if let Some(modal) = &self.modal
            && (dk.is_some() || dm.is_some())
        {
            let damped = modal.of_matrices(dk.as_ref(), dm.as_ref());
            rise.iter_mut().zip(damped).zip(&self.lambda).for_each(|((rise, c), s)| *rise += s * c);
        }
        Ok(self.eigenvalue_change(rise))
    }

    /// Adds ψᴴ(K_k − K_k,own + λ (C_k − C_k,own))φ of the sparse skew parts.
    fn add_rise_of_skew(&self, other: Option<&Skew>, rise: &mut [c64]) {
        let own = self.operator.skew;
        let of = |part: fn(&Skew) -> &SparseMatrix| difference(other.map(part), own.map(part));
        for (matrix, damping) in [(of(|s| &s.stiffness), false), (of(|s| &s.damping), true)] {
            let Some(matrix) = matrix else { continue };
            let forces = self.phi.map(|part| times(&matrix, part.as_ref()));
            for (j, rise) in rise.iter_mut().enumerate() {
                // A product with a matrix stored by columns is that with its transpose.
                let factor = if damping { self.lambda[j] } else { c64::new(1.0, 0.0) };
                *rise -= factor * self.psi.dot(j, &forces);
            }
        }
    }

    /// The change of every λ to first order when the ratio ζₖ of every real mode grows by `ratios[k]`.
    pub fn change_by_ratios(&self, ratios: &[f64]) -> Vec<c64> {
        let rise = |(weights, s): (&Vec<c64>, &c64)| {
            weights.iter().zip(ratios).map(|(w, z)| w * *z).fold(c64::new(0.0, 0.0), |a, b| a + b) * s
        };
        self.eigenvalue_change(self.by_ratio.iter().zip(&self.lambda).map(rise).collect())
    }

    /// dλ/dp of every mode for a scalar that stands at `value`; `build` gives the system for another value of it.
    ///
    /// With w(p) the change of λ to first order, which vanishes at `value`: D(δ) = (w(p+δ) − w(p−δ))/2δ, and
    /// (4 D(δ) − D(2δ))/3 is right to δ⁴; its distance from D(δ) is the error given. At a bound D(δ) = w(p+δ)/δ at
    /// δ, 2δ, 4δ is extrapolated instead. Where steps of size `step` disagree by more than 1e-5 (a contact opens, a law
    /// bends), ten and a hundred times smaller ones are tried and the steps that agree best are kept.
    ///
    /// # Errors
    /// Those of `build`, and those of [`Sensitivity::change`].
    pub fn differentiate(
        &self,
        value: f64,
        step: f64,
        domain: Domain,
        build: &dyn Fn(f64) -> Result<System>,
    ) -> Result<Vec<Rate>> {
        const GOOD: f64 = 1e-5;
        const ROUND_OFF: f64 = 1e-12;
        let mut best: Option<(f64, Vec<Rate>)> = None;
        for step in [step, 0.1 * step, 0.01 * step] {
            let rates = self.rates(value, step, domain, build)?;
            // An effect that the step brings to no more than round-off of λ is as good as none.
            let relative = |(rate, l): (&Rate, &c64)| {
                rate.error / rate.value.norm().max(ROUND_OFF / GOOD * l.norm() / step.abs())
            };
            let worst = rates.iter().zip(&self.lambda).map(relative).fold(0.0, f64::max);
            if best.as_ref().is_none_or(|(known, _)| worst < *known) {
                best = Some((worst, rates));
            }
            if best.as_ref().is_some_and(|(known, rates)| *known <= GOOD || rates.iter().any(|r| r.kink)) {
                break;
            }
        }
        Ok(best.map(|(_, rates)| rates).unwrap_or_default())
    }

    fn rates(
        &self,
        value: f64,
        step: f64,
        domain: Domain,
        build: &dyn Fn(f64) -> Result<System>,
    ) -> Result<Vec<Rate>> {
        // The step as the floating-point numbers have it.
        let at = |factor: f64| -> Result<(f64, Vec<c64>)> {
            let moved = value + factor * step;
            Ok((moved - value, self.change(&build(moved)?)?))
        };
        let slope = |(h, w): &(f64, Vec<c64>), j: usize| w[j] / *h;
        Ok(match domain {
            Domain::Inside => {
                let [up, down, up2, down2] = [at(1.0)?, at(-1.0)?, at(2.0)?, at(-2.0)?];
                let central =
                    |a: &(f64, Vec<c64>), b: &(f64, Vec<c64>), j: usize| (a.1[j] - b.1[j]) / (a.0 - b.0);
                (0..self.lambda.len())
                    .map(|j| {
                        let (near, far) = (central(&up, &down, j), central(&up2, &down2, j));
                        let value = (near * 4.0 - far) / 3.0;
                        // What the slopes to the two sides differ by is halved with the step, but not at a kink.
                        let jump = |a, b| (slope(a, j) - slope(b, j)).norm();
                        let (jump, jump2) = (jump(&up, &down), jump(&up2, &down2));
                        let visible = jump * step.abs() > 1e-10 * self.lambda[j].norm();
                        let kink = visible && jump > 1e-3 * value.norm() && jump2 < 1.4 * jump;
                        let error = (value - near).norm();
                        Rate { value, error: if kink { error.max(0.5 * jump) } else { error }, kink }
                    })
                    .collect()
            }
            Domain::AtLowerBound => {
                let [a, b, c] = [at(1.0)?, at(2.0)?, at(4.0)?];
                (0..self.lambda.len())
                    .map(|j| {
                        let first = |x, y| slope(x, j) * 2.0 - slope(y, j);
                        let (near, far): (c64, c64) = (first(&a, &b), first(&b, &c));
                        let value = (near * 4.0 - far) / 3.0;
                        Rate { value, error: (value - near).norm(), kink: false }
                    })
                    .collect()
            }
        })
    }

    /// ψᴴ W (k + λ c) Wᵀ φ of the `other` interface less that of the own one.
    fn rise_of_interface(&self, other: &Interface<'_>) -> Vec<c64> {
        let of = |interface: &Interface<'_>, j: usize| {
            let moved = |x: &Block| interface.motions(x.vector(j));
            let (phi, psi) = (moved(&self.phi), moved(&self.psi));
            let terms = interface.terms.iter().map(|term| {
                let force = c64::new(term.stiffness, 0.0) + self.lambda[j] * term.damping;
                psi[term.row].conj() * phi[term.column] * force
            });
            terms.fold(c64::new(0.0, 0.0), |a, b| a + b)
        };
        (0..self.lambda.len()).map(|j| of(other, j) - of(&self.operator.interface, j)).collect()
    }

    /// −rise / ψᴴQ′φ.
    pub(super) fn eigenvalue_change(&self, rise: Vec<c64>) -> Vec<c64> {
        rise.iter().zip(&self.steepness).map(|(rise, slope)| -rise / slope).collect()
    }
}

/// One correction z = −A⁻¹Q(λ)φ of each vector, A = K + K_σ − s M with s near |λ|², where it makes the residual smaller.
///
/// The error of λ is quadratic in that of the vectors, the error of dλ/dp linear: the vectors of an accurate λ leave
/// margin for this step. Their residual is orthogonal to the real modes and shows no contact motion, so that z meets only
/// the rest of the spectrum, θⱼ ≫ |λ|², where A⁻¹ is Q(λ)⁻¹ but for (s − |λ|²)/θⱼ.
fn sharpen(
    operator: &Operator<'_>,
    real: &RealModes,
    lambda: &[c64],
    sides: [(Side, &mut Block); 2],
) -> Result<()> {
    let mut factors = Vec::new();
    for l in lambda {
        factors.push(shifted_factor(operator, real, [l.norm(); 2])?.0);
    }
    for (side, vectors) in sides {
        let residual = operator.value(side, lambda, vectors);
        let mut better = vectors.clone();
        for (j, factor) in factors.iter().enumerate() {
            let mut z = Block::gathered(&residual, &[j]);
            factor.solve_in_place(z.parts_mut());
            for (x, z) in better.vector_mut(j).into_iter().zip(z.vector(0)) {
                x.iter_mut().zip(z).for_each(|(x, z)| *x -= z);
            }
        }
        let after = operator.value(side, lambda, &better);
        for j in (0..lambda.len()).filter(|j| after.norm(*j) < residual.norm(*j)) {
            for (x, better) in vectors.vector_mut(j).into_iter().zip(better.vector(j)) {
                x.copy_from_slice(better);
            }
        }
    }
    Ok(())
}

/// a − b, entry by entry, so that what is equal leaves no round-off; `None` when nothing is left.
fn difference(a: Option<&SparseMatrix>, b: Option<&SparseMatrix>) -> Option<SparseMatrix> {
    let d = match (a, b) {
        (Some(a), Some(b)) => add_scaled(&[(1.0, a), (-1.0, b)]),
        (Some(a), None) => a.clone(),
        (None, Some(b)) => add_scaled(&[(-1.0, b)]),
        (None, None) => return None,
    };
    d.val().iter().any(|v| *v != 0.0).then_some(d)
}

#[cfg(test)]
mod tests;
