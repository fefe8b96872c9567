//! Unstructured grids of VTK, as VTK, ParaView, PyVista and meshio write them (*VTK File Formats*): XML files (`.vtu`) and legacy ones (`.vtk`).
//!
//! | in the file | read |
//! |---|---|
//! | points and cells, of all pieces | yes |
//! | whole numbers of cells | their values are parts and sets |
//! | real numbers of cells, numbers of points and of the whole grid | no |
//!
//! Arrays are text, base64 or raw bytes, plain or packed by zlib. `vtkio`, which writes grids here, takes no raw bytes in XML files, ends the
//! process on damaged ones, and gives faults without lines: so elements come from `quick-xml`, bytes from `base64` and `miniz_oxide`.

mod cells;
mod data;
mod grid;
mod groups;
mod legacy;
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
    let read = if bytes.starts_with(b"# vtk DataFile") { legacy::read } else { xml::read };
    let Some(grid) = read(&bytes, file, files, &mut deck) else { return Ok(deck) };
    let mut unpacker = Unpacker::new(&grid, bytes.len());
    let numbers = cells::read(&grid, &mut unpacker, &mut deck, files);
    groups::sections(numbers, &mut deck);
    Ok(deck)
}
