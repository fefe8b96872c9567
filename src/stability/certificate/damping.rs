//! The damping of a structure beyond what is proportional to M and K.

use super::rows::ColumnBlock;
use crate::dynamics::{Damper, DamperPart, modal_times};
use crate::linalg::multivector::{beside, expand, gram};
use crate::linalg::row_sparse::RowSparse;
use crate::linalg::sparse::times;
use crate::stability::analysis::CompletedAnalysis;
use faer::Mat;

/// Damping of a structure that is not proportional.
pub(super) struct DampingParts {
    /// Whether the modal damping acts on real modes of the basis only.
    pub(super) modal_inside: bool,
    /// D B and H_r B, where D is all of C but its proportional part and the modal damping inside the basis.
    pub(super) damped: Option<ColumnBlock>,
    pub(super) lossy: Option<ColumnBlock>,
}

impl DampingParts {
    pub(super) fn new(analysis: &CompletedAnalysis<'_>) -> Self {
        let (operator, basis) = (&analysis.operator, &analysis.basis);
        let Damper { viscous, loss, modal } = &operator.dampers[0];
        let rest = |part: &DamperPart| {
            let rest = part.split.rest.as_ref().map(RowSparse::new);
            rest.map(|rest| ColumnBlock::image(&rest, &basis.columns()))
        };
        let (modal_inside, mut damped) = (modal_inside(analysis), rest(viscous));
        if let Some(modal) = modal.filter(|_| !modal_inside) {
            let [of_modes, of_added] =
                [basis.modes, basis.added.as_ref()].map(|part| modal_times(modal, part));
            let modal = ColumnBlock::whole(beside(of_modes.as_ref(), of_added.as_ref()));
            damped = Some(match damped {
                Some(rest) => modal.plus(&rest),
                None => modal,
            });
        }
        DampingParts { modal_inside, damped, lossy: rest(loss) }
    }
}

/// Whether every column of M Ψ of the modal damping is M times a combination of the real modes, decided by one
/// combination of the columns with fixed, unrelated weights.
fn modal_inside(analysis: &CompletedAnalysis<'_>) -> bool {
    let Some(modal) = &analysis.operator.damping.modal else { return true };
    let weights = Mat::from_fn(modal.basis.ncols(), 1, |j, _| 1.0 + (1.7 * (j + 1) as f64).sin());
    let probe = expand(modal.basis.as_ref(), weights.as_ref());
    let shapes = analysis.basis.modes;
    let inside = expand(shapes, gram(shapes, probe.as_ref()).as_ref());
    let rest = &probe - times(analysis.operator.mass, inside.as_ref());
    rest.norm_l2() <= 1e-8 * probe.norm_l2()
}
