//! Damping of real modes.

use super::RealModes;
use crate::linalg::SparseMatrix;
use crate::linalg::sparse::{quadratic_forms, times};
use crate::system::{Damping, ModalDamping};

/// ζ = ζ_modal + φᵀCφ/(2ω) + φᵀHφ/(2ω²) of mass-normalised real modes, from ζ_modal of each, C of Rayleigh damping and dashpots,
/// H of loss factors. Rigid-body modes keep ζ_modal.
pub fn damping_ratios(modes: &RealModes, modal: Vec<f64>, damping: &Damping) -> Vec<f64> {
    let mut ratios = modal;
    for (matrix, power) in [(&damping.viscous, 1), (&damping.hysteretic, 2)] {
        let Some(matrix) = matrix else { continue };
        let elastic = modes.rigid_bodies..modes.len();
        let works = quadratic_forms(matrix, modes.shapes.subcols(elastic.start, elastic.len()));
        for (k, work) in elastic.zip(works) {
            let square = modes.eigenvalues[k].max(f64::MIN_POSITIVE);
            ratios[k] += work / (2.0 * square.sqrt().powi(power));
        }
    }
    ratios
}

/// C = M Φ diag(2ζω) Φᵀ M, from ζ of each real mode.
pub fn modal_damping(mass: &SparseMatrix, modes: &RealModes, ratios: &[f64]) -> ModalDamping {
    let coefficient = |k: usize| 2.0 * ratios[k] * modes.eigenvalues[k].max(0.0).sqrt();
    ModalDamping {
        basis: times(mass, modes.shapes.as_ref()),
        coefficients: (0..modes.len()).map(coefficient).collect(),
    }
}
