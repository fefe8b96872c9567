//! OUTPUT4 files of NASTRAN, as text and binary.
//!
//! A matrix begins with its columns, rows (negative where these are many, BIGMAT), form (1 square, 2 rectangular, 6 symmetric), kind of numbers
//! (1, 2 real; 3, 4 complex; 2, 4 of two words each) and name. A record is a column: its number, the first row and the number of words, then
//! values; of sparse ones the first row is 0, and strings of values follow, each below its length and first row: in one number
//! IS = first row + 65536 (L + 1), or, of many rows, L + 1 and the first row by themselves. L counts words. Columns ascend, and one beyond
//! the last ends the matrix. Source: MSC Nastran *DMAP Programmer's Guide*, OUTPUT4.

mod binary;
mod text;

use super::found::{File, Found, wanted};
use crate::c64;
use crate::matrix_market::{EMPTY, Entry, Header, LARGEST, MarketMatrix, Symmetry, compress};
use stridor_base::error::{Error, Fault, Result};

/// What is not as it should be: what was found, what is expected.
type Deviation = (String, String);

fn deviation<T>(found: impl Into<String>, expected: impl Into<String>) -> std::result::Result<T, Deviation> {
    Err((found.into(), expected.into()))
}

/// From so many rows on a string has its length and first row by themselves.
const MANY_ROWS: i64 = 65_536;

/// Where a string of values is.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Block {
    /// The first row, from 1.
    row: i64,
    /// How many numbers follow; two of each complex value.
    numbers: i64,
}

/// A matrix while its records are read.
#[derive(Debug)]
struct Matrix {
    name: String,
    rows: i64,
    columns: i64,
    form: i64,
    complex: bool,
    /// Words of a number.
    words: i64,
    /// Whether a string has two numbers above it.
    big: bool,
    /// The place of its first line or record.
    place: String,
    entries: Vec<Entry>,
    /// The column that is read, and the first row of it that may follow.
    column: i64,
    row: i64,
}

impl Matrix {
    /// From the four numbers that it begins with; `double` is the number of words of a number of double precision.
    fn new(
        [columns, rows, form, kind]: [i64; 4],
        name: String,
        double: i64,
        place: String,
    ) -> std::result::Result<Self, Deviation> {
        let most = LARGEST as i64;
        let size = rows.checked_abs().unwrap_or(i64::MAX);
        if !(1..=most).contains(&columns) || !(1..=most).contains(&size) {
            return deviation(
                format!("{rows} rows and {columns} columns"),
                format!("between 1 and {LARGEST} of each"),
            );
        }
        if !(1..=4).contains(&kind) {
            return deviation(format!("kind {kind} of numbers"), "1, 2, 3 or 4");
        }
        Ok(Matrix {
            name,
            rows: size,
            columns,
            form,
            complex: kind > 2,
            words: if kind % 2 == 0 { double } else { 1 },
            big: !(0..MANY_ROWS).contains(&rows),
            place,
            entries: Vec::new(),
            column: 0,
            row: 1,
        })
    }

    /// Begins a column; whether there is one, or the end of the matrix.
    fn begin(&mut self, column: i64) -> std::result::Result<bool, Deviation> {
        if column <= self.column || column > self.columns + 1 {
            let (first, last) = (self.column + 1, self.columns);
            let expected = if first > last {
                format!("{first}, which ends {}", self.name)
            } else {
                format!("one from {first} to {last}, or {}, which ends {}", last + 1, self.name)
            };
            return deviation(format!("column {column}"), expected);
        }
        (self.column, self.row) = (column, 1);
        Ok(column <= self.columns)
    }

    /// The rows of a string of numbers are in the matrix, and below those before.
    fn checked(&self, block: Block) -> std::result::Result<Block, Deviation> {
        let Block { row, numbers } = block;
        let each = if self.complex { 2 } else { 1 };
        if numbers < 1 || numbers % each != 0 {
            let whole = if self.complex { "an even number of numbers" } else { "one number or more" };
            return deviation(format!("{numbers} numbers in column {}", self.column), whole);
        }
        if row < self.row || numbers / each > self.rows - row + 1 {
            let found = format!("{} values from row {row} on in column {}", numbers / each, self.column);
            return deviation(found, format!("rows from {} to {}", self.row, self.rows));
        }
        Ok(block)
    }

    /// The string whose length and first row are `numbers`, one or two of them, and how many words it takes with these.
    fn string(&self, numbers: &[i64]) -> std::result::Result<(Block, i64), Deviation> {
        let (words, row) = match numbers {
            [length, row] => (length.saturating_sub(1), *row),
            [is] => (is / MANY_ROWS - 1, is % MANY_ROWS),
            _ => unreachable!("one or two"),
        };
        if words < 1 || words % self.words != 0 {
            let expected = format!("a string of {} words or a multiple", self.words);
            return deviation(format!("a string of {words} words in column {}", self.column), expected);
        }
        let block = self.checked(Block { row, numbers: words / self.words })?;
        Ok((block, words.saturating_add(numbers.len() as i64)))
    }

    /// Numbers on each string.
    fn header(&self) -> usize {
        if self.big { 2 } else { 1 }
    }

    /// The values of a string that was [checked](Self::checked).
    fn push(&mut self, block: Block, numbers: &[f64]) -> std::result::Result<(), Deviation> {
        let at = |k: i64| Entry {
            row: (block.row - 1 + k) as u32,
            column: (self.column - 1) as u32,
            value: c64::new(0.0, 0.0),
        };
        if let Some(wrong) = numbers.iter().find(|number| !number.is_finite()) {
            return deviation(format!("{wrong} in column {}", self.column), "finite numbers");
        }
        let each = if self.complex { 2 } else { 1 };
        self.row = block.row;
        for (k, value) in numbers.chunks(each).enumerate() {
            let value = c64::new(value[0], value.get(1).copied().unwrap_or(0.0));
            self.entries.push(Entry { value, ..at(k as i64) });
            self.row += 1;
        }
        Ok(())
    }
}

/// Whether it is binary, by the length of its first record, before the text of a file is made plain.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    binary::is(bytes)
}

/// Whether it begins as OUTPUT4.
pub(super) fn is(bytes: &[u8]) -> bool {
    binary::is(bytes) || text::is(bytes)
}

pub(super) fn read(file: &File) -> Result<Found> {
    let read = if binary::is(file.bytes) { binary::read(file) } else { text::read(file) };
    let all = read.map_err(|(place, (found, expected))| Error::input(Fault::new(place, found, expected)))?;
    let named = all.into_iter().map(|matrix| (matrix.name.clone(), matrix)).collect();
    let (_, matrix) = wanted(file.name, file.initial, named)?;
    let (rows, columns, entries) = (matrix.rows as usize, matrix.columns as usize, matrix.entries);
    let refused =
        |found: String, expected: &str| Err(Error::input(Fault::new(&matrix.place, found, expected)));
    if !matches!(matrix.form, 1 | 2 | 6) {
        return refused(
            format!("form {} of {}", matrix.form, matrix.name),
            "1 (square), 2 (rectangular) or 6 (symmetric)",
        );
    }
    if matrix.form != 2 && rows != columns {
        let found = format!("{rows} rows and {columns} columns of form {}", matrix.form);
        return refused(found, "as many rows as columns, or form 2 (rectangular)");
    }
    if columns != file.known && columns > entries.len() + EMPTY {
        let expected = format!("at most {EMPTY} columns more than entries");
        return refused(format!("{columns} columns for {} entries", entries.len()), &expected);
    }
    Ok(Found::Whole(completed(&entries, [rows, columns], matrix.complex, matrix.form == 6)))
}

/// The matrix of some entries. A symmetric one where no entry off the diagonal has its mirror image is half of it, and they are added.
fn completed(entries: &[Entry], [rows, columns]: [usize; 2], complex: bool, symmetric: bool) -> MarketMatrix {
    let off =
        || entries.iter().filter(|entry| entry.row != entry.column).map(|entry| (entry.row, entry.column));
    let mut places: Vec<(u32, u32)> = if symmetric { off().collect() } else { Vec::new() };
    places.sort_unstable();
    let half = places.iter().all(|(row, column)| places.binary_search(&(*column, *row)).is_err());
    let symmetry = if half && !places.is_empty() { Symmetry::Symmetric } else { Symmetry::General };
    drop(places);
    compress(entries, Header { coordinate: true, complex, symmetry }, rows, columns)
}

#[cfg(test)]
mod tests;
