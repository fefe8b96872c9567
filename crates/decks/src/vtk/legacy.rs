//! Legacy files: keywords, each with its data behind it, as text or as bytes that begin with the largest.

use super::data::{Numbers, Unpacker};
use super::grid::{Array, Format, Grid, Piece, Scalar, ScalarKind, Unread};
use crate::deck::{Deck, Place};
use crate::text::Files;
use std::borrow::Cow;

/// Types by their names, with their bytes.
const TYPES: &[(&str, ScalarKind, usize)] = &[
    ("char", ScalarKind::Signed, 1),
    ("signed_char", ScalarKind::Signed, 1),
    ("unsigned_char", ScalarKind::Unsigned, 1),
    ("short", ScalarKind::Signed, 2),
    ("unsigned_short", ScalarKind::Unsigned, 2),
    ("int", ScalarKind::Signed, 4),
    ("unsigned_int", ScalarKind::Unsigned, 4),
    // Files have it as `int`.
    ("vtkidtype", ScalarKind::Signed, 4),
    ("long", ScalarKind::Signed, 8),
    ("unsigned_long", ScalarKind::Unsigned, 8),
    ("vtktypeint64", ScalarKind::Signed, 8),
    ("vtktypeuint64", ScalarKind::Unsigned, 8),
    ("float", ScalarKind::Real, 4),
    ("double", ScalarKind::Real, 8),
];

/// Reads a file; none where it is none of an unstructured grid, or ends early, which is a fault.
pub(super) fn read<'a>(bytes: &'a [u8], file: u32, files: &mut Files, deck: &mut Deck) -> Option<Grid<'a>> {
    let mut reader = Legacy {
        bytes,
        at: 0,
        line: 0,
        next_line: 1,
        binary: false,
        file,
        files,
        deck,
        piece: Piece::default(),
        of: Of::Grid,
        count: 0,
    };
    reader.read()?;
    Some(Grid { big_endian: true, header: 4, pieces: vec![reader.piece], ..Grid::default() })
}

/// What data are of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Of {
    Grid,
    Points,
    Cells,
}

struct Legacy<'a, 'f> {
    bytes: &'a [u8],
    at: usize,
    /// The line that was read last, and that at `at`.
    line: u32,
    next_line: u32,
    binary: bool,
    file: u32,
    files: &'f mut Files,
    deck: &'f mut Deck,
    piece: Piece<'a>,
    of: Of,
    /// How many points or cells have data.
    count: usize,
}

impl<'a> Legacy<'a, '_> {
    fn place(&self) -> Place {
        Place { file: self.file, line: self.line }
    }

    /// Notes a fault, behind which nothing is read.
    fn fault<T>(&mut self, found: impl Into<String>, expected: &str) -> Option<T> {
        self.files.fault(self.place(), found, expected);
        None
    }

    /// The words of the next line that has any; blocks of METADATA are passed over.
    fn words(&mut self) -> Option<Vec<Cow<'a, str>>> {
        let mut within_metadata = false;
        while self.at < self.bytes.len() {
            let rest = &self.bytes[self.at..];
            let end = rest.iter().position(|byte| *byte == b'\n').map_or(rest.len(), |end| end + 1);
            let line = rest[..end].trim_ascii();
            self.pass(end);
            self.line = self.next_line - 1;
            within_metadata &= !line.is_empty();
            if line.eq_ignore_ascii_case(b"METADATA") {
                within_metadata = true;
            } else if !line.is_empty() && !within_metadata {
                let words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
                return Some(words.map(String::from_utf8_lossy).collect());
            }
        }
        None
    }

    fn pass(&mut self, count: usize) {
        let passed = &self.bytes[self.at..self.at + count];
        self.next_line += passed.iter().filter(|byte| **byte == b'\n').count() as u32;
        self.at += count;
    }

    fn read(&mut self) -> Option<()> {
        self.words();
        // The title may be empty.
        let end = self.bytes[self.at..].iter().position(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        self.deck.title = String::from_utf8_lossy(&self.bytes[self.at..self.at + end]).trim().to_string();
        self.pass(end);
        let form = self.words().unwrap_or_default();
        self.binary = match form.first().map(|word| word.to_uppercase()).as_deref() {
            Some("ASCII") => false,
            Some("BINARY") => true,
            other => return self.fault(format!("`{}`", other.unwrap_or_default()), "ASCII or BINARY"),
        };
        while let Some(words) = self.words() {
            self.keyword(&words)?;
        }
        if self.piece.n_points == 0 {
            return self.fault("a file without POINTS", "an unstructured grid");
        }
        Some(())
    }

    fn keyword(&mut self, words: &[Cow<'a, str>]) -> Option<()> {
        let word = |k: usize| words.get(k).map_or("", |word| word);
        match words[0].to_uppercase().as_str() {
            "DATASET" if word(1).eq_ignore_ascii_case("UNSTRUCTURED_GRID") => {}
            "DATASET" => return self.fault(format!("DATASET {}", word(1)), "UNSTRUCTURED_GRID"),
            "POINTS" => {
                self.piece.n_points = self.number(word(1))?;
                self.piece.place = self.place();
                let array = self.array("Points", word(2), 3, self.piece.n_points)?;
                self.piece.arrays.push(array);
            }
            "CELLS" => self.cells(word(1), word(2))?,
            "CELL_TYPES" => {
                let count = self.number(word(1))?;
                let array = self.array("types", "int", 1, count)?;
                self.piece.arrays.push(array);
            }
            "CELL_DATA" | "POINT_DATA" => {
                self.of = if words[0].eq_ignore_ascii_case("CELL_DATA") { Of::Cells } else { Of::Points };
                self.count = self.number(word(1))?;
            }
            "SCALARS" => {
                let components = if word(3).is_empty() { 1 } else { self.number(word(3))? };
                let before = (self.at, self.line, self.next_line);
                if !self.words().is_some_and(|words| words[0].eq_ignore_ascii_case("LOOKUP_TABLE")) {
                    (self.at, self.line, self.next_line) = before;
                }
                self.data(word(1), word(2), components, self.count)?;
            }
            "VECTORS" | "NORMALS" => self.data(word(1), word(2), 3, self.count)?,
            "TENSORS" => self.data(word(1), word(2), 9, self.count)?,
            "TENSORS6" => self.data(word(1), word(2), 6, self.count)?,
            "GLOBAL_IDS" | "PEDIGREE_IDS" => self.data(word(1), word(2), 1, self.count)?,
            "TEXTURE_COORDINATES" => {
                let components = self.number(word(2))?;
                self.data(word(1), word(3), components, self.count)?;
            }
            "COLOR_SCALARS" | "LOOKUP_TABLE" => {
                let (colours, number) =
                    (words[0].eq_ignore_ascii_case("COLOR_SCALARS"), self.number(word(2))?);
                let scalar = if self.binary { "unsigned_char" } else { "float" };
                let [components, count] = if colours { [number, self.count] } else { [4, number] };
                self.data(word(1), scalar, components, count)?;
            }
            "FIELD" => {
                for _ in 0..self.number(word(2))? {
                    let Some(array) = self.words() else {
                        return self.fault("a FIELD that ends early", "its arrays");
                    };
                    let word = |k: usize| array.get(k).map_or("", |word| word);
                    let (components, count) = (self.number(word(1))?, self.number(word(2))?);
                    self.data(word(0), word(3), components, count)?;
                }
            }
            other => {
                return self.fault(
                    format!("`{}`", other.chars().take(30).collect::<String>()),
                    "a keyword of unstructured grids, such as POINTS, CELLS, CELL_DATA, SCALARS, FIELD",
                );
            }
        }
        Some(())
    }

    fn number(&mut self, word: &str) -> Option<usize> {
        let number = word.parse().ok();
        number.or_else(|| {
            self.fault(format!("`{}`", word.chars().take(30).collect::<String>()), "a whole number")
        })
    }

    /// The array of so many numbers that stands behind a line.
    fn array(&mut self, name: &str, scalar: &str, components: usize, count: usize) -> Option<Array<'a>> {
        let lower = scalar.to_lowercase();
        let scalar = TYPES.iter().find(|(own, ..)| *own == lower);
        let scalar = scalar.map(|(_, kind, size)| Scalar { kind: *kind, size: *size });
        // Text has words of any kind.
        let Some(size) = scalar.map(|scalar| scalar.size).or((!self.binary).then_some(1)) else {
            return self.fault(format!("numbers of type `{lower}`"), "a type such as int, float or double");
        };
        let place = self.place();
        let rest = &self.bytes[self.at..];
        let wanted = components.checked_mul(count);
        let length = if self.binary {
            wanted.and_then(|wanted| wanted.checked_mul(size)).filter(|length| *length <= rest.len())
        } else {
            wanted.and_then(|wanted| end_of_words(rest, wanted))
        };
        let Some(length) = length else {
            return self.fault(format!("`{name}`, whose data end early"), "as many numbers as it says");
        };
        self.pass(length);
        let format = if self.binary { Format::Bytes } else { Format::Text };
        Some(Array {
            name: name.into(),
            scalar,
            components,
            format,
            text: Cow::Borrowed(&rest[..length]),
            place,
        })
    }

    /// Data of points, cells or the grid.
    fn data(&mut self, name: &str, scalar: &str, components: usize, count: usize) -> Option<()> {
        let array = self.array(name, scalar, components, count)?;
        match self.of {
            Of::Cells => self.piece.cell_data.push(array),
            Of::Points => Unread::Points.note(name, array.place, self.deck),
            Of::Grid => Unread::Grid.note(name, array.place, self.deck),
        }
        Some(())
    }

    /// CELLS: of each cell how many points it has and these; or, from version 5 on, OFFSETS, of which the first is zero, and CONNECTIVITY.
    fn cells(&mut self, count: &str, size: &str) -> Option<()> {
        let (count, size) = (self.number(count)?, self.number(size)?);
        let before = (self.at, self.line, self.next_line);
        let words = self.words().unwrap_or_default();
        let expected = "numbers of points, and these";
        let (mut offsets, mut connectivity) = (Vec::new(), Vec::new());
        if words.first().is_some_and(|word| word.eq_ignore_ascii_case("OFFSETS")) {
            let array = self.array("offsets", words.get(1).map_or("", |word| word), 1, count)?;
            offsets = self.whole(&array)?;
            if offsets.first().is_some_and(|first| *first != 0) {
                return self.fault("OFFSETS that do not begin with 0", "offsets from 0 on");
            }
            offsets.drain(..offsets.len().min(1));
            let words = self.words().unwrap_or_default();
            let scalar = words.get(1).map_or("", |word| word);
            let array = self.array("connectivity", scalar, 1, size)?;
            connectivity = self.whole(&array)?;
        } else {
            (self.at, self.line, self.next_line) = before;
            let array = self.array("connectivity", "int", 1, size)?;
            let numbers = self.whole(&array)?;
            let mut rest = &numbers[..];
            while let Some((points, behind)) = rest.split_first() {
                let points = usize::try_from(*points).ok();
                let Some((own, behind)) = points.and_then(|points| behind.split_at_checked(points)) else {
                    return self.fault(format!("cell {}, whose points end early", offsets.len()), expected);
                };
                connectivity.extend(own);
                offsets.push(connectivity.len() as i64);
                rest = behind;
            }
            if offsets.len() != count {
                return self
                    .fault(format!("the points of {} cells", offsets.len()), &format!("{count} cells"));
            }
        }
        self.piece.n_cells = offsets.len();
        for (name, numbers) in [("offsets", offsets), ("connectivity", connectivity)] {
            self.piece.arrays.push(Array {
                name: name.into(),
                scalar: Some(Scalar { kind: ScalarKind::Signed, size: 8 }),
                components: 1,
                format: Format::Bytes,
                text: Cow::Owned(numbers.into_iter().flat_map(i64::to_be_bytes).collect()),
                place: self.place(),
            });
        }
        Some(())
    }

    fn whole(&mut self, array: &Array<'_>) -> Option<Vec<i64>> {
        let grid = Grid { big_endian: true, ..Grid::default() };
        match Unpacker::new(&grid, self.bytes.len()).numbers(array) {
            Ok(Numbers::Whole(all)) => Some(all),
            Ok(Numbers::Real(_)) => self.fault(format!("real numbers in `{}`", array.name), "whole numbers"),
            Err(found) => self.fault(format!("`{}`: {found}", array.name), "whole numbers"),
        }
    }
}

/// The byte behind the first `count` words.
fn end_of_words(bytes: &[u8], count: usize) -> Option<usize> {
    let (mut words, mut within) = (0, false);
    for (at, byte) in bytes.iter().enumerate() {
        let blank = byte.is_ascii_whitespace();
        if within && blank {
            words += 1;
        }
        within = !blank;
        if words == count {
            return Some(at);
        }
    }
    (words + usize::from(within) == count).then_some(bytes.len())
}
