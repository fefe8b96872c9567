//! A grid as its file has it: where the data of its arrays are.

use crate::deck::{Deck, Place};
use crate::ledger::Weight;
use std::borrow::Cow;

/// A file.
#[derive(Debug, Default)]
pub(super) struct Grid<'a> {
    pub big_endian: bool,
    /// Bytes of a number in front of data: 4 or 8.
    pub header: usize,
    pub packed: bool,
    pub pieces: Vec<Piece<'a>>,
    /// What stands behind `_` of `AppendedData`, to the end of the file, and whether it is base64.
    pub appended: Option<(&'a [u8], bool)>,
}

/// A piece of the grid.
#[derive(Debug, Default)]
pub(super) struct Piece<'a> {
    pub n_points: usize,
    pub n_cells: usize,
    /// `Points` and `Cells`.
    pub arrays: Vec<Array<'a>>,
    /// `CellData`.
    pub cell_data: Vec<Array<'a>>,
    pub place: Place,
}

/// An array.
#[derive(Debug, Clone)]
pub(super) struct Array<'a> {
    pub name: String,
    /// The type of its numbers, if it is one that there is.
    pub scalar: Option<Scalar>,
    pub components: usize,
    pub format: Format,
    /// What stands in it.
    pub text: Cow<'a, [u8]>,
    pub place: Place,
}

/// What numbers are of that are not read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unread {
    Points,
    Grid,
}

impl Unread {
    /// Lists them under their name.
    pub fn note(self, name: &str, place: Place, deck: &mut Deck) {
        let (what, why) = match self {
            Unread::Points => ("PointData", "numbers of points are not read"),
            Unread::Grid => ("FieldData", "numbers of the whole grid are not read"),
        };
        deck.ledger.note(Weight::Nothing, format!("{what} {name}"), why, place);
    }
}

/// Where the data of an array are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Text,
    /// Bytes as they stand.
    Bytes,
    Base64,
    /// At this byte of the appended data.
    Appended(usize),
}

/// The type of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Scalar {
    pub kind: ScalarKind,
    /// Its bytes.
    pub size: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ScalarKind {
    Signed,
    Unsigned,
    Real,
}

impl Scalar {
    /// A type of XML files by its name, such as `UInt8`.
    pub fn named(name: &str) -> Option<Scalar> {
        let (kind, bits) =
            [("UInt", ScalarKind::Unsigned), ("Int", ScalarKind::Signed), ("Float", ScalarKind::Real)]
                .into_iter()
                .find_map(|(word, kind)| Some((kind, name.strip_prefix(word)?.parse::<usize>().ok()?)))?;
        let sizes: &[usize] = if kind == ScalarKind::Real { &[32, 64] } else { &[8, 16, 32, 64] };
        sizes.contains(&bits).then_some(Scalar { kind, size: bits / 8 })
    }
}
