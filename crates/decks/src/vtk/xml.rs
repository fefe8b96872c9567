//! The elements of a file, and where the data of its arrays are.

use super::grid::{Array, Format, Grid, Piece, Scalar, Unread};
use crate::deck::{Deck, Place};
use crate::text::Files;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::borrow::Cow;

/// Reads the elements; none where the file is none of an unstructured grid, which is a fault.
pub(super) fn read<'a>(bytes: &'a [u8], file: u32, files: &mut Files, deck: &mut Deck) -> Option<Grid<'a>> {
    let mut elements = Elements {
        file,
        files,
        deck,
        grid: Grid { header: 4, ..Grid::default() },
        seen: false,
        unreadable: false,
        section: Section::Other,
        open: None,
        line: 1,
        at: 0,
    };
    let sound = elements.read(bytes);
    let (seen, unreadable, place) = (elements.seen, elements.unreadable, elements.place());
    let grid = elements.grid;
    if sound && !seen {
        let help = "Other files of VTK become one in ParaView";
        files.fault_with_help(place, "a file without a grid", "an unstructured grid of VTK (.vtu)", help);
    }
    (sound && seen && !unreadable).then_some(grid)
}

/// Where arrays stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Section {
    Mesh,
    CellData,
    PointData,
    FieldData,
    Other,
}

struct Elements<'a, 'f> {
    file: u32,
    files: &'f mut Files,
    deck: &'f mut Deck,
    grid: Grid<'a>,
    /// Whether `UnstructuredGrid` has come.
    seen: bool,
    /// Whether no data can be read.
    unreadable: bool,
    section: Section,
    /// The array that is open.
    open: Option<Array<'a>>,
    line: u32,
    at: usize,
}

impl<'a> Elements<'a, '_> {
    fn place(&self) -> Place {
        Place { file: self.file, line: self.line }
    }

    /// Whether there are elements up to the end, or to appended data.
    fn read(&mut self, bytes: &'a [u8]) -> bool {
        let mut reader = Reader::from_reader(bytes);
        loop {
            let event = reader.read_event();
            let end =
                usize::try_from(reader.buffer_position()).map_or(bytes.len(), |end| end.min(bytes.len()));
            let event = match event {
                Ok(event) => event,
                Err(error) => {
                    let found = format!("what is no XML: {error}");
                    self.files.fault(self.place(), found, "an unstructured grid of VTK");
                    return false;
                }
            };
            match event {
                Event::Start(element) | Event::Empty(element)
                    if element.name().as_ref() == b"AppendedData" =>
                {
                    let encoded = attribute(&element, "encoding").is_none_or(|word| word != "raw");
                    let rest = bytes[end..].trim_ascii_start();
                    self.grid.appended = Some((rest.strip_prefix(b"_").unwrap_or(rest), encoded));
                    return true;
                }
                Event::Start(element) => self.begin(&element),
                Event::Empty(element) => {
                    self.begin(&element);
                    self.end(element.name().as_ref());
                }
                Event::End(element) => self.end(element.name().as_ref()),
                Event::Text(text) => self.text(text.into_inner()),
                Event::CData(text) => self.text(text.into_inner()),
                Event::Eof => return true,
                Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::DocType(_) => {}
            }
            self.line += bytes[self.at..end].iter().filter(|byte| **byte == b'\n').count() as u32;
            self.at = end;
        }
    }

    /// Text within an array that is read; that of elements within it, such as `InformationKey`, is no number and is a fault there.
    fn text(&mut self, text: Cow<'a, [u8]>) {
        let Some(open) = self.open.as_mut().filter(|_| !text.trim_ascii().is_empty()) else { return };
        if open.text.is_empty() {
            open.text = text;
        }
    }

    fn begin(&mut self, element: &BytesStart<'_>) {
        let word = |name: &str| attribute(element, name);
        let place = self.place();
        match element.name().as_ref() {
            b"VTKFile" => {
                self.grid.big_endian = word("byte_order").is_some_and(|word| word == "BigEndian");
                self.grid.header =
                    if word("header_type").is_some_and(|word| word == "UInt64") { 8 } else { 4 };
                self.grid.packed = match word("compressor") {
                    None => false,
                    Some(name) if name.is_empty() || name == "vtkZLibDataCompressor" => !name.is_empty(),
                    Some(name) => {
                        let help = "Write it again with the compressor zlib, or without one";
                        let expected = "no compressor, or vtkZLibDataCompressor";
                        self.files.fault_with_help(place, format!("compressor `{name}`"), expected, help);
                        self.unreadable = true;
                        true
                    }
                };
            }
            b"UnstructuredGrid" => self.seen = true,
            b"Piece" => {
                let mut count = |name: &str| {
                    let word = word(name).unwrap_or_default();
                    let count = word.trim().parse::<usize>().ok();
                    count.unwrap_or_else(|| {
                        self.files.fault(place, format!("{name} `{word}`"), "a whole number");
                        0
                    })
                };
                let (n_points, n_cells) = (count("NumberOfPoints"), count("NumberOfCells"));
                let piece = Piece { n_points, n_cells, arrays: Vec::new(), cell_data: Vec::new(), place };
                self.grid.pieces.push(piece);
            }
            b"Points" | b"Cells" => self.section = Section::Mesh,
            b"CellData" => self.section = Section::CellData,
            b"PointData" => self.section = Section::PointData,
            b"FieldData" => self.section = Section::FieldData,
            b"DataArray" | b"Array" => self.array(element),
            _ => {}
        }
    }

    fn array(&mut self, element: &BytesStart<'_>) {
        let place = self.place();
        let word = |name: &str| attribute(element, name);
        let name = word("Name").unwrap_or_default();
        match self.section {
            Section::PointData => return Unread::Points.note(&name, place, self.deck),
            Section::FieldData => return Unread::Grid.note(&name, place, self.deck),
            Section::Other => return,
            Section::Mesh | Section::CellData => {}
        }
        let format = match word("format").as_deref() {
            None | Some("ascii") => Format::Text,
            Some("binary") => Format::Base64,
            Some("appended") => {
                let word = word("offset").unwrap_or_default();
                Format::Appended(word.trim().parse().unwrap_or_else(|_| {
                    self.files.fault(place, format!("offset `{word}` of `{name}`"), "a whole number");
                    0
                }))
            }
            Some(other) => {
                let expected = "ascii, binary or appended";
                self.files.fault(place, format!("format `{other}` of `{name}`"), expected);
                return;
            }
        };
        let components = word("NumberOfComponents").and_then(|word| word.trim().parse().ok()).unwrap_or(1);
        let scalar = word("type").and_then(|word| Scalar::named(&word));
        self.open = Some(Array { name, scalar, components, format, text: Cow::default(), place });
    }

    fn end(&mut self, name: &[u8]) {
        match name {
            b"Points" | b"Cells" | b"CellData" | b"PointData" | b"FieldData" => self.section = Section::Other,
            b"DataArray" | b"Array" => {
                let (Some(array), Some(piece)) = (self.open.take(), self.grid.pieces.last_mut()) else {
                    return;
                };
                match self.section {
                    Section::CellData => piece.cell_data.push(array),
                    _ => piece.arrays.push(array),
                }
            }
            _ => {}
        }
    }
}

fn attribute(element: &BytesStart<'_>, name: &str) -> Option<String> {
    let mut attributes = element.attributes();
    let own = attributes.with_checks(false).flatten().find(|own| own.key.as_ref() == name.as_bytes())?;
    Some(match own.unescape_value() {
        Ok(text) => text.into_owned(),
        Err(_) => String::from_utf8_lossy(&own.value).into_owned(),
    })
}
