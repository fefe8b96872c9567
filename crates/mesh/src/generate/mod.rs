//! Meshes without Gmsh: discs, plates and the whole rig.
//!
//! Graded meshes are made of good triangles whose edge follows a [`Grading`]: fine at the contact, coarser with the
//! distance from it. A half disc, or a quarter of the plate around the contact, is filled with points
//! (Delaunay refinement by circumcentres), smoothed, and mirrored: the meshes are *exactly* mirror-symmetric, bit for
//! bit, which symmetry arguments of the physics rely on. Everything is deterministic.
//!
//! Axes are those of the rig: the disc lies in the plane x = 0 with its centre at the origin, its lowest rim
//! point is (0, 0, −a), its faces' normal is +x. The plate lies in the plane z = 0, its normal is +z.
//!
//! Regions: `disc` (faces), `rim` and `hub` (lines); `slider` (faces), `slider_edge_x_min`, `_x_max`, `_y_min`,
//! `_y_max` (lines); `bar` (lines), `bar_root` and `bar_clamp` (points); `pad` like `slider`.

mod disc;
mod disc_brake;
mod fill;
mod grading;
mod pad;
mod plate;
mod rig;
mod solid;
mod solid_brake;
mod structured;

pub use disc::{DiscSpec, disc};
pub use disc_brake::disc_brake;
pub use grading::Grading;
pub use pad::{PadOnDiscSpec, pad_on_disc};
pub use plate::{PlateSpec, plate};
pub use rig::{BarSide, BarSpec, RigSpec, rig};
pub use solid::structured_box;
pub use solid_brake::{solid_brake, structured_ring};
pub use structured::{Faces, structured_annulus, structured_plate};

use stridor_base::error::{Error, Fault, Faults, Result};

/// The most nodes a generated part may have: more is taken for a slip of units.
const MOST_NODES: f64 = 2e6;

/// Notes a fault for every length that is not a positive finite number.
fn require_positive(part: &str, lengths: &[(&str, f64)]) -> Faults {
    let mut faults = Faults::new();
    for (name, value) in lengths {
        if !(value.is_finite() && *value > 0.0) {
            faults.push(Fault::new(
                format!("{part} `{name}`"),
                value.to_string(),
                "a positive length in metres",
            ));
        }
    }
    faults
}

/// Refuses a part of `area` \[m²\] that would take too many nodes.
fn refuse_too_fine(part: &str, area: f64, grading: &Grading) -> Result<()> {
    // A triangle of edge h covers 0.43 h², and there are two triangles a node.
    let fine = std::f64::consts::PI * (grading.fine_radius + grading.fine / grading.growth.max(0.05)).powi(2);
    let nodes = (area / grading.coarse.powi(2) + fine.min(area) / grading.fine.powi(2)) / 0.866;
    if nodes <= MOST_NODES {
        return Ok(());
    }
    Err(Error::input(
        Fault::new(
            format!("{part} element sizes"),
            format!("{} m and {} m, about {nodes:.0} nodes", grading.coarse, grading.fine),
            format!("at most {MOST_NODES:.0} nodes a part"),
        )
        .with_help("Sizes are in metres: 3 mm is 0.003"),
    ))
}

#[cfg(test)]
mod tests;
