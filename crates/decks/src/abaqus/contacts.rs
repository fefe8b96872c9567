//! *CONTACT PAIR, *SURFACE INTERACTION and what belongs to it.

use super::reader::{Found, Reader, Row};
use super::waiting::{Interaction, PendingContact};
use crate::deck::{Contact, Tie};
use crate::ledger::Weight;

impl Reader {
    /// *SURFACE INTERACTION: what follows is of it.
    pub fn interaction(&mut self, _: usize, found: Found<'_>) {
        let Some(name) = found.option("NAME") else {
            self.files.fault(found.place(), "*SURFACE INTERACTION without a name", "NAME=…");
            return;
        };
        self.interactions.entry(name, Interaction::default);
        self.interaction = Some(name.to_string());
    }

    /// *CHANGE FRICTION, *CHANGE SURFACE BEHAVIOR: what follows is of an interaction from this step on.
    pub fn change_interaction(&mut self, _: usize, found: Found<'_>) {
        let name = found.option("INTERACTION").unwrap_or_default();
        if self.interactions.get(name).is_none() {
            let words = format!("INTERACTION={name}");
            self.files.fault(found.place(), words, "the name of a *SURFACE INTERACTION");
            return;
        }
        let why = "what the last step says of the interaction is read";
        self.deck.ledger.note(Weight::Perhaps, format!("*{}", found.block.keyword), why, found.place());
        self.interaction = Some(name.to_string());
    }

    fn open_interaction(&mut self, found: Found<'_>) -> Option<&mut Interaction> {
        let Some(name) = self.interaction.clone() else {
            let (what, why) = (format!("*{}", found.block.keyword), "no *SURFACE INTERACTION stands above");
            self.deck.ledger.note(Weight::Perhaps, what, why, found.place());
            return None;
        };
        Some(self.interactions.entry(&name, Interaction::default))
    }

    /// *FRICTION: μ; of CalculiX also the stick slope.
    pub fn friction(&mut self, _: usize, found: Found<'_>) {
        let Some(row) = found.rows().next() else {
            if found.block.has("ROUGH") {
                let why = "surfaces that never slip are read without friction";
                self.deck.ledger.note(Weight::Matters, "*FRICTION, ROUGH", why, found.place());
            } else if !found.block.has("NONE") {
                self.files.fault(found.place(), "*FRICTION without data", "a line with μ");
            }
            return;
        };
        let Some([friction, second]) = self.numbers::<2>(&row, 0) else { return };
        let decays = found.block.has("EXPONENTIALDECAY");
        let table = found.lines().count() > 1;
        if decays {
            let why = "the static coefficient is read; it does not fall with the slip rate";
            self.deck.ledger.note(Weight::Matters, "*FRICTION, EXPONENTIAL DECAY", why, found.place());
        } else if table {
            let why = "the first line of a table over slip rate, pressure or temperature is read";
            self.deck.ledger.note(Weight::Matters, "*FRICTION", why, found.place());
        }
        // Of Abaqus the second number is a slip rate.
        let stick = (second > 0.0 && !decays && !table).then_some(second);
        if let Some(interaction) = self.open_interaction(found) {
            interaction.friction = friction;
            interaction.stick = stick;
        }
    }

    /// *SURFACE BEHAVIOR: PRESSURE-OVERCLOSURE=LINEAR with its slope; HARD, TIED.
    pub fn behaviour(&mut self, _: usize, found: Found<'_>) {
        let law = found.option("PRESSURE-OVERCLOSURE").unwrap_or("HARD").to_uppercase();
        let rows: Vec<Row<'_>> = found.rows().take(3).collect();
        let values = rows.first().and_then(|row| self.numbers::<2>(row, 0));
        let slope = values.map(|[slope, _]| slope);
        let (stiffness, tied, why) = match law.as_str() {
            "LINEAR" if slope.is_none() => {
                self.files.fault(found.place(), "*SURFACE BEHAVIOR without a slope", "a line with the slope");
                return;
            }
            "LINEAR" => (slope, false, ""),
            "TIED" => (slope, true, ""),
            "HARD" => (None, false, ""),
            _ => {
                let why = "pressure that is no straight line over penetration is not read: give a stiffness";
                match self.straight(&law, &rows) {
                    Some(slope) => (Some(slope), false, ""),
                    None => (None, false, why),
                }
            }
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

    /// The slope of a table of two lines, pressure and penetration, that begins at zero.
    fn straight(&mut self, law: &str, rows: &[Row<'_>]) -> Option<f64> {
        let [first, last] = rows else { return None };
        let (first, last) = (self.numbers::<2>(first, 0)?, self.numbers::<2>(last, 0)?);
        (law == "TABULAR" && first == [0.0; 2] && last[1] > 0.0).then(|| last[0] / last[1])
    }

    /// *CONTACT PAIR: slave and master.
    pub fn contact_pair(&mut self, space: usize, found: Found<'_>) {
        let interaction = found.option("INTERACTION").unwrap_or_default().to_string();
        let adjust = found.option("ADJUST").map(|cell| Row { place: found.place(), cells: vec![cell] });
        // A set of nodes to adjust has a name.
        let within = adjust.and_then(|row| row.cell(0).parse::<f64>().ok());
        for row in found.rows() {
            if row.cell(1).is_empty() {
                let why = "a surface that touches itself is not read";
                self.deck.ledger.note(Weight::Matters, "*CONTACT PAIR", why, row.place);
                continue;
            }
            let slave = self.surface_of(space, row.cell(0), row.place);
            let master = self.surface_of(space, row.cell(1), row.place);
            let (Some(slave), Some(master)) = (slave, master) else { continue };
            let closed = found.block.has("ADJUST");
            let tied = found.block.has("TIED");
            let (title, interaction, place) = (found.block.title.clone(), interaction.clone(), row.place);
            self.pending.push(PendingContact {
                title,
                slave,
                master,
                interaction,
                tied,
                closed,
                within,
                place,
            });
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
            self.deck.contacts.push(Contact {
                name: pair.title,
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
