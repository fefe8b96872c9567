//! OUTPUT4 files of NASTRAN, as text and binary.
//!
//! A matrix begins with its columns, rows (negative where these are many, BIGMAT), form (1 square, 2 rectangular, 6 symmetric), kind of numbers
//! (1, 2 real; 3, 4 complex; 2, 4 of two words each) and name. A record is a column: its number, the first row and the number of words, then
//! values; of sparse ones the first row is 0, and strings of values follow, each below its length and first row: in one number
//! IS = first row + 65536 (L + 1), or, of many rows, L + 1 and the first row by themselves. L counts words. Columns ascend, and one beyond
//! the last ends the matrix. Source: MSC Nastran *DMAP Programmer's Guide*, OUTPUT4.

mod binary;
mod matrix;
mod text;

use super::found::{File, Found, wanted};
use crate::matrix_market::{EMPTY, Entry, Header, MarketMatrix, Symmetry, compress};
use stridor_base::error::{Error, Fault, Result};

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
