//! Folders for what a check writes.

use crate::error::{Error, Result};
use tempfile::TempDir;

/// A folder that is gone with what holds it.
pub(super) fn scratch() -> Result<TempDir> {
    let help = "Point TMPDIR at a folder that can be written";
    tempfile::tempdir().map_err(|error| Error::io(std::env::temp_dir(), error, help))
}
