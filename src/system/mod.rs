//! The seam between mechanics and analysis: a second-order system with a sliding interface.
//!
//! M ü + C u̇ + K u + Σ_p [ g N − t₁ F₁ − t₂ F₂ ] = f
//!
//! The [`Structure`] (M, C, K) is symmetric and constant. All that is unsymmetric or varies with friction,
//! stiffness, speed and load sits in the [`ContactPair`]s: for each contact point its sparse directions g, t₁, t₂
//! and a [`ContactLaw`]. Contact is never assembled into K.
//!
//! The full finite-element model, a reduced model, the two-degree-of-freedom model and imported matrices are all
//! this one type, and equilibrium, complex eigenvalues, sweeps and transients take nothing else.

mod imported;
mod interface;
mod law;
mod structure;

pub use imported::{Given, Imported, split};
pub use interface::{Closing, ContactPair, ContactPoint};
pub use law::{
    ContactForces, ContactLaw, ContactMotion, ContactTangent, FrictionAtRest, SlipAnswer, SlipStep,
};
pub use structure::{Coupling, Damping, ModalDamping, Prestress, Skew, Structure};

use std::sync::Arc;

/// A structure, its sliding contacts and its external load.
#[derive(Debug, Clone)]
pub struct System {
    /// M, C, K: symmetric and constant.
    pub structure: Structure,
    /// The sliding contacts.
    pub pairs: Vec<ContactPair>,
    /// External force f on the degrees of freedom \[N, N m\].
    pub load: Vec<f64>,
    /// Geometric stiffness of the preload, when the case asks for it.
    pub prestress: Option<Arc<dyn Prestress>>,
    /// Part of imported K and C beyond the symmetric structure.
    pub coupling: Option<Coupling>,
}

impl System {
    /// A structure with sliding contacts; no external force, no prestress, nothing imported.
    pub fn new(structure: Structure, pairs: Vec<ContactPair>) -> System {
        let load = vec![0.0; structure.n_dofs()];
        System { structure, pairs, load, prestress: None, coupling: None }
    }

    /// The number of degrees of freedom.
    pub fn n_dofs(&self) -> usize {
        self.structure.n_dofs()
    }

    /// The sparse skew parts of K and C, where it has them.
    pub fn skew(&self) -> Option<&Skew> {
        self.coupling.as_ref()?.skew.as_ref()
    }

    /// Every contact point with its pair, in the fixed order that results use.
    pub fn points(&self) -> impl Iterator<Item = (&ContactPair, &ContactPoint)> + '_ {
        self.pairs.iter().flat_map(|pair| pair.points.iter().map(move |point| (pair, point)))
    }
}
