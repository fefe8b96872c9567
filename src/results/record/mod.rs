//! Records: what was computed of the studies of a case and of its run in time, appended as it comes. An interrupted run is resumed from
//! the record in its results folder, `record.bin`; the parts of a job array ([`Part`]) are records of their own.
//!
//! A record is a sequence of [`Entry`] in the order in which they were computed, the first of which says of what it is. Each has its
//! length (8 bytes) before and the SHA-256 of all before it after it (32 bytes): what a process that is killed, or a machine that loses
//! power, leaves unfinished has no checksum, and that and all after it does not count. Answers of studies are found by study and place.
//!
//! A run in time resumes from a state that is long and soon outdated. So that is in a file of its own, `checkpoint.bin` ([`Saved`]), which
//! is replaced in one step after the rows that it follows are on the disk; rows beyond it do not count.
//!
//! Both are read as bytes with every length checked before memory is taken. `results.h5`, `transient.csv`, `events.csv` and
//! `transient.vtkhdf` are written again from them; none of these is read.

mod bytes;
mod checkpoint;
mod contents;
mod earlier;
mod entry;
mod origin;
mod part;
mod parts;
mod store;

pub use checkpoint::Saved;
pub use earlier::Earlier;
pub use entry::{Entry, Head};
pub use origin::{InputFile, RecordOrigin};
pub use part::Part;
pub use parts::read_parts;
pub use store::Record;

pub(super) use contents::CHECKPOINT;
pub(crate) use contents::RECORD;

use self::contents::{Contents, FORMAT, block, read_from};
use self::origin::START_OVER;
use super::folder::{refusal, write_durably};
use crate::error::Result;
use sha2::{Digest, Sha256};
use std::path::Path;

/// Whether the work of which the folder `dir` has a record has ended; `None` without a record.
/// Refuses one that is damaged or of another version of the program.
pub(super) fn ended(dir: &Path) -> Result<Option<bool>> {
    Ok(Contents::read(&dir.join(RECORD), None)?.map(|contents| contents.ended))
}

/// Checks that what the folder `dir` holds is of `origin`, where its record says of what it is.
///
/// # Errors
/// Input: it is of another case, or of other files; the record is damaged.
pub fn check_origin(dir: &Path, origin: &RecordOrigin) -> Result<()> {
    let head = Contents::read(&dir.join(RECORD), None)?.and_then(|contents| contents.head);
    head.map_or(Ok(()), |head| origin.check(&head.origin, dir, START_OVER))
}

/// Notes in the folder `dir` of what its results are, and whether the work that makes them has ended, where they are kept in another file
/// than its record.
///
/// # Errors
/// [`Io`](crate::error::Error::Io): the record cannot be written.
pub fn keep_origin(dir: &Path, origin: &RecordOrigin, ended: bool) -> Result<()> {
    let head = Entry::Head(Head::new(origin.clone(), None));
    let entries: Vec<Entry> = std::iter::once(head).chain(ended.then_some(Entry::End)).collect();
    write_durably(dir, RECORD, &to_bytes(&entries))
}

/// The entries of a record with these bytes.
///
/// # Errors
/// Input: they are no record.
pub fn from_bytes(bytes: &[u8]) -> Result<Vec<Entry>> {
    let mut all = Vec::new();
    read_from(Path::new("record"), bytes, bytes.len() as u64, &mut |_, entry| {
        all.push(entry);
        Ok(true)
    })?;
    Ok(all)
}

/// The entries of the record at `path`.
///
/// # Errors
/// Input: the file is no record. [`Io`](crate::error::Error::Io): it cannot be read.
pub fn entries(path: &Path) -> Result<Vec<Entry>> {
    from_bytes(&std::fs::read(path).map_err(|source| refusal(path, source))?)
}

/// The file of a record with these entries.
pub fn to_bytes(entries: &[Entry]) -> Vec<u8> {
    let mut hasher = Sha256::new_with_prefix(FORMAT);
    let blocks = entries.iter().flat_map(|entry| block(&entry.to_bytes(), &mut hasher).0);
    FORMAT.iter().copied().chain(blocks.collect::<Vec<u8>>()).collect()
}

#[cfg(test)]
mod tests;
