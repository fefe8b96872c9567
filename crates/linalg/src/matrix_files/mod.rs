//! Matrices as programs write them: a row of the table a format, which is known by how a file begins.
//!
//! | format | rows | numbers |
//! |---|---|---|
//! | MatrixMarket ([`super::matrix_market`]) | by number | real, complex |
//! | Abaqus, \*MATRIX GENERATE with \*MATRIX OUTPUT, `node,dof, node,dof, value` | by node and degree of freedom | real |
//! | NASTRAN, DMIG in small, large and free fields | by grid point and component | real, complex |
//! | NASTRAN, OUTPUT4 as text and binary | by number | real, complex |
//!
//! A symmetric matrix may be half of one: its file says so by a form or a type. Where an Abaqus file does not, the mirror images are added if no
//! entry off the diagonal has one.

mod abaqus;
mod dmig;
mod found;
mod op4;

use super::matrix_market;
use found::File;
pub use found::{Found, Label, Labelled};
use std::borrow::Cow;
use std::io::Read;
use std::path::Path;
use stridor_base::error::read::{plain, read_bytes};
use stridor_base::error::{Error, Fault, Result};

/// A row of the table.
struct Row {
    /// Whether a file is of this format.
    is: fn(&[u8]) -> bool,
    /// How it begins.
    begins: &'static str,
    /// Whether its rows are of nodes.
    labelled: bool,
    read: fn(&File) -> Result<Found>,
}

const FORMATS: &[Row] = &[
    Row {
        is: |bytes| bytes.trim_ascii_start().starts_with(b"%%"),
        begins: "`%%MatrixMarket matrix coordinate real symmetric` (MatrixMarket)",
        labelled: false,
        read: |file| matrix_market::parse(file.name, file.bytes, file.known).map(Found::Whole),
    },
    Row {
        is: abaqus::is,
        begins: "`*MATRIX INPUT` or `1,1, 1,1, 4.0e+00`: node, degree of freedom, node, degree of freedom, value (Abaqus)",
        labelled: true,
        read: abaqus::read,
    },
    Row {
        is: dmig::is,
        begins: "cards `DMIG    KAAX    0       6       2` (NASTRAN DMIG)",
        labelled: true,
        read: dmig::read,
    },
    Row {
        is: op4::is,
        begins: "columns, rows, form, kind, name and form of numbers `1P,3E23.16`, or a binary record of 24 bytes (NASTRAN OUTPUT4)",
        labelled: false,
        read: op4::read,
    },
];

/// Reads the matrix in the file at `path`; of several the one whose name begins with `initial`. `known` is as in [`matrix_market::read`].
///
/// # Errors
/// Every fault of the file with its line.
pub fn read(path: &Path, initial: char, known: usize) -> Result<Found> {
    let bytes = read_bytes(path, "a file with a matrix")?;
    parse(&path.display().to_string(), &bytes, initial, known)
}

/// Reads the bytes of a file that faults call `name`.
///
/// # Errors
/// Those of [`read`].
///
/// ```
/// use stridor_linalg::matrix_files::{Found, parse};
/// let file = b"1,1, 1,1, 3.0\n2,1, 1,1, -1.5\n";
/// let Ok(Found::Labelled(k)) = parse("k.mtx", file, 'K', 0) else { unreachable!() };
/// let k = k.numbered(&k.labels().into_iter().collect::<Vec<_>>()).unwrap();
/// assert_eq!((k.re[(0, 0)], k.re[(0, 1)], k.re[(1, 0)]), (3.0, -1.5, -1.5));
/// ```
pub fn parse(name: &str, bytes: &[u8], initial: char, known: usize) -> Result<Found> {
    let bytes = &*text(bytes);
    let Some(row) = row_of(bytes) else {
        let first = bytes.trim_ascii_start().split(|byte| *byte == b'\n').next().unwrap_or_default();
        let found =
            if first.is_empty() { "no text".into() } else { format!("`{}`", matrix_market::shown(first)) };
        let kinds: Vec<&str> = FORMATS.iter().map(|row| row.begins).collect();
        let fault = Fault::new(format!("{name}:1"), found, "the begin of one of four kinds of files");
        return Err(Error::input(fault.with_help(format!("They begin with {}", kinds.join("; ")))));
    };
    (row.read)(&File { name, bytes, initial, known })
}

/// The bytes of a binary file as they are, of another one as plain text.
fn text(bytes: &[u8]) -> Cow<'_, [u8]> {
    if op4::is_binary(bytes) { Cow::Borrowed(bytes) } else { plain(bytes) }
}

fn row_of(bytes: &[u8]) -> Option<&'static Row> {
    FORMATS.iter().find(|row| (row.is)(bytes))
}

/// Reads the matrix in the file at `path` as [`read`] does, if its rows are of nodes; none of another file, or one that cannot be read.
///
/// # Errors
/// Every fault of the file with its line.
pub fn read_labelled(path: &Path, initial: char) -> Result<Option<Labelled>> {
    // MatrixMarket's, the largest of all, are known by their first characters.
    let mut first = [0; 2];
    let begins = std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut first));
    if begins.is_ok() && first == *b"%%" {
        return Ok(None);
    }
    let Ok(bytes) = read_bytes(path, "a file with a matrix") else { return Ok(None) };
    let bytes = &*text(&bytes);
    let Some(row) = row_of(bytes).filter(|row| row.labelled) else { return Ok(None) };
    let name = path.display().to_string();
    match (row.read)(&File { name: &name, bytes, initial, known: 0 })? {
        Found::Labelled(matrix) => Ok(Some(matrix)),
        Found::Whole(_) => Ok(None),
    }
}

#[cfg(test)]
mod tests;
