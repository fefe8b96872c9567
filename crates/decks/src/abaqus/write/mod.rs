//! A deck as an input file that Abaqus and CalculiX read; where only one of them does, that is listed.
//!
//! Model data first, then the steps: the loads, and the modes that are asked for. Sources as in [`super`].

mod constraints;
mod mesh;
mod sections;
mod steps;

use crate::deck::Deck;
use crate::ledger::Weight;
use crate::written::{Names, Written, number as number_of, numbers};

/// Characters of a number, a limit of both programs.
const DIGITS: usize = 20;
/// Numbers in a line of a list.
const IN_A_LINE: usize = 16;

/// A file that is being written.
struct Writer<'d> {
    deck: &'d Deck,
    out: Written,
    node_sets: Names,
    element_sets: Names,
    surfaces: Names,
    materials: Names,
    interactions: Names,
    orientations: usize,
    /// The number of the next element without a shape.
    next_element: u64,
    node_numbers: Vec<u64>,
    element_numbers: Vec<u64>,
}

/// Writes a deck.
pub(crate) fn write(deck: &Deck) -> Written {
    let node_numbers = numbers(deck.nodes.iter().map(|node| node.number));
    let element_numbers = numbers(deck.elements.iter().map(|element| element.number));
    let mut writer = Writer {
        deck,
        out: Written::of(deck),
        node_sets: Names::default(),
        element_sets: Names::default(),
        surfaces: Names::default(),
        materials: Names::default(),
        interactions: Names::default(),
        orientations: 0,
        next_element: element_numbers.iter().max().map_or(1, |most| most + 1),
        node_numbers,
        element_numbers,
    };
    writer.out.line("*HEADING");
    writer.out.line(format!(" {}", deck.title.replace(['\n', '\r'], " ")));
    let head = writer.out.text.len();
    writer.nodes();
    writer.elements();
    writer.sets();
    writer.surfaces();
    writer.materials();
    writer.sections();
    writer.masses();
    writer.springs();
    writer.couplings();
    writer.ties();
    writer.supports();
    writer.equations();
    writer.contacts();
    writer.steps();
    writer.out.insert_lost(head, "** ");
    writer.out
}

fn number(value: f64) -> String {
    number_of(value, DIGITS)
}

/// `1.0, 2.0, 3.0`.
fn row(values: &[f64]) -> String {
    values.iter().map(|value| number(*value)).collect::<Vec<_>>().join(", ")
}

impl Writer<'_> {
    fn line(&mut self, line: impl AsRef<str>) {
        self.out.line(line);
    }

    fn note(&mut self, weight: Weight, what: &str, why: &str) {
        self.out.note(weight, what, why);
    }

    /// Whole numbers, so many a line.
    fn list(&mut self, numbers: &[u64]) {
        for line in numbers.chunks(IN_A_LINE) {
            self.line(line.iter().map(u64::to_string).collect::<Vec<_>>().join(", "));
        }
    }

    fn node_numbers_of(&self, nodes: &[usize]) -> Vec<u64> {
        nodes.iter().map(|node| self.node_numbers[*node]).collect()
    }

    fn element_numbers_of(&self, elements: &[usize]) -> Vec<u64> {
        elements.iter().map(|element| self.element_numbers[*element]).collect()
    }

    /// What names some nodes in a line of data: the set that has just these, or their numbers one by one.
    fn words_for_nodes(&mut self, name: Option<&str>, nodes: &[usize]) -> Vec<String> {
        let set = name.and_then(|name| self.deck.node_set(name)).filter(|set| set.members == nodes);
        match set {
            Some(set) => vec![self.node_sets.of(&set.name)],
            None => self.node_numbers_of(nodes).iter().map(u64::to_string).collect(),
        }
    }
}
