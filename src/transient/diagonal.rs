//! Structures whose matrices are all diagonal, as those of reduced models: nothing to factorise, a few products a step.

use crate::linalg::SparseMatrix;
use crate::system::Damping;
use faer::{MatMut, MatRef};

/// The diagonals of M, K and C.
#[derive(Debug)]
pub(super) struct Diagonal {
    pub(super) mass: Vec<f64>,
    pub(super) stiffness: Vec<f64>,
    /// Zero without viscous damping.
    pub(super) viscous: Vec<f64>,
}

impl Diagonal {
    /// That of a structure, if it is one.
    pub(super) fn of(mass: &SparseMatrix, stiffness: &SparseMatrix, damping: &Damping) -> Option<Self> {
        if damping.modal.is_some() {
            return None;
        }
        let viscous = match &damping.viscous {
            Some(c) => diagonal(c)?,
            None => vec![0.0; mass.ncols()],
        };
        Some(Diagonal { mass: diagonal(mass)?, stiffness: diagonal(stiffness)?, viscous })
    }
}

/// The entries of a matrix that has none beside its diagonal.
fn diagonal(a: &SparseMatrix) -> Option<Vec<f64>> {
    let mut values = vec![0.0; a.ncols()];
    for (j, value) in values.iter_mut().enumerate() {
        for entry in a.col_ptr()[j]..a.col_ptr()[j + 1] {
            if a.row_idx()[entry] != j {
                return None;
            }
            *value = a.val()[entry];
        }
    }
    Some(values)
}

/// y = diag(d) x.
pub(super) fn scale(d: &[f64], x: MatRef<'_, f64>, mut y: MatMut<'_, f64>) {
    for k in 0..x.ncols() {
        let column = y.as_mut().col_mut(k).iter_mut().zip(x.col(k).iter());
        column.zip(d).for_each(|((y, x), d)| *y = d * x);
    }
}
