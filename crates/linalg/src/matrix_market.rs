//! MatrixMarket files (<https://math.nist.gov/MatrixMarket/formats.html>), read without trust and written back.
//!
//! Read are `coordinate` and `array` matrices of `real`, `integer` or `complex` numbers that are `general`,
//! `symmetric`, `hermitian` or `skew-symmetric`. A triangle is completed to the whole matrix; entries given more than
//! once add up. Numbers may be written as Fortran does ([`stridor_base::numbers::parse`]), the text in any encoding that
//! [`stridor_base::error::read::plain`] knows. Every number of a header is bounded by the size of the
//! file before memory is taken for it, and the first faults of a file are told together, each with its line.

use super::sparse::{Index, compressed};
use super::{SparseMatrix, c64};
use rayon::prelude::*;
use std::fmt::Write as _;
use std::path::Path;
use stridor_base::error::read::{plain, read_bytes};
use stridor_base::error::{Error, Fault, Faults, Result};
use stridor_base::numbers;

/// The most rows or columns.
pub(super) const LARGEST: usize = 1 << 26;
/// The most columns beyond the number of entries, in a matrix whose size is not known beforehand: a column takes memory
/// even when it is empty.
pub(super) const EMPTY: usize = 1 << 22;
/// Faults that are told of one file; a broken file has as many as lines.
pub(super) const TOLD: usize = 8;
/// Bytes that one task parses.
const PIECE: usize = 1 << 20;

/// A matrix as a file gave it: both triangles, real and imaginary part on one pattern.
#[derive(Debug, Clone)]
pub struct MarketMatrix {
    /// The real part.
    pub re: SparseMatrix,
    /// The imaginary part of a `complex` file.
    pub im: Option<SparseMatrix>,
}

impl MarketMatrix {
    /// Which triangle holds all entries off the diagonal that are not zero, and how many these are; `None` where both triangles
    /// hold some, where there are none, and of a matrix that is not square.
    ///
    /// ```
    /// let file = b"%%MatrixMarket matrix coordinate real general\n2 2 2\n1 1 3.0\n2 1 -1.5\n";
    /// let a = stridor_linalg::matrix_market::parse("k.mtx", file, 0).unwrap();
    /// assert_eq!(a.one_triangle(), Some(("lower", 1)));
    /// ```
    pub fn one_triangle(&self) -> Option<(&'static str, usize)> {
        one_triangle(&self.re, self.im.as_ref())
    }
}

/// [`MarketMatrix::one_triangle`] of Re A and Im A.
pub fn one_triangle(re: &SparseMatrix, im: Option<&SparseMatrix>) -> Option<(&'static str, usize)> {
    let n = re.ncols();
    if re.nrows() != n {
        return None;
    }
    let mut counts = [0, 0];
    for j in 0..n {
        let im = im.map(|im| im.val_of_col(j));
        for (k, (i, value)) in re.row_idx_of_col(j).zip(re.val_of_col(j)).enumerate() {
            let holds = *value != 0.0 || im.is_some_and(|im| im[k] != 0.0);
            if holds && i != j {
                counts[usize::from(i < j)] += 1;
            }
        }
    }
    match counts {
        [lower, 0] if lower > 0 => Some(("lower", lower)),
        [0, upper] if upper > 0 => Some(("upper", upper)),
        _ => None,
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Symmetry {
    General,
    Symmetric,
    Hermitian,
    Skew,
}

/// Header: the first line of the file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Header {
    pub coordinate: bool,
    pub complex: bool,
    pub symmetry: Symmetry,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub row: u32,
    pub column: u32,
    pub value: c64,
}

/// Reads the file at `path`. A matrix of `known` columns, the number that another file of the same system confirms (else 0),
/// may have as many empty ones as it likes.
///
/// # Errors
/// [`Error::Input`] with every fault found: no such file, a header that is none, a `pattern` without values, sizes
/// beyond the file, entries outside the matrix or the triangle, numbers that are none or not finite, entries missing.
pub fn read(path: &Path, known: usize) -> Result<MarketMatrix> {
    let name = path.display().to_string();
    parse(&name, &read_bytes(path, "a MatrixMarket file")?, known)
}

/// Reads the bytes of a file that faults call `name`; `known` is that of [`read`].
///
/// # Errors
/// Those of [`read`].
///
/// ```
/// let file = b"%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 3.0\n2 1 -1.5\n";
/// let a = stridor_linalg::matrix_market::parse("k.mtx", file, 0).unwrap();
/// assert_eq!((a.re[(0, 0)], a.re[(0, 1)], a.re[(1, 0)]), (3.0, -1.5, -1.5));
/// ```
pub fn parse(name: &str, bytes: &[u8], known: usize) -> Result<MarketMatrix> {
    let bytes = &*plain(bytes);
    let mut lines = Lines::of(bytes);
    let header = read_header(name, &mut lines)?;
    let (line, sizes) = loop {
        match lines.next() {
            Some(line) if is_comment(line) => {}
            line => break (lines.number, line.unwrap_or_default()),
        }
    };
    let count = if header.coordinate { 3 } else { 2 };
    let (numbers, surplus) = whole_numbers(sizes, count);
    let refused = |found: String, expected: &str| {
        Err(Error::input(Fault::new(format!("{name}:{}", line.max(1)), found, expected)))
    };
    if numbers.len() < count || surplus {
        let expected =
            if header.coordinate { "rows, columns and the number of entries" } else { "rows and columns" };
        return refused(format!("`{}`", shown(sizes)), expected);
    }
    let (rows, columns) = (numbers[0], numbers[1]);
    if rows.max(columns) > LARGEST || rows.min(columns) == 0 {
        return refused(
            format!("{rows} rows and {columns} columns"),
            &format!("between 1 and {LARGEST} of each"),
        );
    }
    if header.symmetry != Symmetry::General && rows != columns {
        return refused(
            format!("{rows} rows and {columns} columns"),
            "as many rows as columns, for symmetry",
        );
    }
    let entries =
        if header.coordinate { numbers[2] } else { stored(header.symmetry, rows).unwrap_or(rows * columns) };
    // The shortest entry and its line end: `1 1 0`, `1 1 0 0`, `0`, `0 0`.
    let shortest = if header.coordinate { 6 } else { 2 } + if header.complex { 2 } else { 0 };
    let left = bytes.len() - lines.at;
    if entries > (left + 1) / shortest {
        return refused(
            format!("{entries} entries in the {left} bytes that follow"),
            "as many entries as the file holds",
        );
    }
    if columns != known && columns > entries + EMPTY {
        return refused(
            format!("{columns} columns for {entries} entries"),
            &format!("at most {EMPTY} columns more than entries"),
        );
    }
    let entries = read_entries(name, &lines, header, [rows, columns], entries)?;
    Ok(compress(&entries, header, rows, columns))
}

/// The entries of one triangle of an array file, column by column.
fn stored(symmetry: Symmetry, n: usize) -> Option<usize> {
    match symmetry {
        Symmetry::General => None,
        Symmetry::Symmetric | Symmetry::Hermitian => Some(n * (n + 1) / 2),
        Symmetry::Skew => Some(n * (n - 1) / 2),
    }
}

pub(super) struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    pub number: usize,
}

impl<'a> Lines<'a> {
    pub fn of(bytes: &'a [u8]) -> Self {
        Lines { bytes, at: 0, number: 0 }
    }

    pub fn next(&mut self) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        if rest.is_empty() {
            return None;
        }
        let length = rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
        self.at += (length + 1).min(rest.len());
        self.number += 1;
        Some(&rest[..length])
    }
}

fn is_comment(line: &[u8]) -> bool {
    line.iter().find(|b| !b.is_ascii_whitespace()).is_none_or(|b| *b == b'%')
}

/// The beginning of a line, for a fault.
pub(super) fn shown(line: &[u8]) -> String {
    let text = String::from_utf8_lossy(line);
    text.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(60).collect()
}

fn read_header(name: &str, lines: &mut Lines<'_>) -> Result<Header> {
    let first = lines.next().unwrap_or_default();
    let text = String::from_utf8_lossy(first).to_lowercase();
    let words: Vec<&str> = text.split_whitespace().collect();
    let fault = |expected: &str, help: &str| {
        Err(Error::input(
            Fault::new(format!("{name}:1"), format!("`{}`", shown(first)), expected).with_help(help),
        ))
    };
    let &[banner, object, format, field, symmetry] = words.as_slice() else {
        return fault("%%MatrixMarket matrix coordinate real general, or one of its kin", "");
    };
    if banner != "%%matrixmarket" || object != "matrix" {
        return fault("%%MatrixMarket matrix …", "");
    }
    let coordinate = match format {
        "coordinate" => true,
        "array" => false,
        _ => return fault("`coordinate` or `array`", ""),
    };
    let complex = match field {
        "real" | "double" | "integer" | "unsigned-integer" => false,
        "complex" => true,
        "pattern" => return fault("numbers: real, integer or complex", "A pattern has no values"),
        _ => return fault("real, integer or complex", ""),
    };
    let symmetry = match symmetry {
        "general" => Symmetry::General,
        "symmetric" => Symmetry::Symmetric,
        "hermitian" => Symmetry::Hermitian,
        "skew-symmetric" => Symmetry::Skew,
        _ => return fault("general, symmetric, hermitian or skew-symmetric", ""),
    };
    Ok(Header { coordinate, complex, symmetry })
}

/// Up to `most` whole numbers, and whether anything else stands in the line.
fn whole_numbers(line: &[u8], most: usize) -> (Vec<usize>, bool) {
    let mut words = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty());
    let numbers: Vec<usize> = words.by_ref().take(most).map_while(whole_number).collect();
    (numbers, words.next().is_some())
}

fn whole_number(word: &[u8]) -> Option<usize> {
    let word = word.strip_prefix(b"+").unwrap_or(word);
    if word.is_empty() || word.len() > 18 {
        return None;
    }
    word.iter().try_fold(0, |sum, b| b.is_ascii_digit().then(|| 10 * sum + usize::from(b - b'0')))
}

pub(super) fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok().and_then(numbers::parse)
}

/// A fault of one line of a piece: the line within the piece, what was found, what is expected.
type LineFault = (usize, String, String);

/// Parses pieces of the file side by side and joins them in their order.
fn read_entries(
    name: &str,
    lines: &Lines<'_>,
    header: Header,
    size: [usize; 2],
    expected: usize,
) -> Result<Vec<Entry>> {
    let mut pieces = Vec::new();
    let mut rest = &lines.bytes[lines.at..];
    while !rest.is_empty() {
        let end = rest.iter().skip(PIECE).position(|b| *b == b'\n').map_or(rest.len(), |p| PIECE + p + 1);
        let (piece, after) = rest.split_at(end);
        pieces.push(piece);
        rest = after;
    }
    let parsed: Vec<(Vec<Entry>, Vec<LineFault>, usize)> =
        pieces.par_iter().map(|piece| parse_piece(piece, header, size)).collect();
    let mut faults = Faults::new();
    let (mut first_line, mut found, mut untold) = (lines.number + 1, 0, 0);
    let mut entries = Vec::with_capacity(expected);
    for (part, wrong, length) in &parsed {
        for (line, what, wanted) in wrong {
            if faults.0.len() < TOLD {
                faults.push(Fault::new(format!("{name}:{}", first_line + line), what, wanted));
            } else {
                untold += 1;
            }
        }
        found += part.len() + wrong.len();
        first_line += length;
        entries.extend_from_slice(part);
    }
    if untold > 0 {
        faults.push(Fault::new(name, format!("{untold} more such lines"), "none"));
    }
    if found != expected {
        let what = if found < expected { "the file ends after" } else { "the file goes on to" };
        let place = format!("{name}:{}", (first_line - 1).max(1));
        faults.push(Fault::new(place, format!("{what} {found} entries"), format!("{expected} entries")));
    }
    if !header.coordinate {
        place_array(&mut entries, header.symmetry, size[0]);
    }
    faults.into_result(entries)
}

/// The entries of whole lines, their faults, and the number of lines.
fn parse_piece(piece: &[u8], header: Header, size: [usize; 2]) -> (Vec<Entry>, Vec<LineFault>, usize) {
    let (mut entries, mut faults) = (Vec::with_capacity(piece.len() / 16), Vec::new());
    let mut lines = Lines::of(piece);
    while let Some(line) = lines.next() {
        if is_comment(line) {
            continue;
        }
        match parse_entry(line, header, size) {
            Ok(entry) => entries.push(entry),
            Err((found, expected)) => faults.push((lines.number - 1, found, expected)),
        }
    }
    (entries, faults, lines.number)
}

fn parse_entry(
    line: &[u8],
    header: Header,
    [rows, columns]: [usize; 2],
) -> std::result::Result<Entry, (String, String)> {
    let mut words = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty());
    let form = || match (header.coordinate, header.complex) {
        (true, false) => "row, column, value",
        (true, true) => "row, column, real part, imaginary part",
        (false, false) => "a value",
        (false, true) => "real part, imaginary part",
    };
    let malformed = || (format!("`{}`", shown(line)), form().to_string());
    let (mut row, mut column) = (1, 1);
    if header.coordinate {
        row = words.next().and_then(whole_number).ok_or_else(malformed)?;
        column = words.next().and_then(whole_number).ok_or_else(malformed)?;
    }
    let re = words.next().and_then(number).ok_or_else(malformed)?;
    let im = if header.complex { words.next().and_then(number).ok_or_else(malformed)? } else { 0.0 };
    if words.next().is_some() {
        return Err(malformed());
    }
    if !(re.is_finite() && im.is_finite()) {
        return Err((format!("`{}`", shown(line)), "finite numbers".into()));
    }
    if row == 0 || row > rows || column == 0 || column > columns {
        return Err((
            format!("row {row}, column {column}"),
            format!("rows from 1 to {rows} and columns from 1 to {columns}"),
        ));
    }
    if header.coordinate {
        let wrong = match header.symmetry {
            Symmetry::General => None,
            _ if row < column => Some("the lower triangle (row ≥ column) alone"),
            Symmetry::Skew if row == column && re != 0.0 => Some("a zero diagonal, as it is skew"),
            Symmetry::Hermitian if row == column && im != 0.0 => Some("a real diagonal, as it is hermitian"),
            _ => None,
        };
        if let Some(expected) = wrong {
            return Err((format!("an entry in row {row}, column {column}"), expected.into()));
        }
    }
    Ok(Entry { row: (row - 1) as u32, column: (column - 1) as u32, value: c64::new(re, im) })
}

/// Gives the values of an array file their places, column by column.
fn place_array(entries: &mut [Entry], symmetry: Symmetry, rows: usize) {
    let (mut row, mut column) = (if symmetry == Symmetry::Skew { 1 } else { 0 }, 0);
    for entry in entries {
        (entry.row, entry.column) = (row as u32, column as u32);
        row += 1;
        if row == rows {
            column += 1;
            row = match symmetry {
                Symmetry::General => 0,
                Symmetry::Skew => column + 1,
                _ => column,
            };
        }
    }
}

/// Compressed columns of the whole matrix; entries of one place are added in the order of the file.
pub(super) fn compress(entries: &[Entry], header: Header, rows: usize, columns: usize) -> MarketMatrix {
    let mirrored = |e: &Entry| header.symmetry != Symmetry::General && e.row != e.column;
    let mut starts = vec![0usize; columns + 1];
    for e in entries {
        starts[e.column as usize + 1] += 1;
        if mirrored(e) {
            starts[e.row as usize + 1] += 1;
        }
    }
    for j in 0..columns {
        starts[j + 1] += starts[j];
    }
    let mut free = starts.clone();
    let mut slots = vec![(0u32, c64::new(0.0, 0.0)); starts[columns]];
    let mut put = |row: u32, column: u32, value: c64| {
        slots[free[column as usize]] = (row, value);
        free[column as usize] += 1;
    };
    for e in entries {
        put(e.row, e.column, e.value);
        if mirrored(e) {
            let value = match header.symmetry {
                Symmetry::Hermitian => e.value.conj(),
                Symmetry::Skew => -e.value,
                _ => e.value,
            };
            put(e.column, e.row, value);
        }
    }
    let mut whole = Vec::with_capacity(columns + 1);
    whole.push(0);
    let (mut row_of, mut values): (Vec<Index>, Vec<c64>) =
        (Vec::with_capacity(slots.len()), Vec::with_capacity(slots.len()));
    for j in 0..columns {
        let column = &mut slots[starts[j]..starts[j + 1]];
        column.sort_by_key(|(row, _)| *row);
        let begin = row_of.len();
        for (row, value) in column.iter() {
            if row_of.len() > begin && row_of.last() == Some(row) {
                *values.last_mut().expect("as long as the rows") += *value;
            } else {
                row_of.push(*row);
                values.push(*value);
            }
        }
        whole.push(row_of.len());
    }
    let part = |rows_of: Vec<Index>, part: fn(&c64) -> f64| {
        compressed(rows, &whole, rows_of, values.iter().map(part).collect())
    };
    let im = header.complex.then(|| part(row_of.clone(), |v| v.im));
    MarketMatrix { re: part(row_of, |v| v.re), im }
}

/// The text of a MatrixMarket file that reads back as the same numbers, bit for bit; `symmetric` when both parts are,
/// to the last bit. `comment` is one line.
///
/// # Panics
/// When the imaginary part has another pattern than the real one.
pub fn to_text(re: &SparseMatrix, im: Option<&SparseMatrix>, comment: &str) -> String {
    assert!(
        im.is_none_or(|im| im.col_ptr() == re.col_ptr() && im.row_idx() == re.row_idx()),
        "the parts of a complex matrix are on one pattern"
    );
    let symmetric = is_symmetric(re) && im.is_none_or(is_symmetric);
    let field = if im.is_some() { "complex" } else { "real" };
    let kind = if symmetric { "symmetric" } else { "general" };
    let wanted = |row: usize, column: usize| !symmetric || row >= column;
    let mut body = String::new();
    let mut count = 0;
    for j in 0..re.ncols() {
        for (slot, i) in re.col_range(j).zip(re.row_idx_of_col(j)) {
            if wanted(i, j) {
                count += 1;
                let _ = write!(body, "{} {} {:e}", i + 1, j + 1, re.val()[slot]);
                if let Some(im) = im {
                    let _ = write!(body, " {:e}", im.val()[slot]);
                }
                body.push('\n');
            }
        }
    }
    let comment = comment.replace('\n', " ");
    format!(
        "%%MatrixMarket matrix coordinate {field} {kind}\n% {comment}\n{} {} {count}\n{body}",
        re.nrows(),
        re.ncols()
    )
}

/// Whether A = Aᵀ to the last bit, pattern and values.
fn is_symmetric(a: &SparseMatrix) -> bool {
    if a.nrows() != a.ncols() {
        return false;
    }
    match a.transpose().to_col_major() {
        Ok(t) => t.col_ptr() == a.col_ptr() && t.row_idx() == a.row_idx() && t.val() == a.val(),
        Err(_) => false,
    }
}

#[cfg(test)]
mod tests;
