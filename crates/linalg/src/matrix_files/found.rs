//! A matrix of a file, by the numbers of its rows or by the nodes that these are of.

use crate::c64;
use crate::matrix_market::{Entry, Header, LARGEST, MarketMatrix, Symmetry, TOLD, compress};
use std::collections::BTreeSet;
use stridor_base::error::{Error, Fault, Faults, Result};

/// A row by the node that it is of, and the degree of freedom there, from 1; 0 of a point that has one alone.
pub type Label = (i64, u8);

/// A matrix of a file.
#[derive(Debug, Clone)]
pub enum Found {
    /// Its rows have numbers.
    Whole(MarketMatrix),
    /// They have names.
    Labelled(Labelled),
}

/// A matrix whose rows are of nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Labelled {
    /// Row, column, value; of a column of a rectangular matrix its number stands for the node.
    pub entries: Vec<(Label, Label, c64)>,
    /// Whether it has an imaginary part.
    pub complex: bool,
    /// Whether its columns are no rows.
    pub rectangular: bool,
    /// Where it stands.
    pub(super) place: String,
}

/// A file in memory.
pub(super) struct File<'f> {
    pub name: &'f str,
    pub bytes: &'f [u8],
    /// What the name of the matrix begins with, where there are several.
    pub initial: char,
    /// The number of columns that another file confirms.
    pub known: usize,
}

impl Labelled {
    /// The names of its rows, ascending; of a square one those of its columns, too.
    pub fn labels(&self) -> BTreeSet<Label> {
        let columns = self.entries.iter().filter(|_| !self.rectangular).map(|(_, column, _)| *column);
        self.entries.iter().map(|(row, ..)| *row).chain(columns).collect()
    }

    /// The matrix whose rows are these, ascending.
    ///
    /// # Errors
    /// More than can be; a row that is not among them.
    pub fn numbered(&self, labels: &[Label]) -> Result<MarketMatrix> {
        let own: Vec<Label>;
        let columns = if self.rectangular {
            own = self
                .entries
                .iter()
                .map(|(_, column, _)| *column)
                .collect::<BTreeSet<_>>()
                .into_iter()
                .collect();
            &own[..]
        } else {
            labels
        };
        let fault = |found: String, expected: String| Error::input(Fault::new(&self.place, found, expected));
        if labels.len() > LARGEST || labels.is_empty() || columns.is_empty() {
            let expected = format!("between 1 and {LARGEST} of each");
            return Err(fault(format!("{} rows and {} columns", labels.len(), columns.len()), expected));
        }
        let place = |of: &[Label], label: &Label| of.binary_search(label).ok().map(|at| at as u32);
        let mut entries = Vec::with_capacity(self.entries.len());
        for (row, column, value) in &self.entries {
            let (Some(i), Some(j)) = (place(labels, row), place(columns, column)) else {
                let found = format!("node {}, degree of freedom {}", row.0, row.1);
                return Err(fault(found, "a row of the other matrices".into()));
            };
            entries.push(Entry { row: i, column: j, value: *value });
        }
        let square = !self.rectangular;
        Ok(completed(entries, [labels.len(), columns.len()], self.complex, square))
    }
}

/// The matrix of some entries. Where no entry off the diagonal has its mirror image, it is half of a symmetric one, and they are added.
pub(super) fn completed(
    entries: Vec<Entry>,
    [rows, columns]: [usize; 2],
    complex: bool,
    square: bool,
) -> MarketMatrix {
    let off =
        || entries.iter().filter(|entry| entry.row != entry.column).map(|entry| (entry.row, entry.column));
    let mut places: Vec<(u32, u32)> = if square { off().collect() } else { Vec::new() };
    places.sort_unstable();
    let half = places.iter().all(|(row, column)| places.binary_search(&(*column, *row)).is_err());
    let symmetry = if half && !places.is_empty() { Symmetry::Symmetric } else { Symmetry::General };
    drop(places);
    compress(&entries, Header { coordinate: true, complex, symmetry }, rows, columns)
}

/// The matrix that is wanted of several by their names: of a set of NASTRAN, as KAA, KGG and KXX are, or the one that begins so.
pub(super) fn wanted<T>(name: &str, initial: char, mut all: Vec<(String, T)>) -> Result<(String, T)> {
    let begins = |own: &str| own.to_uppercase().starts_with(initial);
    let of_a_set = |own: &str| matches!(own.as_bytes(), [_, a, b, ..] if a == b && a.is_ascii_alphabetic());
    for is in [&(|own: &str| begins(own) && of_a_set(own)) as &dyn Fn(&str) -> bool, &begins] {
        if all.len() > 1 && all.iter().filter(|(own, _)| is(own)).count() == 1 {
            all.retain(|(own, _)| is(own));
        }
    }
    if all.len() == 1 {
        return Ok(all.remove(0));
    }
    let names: Vec<&str> = all.iter().take(TOLD).map(|(own, _)| own.as_str()).collect();
    let found = format!("{} matrices: {}", all.len(), names.join(", "));
    let fault = Fault::new(name, found, format!("one, or one whose name begins with {initial}"));
    Err(Error::input(fault.with_help("Leave the one that is meant in a file of its own")))
}

/// The first faults of a file, and how many more there are.
#[derive(Default)]
pub(super) struct Wrong {
    faults: Faults,
    more: usize,
}

impl Wrong {
    pub fn push(&mut self, place: String, found: impl Into<String>, expected: impl Into<String>) {
        if self.faults.0.len() < TOLD {
            self.faults.push(Fault::new(place, found, expected));
        } else {
            self.more += 1;
        }
    }

    pub fn into_result<T>(mut self, name: &str, value: T) -> Result<T> {
        if self.more > 0 {
            self.faults.push(Fault::new(name, format!("{} more such lines", self.more), "none"));
        }
        self.faults.into_result(value)
    }
}
