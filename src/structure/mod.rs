//! From a description of parts, bars, points and supports to M, C, K: elements, constraints, assembly.
//!
//! A [`Model`] is plain data. [`assemble`] checks it, finds its free degrees of freedom u = T q ([`DofMap`]), adds up
//! the [`elements`] and gives M = Tᵀ (Σ M_e) T, and K and C likewise, with the map from free degrees of freedom back
//! to nodes. [`Assembled::prestress`] gives the geometric stiffness of a static state, [`Assembled::rotating`] the terms of a
//! steady rotation, [`PartForms`] the energies of each part in a motion, [`Assembled::imported`] the same form to matrices of another program.

mod as_plate;
mod assembly;
mod averaging;
mod check;
mod constraints;
mod dofs;
mod drilling;
pub mod elements;
mod free;
mod imported;
mod material;
mod model;
mod numbering;
mod part;
mod part_forms;
mod properties;
mod revolution;
mod rotation;
#[cfg(test)]
pub(crate) mod samples;
mod scatter;
mod section;
mod spaces;
mod tie;
mod users;
mod warnings;

pub use as_plate::as_plate;
pub use assembly::{Assembled, GeometricStiffness, assemble};
pub use averaging::averaging;
pub use check::check;
pub use constraints::{ConstraintWords, check_constraints};
pub use dofs::{DofMap, FreeDof};
pub use elements::waves::{thickness_error, thickness_shear_frequency};
pub use free::{FreePart, free_parts, is_free_along, unresisted_parts};
pub use material::{Engineering, Material, Orthotropic, RayleighDamping};
pub use model::{Constraint, Coupling, InclinedSupport, Model, RigidLink, Support};
pub use part::{Moved, Part, PartKind};
pub use part_forms::{PartForms, PartMatrix};
pub use properties::{
    Bar, Integration, PlateTheory, PointMass, Rotation, RotationAxis, Shell, Solid, Spring,
};
pub use revolution::{Deviation, deviation, is_even_around};
pub use section::Section;
pub use tie::{Tie, Tied, tied};
pub use warnings::{ThicknessError, element_size, thickness_errors};
