//! A model as a [`Deck`]: nodes and elements by index, sets, sections, supports, equations, couplings, pairs of contact.

use super::conditions;
use super::contact::Faces;
use super::materials;
use super::model::RawElement;
use super::reader::Reader;
use super::sections::Sections;
use super::shapes::{self, Family, Middles, Routine, corners};
use crate::deck::{Deck, Element, Material, Node, Place, PointMass, Set, Spring};
use crate::ledger::Weight;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Key options that are read of the elements of a family, or mean nothing.
const OPTIONS_READ: &[(Family, &[u32])] = &[
    (Family::Mass, &[3]),
    (Family::Spring, &[2, 3]),
    (Family::Contact, &[2, 4, 5, 8, 9, 10, 12]),
    (Family::Target, &[1, 2, 3, 4]),
];

/// The deck of what a reader has read.
pub(super) fn deck(mut reader: Reader<'_>) -> Deck {
    let mut deck = Deck::default();
    let numbers: Vec<u64> = reader.model.nodes.keys().copied().collect();
    deck.nodes = reader
        .model
        .nodes
        .iter()
        .map(|(number, own)| Node { number: *number, position: own.position, place: own.place })
        .collect();
    let mut middles = Middles::new(&reader.model);
    let mut faces = Faces::default();
    let mut sections = Sections::default();
    let there = |node: u64| numbers.binary_search(&node).ok();
    elements(&mut reader, &mut deck, &mut middles, &mut faces, &mut sections, &there);
    deck.nodes.extend(middles.nodes(&reader.model));
    let all: Vec<u64> = deck.nodes.iter().map(|node| node.number).collect();
    let index = |node: u64| all.binary_search(&node).ok();
    middles.equations(index, &mut deck.equations);
    sets(&mut reader, &mut deck);
    let by_members: HashMap<Vec<usize>, String> =
        deck.element_sets.iter().map(|set| (set.members.clone(), set.name.clone())).collect();
    deck.sections = sections.finish(&mut reader, |elements| by_members.get(elements).cloned());
    all_materials(&mut reader, &mut deck);
    let found = faces.find(&deck, &index);
    conditions::pressures(&mut reader, &mut deck, &faces, &found, &index);
    faces.pairs(&mut reader, &mut deck, &found, &index);
    conditions::supports(&mut reader, &mut deck, &index);
    conditions::equations(&mut reader, &mut deck, &index);
    conditions::couplings(&mut reader, &mut deck, &index);
    conditions::motions(&mut reader, &mut deck);
    deck.title = std::mem::take(&mut reader.model.title).trim().to_string();
    deck.analyses = std::mem::take(&mut reader.model.analyses);
    deck.ledger = std::mem::take(&mut reader.model.ledger);
    deck
}

/// Cells, masses, springs, and elements on faces.
fn elements(
    reader: &mut Reader<'_>,
    deck: &mut Deck,
    middles: &mut Middles,
    faces: &mut Faces,
    sections: &mut Sections,
    index: &impl Fn(u64) -> Option<usize>,
) {
    let mut names: BTreeMap<u32, Option<(&'static Routine, u32)>> = BTreeMap::new();
    let mut springs: BTreeMap<(u32, u32), Spring> = BTreeMap::new();
    let mut masses: BTreeMap<(u32, u32), PointMass> = BTreeMap::new();
    // Taken out, and put back for what is named by number.
    let all = std::mem::take(&mut reader.model.elements);
    for (number, raw) in &all {
        let kind = raw.attributes.kind;
        let known = *names.entry(kind).or_insert_with(|| type_of(reader, deck, kind, raw.place));
        let Some((routine, type_name)) = known else { continue };
        if routine.family == Family::Drawn {
            continue;
        }
        if let Some(node) = raw.nodes.iter().find(|node| **node > 0 && index(**node).is_none()) {
            reader.fault(
                raw.place,
                format!("element {number} on node {node}, which is not there"),
                "nodes of the file",
            );
            continue;
        }
        match routine.family {
            Family::Solid | Family::Shell | Family::Beam | Family::Link => {
                let Some(cell) = shapes::cell(reader, middles, routine, &raw.nodes, raw.place) else {
                    let found = format!("element {number} of {} with {}", routine.name, listed(&raw.nodes));
                    let expected = format!(
                        "{} corners or more, that form a shape of {}",
                        corners(routine),
                        routine.name
                    );
                    reader.fault(raw.place, found, expected);
                    continue;
                };
                let own = deck.elements.len();
                if cell.turned {
                    faces.turned.insert(own);
                }
                sections.add(&reader.model, routine, raw, own);
                let place = raw.place;
                // By number until the nodes in the middles of edges are there: they come after all others.
                let nodes = cell
                    .nodes
                    .iter()
                    .map(|node| index(*node).unwrap_or_else(|| middles.index(*node, deck.nodes.len())));
                let nodes = nodes.collect();
                deck.elements.push(Element { number: *number, kind: cell.kind, type_name, nodes, place });
            }
            Family::Mass => mass(reader, &mut masses, raw, index),
            Family::Spring => spring(reader, &mut springs, raw, index),
            family => faces.add(family, *number, raw.attributes, &raw.nodes, raw.place),
        }
    }
    reader.model.elements = all;
    deck.springs = springs.into_values().collect();
    deck.masses = masses.into_values().collect();
}

/// What elements of a type are, and the number of its name.
fn type_of(
    reader: &mut Reader<'_>,
    deck: &mut Deck,
    kind: u32,
    place: Place,
) -> Option<(&'static Routine, u32)> {
    let Some(own) = reader.model.types.get(&kind).cloned() else {
        reader.fault(
            place,
            format!("an element of type {kind}, which is not there"),
            "a type that ET or ETBLOCK defines",
        );
        return None;
    };
    let Some(routine) = shapes::routine(own.routine) else {
        let why = "elements that are not read";
        reader.note(Weight::Matters, format!("element {} of type {kind}", own.routine), why, place);
        return None;
    };
    match routine.family {
        Family::Drawn => {
            reader.note(Weight::Nothing, routine.name, "elements without stiffness are left out", place)
        }
        Family::Surface => {
            reader.note(Weight::Nothing, routine.name, "of elements on faces pressures are read only", place);
        }
        _ => {}
    }
    if let Some((weight, why)) = routine.other {
        reader.note(weight, routine.name, why, place);
    }
    let read =
        OPTIONS_READ.iter().find(|(family, _)| *family == routine.family).map_or(&[][..], |(_, own)| *own);
    let mut name = routine.name.to_string();
    for (n, value) in own.options.iter().filter(|(n, value)| **value != 0 && !read.contains(n)) {
        let what = format!("KEYOPT({n}) = {value} of {}", routine.name);
        let formulation = *n == 2 && routine.family == Family::Solid;
        if formulation {
            name += &format!(" KEYOPT(2)={value}");
        }
        let membrane = routine.family == Family::Shell && *n == 1;
        let (weight, why) = match routine.family {
            _ if formulation => (Weight::Perhaps, "the formulation is in the name of the type only"),
            _ if membrane => (Weight::Matters, "a membrane, or bending only: read as a shell"),
            Family::Contact | Family::Target | Family::Surface => {
                (Weight::Nothing, "a choice of the contact algorithm or of output")
            }
            _ => (Weight::Perhaps, "not read"),
        };
        reader.note(weight, what, why, own.place);
    }
    let known = deck.type_names.iter().position(|own| *own == name);
    let at = known.unwrap_or_else(|| {
        deck.type_names.push(name);
        deck.type_names.len() - 1
    });
    Some((routine, at as u32))
}

/// MASS21: masses along x, y, z and moments of inertia, or one mass (KEYOPT(3) of 2 and above).
fn mass(
    reader: &mut Reader<'_>,
    masses: &mut BTreeMap<(u32, u32), PointMass>,
    raw: &RawElement,
    index: &impl Fn(u64) -> Option<usize>,
) {
    let own = raw.attributes;
    let Some(node) = raw.nodes.first().and_then(|node| index(*node)) else { return };
    let known = masses.entry((own.kind, own.real)).or_insert_with(|| {
        let reals = reader.model.reals.get(&own.real);
        let real = |k: u32| reals.and_then(|all| all.get(&k)).copied().unwrap_or(0.0);
        let option = reader.model.types.get(&own.kind).map_or(0, |kind| kind.option(3));
        let inertia = if option < 2 { [real(4), real(5), real(6)] } else { [0.0; 3] };
        let (mass, unlike) = (real(1), option < 2 && (real(2) != real(1) || real(3) != real(1)));
        let name = format!("MASS_{}", own.real);
        let place = raw.place;
        if unlike {
            let why = "masses that differ along x, y, z: the first is taken";
            reader.note(Weight::Matters, format!("MASS21 of real constants {}", own.real), why, place);
        }
        PointMass { name, nodes: Vec::new(), mass, inertia, place }
    });
    known.nodes.push(node);
}

/// COMBIN14: k, c; KEYOPT(2) is the freedom from 1, or 0 for along the line of both nodes.
fn spring(
    reader: &mut Reader<'_>,
    springs: &mut BTreeMap<(u32, u32), Spring>,
    raw: &RawElement,
    index: &impl Fn(u64) -> Option<usize>,
) {
    let own = raw.attributes;
    let Some(first) = raw.nodes.first().and_then(|node| index(*node)) else { return };
    let second = raw.nodes.get(1).and_then(|node| index(*node));
    let model = &mut reader.model;
    let known = springs.entry((own.kind, own.real)).or_insert_with(|| {
        let reals = model.reals.get(&own.real);
        let real = |k: u32| reals.and_then(|all| all.get(&k)).copied().unwrap_or(0.0);
        let option = |n: u32| model.types.get(&own.kind).map_or(0, |kind| kind.option(n));
        let dof = u8::try_from(option(2)).ok().filter(|dof| (1..=6).contains(dof)).map(|dof| dof - 1);
        let name = format!("SPRING_{}", own.real);
        let [turning, nonlinear] = [dof.is_none() && option(3) == 1, real(3) != 0.0];
        let spring =
            Spring { name, ends: Vec::new(), dof, stiffness: real(1), damping: real(2), place: raw.place };
        let what = format!("COMBIN14 of real constants {}", own.real);
        if turning {
            model.ledger.note(
                Weight::Matters,
                &what,
                "a spring of torsion: read as one of length",
                raw.place,
            );
        }
        if nonlinear {
            model.ledger.note(
                Weight::Perhaps,
                &what,
                "damping by powers of velocity: the linear part is taken",
                raw.place,
            );
        }
        spring
    });
    if known.dof.is_some() && model.angles.contains_key(&raw.nodes[0]) {
        let why = "a spring in the turned frame of its node: read along x, y, z";
        model.ledger.note(Weight::Matters, "COMBIN14", why, raw.place);
    }
    known.ends.push((first, second));
}

/// Components as sets.
fn sets(reader: &mut Reader<'_>, deck: &mut Deck) {
    let components = std::mem::take(&mut reader.model.components);
    for (k, component) in components.iter().enumerate() {
        let upper = component.name.to_ascii_uppercase();
        if reader.model.names.get(&upper) != Some(&k) {
            let why = "defined again below: the last one is taken";
            reader.note(Weight::Nothing, format!("component {}", component.name), why, component.place);
            continue;
        }
        let members = reader.model.members(component);
        if !reader.keep(component.place, members.len()) {
            return;
        }
        let numbers = |number: &u64| {
            if component.of_nodes {
                deck.nodes.binary_search_by_key(number, |node| node.number).ok()
            } else {
                deck.elements.binary_search_by_key(number, |element| element.number).ok()
            }
        };
        let indices: Vec<usize> = members.iter().filter_map(numbers).collect();
        let single = component.ranges.iter().filter(|(from, to)| from == to);
        let gone = single.filter(|(number, _)| !members.contains(number)).count();
        if gone > 0 {
            let why = format!("{gone} members are not in the file");
            reader.note(Weight::Perhaps, format!("component {}", component.name), why, component.place);
        }
        if indices.is_empty() && !members.is_empty() {
            let why = "elements that are no cells";
            reader.note(Weight::Nothing, format!("component {}", component.name), why, component.place);
            continue;
        }
        let internal = component.name.starts_with('_');
        let set = Set { name: component.name.clone(), members: indices, internal };
        if component.of_nodes { deck.node_sets.push(set) } else { deck.element_sets.push(set) }
    }
    reader.model.components = components;
}

/// All materials, and those that sections name and that are not there.
fn all_materials(reader: &mut Reader<'_>, deck: &mut Deck) {
    deck.materials = materials::materials(&reader.model).into_values().collect();
    let known: BTreeSet<String> = deck.materials.iter().map(|own| own.name.clone()).collect();
    let missing: BTreeMap<String, Place> =
        deck.sections.iter().map(|section| (section.material.clone(), section.place)).collect();
    for (name, place) in missing.into_iter().filter(|(name, _)| !known.contains(name)) {
        reader.note(Weight::Matters, &name, "elements have a material without properties in the file", place);
        deck.materials.push(Material { name, ..Material::default() });
    }
}

/// Nodes for a message.
fn listed(nodes: &[u64]) -> String {
    let few: Vec<String> = nodes.iter().take(20).map(u64::to_string).collect();
    format!("nodes {}", few.join(" "))
}
