//! Contact points from the geometry of two bodies.

use super::candidate::{Candidate, Sample};
use super::projection::{CounterSurface, Foot, Vector, add, cross, scale, unit};
use super::sliding::Sliding;
use super::surfaces::{ContactPatch, ContactSide, Surfaces};
use super::touching::{candidates, touching};
use crate::error::{Error, Fault, Faults, Result};
use crate::linalg::SparseVector;
use crate::mesh::LocatedPoint;
use crate::numbers::{components, given};
use crate::structure::{Moved, Part};
use crate::system::ContactPoint;
use nalgebra::{DMatrix, DVector};
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
/// Those of a face of a solid are means of these over a part of the face.
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
        let directions = Directions::new(surfaces, candidate)?;
        for point in &candidate.points {
            let samples = || candidate.samples.iter().zip(&point.shares);
            let normal = samples().fold([0.0; 3], |sum, (s, share)| add(sum, scale(*share, s.foot.normal)));
            let normal = unit(normal).unwrap_or_default();
            let (t1, speed) = tangent(surfaces, normal, point.position)?;
            let leaves = [0.5, -0.5].iter().any(|s| {
                let there = || counter.foot(add(point.position, scale(s * surfaces.stroke, t1)));
                surfaces.stroke != 0.0 && !there().is_some_and(|foot| foot.over)
            });
            if leaves && faults.0.is_empty() {
                let found = format!(
                    "{} m, which leaves `{}` at {} m",
                    surfaces.stroke,
                    surfaces.counter.name,
                    components(point.position)
                );
                faults.push(Fault::new(place("stroke"), found, "a stroke that stays on the counter-body"));
            }
            let [normal, t1, t2] = directions.of(&point.shares).map(|terms| reduce(&terms));
            points.push(ContactPoint {
                position: point.position,
                gap: samples().map(|(s, share)| share * s.gap).sum(),
                weight: point.weight,
                speed,
                normal,
                tangents: [t1, t2],
            });
        }
    }
    faults.into_result(points)
}

/// Sums of (node, component of (ux, uy, uz, rx, ry, rz), coefficient).
type Terms = Vec<(usize, usize, f64)>;

/// g, t₁ and t₂ of the samples of a candidate.
enum Directions {
    One([Terms; 3]),
    /// The (node, component) that they depend on, and the coefficients, a column a sample.
    Many(Vec<(usize, usize)>, [DMatrix<f64>; 3]),
}

impl Directions {
    fn new(surfaces: &Surfaces<'_>, candidate: &Candidate<'_>) -> Result<Self> {
        let of = |surfaces: &Surfaces<'_>, sample: &Sample<'_>| {
            let n = sample.foot.normal;
            let (t1, _) = tangent(surfaces, n, sample.position)?;
            let body = sample.moved(surfaces);
            let moved = at_foot(surfaces, &sample.foot);
            let across = scale(0.5 * surfaces.counter.thickness(), n);
            let direction = |w: Vector, sign: f64| {
                let mut terms = Vec::with_capacity(24);
                add_terms(&body, sample.offset, scale(sign, w), &mut terms);
                add_terms(&moved, across, scale(-sign, w), &mut terms);
                terms
            };
            Ok([direction(n, -1.0), direction(t1, 1.0), direction(cross(n, t1), 1.0)])
        };
        if let [one] = &candidate.samples[..] {
            return Ok(Directions::One(of(surfaces, one)?));
        }
        let mut along = *surfaces;
        if let (Sliding::AtRest(_), [first, ..]) = (surfaces.sliding, &candidate.samples[..]) {
            // Any direction will do, but it is the same on all of a face.
            let (t1, _) = tangent(surfaces, first.foot.normal, first.position)?;
            along.sliding = Sliding::AtRest(t1);
        }
        let samples = candidate.samples.iter().map(|sample| of(&along, sample));
        let samples: Vec<[Terms; 3]> = samples.collect::<Result<_>>()?;
        let all = samples.iter().flatten().flatten();
        let mut freedoms: Vec<(usize, usize)> = all.map(|(node, component, _)| (*node, *component)).collect();
        freedoms.sort_unstable();
        freedoms.dedup();
        let matrices = std::array::from_fn(|k| {
            let mut matrix = DMatrix::zeros(freedoms.len(), samples.len());
            for (column, sample) in samples.iter().enumerate() {
                for (node, component, by) in &sample[k] {
                    let row = freedoms.partition_point(|own| *own < (*node, *component));
                    matrix[(row, column)] += by;
                }
            }
            matrix
        });
        Ok(Directions::Many(freedoms, matrices))
    }

    /// Their sums, each sample times its share.
    fn of(&self, shares: &[f64]) -> [Terms; 3] {
        match self {
            Directions::One(terms) => terms.clone(),
            Directions::Many(freedoms, matrices) => std::array::from_fn(|k| {
                let sums = &matrices[k] * DVector::from_column_slice(shares);
                freedoms.iter().zip(&sums).map(|((node, component), by)| (*node, *component, *by)).collect()
            }),
        }
    }
}

/// t₁ at a point and how fast the counter-body slides there, as [`Sliding::tangent`] has them.
fn tangent(surfaces: &Surfaces<'_>, normal: Vector, position: Vector) -> Result<(Vector, f64)> {
    surfaces.sliding.tangent(normal, position).ok_or_else(|| {
        let key = match surfaces.sliding {
            Sliding::Along(_) | Sliding::AtRest(_) => "sliding_direction",
            Sliding::About { .. } => "rotation.axis",
        };
        let place = format!("`contact.{}.{key}`", surfaces.name);
        let way = components(surfaces.sliding.at(position));
        let found = match surfaces.sliding {
            Sliding::Along(_) | Sliding::AtRest(_) => format!("{way}, along the counter-body's normal"),
            Sliding::About { .. } => {
                format!("a motion along {way} at {} m, along the counter-body's normal", components(position))
            }
        };
        Error::input(Fault::new(place, found, "a direction along its face"))
    })
}

/// Refuses bodies out of reach, beside or inside each other, so that at least one point is kept.
fn check_nearest(surfaces: &Surfaces<'_>, counter: &CounterSurface<'_>, all: &[Candidate<'_>]) -> Result<()> {
    let lowest = |a: &&Sample, b: &&Sample| a.gap.total_cmp(&b.gap);
    let samples = || all.iter().flat_map(|candidate| &candidate.samples);
    let over = samples().filter(|c| c.foot.over).min_by(lowest);
    let (name, body) = (&surfaces.counter.name, &surfaces.body);
    let mut faults = Faults::new();
    let Some(nearest) = samples().min_by(lowest) else {
        let found = format!("faces of `{}` that look away from `{name}`", body.name);
        let fault = Fault::new(format!("`contact.{}.body`", surfaces.name), found, "faces that look at it");
        return Err(Error::input(fault.with_help("Choose the faces on the other side of the body")));
    };
    // Of points that are equally near, one over the faces. Of faces parts may be beside; a rim stands where its nearest node does.
    let of_faces = matches!(surfaces.side, ContactSide::Face(_));
    let near = |over: &&Sample| of_faces || over.gap <= nearest.gap + counter.tolerance();
    let nearest = over.filter(near).unwrap_or(nearest);
    let the_nearest = format!("the nearest of {} points of `{}`", all.len(), body.name);
    let faces = surfaces.faces.len();
    let mut beside = |what: &str, help: &str| {
        let found = format!("{the_nearest} at {} m, {what} ({faces} faces)", components(nearest.position));
        let expected = format!("a contact position on `{name}`");
        faults.push(Fault::new(format!("`contact.{}`", surfaces.name), found, expected).with_help(help));
    };
    // A point of a curved edge may overhang the plate; the nearest one must stand on it.
    let place_is_over = || counter.foot(nearest.place()).is_some_and(|foot| foot.over);
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
    nearest: &Sample<'_>,
    over: Option<&Sample<'_>>,
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
    let gap = |c: &Candidate| c.samples.iter().map(|s| s.gap).fold(f64::NEG_INFINITY, f64::max);
    let mut over: Vec<Candidate> =
        all.into_iter().filter(|c| c.samples.iter().all(|s| s.foot.over)).collect();
    match patch {
        ContactPatch::Reach(reach) => over.retain(|c| gap(c) <= reach + tolerance),
        ContactPatch::Nearest(_) => {
            let least = over.iter().map(gap).fold(f64::INFINITY, f64::min);
            let near = over.iter().filter(|c| gap(c) <= least + tolerance);
            let nearest: BTreeSet<Option<usize>> = near.map(Candidate::node).collect();
            over.retain(|c| nearest.contains(&c.node()));
            let share = 1.0 / over.len().max(1) as f64;
            over.iter_mut().flat_map(|c| &mut c.points).for_each(|point| point.weight = share);
        }
    }
    over
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
