//! Lines of files.

use std::path::PathBuf;

/// A line of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Hash)]
pub struct Place {
    /// Index in [`crate::Deck::files`].
    pub file: u32,
    /// Counted from 1.
    pub line: u32,
}

/// `file.inp:12`; the file alone where there is no line.
pub(crate) fn place_words(files: &[PathBuf], place: Place) -> String {
    let file = files.get(place.file as usize).map(|file| file.display().to_string()).unwrap_or_default();
    if place.line == 0 { file } else { format!("{file}:{}", place.line) }
}
