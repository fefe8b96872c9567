//! `[mesh]`: a Gmsh file, or a mesh made by the built-in generator.

use super::reader::Section;
use super::units::LENGTH;
use serde::Serialize;

/// Where the mesh comes from.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum MeshSource {
    /// A Gmsh file.
    File {
        /// Path, relative to the case file.
        file: String,
        /// `m`, `cm`, `mm` or `in`.
        unit: String,
    },
    /// The built-in generator.
    Generated(GeneratedMesh),
}

/// A mesh made by the built-in generator, so that its sizes are scalars of the case like any other.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum GeneratedMesh {
    /// Disc, bar and slider.
    Rig(RigMesh),
    /// A structured annulus: regions `disc`, `rim`, `hub`; without a hub the whole disc.
    Annulus {
        /// a \[m\].
        outer_radius: f64,
        /// b \[m\].
        hub_radius: f64,
        /// Elements along the radius.
        radial: usize,
        /// Elements around.
        around: usize,
    },
    /// A structured rectangle in the plane z = 0: regions `plate`, `plate_edge_x_min`, `plate_edge_x_max`, …
    Plate {
        /// Along x \[m\].
        length: f64,
        /// Along y \[m\].
        width: f64,
        /// Cells along x.
        cells_along: usize,
        /// Cells along y.
        cells_across: usize,
    },
}

/// Sizes of a generated rig \[m\].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RigMesh {
    /// Outer radius of the disc.
    pub outer_radius: f64,
    /// Radius of the hub.
    pub hub_radius: f64,
    /// From the hub's centre to the clamp, along −x; along +x when negative.
    pub bar_length: f64,
    /// Slider along x and y.
    pub slider: [f64; 2],
    /// Where the contact is on the slider, from its middle; the mesh is fine there.
    pub contact: [f64; 2],
    /// Element size at the contact.
    pub contact_size: f64,
    /// Distance from the contact within which elements stay fine.
    pub contact_radius: f64,
    /// Element size of the disc elsewhere.
    pub disc_size: f64,
    /// Element size of the slider elsewhere.
    pub slider_size: f64,
}

pub(super) fn read(s: &Section) -> MeshSource {
    let length = |s: &Section, key: &str, default: f64| s.quantity(key, LENGTH).positive().or(default);
    let rig = s.section("rig", |r| RigMesh {
        outer_radius: length(r, "outer_radius", 0.075),
        hub_radius: length(r, "hub_radius", 0.02075),
        bar_length: r
            .quantity("bar_length", LENGTH)
            .check("a length other than zero", |v| *v != 0.0)
            .or(0.075),
        slider: r.quantities("slider", LENGTH).or([0.2, 0.12]),
        contact: r.quantities("contact", LENGTH).or([0.0; 2]),
        contact_size: length(r, "contact_size", 0.4e-3),
        contact_radius: length(r, "contact_radius", 2e-3),
        disc_size: length(r, "disc_size", 3e-3),
        slider_size: length(r, "slider_size", 8e-3),
    });
    let annulus = s.section("annulus", |a| GeneratedMesh::Annulus {
        outer_radius: a.quantity("outer_radius", LENGTH).positive().required(LENGTH.name),
        hub_radius: a.quantity("hub_radius", LENGTH).non_negative().required(LENGTH.name),
        radial: a.count("radial").or(10),
        around: a.count("around").or(60),
    });
    let plate = s.section("plate", |p| GeneratedMesh::Plate {
        length: p.quantity("length", LENGTH).positive().required(LENGTH.name),
        width: p.quantity("width", LENGTH).positive().required(LENGTH.name),
        cells_along: p.count("cells_along").or(20),
        cells_across: p.count("cells_across").or(20),
    });
    let generated = rig.map(GeneratedMesh::Rig).or(annulus).or(plate);
    if s.names().iter().filter(|key| ["file", "rig", "annulus", "plate"].contains(&key.as_str())).count() > 1
    {
        s.fault("", "more than one of `file`, `rig`, `annulus`, `plate`", "one of them", "");
    }
    match generated {
        Some(generated) => MeshSource::Generated(generated),
        None => MeshSource::File {
            file: s.string("file").required("the path of a Gmsh file, or a table [mesh.rig] to generate one"),
            unit: s.choice("unit", &["m", "cm", "mm", "in"]).required("one of m, cm, mm, in").to_string(),
        },
    }
}
