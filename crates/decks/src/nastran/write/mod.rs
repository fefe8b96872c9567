//! A deck as bulk data of NASTRAN, in small fields where all fit, else in large ones.
//!
//! Sources as in [`super`]. Names are comments as HyperMesh writes them, which other programs read, too.

mod card;
mod constraints;
mod mesh;
mod sections;

use crate::deck::{Analysis, Deck};
use crate::ledger::Weight;
use crate::written::Written;
use card::{Field, card};
use std::collections::HashMap;

/// The set of supports, equations, ties and contacts, and the method, that the case control chooses; that of the loads, which modes have none of.
const SET: u64 = 1;
/// Modes where the deck says no number and no highest frequency.
const MODES: usize = 20;

/// A deck that is being written.
struct Writer<'d> {
    deck: &'d Deck,
    out: Written,
    /// The bulk data.
    bulk: Written,
    node_numbers: Vec<u64>,
    element_numbers: Vec<u64>,
    /// The number of the next element, property or coordinate system.
    next_element: u64,
    next_property: u64,
    next_system: u64,
    /// The number of each surface by its name in capitals.
    surfaces: HashMap<String, u64>,
}

/// Writes a deck.
pub(crate) fn write(deck: &Deck) -> Written {
    let node_numbers = crate::written::numbers(deck.nodes.iter().map(|node| node.number));
    let element_numbers = crate::written::numbers(deck.elements.iter().map(|element| element.number));
    let mut writer = Writer {
        deck,
        out: Written::of(deck),
        bulk: Written::default(),
        next_element: element_numbers.iter().max().map_or(1, |most| most + 1),
        next_property: deck.sections.len() as u64 + 1,
        next_system: 1,
        node_numbers,
        element_numbers,
        surfaces: HashMap::new(),
    };
    writer.methods();
    writer.materials();
    writer.sections();
    writer.nodes();
    writer.elements();
    writer.masses();
    writer.springs();
    writer.couplings();
    writer.supports();
    writer.surfaces();
    writer.ties();
    writer.contacts();
    writer.loads();
    writer.sets();
    let Writer { mut out, bulk, .. } = writer;
    control(deck, &bulk.text, &mut out);
    out.line("BEGIN BULK");
    out.insert_lost(out.text.len(), "$ ");
    out.text += &bulk.text;
    out.line("ENDDATA");
    out
}

/// Executive and case control: the sets of which there are cards.
fn control(deck: &Deck, bulk: &str, out: &mut Written) {
    let complex = deck.analyses.iter().any(|analysis| matches!(analysis, Analysis::ComplexModes { .. }));
    out.line(if complex { "SOL 110" } else { "SOL 103" });
    out.line("CEND");
    let title: String = deck.title.chars().filter(|c| !c.is_control()).take(60).collect();
    out.line(format!("TITLE = {title}"));
    let has = |card: &str| bulk.lines().any(|line| line.split([' ', '*']).next() == Some(card));
    let commands = [
        ("EIGRL", "METHOD"),
        ("EIGC", "CMETHOD"),
        ("SPC1", "SPC"),
        ("MPC", "MPC"),
        ("BGSET", "BGSET"),
        ("BCTSET", "BCSET"),
    ];
    for (_, command) in commands.iter().filter(|(card, _)| has(card)) {
        out.line(format!("{command} = {SET}"));
    }
}

impl Writer<'_> {
    fn card(&mut self, name: &str, fields: &[Field]) {
        self.bulk.text += &card(name, fields);
    }

    fn note(&mut self, weight: Weight, what: &str, why: &str) {
        self.out.note(weight, what, why);
    }

    fn node(&self, node: usize) -> Field {
        Field::Integer(self.node_numbers[node])
    }

    fn nodes_of(&self, nodes: &[usize]) -> Vec<Field> {
        nodes.iter().map(|node| self.node(*node)).collect()
    }

    fn new_element(&mut self) -> Field {
        self.next_element += 1;
        Field::Integer(self.next_element - 1)
    }

    /// EIGRL; EIGC.
    fn methods(&mut self) {
        let deck = self.deck;
        let mut complex = false;
        for analysis in deck.analyses.iter().take(1) {
            let (Analysis::Modes { count, band } | Analysis::ComplexModes { count, band }) = analysis;
            complex = matches!(analysis, Analysis::ComplexModes { .. });
            let real = |value: Option<f64>| value.map_or(Field::Blank, Field::Real);
            let count = count.or(band[1].is_none().then_some(MODES));
            let count = count.map_or(Field::Blank, |count| Field::Integer(count as u64));
            self.card("EIGRL", &[Field::Integer(SET), real(band[0]), real(band[1]), count.clone()]);
            if complex {
                let count = if count == Field::Blank { Field::Integer(MODES as u64) } else { count };
                let word = |word: &str| Field::Word(word.into());
                let mut fields = vec![Field::Integer(SET), word("CLAN"), word("MAX")];
                fields.resize(6, Field::Blank);
                fields.push(count);
                self.card("EIGC", &fields);
            }
        }
        if deck.analyses.len() > 1 {
            self.note(Weight::Perhaps, "analyses", "the first one alone is written");
        }
        if complex && !deck.contacts.is_empty() {
            let why = "friction forces of a sliding contact are no part of SOL 110";
            self.note(Weight::Matters, "complex modes", why);
        }
    }
}
