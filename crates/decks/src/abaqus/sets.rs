//! *NSET, *ELSET.

use super::reader::{Found, Reader, Row};
use super::space::{Item, Space};
use crate::deck::Place;
use crate::ledger::Weight;
use std::collections::BTreeMap;

impl Reader {
    /// *NSET: numbers and names of sets, ranges with GENERATE, or the nodes of a set of elements.
    pub fn node_set(&mut self, space: usize, found: Found<'_>) {
        let Some(name) = found.option("NSET") else {
            self.files.fault(found.place(), "*NSET without a name", "*NSET, NSET=…");
            return;
        };
        let of = self.space_of(space, found);
        let mut members = Vec::new();
        if let Some(elements) = found.option("ELSET") {
            let items = self.items_of(of, elements, found.place()).unwrap_or_default();
            members.extend(items.into_iter().flat_map(|item| self.nodes_of_item(item)));
        }
        members.extend(self.listed(
            found,
            of,
            "NSET",
            |space| &space.nodes,
            Reader::nodes_called,
            Reader::nodes_of,
        ));
        let set = self.spaces[space].node_set(name);
        set.members.extend(members);
        set.unsorted |= found.block.has("UNSORTED");
        set.internal |= found.block.has("INTERNAL");
    }

    /// *ELSET: numbers and names of sets, or ranges with GENERATE.
    pub fn element_set(&mut self, space: usize, found: Found<'_>) {
        let Some(name) = found.option("ELSET") else {
            self.files.fault(found.place(), "*ELSET without a name", "*ELSET, ELSET=…");
            return;
        };
        let of = self.space_of(space, found);
        let members =
            self.listed(found, of, "ELSET", |space| &space.elements, Reader::items_called, Reader::items_of);
        let set = self.spaces[space].element_set(name);
        set.items.extend(members);
        set.internal |= found.block.has("INTERNAL");
    }

    /// The members that the lines of a set name: ranges, or numbers and names, of which numbers of what is not there are noted.
    fn listed<T: Copy>(
        &mut self,
        found: Found<'_>,
        of: usize,
        keyword: &str,
        numbered: fn(&Space) -> &BTreeMap<u64, T>,
        called: fn(&Reader, usize, &str) -> Option<Vec<T>>,
        named: fn(&mut Reader, usize, &str, Place) -> Option<Vec<T>>,
    ) -> Vec<T> {
        let mut members = Vec::new();
        for row in found.rows() {
            if found.block.has("GENERATE") {
                members.extend(self.range(&row, of, keyword, numbered));
                continue;
            }
            for cell in row.cells.iter().filter(|cell| !cell.is_empty()) {
                if cell.parse::<u64>().is_ok() && called(self, of, cell).is_none() {
                    self.missing(keyword, row.place);
                } else {
                    members.extend(named(self, of, cell, row.place).unwrap_or_default());
                }
            }
        }
        members
    }

    /// The space that a set's numbers are of: its own, or that of INSTANCE.
    fn space_of(&mut self, space: usize, found: Found<'_>) -> usize {
        let Some(name) = found.option("INSTANCE") else { return space };
        match self.instances.get(name) {
            Some(instance) => *instance,
            None => {
                if self.spaces.len() > 1 {
                    self.files.fault(found.place(), format!("INSTANCE={name}"), "the name of an *INSTANCE");
                } else {
                    let why = "the file has no instances: the numbers are those of the model";
                    self.deck.ledger.note(Weight::Perhaps, "INSTANCE", why, found.place());
                }
                space
            }
        }
    }

    /// The nodes of an element.
    pub fn nodes_of_item(&self, item: Item) -> Vec<usize> {
        match item {
            Item::Shape(index) => self.deck.elements[index].nodes.clone(),
            Item::Point(index) => self.points[index].nodes.clone(),
            Item::Unread => Vec::new(),
        }
    }

    /// What is there of first, first + step … last, noted where it is nothing.
    fn range<T: Copy>(
        &mut self,
        row: &Row<'_>,
        space: usize,
        keyword: &str,
        numbered: fn(&Space) -> &BTreeMap<u64, T>,
    ) -> Vec<T> {
        let Some(found) = self.members_in(row, space, numbered) else { return Vec::new() };
        if found.is_empty() {
            self.missing(keyword, row.place);
        }
        found
    }

    /// What is there of first, first + step … last.
    pub fn members_in<T: Copy>(
        &mut self,
        row: &Row<'_>,
        space: usize,
        numbered: fn(&Space) -> &BTreeMap<u64, T>,
    ) -> Option<Vec<T>> {
        let [first, last, step] = self.range_numbers(row)?;
        let inside = || numbered(&self.spaces[space]).range(first..=last);
        let n_inside = inside().count();
        let of_step = |(number, _): &(&u64, &T)| (**number - first).is_multiple_of(step);
        let found: Vec<T> = inside().filter(of_step).map(|(_, item)| *item).collect();
        self.may_name(n_inside, row.place).then_some(found)
    }

    /// Notes a member of a set that is not in the file, as these programs do.
    fn missing(&mut self, keyword: &str, place: Place) {
        let why = "members that are not in the file";
        self.deck.ledger.note(Weight::Perhaps, format!("*{keyword}"), why, place);
    }

    fn range_numbers(&mut self, row: &Row<'_>) -> Option<[u64; 3]> {
        let first = self.label(row.place, row.cell(0))?;
        let last = if row.cell(1).is_empty() { first } else { self.label(row.place, row.cell(1))? };
        let step = if row.cell(2).is_empty() { 1 } else { self.label(row.place, row.cell(2))? };
        if last < first {
            self.files.fault(row.place, format!("a range from {first} to {last}"), "first, last, step");
            return None;
        }
        Some([first, last, step])
    }
}
