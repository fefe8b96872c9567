//! How stages of a run are written to `results.h5`; how it is written safely: `file.rs`.

use super::{ResultsFile, RunResults, summary};
use crate::dataset::Group;
pub(super) use crate::dataset::attribute;
use crate::error::Result;
use ndarray::Array2;

impl ResultsFile {
    /// Writes what is known before the first analysis: title, resolved case, inputs, size, nodes and elements.
    pub fn write_head(&mut self, results: &RunResults) -> Result<()> {
        let head = summary::model(results);
        self.stage(|root| head.write_hdf5(root))
    }

    /// Writes what an analysis has found.
    pub fn write(&mut self, group: &Group) -> Result<()> {
        self.keep(|root| group.write_hdf5(root))
    }
}

pub(super) fn rows<const N: usize>(values: &[[f64; N]]) -> Array2<f64> {
    Array2::from_shape_fn((values.len(), N), |(i, j)| values[i][j])
}
