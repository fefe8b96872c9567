//! Linear algebra for large sparse symmetric problems; knows no mechanics.
//!
//! * [`sparse`]: the matrix type of the whole program, sparse vectors, products.

pub mod sparse;

pub use faer::c64;
pub use sparse::{SparseMatrix, SparseVector};
