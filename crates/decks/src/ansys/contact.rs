//! Contact elements as surfaces of the cells beneath them, and their pairs: elements CONTA and TARGE of one set of real constants.
//!
//! Key options of CONTA173 to CONTA175: 2 is the algorithm (2: constraints), 4 of constraints to a pilot node is 1 where the pilot moves as
//! the others do on average and 2 where it leads them, 9 and 5 close gaps of the meshes, 12 is 0 for contact, 1 without slip, 2 and 4 without
//! separation, 3, 5 and 6 for what is joined. Real constants: 3 is the normal stiffness, 6 the size of the region of search, 12 the tangential
//! stiffness; they are in the units of the model where they are negative, factors otherwise.

use super::model::{Attributes, Region};
use super::reader::Reader;
use super::shapes::Family;
use crate::deck::{Contact, Deck, Place, ShellFace, Surface, Tie};
use crate::ledger::Weight;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Elements on faces.
#[derive(Debug, Default)]
pub(super) struct Faces {
    pairs: BTreeMap<u32, Pair>,
    /// Elements of loads: number, corners.
    pub loaded: BTreeMap<u64, Vec<u64>>,
    /// Cells whose faces do not have the numbers of the file.
    pub turned: BTreeSet<usize>,
}

/// The elements of a pair: the corners of each.
#[derive(Debug, Default)]
struct Pair {
    contact: Vec<Vec<u64>>,
    target: Vec<Vec<u64>>,
    /// All nodes of the contact elements.
    nodes: Vec<u64>,
    attributes: Option<Attributes>,
    place: Place,
}

/// The corners of a face, ascending.
type Corners = [usize; 4];

/// What is under a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Under {
    Side(usize, usize),
    Shell(usize, ShellFace),
}

/// The cells under faces by their corners.
#[derive(Debug, Default)]
pub(super) struct Found(HashMap<Corners, Vec<(Under, Vec<usize>)>>);

impl Faces {
    /// Takes an element that is no cell.
    pub fn add(&mut self, family: Family, number: u64, attributes: Attributes, nodes: &[u64], place: Place) {
        let corners = corners(family, nodes);
        if family == Family::Surface {
            self.loaded.insert(number, corners);
            return;
        }
        let pair = self.pairs.entry(attributes.real).or_default();
        if family == Family::Target {
            pair.target.push(corners);
        } else {
            pair.contact.push(corners);
            pair.nodes.extend(nodes.iter().filter(|node| **node > 0));
            if pair.attributes.is_none() {
                (pair.attributes, pair.place) = (Some(attributes), place);
            }
        }
    }

    /// Finds the cells under all faces.
    pub fn find(&self, deck: &Deck, index: &impl Fn(u64) -> Option<usize>) -> Found {
        let pairs = self.pairs.values().flat_map(|pair| pair.contact.iter().chain(&pair.target));
        let keys = pairs.chain(self.loaded.values()).filter_map(|corners| key(&indices(corners, index)));
        let mut found = Found(keys.map(|key| (key, Vec::new())).collect());
        if found.0.is_empty() {
            return found;
        }
        for (k, element) in deck.elements.iter().enumerate() {
            let whole: Vec<usize> = element.nodes[..element.kind.n_corners()].to_vec();
            let mut note = |under: Under, corners: Vec<usize>| {
                if let Some(all) = key(&corners).and_then(|key| found.0.get_mut(&key)) {
                    all.push((under, corners));
                }
            };
            match element.kind.dimension() {
                3 => {
                    for (side, (kind, nodes)) in element.kind.table().sides.iter().enumerate() {
                        let corners =
                            nodes[..kind.n_corners()].iter().map(|n| element.nodes[usize::from(*n)]);
                        note(Under::Side(k, side), corners.collect());
                    }
                }
                2 => note(Under::Shell(k, ShellFace::Positive), whole),
                _ => {}
            }
        }
        found
    }

    /// Surfaces, ties, contacts and couplings of all pairs.
    pub fn pairs(
        self,
        reader: &mut Reader<'_>,
        deck: &mut Deck,
        found: &Found,
        index: &impl Fn(u64) -> Option<usize>,
    ) {
        let mut seen: BTreeSet<[Vec<Under>; 2]> = BTreeSet::new();
        for (real, pair) in &self.pairs {
            let Some(attributes) = pair.attributes else {
                let why = "targets without contact elements of the same real constants";
                reader.note(Weight::Nothing, format!("TARGE170 of real constants {real}"), why, pair.place);
                continue;
            };
            let options = reader.model.types.get(&attributes.kind).cloned().unwrap_or_default();
            let pilots: Vec<u64> =
                pair.target.iter().filter(|own| own.len() == 1).map(|own| own[0]).collect();
            if let ([pilot], true) = (&pilots[..], pair.target.len() == 1) {
                let nodes = pair.nodes.iter().copied().filter(|node| node != pilot).collect();
                let rigid = options.option(4) != 1;
                reader.model.regions.push(Region { reference: *pilot, nodes, rigid, place: pair.place });
                continue;
            }
            if pair.target.is_empty() {
                let why = "contact elements without targets: contact of a surface with itself is not read";
                reader.note(Weight::Matters, format!("CONTA of real constants {real}"), why, pair.place);
                continue;
            }
            let names = ["CONTACT", "TARGET"].map(|side| format!("{side}_{real}"));
            let sides = [&pair.contact, &pair.target].map(|faces| surface(found, faces, index));
            let both = sides.clone().map(|(surface, _)| under(&surface));
            if seen.contains(&[both[1].clone(), both[0].clone()]) && !both[0].is_empty() {
                let why = "the same two surfaces the other way round: the first pair is taken";
                reader.note(Weight::Nothing, "pairs of contact", why, pair.place);
                continue;
            }
            seen.insert(both);
            for (k, (mut surface, lost)) in sides.into_iter().enumerate() {
                surface.name.clone_from(&names[k]);
                if lost > 0 {
                    let why = format!("{lost} faces that are of no cell");
                    reader.note(Weight::Matters, format!("surface {}", names[k]), why, pair.place);
                }
                deck.surfaces.push(surface);
            }
            let [slave, master] = names;
            joined_or_touching(reader, deck, attributes, *real, [slave, master], pair.place);
        }
    }
}

/// A tie or a contact between two surfaces.
fn joined_or_touching(
    reader: &mut Reader<'_>,
    deck: &mut Deck,
    attributes: Attributes,
    real: u32,
    [slave, master]: [String; 2],
    place: Place,
) {
    let model = &reader.model;
    let options = model.types.get(&attributes.kind).cloned().unwrap_or_default();
    let constant = |k: u32| model.reals.get(&real).and_then(|own| own.get(&k)).copied().unwrap_or(0.0);
    let absolute = |k: u32| Some(-constant(k)).filter(|value| *value > 0.0);
    let (stiffness, within, stick) = (absolute(3), absolute(6), absolute(12));
    let friction =
        model.materials.get(&attributes.material).and_then(|own| own.properties.get("MU")).copied();
    let name = format!("PAIR_{real}");
    let behaviour = options.option(12);
    if matches!(behaviour, 3 | 5 | 6) {
        deck.ties.push(Tie { name, slave, master, within, place });
        return;
    }
    match behaviour {
        1 => reader.note(
            Weight::Matters,
            "KEYOPT(12) = 1 of contact",
            "no slip: it sticks by friction of 1 here",
            place,
        ),
        2 | 4 => reader.note(
            Weight::Matters,
            "KEYOPT(12) = 2, 4 of contact",
            "surfaces that never part: here they may",
            place,
        ),
        _ => {}
    }
    let friction = if behaviour == 1 { 1.0 } else { friction.unwrap_or(0.0) };
    let closed = options.option(9) == 1 || matches!(options.option(5), 1 | 3);
    let name = String::new();
    deck.contacts.push(Contact { name, slave, master, friction, stiffness, stick, closed, place });
}

/// What is under a surface.
fn under(surface: &Surface) -> Vec<Under> {
    let faces = surface.faces.iter().map(|(element, side)| Under::Side(*element, *side));
    faces
        .chain(surface.shells.iter().map(|(element, _)| Under::Shell(*element, ShellFace::Positive)))
        .collect()
}

/// The surface of faces, and how many of them are of no cell. Faces of one node are a surface of nodes.
pub(super) fn surface(
    found: &Found,
    faces: &[Vec<u64>],
    index: &impl Fn(u64) -> Option<usize>,
) -> (Surface, usize) {
    let mut surface = Surface::default();
    let mut lost = 0;
    for face in faces {
        let corners = indices(face, index);
        if let ([node], 1) = (&corners[..], face.len()) {
            surface.nodes.push(*node);
            continue;
        }
        let all = key(&corners).and_then(|key| found.0.get(&key)).map_or(&[][..], Vec::as_slice);
        // Normals of contact elements look out of the cell that they are on.
        let agrees = |own: &[usize]| {
            (0..own.len()).any(|k| (0..own.len()).all(|i| own[(k + i) % own.len()] == corners[i]))
        };
        let side = all.iter().filter(|(under, _)| matches!(under, Under::Side(..)));
        let best = side.clone().find(|(_, own)| agrees(own)).or_else(|| side.clone().next()).or(all.first());
        match best {
            Some((Under::Side(element, side), _)) => surface.faces.push((*element, *side)),
            Some((Under::Shell(element, _), own)) => {
                let face = if agrees(own) { ShellFace::Positive } else { ShellFace::Negative };
                surface.shells.push((*element, face));
            }
            None => lost += 1,
        }
    }
    surface.faces.sort_unstable();
    surface.faces.dedup();
    surface.shells.sort_unstable();
    surface.shells.dedup();
    surface.nodes.sort_unstable();
    surface.nodes.dedup();
    (surface, lost)
}

/// The corners of an element on a face, in their order, each once.
fn corners(family: Family, nodes: &[u64]) -> Vec<u64> {
    let there = nodes.iter().take_while(|node| **node != 0).count();
    // Targets are triangles of 3 and 6 nodes, quadrilaterals of 4 and 8.
    let n = match (family, there) {
        (Family::Target, 6) => 3,
        (_, there) => there.min(4),
    };
    let mut corners: Vec<u64> = Vec::with_capacity(n);
    for node in &nodes[..n] {
        if !corners.contains(node) {
            corners.push(*node);
        }
    }
    corners
}

/// The indices of nodes; empty where one is not there.
fn indices(nodes: &[u64], index: &impl Fn(u64) -> Option<usize>) -> Vec<usize> {
    let all: Option<Vec<usize>> = nodes.iter().map(|node| index(*node)).collect();
    all.unwrap_or_default()
}

/// The corners of a face with three or four.
fn key(corners: &[usize]) -> Option<Corners> {
    let mut key = [usize::MAX; 4];
    if !(3..=4).contains(&corners.len()) {
        return None;
    }
    key[..corners.len()].copy_from_slice(corners);
    key.sort_unstable();
    Some(key)
}
