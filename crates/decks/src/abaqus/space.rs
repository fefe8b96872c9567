//! Names and numbers of nodes, elements, sets and surfaces: of the model, or of an instance of a part.

use super::names::Names;
use super::{Reader, blocks};
use crate::deck::{Deck, Place, Set, Surface};
use std::collections::HashMap;

/// What names and numbers mean.
#[derive(Debug, Default)]
pub(super) struct Space {
    /// The instance; empty for the model.
    pub name: String,
    /// How the part is placed.
    pub placement: Option<Placement>,
    pub nodes: HashMap<u64, usize>,
    pub elements: HashMap<u64, Item>,
    pub node_sets: Names<Set>,
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
    pub fn node_set(&mut self, name: &str) -> &mut Set {
        let own = self.qualified(name);
        self.node_sets.entry(name, || Set { name: own, members: Vec::new(), internal: false })
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
        let named = self.node_sets.all.into_iter();
        deck.node_sets.extend(named.map(|set| Set { members: sorted(set.members), ..set }));
        for set in self.element_sets.all {
            let shape = |item: &Item| if let Item::Shape(index) = item { Some(*index) } else { None };
            let members = sorted(set.items.iter().filter_map(shape).collect());
            deck.element_sets.push(Set { name: set.name, members, internal: set.internal });
        }
        deck.surfaces.extend(self.surfaces.all);
    }
}

impl Reader {
    /// A name as seen from a space: its own, or of the model `INSTANCE.NAME`; the space and the name within.
    fn candidates<'n>(&self, space: usize, name: &'n str) -> Vec<(usize, &'n str)> {
        let mut found = vec![(space, name)];
        let dots = name.match_indices('.').map(|(at, _)| at);
        found.extend(dots.filter_map(|at| {
            let instance = self.instances.get(&name[..at])?;
            Some((*instance, &name[at + 1..]))
        }));
        // A model of one instance may name what is in it without saying so.
        if space == 0 && self.spaces.len() == 2 {
            found.push((1, name));
        }
        found
    }

    /// The nodes of a set, or the node of a number; none where there is no such thing.
    pub fn nodes_called(&self, space: usize, name: &str) -> Option<Vec<usize>> {
        self.candidates(space, name).into_iter().find_map(|(space, name)| {
            let space = &self.spaces[space];
            let numbered =
                || name.parse().ok().and_then(|number: u64| space.nodes.get(&number)).map(|node| vec![*node]);
            numbered().or_else(|| space.node_sets.get(name).map(|set| set.members.clone()))
        })
    }

    /// [`Reader::nodes_called`], or a fault.
    pub fn nodes_of(&mut self, space: usize, name: &str, place: Place) -> Option<Vec<usize>> {
        let found = self.nodes_called(space, name);
        if found.is_none() {
            self.files.fault(
                place,
                format!("`{}`", blocks::short(name)),
                "the number of a node or the name of a set of nodes",
            );
        }
        found
    }

    /// The one node of a number or of a set of one, or a fault.
    pub fn node_of(&mut self, space: usize, name: &str, place: Place) -> Option<usize> {
        match self.nodes_of(space, name, place)?.as_slice() {
            [node] => Some(*node),
            several => {
                let found = format!("`{}`, a set of {} nodes", blocks::short(name), several.len());
                self.files.fault(place, found, "one node");
                None
            }
        }
    }

    /// The elements of a set, or the element of a number; none where there is no such thing.
    pub fn items_called(&self, space: usize, name: &str) -> Option<Vec<Item>> {
        self.candidates(space, name).into_iter().find_map(|(space, name)| {
            let space = &self.spaces[space];
            let numbered = || {
                name.parse().ok().and_then(|number: u64| space.elements.get(&number)).map(|item| vec![*item])
            };
            numbered().or_else(|| space.element_sets.get(name).map(|set| set.items.clone()))
        })
    }

    /// [`Reader::items_called`], or a fault.
    pub fn items_of(&mut self, space: usize, name: &str, place: Place) -> Option<Vec<Item>> {
        let found = self.items_called(space, name);
        if found.is_none() {
            self.files.fault(
                place,
                format!("`{}`", blocks::short(name)),
                "the number of an element or the name of a set of elements",
            );
        }
        found
    }

    /// The surface of this name as the deck calls it, or a fault.
    pub fn surface_of(&mut self, space: usize, name: &str, place: Place) -> Option<String> {
        let candidates = self.candidates(space, name);
        let found = candidates.into_iter().find_map(|(space, name)| self.spaces[space].surfaces.get(name));
        let found = found.map(|surface| surface.name.clone());
        if found.is_none() {
            self.files.fault(place, format!("`{}`", blocks::short(name)), "the name of a *SURFACE");
        }
        found
    }

    /// The surface of this name.
    pub fn surface_called(&self, space: usize, name: &str) -> Option<&Surface> {
        let candidates = self.candidates(space, name);
        candidates.into_iter().find_map(|(space, name)| self.spaces[space].surfaces.get(name))
    }
}
