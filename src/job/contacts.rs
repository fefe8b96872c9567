//! The contact pairs of a case: points from the meshes, laws from the case.

use super::contact_twice::{points_twice, surfaces_twice, tied_and_in_contact};
use super::counter::{CounterFaces, counter_faces};
use super::imported::given_points;
use super::regions::Regions;
use crate::case::{Case, Contact, Friction, InitialGap, Pressing, SlidingChoice, StiffnessPer};
use crate::connected::lowest_connected;
use crate::contact::{
    Bristle, ContactPatch, ContactSide, FrictionSense, GroundFault, NormalLaw, Sliding, SlidingLaw, Surfaces,
    pair_surfaces, travelled, tributary,
};
use crate::error::{Error, Fault, Faults, Result};
use crate::mesh::{Cell, cell_nodes, made_of};
use crate::structure::{DofMap, Model, Part};
use crate::system::{Closing, ContactPair, ContactPoint, FrictionAtRest};
use nalgebra::Vector3;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Faces whose area vectors add up to less than this share of their areas look no one way.
const ONE_WAY: f64 = 0.5;

/// Every contact pair of the case.
///
/// # Errors
/// All faults of all pairs: regions that are missing, bodies out of reach, tables that make no sense.
pub fn contact_pairs(
    case: &Case,
    regions: &Regions,
    model: &Model,
    dofs: &DofMap,
) -> Result<Vec<ContactPair>> {
    let mut faults = Faults::new();
    let mut pairs = Vec::new();
    for (name, contact) in &case.contact {
        let points = if let Some(points) = &contact.points {
            faults.take(given_points(case, name, contact, points, dofs.n_dofs()))
        } else if contact.counter == "ground" {
            faults.take(ground_points(name, contact, regions, dofs))
        } else {
            faults.take(surface_points(name, contact, (regions, model, dofs), &Stand::first(contact)))
        };
        let law = faults.take(law(name, contact, touches_with_faces(contact, regions, model)));
        let points = points.and_then(|points| faults.take(by_mean_distance(name, contact, points)));
        if let (Some(points), Some(law)) = (points, law) {
            pairs.push(ContactPair {
                name: name.clone(),
                sliding_velocity: sliding_velocity(contact, &points),
                points: points.into(),
                law: Arc::new(law),
                closing: closing(contact),
            });
        }
    }
    points_twice(&pairs, case.matrices.is_some(), &mut faults);
    surfaces_twice(case, (regions, model), &pairs, &mut faults);
    tied_and_in_contact(case, (regions, model), &mut faults);
    faults.into_result(pairs)
}

/// The same points under the laws, loads and velocities of `case`.
///
/// # Errors
/// A table that makes no sense.
pub fn with_laws(pairs: &[ContactPair], case: &Case) -> Result<Vec<ContactPair>> {
    let of = |pair: &ContactPair| {
        let contact = &case.contact[&pair.name];
        let elastic = pair.law.at_rest() == FrictionAtRest::Elastic;
        Ok(ContactPair {
            law: Arc::new(law(&pair.name, contact, elastic)?),
            closing: closing(contact),
            sliding_velocity: sliding_velocity(contact, &pair.points),
            ..pair.clone()
        })
    };
    pairs.iter().map(of).collect()
}

/// V of a pair \[m/s\]: of a counter-body that turns, at the mean distance of the points from the axis.
fn sliding_velocity(contact: &Contact, points: &[ContactPoint]) -> f64 {
    contact.sliding.rate() * contact.sliding.way().mean_distance(points)
}

/// The points of a counter-body that turns with their speeds in parts of V, where they come with their distance from the axis.
fn by_mean_distance(
    name: &str,
    contact: &Contact,
    mut points: Vec<ContactPoint>,
) -> Result<Vec<ContactPoint>> {
    let mean = contact.sliding.way().mean_distance(&points);
    if mean == 0.0 {
        let fault = Fault::new(
            format!("`contact.{name}.rotation.point`"),
            "an axis through the only point",
            "points beside the axis",
        );
        return Err(Error::input(fault));
    }
    points.iter_mut().for_each(|point| point.speed /= mean);
    Ok(points)
}

fn closing(contact: &Contact) -> Closing {
    match contact.pressing {
        Pressing::Load { load } => Closing::Load(load),
        Pressing::Approach { approach } => Closing::Approach(approach),
    }
}

/// Whether a pair touches with faces of a solid.
fn touches_with_faces(contact: &Contact, regions: &Regions, model: &Model) -> bool {
    let nodes = regions.nodes(&contact.body, "").unwrap_or_default();
    let on_a_solid = model.part_with(&nodes).is_some_and(|part| part.as_shell().is_none());
    contact.points.is_none() && contact.normal.per == StiffnessPer::Area && on_a_solid
}

/// The law of a pair, which sticks elastically by default where `elastic`.
fn law(name: &str, contact: &Contact, elastic: bool) -> Result<SlidingLaw> {
    let normal = NormalLaw {
        stiffness: contact.normal.stiffness,
        cubic_stiffness: contact.normal.cubic,
        damping: contact.normal.damping,
        bilateral: !contact.normal.unilateral,
    };
    let Friction { regularisation, sense, .. } = contact.friction;
    let sticks = (elastic || contact.rests())
        && (regularisation == 0.0 && sense == FrictionSense::WithSlip)
        && (normal.stiffness > 0.0 && !normal.bilateral);
    let by_default = sticks.then_some(Bristle { stiffness: normal.stiffness, damping: 0.0 });
    let given = contact.bristle.as_ref().map(|b| Bristle { stiffness: b.stiffness, damping: b.damping });
    let friction = contact.friction.law.coefficient(&format!("`contact.{name}.friction`"))?;
    Ok(SlidingLaw { normal, friction, regularisation, sense, bristle: given.or(by_default) })
}

/// A stiffness per length on faces, per area on lines, or either on points.
fn unfit(name: &str, per: StiffnessPer, natural: Option<StiffnessPer>) -> Error {
    let word = StiffnessPer::word;
    let expected = match natural.filter(|natural| *natural != StiffnessPer::Point) {
        Some(natural) => format!("\"{}\" or \"point\" for this region", word(natural)),
        None => "\"point\" for this region".to_string(),
    };
    Error::input(Fault::new(format!("`contact.{name}.normal.per`"), format!("\"{}\"", word(per)), expected))
}

/// Points of a region against rigid ground.
fn ground_points(
    name: &str,
    contact: &Contact,
    regions: &Regions,
    dofs: &DofMap,
) -> Result<Vec<ContactPoint>> {
    let region = regions.region(&contact.body, &format!("`contact.{name}.body`"))?;
    let nodes = regions.mesh.region_nodes(region);
    let natural =
        [StiffnessPer::Point, StiffnessPer::Length, StiffnessPer::Area].get(region.dimension).copied();
    let weighted: Vec<(usize, f64)> = match contact.normal.per {
        StiffnessPer::Point => nodes.iter().map(|node| (*node, 1.0 / nodes.len() as f64)).collect(),
        per if Some(per) == natural => {
            let weights = tributary(&regions.mesh.nodes, &regions.cells(region));
            nodes.iter().map(|node| (*node, weights[*node])).collect()
        }
        per => return Err(unfit(name, per, natural)),
    };
    let directions = (contact.into.unwrap_or_default(), contact.sliding.way());
    crate::contact::ground_points(&weighted, &regions.mesh.nodes, directions, &|terms| dofs.reduce(terms))
        .map_err(|fault| {
            let (key, found, expected) = match fault {
                GroundFault::NoDirection => ("into", "no direction", "a direction"),
                GroundFault::SlidesIntoTheGround => {
                    let key = match contact.sliding {
                        SlidingChoice::Along { .. } => "sliding_direction",
                        SlidingChoice::About { .. } => "rotation.axis",
                    };
                    (key, "the direction into the ground", "a direction along the ground")
                }
            };
            Error::input(Fault::new(format!("`contact.{name}.{key}`"), found, expected))
        })
}

/// How the bodies of a pair stand to each other.
#[derive(Debug, Clone, Copy)]
pub struct Stand {
    /// How far the counter-body has come along the sliding direction \[m\].
    pub travel: f64,
    /// Distance subtracted from the gaps \[m\]; the smallest gap when absent.
    pub touch: Option<f64>,
}

impl Stand {
    /// As the case has it. The approach of a placed body counts from the first touch.
    fn first(contact: &Contact) -> Self {
        Stand { travel: 0.0, touch: contact.placement.is_none().then_some(0.0) }
    }
}

/// What makes the `nodes` of a body and the `faces` of its counter-body one body, and what to do: nodes that both have, or one piece of the same part
/// that they are on.
fn touches_itself(
    regions: &Regions,
    (body, counter): (&Part, &[&Part]),
    nodes: &[usize],
    faces: &[Cell],
) -> Option<(String, &'static str)> {
    let of_counter = cell_nodes(faces);
    let shared: Vec<usize> =
        nodes.iter().copied().filter(|node| of_counter.binary_search(node).is_ok()).collect();
    if let Some(first) = shared.first() {
        let (count, all, name) = (shared.len(), nodes.len(), regions.name_of_node(*first));
        let found = format!("has {count} of the {all} nodes of the body, the first {name}");
        return Some((
            found,
            "Two plates that touch have nodes of their own, half of both thicknesses apart",
        ));
    }
    let counter = counter.iter().find(|part| part.name == body.name)?;
    let piece = lowest_connected(regions.mesh.nodes.len(), body.cells.iter().map(Cell::nodes));
    let own: BTreeSet<usize> = nodes.iter().map(|node| piece[*node]).collect();
    let found = format!("hangs together with the body in `{}`", counter.name);
    let connected = of_counter.iter().any(|node| own.contains(&piece[*node]));
    connected.then_some((found, "Give both bodies meshes of their own, without common nodes"))
}

/// Points of a rim or a face against another body.
pub fn surface_points(
    name: &str,
    contact: &Contact,
    (regions, model, dofs): (&Regions, &Model, &DofMap),
    stand: &Stand,
) -> Result<Vec<ContactPoint>> {
    let place = |key: &str| format!("`contact.{name}.{key}`");
    let region = regions.region(&contact.body, &place("body"))?;
    let touching = regions.cells(region);
    let nodes = regions.mesh.region_nodes(region);
    let body = model.part_with(&nodes).ok_or_else(|| {
        Error::input(Fault::new(
            place("body"),
            format!("region \"{}\", whose nodes are not all on one shell or one solid", contact.body),
            "lines or faces on one of the case's shells, or faces on one of its solids",
        ).with_help("Of several bodies, give each a contact of its own; the counter-faces may be on several solids"))
    })?;
    let CounterFaces { part: counter, parts, faces } =
        counter_faces(&contact.counter, regions, model, (&place("counter"), ", or \"ground\""))?;
    if let Some((found, help)) = touches_itself(regions, (body, &parts), &nodes, &faces) {
        let found = format!("\"{}\", which {found}", contact.counter);
        let fault = Fault::new(place("counter"), found, "another body: none is in contact with itself");
        return Err(Error::input(fault.with_help(help)));
    }
    let touching = match region.dimension {
        2 => body.outward(touching).ok_or_else(|| {
            let found = format!("region \"{}\", some of whose faces are not on the skin", contact.body);
            Error::input(Fault::new(place("body"), found, format!("faces on the skin of `{}`", body.name)))
        })?,
        _ => touching,
    };
    let lines: Vec<[usize; 2]> = touching.iter().filter_map(Cell::ends).collect();
    let (side, natural) = match region.dimension {
        1 if body.as_shell().is_none() => {
            let found = format!("region \"{}\" of lines on the solid `{}`", contact.body, body.name);
            return Err(Error::input(Fault::new(place("body"), found, "a region of its faces")));
        }
        1 if contact.points_across == 1 => (ContactSide::Middle(&lines), StiffnessPer::Length),
        1 => (ContactSide::Edge(&lines), StiffnessPer::Length),
        2 => (ContactSide::Face(&touching), StiffnessPer::Area),
        _ => {
            return Err(Error::input(Fault::new(
                place("body"),
                format!("region \"{}\" of {}", contact.body, made_of(region.dimension)),
                "lines or faces; points can only touch the ground",
            )));
        }
    };
    let patch = match contact.normal.per {
        StiffnessPer::Point => ContactPatch::Nearest(contact.reach),
        per if per == natural => ContactPatch::Reach(contact.reach),
        per => return Err(unfit(name, per, Some(natural))),
    };
    let way = contact.sliding.way();
    let moved = match way {
        Sliding::Along(direction) if stand.travel != 0.0 => {
            Some(travelled(&model.nodes, &faces, direction, stand.travel))
        }
        _ => None,
    };
    let surfaces = Surfaces {
        name,
        nodes: moved.as_ref().unwrap_or(&model.nodes),
        body,
        side,
        counter,
        faces: &faces,
        sliding: way,
        patch,
        stroke: contact.stroke,
    };
    let mut points = pair_surfaces(&surfaces, &|terms| dofs.reduce(terms))?;
    let touch = stand.touch.unwrap_or_else(|| points.iter().map(|p| p.gap).fold(f64::INFINITY, f64::min));
    points.iter_mut().for_each(|p| match contact.initial_gap {
        InitialGap::Geometry => p.gap -= touch,
        InitialGap::Closed => p.gap = 0.0,
    });
    Ok(points)
}

/// Two unit vectors of a pair, for pictures: where the load presses the body, and where the counter-body moves; zero where it has no one such
/// direction, as a shaft in a bore.
pub fn arrows(contact: &Contact, regions: &Regions, model: &Model, points: &[ContactPoint]) -> [[f64; 3]; 2] {
    let weight: f64 = points.iter().map(|p| p.weight).sum();
    let middle = points.iter().map(|p| p.weight / weight * Vector3::from(p.position)).sum::<Vector3<f64>>();
    let sliding = Vector3::from(contact.sliding.way().at(middle.into())) * contact.sliding.rate();
    let press = match (contact.into, counter_faces(&contact.counter, regions, model, ("", "")).ok()) {
        (Some(into), _) => Vector3::from(into),
        (None, Some(CounterFaces { part, faces, .. })) => {
            let at = |face: &Cell, k: usize| Vector3::from(model.nodes[face.corners()[k]]);
            let normal = |face: &Cell| (at(face, 1) - at(face, 0)).cross(&(at(face, 2) - at(face, 0)));
            let sum = faces.iter().map(normal).sum::<Vector3<f64>>();
            let whole: f64 = faces.iter().map(|face| normal(face).norm()).sum();
            // The faces of a solid look outwards; a plate is pressed on the side of the points.
            let side = match part.as_shell() {
                Some(_) => faces.first().map_or(0.0, |face| (middle - at(face, 0)).dot(&sum)).signum(),
                None => 1.0,
            };
            if sum.norm() > ONE_WAY * whole { -side * sum } else { Vector3::zeros() }
        }
        (None, None) => Vector3::zeros(),
    };
    [press, sliding].map(|v| v.try_normalize(0.0).unwrap_or_default().into())
}

#[cfg(test)]
mod tests {
    use super::{Arc, with_laws};
    use crate::bounds::{Origin::*, within};
    use crate::case::Case;
    use crate::job::Prepared;
    use crate::job::scalars::scalar;

    /// Neighbouring systems and members of sweeps have the directions of the contact points of the case itself, not copies of them.
    #[test]
    fn systems_that_differ_in_laws_share_their_contact_points() {
        let text = include_str!("../../validation/rig-coarse/case.toml");
        let case = Case::parse("rig", text, std::path::PathBuf::new()).unwrap();
        let prepared = Prepared::new(&case).unwrap();
        for path in ["contact.rim.friction.mu0", "contact.rim.sliding_velocity", "contact.rim.load"] {
            let own = case.parameter(path).unwrap().value;
            let neighbour = scalar(&case, path).unwrap().unwrap().system_at(&prepared, 1.1 * own).unwrap();
            let member = with_laws(&prepared.system.pairs, &case.with_parameter(path, 1.1 * own).unwrap());
            for pairs in [&neighbour.pairs, &member.unwrap()] {
                assert!(Arc::ptr_eq(&pairs[0].points, &prepared.system.pairs[0].points), "{path}");
            }
        }
    }

    /// A stiffness per area or length counts the area of the faces or the length of the lines that touch the ground, one per point the region.
    #[test]
    fn contact_with_the_ground_counts_lengths_and_areas() {
        let weights = |body: &str, per: &str| {
            let text = format!(
                "[mesh.plate]\nlength = 0.3\nwidth = 0.2\ncells_along = 3\ncells_across = 2\n[material.steel]\n\
                 youngs_modulus = 2e11\npoissons_ratio = 0.3\ndensity = 8000\n[shell.plate]\nmaterial = \"steel\"\n\
                 thickness = 0.001\n[contact.floor]\nbody = \"{body}\"\ncounter = \"ground\"\ninto = [0, 0, -1]\n\
                 approach = 1e-6\nsliding_direction = [1, 0, 0]\nsliding_velocity = 1\n\
                 normal = {{ per = \"{per}\", stiffness = 1e6 }}\nfriction = {{ law = \"coulomb\", mu0 = 0.3 }}\n\
                 [modes.all]\ncount = 1\n"
            );
            let case = Case::parse("a.toml", &text, std::path::PathBuf::new()).unwrap();
            let prepared = Prepared::new(&case).map_err(|error| error.to_string())?;
            Ok::<f64, String>(prepared.system.points().map(|(_, point)| point.weight).sum())
        };
        let near = |found: Result<f64, String>, right: f64| {
            let found = found.unwrap();
            assert!(within((found / right - 1.0).abs(), 1e-14, RoundOff), "{found} {right}");
        };
        near(weights("plate", "area"), 0.06);
        near(weights("plate_edge_y_min", "length"), 0.3);
        near(weights("plate", "point"), 1.0);
        for (body, per) in [("plate", "length"), ("plate_edge_y_min", "area")] {
            assert!(weights(body, per).unwrap_err().contains("`contact.floor.normal.per`"));
        }
    }
}
