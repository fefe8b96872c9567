//! `[mesh]`: a Gmsh file, or a mesh made by the built-in generator.

use crate::schema::units::LENGTH;
use crate::schema::{Derivative, choices, declare, key, variants};

variants! {
    /// Where the mesh comes from: a Gmsh file, or the built-in generator, whose sizes are scalars of the case like any other.
    pub enum MeshSource by presence {
        /// A Gmsh file.
        File "file" {
            /// Path, relative to the case file.
            file: String = key::name("the path of a Gmsh file, or a table [mesh.rig] to generate one"),
            /// The unit of its coordinates.
            unit: LengthUnit = key::choice(),
        }
        /// Disc, bar and slider.
        Rig "rig" {
            /// Its sizes.
            rig: RigMesh = key::table(),
        }
        /// A structured annulus: regions `disc`, `rim`, `hub`; without a hub the whole disc.
        Annulus "annulus" {
            /// Its sizes.
            annulus: AnnulusMesh = key::table(),
        }
        /// A structured rectangle in the plane z = 0: regions `plate`, `plate_edge_x_min`, `plate_edge_x_max`, …
        Plate "plate" {
            /// Its sizes.
            plate: PlateMesh = key::table(),
        }
    }
}

choices! {
    /// A unit of coordinates.
    pub enum LengthUnit {
        /// Metres.
        Metre = "m",
        /// Centimetres.
        Centimetre = "cm",
        /// Millimetres.
        Millimetre = "mm",
        /// Inches.
        Inch = "in",
    }
}

/// An element size: greater than zero, and no property of the machine.
fn element_size(default: f64) -> crate::schema::Field<f64> {
    key::quantity(LENGTH)
        .positive()
        .or(default)
        .derivative(|_, _| Derivative::None("an element size, which is no property of the machine"))
}

declare! {
    /// Sizes of a generated rig \[m\].
    pub struct RigMesh {
        /// Outer radius of the disc.
        pub outer_radius: f64 = key::quantity(LENGTH).positive().or(0.075),
        /// Radius of the hub.
        pub hub_radius: f64 = key::quantity(LENGTH).positive().or(0.02075),
        /// From the hub's centre to the clamp, along −x; along +x when negative.
        pub bar_length: f64 =
            key::quantity(LENGTH).check("a length other than zero", |v| *v != 0.0).or(0.075),
        /// Slider along x and y.
        pub slider: [f64; 2] = key::quantities(LENGTH).or([0.2, 0.12]),
        /// Where the contact is on the slider, from its middle; the mesh is fine there.
        pub contact: [f64; 2] = key::quantities(LENGTH).or([0.0; 2]),
        /// Element size at the contact.
        pub contact_size: f64 = element_size(0.4e-3),
        /// Distance from the contact within which elements stay fine.
        pub contact_radius: f64 = element_size(2e-3),
        /// Element size of the disc elsewhere.
        pub disc_size: f64 = element_size(3e-3),
        /// Element size of the slider elsewhere.
        pub slider_size: f64 = element_size(8e-3),
    }
}

declare! {
    /// Sizes of a generated annulus.
    pub struct AnnulusMesh {
        /// a \[m\].
        pub outer_radius: f64 = key::quantity(LENGTH).positive(),
        /// b \[m\].
        pub hub_radius: f64 = key::quantity(LENGTH).non_negative(),
        /// Elements along the radius.
        pub radial: usize = key::count().or(10),
        /// Elements around.
        pub around: usize = key::count().or(60),
    }
}

declare! {
    /// Sizes of a generated plate.
    pub struct PlateMesh {
        /// Along x \[m\].
        pub length: f64 = key::quantity(LENGTH).positive(),
        /// Along y \[m\].
        pub width: f64 = key::quantity(LENGTH).positive(),
        /// Cells along x.
        pub cells_along: usize = key::count().or(20),
        /// Cells along y.
        pub cells_across: usize = key::count().or(20),
    }
}
