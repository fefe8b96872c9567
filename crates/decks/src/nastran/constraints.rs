//! Supports and equations: SPC, SPC1, SPCADD, the permanent ones of GRID, MPC, MPCADD.
//!
//! Degrees of freedom are those of the system of the displacements of their node.

use super::control::Choice;
use super::fields::Fields;
use super::list::{self, Ids};
use super::model::Model;
use crate::deck::{Frame, Place, Set, Support};
use crate::ledger::Weight;
use std::collections::{BTreeMap, BTreeSet};

#[derive(Debug, Default)]
pub(super) struct Constraints {
    supports: BTreeMap<u64, Vec<Held>>,
    /// Sets that are sums of others: SPCADD.
    support_sums: Sums,
    equations: BTreeMap<u64, Vec<Terms>>,
    equation_sums: Sums,
}

#[derive(Debug)]
struct Held {
    points: Vec<Ids>,
    held: [bool; 6],
    place: Place,
}

#[derive(Debug)]
struct Terms {
    terms: Vec<(u64, usize, f64)>,
    place: Place,
}

/// Sets by number that are sums of others.
pub(super) type Sums = BTreeMap<u64, (Vec<u64>, Place)>;

/// Reads SPCADD, MPCADD and the like.
pub(super) fn sum(fields: &mut Fields, sums: &mut Sums) -> Option<()> {
    let number = fields.id(1)?;
    let last = fields.last();
    let mut of = Vec::new();
    for (at, _) in fields.words(2, last) {
        of.push(fields.id(at)?);
    }
    sums.entry(number).or_insert((Vec::new(), fields.place())).0.extend(of);
    Some(())
}

/// The sets that are taken: the one that the case control chooses, with those that it is a sum of; all where it chooses none.
pub(super) fn taken<T>(
    choice: Choice,
    what: &str,
    sets: &BTreeMap<u64, T>,
    sums: &Sums,
    model: &mut Model,
) -> BTreeSet<u64> {
    let Some(chosen) = model.control.chosen(choice, model.notes) else {
        if !sets.is_empty() {
            let why = "no set is chosen by the case control: all are taken";
            let weight = if sets.len() > 1 { Weight::Matters } else { Weight::Nothing };
            model.notes.ledger.note(weight, what, why, Place { file: 0, line: 0 });
        }
        return sets.keys().copied().collect();
    };
    let mut taken = BTreeSet::new();
    let mut open = vec![(chosen, Place { file: 0, line: 0 })];
    let mut seen = BTreeSet::new();
    while let Some((number, place)) = open.pop() {
        if !seen.insert(number) {
            continue;
        }
        let sum = sums.get(&number);
        if let Some((of, place)) = sum {
            open.extend(of.iter().map(|number| (*number, *place)));
        }
        if sets.contains_key(&number) {
            taken.insert(number);
        } else if sum.is_none() {
            // A set may be of cards that are not read, or that other cards of the same command make up.
            let why = format!("set {number} that is chosen has no cards that are read");
            model.notes.ledger.note(Weight::Matters, what, why, place);
        }
    }
    let left = sets.keys().any(|number| !taken.contains(number));
    if left {
        let why = "sets that are not chosen are not read";
        model.notes.ledger.note(Weight::Nothing, what, why, Place { file: 0, line: 0 });
    }
    taken
}

impl Constraints {
    pub fn card(&mut self, fields: &mut Fields) -> Option<()> {
        match fields.name() {
            "SPC" => {
                let set = fields.id(1)?;
                if fields.word(9) == "GSET" {
                    fields.note(Weight::Matters, "supports of sets of grid points are not read");
                    return None;
                }
                for first in [2, 5] {
                    if fields.is_blank(first) {
                        continue;
                    }
                    let point = fields.id(first)?;
                    let held =
                        if fields.is_blank(first + 1) { [false; 6] } else { fields.components(first + 1)? };
                    let place = fields.place();
                    self.supports.entry(set).or_default().push(Held {
                        points: vec![Ids::One(point)],
                        held,
                        place,
                    });
                    fields.unread(
                        first + 2,
                        first + 2,
                        Weight::Perhaps,
                        "motions of supports are not read: they are held",
                    );
                }
                Some(())
            }
            "SPC1" => {
                let (set, held) = (fields.id(1)?, fields.components(2)?);
                let last = fields.last();
                let points = list::read(fields, 3, last);
                let place = fields.place();
                self.supports.entry(set).or_default().push(Held { points, held, place });
                Some(())
            }
            "MPC" => self.equation(fields),
            "SPCADD" => sum(fields, &mut self.support_sums),
            _ => sum(fields, &mut self.equation_sums),
        }
    }

    /// Three fields a term, two terms a line.
    fn equation(&mut self, fields: &mut Fields) -> Option<()> {
        let set = fields.id(1)?;
        let mut terms = Vec::new();
        for line in (0..=fields.last()).step_by(8) {
            for first in [line + 2, line + 5] {
                if (first..first + 3).all(|k| fields.is_blank(k)) {
                    continue;
                }
                let (point, component) = (fields.id(first)?, fields.integer_or(first + 1, 0)?);
                let factor = fields.real(first + 2)?;
                if !(0..=6).contains(&component) {
                    fields.fault(first + 1, format!("degree of freedom {component} of MPC"), "one of 1 to 6");
                    return None;
                }
                terms.push((point, component.max(1) as usize - 1, factor));
            }
        }
        if terms.first().is_none_or(|(.., factor)| *factor == 0.0) {
            fields.fault(
                4,
                "MPC whose first term is none",
                "a factor that is not zero: the first degree of freedom follows the others",
            );
            return None;
        }
        let place = fields.place();
        self.equations.entry(set).or_default().push(Terms { terms, place });
        Some(())
    }

    pub fn resolve(&self, model: &mut Model) {
        let permanent: Vec<_> = (0..model.grids.table.rows().len())
            .map(|node| (node, model.grids.held(node), model.deck.nodes[node].place))
            .filter(|(_, held, _)| held.contains(&true))
            .collect();
        support(None, permanent, model);
        for number in taken(Choice::Spc, "SPC", &self.supports, &self.support_sums, model) {
            let mut held = Vec::new();
            for card in self.supports.get(&number).into_iter().flatten() {
                let nodes = model.nodes(&card.points, "SPC", card.place);
                held.extend(nodes.into_iter().map(|node| (node, card.held, card.place)));
            }
            support(Some(format!("SPC_{number}")), held, model);
        }
        for number in taken(Choice::Mpc, "MPC", &self.equations, &self.equation_sums, model) {
            for card in self.equations.get(&number).into_iter().flatten() {
                let mut terms = Vec::new();
                let mut whole = true;
                for (id, component, factor) in &card.terms {
                    match model.node(*id, "MPC", card.place) {
                        Some(node) => terms.extend(model.terms(node, *component, *factor)),
                        None => whole = false,
                    }
                }
                if whole {
                    model.equation(terms, card.place);
                }
            }
        }
    }
}

/// Adds supports: nodes with the same degrees of freedom in the same frame are one.
fn support(name: Option<String>, mut held: Vec<(usize, [bool; 6], Place)>, model: &mut Model) {
    held.sort_by_key(|(node, _, place)| (*node, *place));
    held.dedup_by(|next, first| {
        let same = next.0 == first.0;
        if same {
            (0..6).for_each(|k| first.1[k] |= next.1[k]);
        }
        same
    });
    let mut groups: BTreeMap<([bool; 6], Vec<u64>), Support> = BTreeMap::new();
    for (node, held, place) in held.iter().filter(|(_, held, _)| held.contains(&true)) {
        let frame = model.displacements(*node).frame(model.position(*node));
        // A frame whose directions are all held is as good as any other.
        let whole = held.chunks(3).all(|of| of.iter().all(|one| *one == of[0]));
        let frame = if whole { Frame::Global } else { frame };
        let bits = |v: &[[f64; 3]]| v.iter().flatten().map(|x| x.to_bits()).collect();
        let key = match &frame {
            Frame::Global => Vec::new(),
            Frame::Turned(unit) => bits(unit),
            Frame::Cylindrical(axis) => bits(axis),
        };
        let new = || Support {
            title: String::new(),
            name: name.clone(),
            nodes: Vec::new(),
            held: *held,
            frame,
            place: *place,
        };
        groups.entry((*held, key)).or_insert_with(new).nodes.push(*node);
    }
    model.deck.supports.extend(groups.into_values());
    if let Some(name) = name.filter(|_| !held.is_empty()) {
        let members = held.iter().map(|(node, ..)| *node).collect();
        model.deck.node_sets.push(Set { name, members, internal: false });
    }
}
