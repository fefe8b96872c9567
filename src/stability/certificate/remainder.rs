//! Bound of the coupling to the complement of the basis.
//!
//! Z is the complement of the basis B that is orthogonal to it in A = K + K_σ − σ_A M, the matrix that the analysis has
//! factorised. Every real mode below Ω_b is in B, so that A is positive on Z, and with P(s) = s²M + sC + K + K_σ + iH
//!
//! Re xᴴP(s)x ≥ (Re s² + w) ‖x‖²_M with w ≥ Ω_b², hence Re xᴴP(s)x ≥ xᴴAx / q(s), q(s) = (w − σ_A) / (w + Re s²) at its
//! largest,
//!
//! for any loss factors and any viscous damping that dissipates. As ZᵀKB = σ_A ZᵀMB, the structure couples Z and B by
//! Γ(s) = (s² + σ_A + s(α + βσ_A) + i(α_h + β_hσ_A)) ZᵀMB + s ZᵀDB + i ZᵀH_rB alone. Elimination of B gives
//!
//! det Q(s) = det Q_B(s) · det(P_ZZ(s) − E(s)), E = Γ D_B Γᵀ − (Y − W_Z) κ N⁻¹ (Y − W_Z)ᵀ, Y = Γ D_B W_B,
//!
//! with D_B the inverse of the structure's part of Q_B and N = I + W_BᵀD_BW_B κ. Where ρ = q ‖E‖ < 1 (‖·‖ relative to A
//! on both sides) P_ZZ − tE is regular for every t in \[0, 1\], so that det Q and det Q_B wind alike. The norms need
//! S = ZᵀF (ZᵀAZ)⁻¹FᵀZ = Fᵀ(A⁻¹ − B(BᵀAB)⁻¹Bᵀ)F of the columns F = \[MB DB H_rB W\] only, of W in many directions of its images
//! W κ W_Bᵀ and W κᵀ W_Bᵀ ([`FewRows`]) and of ‖W_Z κ W_Zᵀ‖ ([`missed`](super::missed)). As A⁻¹ − B(BᵀAB)⁻¹Bᵀ takes AB
//! to zero, F may first lose what the real modes Φ make of it: with F' = F − AΦ diag(ΦᵀAΦ)⁻¹ΦᵀF nothing small is lost in what
//! is resonant, and S = F'ᵀA⁻¹F' − F'ᵀB(BᵀAB)⁻¹BᵀF' is half a block solve ([`compliances`]) less a small matrix. What rounding
//! may hide in it is measured (`Probes`) and added.

use super::coupling_factor::CouplingFactor;
use super::damping::DampingParts;
use super::few_rows::{FewRows, ImageKind};
use super::missed::{DirectionGroup, Missed};
use super::probes::{Probes, RitzPairs};
use crate::dynamics::{Damper, DamperPart};
use crate::error::Result;
use crate::linalg::dense::{product, symmetric_eigen};
use crate::linalg::factor::{SymmetricFactor, compliances, inertia_like};
use crate::linalg::multivector::{combine, expand, panels};
use crate::linalg::sparse::{add_scaled, multiply, times};
use crate::linalg::{SparseMatrix, c64};
use crate::stability::analysis::CompletedAnalysis;
use faer::{Accum, Mat, MatRef};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Γ(s) in the A-norm of Z, and what q(s) needs.
#[derive(Debug)]
pub(super) struct Remainder {
    /// Ω_b²: no real mode below it is outside the basis.
    pub(super) complete_below: f64,
    /// σ_A.
    pub(super) shift: f64,
    /// The terms of Γ(s)ᵀ (m × f each), with the polynomial that multiplies each.
    pub(super) terms: Vec<(CouplingFactor, Mat<f64>)>,
    /// γ \[s\]: C ≥ −γ (K + τM) outside the basis.
    pub(super) indefinite: f64,
    /// τ of γ \[1/s²\].
    pub(super) tau: f64,
    /// Those of (W_Z κ W_Bᵀ)ᵀ and of W_B κ W_Zᵀ.
    pub(super) contact: [Vec<(CouplingFactor, Mat<f64>)>; 2],
    pub(super) missed: Missed,
}

impl Remainder {
    /// Solves for A⁻¹F, with `theta` and `x` the Ritz values and vectors in the basis, and W of the `active` directions.
    pub(super) fn new(
        analysis: &CompletedAnalysis<'_>,
        parts: &DampingParts,
        theta: &[f64],
        x: &Mat<f64>,
        active: &[usize],
        indefinite: f64,
    ) -> Result<Self> {
        let (operator, basis, shift) = (&analysis.operator, &analysis.basis, analysis.shift);
        let (m, first) = (basis.len(), basis.n_real());
        let top = TAU * analysis.band_hz[1];
        let beyond = m - first;
        // Of one size, so that the smallest are not lost in the rounding of the largest: \[top MB, DB, H_rB/top, …\].
        let FewRows { columns: few, images, directions } = FewRows::new(analysis, parts, active);
        let f = beyond + few.values.ncols();
        let mut forces = Mat::zeros(operator.n(), f);
        for (start, width) in panels(0..beyond) {
            let mut inertia = forces.subcols_mut(start, width);
            multiply(operator.mass, basis.added.subcols(start, width), inertia.as_mut());
            inertia *= faer::Scale(top);
        }
        few.write(forces.subcols_mut(beyond, f - beyond));
        // BᵀF', and F': MB has nothing of the real modes, to which the others are orthogonal.
        let mut share = Mat::zeros(m, f);
        share.subcols_mut(0, beyond).copy_from(basis.mass.subcols(first, beyond) * faer::Scale(top));
        share.subcols_mut(beyond, f - beyond).copy_from(few.seen_by(&basis.columns()));
        let small = &basis.stiffness - &basis.mass * faer::Scale(shift);
        let taken = Mat::from_fn(first, f - beyond, |i, j| share[(i, beyond + j)] / small[(i, i)]);
        let a = add_scaled(&[(1.0, &*operator.stiffness), (-shift, operator.mass)]);
        for (start, width) in panels(0..first) {
            let of_basis = times(&a, basis.modes.subcols(start, width));
            let forces = forces.subcols_mut(beyond, f - beyond);
            combine(forces, Accum::Add, of_basis.as_ref(), taken.subrows(start, width), -1.0);
        }
        drop(a);
        let mut rest = share.subcols_mut(beyond, f - beyond);
        rest -= product(small.subcols(0, first), taken.as_ref());
        let combinations = Probes::combinations(f);
        let probes = Probes::new(analysis, expand(forces.as_ref(), combinations.as_ref()));
        let mut square = compliances(analysis.factor, forces.as_mut());
        drop(forces);
        let rounding = probes.error(&combinations, &product(square.as_ref(), combinations.as_ref()));
        // BᵀAB = diag(θ − σ) for the Ritz vectors.
        let ritz = RitzPairs { x, distances: theta.iter().map(|theta| theta - shift).collect() };
        square -= product(share.transpose(), ritz.solution(&share).as_ref());
        let (values, vectors) = symmetric_eigen(square.as_ref())?;
        // A root of it, one row a column of F, made larger by its rounding: those of the few rows represent all that they span.
        let size = |value: f64| (value.max(0.0) + rounding).sqrt();
        let root = Mat::from_fn(f, f, |i, j| vectors[(i, j)] * size(values[j]));
        let of_few = root.as_ref().subrows(beyond, f - beyond);
        let inertia = Mat::from_fn(m, f, |i, j| if i < first { 0.0 } else { root[(i - first, j)] / top });
        let in_ritz = |rows: MatRef<'_, f64>| product(x.transpose(), rows);
        let mut terms = vec![(of_mass(analysis), in_ritz(inertia.as_ref()))];
        let mut contact = [Vec::new(), Vec::new()];
        for image in images {
            let rows = product(image.coefficients.transpose(), of_few);
            let term = (image.factor, in_ritz(rows.as_ref()));
            match image.kind {
                ImageKind::Damping => terms.push(term),
                ImageKind::Interface { transposed } => contact[usize::from(transposed)].push(term),
            }
        }
        let groups = DirectionGroup::of(analysis, active);
        let sizes = match &directions {
            Some(coefficients) => {
                let all = product(coefficients.transpose(), of_few);
                let of = |group: &DirectionGroup| group.largest_of_rows(active, all.as_ref());
                groups.iter().map(of).collect::<Result<Vec<f64>>>()?
            }
            None => DirectionGroup::largest(&groups, analysis, &ritz)?,
        };
        Ok(Remainder {
            complete_below: analysis.complete_below,
            shift,
            terms,
            contact,
            indefinite,
            tau: top * top,
            missed: Missed::new(analysis, &sizes),
        })
    }

    /// The largest q(s) for Re s in \[`growth`\] and |Im s| ≤ `omega`; infinite when P may be singular on Z.
    pub(super) fn amplification(&self, growth: [f64; 2], omega: f64) -> f64 {
        let gamma = self.indefinite * growth[1].max(0.0);
        let slope = 1.0 - gamma;
        let constant = growth[0].max(0.0).powi(2) - omega * omega - gamma * self.tau;
        let at = |w: f64| (w - self.shift) / (slope * w + constant);
        let bottom = slope * self.complete_below + constant;
        if self.complete_below <= self.shift || slope <= 0.0 || bottom.is_nan() || bottom <= 0.0 {
            return f64::INFINITY;
        }
        at(self.complete_below).max(1.0 / slope)
    }
}

/// s² + (α + βσ_A) s + σ_A + i(α_h + β_hσ_A), which multiplies ZᵀMB in Γ.
fn of_mass(analysis: &CompletedAnalysis<'_>) -> CouplingFactor {
    let Damper { viscous, loss, .. } = &analysis.operator.dampers[0];
    let [(alpha, beta), (alpha_h, beta_h)] =
        [viscous, loss].map(|part| (part.split.mass_factor, part.split.stiffness_factor));
    let shift = analysis.shift;
    CouplingFactor {
        square: 1.0,
        linear: alpha + beta * shift,
        constant: c64::new(shift, alpha_h + beta_h * shift),
    }
}

/// γ with C ≥ −γ(K + K_σ + τM) outside the basis, τ the square of the band's top, and whether C and H are known to be
/// positive semidefinite; `lowest` is the least ω² of the basis. What is not known to be semidefinite by its factors α, β and few rows is
/// settled by the inertia of C + γ(K + K_σ + τM) for growing γ.
pub(super) fn dissipation(
    analysis: &CompletedAnalysis<'_>,
    parts: &DampingParts,
    lowest: f64,
) -> (f64, bool) {
    let (operator, damping) = (&analysis.operator, analysis.operator.damping);
    let top = TAU * analysis.band_hz[1];
    let worst_modal =
        damping.modal.as_ref().map_or(0.0, |modal| modal.coefficients.iter().fold(0.0f64, |w, c| w.max(-c)));
    let lowest = if analysis.complete_below > 0.0 { lowest.min(0.0) } else { f64::NEG_INFINITY };
    let energy = || add_scaled(&[(1.0, &*operator.stiffness), (top * top, operator.mass)]);
    let settle = |whole: &Option<Arc<SparseMatrix>>, part: &DamperPart, unit: f64| match whole {
        Some(whole) if !part.dissipates(lowest) => least_shift(analysis.factor, whole, &energy(), unit),
        _ => Some(0.0),
    };
    let Damper { viscous, loss, .. } = &operator.dampers[0];
    let viscous = settle(&damping.viscous, viscous, 1.0 / top);
    let losses = settle(&damping.hysteretic, loss, 1.0);
    let modal = if parts.modal_inside { 0.0 } else { worst_modal / (top * top) };
    let dissipative = worst_modal == 0.0
        && viscous.is_some_and(|g| g * top <= 2.0 * SHIFTS[0])
        && losses.is_some_and(|g| g <= 2.0 * SHIFTS[0]);
    (viscous.unwrap_or(f64::INFINITY) + modal, dissipative)
}

/// Shifts that are tried; the first is round-off.
const SHIFTS: [f64; 5] = [1e-9, 1e-7, 1e-5, 1e-3, 1e-1];

/// The least of the shifts (in `unit`) for which `a` + shift · `energy` has no negative eigenvalue; `known` is a factor
/// with the pattern of the energy.
fn least_shift(
    known: &dyn SymmetricFactor,
    a: &SparseMatrix,
    energy: &SparseMatrix,
    unit: f64,
) -> Option<f64> {
    let definite = |g: &&f64| {
        let sum = add_scaled(&[(1.0, a), (**g * unit, energy)]);
        inertia_like(known, &sum).is_ok_and(|inertia| inertia.negative == 0)
    };
    SHIFTS.iter().find(definite).map(|g| g * unit)
}
