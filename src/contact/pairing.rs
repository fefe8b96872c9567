//! Contact points from the geometry of two bodies.

use super::projection::{CounterSurface, Foot, Vector, add, cross, scale};
use super::sliding::Sliding;
use super::surfaces::{ContactPatch, ContactSide, Surfaces};
use super::touching::{Candidate, On, candidates, touching};
use crate::error::{Error, Fault, Faults, Result};
use crate::linalg::SparseVector;
use crate::mesh::LocatedPoint;
use crate::numbers::{components, given};
use crate::structure::{Moved, Part};
use crate::system::ContactPoint;
use std::collections::BTreeSet;

/// Turns a sum of (node, component of (ux, uy, uz, rx, ry, rz), coefficient) into a vector on the degrees of freedom
/// of the system: held ones drop out, rigidly linked ones pass to their master.
pub type Reduce<'a> = dyn Fn(&[(usize, usize, f64)]) -> SparseVector + 'a;

/// The contact points of a pair, in the order of the body's nodes or faces.
///
/// The foot of a point is the nearest point of the counter-faces, curved ones included; n is the normal there, so that each point has a frame of
/// its own. With **d** the vector from the mid-surface of a plate to its face, a point of a plate moves by u + θ × d. For the body's point and its
/// foot on the counter-face:
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
    let touching = touching(surfaces, &place("body"))?;
    let counter = CounterSurface::new(surfaces.nodes, surfaces.faces);
    // The faces of a solid look outwards; a plate has two sides.
    let counter = match surfaces.counter.as_shell() {
        Some(_) => counter.towards(&touching.iter().map(|place| place.position).collect::<Vec<_>>()),
        None => counter,
    };
    let candidates = candidates(surfaces, &counter, &touching);
    check_nearest(surfaces, &counter, &candidates)?;
    let kept = keep(surfaces.patch, candidates, counter.tolerance());
    let mut faults = Faults::new();
    let mut points = Vec::with_capacity(kept.len());
    for candidate in &kept {
        let foot = &candidate.foot;
        let (t1, speed) = tangent(surfaces, candidate)?;
        let t2 = cross(foot.normal, t1);
        let leaves = [0.5, -0.5].iter().any(|s| {
            let there = || counter.foot(add(candidate.position, scale(s * surfaces.stroke, t1)));
            surfaces.stroke != 0.0 && !there().is_some_and(|foot| foot.over)
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
        let body = candidate.moved(surfaces);
        let moved = at_foot(surfaces, foot);
        let across = scale(0.5 * surfaces.counter.thickness(), foot.normal);
        let direction = |w: Vector, sign: f64| {
            let mut terms = Vec::with_capacity(24);
            add_terms(&body, candidate.offset, scale(sign, w), &mut terms);
            add_terms(&moved, across, scale(-sign, w), &mut terms);
            reduce(&terms)
        };
        points.push(ContactPoint {
            position: candidate.position,
            gap: candidate.gap,
            weight: candidate.weight,
            speed,
            normal: direction(foot.normal, -1.0),
            tangents: [direction(t1, 1.0), direction(t2, 1.0)],
        });
    }
    faults.into_result(points)
}

/// t₁ at a point and how fast the counter-body slides there, as [`Sliding::tangent`] has them.
fn tangent(surfaces: &Surfaces<'_>, point: &Candidate<'_>) -> Result<(Vector, f64)> {
    surfaces.sliding.tangent(point.foot.normal, point.position).ok_or_else(|| {
        let key = match surfaces.sliding {
            Sliding::Along(_) | Sliding::AtRest(_) => "sliding_direction",
            Sliding::About { .. } => "rotation.axis",
        };
        let place = format!("`contact.{}.{key}`", surfaces.name);
        let way = components(surfaces.sliding.at(point.position));
        let found = match surfaces.sliding {
            Sliding::Along(_) | Sliding::AtRest(_) => format!("{way}, along the counter-body's normal"),
            Sliding::About { .. } => format!(
                "a motion along {way} at {} m, along the counter-body's normal",
                components(point.position)
            ),
        };
        Error::input(Fault::new(place, found, "a direction along its face"))
    })
}

/// Refuses bodies out of reach, beside or inside each other, so that at least one point is kept.
fn check_nearest(surfaces: &Surfaces<'_>, counter: &CounterSurface<'_>, all: &[Candidate<'_>]) -> Result<()> {
    let lowest = |a: &&Candidate, b: &&Candidate| a.gap.total_cmp(&b.gap);
    let over = all.iter().filter(|c| c.foot.over).min_by(lowest);
    let (name, body) = (&surfaces.counter.name, &surfaces.body);
    let mut faults = Faults::new();
    let Some(nearest) = all.iter().min_by(lowest) else {
        let found = format!("faces of `{}` that look away from `{name}`", body.name);
        let fault = Fault::new(format!("`contact.{}.body`", surfaces.name), found, "faces that look at it");
        return Err(Error::input(fault.with_help("Choose the faces on the other side of the body")));
    };
    // Of points that are equally near, one over the faces. Of faces parts may be beside; a rim stands where its nearest node does.
    let of_faces = matches!(surfaces.side, ContactSide::Face(_));
    let near = |over: &&Candidate| of_faces || over.gap <= nearest.gap + counter.tolerance();
    let nearest = over.filter(near).unwrap_or(nearest);
    let the_nearest = format!("the nearest of {} points of `{}`", all.len(), body.name);
    let faces = surfaces.faces.len();
    let mut beside = |what: &str, help: &str| {
        let found = format!("{the_nearest} at {} m, {what} ({faces} faces)", components(nearest.position));
        let expected = format!("a contact position on `{name}`");
        faults.push(Fault::new(format!("`contact.{}`", surfaces.name), found, expected).with_help(help));
    };
    // A point of a curved edge may overhang the plate; the nearest one must stand on it.
    let place_is_over = || counter.foot(nearest.place.position).is_some_and(|foot| foot.over);
    if !nearest.foot.over && !place_is_over() {
        let help = "Move the bodies over each other, or choose another `body` or `counter`";
        beside(&format!("beside `{name}`"), help);
    } else if over.is_none() {
        let help = format!(
            "Its node is over `{name}`: look at the thickness of `{}`, {} m",
            body.name,
            body.thickness()
        );
        beside(&format!("which stands over none of the faces of `{name}`"), &help);
    }
    check_gap(surfaces, nearest, over, &the_nearest, &mut faults);
    faults.into_result(())
}

/// Refuses a nearest point that is out of reach or inside the counter-body; `over` is the nearest of those over it.
fn check_gap(
    surfaces: &Surfaces<'_>,
    nearest: &Candidate<'_>,
    over: Option<&Candidate<'_>>,
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
    let thickness = |part: &Part| match part.as_shell() {
        Some(shell) => shell.thickness,
        None => part.smallest_extent(surfaces.nodes),
    };
    if nearest.foot.over && nearest.gap < -0.5 * (thickness(surfaces.body) + thickness(surfaces.counter)) {
        let found = format!("the bodies {} m inside each other", given(-nearest.gap));
        let fault = Fault::new(place(""), found, "bodies that just touch");
        faults.push(fault.with_help("Check the contact position and the thicknesses"));
    }
}

fn keep(patch: ContactPatch, all: Vec<Candidate<'_>>, tolerance: f64) -> Vec<Candidate<'_>> {
    let over = all.into_iter().filter(|c| c.foot.over);
    match patch {
        ContactPatch::Reach(reach) => over.filter(|c| c.gap <= reach + tolerance).collect(),
        ContactPatch::Nearest(_) => {
            let over: Vec<Candidate> = over.collect();
            let least = over.iter().map(|c| c.gap).fold(f64::INFINITY, f64::min);
            let node = |c: &Candidate| if let On::Node(node) = c.place.on { Some(node) } else { None };
            let near = over.iter().filter(|c| c.gap <= least + tolerance);
            let nearest: BTreeSet<Option<usize>> = near.map(node).collect();
            let mut kept: Vec<Candidate> = over.into_iter().filter(|c| nearest.contains(&node(c))).collect();
            let share = 1.0 / kept.len().max(1) as f64;
            kept.iter_mut().for_each(|c| c.weight = share);
            kept
        }
    }
}

/// The displacement at the foot, of a plate of its mid-surface: the mean over the faces that it is on.
fn at_foot(surfaces: &Surfaces<'_>, foot: &Foot) -> Vec<Moved> {
    let share = 1.0 / foot.places.len() as f64;
    let on = |place: &LocatedPoint| {
        surfaces.counter.displacement_at(surfaces.nodes, &surfaces.faces[place.face], place.at)
    };
    let shared = |(node, component, by): Moved| (node, component, by.map(|b| share * b));
    foot.places.iter().flat_map(on).map(shared).collect()
}

/// w·(u + θ × d) = w·u + θ·(d × w) of a place that is `moved`, d from it to the point.
fn add_terms(moved: &[Moved], d: Vector, w: Vector, terms: &mut Vec<(usize, usize, f64)>) {
    let moment = cross(d, w);
    let force = [w[0], w[1], w[2], moment[0], moment[1], moment[2]];
    for (node, component, by) in moved {
        let coefficient: f64 = force.iter().zip(by).map(|(f, by)| f * by).sum();
        if coefficient != 0.0 {
            terms.push((*node, *component, coefficient));
        }
    }
}

#[cfg(test)]
mod tests;
