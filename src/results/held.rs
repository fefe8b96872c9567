//! The results folders that this process has locked, and whether they are still what stands at their paths.

use crate::error::{Error, Result};
use std::fs::{File, Metadata};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The file of a folder that is locked; it says who holds the lock and stays when the process ends.
pub(super) const LOCK: &str = ".lock";

/// Device and number of a file. No other file gets them while this one is open.
type FileIdentity = (u64, u64);

/// The folders that this process has locked, and what identifies the open file of each lock.
static HELD: Mutex<Vec<(PathBuf, FileIdentity)>> = Mutex::new(Vec::new());

/// A folder that this process has locked, until this is dropped.
#[derive(Debug)]
pub(super) struct Held(PathBuf);

impl Held {
    /// The folder `dir`, whose open lock is `lock`. `None` where files have no identity.
    pub(super) fn new(dir: &Path, lock: &File) -> Option<Self> {
        let own = identity(&lock.metadata().ok()?)?;
        HELD.lock().unwrap_or_else(PoisonError::into_inner).push((dir.to_path_buf(), own));
        Some(Held(dir.to_path_buf()))
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        HELD.lock().unwrap_or_else(PoisonError::into_inner).retain(|(held, _)| *held != self.0);
    }
}

/// Refuses to write into a folder that was removed, moved or replaced by another one since this process locked it: what
/// stands at its path then is not this run's.
pub(super) fn check_held(dir: &Path) -> Result<()> {
    let held = HELD.lock().unwrap_or_else(PoisonError::into_inner);
    let Some((_, own)) = held.iter().find(|(held, _)| held == dir) else { return Ok(()) };
    if std::fs::metadata(dir.join(LOCK)).ok().and_then(|now| identity(&now)) == Some(*own) {
        return Ok(());
    }
    let found = "the results folder was removed, moved or replaced while this run wrote into it";
    let help = "This run has stopped and writes nothing more; run it again, into a folder of its own";
    Err(Error::io(dir, found, help))
}

#[cfg(unix)]
fn identity(file: &Metadata) -> Option<FileIdentity> {
    use std::os::unix::fs::MetadataExt;
    Some((file.dev(), file.ino()))
}

/// Elsewhere a folder with an open file can be neither removed nor moved.
#[cfg(not(unix))]
fn identity(_: &Metadata) -> Option<FileIdentity> {
    None
}
