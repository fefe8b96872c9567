//! A matrix of a file, by the numbers of its rows or by the nodes that these are of.

use crate::c64;
use crate::matrix_market::{Entry, Header, LARGEST, MarketMatrix, Symmetry, TOLD, compress};
use rayon::prelude::*;
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

/// A matrix whose rows are of nodes; no place has two entries.
#[derive(Debug, Clone, PartialEq)]
pub struct Labelled {
    /// Row, column, value; of a column of a rectangular matrix its number stands for the node.
    pub entries: Vec<(Label, Label, c64)>,
    /// Whether it has an imaginary part.
    pub complex: bool,
    /// Whether its columns are no rows.
    pub rectangular: bool,
    /// Whether each entry off the diagonal stands for its mirror image, too.
    half: bool,
    /// Where it stands.
    place: String,
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

/// What a file says of the entries above and below the diagonal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Triangles {
    /// The columns are no rows.
    Rectangular,
    /// All entries are there.
    Both,
    /// Of a symmetric matrix, one of each pair or both.
    Symmetric,
    /// Nothing: where no entry off the diagonal has its mirror image, it is half of a symmetric matrix.
    Unsaid,
}

/// The entries of a matrix by nodes while they are read, each with its line.
#[derive(Debug, Default)]
pub(super) struct Entries {
    pub all: Vec<(Label, Label, c64)>,
    pub lines: Vec<u32>,
}

impl Entries {
    pub fn push(&mut self, row: Label, column: Label, value: c64, line: usize) {
        self.all.push((row, column, value));
        self.lines.push(u32::try_from(line).unwrap_or(u32::MAX));
    }

    /// The matrix, whose name is `name` if the file gives it one. A place that is given twice and, of a symmetric matrix, two halves that
    /// differ are faults.
    pub fn into_matrix(
        mut self,
        file: &File,
        name: &str,
        triangles: Triangles,
        complex: bool,
        wrong: &mut Wrong,
    ) -> Labelled {
        let rectangular = triangles == Triangles::Rectangular;
        let sorted = |k: u32| {
            let (row, column, _) = self.all[k as usize];
            if rectangular { (row, column) } else { (row.max(column), row.min(column)) }
        };
        let upper = |k: u32| self.all[k as usize].0 < self.all[k as usize].1;
        let mut order: Vec<u32> = (0..self.all.len() as u32).collect();
        order.par_sort_unstable_by_key(|k| (sorted(*k), !rectangular && upper(*k), *k));
        let mut mirrored = Vec::new();
        for two in order.windows(2).filter(|two| sorted(two[0]) == sorted(two[1])) {
            let [first, second] = [two[0].min(two[1]), two[0].max(two[1])].map(|k| k as usize);
            let ((row, column, value), (other_row, _, other)) = (self.all[second], self.all[first]);
            if row != other_row && !rectangular {
                mirrored.push(second);
                if triangles != Triangles::Symmetric || value == other {
                    continue;
                }
            }
            let found = format!(
                "row {}, {} of column {}, {} a second time, after line {}",
                row.0, row.1, column.0, column.1, self.lines[first]
            );
            let expected =
                if row == other_row { "every entry once" } else { "the value of its mirror image" };
            wrong.push(format!("{}:{}", file.name, self.lines[second]), found, expected);
        }
        let half = match triangles {
            Triangles::Symmetric => true,
            Triangles::Unsaid => mirrored.is_empty(),
            Triangles::Both | Triangles::Rectangular => false,
        };
        if half && !mirrored.is_empty() {
            let mut keep = vec![true; self.all.len()];
            mirrored.into_iter().for_each(|k| keep[k] = false);
            let mut keep = keep.into_iter();
            self.all.retain(|_| keep.next().unwrap_or(true));
        }
        let place = if name.is_empty() { file.name.to_string() } else { format!("{} {name}", file.name) };
        Labelled { entries: self.all, complex, rectangular, half, place }
    }
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
        let symmetry = if self.half { Symmetry::Symmetric } else { Symmetry::General };
        let header = Header { coordinate: true, complex: self.complex, symmetry };
        Ok(compress(&entries, header, labels.len(), columns.len()))
    }
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
