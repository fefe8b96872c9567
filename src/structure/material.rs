//! Materials: isotropic elasticity, density and damping.

use crate::schema::units::{DENSITY, NUMBER, PRESSURE, RATE, TIME};
use crate::schema::{Invalidates, declare, key};
use nalgebra::SMatrix;
use std::ops::Bound;

declare! {
    /// Isotropic linear elastic material.
    #[derive(Copy)]
    pub struct Material {
        /// E \[Pa\].
        pub youngs_modulus: f64 = key::quantity(PRESSURE).positive().label("Young's modulus"),
        /// ν.
        pub poissons_ratio: f64 = key::quantity(NUMBER)
            .within(Bound::Excluded(-1.0), Bound::Excluded(0.5))
            .expecting("a number such as 0.3")
            .label("Poisson's ratio"),
        /// ρ \[kg/m³\].
        pub density: f64 = key::quantity(DENSITY).positive(),
        /// η of K(1 + iη); zero for none.
        pub loss_factor: f64 =
            key::quantity(NUMBER).non_negative().or(0.0).invalidates(Invalidates::Damping),
        /// C = α M + β K of the parts made of it.
        pub rayleigh: RayleighDamping = key::table().invalidates(Invalidates::Damping),
    }
}

declare! {
    /// C = α M + β K.
    #[derive(Copy)]
    pub struct RayleighDamping {
        /// α \[1/s\].
        pub alpha: f64 = key::quantity(RATE).non_negative().or(0.0).label("Rayleigh coefficient"),
        /// β \[s\].
        pub beta: f64 = key::quantity(TIME).non_negative().or(0.0).label("Rayleigh coefficient"),
    }
}

impl Material {
    /// G = E/2(1+ν) \[Pa\].
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))
    }

    /// D \[Pa\] of σ = D ε on (xx, yy, zz, xy, yz, zx) in space, shear strains γ.
    pub fn elasticity(&self) -> SMatrix<f64, 6, 6> {
        let (e, nu, g) = (self.youngs_modulus, self.poissons_ratio, self.shear_modulus());
        let lambda = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
        SMatrix::from_fn(|i, j| match (i < 3, j < 3) {
            (true, true) => lambda + if i == j { 2.0 * g } else { 0.0 },
            (false, false) if i == j => g,
            _ => 0.0,
        })
    }
}
