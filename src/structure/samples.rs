//! Materials shared by the tests of the structure.

use super::{Material, RayleighDamping};

/// Steel without damping.
pub(crate) const STEEL: Material = Material {
    youngs_modulus: 210e9,
    poissons_ratio: 0.3,
    density: 7850.0,
    loss_factor: 0.0,
    rayleigh: RayleighDamping { alpha: 0.0, beta: 0.0 },
    orthotropic: None,
};
