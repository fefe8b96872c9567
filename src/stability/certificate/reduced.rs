//! The system as its interface sees it: oscillators, what couples them, and a bound on what the basis leaves out.

use super::damping::DampingParts;
use super::remainder::Remainder;
use super::rows::ColumnBlock;
use crate::error::Result;
use crate::linalg::dense::{definite_pencil, product};
use crate::stability::analysis::CompletedAnalysis;
use faer::Mat;
use std::f64::consts::TAU;

/// BᵀQ(s)B = s² + diag(s a + θ + i h) + s C_r + i H_r + W_B κ(s) W_Bᵀ in the coordinates of the Ritz vectors B
/// (BᵀMB = 1, BᵀKB = diag θ): the structure is a row of oscillators, and the interface acts between them.
///
/// But for its remainder it does not depend on the numbers of the contact laws (κ), only on the directions in which contacts act.
#[derive(Debug)]
pub(crate) struct ReducedModel {
    /// The oscillators, ascending in θ.
    pub(super) oscillators: Vec<Oscillator>,
    /// C_r \[1/s\] and H_r \[1/s²\], m × m: damping that couples the real modes.
    pub(super) coupled_damping: Option<Mat<f64>>,
    pub(super) coupled_loss: Option<Mat<f64>>,
    /// The directions of the interface that matter, as indices into those of the operator.
    pub(super) active: Vec<usize>,
    /// W_B of the active directions, m × r.
    pub(super) interface: Mat<f64>,
    /// The Ritz vectors in the basis, one a column.
    pub(super) ritz: Mat<f64>,
    /// Coupling to the complement of the basis; `None` when the basis is the whole space, or when it is not asked for.
    pub(super) remainder: Option<Remainder>,
    /// Whether C and H are known to dissipate.
    pub(super) dissipative: bool,
}

/// p(s) = s² + a s + θ + i h.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Oscillator {
    /// a \[1/s\].
    pub(super) damping: f64,
    /// θ \[1/s²\].
    pub(super) stiffness: f64,
    /// h \[1/s²\].
    pub(super) loss: f64,
}

impl ReducedModel {
    /// Brings the projections of the analysis to diagonal form and bounds what they leave out.
    pub(crate) fn new(analysis: &CompletedAnalysis<'_>) -> Result<Self> {
        ReducedModel::of(analysis, true)
    }

    /// The projections of the analysis in diagonal form.
    pub(super) fn alone(analysis: &CompletedAnalysis<'_>) -> Result<Self> {
        ReducedModel::of(analysis, false)
    }

    fn of(analysis: &CompletedAnalysis<'_>, bounded: bool) -> Result<Self> {
        let (operator, basis) = (&analysis.operator, &analysis.basis);
        let top = TAU * analysis.band_hz[1];
        let parts = DampingParts::new(analysis);
        let (theta, x) = definite_pencil(basis.stiffness.as_ref(), basis.mass.as_ref())?;
        let rotate = |a: &Mat<f64>| product(x.transpose(), product(a.as_ref(), x.as_ref()).as_ref());
        let small = |image: &ColumnBlock| rotate(&image.seen_by(&basis.columns()));
        let mut coupled = parts.damped.as_ref().map(small);
        let mut regular = rotate(&basis.damping);
        if let Some(rest) = &coupled {
            regular -= rest;
        }
        if let Some(doublets) = off_diagonal(&regular, basis.n_real()) {
            coupled = Some(coupled.map_or(doublets.clone(), |rest| rest + doublets));
        }
        let loss = &operator.dampers[0].loss.split;
        let oscillators = (0..theta.len())
            .map(|i| Oscillator {
                damping: regular[(i, i)],
                stiffness: theta[i],
                loss: loss.mass_factor + loss.stiffness_factor * theta[i],
            })
            .collect();
        let active = operator.interface.active(top);
        let w = Mat::from_fn(basis.len(), active.len(), |i, j| basis.interface[(i, active[j])]);
        let lowest = theta.first().copied().unwrap_or(0.0);
        let whole = basis.len() == operator.n() || analysis.complete_below == f64::INFINITY;
        let (indefinite, dissipative) = match bounded {
            true => super::remainder::dissipation(analysis, &parts, lowest),
            false => (0.0, false),
        };
        let remainder = match bounded && !whole {
            true => Some(Remainder::new(analysis, &parts, &theta, &x, &active, indefinite)?),
            false => None,
        };
        Ok(ReducedModel {
            oscillators,
            coupled_damping: coupled,
            coupled_loss: parts.lossy.as_ref().map(small),
            active,
            interface: product(x.transpose(), w.as_ref()),
            ritz: x,
            remainder,
            dissipative,
        })
    }
}

/// The entries off the diagonal, when they are more than the round-off of a diagonal matrix: doublets with different
/// damping ratios.
fn off_diagonal(a: &Mat<f64>, n_real: usize) -> Option<Mat<f64>> {
    let m = a.nrows();
    let typical = (0..n_real.min(m)).fold(0.0f64, |s, i| s.max(a[(i, i)].abs()));
    let kept = Mat::from_fn(m, m, |i, j| {
        let noise = 1e-10 * ((a[(i, i)] * a[(j, j)]).abs().sqrt() + typical);
        if i == j || a[(i, j)].abs() <= noise { 0.0 } else { 0.5 * (a[(i, j)] + a[(j, i)]) }
    });
    (kept.norm_max() > 0.0).then_some(kept)
}
