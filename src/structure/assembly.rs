//! M, C and K of a model on its free degrees of freedom: Tᵀ (Σ elements) T.

use super::check::check_model;
use super::dofs::DofMap;
use super::model::Model;
use super::pieces::{PieceMatrices, pieces};
use super::scatter::{Pattern, reduced};
use crate::error::{Error, Fault, Result};
use crate::linalg::SparseMatrix;
use crate::system::{Damping, Prestress, Structure};
use std::sync::Arc;

/// A model's matrices, and how its free degrees of freedom relate to its nodes.
#[derive(Debug, Clone)]
pub struct Assembled {
    /// M, C (Rayleigh and dashpots), η K, K; modal damping is added when the modes are known.
    pub structure: Structure,
    /// u = T q.
    pub dofs: Arc<DofMap>,
    /// Mass of all parts and points \[kg\], held nodes included.
    pub total_mass: f64,
    /// Its centre \[m\]; the origin when there is no mass.
    pub center_of_mass: [f64; 3],
    pattern: Arc<Pattern>,
}

/// Assembles M, C and K of `model`.
///
/// M and K are symmetric to the last bit, share one sparsity pattern, and do not depend on the number of threads.
///
/// # Errors
/// Every fault of the model at once: see the rules of a sound [`Model`] (positive thickness, E > 0, −1 < ν < ½, ρ ≥ 0,
/// nodes that exist, elements with an extent, links without circles, supports on nodes that lead).
pub fn assemble(model: &Model) -> Result<Assembled> {
    check_model(model)?;
    let dofs = DofMap::new(model)?;
    let pieces = pieces(model);
    let piece_nodes: Vec<Vec<usize>> = pieces.iter().map(|piece| piece.nodes().collect()).collect();
    let pattern = Pattern::new(&dofs, &piece_nodes);
    let [mass, stiffness, viscous, hysteretic] = pattern.sum(|p, coupled| {
        let PieceMatrices { mass, stiffness, viscous, hysteretic } = pieces[p].matrices(&model.nodes);
        let reduce = |full| reduced(&dofs, &piece_nodes[p], coupled, full);
        [
            reduce(&mass),
            reduce(&stiffness),
            viscous.as_ref().map(reduce).unwrap_or_default(),
            hysteretic.as_ref().map(reduce).unwrap_or_default(),
        ]
    });
    let (mut total_mass, mut moment) = (0.0, [0.0; 3]);
    for piece in &pieces {
        let (mass, center) = piece.mass_and_center(&model.nodes);
        total_mass += mass;
        for (m, c) in moment.iter_mut().zip(center) {
            *m += mass * c;
        }
    }
    let center_of_mass = if total_mass > 0.0 { moment.map(|m| m / total_mass) } else { [0.0; 3] };
    let structure = Structure {
        mass: mass.unwrap_or_else(|| pattern.zero()),
        stiffness: stiffness.unwrap_or_else(|| pattern.zero()),
        damping: Damping { viscous, modal: None, hysteretic },
    };
    Ok(Assembled { structure, dofs: Arc::new(dofs), total_mass, center_of_mass, pattern: Arc::new(pattern) })
}

impl Assembled {
    /// The geometric stiffness of `model`, the one that was assembled, under a static displacement.
    pub fn prestress(&self, model: Model) -> GeometricStiffness {
        GeometricStiffness { model, dofs: Arc::clone(&self.dofs), pattern: Arc::clone(&self.pattern) }
    }
}

/// K_σ(u₀) of shells (their mean membrane forces) and bars (their axial forces), on the pattern of K.
///
/// Bending-only plates carry no membrane forces and give none. The turning of the lever arms of rigid links under
/// load is not part of it.
#[derive(Debug)]
pub struct GeometricStiffness {
    model: Model,
    dofs: Arc<DofMap>,
    pattern: Arc<Pattern>,
}

impl Prestress for GeometricStiffness {
    fn geometric_stiffness(&self, displacement: &[f64]) -> Result<SparseMatrix> {
        if displacement.len() != self.dofs.n_dofs() || displacement.iter().any(|u| !u.is_finite()) {
            return Err(Error::input(Fault::new(
                "geometric stiffness",
                format!("a displacement of {} values, or one that is not finite", displacement.len()),
                format!("{} finite values", self.dofs.n_dofs()),
            )));
        }
        let u = self.dofs.expand(displacement);
        let pieces = pieces(&self.model);
        let [sum] = self.pattern.sum(|p, coupled| {
            let nodes: Vec<usize> = pieces[p].nodes().collect();
            let full = pieces[p].geometric_stiffness(&self.model.nodes, &u);
            [full.map(|k| reduced(&self.dofs, &nodes, coupled, &k)).unwrap_or_default()]
        });
        Ok(sum.unwrap_or_else(|| self.pattern.zero()))
    }
}
