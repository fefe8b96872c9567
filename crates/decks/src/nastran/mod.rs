//! Bulk data decks of NASTRAN (MSC, NX and Simcenter, OptiStruct), and punch files.
//!
//! Source of all cards: MSC Nastran *Quick Reference Guide* and Simcenter Nastran *Quick Reference Guide*, entries of the same names.
//! [`source`] has the sections and files of a deck, [`card`] the fields of a card; a file each has the cards of one concept, first as they stand
//! with the numbers of what they name, then, once all are read, with these found.

mod axis;
mod beams;
mod bulk;
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
mod notes;
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
mod unread;
mod write;

use crate::deck::Deck;
use crate::ledger::Ledger;
use crate::text::Files;
use notes::Notes;
use source::Source;
use std::path::Path;
use stridor_base::error::Result;
pub(crate) use write::write;

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
    deck.lost = names.lost;
    deck.ledger = notes.ledger;
    Ok(deck)
}
