//! Universal files of SDRC, cut into datasets: of tests, and of finite-element models (*Universal File Datasets Summary*).

mod dataset;
mod file;
mod form;
pub mod record;

pub use dataset::{Binary, Dataset, DatasetLine, shown};
pub use file::datasets;
pub use form::ValueLayout;
