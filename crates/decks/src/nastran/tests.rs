//! Small decks, one for each form and concept.

use crate::deck::{Analysis, CouplingKind, Deck, Elastic, Frame, LoadOn, Profile, SectionShape, ShellFace};
use crate::format::{Format, read};
use crate::ledger::Weight;
use std::path::Path;
use stridor_base::bounds::{Origin, within};
use stridor_mesh::CellKind;

mod damaged;
mod forms;
mod joints;
mod structure;

/// The deck of a text, or its faults.
fn read_text(text: &str) -> Result<Deck, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deck.bdf");
    std::fs::write(&path, text).unwrap();
    read(&path, None).map_err(|error| error.to_string().replace(&format!("{}", path.display()), "deck.bdf"))
}

fn deck(text: &str) -> Deck {
    read_text(text).unwrap()
}

fn faults(text: &str) -> String {
    read_text(text).unwrap_err()
}

/// Whether the ledger has a row with these words.
fn notes(deck: &Deck, weight: Weight, what: &str, why: &str) -> bool {
    deck.ledger.rows().any(|row| row.weight == weight && row.what == what && row.why.contains(why))
}

/// Numbers of nodes.
fn numbers(deck: &Deck, nodes: &[usize]) -> Vec<u64> {
    nodes.iter().map(|node| deck.nodes[*node].number).collect()
}

fn close(found: f64, expected: f64) -> bool {
    within((found - expected).abs(), 1e-12 * (1.0 + expected.abs()), Origin::RoundOff)
}

/// A cube of one element.
const CUBE: &str = "\
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,1.,1.,0.
GRID,4,,0.,1.,0.
GRID,5,,0.,0.,1.
GRID,6,,1.,0.,1.
GRID,7,,1.,1.,1.
GRID,8,,0.,1.,1.
CHEXA,10,3,1,2,3,4,5,6,
,7,8
PSOLID,3,5
MAT1,5,2.1+11,,.3,7850.
";
