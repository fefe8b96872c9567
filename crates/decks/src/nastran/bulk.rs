//! The cards of the bulk data, and the model that they make.

use super::card::Card;
use super::fields::{Fields, integer};
use super::model::Model;
use super::names::{Named, Names};
use super::notes::Notes;
use super::table::Table;
use super::unread::Unread;
use super::{
    constraints, contact, control, elements, frames, grids, loads, masses, materials, modes, parameters,
    properties, rigid, sections, springs, surfaces, unread,
};
use crate::deck::Deck;

/// The cards of the bulk data, as they stand.
#[derive(Default)]
pub(super) struct Bulk {
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
    pub fn card(&mut self, card: &Card, names: &mut Names, notes: &mut Notes) {
        let mut fields = Fields::of(card, notes);
        let name = card.name.as_str();
        if name.starts_with('P') || name.starts_with("MAT") {
            let what = if name.starts_with('P') { Named::Property } else { Named::Material };
            if let Some(number) = card.find(1).and_then(|(_, text)| integer(text)) {
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
            "FORCE" | "LOAD" | "PLOAD" | "PLOAD2" | "PLOAD4" | "RFORCE" => self.loads.card(&mut fields),
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
    pub fn resolve(self, control: &control::Control, names: &Names, notes: &mut Notes) -> Deck {
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
