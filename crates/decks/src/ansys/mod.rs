//! Archives of ANSYS Mechanical APDL, as CDWRITE and other programs write them, and simple input files.
//!
//! Source: ANSYS Mechanical APDL Command Reference, Element Reference, Material Reference and Programmer's Reference (format of the
//! archive file).
//!
//! * [`reader`]: lines and commands; [`fortran`]: lines of blocks by their format.
//! * [`commands`]: which command is read by whom; [`blocks`], [`attributes`], [`materials`], [`loads`], [`selection`]: the commands
//!   that put numbers into a [`model::Model`].
//! * [`shapes`]: elements as cells; [`assemble`]: the model as a [`Deck`]; [`sections`], [`contact`], [`conditions`], [`frames`]: parts of that.

mod assemble;
mod attributes;
mod blocks;
mod commands;
mod conditions;
mod contact;
#[cfg(test)]
mod damaged;
mod fortran;
mod frames;
mod loads;
mod materials;
mod model;
mod reader;
mod sections;
mod selection;
mod shapes;
#[cfg(test)]
mod tests;

use crate::deck::Deck;
use crate::text::Files;
use std::path::Path;
use stridor_base::error::Result;

/// Reads an archive.
///
/// # Errors
/// A file that cannot be read.
pub(crate) fn read(path: &Path, files: &mut Files) -> Result<Deck> {
    let (file, text) = files.read(path)?;
    let mut reader = reader::Reader::new(files, file, &text);
    reader.run();
    Ok(assemble::deck(reader))
}
