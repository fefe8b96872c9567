//! The model while the cards are put together.

use super::control::Control;
use super::frames::{Axes, Frames};
use super::grids::Grids;
use super::list::{self, Ids};
use super::names::Names;
use super::notes::Notes;
use super::table::Table;
use crate::deck::{Deck, Equation, Node, Place};
use crate::ledger::Weight;
use std::collections::BTreeSet;

/// What is found so far.
pub(super) struct Model<'m, 'n> {
    pub deck: Deck,
    pub grids: Grids,
    pub frames: Frames,
    pub control: &'m Control,
    pub names: &'m Names,
    pub notes: &'m mut Notes<'n>,
    /// Numbers of the elements of the deck, at the same indices.
    pub elements: Table<()>,
    /// Numbers of elements that have no shape or are not read.
    pub other_elements: BTreeSet<u64>,
    /// Whether shells or beams turn each node.
    pub rotates: Vec<bool>,
}

impl Model<'_, '_> {
    /// The node of a grid point that a card names. One that is not there is a fault; a scalar point is none.
    pub fn node(&mut self, id: u64, what: &str, place: Place) -> Option<usize> {
        let found = self.grids.table.find(id);
        if found.is_none() {
            self.missing_node(id, what, place);
        }
        found
    }

    fn missing_node(&mut self, id: u64, what: &str, place: Place) {
        if self.grids.is_scalar(id) {
            self.notes.ledger.note(Weight::Matters, what, "on a scalar point it is not read", place);
        } else {
            let found = format!("grid point {id} of {what}, which is not there");
            self.notes.files.fault(place, found, "the number of a GRID card");
        }
    }

    /// The nodes of a list.
    pub fn nodes(&mut self, list: &[Ids], what: &str, place: Place) -> Vec<usize> {
        let (found, missing) = list::members(list, &self.grids.table, place, self.notes);
        missing.into_iter().for_each(|id| self.missing_node(id, what, place));
        found
    }

    /// The element of a number that a card names.
    pub fn element(&mut self, id: u64, what: &str, place: Place) -> Option<usize> {
        let found = self.elements.find(id);
        if found.is_none() {
            self.missing_element(id, what, place);
        }
        found
    }

    fn missing_element(&mut self, id: u64, what: &str, place: Place) {
        if self.other_elements.contains(&id) {
            let why = "of elements without a shape, and of those that are not read, it is not read";
            self.notes.ledger.note(Weight::Perhaps, what, why, place);
        } else {
            let found = format!("element {id} of {what}, which is not there");
            self.notes.files.fault(place, found, "the number of an element of the deck");
        }
    }

    /// The elements of a list.
    pub fn elements(&mut self, list: &[Ids], what: &str, place: Place) -> Vec<usize> {
        let (found, missing) = list::members(list, &self.elements, place, self.notes);
        missing.into_iter().for_each(|id| self.missing_element(id, what, place));
        found
    }

    pub fn position(&self, node: usize) -> [f64; 3] {
        self.deck.nodes[node].position
    }

    /// The system of the displacements of a node.
    pub fn displacements(&mut self, node: usize) -> Axes {
        self.grids.displacements(node, &self.frames, self.notes)
    }

    /// The directions of the displacements of a node.
    pub fn directions(&mut self, node: usize) -> [[f64; 3]; 3] {
        let axes = self.displacements(node);
        axes.directions(self.position(node))
    }

    /// a u of a degree of freedom of the deck, as terms in the directions of the coordinates.
    pub fn terms(&mut self, node: usize, component: usize, factor: f64) -> Vec<(usize, u8, f64)> {
        let direction = self.directions(node)[component % 3];
        let first = component / 3 * 3;
        let term = |k: usize| (node, (first + k) as u8, factor * direction[k]);
        (0..3).map(term).filter(|(_, _, factor)| *factor != 0.0).collect()
    }

    /// Adds a node that the deck does not have, with a number of its own.
    pub fn add_node(&mut self, position: [f64; 3], place: Place) -> usize {
        let number = self.deck.nodes.last().map_or(0, |node| node.number).saturating_add(1);
        self.deck.nodes.push(Node { number, position, place });
        self.rotates.push(false);
        self.deck.nodes.len() - 1
    }

    /// Adds an equation, unless it has no terms.
    pub fn equation(&mut self, terms: Vec<(usize, u8, f64)>, place: Place) {
        if !terms.is_empty() {
            self.deck.equations.push(Equation { terms, place });
        }
    }
}
