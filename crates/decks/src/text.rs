//! Files as lines with their places: text of any encoding, files that a line includes, faults.

use crate::place::{Place, place_words};
use std::path::{Path, PathBuf};
use stridor_base::error::read::{not_text, plain, read_bytes};
use stridor_base::error::{Error, Fault, Faults, Result};

/// The files that were read, and what is wrong in them.
#[derive(Debug, Default)]
pub(crate) struct Files {
    /// Their paths: a [`Place`] counts in them.
    pub paths: Vec<PathBuf>,
    /// What is wrong.
    pub faults: Faults,
    /// The only file that there is, where it is in memory.
    memory: Option<Vec<u8>>,
}

/// The most faults that are kept: a file of another kind has one in every line.
const MOST_FAULTS: usize = 1000;

impl Files {
    /// A file in memory, by any name, that includes no others.
    pub fn of_bytes(bytes: &[u8]) -> Files {
        Files { memory: Some(bytes.to_vec()), ..Files::default() }
    }

    /// The bytes of a file, and its number.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read_bytes(&mut self, path: &Path) -> Result<(u32, Vec<u8>)> {
        let bytes = match self.memory.as_mut() {
            Some(_) if !self.paths.is_empty() => {
                let fault = Fault::new(path.display().to_string(), "no file there", "one file in memory");
                return Err(Error::input(fault));
            }
            Some(bytes) => std::mem::take(bytes),
            None => read_bytes(path, "a model of another program")?,
        };
        let number = self.paths.len() as u32;
        self.paths.push(path.to_path_buf());
        Ok((number, bytes))
    }

    /// The text of a file, whose bytes need not be UTF-8 where they are a comment, and its number.
    ///
    /// # Errors
    /// A file that cannot be read, or that is no text.
    pub fn read(&mut self, path: &Path) -> Result<(u32, String)> {
        let (number, bytes) = self.read_bytes(path)?;
        let text = plain(&bytes);
        if let Some(at) = text.iter().position(|byte| *byte == 0) {
            return Err(Error::input(not_text(&text, at, &path.display().to_string())));
        }
        let text = match std::str::from_utf8(&text) {
            Ok(text) => text.to_string(),
            // Latin-1: every byte is the character of its number.
            Err(_) => text.iter().map(|byte| char::from(*byte)).collect(),
        };
        Ok((number, text))
    }

    /// Notes a fault.
    pub fn fault(&mut self, place: Place, found: impl Into<String>, expected: impl Into<String>) {
        self.fault_with_help(place, found, expected, "");
    }

    /// Notes a fault with advice.
    pub fn fault_with_help(
        &mut self,
        place: Place,
        found: impl Into<String>,
        expected: impl Into<String>,
        help: &str,
    ) {
        let place = place_words(&self.paths, place);
        self.keep(Fault::new(place, found, expected).with_help(help));
    }

    /// Keeps a fault.
    pub fn keep(&mut self, fault: Fault) {
        // A part that is placed twice is read twice.
        if self.faults.0.len() < MOST_FAULTS && !self.faults.0.contains(&fault) {
            self.faults.push(fault);
        }
    }

    /// Whether so many faults were found that no more are looked for.
    pub fn too_many(&self) -> bool {
        self.faults.0.len() >= MOST_FAULTS
    }
}
