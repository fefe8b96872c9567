//! Where a body may touch: its nodes, or the integration points of its faces; and where each of these stands over the counter-faces.
//!
//! Plates touch with their nodes: they have so few motions that points that stick at the integration points of triangles would hold each of them
//! several times, and share their forces in no definite way.

use super::projection::{CounterSurface, Foot, Vector, add, area_vector, cross, dot, scale, unit};
use super::surfaces::{ContactPatch, ContactSide, Surfaces};
use super::tributary::tributary;
use crate::error::{Error, Fault, Result};
use crate::mesh::Cell;
use crate::numbers::components;
use crate::structure::Moved;
use crate::structure::elements::{WeightedTriangle, split_face};

/// Quadrature of faces, exact to this degree: a constant pressure is consistent on flat faces of second order.
const DEGREE: usize = 2;
/// Least cosine of the angle between the normals of the body and of the counter-face, turned against each other, at integration points that may touch: 60°.
const FACING: f64 = 0.5;

/// A place on the body, of a plate on its mid-surface, that may touch.
pub(super) struct Touching<'a> {
    pub(super) on: On<'a>,
    pub(super) position: Vector,
    /// The tributary length or area of a node, the area of an integration point.
    weight: f64,
    /// The unit normal of a plate; that of a face of a solid outwards.
    normal: Vector,
}

/// What of the body moves a place.
#[derive(Clone, Copy)]
pub(super) enum On<'a> {
    Node(usize),
    /// A face at its reference coordinates.
    Face(&'a Cell, [f64; 3]),
}

/// A point that may be kept.
pub(super) struct Candidate<'a> {
    pub(super) place: &'a Touching<'a>,
    /// From the place to the point.
    pub(super) offset: Vector,
    pub(super) position: Vector,
    pub(super) weight: f64,
    /// From the counter-face; over the tangent plane at its edge when the point stands beside it \[m\].
    pub(super) gap: f64,
    pub(super) foot: Foot,
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
    let is_solid = surfaces.body.as_shell().is_none();
    Ok(match (surfaces.side, surfaces.patch) {
        (ContactSide::Face(faces), ContactPatch::Reach(_)) if is_solid => {
            integration_points(surfaces.nodes, faces)
        }
        _ => nodes(surfaces, cells, &own),
    })
}

/// The integration points of faces, with the area of each.
fn integration_points<'a>(nodes: &[Vector], faces: &'a [Cell]) -> Vec<Touching<'a>> {
    let on = |face: &'a Cell| {
        face.kind().quadrature(DEGREE).into_iter().filter_map(move |point| {
            let [a, b, _] = face.tangents(nodes, point.at);
            let area = cross(a, b);
            Some(Touching {
                on: On::Face(face, point.at),
                position: face.position(nodes, point.at),
                weight: point.weight * dot(area, area).sqrt(),
                normal: unit(area)?,
            })
        })
    };
    faces.iter().flat_map(on).collect()
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

/// The points of the places, each with its foot on the counter-face. Integration points that do not face it are left out.
pub(super) fn candidates<'a>(
    surfaces: &Surfaces<'_>,
    counter: &CounterSurface<'_>,
    touching: &'a [Touching<'a>],
) -> Vec<Candidate<'a>> {
    let half = 0.5 * surfaces.body.thickness();
    let at = |place: &'a Touching<'a>, h: f64, weight: f64| {
        let offset = scale(h, place.normal);
        let position = add(place.position, offset);
        let foot = counter.foot(position)?;
        let gap = foot.height - 0.5 * surfaces.counter.thickness();
        Some(Candidate { place, offset, position, weight, gap, foot })
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

impl Candidate<'_> {
    /// The displacement of the place on the body.
    pub(super) fn moved(&self, surfaces: &Surfaces<'_>) -> Vec<Moved> {
        match self.place.on {
            On::Node(node) => {
                (0..6).map(|k| (node, k, std::array::from_fn(|i| f64::from(u8::from(i == k))))).collect()
            }
            On::Face(face, at) => surfaces.body.displacement_at(surfaces.nodes, face, at),
        }
    }
}
