//! *CONTACT PAIR, *SURFACE INTERACTION and what belongs to it.

use super::{Found, Reader, Row};
use crate::deck::{Contact, Place, Tie};
use crate::ledger::Weight;

/// A law of contact.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Interaction {
    friction: f64,
    stick: Option<f64>,
    stiffness: Option<f64>,
    tied: bool,
}

/// A pair whose law may stand below it.
#[derive(Debug)]
pub(super) struct PendingContact {
    slave: String,
    master: String,
    interaction: String,
    tied: bool,
    closed: bool,
    within: Option<f64>,
    place: Place,
}

impl Reader {
    /// *SURFACE INTERACTION: what follows is of it.
    pub fn interaction(&mut self, _: usize, found: Found<'_>) {
        let name = found.option("NAME").unwrap_or_default();
        self.interactions.entry(name, Interaction::default);
    }

    fn open_interaction(&mut self, found: Found<'_>) -> Option<&mut Interaction> {
        if self.interactions.all.is_empty() {
            let what = format!("*{}", found.block.keyword);
            self.deck.ledger.note(
                Weight::Perhaps,
                what,
                "no *SURFACE INTERACTION stands above",
                found.place(),
            );
        }
        self.interactions.all.last_mut()
    }

    /// *FRICTION and *CHANGE FRICTION's: μ; of CalculiX also the stick slope.
    pub fn friction(&mut self, _: usize, found: Found<'_>) {
        let Some(row) = found.rows().next() else {
            if !found.block.has("ROUGH") && !found.block.has("NONE") {
                self.files.fault(found.place(), "*FRICTION without data", "a line with μ");
            }
            return;
        };
        let Some([friction, stick]) = self.numbers::<2>(&row, 0) else { return };
        if found.block.n_lines() > 1 {
            let why = "the first line of a table over slip rate, pressure or temperature is read";
            self.deck.ledger.note(Weight::Matters, "*FRICTION", why, found.place());
        }
        if let Some(interaction) = self.open_interaction(found) {
            interaction.friction = friction;
            interaction.stick = (stick > 0.0).then_some(stick);
        }
    }

    /// *SURFACE BEHAVIOR: PRESSURE-OVERCLOSURE=LINEAR with its slope; HARD, TIED.
    pub fn behaviour(&mut self, _: usize, found: Found<'_>) {
        let law = found.option("PRESSURE-OVERCLOSURE").unwrap_or("HARD").to_uppercase();
        let row = found.rows().next();
        let values = row.as_ref().and_then(|row| self.numbers::<2>(row, 0));
        let (stiffness, tied, why) = match law.as_str() {
            "LINEAR" => (values.map(|[slope, _]| slope), false, ""),
            "TIED" => (values.map(|[slope, _]| slope), true, ""),
            "HARD" => (None, false, ""),
            // The slope of a straight line between its first and its last point.
            _ => (
                None,
                false,
                "pressure that is no straight line over penetration is not read: give a stiffness",
            ),
        };
        if !why.is_empty() {
            let what = format!("*SURFACE BEHAVIOR, {law}");
            self.deck.ledger.note(Weight::Matters, what, why, found.place());
        }
        if let Some(interaction) = self.open_interaction(found) {
            interaction.stiffness = stiffness.filter(|slope| *slope > 0.0);
            interaction.tied = tied;
        }
    }

    /// *CONTACT PAIR: slave and master.
    pub fn contact_pair(&mut self, space: usize, found: Found<'_>) {
        let interaction = found.option("INTERACTION").unwrap_or_default().to_string();
        let adjust = found.option("ADJUST").map(|cell| Row { place: found.place(), cells: vec![cell] });
        // A set of nodes to adjust has a name.
        let within = adjust.and_then(|row| row.cell(0).parse::<f64>().ok());
        for row in found.rows() {
            let slave = self.surface_of(space, row.cell(0), row.place);
            let master = self.surface_of(space, row.cell(1), row.place);
            let (Some(slave), Some(master)) = (slave, master) else { continue };
            let closed = found.block.has("ADJUST");
            let tied = found.block.has("TIED");
            let (interaction, place) = (interaction.clone(), row.place);
            self.pending.push(PendingContact { slave, master, interaction, tied, closed, within, place });
        }
    }

    /// Gives the pairs their laws.
    pub fn finish_contacts(&mut self) {
        for pair in std::mem::take(&mut self.pending) {
            let PendingContact { slave, master, place, within, .. } = pair;
            let law = self.interactions.get(&pair.interaction).copied();
            if law.is_none() && !pair.tied {
                self.files.fault(
                    place,
                    format!("INTERACTION={}", pair.interaction),
                    "the name of a *SURFACE INTERACTION",
                );
                continue;
            }
            let law = law.unwrap_or_default();
            if pair.tied || law.tied {
                self.deck.ties.push(Tie { name: pair.interaction, slave, master, within, place });
                continue;
            }
            let Interaction { friction, stick, stiffness, .. } = law;
            let name = pair.interaction;
            self.deck.contacts.push(Contact {
                name,
                slave,
                master,
                friction,
                stiffness,
                stick,
                closed: pair.closed,
                place,
            });
        }
    }
}
