//! Complex eigenvalues at steady sliding: (λ² M + λ (C + C_c) + K + K_σ + K_c) φ = 0, λ = σ + iω, unstable when σ > 0.
//!
//! [`complex_modes`] projects the problem on real modes and the static responses to the contact directions, solves the
//! small one, and lets the residuals on the full order enrich the basis until every pair is right there; the last
//! corrections then sharpen the right vectors.
//! [`certified_modes`] also counts the unstable eigenvalues, without looking for them. [`confirm`] looks for the same
//! pairs by two-level Arnoldi on the full order, which shares nothing with the projection. Where what is not symmetric has no
//! low rank, and a mode is not accurate on the projection, the modes themselves come from there.

mod advice;
mod analysis;
mod band;
mod basis;
mod budget;
mod certificate;
mod changed;
mod closed;
mod compact;
mod complex;
#[cfg(test)]
mod doubles;
#[cfg(test)]
mod exact;
mod family;
mod filter;
mod full_order;
mod general;
mod modal_damping;
mod near;
mod nearest;
mod post_processing;
mod projected;
mod reduced;
mod refinement;
mod responses;
mod sensitivity;
mod structural;
#[cfg(test)]
mod tests;

pub use advice::PointRates;
pub use band::Band;
pub use certificate::{Certificate, CloseCall, CountSize, SLOWEST_GROWTH, certified_modes};
pub use changed::{StiffnessChange, changed_eigenvalues};
pub use closed::{ClosedContact, ClosedModes, closed_modes};
pub use complex::{complex_eigenvalues, complex_modes};
pub use family::{Family, FamilyCheck, FamilyFrame, FamilyModes, SlidingState};
pub use filter::{ModalFilter, modal_filter};
pub use full_order::{Confirmation, confirm};
pub use near::near_mode;
pub use nearest::{Nearest, band_around, band_expected, keep_nearest};
pub use sensitivity::{Domain, Rate, Sensitivity};
pub use structural::Structural;

use crate::linalg::c64;
use crate::numbers::hertz;
use faer::Mat;

/// The complex modes of a system at steady sliding, ascending in frequency; one of each conjugate pair (ω ≥ 0).
#[derive(Debug, Clone)]
pub struct ComplexModes {
    /// The modes.
    pub modes: Vec<ComplexMode>,
    /// Size of the projected problem.
    pub subspace_dimension: usize,
    /// Refinement steps at full order.
    pub refinements: usize,
    /// Warnings: a count that changed, a mode not accepted, too few real modes.
    pub warnings: Vec<String>,
    /// A premise of every statement on stability that is false: such as a mass matrix with negative eigenvalues.
    pub broken_premise: Option<&'static str>,
}

impl ComplexModes {
    /// Re φ/|λ| and Im φ/|λ| of each mode, of which φᴴMφ = 1 makes the energy about one; those with λ = 0 are left out.
    pub fn parts(&self) -> Mat<f64> {
        let modes: Vec<&ComplexMode> = self.modes.iter().filter(|mode| !mode.is_zero()).collect();
        let n = modes.first().map_or(0, |mode| mode.right.len());
        Mat::from_fn(n, 2 * modes.len(), |i, j| {
            let mode = modes[j / 2];
            let part = if j % 2 == 0 { mode.right[i].re } else { mode.right[i].im };
            part / mode.eigenvalue.norm()
        })
    }
}

/// One complex mode with the measures of its own error.
#[derive(Debug, Clone)]
pub struct ComplexMode {
    /// λ = σ + iω \[1/s\].
    pub eigenvalue: c64,
    /// φ on the degrees of freedom, scaled to φᴴMφ = 1.
    pub right: Vec<c64>,
    /// ψ, ψᴴ Q(λ) = 0, scaled to ‖ψ‖_M = 1; empty where left vectors were not requested ([`Band::left_vectors`]).
    pub left: Vec<c64>,
    /// η = ‖Q(λ)φ‖ / ((|λ|²‖M‖ + |λ|(‖C‖ + ‖C_c‖) + ‖K‖ + ‖K_c‖)‖φ‖).
    pub backward_error: f64,
    /// Estimated |Δλ| / |λ|, within a factor of two: that from the residuals of both vectors, the first term of a series, and the least that rounding leaves,
    /// 10 ε κ + 40 ε |ψ|ᵀ|W| |k + λ c| |W|ᵀ|φ| / |λ ψᴴQ′(λ)φ| of an interface W (k + λ c) Wᵀ: a stiff contact makes large
    /// forces from the last digits of motions. Near coalescence it is at most ∛(10 ε) that rounding leaves.
    ///
    /// An eigenvalue that is zero but for rounding, |λ|² ≤ 100 p with p = 10 ε |φ|ᵀ|K||φ| + |ψᴴQ(λ)φ| + …, is given as 0 within its
    /// uncertainty: p/|ψᴴQ′φ|, or √p where it is double, as of a rigid body, a drift or at the onset of divergence. Its error is
    /// relative to √(|φ|ᵀ|K||φ|), or to a thousandth of the band's top.
    pub eigenvalue_error: f64,
    /// Estimated |Δλ| \[1/s\].
    pub uncertainty: f64,
    /// Condition number of λ, 2|λ| ‖ψ‖_M ‖φ‖_M / |ψᴴ(2λM + C + C_c)φ|: 1 for an undamped symmetric system, large near
    /// coalescence.
    pub condition: f64,
    /// Where the growth comes from.
    pub growth: GrowthBudget,
    /// Share of each real mode in φ (index into the real modes, share in [0, 1]), largest first.
    pub participation: Vec<(usize, f64)>,
}

/// The terms of σ in 2σω + ω φᴴ(C + C_c)φ + Im φᴴ(K + K_c)φ = 0 \[1/s\]; they add up to the growth rate.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GrowthBudget {
    /// C, the loss factors and damping of the contact's normal motion (negative: dissipates).
    pub structural_damping: f64,
    /// Falling friction μ′(v).
    pub falling_friction: f64,
    /// Friction turning with the transverse slip.
    pub transverse_friction: f64,
    /// The unsymmetric part of the contact stiffness.
    pub mode_coupling: f64,
}

impl ComplexMode {
    /// σ \[1/s\].
    pub fn growth_rate(&self) -> f64 {
        self.eigenvalue.re
    }

    /// ω/2π \[Hz\]; 0 where ω is below the rounding of λ, as that of a real eigenvalue may be.
    pub fn frequency_hz(&self) -> f64 {
        let (omega, size) = (self.eigenvalue.im, self.eigenvalue.norm());
        if omega.abs() < f64::EPSILON * size { 0.0 } else { omega / std::f64::consts::TAU }
    }

    /// −σ/|λ|; negative when unstable.
    pub fn damping_ratio(&self) -> f64 {
        -self.eigenvalue.re / self.eigenvalue.norm().max(f64::MIN_POSITIVE)
    }

    /// Whether λ is zero but for rounding: of rigid-body motion, a drift, or at the onset of divergence.
    pub fn is_zero(&self) -> bool {
        self.eigenvalue == c64::new(0.0, 0.0)
    }

    /// Verdict by its growth rate.
    pub fn verdict(&self) -> Verdict {
        if !self.accurate() {
            Verdict::Inaccurate
        } else if self.within_error() {
            Verdict::Undecided
        } else if unstable(self.eigenvalue) {
            Verdict::Unstable
        } else {
            Verdict::Stable
        }
    }

    /// Whether the estimated |Δλ|/|λ| is at most [`LARGEST_EIGENVALUE_ERROR`], and at most [`ACCEPTED_EIGENVALUE_ERROR`] where η is
    /// above [`LARGEST_BACKWARD_ERROR`]; another mode is neither stable nor unstable.
    pub fn accurate(&self) -> bool {
        let settled = self.backward_error <= LARGEST_BACKWARD_ERROR || self.accepted();
        settled && self.eigenvalue_error <= LARGEST_EIGENVALUE_ERROR
    }

    /// The frequency and both errors in words.
    pub fn errors(&self) -> String {
        let cause = if self.condition > 1e4 { ", near the coalescence of two modes" } else { "" };
        format!(
            "the mode at {} Hz: relative eigenvalue error {:.1e}, backward error {:.1e}{cause}",
            hertz(self.frequency_hz(), 2),
            self.eigenvalue_error,
            self.backward_error
        )
    }

    /// Whether the estimated |Δλ|/|λ| is at most [`ACCEPTED_EIGENVALUE_ERROR`]; of a λ that is zero its root, as that of λ² decides.
    pub fn accepted(&self) -> bool {
        let most = ACCEPTED_EIGENVALUE_ERROR;
        self.eigenvalue_error <= if self.is_zero() { most.sqrt() } else { most }
    }

    /// Whether both vectors are there, on `n` degrees of freedom.
    fn of_size(&self, n: usize) -> bool {
        self.right.len() == n && self.left.len() == n
    }

    /// Whether the mode grows by more than round-off and the error of λ.
    pub fn unstable(&self) -> bool {
        self.verdict() == Verdict::Unstable
    }

    /// Whether |σ| is within the error of λ, and that error beyond round-off: so it is where flutter sets in and two modes have
    /// become one, λ being as exact there as the root of round-off.
    fn within_error(&self) -> bool {
        let size = self.eigenvalue.norm();
        let error = self.resolution();
        error > ROUND_OFF * size && self.eigenvalue.re.abs() <= error
    }

    /// What λ is resolved to \[1/s\]: its uncertainty, and at least what the backward error and a few roundings make of it by its condition,
    /// max(η, 10 ε) κ |λ|.
    pub fn resolution(&self) -> f64 {
        let relative = self.backward_error.max(ROUNDING) * self.condition;
        self.uncertainty.max(relative * self.eigenvalue.norm())
    }
}

/// A sentence for each mode that is not as accurate as it should be.
fn accuracy_warnings(modes: &[ComplexMode]) -> impl Iterator<Item = String> {
    modes.iter().filter(|mode| !mode.accepted()).map(|mode| {
        let degree = if mode.accurate() { "less accurate than aimed at" } else { "not accurate" };
        format!("A mode is {degree}: {}", mode.errors())
    })
}

/// Stability of a complex mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The mode does not grow.
    Stable,
    /// σ exceeds round-off and the error of λ.
    Unstable,
    /// |σ| is within the error of λ, [`ComplexMode::resolution`].
    Undecided,
    /// λ itself is not accurate ([`ComplexMode::accurate`]).
    Inaccurate,
}

impl Verdict {
    /// The word for it in all outputs.
    pub fn word(self) -> &'static str {
        match self {
            Verdict::Stable => "stable",
            Verdict::Unstable => "unstable",
            Verdict::Undecided => "undecided",
            Verdict::Inaccurate => "not accurate",
        }
    }
}

/// The largest η of a mode that is accurate.
pub const LARGEST_BACKWARD_ERROR: f64 = 1e-10;

/// The |Δλ|/|λ| below which a mode is accurate whatever its η, which says little where the matrices have large norms.
pub const ACCEPTED_EIGENVALUE_ERROR: f64 = 1e-8;

/// The largest |Δλ|/|λ| of a mode that is accurate: its frequency has four digits.
pub const LARGEST_EIGENVALUE_ERROR: f64 = 1e-4;

/// A mode counts as unstable when σ exceeds this share of |λ|: the round-off of an undamped mode is below it, and past
/// a flutter onset, where σ grows like the square root of the distance, it is reached within 1e-18 of the onset.
pub const ROUND_OFF: f64 = 1e-9;

/// The error of λ over |λ| that a few roundings leave, by the condition number of λ.
const ROUNDING: f64 = 10.0 * f64::EPSILON;

/// The same by the work of the interface without cancellation: a few roundings each of WᵀB, of k WᵀB, of their product and of
/// its product with the coordinates of φ.
const CONTACT_ROUNDING: f64 = 4.0 * ROUNDING;

/// λ is zero but for rounding up to |λ|² of this many times what rounding makes of it.
const NEAR_ZERO: f64 = 100.0;

/// Whether λ is real but for rounding.
pub(crate) fn is_real(lambda: c64) -> bool {
    lambda.im.abs() <= 1e-9 * lambda.norm()
}

/// Whether a mode grows by more than round-off.
pub fn unstable(lambda: c64) -> bool {
    lambda.re > ROUND_OFF * lambda.norm()
}
