//! The section of a bar.

use crate::schema::units::{AREA, AREA_MOMENT};
use crate::schema::{declare, key};

declare! {
    /// Section of a bar.
    #[derive(Copy)]
    pub struct Section {
        /// A \[m²\].
        pub area: f64 = key::quantity(AREA).positive(),
        /// Second moment about the section's first axis \[m⁴\].
        pub inertia_1: f64 = key::quantity(AREA_MOMENT).positive(),
        /// Second moment about the section's second axis \[m⁴\].
        pub inertia_2: f64 = key::quantity(AREA_MOMENT).positive(),
        /// Torsion constant \[m⁴\].
        pub torsion: f64 = key::quantity(AREA_MOMENT).positive(),
    }
}

impl Section {
    /// A round bar of diameter `d` \[m\].
    pub fn round(d: f64) -> Self {
        let inertia = std::f64::consts::PI * d.powi(4) / 64.0;
        Section {
            area: std::f64::consts::PI * d * d / 4.0,
            inertia_1: inertia,
            inertia_2: inertia,
            torsion: 2.0 * inertia,
        }
    }
}
