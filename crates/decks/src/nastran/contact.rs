//! Contact and glue: BCTSET, BCTADD, BGSET, BGADD of Simcenter, BCTABLE of MSC, CONTACT, TIE and PCONT of OptiStruct.

use super::constraints::{Sums, sum, taken};
use super::control::Choice;
use super::fields::{Fields, integer, real};
use super::model::Model;
use super::surfaces::Found;
use crate::deck::{Contact, Place, Tie};
use crate::ledger::Weight;
use std::collections::BTreeMap;

#[derive(Debug, Default)]
pub(super) struct Contacts {
    contacts: BTreeMap<u64, Vec<Pair>>,
    contact_sums: Sums,
    glues: BTreeMap<u64, Vec<Pair>>,
    glue_sums: Sums,
    /// Pairs of OptiStruct, which no set chooses.
    always: Vec<Pair>,
    /// Friction of PCONT.
    friction: BTreeMap<u64, f64>,
}

#[derive(Debug, Clone)]
struct Pair {
    card: &'static str,
    number: u64,
    slave: u64,
    master: u64,
    friction: Friction,
    /// Glued together.
    glued: bool,
    /// The largest gap that is closed.
    within: Option<f64>,
    place: Place,
}

#[derive(Debug, Clone, Copy)]
enum Friction {
    Is(f64),
    Property(u64),
}

impl Contacts {
    pub fn card(&mut self, fields: &mut Fields) -> Option<()> {
        match fields.name() {
            "BCTADD" => return sum(fields, &mut self.contact_sums),
            "BGADD" => return sum(fields, &mut self.glue_sums),
            "PCONT" => {
                let number = fields.id(1)?;
                fields.unread(2, 3, Weight::Perhaps, "gaps and stiffness of contact are not read");
                let friction = fields.real_or(4, 0.0)?;
                let last = fields.last();
                fields.unread(5, last, Weight::Perhaps, "gaps and stiffness of contact are not read");
                self.friction.insert(number, friction);
                return Some(());
            }
            _ => {}
        }
        let (number, place, last) = (fields.id(1)?, fields.place(), fields.last());
        match fields.name() {
            "BCTSET" => {
                for line in (0..last).step_by(8) {
                    if fields.is_blank(line + 2) && fields.is_blank(line + 3) {
                        continue;
                    }
                    let (slave, master) = (fields.id(line + 2)?, fields.id(line + 3)?);
                    let friction = Friction::Is(fields.real_or(line + 4, 0.0)?);
                    fields.unread(
                        line + 5,
                        line + 6,
                        Weight::Nothing,
                        "the range of gaps that are looked for is not read",
                    );
                    let pair = Pair {
                        card: "BCTSET",
                        number,
                        slave,
                        master,
                        friction,
                        glued: false,
                        within: None,
                        place,
                    };
                    self.contacts.entry(number).or_default().push(pair);
                }
            }
            "BGSET" => {
                for line in (0..last).step_by(8) {
                    if fields.is_blank(line + 2) && fields.is_blank(line + 3) {
                        continue;
                    }
                    let (slave, master) = (fields.id(line + 2)?, fields.id(line + 3)?);
                    let within = fields.real_if(line + 4)?;
                    fields.unread(
                        line + 5,
                        line + 8,
                        Weight::Nothing,
                        "how far beyond edges glue reaches is not read",
                    );
                    let friction = Friction::Is(0.0);
                    let pair =
                        Pair { card: "BGSET", number, slave, master, friction, glued: true, within, place };
                    self.glues.entry(number).or_default().push(pair);
                }
            }
            "BCTABLE" => self.table(fields, number)?,
            name => {
                let (slave, master) = (fields.id(3)?, fields.id(4)?);
                let text = fields.word(2);
                let glued = name == "TIE" || text == "FREEZE";
                let friction = match (integer(text), real(text)) {
                    (Some(property), _) if property > 0 => Friction::Property(property.unsigned_abs()),
                    (None, Some(mu)) => Friction::Is(mu),
                    _ => {
                        if text == "STICK" {
                            fields.note(
                                Weight::Matters,
                                "contact that does not slide is read as one without friction",
                            );
                        }
                        Friction::Is(0.0)
                    }
                };
                fields.unread(
                    5,
                    last,
                    Weight::Perhaps,
                    "gaps, directions and adjustments of contact are not read",
                );
                let card = if name == "TIE" { "TIE" } else { "CONTACT" };
                self.always.push(Pair { card, number, slave, master, friction, glued, within: None, place });
            }
        }
        Some(())
    }

    /// BCTABLE: lines of SLAVE, a body, its numbers, and lines of MASTERS with bodies.
    fn table(&mut self, fields: &mut Fields, number: u64) -> Option<()> {
        let last = fields.last();
        fields.unread(2, 8, Weight::Nothing, "the count of pairs is not read");
        let mut slave: Option<(u64, f64, bool)> = None;
        let mut masters = false;
        for line in (8..last).step_by(8) {
            let word = fields.word(line + 1);
            match word {
                "SLAVE" => {
                    masters = false;
                    let body = fields.id(line + 2)?;
                    fields.unread(line + 3, line + 4, Weight::Nothing, "tolerances of contact are not read");
                    let friction = fields.real_or(line + 5, 0.0)?;
                    fields.unread(line + 6, line + 6, Weight::Perhaps, "interference is not read");
                    let glued = fields.integer_or(line + 7, 0)? > 0;
                    slave = Some((body, friction, glued));
                    continue;
                }
                "MASTERS" => masters = true,
                _ if !masters => {
                    fields.unread(
                        line + 1,
                        line + 8,
                        Weight::Perhaps,
                        "tolerances and options of contact are not read",
                    );
                    continue;
                }
                _ => {}
            }
            let Some((body, friction, glued)) = slave else { continue };
            let first = if word == "MASTERS" { line + 2 } else { line + 1 };
            for (at, _) in fields.words(first, line + 8) {
                let (master, place) = (fields.id(at)?, fields.place());
                let friction = Friction::Is(friction);
                let pair = Pair {
                    card: "BCTABLE",
                    number,
                    slave: body,
                    master,
                    friction,
                    glued,
                    within: None,
                    place,
                };
                self.contacts.entry(number).or_default().push(pair);
            }
        }
        Some(())
    }

    pub fn resolve(&self, found: &Found, model: &mut Model) {
        let contacts = taken(Choice::Contact, "contact", &self.contacts, &self.contact_sums, model);
        let glues = taken(Choice::Glue, "glue", &self.glues, &self.glue_sums, model);
        let of =
            |sets: &BTreeMap<u64, Vec<Pair>>, number: &u64| sets.get(number).cloned().unwrap_or_default();
        let chosen = contacts.iter().flat_map(|number| of(&self.contacts, number));
        let glued = glues.iter().flat_map(|number| of(&self.glues, number));
        let pairs: Vec<Pair> = chosen.chain(glued).chain(self.always.iter().cloned()).collect();
        let mut counts: BTreeMap<(&str, u64), usize> = BTreeMap::new();
        for pair in &pairs {
            let names = match pair.card {
                "BCTABLE" => &found.bodies,
                "CONTACT" | "TIE" => &found.own,
                _ => &found.regions,
            };
            let [slave, master] = [pair.slave, pair.master].map(|number| {
                let name = names.get(&number).cloned();
                if name.is_none() {
                    let found =
                        format!("surface {number} of {}, which is not there or is not read", pair.card);
                    model.notes.ledger.note(Weight::Matters, pair.card, found, pair.place);
                }
                name
            });
            let (Some(slave), Some(master)) = (slave, master) else { continue };
            let count = counts.entry((pair.card, pair.number)).or_default();
            *count += 1;
            let name = match count {
                1 => format!("{}_{}", pair.card, pair.number),
                _ => format!("{}_{}_{count}", pair.card, pair.number),
            };
            let place = pair.place;
            if pair.glued {
                model.deck.ties.push(Tie { name, slave, master, within: pair.within, place });
                continue;
            }
            let friction = match pair.friction {
                Friction::Is(mu) => mu,
                Friction::Property(number) => self.friction.get(&number).copied().unwrap_or(0.0),
            };
            let (stiffness, stick, closed) = (None, None, false);
            model.deck.contacts.push(Contact {
                name: String::new(),
                slave,
                master,
                friction,
                stiffness,
                stick,
                closed,
                place,
            });
        }
    }
}
