//! Bulk data decks of NASTRAN (MSC, NX and Simcenter, OptiStruct), and punch files.
//!
//! Source of all cards: MSC Nastran *Quick Reference Guide* and Simcenter Nastran *Quick Reference Guide*, entries of the same names.
//! [`source`] has the sections and files of a deck, [`card`] the fields of a card; a file each has the cards of one concept, first as they stand
//! with the numbers of what they name, then, once all are read, with these found.

mod axis;
mod beams;
mod card;
mod constraints;
mod contact;
mod control;
mod elements;
mod fields;
mod frames;
mod grids;
mod list;
mod loads;
mod masses;
mod materials;
mod model;
mod modes;
mod names;
mod parameters;
mod properties;
mod repeat;
mod rigid;
mod sections;
mod source;
mod springs;
mod surfaces;
mod table;
#[cfg(test)]
mod tests;
mod turn;
mod unread;

use crate::deck::{Deck, Place};
use crate::ledger::Ledger;
use crate::text::Files;
use card::Card;
use fields::Fields;
use model::Model;
use names::{Named, Names};
use source::Source;
use std::path::Path;
use stridor_base::error::Result;
use table::Table;
use unread::Unread;

/// Reads a deck.
///
/// # Errors
/// A file that cannot be read.
pub(crate) fn read(path: &Path, files: &mut Files) -> Result<Deck> {
    let mut notes = Notes { files, ledger: Ledger::default(), members_left: 1000 };
    let Source { bulk, control, mut names, .. } = Source::read(path, &mut notes)?;
    names.count();
    let mut deck = bulk.resolve(&control, &names, &mut notes);
    deck.title = control.title;
    deck.ledger = notes.ledger;
    Ok(deck)
}

/// What is wrong, and what is not read.
struct Notes<'n> {
    files: &'n mut Files,
    ledger: Ledger,
    /// How many members lists may still have: ranges that overlap make long lists of short lines.
    members_left: usize,
}

impl Notes<'_> {
    /// Whether a list may have so many members more.
    fn may_list(&mut self, members: usize, place: Place) -> bool {
        let may = members <= self.members_left;
        if may {
            self.members_left -= members;
        } else {
            let expected = "lists whose ranges do not overlap again and again";
            self.files.fault(place, "ranges of more members than four a byte of the files", expected);
        }
        may
    }
}

/// The cards of the bulk data, as they stand.
#[derive(Default)]
struct Bulk {
    grids: grids::Grids,
    frames: frames::RawFrames,
    elements: elements::Elements,
    properties: properties::Properties,
    materials: materials::Materials,
    springs: springs::Springs,
    masses: masses::Masses,
    constraints: constraints::Constraints,
    rigid: rigid::Rigid,
    loads: loads::Loads,
    contact: contact::Contacts,
    surfaces: surfaces::Surfaces,
    modes: modes::Methods,
    parameters: parameters::Parameters,
    unread: Unread,
}

impl Bulk {
    /// Reads a card.
    fn card(&mut self, card: &Card, names: &mut Names, notes: &mut Notes) {
        let mut fields = Fields::of(card, notes);
        let name = card.name.as_str();
        if name.starts_with('P') || name.starts_with("MAT") {
            let what = if name.starts_with('P') { Named::Property } else { Named::Material };
            if let Some(number) = card.find(1).and_then(|(_, text)| fields::integer(text)) {
                names.card(what, number.unsigned_abs());
            }
        }
        let read = match name {
            "GRID" | "GRDSET" | "SPOINT" | "EPOINT" => self.grids.card(&mut fields),
            "CORD1R" | "CORD1C" | "CORD1S" | "CORD2R" | "CORD2C" | "CORD2S" => self.frames.card(&mut fields),
            "CTETRA" | "CHEXA" | "CPENTA" | "CPYRAM" | "CPYRA" | "CTRIA3" | "CTRIA6" | "CTRIAR"
            | "CQUAD4" | "CQUAD8" | "CQUADR" | "CBAR" | "CBEAM" | "BAROR" | "BEAMOR" | "CROD" | "CONROD"
            | "CTUBE" => self.elements.card(&mut fields),
            "PSOLID" | "PSHELL" | "PCOMP" | "PBAR" | "PBARL" | "PBEAM" | "PBEAML" | "PROD" | "PTUBE" => {
                self.properties.card(&mut fields)
            }
            "MAT1" | "MAT8" | "MAT9" | "MAT11" => self.materials.card(&mut fields),
            "CELAS1" | "CELAS2" | "CDAMP1" | "CDAMP2" | "CBUSH" | "CBUSH1D" | "PELAS" | "PDAMP" | "PBUSH"
            | "PBUSH1D" => self.springs.card(&mut fields),
            "CONM1" | "CONM2" => self.masses.card(&mut fields),
            "SPC" | "SPC1" | "SPCADD" | "MPC" | "MPCADD" => self.constraints.card(&mut fields),
            "RBE2" | "RBE3" | "RBAR" | "RBAR1" => self.rigid.card(&mut fields),
            "FORCE" | "LOAD" | "PLOAD4" | "RFORCE" => self.loads.card(&mut fields),
            "BSURF" | "BSURFS" | "BCPROP" | "BCPROPS" | "SURF" | "SET" | "SET3" | "BCBODY" => {
                self.surfaces.card(&mut fields)
            }
            "BCTSET" | "BGSET" | "BCTADD" | "BGADD" | "BCTABLE" | "CONTACT" | "TIE" | "PCONT" => {
                self.contact.card(&mut fields)
            }
            "EIGRL" | "EIGR" | "EIGC" => self.modes.card(&mut fields),
            "PARAM" => self.parameters.card(&mut fields),
            "CELAS3" | "CELAS4" | "CDAMP3" | "CDAMP4" | "CMASS3" | "CMASS4" => {
                self.grids.scalar_element(&mut fields);
                unread::note(&mut fields, &mut self.unread);
                None
            }
            _ => {
                unread::note(&mut fields, &mut self.unread);
                None
            }
        };
        if read.is_none() && name.starts_with('P') {
            // What names it is not at fault.
            self.unread.properties.extend(card.find(1).and_then(|(_, text)| text.parse::<u64>().ok()));
        }
        if read.is_some() {
            fields.end();
        }
    }

    /// The model, with all that cards name by number found.
    fn resolve(self, control: &control::Control, names: &Names, notes: &mut Notes) -> Deck {
        let Bulk {
            mut grids, frames, mut elements, mut properties, mut materials, unread, parameters, ..
        } = self;
        grids.sort(notes);
        let frames = frames.resolve(&grids, notes);
        let deck = Deck { nodes: grids.nodes(&frames, notes), ..Deck::default() };
        let mut model = Model {
            deck,
            grids,
            frames,
            control,
            names,
            notes,
            elements: Table::default(),
            other_elements: unread.elements.clone(),
            rotates: Vec::new(),
        };
        properties.sort(model.notes);
        materials.sort(model.notes);
        self.springs.numbers(&mut model.other_elements);
        self.masses.numbers(&mut model.other_elements);
        elements.resolve(&mut model);
        let heavier = sections::resolve(&elements, &properties, &materials, &unread, &mut model);
        materials.resolve(heavier, &parameters, &mut model);
        let surfaces = self.surfaces.resolve(&elements, &mut model);
        self.contact.resolve(&surfaces, &mut model);
        self.constraints.resolve(&mut model);
        self.rigid.resolve(&mut model);
        self.springs.resolve(&mut model);
        self.masses.resolve(&parameters, &mut model);
        self.loads.resolve(&mut model);
        self.modes.resolve(&mut model);
        model.deck
    }
}
