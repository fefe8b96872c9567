//! A pad on a disc's face: the other common shape of a squealing pair.

use super::{DiscSpec, PlateSpec, disc, plate};
use crate::Mesh;
use stridor_base::error::{Fault, Faults, Result};

/// A rectangular pad that lies on the disc's face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PadOnDiscSpec {
    /// The disc.
    pub disc: DiscSpec,
    /// The pad; `length` along the rubbing direction.
    pub pad: PlateSpec,
    /// From the disc's axis to the pad's centre \[m\].
    pub radius: f64,
    /// Between the two mid-surfaces \[m\]: half of both thicknesses, when they just touch.
    pub offset: f64,
}

impl PadOnDiscSpec {
    /// A pad of 30 × 20 × 5 mm at the radius of 50 mm of the rig's disc, 1 mm thick.
    pub fn example() -> Self {
        use super::Grading;
        PadOnDiscSpec {
            disc: DiscSpec { outer_radius: 0.075, hub_radius: 0.02, grading: Grading::uniform(8e-3) },
            pad: PlateSpec { length: 0.03, width: 0.02, contact: [0.0; 2], grading: Grading::uniform(5e-3) },
            radius: 0.05,
            offset: 3e-3,
        }
    }
}

/// Disc as in [`super::disc`] and a pad at the top of the disc's +x face: its centre at (offset, 0, radius), its
/// length along y, its width along z, its normal +x. Regions of the disc, and `pad` (faces), `pad_edge_x_min`,
/// `_x_max` (ends of its length), `_y_min`, `_y_max` (inner and outer side).
///
/// # Errors
/// Those of disc and plate; a pad that reaches beyond hub or rim.
pub fn pad_on_disc(spec: &PadOnDiscSpec) -> Result<Mesh> {
    let mut faults = Faults::new();
    let disc = faults.take(disc(&spec.disc));
    let pad = faults.take(plate(&spec.pad));
    let (inner, outer) = (spec.radius - spec.pad.width / 2.0, spec.radius + spec.pad.width / 2.0);
    let reach = outer.hypot(spec.pad.length / 2.0);
    if !(inner >= spec.disc.hub_radius && reach <= spec.disc.outer_radius) {
        let found = format!("a pad between the radii {inner:.4} m and {reach:.4} m");
        let expected = format!("{} … {} m, on the disc", spec.disc.hub_radius, spec.disc.outer_radius);
        faults.push(Fault::new("pad `radius`", found, expected));
    }
    if !(spec.offset.is_finite() && spec.offset > 0.0) {
        faults.push(Fault::new("pad `offset`", spec.offset.to_string(), "a positive length in metres"));
    }
    let (Some(mut mesh), Some(mut pad)) = (disc, pad) else { return faults.into_result(Mesh::default()) };
    faults.into_result(())?;
    for node in &mut pad.nodes {
        *node = [spec.offset, node[0], spec.radius + node[1]];
    }
    for region in &mut pad.regions {
        region.name = region.name.replace("slider", "pad");
    }
    mesh.append(pad);
    Ok(mesh)
}
