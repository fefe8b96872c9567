//! Contact points from the geometry of two bodies.

use super::projection::{FaceGrid, Foot, FootShare, Vector, add, area_vector, cross, dot, scale, subtract};
use super::tributary::tributary;
use crate::error::{Error, Fault, Faults, Result};
use crate::linalg::SparseVector;
use crate::mesh::Cell;
use crate::numbers::{components, given};
use crate::structure::Part;
use crate::structure::elements::{WeightedTriangle, split_face};
use crate::system::ContactPoint;
use std::collections::BTreeSet;

/// Two plates or solids that may touch.
///
/// The *counter-body* (slider) offers the faces that look towards the body, of a plate half its thickness from its mid-surface;
/// **n** is the outward normal there. The *body* (disc) touches with nodes of its edge or of its face.
#[derive(Debug, Clone, Copy)]
pub struct Surfaces<'a> {
    /// The name of the pair, for faults.
    pub name: &'a str,
    /// Coordinates of all nodes \[m\].
    pub nodes: &'a [[f64; 3]],
    /// The part whose nodes touch.
    pub body: &'a Part,
    /// Which of its nodes may touch, and how.
    pub side: ContactSide<'a>,
    /// The part whose faces are touched.
    pub counter: &'a Part,
    /// Those faces: cells of a plate, faces of a solid seen from outside counter-clockwise.
    pub faces: &'a [Cell],
    /// The direction in which the counter-body slides past the body; its part across n is t₁.
    pub sliding_direction: [f64; 3],
    /// How many of the points are kept.
    pub patch: ContactPatch,
    /// How far the counter-body travels in all along t₁ \[m\], half of it either way; zero for none.
    pub stroke: f64,
}

impl<'a> Surfaces<'a> {
    /// The pair `name` of a body and a plate, of whose contact points those within 1 mm are kept, without travel.
    pub fn new(
        name: &'a str,
        nodes: &'a [[f64; 3]],
        [body, counter]: [&'a Part; 2],
        side: ContactSide<'a>,
        sliding_direction: [f64; 3],
    ) -> Self {
        let patch = ContactPatch::Reach(1e-3);
        Surfaces {
            name,
            nodes,
            body,
            side,
            counter,
            faces: &counter.cells,
            sliding_direction,
            patch,
            stroke: 0.0,
        }
    }
}

/// The part of the body that touches.
#[derive(Debug, Clone, Copy)]
pub enum ContactSide<'a> {
    /// Lines on the edge of the plate (a rim). Every node carries two points, at ±h/2 along the plate's normal: the
    /// two-point Lobatto rule over the thickness, each with half the node's tributary length \[m\].
    Edge(&'a [[usize; 2]]),
    /// Lines on the edge of the plate, with one point a node at the middle of the thickness: the line contact of an
    /// infinitely thin rim, which knows no moment about the line.
    Middle(&'a [[usize; 2]]),
    /// Faces of a plate or a solid (a pad). Every node carries one point, of a plate at h/2 towards the counter-body, with the node's
    /// tributary area \[m²\].
    Face(&'a [Cell]),
}

/// Which points are kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactPatch {
    /// Those whose gap is at most this \[m\].
    Reach(f64),
    /// The node nearest to the counter-body only, or several that are equally near, of weight 1 in all (shared equally by
    /// their points), for a contact stiffness in N/m; an error when it is farther than this \[m\].
    Nearest(f64),
}

/// Turns a sum of (node, component of (ux, uy, uz, rx, ry, rz), coefficient) into a vector on the degrees of freedom
/// of the system: held ones drop out, rigidly linked ones pass to their master.
pub type Reduce<'a> = dyn Fn(&[(usize, usize, f64)]) -> SparseVector + 'a;

/// The contact points of a pair, in the order of the body's nodes.
///
/// With **d** the vector from a node to its point, a point moves by u + θ × d. For the body's point and its foot on
/// the counter-face:
///
/// * g: gᵀu = −n·(u_body − u_counter), positive when the contact closes;
/// * t₁ᵀu, t₂ᵀu: tangential displacement of the body relative to the counter-body, t₂ = n × t₁;
/// * gap = distance along n, positive when open. It is exact at the nodes of a circular rim; between the nodes a
///   coarse mesh cuts the circle by a chord, which the points do not see.
///
/// # Errors
/// Contact nodes that are not on the body, a counter-body out of reach (with the distance), beside it, through it, or
/// left by the stroke.
pub fn pair_surfaces(surfaces: &Surfaces<'_>, reduce: &Reduce<'_>) -> Result<Vec<ContactPoint>> {
    let place = |key: &str| format!("`contact.{}.{key}`", surfaces.name);
    let touching = touching_nodes(surfaces, &place("body"))?;
    let mean = touching.iter().fold([0.0; 3], |sum, t| add(sum, surfaces.nodes[t.node]));
    let mean = scale(1.0 / touching.len() as f64, mean);
    // The faces of a solid look outwards; a plate has two sides.
    let towards = surfaces.counter.as_shell().map(|_| mean);
    let plate = FaceGrid::new(surfaces.nodes, surfaces.faces, towards).ok_or_else(|| {
        let found = "faces without area or turned against each other";
        Error::input(Fault::new(
            place("counter"),
            format!("`{}`, a part with {found}", surfaces.counter.name),
            "faces that look one way",
        ))
    })?;
    let candidates: Vec<Candidate> = candidates(surfaces, &plate, &touching);
    check_nearest(surfaces, &plate, &candidates)?;
    let kept = keep(surfaces.patch, candidates, plate.tolerance());
    let mut faults = Faults::new();
    let mut points = Vec::with_capacity(kept.len());
    for candidate in &kept {
        let Some(foot) = &candidate.foot else { continue };
        let along = subtract(
            surfaces.sliding_direction,
            scale(dot(surfaces.sliding_direction, foot.normal), foot.normal),
        );
        let (length, whole) =
            (dot(along, along).sqrt(), dot(surfaces.sliding_direction, surfaces.sliding_direction));
        if length.is_nan() || length <= 0.1 * whole.sqrt() {
            let found =
                format!("{}, along the counter-body's normal", components(surfaces.sliding_direction));
            return Err(Error::input(Fault::new(
                place("sliding_direction"),
                found,
                "a direction along its face",
            )));
        }
        let t1 = scale(1.0 / length, along);
        let t2 = cross(foot.normal, t1);
        let leaves = [0.5, -0.5].iter().any(|s| {
            surfaces.stroke != 0.0
                && plate.foot(add(candidate.position, scale(s * surfaces.stroke, t1))).is_none()
        });
        if leaves && faults.0.is_empty() {
            let found = format!(
                "{} m, which leaves `{}` at {} m",
                surfaces.stroke,
                surfaces.counter.name,
                components(candidate.position)
            );
            faults.push(Fault::new(place("stroke"), found, "a stroke that stays on the counter-body"));
        }
        let moved = at_foot(surfaces, foot);
        let direction = |w: Vector, sign: f64| {
            let mut terms = Vec::with_capacity(24);
            on_body(candidate, scale(sign, w), &mut terms);
            on_counter((foot, &moved), 0.5 * surfaces.counter.thickness(), scale(-sign, w), &mut terms);
            reduce(&terms)
        };
        points.push(ContactPoint {
            position: candidate.position,
            gap: candidate.gap,
            weight: candidate.weight,
            normal: direction(foot.normal, -1.0),
            tangents: [direction(t1, 1.0), direction(t2, 1.0)],
        });
    }
    faults.into_result(points)
}

/// A node of the body that may touch, with its tributary length or area and the plate's normal there.
struct Touching {
    node: usize,
    weight: f64,
    normal: Vector,
}

/// A point that may be kept.
struct Candidate {
    node: usize,
    /// From the node to the point.
    offset: Vector,
    position: Vector,
    weight: f64,
    /// From the counter-face; over its mean plane when the point stands beside it.
    gap: f64,
    foot: Option<Foot>,
}

fn touching_nodes(surfaces: &Surfaces<'_>, place: &str) -> Result<Vec<Touching>> {
    let n = surfaces.nodes.len();
    let area_of =
        |t: &WeightedTriangle| scale(t.weight, area_vector(&t.nodes.map(|node| surfaces.nodes[node])));
    let lines: Vec<Cell>;
    let cells: &[Cell] = match surfaces.side {
        ContactSide::Edge(ends) | ContactSide::Middle(ends) => {
            lines = ends.iter().copied().map(Cell::line).collect();
            &lines
        }
        ContactSide::Face(faces) => faces,
    };
    let weights = tributary(surfaces.nodes, cells);
    let mut named = vec![false; n];
    cells.iter().flat_map(Cell::nodes).for_each(|node| named[*node] = true);
    let mut normals = vec![[0.0; 3]; n];
    let mut on_part = vec![false; n];
    let own = match (surfaces.body.as_shell(), surfaces.side) {
        (None, ContactSide::Face(faces)) => faces,
        _ => &surfaces.body.cells,
    };
    for triangle in own.iter().flat_map(split_face) {
        let area = area_of(&triangle);
        for node in triangle.nodes {
            normals[node] = add(normals[node], area);
        }
    }
    surfaces.body.nodes().into_iter().for_each(|node| on_part[node] = true);
    let (touching, off): (Vec<usize>, Vec<usize>) = (0..n).filter(|k| named[*k]).partition(|k| on_part[*k]);
    if let Some(node) = off.first() {
        let found = format!(
            "{} of its nodes off part `{}`, one at {} m",
            off.len(),
            surfaces.body.name,
            components(surfaces.nodes[*node])
        );
        return Err(Error::input(Fault::new(
            place,
            found,
            format!("contact nodes on `{}`", surfaces.body.name),
        )));
    }
    if touching.is_empty() {
        return Err(Error::input(Fault::new(place, "no line or face to touch with", "a region of the body")));
    }
    let unit = |v: Vector| scale(1.0 / dot(v, v).sqrt().max(f64::MIN_POSITIVE), v);
    Ok(touching
        .into_iter()
        .map(|node| Touching { node, weight: weights[node], normal: unit(normals[node]) })
        .collect())
}

fn candidates(surfaces: &Surfaces<'_>, plate: &FaceGrid, touching: &[Touching]) -> Vec<Candidate> {
    let half = 0.5 * surfaces.body.thickness();
    let place = |t: &Touching, offset: Vector, weight: f64| {
        let position = add(surfaces.nodes[t.node], offset);
        let foot = plate.foot(position);
        let height = foot.as_ref().map_or_else(|| plate.height_over_plane(position), |f| f.height);
        let gap = height - 0.5 * surfaces.counter.thickness();
        Candidate { node: t.node, offset, position, weight, gap, foot }
    };
    let mut all = Vec::new();
    for t in touching {
        match surfaces.side {
            ContactSide::Edge(_) => {
                all.extend([half, -half].map(|h| place(t, scale(h, t.normal), 0.5 * t.weight)));
            }
            ContactSide::Middle(_) => all.push(place(t, [0.0; 3], t.weight)),
            ContactSide::Face(_) => {
                let h = if dot(t.normal, plate.normal) > 0.0 { -half } else { half };
                all.push(place(t, scale(h, t.normal), t.weight));
            }
        }
    }
    all
}

/// Refuses bodies out of reach, beside or inside each other, so that at least one point is kept.
fn check_nearest(surfaces: &Surfaces<'_>, plate: &FaceGrid, all: &[Candidate]) -> Result<()> {
    let lowest = |a: &&Candidate, b: &&Candidate| a.gap.total_cmp(&b.gap);
    let over = all.iter().filter(|c| c.foot.is_some()).min_by(lowest);
    let Some(nearest) = all.iter().min_by(lowest) else { return Ok(()) };
    // Of points that are equally near, one over the plate.
    let nearest = over.filter(|over| over.gap <= nearest.gap + plate.tolerance()).unwrap_or(nearest);
    let (counter, body) = (&surfaces.counter.name, &surfaces.body);
    let the_nearest = format!("the nearest of {} points of `{}`", all.len(), body.name);
    let faces = surfaces.faces.len();
    let mut faults = Faults::new();
    let mut beside = |what: &str, help: &str| {
        let found = format!("{the_nearest} at {} m, {what} ({faces} faces)", components(nearest.position));
        let expected = format!("a contact position on `{counter}`");
        faults.push(Fault::new(format!("`contact.{}`", surfaces.name), found, expected).with_help(help));
    };
    // A point of a curved edge may overhang the plate; the nearest one must stand on it.
    if nearest.foot.is_none() && plate.foot(surfaces.nodes[nearest.node]).is_none() {
        let help = "Move the bodies over each other, or choose another `body` or `counter`";
        beside(&format!("beside `{counter}`"), help);
    } else if over.is_none() {
        let help = format!(
            "Its node is over `{counter}`: look at the thickness of `{}`, {} m",
            body.name,
            body.thickness()
        );
        beside(&format!("which stands over none of the faces of `{counter}`"), &help);
    }
    check_gap(surfaces, nearest, over, &the_nearest, &mut faults);
    faults.into_result(())
}

/// Refuses a nearest point that is out of reach or inside the counter-body; `over` is the nearest of those over it.
fn check_gap(
    surfaces: &Surfaces<'_>,
    nearest: &Candidate,
    over: Option<&Candidate>,
    the_nearest: &str,
    faults: &mut Faults,
) {
    let (ContactPatch::Reach(reach) | ContactPatch::Nearest(reach)) = surfaces.patch;
    let place = |key: &str| format!("`contact.{}{key}`", surfaces.name);
    let gap = over.map_or(nearest.gap, |over| over.gap);
    if gap > reach {
        let found = format!("{the_nearest} {} m away from `{}`", given(gap), surfaces.counter.name);
        let expected = format!("a distance within the reach of {} m", given(reach));
        let help = format!(
            "Move the bodies together or check the mesh's unit; `reach = \"{:.3} mm\"` would take this point in",
            1.01e3 * gap
        );
        faults.push(Fault::new(place(".reach"), found, expected).with_help(help));
    }
    let thickness = 0.5 * (surfaces.body.thickness() + surfaces.counter.thickness());
    if nearest.foot.is_some() && nearest.gap < -thickness {
        let found = format!("the bodies {} m inside each other", given(-nearest.gap));
        let fault = Fault::new(place(""), found, "bodies that just touch");
        faults.push(fault.with_help("Check the contact position and the thicknesses"));
    }
}

fn keep(patch: ContactPatch, all: Vec<Candidate>, tolerance: f64) -> Vec<Candidate> {
    let on_plate = all.into_iter().filter(|c| c.foot.is_some());
    match patch {
        ContactPatch::Reach(reach) => on_plate.filter(|c| c.gap <= reach + tolerance).collect(),
        ContactPatch::Nearest(_) => {
            let on_plate: Vec<Candidate> = on_plate.collect();
            let least = on_plate.iter().map(|c| c.gap).fold(f64::INFINITY, f64::min);
            let near = on_plate.iter().filter(|c| c.gap <= least + tolerance);
            let nearest: BTreeSet<usize> = near.map(|c| c.node).collect();
            let mut kept: Vec<Candidate> =
                on_plate.into_iter().filter(|c| nearest.contains(&c.node)).collect();
            let share = 1.0 / kept.len().max(1) as f64;
            kept.iter_mut().for_each(|c| c.weight = share);
            kept
        }
    }
}

/// w·(u + θ × d) = w·u + θ·(d × w) at the body's node.
fn on_body(candidate: &Candidate, w: Vector, terms: &mut Vec<(usize, usize, f64)>) {
    let moment = cross(candidate.offset, w);
    for k in 0..3 {
        terms.push((candidate.node, k, w[k]));
        terms.push((candidate.node, 3 + k, moment[k]));
    }
}

/// Contribution of a component of the displacement of a node to that of a foot.
struct NodeShare {
    node: usize,
    component: usize,
    /// The share of the part of the foot.
    share: f64,
    /// (ux, uy, uz, rx, ry, rz) of the part for a unit of the component.
    by: [f64; 6],
}

/// The displacement of the mid-surface at the foot, by the elements of the counter-body.
fn at_foot(surfaces: &Surfaces<'_>, foot: &Foot) -> Vec<NodeShare> {
    let on_face = |part: &FootShare| {
        let moved = surfaces.counter.displacement_at(surfaces.nodes, &surfaces.faces[part.face], &part.at);
        let share = part.share;
        moved.into_iter().map(move |(node, component, by)| NodeShare { node, component, share, by })
    };
    foot.parts.iter().flat_map(on_face).collect()
}

/// The same at the foot on the counter-face, `half` off the mid-surface, whose displacement is `at_foot`.
fn on_counter(
    (foot, at_foot): (&Foot, &[NodeShare]),
    half: f64,
    w: Vector,
    terms: &mut Vec<(usize, usize, f64)>,
) {
    let moment = cross(scale(half, foot.normal), w);
    let force = [w[0], w[1], w[2], moment[0], moment[1], moment[2]];
    for NodeShare { node, component, share, by } in at_foot {
        let coefficient: f64 = force.iter().zip(by).map(|(f, by)| f * by).sum();
        if coefficient != 0.0 {
            terms.push((*node, *component, share * coefficient));
        }
    }
}

#[cfg(test)]
mod tests;
