//! From a description of parts, bars, points and supports to M, C, K: elements, constraints, assembly.

mod model;

pub use model::{
    BarPart, Material, Model, PointMass, RayleighDamping, RigidLink, Section, ShellPart, Spring, Support,
};
