//! What acts on a model: supports, forces, pressures, equations, couplings and rotations, by index and in x, y, z.

use super::contact::{self, Faces};
use super::model::Terms;
use super::reader::Reader;
use super::shapes;
use crate::deck::{Coupling, CouplingKind, Deck, Equation, Frame, Load, LoadOn, Place, Support};
use crate::ledger::Weight;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use stridor_mesh::{CellKind, Program};

/// Faces under one pressure.
type Pressed = (f64, Vec<(usize, usize)>, Place);

/// Pressures on faces of solids, and by elements on them.
pub(super) fn pressures(
    reader: &mut Reader<'_>,
    deck: &mut Deck,
    faces: &Faces,
    found: &contact::Found,
    index: &impl Fn(u64) -> Option<usize>,
) {
    let mut loads: BTreeMap<u64, Pressed> = BTreeMap::new();
    let mut shells: BTreeMap<u64, (f64, Vec<usize>, Place)> = BTreeMap::new();
    for (number, face, pressure, place) in std::mem::take(&mut reader.model.pressures) {
        let side = if let Some(corners) = faces.loaded.get(&number) {
            let (surface, _) = contact::surface(found, std::slice::from_ref(corners), index);
            surface.faces.first().copied().filter(|_| face == 1)
        } else if let Ok(at) = deck.elements.binary_search_by_key(&number, |own| own.number) {
            let element = &deck.elements[at];
            if element.kind.dimension() == 2 && (1..=2).contains(&face) {
                // Face 1 is that below: a pressure there is along the normal.
                let pressure = if face == 1 { pressure } else { -pressure };
                shells.entry(pressure.to_bits()).or_insert((pressure, Vec::new(), place)).1.push(at);
                continue;
            }
            let side = side(element.kind, &deck.type_names[element.type_name as usize], face);
            side.filter(|_| element.kind.dimension() == 3 && !faces.turned.contains(&at))
                .map(|side| (at, side))
        } else {
            reader.fault(
                place,
                format!("a pressure on element {number}, which is not there"),
                "an element of the file",
            );
            continue;
        };
        match side {
            Some(side) => {
                loads.entry(pressure.to_bits()).or_insert((pressure, Vec::new(), place)).1.push(side)
            }
            None => {
                let why = format!("pressure on face {face} that is no face of a solid or a shell");
                reader.note(Weight::Perhaps, "SFE PRES", why, place);
            }
        }
    }
    let faces =
        loads.into_values().map(|(pressure, faces, place)| (LoadOn::Faces { faces, pressure }, place));
    let shells =
        shells.into_values().map(|(pressure, shells, place)| (LoadOn::Shells { shells, pressure }, place));
    let named = |(k, (on, place))| Load { name: format!("PRESSURE_{}", k + 1), on, place };
    deck.loads.extend(faces.chain(shells).enumerate().map(named));
}

/// The side of a face of an element of ANSYS.
fn side(kind: CellKind, type_name: &str, face: u32) -> Option<usize> {
    let routine: u32 =
        type_name.trim_start_matches(|c: char| !c.is_ascii_digit()).split(' ').next()?.parse().ok()?;
    let own = shapes::routine(routine)?;
    let forms = kind.named(Program::Ansys);
    let form = forms.iter().find(|form| form.names().any(|name| own.nodes_of.contains(&name)))?;
    form.sides.iter().position(|side| u32::from(*side) == face)
}

/// Supports of nodes that have the same freedoms held in the same frame, and forces.
pub(super) fn supports(reader: &mut Reader<'_>, deck: &mut Deck, index: &impl Fn(u64) -> Option<usize>) {
    let model = &reader.model;
    type Group = (Vec<usize>, Frame, Place);
    let mut groups: BTreeMap<([bool; 6], [u64; 3]), Group> = BTreeMap::new();
    let mut missing = Vec::new();
    for (node, held) in &model.held {
        let Some(at) = index(*node) else {
            missing.push((*node, held.place));
            continue;
        };
        let angles = model.angles.get(node).copied().unwrap_or_default();
        let key = (held.freedoms, angles.map(f64::to_bits));
        let group = groups.entry(key).or_insert((Vec::new(), model.frame(*node), held.place));
        group.0.push(at);
        group.2 = group.2.min(held.place);
    }
    let by_members: HashMap<&[usize], &str> =
        deck.node_sets.iter().map(|set| (set.members.as_slice(), set.name.as_str())).collect();
    for ((held, _), (nodes, frame, place)) in groups {
        let name = by_members.get(nodes.as_slice()).map(|name| name.to_string());
        let title = String::new();
        deck.supports.push(Support { title, name, nodes, held, frame, place });
    }
    let mut forces: BTreeMap<[u64; 3], ([f64; 3], Vec<usize>, Place)> = BTreeMap::new();
    for (node, (force, place)) in &model.forces {
        let Some(at) = index(*node) else {
            missing.push((*node, *place));
            continue;
        };
        let force = model.in_global(*node, *force);
        forces.entry(force.map(f64::to_bits)).or_insert((force, Vec::new(), *place)).1.push(at);
    }
    deck.loads.extend(forces.into_values().enumerate().map(|(k, (force, nodes, place))| Load {
        name: format!("FORCE_{}", k + 1),
        on: LoadOn::Nodes { nodes, force },
        place,
    }));
    for (node, place) in missing {
        reader.fault(place, format!("node {node}, which is not there"), "a node of the file");
    }
}

/// Constraint equations and coupled freedoms, in x, y, z.
pub(super) fn equations(reader: &mut Reader<'_>, deck: &mut Deck, index: &impl Fn(u64) -> Option<usize>) {
    let coupled =
        std::mem::take(&mut reader.model.coupled).into_iter().flat_map(|((_, dof), (nodes, place))| {
            let first = nodes.first().copied().unwrap_or(0);
            let others: Vec<u64> = nodes.into_iter().skip(1).filter(|node| *node != first).collect();
            others
                .into_iter()
                .map(move |node| -> (Terms, Place) { (vec![(node, dof, 1.0), (first, dof, -1.0)], place) })
        });
    let written = std::mem::take(&mut reader.model.equations).into_values();
    let mut written: Vec<(Terms, Place)> = written.chain(coupled).collect();
    // The first that stands in no other equation and that nothing holds follows the others (theory reference, constraint equations).
    let mut counts: HashMap<(u64, u8), usize> = HashMap::new();
    let terms = written.iter().flat_map(|(terms, _)| terms);
    terms.for_each(|(node, dof, _)| *counts.entry((*node, *dof)).or_default() += 1);
    for (terms, _) in &mut written {
        let held = |node: &u64, dof: &u8| {
            reader.model.held.get(node).is_some_and(|held| held.freedoms[usize::from(*dof)])
        };
        let own =
            |(node, dof, a): &(u64, u8, f64)| *a != 0.0 && counts[&(*node, *dof)] < 2 && !held(node, dof);
        if let Some(first) = terms.iter().position(own) {
            terms[..=first].rotate_right(1);
        }
    }
    for (terms, place) in written {
        let mut all: Vec<(usize, u8, f64)> = Vec::new();
        for (node, dof, factor) in terms {
            let Some(at) = index(node) else {
                reader.fault(
                    place,
                    format!("an equation of node {node}, which is not there"),
                    "a node of the file",
                );
                continue;
            };
            // A motion in the frame of the node is three along x, y, z.
            let (turning, axis) = (dof / 3 * 3, usize::from(dof % 3));
            match reader.model.frame(node) {
                Frame::Turned(axes) => {
                    let parts = axes[axis].into_iter().zip(turning..).filter(|(part, _)| *part != 0.0);
                    all.extend(parts.map(|(part, dof)| (at, dof, factor * part)));
                }
                _ => all.push((at, dof, factor)),
            }
        }
        if !all.is_empty() {
            deck.equations.push(Equation { terms: all, place });
        }
    }
}

/// Rigid regions and averages.
pub(super) fn couplings(reader: &mut Reader<'_>, deck: &mut Deck, index: &impl Fn(u64) -> Option<usize>) {
    for region in std::mem::take(&mut reader.model.regions) {
        let nodes: BTreeSet<usize> = region.nodes.iter().filter_map(|node| index(*node)).collect();
        let Some(reference) = index(region.reference).filter(|_| !nodes.is_empty()) else {
            let found =
                format!("node {}, or all that it is coupled to, which are not there", region.reference);
            reader.fault(region.place, found, "nodes of the file");
            continue;
        };
        let kind = if region.rigid { CouplingKind::Rigid } else { CouplingKind::Averaging };
        let name = format!("COUPLING_{}", deck.couplings.len() + 1);
        let nodes: Vec<usize> = nodes.into_iter().collect();
        deck.couplings.push(Coupling { name, reference, nodes, of: None, kind, place: region.place });
    }
}

/// Rotations of components that are there.
pub(super) fn motions(reader: &mut Reader<'_>, deck: &mut Deck) {
    for motion in std::mem::take(&mut reader.model.motions) {
        if deck.element_set(&motion.set).is_some() || deck.node_set(&motion.set).is_some() {
            deck.motions.push(motion);
        } else {
            let found = format!("a rotation of component `{}`, which is not there", motion.set);
            reader.fault(motion.place, found, "a component of the file");
        }
    }
}
