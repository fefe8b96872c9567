//! Nodes and elements that a file describes by others: *NGEN, *NFILL, *NCOPY, *NMAP; *ELGEN, *ELCOPY.
//!
//! A few lines may ask for any number of them: how many there are in all is bounded. Sets that are copied or filled between are what was
//! named above, so that a file with such keywords has its sets read as far as they are known, too. Source: *Abaqus Analysis User's Guide*,
//! 2.1.1 *Node definition*, 2.2.1 *Element definition*.

mod curves;
mod elements;
mod mapped;
mod nodes;

use super::blocks::{self, Block};
use super::keywords::Phase;
use super::lookup::each_once;
use super::reader::{Found, Reader, Row};
use super::space::{Item, Space};
use crate::deck::Place;
use std::collections::BTreeMap;
use stridor_base::numbers::parse;

/// The most nodes and elements that are generated in all.
const MOST_GENERATED: u128 = 1_000_000;
/// Members of sets that each of them may be named as.
const NAMED: usize = 32;
/// Keywords that work on sets above them.
const ON_SETS: [&str; 4] = ["NFILL", "NCOPY", "NMAP", "ELCOPY"];

/// Whether a block works on sets above it.
pub(super) fn needs_sets(block: &Block) -> bool {
    ON_SETS.contains(&block.keyword.as_str())
}

impl Reader {
    /// Reads *NSET among the nodes and *ELSET among the elements, as far as members are known by then.
    pub fn set_so_far(&mut self, phase: Phase, space: usize, found: Found<'_>) {
        let option = match (phase, found.block.keyword.as_str()) {
            (Phase::Nodes, "NSET") if found.option("ELSET").is_none() => "NSET",
            (Phase::Elements, "ELSET") => "ELSET",
            _ => return,
        };
        let (Some(name), None) = (found.option(option), found.option("INSTANCE")) else { return };
        if option == "NSET" {
            let members = self.known(space, found, |space| &space.nodes, Reader::nodes_called);
            let set = self.spaces[space].node_set(name);
            set.members.extend(members);
            set.unsorted |= found.block.has("UNSORTED");
        } else {
            let items = self.known(space, found, |space| &space.elements, Reader::items_called);
            self.spaces[space].element_set(name).items.extend(items);
        }
    }

    fn known<T: Copy>(
        &mut self,
        space: usize,
        found: Found<'_>,
        numbered: fn(&Space) -> &BTreeMap<u64, T>,
        called: fn(&Reader, usize, &str) -> Option<Vec<T>>,
    ) -> Vec<T> {
        let mut members = Vec::new();
        for row in found.rows() {
            if found.block.has("GENERATE") {
                members.extend(self.members_in(&row, space, numbered).unwrap_or_default());
                continue;
            }
            for cell in row.cells.iter().filter(|cell| !cell.is_empty()) {
                let named = called(self, space, cell).unwrap_or_default();
                if self.may_name(named.len(), row.place) {
                    members.extend(named);
                }
            }
        }
        members
    }

    /// Whether so many more nodes or elements may be generated; a fault where not.
    fn may_generate(&mut self, n: u128, place: Place) -> bool {
        let all = n.saturating_add(self.generated as u128);
        if all > MOST_GENERATED {
            let found = format!("{all} nodes and elements that are generated");
            let expected = format!("at most {MOST_GENERATED} in all");
            self.files.fault_with_help(place, found, expected, "write them, by *NODE and *ELEMENT");
            return false;
        }
        self.generated = all as usize;
        self.members_left += NAMED * n as usize;
        true
    }

    /// A whole number; that of `empty` for an empty cell.
    fn whole(&mut self, row: &Row<'_>, at: usize, empty: i64) -> Option<i64> {
        let cell = row.cell(at);
        if cell.is_empty() {
            return Some(empty);
        }
        // `2.` and `2.0` are what some programs write.
        let real = || parse(cell).filter(|x| x.fract() == 0.0 && x.abs() < 1e15).map(|x| x as i64);
        let whole = cell.parse().ok().or_else(real);
        if whole.is_none() {
            self.files.fault(row.place, format!("`{}`", blocks::short(cell)), "a whole number");
        }
        whole
    }

    /// A whole number from 1; 1 for an empty cell.
    fn count(&mut self, row: &Row<'_>, at: usize) -> Option<i64> {
        let count = self.whole(row, at, 1)?;
        if count < 1 {
            self.files.fault(row.place, format!("`{count}`"), "how many there are, from 1");
            return None;
        }
        Some(count)
    }

    /// A whole number that an option gives; a fault where it is missing or none.
    fn shift(&mut self, found: Found<'_>, option: &str, words: &str) -> Option<i64> {
        let value = found.option(option).unwrap_or_default();
        let shift = value.trim_end_matches('.').parse().ok();
        if shift.is_none() {
            let found_words = format!("*{} with {words}=`{}`", found.block.keyword, blocks::short(value));
            self.files.fault(found.place(), found_words, format!("{words}=…, a whole number"));
        }
        shift
    }

    /// A number and what is added to it; a fault where that is no number of a node or an element.
    fn shifted(&mut self, number: u64, by: i128, place: Place) -> Option<u64> {
        let shifted = u64::try_from(i128::from(number).saturating_add(by)).ok().filter(|number| *number > 0);
        if shifted.is_none() {
            let found = format!("{number} and {by}");
            self.files.fault(place, found, "a sum that is a number of a node or an element, from 1");
        }
        shifted
    }

    /// The name of the set that is copied, a fault where there is none.
    fn old_set<'a>(&mut self, found: Found<'a>) -> Option<&'a str> {
        let name = found.option("OLDSET");
        if name.is_none() {
            let words = format!("*{} without OLD SET", found.block.keyword);
            self.files.fault(found.place(), words, "OLD SET=…, the name of a set above");
        }
        name
    }

    /// The nodes of a set as it is so far, or the node of a number; a fault where there is none. Each once, by number if the set is sorted.
    fn nodes_so_far(&mut self, space: usize, name: &str, place: Place) -> Option<Vec<usize>> {
        let own = &self.spaces[space];
        let one = || name.parse().ok().and_then(|number: u64| own.nodes.get(&number)).map(|node| vec![*node]);
        let of_set = own.node_sets.get(name).map(|set| (set.members.len(), set.unsorted));
        if let Some((n_members, unsorted)) = of_set.filter(|(n_members, _)| *n_members > 0) {
            if !self.may_name(n_members, place) {
                return None;
            }
            let mut nodes = self.spaces[space].node_sets.get(name)?.members.clone();
            each_once(&self.deck.nodes, &mut nodes, unsorted);
            return Some(nodes);
        }
        let one = one();
        if one.is_none() {
            let found = format!("`{}`", blocks::short(name));
            self.files.fault(place, found, "a node, or a set of nodes by their numbers, above this line");
        }
        one
    }

    /// The elements of a set as it is so far, each once, or a fault.
    fn items_so_far(&mut self, space: usize, name: &str, place: Place) -> Option<Vec<Item>> {
        let n_items = self.spaces[space].element_sets.get(name).map_or(0, |set| set.items.len());
        if n_items == 0 {
            let found = format!("`{}`", blocks::short(name));
            self.files.fault(place, found, "the name of a set of elements above this line");
            return None;
        }
        if !self.may_name(n_items, place) {
            return None;
        }
        let mut items = self.spaces[space].element_sets.get(name)?.items.clone();
        items.sort_unstable();
        items.dedup();
        Some(items)
    }
}
