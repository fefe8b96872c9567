//! Formats of files, by their names and by how they begin.

use crate::deck::Deck;
use crate::text::Files;
use crate::written::Written;
use std::path::Path;
use stridor_base::error::{Error, Fault, Result, nearest};

/// A format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Input files of Abaqus and CalculiX.
    Abaqus,
    /// Archives of ANSYS Mechanical APDL.
    Ansys,
    /// Universal files.
    Universal,
    /// Bulk data decks of NASTRAN.
    Nastran,
    /// Unstructured grids of VTK.
    Vtk,
}

/// A row of the table of formats.
struct Row {
    format: Format,
    /// Its name on the command line.
    name: &'static str,
    /// Endings of its files, in small letters.
    endings: &'static [&'static str],
    read: fn(&Path, &mut Files) -> Result<Deck>,
    /// Where it is written, too.
    write: Option<fn(&Deck) -> Written>,
}

/// All of them.
const FORMATS: &[Row] = &[
    Row {
        format: Format::Abaqus,
        name: "abaqus",
        endings: &["inp"],
        read: crate::abaqus::read,
        write: Some(crate::abaqus::write),
    },
    Row { format: Format::Ansys, name: "ansys", endings: &["cdb"], read: crate::ansys::read, write: None },
    Row {
        format: Format::Universal,
        name: "universal",
        endings: &["unv", "uff"],
        read: crate::universal::read,
        write: None,
    },
    Row {
        format: Format::Nastran,
        name: "nastran",
        endings: &["bdf", "dat", "nas", "fem", "pch", "blk"],
        read: crate::nastran::read,
        write: Some(crate::nastran::write),
    },
    Row { format: Format::Vtk, name: "vtk", endings: &["vtu", "vtk"], read: crate::vtk::read, write: None },
];

impl Format {
    /// The row of the table.
    fn row(self) -> &'static Row {
        FORMATS.iter().find(|row| row.format == self).unwrap_or(&FORMATS[0])
    }

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// All formats.
    pub fn all() -> impl Iterator<Item = Format> {
        FORMATS.iter().map(|row| row.format)
    }

    /// Whether it is written, too.
    pub fn is_written(self) -> bool {
        self.row().write.is_some()
    }

    /// `.inp (abaqus), .bdf, .dat (nastran)`: the endings of the formats that are written.
    pub fn written_endings() -> String {
        endings(|row| row.write.is_some())
    }

    /// The names of all.
    pub fn names() -> impl Iterator<Item = &'static str> {
        FORMATS.iter().map(|row| row.name)
    }

    /// The format of this name.
    ///
    /// # Errors
    /// No such format.
    pub fn named(name: &str) -> Result<Format> {
        if let Some(row) = FORMATS.iter().find(|row| row.name.eq_ignore_ascii_case(name)) {
            return Ok(row.format);
        }
        let names: Vec<_> = Format::names().collect();
        let fault = Fault::new("--format", format!("`{name}`"), format!("one of {}", names.join(", ")));
        Err(Error::input(match nearest(name, Format::names()) {
            Some(near) => fault.with_help(format!("Did you mean `{near}`?")),
            None => fault,
        }))
    }

    /// The format of a file by the ending of its name.
    ///
    /// # Errors
    /// An ending of no format.
    pub fn of_path(path: &Path) -> Result<Format> {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        if let Some(row) = FORMATS.iter().find(|row| row.endings.contains(&ending.as_str())) {
            return Ok(row.format);
        }
        let expected = format!("a file that ends in {}", endings(|_| true));
        let found = if ending.is_empty() {
            "a name without an ending".into()
        } else {
            format!("a name that ends in `.{ending}`")
        };
        let help = "Say what it is with --format";
        Err(Error::input(Fault::new(path.display().to_string(), found, expected).with_help(help)))
    }
}

/// `.inp (abaqus), .bdf, .dat (nastran)`: the endings of some formats.
fn endings(some: impl Fn(&Row) -> bool) -> String {
    let rows = FORMATS.iter().filter(|row| some(row));
    let all: Vec<_> = rows.map(|row| format!(".{} ({})", row.endings.join(", ."), row.name)).collect();
    all.join(", ")
}

/// Reads the model in a file, of a format that is said or that the ending of its name is of.
///
/// # Errors
/// Every fault of the file and of those it includes: what cannot be read as what it should be, and what is named but not there.
pub fn read(path: &Path, format: Option<Format>) -> Result<Deck> {
    let format = format.map_or_else(|| Format::of_path(path), Ok)?;
    read_with(path, format, Files::default())
}

/// Reads the model in `bytes`, which faults call `name`. It may not include files.
///
/// # Errors
/// As [`read`].
pub fn read_bytes(name: &str, bytes: &[u8], format: Format) -> Result<Deck> {
    read_with(Path::new(name), format, Files::of_bytes(bytes))
}

/// A deck as text of a format, with what that does not hold; none where the format is only read.
pub fn write(deck: &Deck, format: Format) -> Option<Written> {
    format.row().write.map(|write| write(deck))
}

fn read_with(path: &Path, format: Format, mut files: Files) -> Result<Deck> {
    let mut deck = (format.row().read)(path, &mut files)?;
    let Files { paths, faults, .. } = files;
    faults.into_result(())?;
    deck.files = paths;
    Ok(deck)
}
