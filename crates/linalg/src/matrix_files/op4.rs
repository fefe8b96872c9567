//! OUTPUT4 files of NASTRAN as text.
//!
//! A matrix begins with its columns, rows (negative where these are many, BIGMAT), form and kind of numbers (1, 2 real; 3, 4 complex), eight
//! characters each, its name and the form of its numbers, `1P,3E23.16`. A record is a line of column, first row and number of words, with
//! values below; of sparse ones the first row is 0, and strings of values follow, each below a line that has, in one number IS, its length and
//! first row, IS = first row + 65536 (L + 1), or, of many rows, both by themselves. A column beyond the last ends the matrix. Source: MSC
//! Nastran *DMAP Programmer's Guide*, OUTPUT4.

use super::found::{File, Found, Wrong, completed, wanted};
use crate::c64;
use crate::matrix_market::{EMPTY, Entry, LARGEST, Lines, shown};
use stridor_base::error::{Error, Fault, Result};
use stridor_base::numbers;

/// The first line of a matrix.
struct Head {
    columns: usize,
    rows: usize,
    kind: u8,
    name: String,
    /// Characters of a value.
    width: usize,
}

struct Matrix {
    entries: Vec<Entry>,
    size: [usize; 2],
    complex: bool,
    line: usize,
}

fn head(line: &[u8]) -> Option<Head> {
    let line = std::str::from_utf8(line).ok().filter(|line| line.is_ascii())?;
    let number = |k: usize| line.get(8 * k..8 * k + 8)?.trim().parse::<i64>().ok();
    let (columns, rows, kind) = (number(0)?, number(1)?, number(3)?);
    number(2)?;
    // `1P,3E23.16`, `3D23.16`: the width stands after the letter.
    let form = line.get(40..)?.trim().to_ascii_uppercase();
    let after = &form[form.find(['E', 'D'])? + 1..];
    let width = after.split('.').next()?.parse().ok().filter(|width| (8..=64).contains(width))?;
    Some(Head {
        columns: usize::try_from(columns).ok()?,
        rows: usize::try_from(rows.unsigned_abs()).ok()?,
        kind: u8::try_from(kind).ok().filter(|kind| (1..=4).contains(kind))?,
        name: line.get(32..40)?.trim().to_string(),
        width,
    })
}

/// Whether it begins as text of OUTPUT4, or as a binary one, by the length of its first record.
pub(super) fn is(bytes: &[u8]) -> bool {
    is_binary(bytes) || Lines::of(bytes).next().is_some_and(|line| head(line).is_some())
}

fn is_binary(bytes: &[u8]) -> bool {
    matches!(bytes, [24, 0, 0, 0, ..] | [0, 0, 0, 24, ..])
}

/// Whole numbers alone.
fn integers(line: &[u8]) -> Option<Vec<i64>> {
    let line = std::str::from_utf8(line).ok()?;
    line.split_whitespace().map(|word| word.parse().ok()).collect()
}

pub(super) fn read(file: &File) -> Result<Found> {
    if is_binary(file.bytes) {
        let fault = Fault::new(file.name, "a binary file of OUTPUT4", "one of text");
        return Err(Error::input(fault.with_help("Write it with ASSIGN OUTPUT4 … FORMATTED")));
    }
    let mut lines = Lines::of(file.bytes);
    let (mut all, mut wrong) = (Vec::new(), Wrong::default());
    while let Some(line) = lines.next() {
        if line.trim_ascii().is_empty() {
            continue;
        }
        let Some(own) = head(line) else {
            let expected = "columns, rows, form, kind, name and form of numbers of the next matrix";
            wrong.push(format!("{}:{}", file.name, lines.number), format!("`{}`", shown(line)), expected);
            break;
        };
        let name = own.name.clone();
        all.push((name, matrix(file, own, &mut lines, &mut wrong)));
    }
    wrong.into_result(file.name, ())?;
    let (_, Matrix { entries, size: [rows, columns], complex, line }) = wanted(file.name, file.initial, all)?;
    let refused = |found: String, expected: String| {
        Err(Error::input(Fault::new(format!("{}:{line}", file.name), found, expected)))
    };
    if rows.max(columns) > LARGEST || rows.min(columns) == 0 {
        let expected = format!("between 1 and {LARGEST} of each");
        return refused(format!("{rows} rows and {columns} columns"), expected);
    }
    if columns != file.known && columns > entries.len() + EMPTY {
        let expected = format!("at most {EMPTY} columns more than entries");
        return refused(format!("{columns} columns for {} entries", entries.len()), expected);
    }
    Ok(Found::Whole(completed(entries, [rows, columns], complex, rows == columns)))
}

/// The records of a matrix, to the one beyond its last column with the line below that.
fn matrix(file: &File, own: Head, lines: &mut Lines<'_>, wrong: &mut Wrong) -> Matrix {
    let complex = own.kind > 2;
    let size = [own.rows, own.columns];
    let mut found = Matrix { entries: Vec::new(), size, complex, line: lines.number };
    // The column, the next row, and the real part that waits for the imaginary one.
    let (mut column, mut row, mut real) = (0, 0_i64, None);
    while let Some(line) = lines.next() {
        let place = format!("{}:{}", file.name, lines.number);
        match integers(line).as_deref() {
            Some([]) => {}
            Some([at, first, _]) => {
                (column, row, real) = (*at, *first, None);
                if column > own.columns as i64 {
                    lines.next();
                    return found;
                }
            }
            Some([_, first]) => (row, real) = (*first, None),
            Some([string]) => (row, real) = (string % 65536, None),
            _ => {
                let line = line.trim_ascii_end();
                for word in line.chunks(own.width) {
                    let value = std::str::from_utf8(word).ok().and_then(|word| numbers::parse(word.trim()));
                    let Some(value) = value.filter(|value| value.is_finite()) else {
                        let words = format!("`{}`", shown(word));
                        wrong.push(
                            place.clone(),
                            words,
                            format!("finite numbers of {} characters", own.width),
                        );
                        break;
                    };
                    let value = match (complex, real.take()) {
                        (false, _) => c64::new(value, 0.0),
                        (true, Some(real)) => c64::new(real, value),
                        (true, None) => {
                            real = Some(value);
                            continue;
                        }
                    };
                    let within =
                        (1..=own.rows as i64).contains(&row) && (1..=own.columns as i64).contains(&column);
                    if !within {
                        let expected = format!("rows to {} and columns to {}", own.rows, own.columns);
                        wrong.push(place.clone(), format!("row {row}, column {column}"), expected);
                        break;
                    }
                    found.entries.push(Entry { row: (row - 1) as u32, column: (column - 1) as u32, value });
                    row += 1;
                }
            }
        }
    }
    let expected = format!("a record of column {}, which ends {}", own.columns + 1, own.name);
    wrong.push(format!("{}:{}", file.name, lines.number), "the end of the file", expected);
    found
}
