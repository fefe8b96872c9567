//! Measured data, and their comparison with computed modes.
//!
//! * [`MeasuredSet`]: points, modes and frequency responses of a test, plain data in SI units.
//! * [`TestRecords`]: what a file of a test holds, by the numbers of its points.
//! * [`uff`]: universal files, read and written.
//! * [`geometry`]: where the frame of a test lies in the mesh, and which nodes its points are.
//! * [`compare`]: MAC, double modes as subspaces; which computed mode a measured one is.

pub mod compare;
pub mod geometry;
mod records;
mod set;
pub mod uff;

pub use records::{FunctionRecord, ModeRecord, TestRecords};
pub use set::{MeasuredDof, MeasuredFrf, MeasuredMode, MeasuredPoint, MeasuredSet, Quantity};
