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

mod friction;
mod halves;
mod imported;
mod interface;
mod law;
mod low_rank;
mod structure;

pub use friction::is_unsymmetric;
pub use imported::{Given, Imported, hysteretic_skew, mass_skew, split};
pub use interface::{Closing, ContactPair, ContactPoint};
pub use law::{
    ContactForces, ContactLaw, ContactMotion, ContactTangent, FrictionAtRest, SlipAnswer, SlipStep,
};
pub use structure::{Coupling, Damping, ModalDamping, Prestress, Skew, Structure};

use crate::error::Result;
use crate::linalg::SparseMatrix;
use crate::linalg::sparse::add_scaled;
use std::sync::Arc;

/// M, C and K of a system without its contacts, every constant part added up, n × n, both triangles stored.
#[derive(Debug, Clone)]
pub struct ConstantMatrices {
    /// M \[kg, kg m²\].
    pub mass: Arc<SparseMatrix>,
    /// C \[N s/m, N m s\]: Rayleigh damping, dashpots, imported parts; without modal damping. `None` where there is none.
    pub damping: Option<SparseMatrix>,
    /// K, its real part \[N/m, N m\].
    pub stiffness: SparseMatrix,
    /// The imaginary part of K \[N/m, N m\], from loss factors.
    pub loss: Option<Arc<SparseMatrix>>,
}

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
    /// Part of K and C beyond the symmetric structure: imported, or of a rotation.
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

    /// M, C and K as other programs take them; what depends on the state, the stiffness of the preload, is not part of K.
    ///
    /// # Errors
    /// Not enough memory for the sums.
    pub fn constant_matrices(&self) -> Result<ConstantMatrices> {
        let structure = &self.structure;
        let rest = self.coupling.as_ref().map(|c| c.assembled(self.n_dofs())).transpose()?;
        let [of_stiffness, of_damping] = rest.map_or([None, None], |rest| rest.map(Some));
        let sum = |symmetric: &SparseMatrix, rest: Option<SparseMatrix>| match rest {
            Some(rest) => add_scaled(&[(1.0, symmetric), (1.0, &rest)]),
            None => symmetric.clone(),
        };
        let damping = match &structure.damping.viscous {
            Some(viscous) => Some(sum(viscous, of_damping)),
            None => of_damping,
        };
        Ok(ConstantMatrices {
            mass: structure.mass.clone(),
            damping,
            stiffness: sum(&structure.stiffness, of_stiffness),
            loss: structure.damping.hysteretic.clone(),
        })
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
