//! Accelerations of the real modes, and the sound that follows from them.

use super::history_writer::HistoryWriter;
use crate::error::Result;
use crate::linalg::SparseMatrix;
use crate::linalg::sparse::times;
use crate::modal::RealModes;
use crate::results::{Sound, modal_channel};
use crate::sound::{BLOCK, Listener};
use faer::Mat;
use rayon::prelude::*;

/// q̈ = ΦᵀM ü, step by step \[√kg m/s²\]: a sound needs all of them, and they are few.
pub(super) struct ModalMotion {
    /// M Φ of a full model; the first coordinates of a reduced one are those of the modes.
    weights: Option<Mat<f64>>,
    /// The rows at hand, by mode.
    pub(super) rows: Vec<Vec<f32>>,
}

impl ModalMotion {
    /// Of the full model with the mass matrix `mass`, or of a reduced one.
    pub(super) fn new(real: &RealModes, mass: Option<&SparseMatrix>) -> Self {
        let weights = mass.map(|mass| times(mass, real.shapes.as_ref()));
        ModalMotion { weights, rows: vec![Vec::new(); real.len()] }
    }

    /// Adds the accelerations of a step.
    pub(super) fn take(&mut self, acceleration: &[f64]) {
        match &self.weights {
            None => self.rows.iter_mut().zip(acceleration).for_each(|(row, a)| row.push(*a as f32)),
            Some(weights) => self.rows.par_iter_mut().enumerate().for_each(|(mode, row)| {
                let products = weights.col_as_slice(mode).iter().zip(acceleration).map(|(w, a)| w * a);
                row.push(products.sum::<f64>() as f32);
            }),
        }
    }

    /// Lets go of the rows at hand.
    pub(super) fn forget(&mut self) {
        self.rows.iter_mut().for_each(Vec::clear);
    }
}

impl HistoryWriter<'_, '_> {
    /// What is heard of the record of `rows` rows.
    pub(super) fn heard(&self, mut listener: Listener, rows: usize) -> Result<Sound> {
        let modes = self.recorder.modal.as_ref().map_or(0, |modal| modal.rows.len());
        for first in (0..rows).step_by(BLOCK) {
            let part = first..rows.min(first + BLOCK);
            let read = |mode: usize| self.sink.recorded(&modal_channel(mode), part.clone());
            listener.hear((0..modes).map(read).collect::<Result<Vec<Vec<f64>>>>()?);
        }
        Ok(listener.finish())
    }
}
