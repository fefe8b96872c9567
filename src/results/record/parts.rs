//! Parts of a job array: one share of all studies of a case, a record each (`3-of-40.bin`). Each has a lock of its own: parts of one
//! folder are computed at the same time.

use super::contents::{Contents, damaged};
use super::entry::Head;
use super::origin::RecordOrigin;
use super::part::Part;
use super::store::Record;
use crate::error::{Error, Fault, Faults, Result};
use crate::results::folder::refusal;
use crate::results::lock::FolderLock;
use std::io::ErrorKind;
use std::path::Path;

/// The parts in the folder `dir` whose number is `of`, or that of the first.
fn listed(dir: &Path, of: Option<usize>) -> Result<Vec<Part>> {
    let entries = match std::fs::read_dir(dir) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries.map_err(|source| refusal(dir, source))?,
    };
    let names = entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
    let mut parts: Vec<Part> = names.filter_map(|name| Part::of_file(&name)).collect();
    parts.sort_unstable();
    let of = of.or(parts.first().map(|part| part.of));
    if let Some(other) = parts.iter().find(|part| Some(part.of) != of) {
        let expected = format!("parts of {}", of.unwrap_or_default());
        let fault = Fault::new(dir.join(other.file()).display().to_string(), other.to_string(), expected);
        let help = "Delete the parts of one number, or name another folder with --out";
        return Err(Error::input(fault.with_help(help)));
    }
    Ok(parts)
}

/// All parts in the folder `dir`, which are of `origin`.
///
/// # Errors
/// Input: parts of different numbers, of another case, of other files, of another program, damaged ones.
pub fn read_parts(dir: &Path, origin: &RecordOrigin) -> Result<Vec<Record>> {
    let mut faults = Faults::new();
    let parts = listed(dir, None)?;
    let read = |part: &Part| faults.take(Record::of_part(dir, *part, origin)).flatten();
    let parts = parts.iter().filter_map(read).collect();
    faults.into_result(parts)
}

impl Record {
    /// Locks a part in the folder `dir`, to go on with what was computed of it before.
    ///
    /// # Errors
    /// Input: the folder has parts of another number, of another case, of other files, of another program, or damaged ones.
    /// [`Error::Io`]: another process has the lock.
    pub fn open_part(dir: &Path, part: Part, origin: &RecordOrigin) -> Result<Self> {
        // All parts are read when they are merged.
        let others = listed(dir, Some(part.of))?.into_iter().filter(|other| *other != part).take(1);
        for part in others.chain([part]) {
            Record::of_part(dir, part, origin)?;
        }
        let lock =
            FolderLock::take_file(dir, &format!(".{}-of-{}.lock", part.number, part.of), &part.to_string())?;
        let earlier = Record::of_part(dir, part, origin)?;
        let mut record = earlier.unwrap_or_else(|| {
            Record::at(dir.join(part.file()), Head::new(origin.clone(), Some(part)), None)
        });
        record.lock = Some(lock);
        Ok(record)
    }

    /// Begins to compute a part, with the `reference` that shapes are compared by.
    ///
    /// # Errors
    /// Input: shapes of this part, or of another in the folder, were compared by another one. [`Error::Io`]: the part cannot be written.
    pub fn begin_part(&self, part: Part, reference: [u8; 32]) -> Result<()> {
        let dir = self.path.parent().unwrap_or(Path::new(""));
        let other = listed(dir, Some(part.of))?.into_iter().find(|other| other.number != part.number);
        if let Some(other) = other.map(|other| Record::of_part(dir, other, &self.head.origin)).transpose()? {
            other.iter().try_for_each(|other| other.compare_by(reference))?;
        }
        self.compare_by(reference)?;
        self.begin()
    }

    /// The record of a part in the folder `dir`, if it is there.
    fn of_part(dir: &Path, part: Part, origin: &RecordOrigin) -> Result<Option<Self>> {
        let path = dir.join(part.file());
        let Some(contents) = Contents::read(&path, None)? else { return Ok(None) };
        let head = contents.head.clone().expect("a record with its head");
        if head.part != Some(part) {
            return Err(damaged(&path, "it is another part"));
        }
        let help = "Delete the parts of the other run, or name another folder with --out";
        origin.check(&head.origin, &path, help)?;
        let own = Head::new(origin.clone(), Some(part));
        if head.program != own.program {
            let found = format!("a part by version {}", head.program);
            let fault = Fault::new(path.display().to_string(), found, format!("version {}", own.program));
            return Err(Error::input(fault.with_help("Compute and merge all parts with one program")));
        }
        Ok(Some(Record::at(path, own, Some(contents))))
    }
}
