//! Input files of Abaqus and CalculiX.

use crate::deck::Deck;
use crate::text::Files;
use std::path::Path;
use stridor_base::error::Result;

/// Reads an input file.
///
/// # Errors
/// A file that cannot be read.
pub(crate) fn read(path: &Path, files: &mut Files) -> Result<Deck> {
    let _ = files.read(path)?;
    Ok(Deck::default())
}
