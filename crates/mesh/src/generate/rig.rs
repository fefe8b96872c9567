//! The whole rig in one mesh: disc, bar and slider.

use super::{DiscSpec, Grading, PlateSpec, disc, plate, require_positive};
use crate::{Cell, Mesh};
use stridor_base::error::{Fault, Result};

/// The side of the disc on which the bar is clamped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BarSide {
    /// The bar runs from the hub's centre along −x.
    Minus,
    /// The bar runs from the hub's centre along +x.
    Plus,
}

/// The bar that carries the disc's hub.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BarSpec {
    /// From the hub's centre to the clamp \[m\].
    pub length: f64,
    /// Number of elements.
    pub elements: usize,
    /// Where the clamp is.
    pub side: BarSide,
}

/// Disc, bar and slider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigSpec {
    /// The disc; it needs a hub.
    pub disc: DiscSpec,
    /// The bar.
    pub bar: BarSpec,
    /// The slider.
    pub slider: PlateSpec,
    /// Thickness of the slider \[m\]; only places its mid-plane.
    pub slider_thickness: f64,
}

impl RigSpec {
    /// The reference rig: disc 150 mm, slider 200 × 120 × 10 mm; hub radius and bar are assumptions.
    fn reference(disc: Grading, slider: Grading) -> Self {
        RigSpec {
            disc: DiscSpec { outer_radius: 0.075, hub_radius: 0.02075, grading: disc },
            bar: BarSpec { length: 0.075, elements: 10, side: BarSide::Minus },
            slider: PlateSpec { length: 0.2, width: 0.12, contact: [0.0, 0.0], grading: slider },
            slider_thickness: 0.01,
        }
    }

    /// About 450 nodes: for a first look.
    pub fn small() -> Self {
        let disc = Grading { growth: 0.35, ..Grading::graded(1e-3, 1.5e-3, 11e-3) };
        let slider = Grading { growth: 0.4, ..Grading::graded(1.25e-3, 1.25e-3, 25e-3) };
        Self::reference(disc, slider)
    }

    /// About 3,300 nodes: 0.4 mm at the contact, 3 mm elsewhere on the disc, 8 mm on the slider.
    pub fn medium() -> Self {
        Self::reference(Grading::graded(0.4e-3, 2e-3, 3e-3), Grading::graded(0.4e-3, 2e-3, 8e-3))
    }
}

/// The rig as it stands upright: the disc in the plane x = 0 with its centre at the origin, the bar along ∓x, and the
/// slider below, moved so that its contact is under the disc's lowest rim point, with the mid-plane at
/// z = −(a + h/2), so that its upper face touches the rim. (A case tilts and moves the parts by lead angle and
/// contact position.)
///
/// Regions of [`disc`] and [`plate`], and `bar` (lines, from the hub's centre outwards), `bar_root` (its node at
/// the hub's centre, to be tied to `hub` by a rigid link), `bar_clamp` (its node at the far end).
///
/// # Errors
/// Those of [`disc`] and [`plate`]; a full disc; a bar without length or elements.
pub fn rig(spec: &RigSpec) -> Result<Mesh> {
    let mut faults = require_positive(
        "rig",
        &[("bar.length", spec.bar.length), ("slider_thickness", spec.slider_thickness)],
    );
    if !(1..=100_000).contains(&spec.bar.elements) {
        faults.push(Fault::new("rig `bar.elements`", spec.bar.elements.to_string(), "1 … 100000"));
    }
    if spec.disc.hub_radius == 0.0 {
        let fault = Fault::new("rig `disc.hub_radius`", "0, a full disc", "a hub that the bar can carry");
        faults.push(fault);
    }
    let disc = faults.take(disc(&spec.disc));
    let slider = faults.take(plate(&spec.slider));
    let (Some(mut mesh), Some(mut slider)) = (disc, slider) else {
        return faults.into_result(Mesh::default());
    };
    faults.into_result(())?;

    let root = mesh.nodes.len();
    let n = spec.bar.elements;
    let direction = match spec.bar.side {
        BarSide::Minus => -1.0,
        BarSide::Plus => 1.0,
    };
    mesh.nodes.push([0.0; 3]);
    mesh.nodes.extend((1..=n).map(|i| [direction * spec.bar.length * i as f64 / n as f64, 0.0, 0.0]));
    mesh.add_region("bar", 1, (root..root + n).map(|i| Cell::line([i, i + 1])));
    mesh.add_region("bar_root", 0, [Cell::point(root)]);
    mesh.add_region("bar_clamp", 0, [Cell::point(root + n)]);

    let down = spec.disc.outer_radius + spec.slider_thickness / 2.0;
    for node in &mut slider.nodes {
        *node = [node[0] - spec.slider.contact[0], node[1] - spec.slider.contact[1], -down];
    }
    mesh.append(slider);
    Ok(mesh)
}
