//! Loads: FORCE, PLOAD, PLOAD2, PLOAD4, LOAD, and the rotation of RFORCE.

use super::constraints::taken;
use super::control::Choice;
use super::fields::Fields;
use super::list::{self, Ids};
use super::model::Model;
use crate::deck::{Deck, Load, LoadOn, Motion, Place, Set};
use crate::ledger::Weight;
use crate::skin::outer_faces;
use std::collections::{BTreeMap, BTreeSet, HashMap};

#[derive(Debug, Default)]
pub(super) struct Loads {
    sets: BTreeMap<u64, Vec<(Raw, Place)>>,
    /// Sums of sets with factors: LOAD.
    sums: BTreeMap<u64, (Vec<(f64, u64)>, Place)>,
}

/// A load as its card has it.
#[derive(Debug)]
enum Raw {
    Force {
        point: u64,
        system: u64,
        force: [f64; 3],
    },
    /// `card` is its name.
    Pressure {
        card: &'static str,
        elements: Vec<Ids>,
        pressure: f64,
        corners: [u64; 2],
    },
    /// On the face of these corners.
    OnCorners {
        corners: Vec<u64>,
        pressure: f64,
    },
    Rotation {
        point: u64,
        system: u64,
        axis: [f64; 3],
        turns: f64,
    },
}

impl Loads {
    pub fn card(&mut self, fields: &mut Fields) -> Option<()> {
        let set = fields.id(1)?;
        let raw = match fields.name() {
            "LOAD" => {
                let factor = fields.real_or(2, 1.0)?;
                let mut of = Vec::new();
                for first in (3..=fields.last()).step_by(2) {
                    if !fields.is_blank(first) || !fields.is_blank(first + 1) {
                        of.push((factor * fields.real(first)?, fields.id(first + 1)?));
                    }
                }
                let place = fields.place();
                self.sums.entry(set).or_insert((Vec::new(), place)).0.extend(of);
                return Some(());
            }
            "FORCE" => {
                let (point, system) = (fields.id(2)?, fields.id_or(3, 0)?);
                let (factor, direction) = (fields.real(4)?, fields.vector(5)?);
                Raw::Force { point, system, force: direction.map(|x| factor * x) }
            }
            "RFORCE" => {
                let (point, system) = (fields.id_or(2, 0)?, fields.id_or(3, 0)?);
                let (turns, axis) = (fields.real_or(4, 0.0)?, fields.vector(5)?);
                fields.unread(8, 8, Weight::Nothing, "how centrifugal forces are found is not read");
                fields.unread(9, 9, Weight::Nothing, "a rotation that changes is not read: its speed holds");
                Raw::Rotation { point, system, axis, turns }
            }
            "PLOAD" => {
                let pressure = fields.real(2)?;
                let mut corners = vec![fields.id(3)?, fields.id(4)?, fields.id(5)?];
                if !fields.is_blank(6) {
                    corners.push(fields.id(6)?);
                }
                Raw::OnCorners { corners, pressure }
            }
            "PLOAD2" => {
                let (pressure, last) = (fields.real(2)?, fields.last());
                Raw::Pressure {
                    card: "PLOAD2",
                    elements: list::read(fields, 3, last),
                    pressure,
                    corners: [0, 0],
                }
            }
            _ => pressure(fields)?,
        };
        let place = fields.place();
        self.sets.entry(set).or_default().push((raw, place));
        Some(())
    }

    pub fn resolve(&self, model: &mut Model) {
        let of = |(of, place): &(Vec<(f64, u64)>, Place)| (of.iter().map(|(_, set)| *set).collect(), *place);
        let sums = self.sums.iter().map(|(number, sum)| (*number, of(sum))).collect();
        let chosen = model.control.chosen(Choice::Load, model.notes);
        let mut factors: BTreeMap<u64, f64> = BTreeMap::new();
        for (factor, set) in chosen.and_then(|number| self.sums.get(&number)).map_or(&[][..], |(of, _)| of) {
            *factors.entry(*set).or_default() += factor;
        }
        let mut faces = None;
        for number in taken(Choice::Load, "LOAD", &self.sets, &sums, model) {
            // A set that is chosen by itself stands with the factor 1; one may stand in a sum several times.
            let in_sum = factors.get(&number).copied().unwrap_or(0.0);
            let own = if chosen.is_none() || chosen == Some(number) { 1.0 } else { 0.0 };
            let mut alike = Alike { faces, ..Alike::default() };
            for (raw, place) in self.sets.get(&number).into_iter().flatten() {
                let site = Site { set: number, factor: own + in_sum, place: *place };
                load(raw, &site, &mut alike, model);
            }
            faces = alike.faces;
        }
    }
}

/// PLOAD4: pressures at the corners of a face, which corners of a solid name; of a range of elements where THRU stands.
fn pressure(fields: &mut Fields) -> Option<Raw> {
    let first = fields.id(2)?;
    let p = fields.real_or(3, 0.0)?;
    for k in 4..7 {
        if fields.real_or(k, p)? != p {
            fields.note(
                Weight::Perhaps,
                "a pressure that varies over a face is not read: that at the first corner holds",
            );
        }
    }
    let range = fields.words(7, 7).iter().any(|(_, text)| *text == "THRU");
    let (elements, corners) = if range {
        (list::range(first, fields.id(8)?), [0, 0])
    } else {
        (Ids::One(first), [fields.id_or(7, 0)?, fields.id_or(8, 0)?])
    };
    fields.unread(
        9,
        12,
        Weight::Perhaps,
        "the direction of a load on faces is not read: it presses along the normal",
    );
    fields.unread(13, 14, Weight::Nothing, "the kind of load of edges is not read");
    Some(Raw::Pressure { card: "PLOAD4", elements: vec![elements], pressure: p, corners })
}

/// Loads of a set that differ in what they act on only, by their force or pressure.
#[derive(Default)]
struct Alike {
    loads: BTreeMap<[u64; 3], usize>,
    /// What each acts on already: a node that has a force twice has two loads.
    on: BTreeSet<(usize, usize, usize)>,
    /// Once a PLOAD asks for them.
    faces: Option<CornersOfFaces>,
}

impl Alike {
    /// Adds a load of these values on a node, or on an element and its side, to one that has them, or as a new one.
    fn add(
        &mut self,
        values: [f64; 3],
        (thing, side): (usize, usize),
        on: LoadOn,
        site: &Site,
        deck: &mut Deck,
    ) {
        let (key, next) = (values.map(f64::to_bits), deck.loads.len());
        let at = *self.loads.entry(key).or_insert(next);
        let fresh = self.on.insert((at, thing, side));
        match (deck.loads.get_mut(at).map(|load| &mut load.on), &on) {
            (Some(LoadOn::Nodes { nodes, .. }), LoadOn::Nodes { .. }) if fresh => nodes.push(thing),
            (Some(LoadOn::Faces { faces, .. }), LoadOn::Faces { .. }) if fresh => faces.push((thing, side)),
            (Some(LoadOn::Shells { shells, .. }), LoadOn::Shells { .. }) if fresh => shells.push(thing),
            _ => {
                self.loads.insert(key, next);
                self.on.insert((next, thing, side));
                deck.loads.push(Load { name: format!("LOAD_{}", site.set), on, place: site.place });
            }
        }
    }
}

/// Where a load stands, and its factor.
struct Site {
    set: u64,
    factor: f64,
    place: Place,
}

fn load(raw: &Raw, site: &Site, alike: &mut Alike, model: &mut Model) {
    match raw {
        Raw::Force { point, system, force } => {
            let Some(node) = model.node(*point, "FORCE", site.place) else { return };
            let Some(axes) = model.frames.get(*system, site.place, model.notes) else { return };
            let force = axes.vector(force.map(|x| site.factor * x), model.position(node));
            alike.add(force, (node, 0), LoadOn::Nodes { nodes: vec![node], force }, site, &mut model.deck);
        }
        Raw::Rotation { point, system, axis, turns } => {
            let Some(axes) = model.frames.get(*system, site.place, model.notes) else { return };
            let mut point_on = [0.0; 3];
            if *point > 0 {
                let Some(node) = model.node(*point, "RFORCE", site.place) else { return };
                point_on = model.position(node);
            }
            rotation(point_on, axes.vector(*axis, point_on), turns * site.factor, site.place, model);
        }
        Raw::OnCorners { corners, pressure } => {
            on_corners(corners, site.factor * pressure, site, alike, model)
        }
        Raw::Pressure { card, elements, pressure, corners } => {
            let pressure = site.factor * pressure;
            for element in model.elements(elements, card, site.place) {
                let what = &model.deck.elements[element];
                if what.kind.dimension() == 2 {
                    on_shell(element, pressure, site, alike, model);
                } else if what.kind.dimension() != 3 || *card == "PLOAD2" {
                    let why = "pressures on elements of this kind are not read";
                    model.notes.ledger.note(Weight::Perhaps, *card, why, site.place);
                } else if let Some(side) = side(element, *corners, model) {
                    let on = LoadOn::Faces { faces: vec![(element, side)], pressure };
                    alike.add([pressure, 0.0, 0.0], (element, side), on, site, &mut model.deck);
                } else {
                    let [first, second] = corners;
                    let found =
                        format!("PLOAD4 with corners {first} and {second} of element {}", what.number);
                    let expected = "a corner of a face and the one across from it";
                    model.notes.files.fault(site.place, found, expected);
                }
            }
        }
    }
}

/// A pressure along the normal of a shell.
fn on_shell(shell: usize, pressure: f64, site: &Site, alike: &mut Alike, model: &mut Model) {
    let on = LoadOn::Shells { shells: vec![shell], pressure };
    alike.add([pressure, 0.0, 1.0], (shell, 0), on, site, &mut model.deck);
}

/// PLOAD: a pressure on the face of some corners, along its normal by the right hand about them. The face is that of a shell, or the side of a
/// solid.
fn on_corners(corners: &[u64], pressure: f64, site: &Site, alike: &mut Alike, model: &mut Model) {
    let corners = corners.iter().map(|id| model.node(*id, "PLOAD", site.place));
    let Some(corners) = corners.collect::<Option<Vec<usize>>>() else { return };
    match alike.faces.get_or_insert_with(|| CornersOfFaces::of(&model.deck)).find(&corners) {
        Some((element, None, same)) => {
            on_shell(element, if same { pressure } else { -pressure }, site, alike, model);
        }
        Some((element, Some(side), same)) => {
            // The sides of solids go round as seen from outside.
            let pressure = if same { -pressure } else { pressure };
            let on = LoadOn::Faces { faces: vec![(element, side)], pressure };
            alike.add([pressure, 0.0, 0.0], (element, side), on, site, &mut model.deck);
        }
        None => {
            let why = "a pressure on a face that no element has is not read";
            model.notes.ledger.note(Weight::Matters, "PLOAD", why, site.place);
        }
    }
}

/// Shells, and sides of solids, by their corners.
struct CornersOfFaces(HashMap<Vec<usize>, (usize, Option<usize>, [usize; 2])>);

impl CornersOfFaces {
    fn of(deck: &Deck) -> Self {
        let mut found = HashMap::new();
        let mut add = |corners: Vec<usize>, element: usize, side: Option<usize>| {
            let first = [corners[0], corners[1]];
            found.entry(ordered(corners)).or_insert((element, side, first));
        };
        let shells = deck.elements.iter().enumerate().filter(|(_, own)| own.kind.dimension() == 2);
        shells.for_each(|(k, own)| add(own.nodes[..own.kind.n_corners()].to_vec(), k, None));
        for (k, side) in outer_faces(&deck.elements, 0..deck.elements.len()) {
            let (kind, nodes) = deck.elements[k].kind.table().sides[side];
            let corners =
                nodes[..kind.n_corners()].iter().map(|node| deck.elements[k].nodes[usize::from(*node)]);
            add(corners.collect(), k, Some(side));
        }
        CornersOfFaces(found)
    }

    /// The element, its side if it is a solid, and whether it goes round its corners as these do.
    fn find(&self, corners: &[usize]) -> Option<(usize, Option<usize>, bool)> {
        let (element, side, [a, b]) = *self.0.get(&ordered(corners.to_vec()))?;
        let at = corners.iter().position(|node| *node == a)?;
        Some((element, side, corners[(at + 1) % corners.len()] == b))
    }
}

fn ordered(mut nodes: Vec<usize>) -> Vec<usize> {
    nodes.sort_unstable();
    nodes
}

/// All elements turn about an axis of length R: so many times R revolutions a unit of time.
fn rotation(point: [f64; 3], axis: [f64; 3], turns: f64, place: Place, model: &mut Model) {
    let length = stridor_mesh::quality::norm(axis);
    if length == 0.0 {
        let expected = "a direction that is not zero";
        model.notes.files.fault(place, "RFORCE about an axis of no length", expected);
        return;
    }
    let set = "RFORCE".to_string();
    if model.deck.element_set(&set).is_none() {
        let members = (0..model.deck.elements.len()).collect();
        model.deck.element_sets.push(Set { name: set.clone(), members, internal: true });
    }
    let (axis, speed) = (axis.map(|x| x / length), std::f64::consts::TAU * turns * length);
    model.deck.motions.push(Motion { set, point, axis, speed, place });
}

/// The side of a solid that two grid points name: a corner of the face, and the one across from it, or that of a tetrahedron which is not
/// on it.
pub(super) fn side(element: usize, [first, second]: [u64; 2], model: &Model) -> Option<usize> {
    let element = &model.deck.elements[element];
    let corners = &element.nodes[..element.kind.n_corners()];
    let corner =
        |id: u64| corners.iter().position(|node| model.deck.nodes[*node].number == id).map(|at| at as u8);
    let second = if second == 0 { None } else { Some(corner(second)?) };
    element.kind.side_of_corners(corner(first)?, second)
}
