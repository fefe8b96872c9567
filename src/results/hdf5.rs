//! How stages of a run are written to `results.h5`; how it is written safely: `file.rs`.

use super::{NamedModes, ResultsFile, RunResults, summary};
use crate::dataset::{Group as Described, Variable};
pub(super) use crate::dataset::{attribute, describe, text_attribute};
use crate::error::Result;
use hdf5::{Group, H5Type};
use ndarray::{Array2, ArrayView, ArrayViewD, Dimension};

impl ResultsFile {
    /// Writes what is known before the first analysis: title, resolved case, inputs, size, nodes and elements.
    ///
    /// # Errors
    /// As every method of the file: the machine refuses.
    pub fn write_head(&mut self, results: &RunResults) -> Result<()> {
        let case = Variable::text(
            "case",
            "the case with every default written out, as TOML",
            &results.resolved_case,
        );
        let head = summary::head(results).with(case).group(results.geometry.group());
        self.stage(|root| head.write_hdf5(root))
    }

    /// Writes what an analysis has found.
    ///
    /// # Errors
    /// As every method of the file: the machine refuses.
    pub fn write(&mut self, group: &Described) -> Result<()> {
        self.keep(|root| group.write_hdf5(root))
    }

    /// Writes a member of a list of groups.
    ///
    /// # Errors
    /// As every method of the file: the machine refuses.
    pub fn write_member(&mut self, list: &'static str, group: Described) -> Result<()> {
        self.write(&Described::new("", "").list(list, vec![group]))
    }

    /// Writes one set of real modes.
    ///
    /// # Errors
    /// As every method of the file: the machine refuses.
    pub fn write_modes(&mut self, set: &NamedModes) -> Result<()> {
        let group = Described::new("", "").list("mode_sets", vec![set.summary()]);
        self.write(&group.parts("modes", "set", vec![set.table("")]))
    }
}

/// A group whose datasets all carry units and a description.
pub(super) struct Datasets(pub(super) Group);

impl Datasets {
    pub(super) fn list<T: H5Type>(
        &self,
        name: &str,
        data: &[T],
        units: &str,
        description: &str,
    ) -> hdf5::Result<()> {
        self.write(name, ArrayView::from(data), units, description)
    }

    /// Stored whole and uncompressed: mode shapes in full precision hardly shrink, and deflating them took longer than
    /// computing them.
    pub(super) fn write<T: H5Type, D: Dimension>(
        &self,
        name: &str,
        data: ArrayView<'_, T, D>,
        units: &str,
        description: &str,
    ) -> hdf5::Result<()> {
        let data: ArrayViewD<'_, T> = data.into_dyn();
        let dataset = self.0.new_dataset::<T>().shape(data.shape().to_vec()).create(name)?;
        dataset.write(data)?;
        describe(&dataset, units, description)
    }
}

/// The operating system's words inside an error of the library, which runs over several lines, or its first line.
pub(super) fn plain(error: &hdf5::Error) -> String {
    let text = error.to_string();
    if text.contains("Resource temporarily unavailable") {
        return "another program has the file open".into();
    }
    let cause = text.split_once("error message = '").and_then(|(_, rest)| rest.split_once('\''));
    let words = cause.map(|(words, _)| words).or(text.lines().next()).unwrap_or_default();
    // So the library says when it has lost the cause, as it does where room cannot be made.
    if words == "unknown library error" { "the file cannot be written".into() } else { words.into() }
}

pub(super) fn rows<const N: usize>(values: &[[f64; N]]) -> Array2<f64> {
    Array2::from_shape_fn((values.len(), N), |(i, j)| values[i][j])
}
