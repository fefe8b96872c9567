//! Sections: elements of one property, under the name of that.

use super::elements::{Elements, Of};
use super::materials::{Heavier, Materials};
use super::model::Model;
use super::names::Named;
use super::properties::{Class, Properties, Property};
use super::unread::Unread;
use crate::deck::{Place, Section, SectionShape, Set};
use crate::ledger::Weight;
use std::collections::{BTreeMap, BTreeSet};
use stridor_mesh::CellKind;

/// What elements of one section have in common: what they are made of, and of beams the direction of their plane of bending.
type Key = (Class, u64, Option<(u64, u64)>, Option<[i64; 3]>);

/// Puts sections and sets of their elements into the deck; materials that they need beside those of the cards are the result.
pub(super) fn resolve(
    elements: &Elements,
    properties: &Properties,
    materials: &Materials,
    unread: &Unread,
    model: &mut Model,
) -> Vec<Heavier> {
    let mut heavier = Vec::new();
    let mut of: BTreeMap<Key, Vec<usize>> = BTreeMap::new();
    for (at, (made_of, direction)) in elements.made_of.iter().enumerate() {
        let name = type_name(model, at);
        let class = class(model.deck.elements[at].kind, name);
        // Directions that differ by round-off are one.
        let direction = direction.map(|v| {
            let length = stridor_mesh::quality::norm(v);
            v.map(|x| if length > 0.0 { (1e6 * x / length).round() as i64 } else { 0 })
        });
        let key = match made_of {
            Of::Property(number) => (class, *number, None, direction),
            Of::Rod(material, area) => (class, 0, Some((*material, area.to_bits())), None),
        };
        of.entry(key).or_default().push(at);
    }
    let mut names = BTreeMap::new();
    let mut missing = BTreeSet::new();
    for (key, members) in of {
        let (class, number, rod, _) = key;
        let first = members[0];
        let place = model.deck.elements[first].place;
        let (property, name) = match rod {
            Some((material, area)) => {
                let shape = SectionShape::Truss { area: f64::from_bits(area) };
                let number = model.deck.elements[first].number;
                (
                    Property { card: "CONROD".into(), material, carried: 0.0, shape, system: 0 },
                    format!("CONROD_{number}"),
                )
            }
            None => match properties.get(class, number) {
                Some(property) => (property.clone(), model.names.of(Named::Property, number, &property.card)),
                None => {
                    let what = type_name(model, first).to_string();
                    if !properties.has(class) {
                        let why =
                            "no property has what these elements are made of: they are faces and lines only";
                        model.notes.ledger.note(Weight::Matters, what, why, place);
                    } else if !unread.properties.contains(&number) && missing.insert((class, number)) {
                        let found = format!("{what} of property {number}, which is not there");
                        model.notes.files.fault(
                            place,
                            found,
                            "the number of a property card for such elements",
                        );
                    }
                    let name = free_name(format!("PROPERTY_{number}"), &mut names);
                    model.deck.element_sets.push(Set { name, members, internal: false });
                    continue;
                }
            },
        };
        let name = free_name(name, &mut names);
        model.deck.element_sets.push(Set { name: name.clone(), members: members.clone(), internal: false });
        let Some(mut material) = materials.name(property.material, model.names) else {
            if !unread.materials.contains(&property.material) {
                let found = format!("material {} of {name}, which is not there", property.material);
                model.notes.files.fault(place, found, "the number of a material card");
            }
            continue;
        };
        let mut shape = property.shape.clone();
        if let SectionShape::Beam { first_axis, .. } = &mut shape {
            *first_axis = elements.made_of[first].1;
        }
        let size = match &shape {
            SectionShape::Shell { thickness } => *thickness,
            SectionShape::Truss { area } => *area,
            SectionShape::Beam { profile, .. } => profile.area(),
            SectionShape::Solid | SectionShape::Unstated => 0.0,
        };
        if property.carried != 0.0 && size > 0.0 {
            let why = "mass that stiffens nothing is read as a higher density of the material";
            model.notes.ledger.note(Weight::Nothing, property.card.as_str(), why, place);
            material = format!("{material} of {name}");
            let density = property.carried / size;
            heavier.push(Heavier { name: material.clone(), number: property.material, density });
        }
        let turned = materials.is_isotropic(property.material);
        let axes = if turned { None } else { axes(&property, place, model) };
        model.deck.sections.push(Section { name, elements: members, material, axes, shape, place });
    }
    heavier
}

fn type_name<'m>(model: &'m Model, element: usize) -> &'m str {
    &model.deck.type_names[model.deck.elements[element].type_name as usize]
}

fn class(kind: CellKind, name: &str) -> Class {
    match kind.dimension() {
        3 => Class::Solid,
        2 => Class::Shell,
        _ if name == "CBAR" || name == "CBEAM" => Class::Beam,
        _ => Class::Rod,
    }
}

/// A name that no other has, in any case of its letters: of several with one name the others are counted.
fn free_name(name: String, names: &mut BTreeMap<String, usize>) -> String {
    let mut count = names.get(&name.to_uppercase()).copied().unwrap_or(0);
    let mut free = name.clone();
    while names.contains_key(&free.to_uppercase()) {
        count += 1;
        free = format!("{name}_{count}");
    }
    names.insert(free.to_uppercase(), 1);
    names.insert(name.to_uppercase(), count.max(1));
    free
}

/// Directions 1 and 2 of the material of a solid.
fn axes(property: &Property, place: Place, model: &mut Model) -> Option<[[f64; 3]; 2]> {
    if property.card != "PSOLID" {
        let why = "directions of materials of shells are not read";
        model.notes.ledger.note(Weight::Matters, property.card.as_str(), why, place);
        return None;
    }
    let system = u64::try_from(property.system).ok();
    let axes = system.and_then(|number| model.frames.get(number, place, model.notes));
    match axes.and_then(|axes| axes.fixed()) {
        Some([e1, e2, _]) => Some([e1, e2]),
        None => {
            let why = "directions of the material that follow the elements, or a cylinder or a sphere, are not read: those of the coordinates hold";
            model.notes.ledger.note(Weight::Matters, "PSOLID", why, place);
            None
        }
    }
}
