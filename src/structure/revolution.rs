//! Whether a body is one of revolution: its surface must fall upon itself when it is turned. Whether its mesh does, when it is turned by an element.

use super::model::Model;
use super::part::Part;
use super::properties::{Rotation, RotationAxis};
use crate::mesh::{Cell, FaceTree, cell_nodes, coincident, outer_faces};
use nalgebra::{Rotation3, Unit, Vector3};
use rayon::prelude::*;
use std::collections::HashSet;
use std::f64::consts::TAU;

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

/// Whether the mesh of a part falls upon itself, cell by cell, when it is turned about the axis by one element of its rim: then no wave that the
/// mesh can hold is split by it.
pub fn is_even_around(part: &Part, nodes: &[[f64; 3]], axis: &RotationAxis) -> bool {
    let own = part.nodes();
    let Some(turn) = element_of_the_rim(part, nodes, axis) else { return false };
    let (point, by) = (
        Vector3::from(axis.point),
        Rotation3::from_axis_angle(&Unit::new_unchecked(axis.direction.into()), turn),
    );
    let mut places: Vec<[f64; 3]> = own.iter().map(|n| nodes[*n]).collect();
    let turned: Vec<[f64; 3]> =
        places.iter().map(|x| (point + by * (Vector3::from(*x) - point)).into()).collect();
    places.extend(turned);
    // Where each node comes to lie.
    let mut image = vec![None; nodes.len()];
    for [a, b] in coincident(&places) {
        if a < own.len() && b >= own.len() {
            image[own[b - own.len()]] = Some(own[a]);
        }
    }
    let name = |cell: &Cell, at: &dyn Fn(usize) -> Option<usize>| -> Option<Vec<usize>> {
        let mut name = cell.nodes().iter().map(|n| at(*n)).collect::<Option<Vec<usize>>>()?;
        name.sort_unstable();
        Some(name)
    };
    let there: HashSet<Option<Vec<usize>>> = part.cells.iter().map(|cell| name(cell, &Some)).collect();
    part.cells
        .iter()
        .map(|cell| name(cell, &|n| image[n]))
        .all(|cell| cell.is_some() && there.contains(&cell))
}

/// The angle between neighbouring corners of cells at the greatest radius, all at one place along the axis \[rad\].
fn element_of_the_rim(part: &Part, nodes: &[[f64; 3]], axis: &RotationAxis) -> Option<f64> {
    let mut corners: Vec<usize> = part.cells.iter().flat_map(|cell| cell.corners().iter().copied()).collect();
    corners.sort_unstable();
    corners.dedup();
    let (e, point) = (Vector3::from(axis.direction), Vector3::from(axis.point));
    let along = |n: usize| e.dot(&(Vector3::from(nodes[n]) - point));
    let arm = |n: usize| axis.arm(nodes[n]);
    let outermost = corners.iter().copied().max_by(|a, b| arm(*a).norm().total_cmp(&arm(*b).norm()))?;
    let (first, height) = (arm(outermost), along(outermost));
    let tolerance = ROUNDING * first.norm();
    let beside = |n: &usize| {
        (arm(*n).norm() - first.norm()).abs() <= tolerance && (along(*n) - height).abs() <= tolerance
    };
    let angle = |n: usize| e.dot(&first.cross(&arm(n))).atan2(first.dot(&arm(n))).rem_euclid(TAU);
    let angles = corners.into_iter().filter(|n| *n != outermost).filter(beside).map(angle);
    angles.min_by(f64::total_cmp)
}
