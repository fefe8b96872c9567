//! The part of a basis in which the eigenvalues of the region are counted where contact has many directions.
//!
//! A basis that grew by hundreds of corrections holds vectors far above the band. Each of them is a term of the bound on what is left
//! out, where it adds up with the others, while left out itself it is part of ‖W_Z κ W_Zᵀ‖, which does not add up. So of the vectors
//! added to the real modes only what the eigenvectors of the region and next to it have of them is kept.

use super::reduced::ReducedModel;
use super::spectrum::Decomposition;
use crate::error::Result;
use crate::linalg::dense::{product, symmetric_eigen};
use crate::stability::analysis::CompletedAnalysis;
use crate::stability::basis::Basis;
use faer::Mat;
use std::f64::consts::TAU;

/// How far eigenvalues are kept, by the top of the band.
const NEAR: f64 = 1.3;
/// What of an eigenvector may be left out, by its length in the E-norm: next to an eigenvalue it counts squared, over the distance.
const LEFT_OUT: f64 = 1e-4;

/// The real modes and the directions that eigenvectors with |λ| up to [`NEAR`] times the band have besides, right and left.
pub(super) fn narrow<'a>(analysis: &CompletedAnalysis<'a>) -> Result<Basis<'a>> {
    let (basis, top) = (analysis.basis, TAU * analysis.band_hz[1]);
    let interface = &analysis.operator.interface;
    let model = ReducedModel::alone(analysis)?;
    let Decomposition { values, right, left, .. } =
        Decomposition::new(&model, &interface.terms, &interface.sizes(top), top)?;
    let near: Vec<usize> =
        (0..values.len()).filter(|k| values[*k].im >= 0.0 && values[*k].norm() <= NEAR * top).collect();
    let (first, beyond) = (basis.n_real(), basis.len() - basis.n_real());
    // BᵀMB = 1 for the Ritz vectors: of eigenvectors of length one there, re and im.
    let parts = Mat::from_fn(basis.len(), 4 * near.len(), |i, j| {
        let vectors = if j % 4 < 2 { &right } else { &left };
        let z = vectors[(i, near[j / 4])];
        let length = vectors.col(near[j / 4]).norm_l2();
        if j % 2 == 0 { z.re / length } else { z.im / length }
    });
    let added = product(model.ritz.as_ref().subrows(first, beyond), parts.as_ref());
    let (sizes, directions) = symmetric_eigen(product(added.as_ref(), added.transpose()).as_ref())?;
    let kept = sizes.iter().filter(|size| **size > LEFT_OUT * LEFT_OUT).count();
    Ok(basis.combined(directions.as_ref().subcols(beyond - kept, kept)))
}
