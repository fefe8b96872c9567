//! Surfaces of contact and sets: BSURF, BSURFS, BCPROP, BCPROPS, BCBODY, and SURF and SET of OptiStruct.

use super::elements::{Elements, Of};
use super::fields::Fields;
use super::list::{self, Ids};
use super::loads;
use super::model::Model;
use super::names::Named;
use crate::deck::{Place, Set, ShellFace, Surface};
use crate::ledger::Weight;
use crate::skin::outer_faces;
use std::collections::BTreeMap;

/// Surfaces by number: the card, and what they have.
type Parts = BTreeMap<u64, (&'static str, Vec<(Part, Place)>)>;

#[derive(Debug, Default)]
pub(super) struct Surfaces {
    /// Regions of contact.
    regions: Parts,
    /// Surfaces of OptiStruct.
    own: Parts,
    /// Bodies of contact: the number of their region.
    bodies: BTreeMap<u64, u64>,
    sets: BTreeMap<u64, (SetOf, Vec<Ids>, Place)>,
}

/// What a surface has.
#[derive(Debug)]
enum Part {
    /// Elements: shells, and the outer faces of solids.
    Elements(Vec<Ids>),
    /// All elements of properties.
    Properties(Vec<Ids>),
    /// A face of a solid by three of its corners.
    Face(u64, [u64; 3]),
    /// A face by two corners as PLOAD4 has them, or a shell, whose normal may be turned.
    Side(u64, [u64; 2], ShellFace),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SetOf {
    Points,
    Elements,
}

/// Names of what is found, by the numbers that cards of contact have.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub regions: BTreeMap<u64, String>,
    pub own: BTreeMap<u64, String>,
    pub bodies: BTreeMap<u64, String>,
}

impl Surfaces {
    pub fn card(&mut self, fields: &mut Fields) -> Option<()> {
        let number = fields.id(1)?;
        let (place, last) = (fields.place(), fields.last());
        let mut add = |name: &'static str, part: Part| {
            self.regions.entry(number).or_insert((name, Vec::new())).1.push((part, place));
        };
        match fields.name() {
            "BSURF" => add("BSURF", Part::Elements(list::read(fields, 2, last))),
            "BCPROP" => add("BCPROP", Part::Properties(list::read(fields, 2, last))),
            "BCPROPS" => add("BCPROPS", Part::Properties(list::read(fields, 2, last))),
            "BSURFS" => {
                for first in (5..=last).step_by(4) {
                    if (first..first + 4).all(|k| fields.is_blank(k)) {
                        continue;
                    }
                    let [element, a, b, c] = [0, 1, 2, 3].map(|k| fields.id(first + k));
                    add("BSURFS", Part::Face(element?, [a?, b?, c?]));
                }
            }
            "BCBODY" => {
                fields.unread(2, 3, Weight::Nothing, "the kind of the body is not read");
                if fields.words(3, 3).iter().any(|(_, text)| *text == "RIGID") {
                    fields.note(Weight::Matters, "rigid bodies without elements are not read");
                }
                let region = fields.id_or(4, 0)?;
                fields.unread(5, last, Weight::Perhaps, "its friction and its motion are not read");
                self.bodies.insert(number, region);
            }
            "SURF" => {
                if fields.word(2) != "ELFACE" {
                    fields.note(Weight::Matters, "surfaces by sets are not read");
                    return None;
                }
                let mut sides = Vec::new();
                for line in (8..last).step_by(8) {
                    if fields.is_blank(line + 1) {
                        continue;
                    }
                    let element = fields.id(line + 1)?;
                    let corners = [fields.id_or(line + 2, 0)?, fields.id_or(line + 3, 0)?];
                    let face = if fields.integer_or(line + 4, 0)? == 1 {
                        ShellFace::Negative
                    } else {
                        ShellFace::Positive
                    };
                    sides.push((Part::Side(element, corners, face), place));
                }
                self.own.entry(number).or_insert(("SURF", Vec::new())).1.extend(sides);
            }
            name => {
                let first = if name == "SET" { 9 } else { 3 };
                let of = match fields.word(2) {
                    "GRID" | "POINT" => SetOf::Points,
                    "ELEM" | "ELEMENT" => SetOf::Elements,
                    _ => {
                        fields.note(
                            Weight::Nothing,
                            "sets of other things than grid points and elements are not read",
                        );
                        return None;
                    }
                };
                if name == "SET" && !["LIST", ""].contains(&fields.word(3)) {
                    fields.note(Weight::Perhaps, "sets by formulas are not read");
                    return None;
                }
                let ids = list::read(fields, first, last);
                self.sets.entry(number).or_insert((of, Vec::new(), place)).1.extend(ids);
            }
        }
        Some(())
    }

    pub fn resolve(&self, elements: &Elements, model: &mut Model) -> Found {
        let mut found = Found::default();
        let mut of_property: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
        for (at, (of, _)) in elements.made_of.iter().enumerate() {
            if let (Of::Property(number), false) = (of, self.regions.is_empty()) {
                of_property.entry(*number).or_default().push(at);
            }
        }
        let regions = (&self.regions, &mut found.regions, true);
        for (numbers, names, named) in [regions, (&self.own, &mut found.own, false)] {
            for (number, (card, parts)) in numbers {
                let name = match named {
                    true => model.names.of(Named::Region, *number, card),
                    false => format!("{card}_{number}"),
                };
                let surface = surface(name.clone(), parts, card, &of_property, model);
                model.deck.surfaces.push(surface);
                names.insert(*number, name);
            }
        }
        for (body, region) in &self.bodies {
            if let Some(name) = found.regions.get(region) {
                found.bodies.insert(*body, name.clone());
            }
        }
        for (number, (of, ids, place)) in &self.sets {
            let name = model.names.of(Named::Set, *number, "SET");
            let (members, sets) = match of {
                SetOf::Points => (model.nodes(ids, "SET", *place), &mut model.deck.node_sets),
                SetOf::Elements => (model.elements(ids, "SET", *place), &mut model.deck.element_sets),
            };
            sets.push(Set { name, members, internal: false });
        }
        found
    }
}

fn surface(
    name: String,
    parts: &[(Part, Place)],
    card: &str,
    of_property: &BTreeMap<u64, Vec<usize>>,
    model: &mut Model,
) -> Surface {
    let mut surface = Surface { name, ..Surface::default() };
    let mut whole = Vec::new();
    for (part, place) in parts {
        match part {
            Part::Elements(ids) => whole.extend(model.elements(ids, card, *place)),
            Part::Properties(ids) => {
                for ids in ids {
                    let (first, last) = ids.bounds();
                    // A range from a number to a smaller one has none.
                    let of = of_property.range(first..=last.max(first));
                    for (_, members) in of.filter(|(number, _)| ids.spans(**number)) {
                        if model.notes.may_list(members.len(), *place) {
                            whole.extend(members);
                        }
                    }
                }
            }
            Part::Face(id, corners) => {
                let Some(element) = model.element(*id, card, *place) else { continue };
                match side_of_three(element, corners, model) {
                    Some(side) => surface.faces.push((element, side)),
                    None => no_face(card, *id, *place, model),
                }
            }
            Part::Side(id, corners, face) => {
                let Some(element) = model.element(*id, card, *place) else { continue };
                if model.deck.elements[element].kind.dimension() == 2 {
                    surface.shells.push((element, *face));
                } else {
                    match loads::side(element, *corners, model) {
                        Some(side) => surface.faces.push((element, side)),
                        None => no_face(card, *id, *place, model),
                    }
                }
            }
        }
    }
    whole.sort_unstable();
    whole.dedup();
    let dimension = |element: &usize| model.deck.elements[*element].kind.dimension();
    surface.shells.extend(whole.iter().filter(|e| dimension(e) == 2).map(|e| (*e, ShellFace::Positive)));
    whole.retain(|element| dimension(element) == 3);
    surface.faces.extend(outer_faces(&model.deck.elements, whole));
    surface.faces.sort_unstable();
    surface.faces.dedup();
    surface.shells.sort_unstable();
    surface.shells.dedup();
    surface
}

fn no_face(card: &str, element: u64, place: Place, model: &mut Model) {
    let found = format!("corners of {card} that are not of a face of element {element}");
    model.notes.files.fault(place, found, "corners of one face of a solid");
}

/// The side of a solid with three corners.
fn side_of_three(element: usize, corners: &[u64; 3], model: &Model) -> Option<usize> {
    let element = &model.deck.elements[element];
    let number = |node: &u8| model.deck.nodes[element.nodes[usize::from(*node)]].number;
    let mut sides = element.kind.table().sides.iter();
    if element.kind.dimension() != 3 {
        return None;
    }
    sides.position(|(kind, nodes)| {
        corners.iter().all(|corner| nodes[..kind.n_corners()].iter().any(|node| number(node) == *corner))
    })
}
