//! Loads: FORCE, PLOAD4, LOAD, and the rotation of RFORCE.

use super::constraints::taken;
use super::control::Choice;
use super::fields::Fields;
use super::list::{self, Ids};
use super::model::Model;
use crate::deck::{Load, LoadOn, Motion, Place, Set};
use crate::ledger::Weight;
use std::collections::BTreeMap;

#[derive(Debug, Default)]
pub(super) struct Loads {
    sets: BTreeMap<u64, Vec<(Raw, Place)>>,
    /// Sums of sets with factors: LOAD.
    sums: BTreeMap<u64, (Vec<(f64, u64)>, Place)>,
}

/// A load as its card has it.
#[derive(Debug)]
enum Raw {
    Force { point: u64, system: u64, force: [f64; 3] },
    Pressure { elements: Vec<Ids>, pressure: f64, corners: [u64; 2] },
    Rotation { point: u64, system: u64, axis: [f64; 3], turns: f64 },
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
        for number in taken(Choice::Load, "LOAD", &self.sets, &sums, model) {
            // A set that is chosen by itself stands with the factor 1; one may stand in a sum several times.
            let in_sum = factors.get(&number).copied().unwrap_or(0.0);
            let own = if chosen.is_none() || chosen == Some(number) { 1.0 } else { 0.0 };
            for (raw, place) in self.sets.get(&number).into_iter().flatten() {
                load(raw, own + in_sum, number, *place, model);
            }
        }
    }
}

/// PLOAD4: pressures at the corners of a face, which corners of a solid tell; of a range of elements where THRU stands.
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
    Some(Raw::Pressure { elements: vec![elements], pressure: p, corners })
}

fn load(raw: &Raw, factor: f64, set: u64, place: Place, model: &mut Model) {
    let name = format!("LOAD_{set}");
    match raw {
        Raw::Force { point, system, force } => {
            let Some(node) = model.node(*point, "FORCE", place) else { return };
            let Some(axes) = model.frames.get(*system, place, model.notes) else { return };
            let force = axes.vector(force.map(|x| factor * x), model.position(node));
            model.deck.loads.push(Load { name, on: LoadOn::Nodes { nodes: vec![node], force }, place });
        }
        Raw::Rotation { point, system, axis, turns } => {
            let Some(axes) = model.frames.get(*system, place, model.notes) else { return };
            let at = if *point == 0 {
                Some([0.0; 3])
            } else {
                model.node(*point, "RFORCE", place).map(|n| model.position(n))
            };
            let Some(at) = at else { return };
            let axis = axes.vector(*axis, at);
            let length = stridor_mesh::quality::norm(axis);
            if length == 0.0 {
                model.notes.files.fault(
                    place,
                    "RFORCE about an axis of no length",
                    "a direction that is not zero",
                );
                return;
            }
            // A R revolutions a unit of time.
            let speed = std::f64::consts::TAU * turns * factor * length;
            let set = format!("RFORCE_{set}");
            if model.deck.element_set(&set).is_none() {
                let members = (0..model.deck.elements.len()).collect();
                model.deck.element_sets.push(Set { name: set.clone(), members, internal: true });
            }
            let axis = axis.map(|x| x / length);
            model.deck.motions.push(Motion { set, point: at, axis, speed, place });
        }
        Raw::Pressure { elements, pressure, corners } => {
            let mut faces = Vec::new();
            for element in model.elements(elements, "PLOAD4", place) {
                if model.deck.elements[element].kind.dimension() != 3 {
                    let why = "pressures on shells are not read";
                    model.notes.ledger.note(Weight::Perhaps, "PLOAD4", why, place);
                    continue;
                }
                match side(element, *corners, model) {
                    Some(side) => faces.push((element, side)),
                    None => {
                        let number = model.deck.elements[element].number;
                        let found = format!(
                            "PLOAD4 with corners {} and {} of element {number}",
                            corners[0], corners[1]
                        );
                        model.notes.files.fault(
                            place,
                            found,
                            "a corner of a face and the one across from it",
                        );
                    }
                }
            }
            if !faces.is_empty() {
                let pressure = factor * pressure;
                model.deck.loads.push(Load { name, on: LoadOn::Faces { faces, pressure }, place });
            }
        }
    }
}

/// The side of a solid that two grid points tell: a corner of the face, and the one across from it, or that of a tetrahedron which is not
/// on it.
pub(super) fn side(element: usize, [first, second]: [u64; 2], model: &Model) -> Option<usize> {
    let element = &model.deck.elements[element];
    let corners = &element.nodes[..element.kind.n_corners()];
    let corner =
        |id: u64| corners.iter().position(|node| model.deck.nodes[*node].number == id).map(|at| at as u8);
    let second = if second == 0 { None } else { Some(corner(second)?) };
    element.kind.side_of_corners(corner(first)?, second)
}
