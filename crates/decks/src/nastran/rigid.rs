//! Rigid elements and averages: RBE2, RBAR, RBAR1, RBE3.

use super::fields::{Fields, integer};
use super::list::{self, Ids};
use super::model::Model;
use super::table::Table;
use crate::deck::{Coupling, CouplingKind, Place};
use crate::ledger::Weight;
use stridor_mesh::quality::{cross, minus};

/// An element as its card has it.
#[derive(Debug, Clone, PartialEq)]
struct Raw {
    card: &'static str,
    reference: u64,
    points: Vec<Ids>,
    kind: CouplingKind,
    /// The degrees of freedom of the points that follow.
    follow: [bool; 6],
}

#[derive(Debug, Default)]
pub(super) struct Rigid {
    table: Table<Raw>,
}

const ALL: [bool; 6] = [true; 6];

impl Rigid {
    pub fn card(&mut self, fields: &mut Fields) -> Option<()> {
        let number = fields.id(1)?;
        let raw = match fields.name() {
            "RBE2" => {
                let reference = fields.id(2)?;
                let follow = fields.components(3)?;
                // Heat expansion and a reference temperature may be the last.
                let mut last = fields.last();
                while last > 4
                    && fields
                        .words(last, last)
                        .iter()
                        .any(|(_, text)| integer(text).is_none() && text.contains('.'))
                {
                    last -= 1;
                }
                Raw {
                    card: "RBE2",
                    reference,
                    points: list::read(fields, 4, last),
                    kind: CouplingKind::Rigid,
                    follow,
                }
            }
            "RBE3" => average(fields)?,
            "RBAR1" => {
                let (reference, point) = (fields.id(2)?, fields.id(3)?);
                let follow = if fields.is_blank(4) { ALL } else { fields.components(4)? };
                fields.unread(5, 6, Weight::Nothing, "heat expansion is not read");
                Raw {
                    card: "RBAR1",
                    reference,
                    points: vec![Ids::One(point)],
                    kind: CouplingKind::Rigid,
                    follow,
                }
            }
            _ => bar(fields)?,
        };
        self.table.push(number, fields.place(), raw);
        Some(())
    }

    pub fn resolve(mut self, model: &mut Model) {
        self.table.sort("rigid element", model.notes);
        for row in self.table.rows() {
            let Raw { card, reference, points, kind, follow } = &row.value;
            let Some(reference) = model.node(*reference, card, row.place) else { continue };
            let mut nodes = model.nodes(points, card, row.place);
            nodes.retain(|node| *node != reference);
            let (mut whole, partly): (Vec<usize>, Vec<usize>) = (nodes.iter().copied()).partition(|node| {
                let turns = model.rotates.get(*node).is_some_and(|rotates| *rotates);
                let n = if turns { 6 } else { 3 };
                *kind == CouplingKind::Averaging || follow[..n].iter().all(|one| *one)
            });
            if !whole.is_empty() {
                whole.sort_unstable();
                let name = format!("{card}_{}", row.number);
                let coupling =
                    Coupling { name, reference, nodes: whole, of: None, kind: *kind, place: row.place };
                model.deck.couplings.push(coupling);
            }
            for node in partly {
                follow_partly(node, reference, *follow, row.place, model);
            }
        }
    }
}

/// RBAR: one end has all degrees of freedom that others follow.
fn bar(fields: &mut Fields) -> Option<Raw> {
    let (a, b) = (fields.id(2)?, fields.id(3)?);
    let mut of = |k: usize| if fields.is_blank(k) { Some([false; 6]) } else { fields.components(k) };
    let (lead_a, lead_b, follow_a, follow_b) = (of(4)?, of(5)?, of(6)?, of(7)?);
    fields.unread(8, 9, Weight::Nothing, "heat expansion is not read");
    let or_all = |follow: [bool; 6]| if follow.contains(&true) { follow } else { ALL };
    let (reference, point, follow) = match () {
        _ if lead_b == ALL => (b, a, or_all(follow_a)),
        _ => {
            if lead_a != ALL && lead_a.contains(&true) || lead_b.contains(&true) {
                fields.note(Weight::Matters, "degrees of freedom that lead, of both ends or fewer than six, are not read: all of the first end lead");
            }
            (a, b, or_all(follow_b))
        }
    };
    Some(Raw { card: "RBAR", reference, points: vec![Ids::One(point)], kind: CouplingKind::Rigid, follow })
}

/// RBE3: groups of a weight, degrees of freedom and points.
fn average(fields: &mut Fields) -> Option<Raw> {
    let reference = fields.id(3)?;
    let follow = fields.components(4)?;
    if follow[..3] != [true; 3] {
        fields.note(Weight::Matters, "an average of some displacements is read as that of all");
    }
    let last = fields.last();
    let words = fields.words(5, last);
    let end =
        words.iter().find(|(_, text)| ["UM", "ALPHA", "TREF"].contains(text)).map_or(last, |(at, _)| at - 1);
    if words.iter().any(|(_, text)| *text == "UM") {
        fields.note(Weight::Matters, "other degrees of freedom that follow (UM) are not read");
    }
    let starts: Vec<usize> = words
        .iter()
        .filter(|(at, text)| *at <= end && integer(text).is_none() && text.contains('.'))
        .map(|(at, _)| *at)
        .collect();
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    for (k, start) in starts.iter().enumerate() {
        weights.push(fields.real(*start)?);
        let stop = starts.get(k + 1).map_or(end, |next| next - 1);
        // Blank fields may stand between.
        let after = words.partition_point(|(at, _)| at <= start);
        let Some((component, _)) = words.get(after).filter(|(at, _)| *at <= stop) else { continue };
        let own = fields.components(*component)?;
        if own[..3] != [true; 3] || own[3..].contains(&true) {
            fields.note(
                Weight::Perhaps,
                "an average over other degrees of freedom than 123 of its nodes is read as one over these",
            );
        }
        points.extend(list::read(fields, component + 1, stop));
    }
    if weights.windows(2).any(|pair| pair[0] != pair[1]) {
        fields.note(Weight::Perhaps, "weights that differ are not read: all nodes weigh alike");
    }
    if points.is_empty() {
        fields.fault(
            5,
            "RBE3 without nodes that it averages",
            "a weight, degrees of freedom and grid points",
        );
        return None;
    }
    Some(Raw { card: "RBE3", reference, points, kind: CouplingKind::Averaging, follow })
}

/// Some degrees of freedom of a node, in the directions e of its displacements, follow a rigid body:
/// e·u = e·(u₀ + θ₀ × r), e·θ = e·θ₀, with r from the reference to the node, and e·(θ₀ × r) = θ₀·(r × e).
fn follow_partly(node: usize, reference: usize, follow: [bool; 6], place: Place, model: &mut Model) {
    let r = minus(model.position(node), model.position(reference));
    let directions = model.directions(node);
    let turns = model.rotates.get(node).is_some_and(|rotates| *rotates);
    for component in (0..if turns { 6 } else { 3 }).filter(|k| follow[*k]) {
        let e = directions[component % 3];
        let first = component / 3 * 3;
        let mut terms: Vec<(usize, u8, f64)> = Vec::new();
        terms.extend((0..3).map(|k| (node, (first + k) as u8, e[k])));
        terms.extend((0..3).map(|k| (reference, (first + k) as u8, -e[k])));
        if component < 3 {
            let moment = cross(r, e);
            terms.extend((0..3).map(|k| (reference, 3 + k as u8, -moment[k])));
        }
        terms.retain(|(.., factor)| *factor != 0.0);
        model.equation(terms, place);
    }
}
