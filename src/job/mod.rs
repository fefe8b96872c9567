//! From a case to its results: the one place where mechanics and analyses meet.
//!
//! 1. [`Prepared::new`] reads the mesh, places the bodies and builds the [`crate::system::System`].
//! 2. [`analyse`] runs the analyses of the case on it and hands each result on as soon as it is there.
//! 3. [`run_case`] does both and writes the results folder.

mod analyse;
mod contacts;
mod disc;
mod explore;
mod model;
mod modes;
mod place;
mod prepared;
mod regions;
mod states;

pub use analyse::{Selection, Stage, analyse, run_case};
pub use explore::{KnownMap, KnownMaps};
pub use prepared::Prepared;
pub use states::Whole;
