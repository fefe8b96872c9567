//! The model that is being made of a deck.

use super::regions::Regions;
use super::text::CaseText;
use super::units::Units;
use crate::deck::{Deck, Equation, Place};
use crate::ledger::Ledger;
use std::collections::{HashMap, HashSet};
use stridor_base::error::{Fault, Faults};

/// What is being made.
pub(super) struct Converter<'a> {
    pub deck: &'a Deck,
    pub units: Units,
    pub regions: Regions<'a>,
    pub case: CaseText,
    pub ledger: Ledger,
    pub parts: Vec<Part>,
    pub names: TableNames,
    /// What each node is used for.
    pub uses: Vec<NodeUse>,
    /// Supports that are equations.
    pub held: Vec<Equation>,
    pub axes_of_materials: HashMap<String, [[f64; 3]; 2]>,
    pub warnings: Vec<String>,
    pub faults: Faults,
}

/// What a node is used for.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct NodeUse {
    /// Elements of the mesh, couplings, springs or equations have it.
    pub moves: bool,
    /// Shells or beams have it, or nodes follow it.
    pub rotates: bool,
    /// An equation makes it follow others.
    pub follows: bool,
}

/// A part of the case.
#[derive(Debug, Clone)]
pub(super) struct Part {
    /// Its region.
    pub name: String,
    /// Index in [`crate::Deck::sections`].
    pub section: usize,
    /// Its elements in the deck.
    pub elements: Vec<usize>,
}

/// Names of tables, each once a kind.
#[derive(Default)]
pub(super) struct TableNames(HashSet<(&'static str, String)>);

impl TableNames {
    /// A name like `name` that no table of the kind has.
    pub fn free(&mut self, kind: &'static str, name: &str) -> String {
        let numbered = (1..).map(|n| if n == 1 { name.to_string() } else { format!("{name}_{n}") });
        let mut numbered = numbered.filter(|name| !self.0.contains(&(kind, name.clone())));
        let name = numbered.next().unwrap_or_default();
        self.0.insert((kind, name.clone()));
        name
    }
}

impl Converter<'_> {
    /// Notes a fault of the deck.
    pub fn fault(&mut self, place: Place, found: impl Into<String>, expected: &str) {
        self.faults.push(Fault::new(self.deck.words(place), found, expected));
    }
}
