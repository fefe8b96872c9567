//! Small decks, one for each thing that is read and each trap of decks that others wrote.

mod constraints;
mod contacts;
mod faults;
mod files;
mod generate;
mod loads;
mod materials;
mod mesh;
mod sets;

use crate::deck::Deck;
use crate::format::{Format, read_bytes};
use crate::ledger::Weight;
use stridor_base::error::Error;

/// A deck that reads.
fn deck(text: &str) -> Deck {
    read_bytes("a.inp", text.as_bytes(), Format::Abaqus).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The faults of one that does not, each as a sentence.
fn faults(text: &str) -> Vec<String> {
    match read_bytes("a.inp", text.as_bytes(), Format::Abaqus) {
        Err(Error::Input(faults)) => faults.0.iter().map(ToString::to_string).collect(),
        other => panic!("{other:?}\n{text}"),
    }
}

/// Whether it has one fault, at this line, with these words.
fn fault(text: &str, line: usize, words: &str) {
    let faults = faults(text);
    let at = format!("a.inp:{line}: ");
    assert!(faults.len() == 1 && faults[0].starts_with(&at) && faults[0].contains(words), "{faults:?}");
}

/// What the ledger lists, with its lines.
fn notes(deck: &Deck) -> Vec<(Weight, &str, u32)> {
    deck.ledger.rows().map(|row| (row.weight, row.what, row.first.line)).collect()
}

/// Numbers of the nodes of an element, or of any.
fn numbers(deck: &Deck, nodes: &[usize]) -> Vec<u64> {
    nodes.iter().map(|node| deck.nodes[*node].number).collect()
}

fn set(deck: &Deck, name: &str) -> Vec<u64> {
    numbers(deck, &deck.node_set(name).unwrap_or_else(|| panic!("no set {name}")).members)
}

fn elements(deck: &Deck, name: &str) -> Vec<u64> {
    let set = deck.element_set(name).unwrap_or_else(|| panic!("no set {name}"));
    set.members.iter().map(|index| deck.elements[*index].number).collect()
}

/// The faces of a surface as the corners' numbers of each.
fn faces(deck: &Deck, name: &str) -> Vec<Vec<u64>> {
    let surface = deck.surface(name).unwrap_or_else(|| panic!("no surface {name}"));
    let corners = |(element, side): &(usize, usize)| {
        let element = &deck.elements[*element];
        let (kind, nodes) = element.kind.table().sides[*side];
        let nodes = nodes[..kind.n_corners()].iter().map(|node| element.nodes[usize::from(*node)]);
        let mut corners = numbers(deck, &nodes.collect::<Vec<_>>());
        corners.sort_unstable();
        corners
    };
    surface.faces.iter().map(corners).collect()
}

/// Two bricks one upon the other: nodes 1 to 12, elements 1 and 2.
const BRICKS: &str = "\
*NODE, NSET=ALL
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
9, 0., 0., 2.
10, 1., 0., 2.
11, 1., 1., 2.
12, 0., 1., 2.
*ELEMENT, TYPE=C3D8, ELSET=EALL
1, 1, 2, 3, 4, 5, 6, 7, 8
2, 5, 6, 7, 8, 9, 10, 11, 12
";

/// [`BRICKS`] and more.
fn bricks(more: &str) -> Deck {
    deck(&format!("{BRICKS}{more}"))
}
