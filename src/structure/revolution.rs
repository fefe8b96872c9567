//! Whether a body is one of revolution: its surface must fall upon itself when it is turned.

use super::model::Model;
use super::properties::Rotation;
use crate::mesh::{Cell, FaceTree, cell_nodes, outer_faces};
use nalgebra::{Rotation3, Unit, Vector3};
use rayon::prelude::*;

/// The angle that divides the turn so that its multiples come near no symmetry \[rad\], and how many of them are used.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;
const ANGLES: usize = 5;
/// Coordinates are taken as exact to this part of the radius.
const ROUNDING: f64 = 1e-6;

/// Where a body differs most from one of revolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// How far a node of the surface is from the surface when it is turned about the axis, beyond what flat faces explain \[m\].
    pub distance: f64,
    /// That node \[m\].
    pub at: [f64; 3],
    /// The radius of the body \[m\].
    pub radius: f64,
}

/// Where the parts of a rotation, solids or plates, are not a body of revolution; `None` where they are one but for the facets of the mesh.
///
/// Every node of the surface is turned by one of five angles. A flat face of size a at radius r is up to a²/8r inside of a round one; twice
/// that is allowed.
pub fn deviation(model: &Model, rotation: &Rotation) -> Option<Deviation> {
    let cells = |dimension: usize| {
        let parts = model.turned_by(rotation).filter(move |part| part.kind.dimension() == dimension);
        parts.flat_map(|part| &part.cells)
    };
    let mut faces: Vec<Cell> = outer_faces(cells(3));
    faces.extend(cells(2).cloned());
    let nodes = cell_nodes(&faces);
    let tree = FaceTree::new(&model.nodes, &faces);
    let (axis, point) = (rotation.axis, Vector3::from(rotation.axis.point));
    let arm = |node: &usize| axis.arm(model.nodes[*node]).norm();
    let radius = nodes.iter().map(arm).fold(0.0, f64::max);
    let direction = Unit::new_unchecked(Vector3::from(axis.direction));
    let turns: [Rotation3<f64>; ANGLES] =
        std::array::from_fn(|k| Rotation3::from_axis_angle(&direction, (k + 1) as f64 * GOLDEN_ANGLE));
    let off = |(k, node): (usize, &usize)| {
        let place = point + turns[k % ANGLES] * (Vector3::from(model.nodes[*node]) - point);
        let near = tree.nearest(place.into());
        let facet = |face: usize| tree.size(face).powi(2) / (4.0 * arm(node)).max(f64::MIN_POSITIVE);
        let allowed = near.iter().map(|p| facet(p.face)).fold(0.0, f64::max).min(0.1 * radius);
        near.first().map_or(0.0, |p| p.distance - allowed)
    };
    let all: Vec<f64> = nodes.par_iter().enumerate().map(off).collect();
    let (worst, distance) = all.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    (*distance > ROUNDING * radius).then(|| Deviation {
        distance: *distance,
        at: model.nodes[nodes[worst]],
        radius,
    })
}
