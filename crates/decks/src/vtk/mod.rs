//! Unstructured grids of VTK (`.vtu`), as VTK, ParaView, PyVista and meshio write them (*VTK File Formats*, XML formats).
//!
//! | element of the file | read |
//! |---|---|
//! | `Points`, `Cells` of all pieces | yes |
//! | `CellData` of whole numbers | their values are parts and sets |
//! | `CellData` of real numbers, `PointData`, `FieldData` | no |
//!
//! Arrays are text, base64 or raw bytes, plain or packed by zlib. The program's own writer, `vtkio`, reads no raw bytes and no bundle of
//! zlib as it is built here, ends the process on damaged bytes, and knows no lines: so elements come from `quick-xml`, bytes from `base64`
//! and `miniz_oxide`.

mod cells;
mod data;
mod groups;
#[cfg(test)]
mod tests;
mod xml;

use crate::deck::Deck;
use crate::text::Files;
use data::Unpacker;
use std::path::Path;
use stridor_base::error::Result;

/// Reads an unstructured grid.
///
/// # Errors
/// A file that cannot be read.
pub(crate) fn read(path: &Path, files: &mut Files) -> Result<Deck> {
    let (file, bytes) = files.read_bytes(path)?;
    let mut deck = Deck::default();
    let Some(grid) = xml::read(&bytes, file, files, &mut deck) else { return Ok(deck) };
    let mut unpacker = Unpacker::new(&grid, bytes.len());
    let numbers = cells::read(&grid, &mut unpacker, &mut deck, files);
    groups::sections(numbers, &mut deck);
    Ok(deck)
}
