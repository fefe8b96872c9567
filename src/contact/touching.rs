//! Where a body may touch: its nodes, or the faces of a solid ([`super::segments`]); and where these stand over the counter-faces.
//!
//! Plates touch with their nodes: they have so few motions that points that stick at the integration points of triangles would hold each of them
//! several times, and share their forces in no definite way.

use super::candidate::{Candidate, FACING, On, Point, Sample};
use super::projection::{CounterSurface, Vector, add, area_vector, cross, dot, scale, unit};
use super::segments::segments;
use super::surfaces::{ContactPatch, ContactSide, Surfaces};
use super::tributary::tributary;
use crate::error::{Error, Fault, Result};
use crate::mesh::Cell;
use crate::numbers::components;
use crate::structure::elements::{WeightedTriangle, split_face};

/// A place on the body, of a plate on its mid-surface, that may touch.
pub(super) struct Touching<'a> {
    on: On<'a>,
    pub(super) position: Vector,
    /// The tributary length or area of a node, the area of a face.
    weight: f64,
    /// The unit normal of a plate; that of a face of a solid outwards.
    normal: Vector,
}

/// The places of the body of a pair that may touch; `place` names the body in faults.
///
/// # Errors
/// Nodes off the body, nothing to touch with.
pub(super) fn touching<'a>(surfaces: &Surfaces<'a>, place: &str) -> Result<Vec<Touching<'a>>> {
    let lines: Vec<Cell>;
    let cells: &[Cell] = match surfaces.side {
        ContactSide::Edge(ends) | ContactSide::Middle(ends) => {
            lines = ends.iter().copied().map(Cell::line).collect();
            &lines
        }
        ContactSide::Face(faces) => faces,
    };
    let mut named = vec![false; surfaces.nodes.len()];
    cells.iter().flat_map(Cell::nodes).for_each(|node| named[*node] = true);
    let mut on_part = vec![false; surfaces.nodes.len()];
    surfaces.body.nodes().into_iter().for_each(|node| on_part[node] = true);
    let (own, off): (Vec<usize>, Vec<usize>) =
        (0..named.len()).filter(|k| named[*k]).partition(|k| on_part[*k]);
    if let Some(node) = off.first() {
        let found = format!(
            "{} of its nodes off part `{}`, one at {} m",
            off.len(),
            surfaces.body.name,
            components(surfaces.nodes[*node])
        );
        let expected = format!("contact nodes on `{}`", surfaces.body.name);
        return Err(Error::input(Fault::new(place, found, expected)));
    }
    if own.is_empty() {
        return Err(Error::input(Fault::new(place, "no line or face to touch with", "a region of the body")));
    }
    Ok(match faces_within(surfaces) {
        Some((faces, _)) => middles(surfaces.nodes, faces),
        None => nodes(surfaces, cells, &own),
    })
}

/// The faces of a solid that touches with them, and their reach \[m\].
fn faces_within<'a>(surfaces: &Surfaces<'a>) -> Option<(&'a [Cell], f64)> {
    match (surfaces.side, surfaces.patch, surfaces.body.as_shell()) {
        (ContactSide::Face(faces), ContactPatch::Reach(reach), None) => Some((faces, reach)),
        _ => None,
    }
}

/// The middle of each face.
fn middles<'a>(nodes: &[Vector], faces: &'a [Cell]) -> Vec<Touching<'a>> {
    let on = |face: &'a Cell| {
        let [middle] = face.kind().quadrature(1)[..] else { return None };
        let [a, b, _] = face.tangents(nodes, middle.at);
        let area = cross(a, b);
        Some(Touching {
            on: On::Face(face, middle.at),
            position: face.position(nodes, middle.at),
            weight: middle.weight * dot(area, area).sqrt(),
            normal: unit(area)?,
        })
    };
    faces.iter().filter_map(on).collect()
}

/// The `own` nodes of `cells`, with the tributary length or area of each.
fn nodes<'a>(surfaces: &Surfaces<'a>, cells: &[Cell], own: &[usize]) -> Vec<Touching<'a>> {
    let weights = tributary(surfaces.nodes, cells);
    let area_of =
        |t: &WeightedTriangle| scale(t.weight, area_vector(&t.nodes.map(|node| surfaces.nodes[node])));
    let mut normals = vec![[0.0; 3]; surfaces.nodes.len()];
    let faces = if surfaces.body.as_shell().is_none() { cells } else { &surfaces.body.cells };
    for triangle in faces.iter().flat_map(split_face) {
        let area = area_of(&triangle);
        for node in triangle.nodes {
            normals[node] = add(normals[node], area);
        }
    }
    let at = |node: &usize| Touching {
        on: On::Node(*node),
        position: surfaces.nodes[*node],
        weight: weights[*node],
        normal: unit(normals[*node]).unwrap_or_default(),
    };
    own.iter().map(at).collect()
}

/// The points of the places, with their feet on the counter-face. Faces of solids that do not face it are left out; where they are not over
/// it at all, the middles of faces are left, whose feet say where they are.
pub(super) fn candidates<'a>(
    surfaces: &Surfaces<'a>,
    counter: &CounterSurface<'_>,
    touching: &[Touching<'a>],
) -> Vec<Candidate<'a>> {
    if let Some((faces, reach)) = faces_within(surfaces) {
        let found = segments(surfaces, counter, faces, reach);
        if !found.is_empty() {
            return found;
        }
    }
    let half = 0.5 * surfaces.body.thickness();
    let at = |place: &Touching<'a>, h: f64, weight: f64| {
        let offset = scale(h, place.normal);
        let position = add(place.position, offset);
        let foot = counter.foot(position)?;
        let gap = foot.height - 0.5 * surfaces.counter.thickness();
        Some(Candidate {
            samples: vec![Sample { on: place.on, offset, position, gap, foot }],
            points: vec![Point { position, weight, shares: vec![1.0] }],
        })
    };
    let mut all = Vec::new();
    for place in touching {
        match surfaces.side {
            ContactSide::Edge(_) => {
                all.extend([half, -half].into_iter().filter_map(|h| at(place, h, 0.5 * place.weight)));
            }
            ContactSide::Middle(_) => all.extend(at(place, 0.0, place.weight)),
            ContactSide::Face(_) => {
                let Some(foot) = counter.foot(place.position) else { continue };
                let along = dot(place.normal, foot.normal);
                match place.on {
                    // A plate touches with the side towards the counter-face.
                    On::Node(_) => {
                        all.extend(at(place, if along > 0.0 { -half } else { half }, place.weight))
                    }
                    On::Face(..) if -along >= FACING => all.extend(at(place, 0.0, place.weight)),
                    On::Face(..) => {}
                }
            }
        }
    }
    all
}
