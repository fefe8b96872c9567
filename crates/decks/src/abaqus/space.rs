//! Names and numbers of nodes, elements, sets and surfaces: of the model, or of an instance of a part.

use super::blocks;
use super::names::Names;
use crate::deck::{Deck, Set, Surface};
use std::collections::BTreeMap;

/// What names and numbers mean.
#[derive(Debug, Default)]
pub(super) struct Space {
    /// The instance; empty for the model.
    pub name: String,
    /// How the part is placed.
    pub placement: Option<Placement>,
    pub nodes: BTreeMap<u64, usize>,
    pub elements: BTreeMap<u64, Item>,
    pub node_sets: Names<NodeSet>,
    pub element_sets: Names<ElementSet>,
    pub surfaces: Names<Surface>,
}

/// An element by what it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Item {
    /// With a shape: index in [`Deck::elements`].
    Shape(usize),
    /// A mass, a spring, a dashpot: index in the reader's list.
    Point(usize),
    /// Of a type that is not read.
    Unread,
}

/// A set of nodes.
#[derive(Debug, Default)]
pub(super) struct NodeSet {
    pub name: String,
    /// By their numbers, each once; in the order of the file where it is to be kept.
    pub members: Vec<usize>,
    pub unsorted: bool,
    pub internal: bool,
}

/// A set of elements of all sorts.
#[derive(Debug, Default)]
pub(super) struct ElementSet {
    pub name: String,
    pub items: Vec<Item>,
    pub internal: bool,
}

/// x ↦ R x + t.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placement {
    pub rotation: [[f64; 3]; 3],
    pub translation: [f64; 3],
}

impl Placement {
    /// The place of a point.
    pub fn place(&self, x: [f64; 3]) -> [f64; 3] {
        let turned = self.turn(x);
        std::array::from_fn(|i| turned[i] + self.translation[i])
    }

    /// The point that comes to a place.
    pub fn back(&self, y: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|j| self.rotation[j][i] * (y[j] - self.translation[j])).sum())
    }

    /// The direction of a vector.
    pub fn turn(&self, x: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|j| self.rotation[i][j] * x[j]).sum())
    }
}

impl Space {
    /// A name with that of the instance before it.
    pub fn qualified(&self, name: &str) -> String {
        let name = blocks::unquoted(name);
        if self.name.is_empty() { name.to_string() } else { format!("{}.{name}", self.name) }
    }

    /// The set of nodes of this name, made if there is none.
    pub fn node_set(&mut self, name: &str) -> &mut NodeSet {
        let own = self.qualified(name);
        self.node_sets.entry(name, || NodeSet { name: own, ..NodeSet::default() })
    }

    /// The set of elements of this name, made if there is none.
    pub fn element_set(&mut self, name: &str) -> &mut ElementSet {
        let own = self.qualified(name);
        self.element_sets.entry(name, || ElementSet { name: own, ..ElementSet::default() })
    }

    /// Moves its sets and surfaces into the deck.
    pub fn into_deck(self, deck: &mut Deck) {
        let sorted = |mut members: Vec<usize>| {
            members.sort_unstable();
            members.dedup();
            members
        };
        for NodeSet { name, members, internal, .. } in self.node_sets.all {
            deck.node_sets.push(Set { name, members: sorted(members), internal });
        }
        for set in self.element_sets.all {
            let shape = |item: &Item| if let Item::Shape(index) = item { Some(*index) } else { None };
            let members = sorted(set.items.iter().filter_map(shape).collect());
            deck.element_sets.push(Set { name: set.name, members, internal: set.internal });
        }
        deck.surfaces.extend(self.surfaces.all);
    }
}
