//! Damping of a structure, applied to vectors whose M x and K x are known.

use crate::linalg::SparseMatrix;
use crate::linalg::dense::product;
use crate::linalg::multivector::{Columns, expand, gram};
use crate::linalg::proportional::Proportional;
use crate::linalg::row_sparse::RowSparse;
use crate::linalg::sparse::times;
use crate::system::{Damping, ModalDamping};
use faer::{Mat, MatRef};
use std::sync::Arc;

/// C and H of a structure, each α M + β K, a few rows, and what is wide: seldom all of them.
#[derive(Debug, Clone)]
pub(crate) struct Damper<'a> {
    pub(crate) viscous: DamperPart,
    pub(crate) loss: DamperPart,
    pub(crate) modal: Option<&'a ModalDamping>,
}

/// C, but for modal damping, or H.
#[derive(Debug, Clone, Default)]
pub(crate) struct DamperPart {
    /// α M + β K + rest.
    pub(crate) split: Proportional,
    /// The rest, where it has entries in few rows.
    pub(crate) few: Option<RowSparse>,
}

/// Vectors B and Y, with BᵀMY and BᵀKY.
pub(crate) struct Between<'a> {
    pub(crate) b: Columns<'a>,
    pub(crate) y: MatRef<'a, f64>,
    pub(crate) mass: MatRef<'a, f64>,
    pub(crate) stiffness: MatRef<'a, f64>,
}

impl DamperPart {
    fn new(x: Option<&SparseMatrix>, mass: &SparseMatrix, stiffness: &SparseMatrix) -> Self {
        let Some(x) = x else { return DamperPart::default() };
        let split = Proportional::split(x, mass, stiffness);
        let few = split.rest.as_ref().map(RowSparse::new).filter(|few| few.are_few(x.ncols()));
        DamperPart { split, few }
    }

    /// The rest, where it has entries in many rows.
    pub(crate) fn wide(&self) -> Option<&SparseMatrix> {
        self.split.rest.as_ref().filter(|_| self.few.is_none())
    }

    /// Whether α M + β K + rest is known to have no negative eigenvalue but for rounding, where K − `lowest` M has none
    /// (`lowest` ≤ 0): known from few rows, without the whole matrix.
    pub(crate) fn dissipates(&self, lowest: f64) -> bool {
        let Proportional { mass_factor, stiffness_factor, .. } = self.split;
        let least = if stiffness_factor == 0.0 { 0.0 } else { stiffness_factor * lowest };
        let proportional = stiffness_factor >= 0.0 && mass_factor + least >= 0.0;
        let rest = self.split.rest.is_none() || self.few.as_ref().is_some_and(RowSparse::is_semidefinite);
        proportional && rest
    }

    /// BᵀXY.
    pub(crate) fn form(&self, Between { b, y, mass, stiffness }: &Between<'_>) -> Mat<f64> {
        let Proportional { mass_factor, stiffness_factor, .. } = self.split;
        let mut form = *mass * faer::Scale(mass_factor) + *stiffness * faer::Scale(stiffness_factor);
        if let Some(few) = &self.few {
            form += gram(b.picked(few.rows()).as_ref(), few.times(*y).as_ref());
        }
        if let Some(wide) = self.wide() {
            form += b.gram(times(wide, *y).as_ref());
        }
        form
    }
}

impl<'a> Damper<'a> {
    pub(crate) fn new(damping: &'a Damping, mass: &SparseMatrix, stiffness: &SparseMatrix) -> Self {
        let part = |x: &Option<Arc<SparseMatrix>>| DamperPart::new(x.as_deref(), mass, stiffness);
        let (viscous, loss) = rayon::join(|| part(&damping.viscous), || part(&damping.hysteretic));
        Damper { viscous, loss, modal: damping.modal.as_ref() }
    }

    /// [`DamperPart::form`] of C, modal damping included.
    pub(crate) fn viscous_form(&self, of: &Between<'_>) -> Mat<f64> {
        let mut form = self.viscous.form(of);
        if let Some(modal) = self.modal {
            form += product(of.b.gram(modal.basis.as_ref()).as_ref(), amplitudes(modal, of.y).as_ref());
        }
        form
    }
}

/// C x of modal damping.
pub(crate) fn modal_times(modal: &ModalDamping, x: MatRef<'_, f64>) -> Mat<f64> {
    expand(modal.basis.as_ref(), amplitudes(modal, x).as_ref())
}

/// diag(c) Bᵀx of C = B diag(c) Bᵀ.
fn amplitudes(modal: &ModalDamping, x: MatRef<'_, f64>) -> Mat<f64> {
    let mut amplitudes = gram(modal.basis.as_ref(), x);
    for (i, c) in modal.coefficients.iter().enumerate() {
        (0..amplitudes.ncols()).for_each(|j| amplitudes[(i, j)] *= c);
    }
    amplitudes
}
