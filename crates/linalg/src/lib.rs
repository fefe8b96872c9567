//! Linear algebra for large sparse symmetric problems and small dense ones; knows no mechanics.
//!
//! * [`sparse`]: the matrix type of the whole program, sparse vectors, products.
//! * [`factor`]: A = L B Lᵀ of a sparse symmetric matrix, definite or not, with its inertia.
//! * [`eigenpairs`]: the lowest eigenpairs of K x = θ M x with the count that proves none is missing, by
//!   [`lanczos`].
//! * [`assignment`]: the pairs of least total cost.
//! * [`gmres`]: linear systems that are not symmetric, by products and a preconditioner.
//! * [`dense`]: small symmetric eigenproblems and the MAC of two vectors.
//! * [`row_sparse`]: symmetric matrices with entries in a few rows.
//! * [`lu`]: small dense matrices factorised.
//! * [`matrix_market`]: matrices from and to files; [`matrix_files`]: those of other programs.
//! * [`nalgebra`]: matrices from and to nalgebra-sparse.
//! * [`shared_pattern`]: products with several sparse matrices at once.
//! * [`orthogonal`]: orthogonal factors of small dense matrices.
//! * [`proportional`]: a matrix as α M + β K and a rest.
//! * [`random`]: start vectors that are the same in every run.
//! * [`multivector`]: products of multivectors, such as a set of modes.
//! * [`toar`]: eigenpairs of a quadratic problem nearest a shift, by two-level Arnoldi.
//! * [`extended`], [`samples`]: for tests; linear systems solved with twice the digits, matrices with known eigenvalues.
//! * [`unsymmetric`]: small dense eigenproblems that are not symmetric.

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub mod assignment;
pub mod congruence;
pub mod dense;
pub mod eigenpairs;
pub mod extended;
pub mod factor;
pub mod gmres;
pub mod lanczos;
mod lanes;
pub mod lu;
pub mod matrix_files;
pub mod matrix_market;
pub mod multivector;
pub mod nalgebra;
pub mod orthogonal;
pub mod proportional;
pub mod random;
pub mod row_sparse;
pub mod samples;
mod scalar;
pub mod shared_pattern;
pub mod sparse;
pub mod toar;
pub mod unsymmetric;
mod workspace;

pub use eigenpairs::{
    Eigenpairs, SturmCount, Wanted, eigenpairs_below, lowest_eigenpairs, lowest_eigenpairs_by,
};
pub use factor::{Engine, Inertia, SymbolicFactor, SymmetricFactor};
pub use faer::c64;
pub use sparse::{SparseMatrix, SparseVector};
