//! Rows by their number, as grid points, elements and properties are known.

use super::notes::Notes;
use crate::deck::Place;
use crate::ledger::Weight;
use std::ops::Range;

/// What has a number of its own.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row<T> {
    pub number: u64,
    pub place: Place,
    pub value: T,
}

/// Rows, ascending by their number once the file is read.
#[derive(Debug)]
pub(super) struct Table<T> {
    rows: Vec<Row<T>>,
}

impl<T> Default for Table<T> {
    fn default() -> Self {
        Table { rows: Vec::new() }
    }
}

impl<T: PartialEq> Table<T> {
    pub fn push(&mut self, number: u64, place: Place, value: T) {
        self.rows.push(Row { number, place, value });
    }

    /// Sorts the rows. The same card twice is noted, another one of the same number is a fault.
    pub fn sort(&mut self, what: &str, notes: &mut Notes) {
        self.rows.sort_by_key(|row| (row.number, row.place));
        for pair in self.rows.windows(2) {
            let [first, second] = pair else { continue };
            if first.number != second.number {
                continue;
            }
            if first.value == second.value {
                let why = "the same card stands twice: it is read once";
                notes.ledger.note(Weight::Nothing, what, why, second.place);
            } else {
                let found = format!("{what} {} a second time, and another one", second.number);
                let first = crate::place::place_words(&notes.files.paths, first.place);
                notes.files.fault(
                    second.place,
                    found,
                    format!("each number once; the first one is at {first}"),
                );
            }
        }
        self.rows.dedup_by_key(|row| row.number);
    }

    pub fn find(&self, number: u64) -> Option<usize> {
        self.rows.binary_search_by_key(&number, |row| row.number).ok()
    }

    pub fn get(&self, number: u64) -> Option<&Row<T>> {
        self.find(number).map(|at| &self.rows[at])
    }

    /// Indices of the rows from one number to another.
    pub fn range(&self, first: u64, last: u64) -> Range<usize> {
        let start = self.rows.partition_point(|row| row.number < first);
        start..self.rows.partition_point(|row| row.number <= last).max(start)
    }

    pub fn rows(&self) -> &[Row<T>] {
        &self.rows
    }
}
