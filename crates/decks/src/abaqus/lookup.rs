//! Names and numbers as a block sees them: those of its own space, and of instances.

use super::blocks;
use super::reader::Reader;
use super::space::{Item, Space};
use crate::deck::{Node, Place, Surface};
use std::collections::{BTreeMap, HashSet};

/// The most dots of a name that may stand before what is within an instance.
const MOST_DOTS: usize = 16;

impl Reader {
    /// A name as seen from a space: its own, or of the model `INSTANCE.NAME`; the space and the name within.
    fn candidates<'n>(&self, space: usize, name: &'n str) -> Vec<(usize, &'n str)> {
        let mut found = vec![(space, name)];
        let dots = name.match_indices('.').map(|(at, _)| at).take(MOST_DOTS);
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

    /// What `get` finds of a name in the spaces that it may be of.
    fn called<'s, T>(
        &'s self,
        space: usize,
        name: &str,
        get: impl Fn(&'s Space, &str) -> Option<T>,
    ) -> Option<T> {
        self.candidates(space, name).into_iter().find_map(|(space, name)| get(&self.spaces[space], name))
    }

    /// Members of a set that was looked for; a fault where it is not there, or names too many.
    fn found<T>(
        &mut self,
        found: Option<Vec<T>>,
        name: &str,
        place: Place,
        expected: &str,
    ) -> Option<Vec<T>> {
        match &found {
            Some(members) if !self.may_name(members.len(), place) => return None,
            Some(_) => {}
            None => self.files.fault(place, format!("`{}`", blocks::short(name)), expected),
        }
        found
    }

    /// The nodes of a set, or the node of a number; none where there is no such thing.
    pub fn nodes_called(&self, space: usize, name: &str) -> Option<Vec<usize>> {
        self.called(space, name, |space, name| {
            let set = || space.node_sets.get(name).map(|set| set.members.clone());
            numbered(&space.nodes, name).or_else(set)
        })
    }

    /// [`Reader::nodes_called`], or a fault.
    pub fn nodes_of(&mut self, space: usize, name: &str, place: Place) -> Option<Vec<usize>> {
        let found = self.nodes_called(space, name);
        self.found(found, name, place, "the number of a node or the name of a set of nodes")
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
        self.called(space, name, |space, name| {
            let set = || space.element_sets.get(name).map(|set| set.items.clone());
            numbered(&space.elements, name).or_else(set)
        })
    }

    /// [`Reader::items_called`], or a fault.
    pub fn items_of(&mut self, space: usize, name: &str, place: Place) -> Option<Vec<Item>> {
        let found = self.items_called(space, name);
        self.found(found, name, place, "the number of an element or the name of a set of elements")
    }

    /// The surface of this name as the deck calls it, or a fault.
    pub fn surface_of(&mut self, space: usize, name: &str, place: Place) -> Option<String> {
        let found = self.surface_called(space, name).map(|surface| surface.name.clone());
        if found.is_none() {
            self.files.fault(place, format!("`{}`", blocks::short(name)), "the name of a *SURFACE");
        }
        found
    }

    /// The surface of this name.
    pub fn surface_called(&self, space: usize, name: &str) -> Option<&Surface> {
        self.called(space, name, |space, name| space.surfaces.get(name))
    }

    /// Whether so many members of sets may still be named; a fault where not.
    pub fn may_name(&mut self, members: usize, place: Place) -> bool {
        let may = members <= self.members_left;
        if !may {
            let expected = "a file that does not name the same members again and again";
            self.files.fault(place, "sets with too many members in all", expected);
        }
        self.members_left = self.members_left.saturating_sub(members);
        may
    }

    /// Sorts the sets once all are there.
    pub fn settle_sets(&mut self) {
        for space in &mut self.spaces {
            for set in &mut space.node_sets.all {
                each_once(&self.deck.nodes, &mut set.members, set.unsorted);
            }
            for set in &mut space.element_sets.all {
                set.items.sort_unstable();
                set.items.dedup();
            }
        }
    }
}

/// What has a number.
fn numbered<T: Copy>(all: &BTreeMap<u64, T>, number: &str) -> Option<Vec<T>> {
    number.parse().ok().and_then(|number: u64| all.get(&number)).map(|one| vec![*one])
}

/// Keeps each node of a set once: by numbers, or in the order in which they stand if the set is unsorted.
pub(super) fn each_once(all: &[Node], members: &mut Vec<usize>, unsorted: bool) {
    if unsorted {
        let mut seen = HashSet::new();
        members.retain(|node| seen.insert(*node));
    } else {
        members.sort_unstable_by_key(|node| (all[*node].number, *node));
        members.dedup();
    }
}
