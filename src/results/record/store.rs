//! The record of a run or of a part while it grows.

use super::checkpoint::Saved;
use super::contents::{CHECKPOINT, Contents, FORMAT, RECORD, Span, block, damaged, read_entries};
use super::earlier::Earlier;
use super::entry::{self, Entry, Head};
use super::origin::{RecordOrigin, START_OVER};
use super::part::Part;
use crate::error::{Error, Fault, Result};
use crate::results::folder::{own, prepare_folder, refusal, synchronise, write_durably};
use crate::results::held::check_held;
use crate::results::lock::FolderLock;
use crate::results::{FieldSnapshot, RecordPiece, Recording};
use crate::sweep::Modes;
use sha2::{Digest, Sha256};
use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// A disk may take long until it has what was written: it is waited for after so many times that time, which costs at most a percent.
const PAUSE: u32 = 100;

/// Record of a run, or of a part, which is read and appended to by several threads.
#[derive(Debug)]
pub struct Record {
    pub(super) path: PathBuf,
    pub(super) head: Head,
    state: Mutex<State>,
    pub(super) lock: Option<FolderLock>,
}

#[derive(Debug)]
struct State {
    contents: Contents,
    /// SHA-256 of the M Φ by which shapes to come are compared.
    reference: Option<[u8; 32]>,
    /// Entries that count with the next ones.
    pending: Vec<u8>,
    file: Option<File>,
    /// Whether entries were appended, and the file has nothing but what counts.
    appends: bool,
    /// State of the run in time that is not in its file yet.
    waiting: Option<Saved>,
    /// Before this moment the disk is not waited for again.
    due: Option<Instant>,
}

impl Record {
    /// Begins a record in the folder `dir`; its file is made with the first entry.
    pub fn new(dir: &Path, origin: RecordOrigin) -> Self {
        Record::at(dir.join(RECORD), Head::new(origin, None), None)
    }

    /// Goes on with the record that an earlier run of the same case has left in the folder `dir`, or begins one.
    ///
    /// # Errors
    /// Input: it is of another case, of other files, of another version of the program, or damaged.
    pub fn resume(dir: &Path, origin: RecordOrigin) -> Result<Self> {
        let path = dir.join(CHECKPOINT);
        let saved = match path.exists() {
            false => None,
            true => {
                let bytes = std::fs::read(&path).map_err(|source| refusal(&path, source))?;
                Some(Saved::from_bytes(&bytes).map_err(|what| damaged(&path, what))?)
            }
        };
        let path = dir.join(RECORD);
        let head = Head::new(origin, None);
        let march = saved.as_ref().map_or(0, |saved| saved.length);
        let Some(mut contents) = Contents::read(&path, Some(march))? else {
            return match saved {
                Some(_) => Err(damaged(&path, "nothing")),
                None => Ok(Record::at(path, head, None)),
            };
        };
        let earlier = contents.head.as_ref().expect("a record with its head");
        head.origin.check(&earlier.origin, dir, START_OVER)?;
        let version = |head: &Head| head.program.split(' ').next().unwrap_or_default().to_string();
        if version(earlier) != version(&head) {
            let found = format!("results of version {:.20}", version(earlier));
            let fault = Fault::new(dir.display().to_string(), found, format!("version {}", version(&head)));
            return Err(Error::input(
                fault.with_help("Take it up with that version, or run without --resume"),
            ));
        }
        if let Some(saved) = saved {
            if contents.followed != saved.digest {
                return Err(damaged(&path, "not the record of the checkpoint (its checksum is wrong)"));
            }
            contents.in_time.march = Some(saved.march);
        }
        Ok(Record::at(path, head, Some(contents)))
    }

    pub(super) fn at(path: PathBuf, head: Head, contents: Option<Contents>) -> Self {
        let state = State {
            contents: contents.unwrap_or_default(),
            reference: None,
            pending: Vec::new(),
            file: None,
            appends: false,
            waiting: None,
            due: None,
        };
        Record { path, head, state: Mutex::new(state), lock: None }
    }

    /// The state, also after a thread has panicked that had it: entries are added whole.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Which part it is of.
    pub fn part(&self) -> Option<Part> {
        self.head.part
    }

    /// Whether its work had ended by itself, or a part has all answers that it asks for.
    pub fn ended(&self) -> bool {
        self.state().contents.ended
    }

    /// What an earlier run has recorded of the run in time.
    pub fn in_time(&self) -> Earlier {
        self.state().contents.in_time.clone()
    }

    /// Whether it has answers of a study whose table begins like this.
    pub fn has_study(&self, table: &str) -> bool {
        self.state().contents.answers.studies.iter().any(|study| study.starts_with(table))
    }

    /// The paths of the files of a run.
    pub fn files() -> [PathBuf; 2] {
        [RECORD, CHECKPOINT].map(PathBuf::from)
    }

    /// Hands on every entry that counts.
    ///
    /// # Errors
    /// Input: the file was changed since. What `each` returns.
    pub fn replay(&self, each: &mut dyn FnMut(Entry) -> Result<()>) -> Result<()> {
        let length = self.state().contents.length;
        let mut each = |at: Span, entry| Ok(at.begin < length && each(entry).map(|()| true)?);
        read_entries(&self.path, &mut each).map(|_| ())
    }

    /// Compares shapes by this `reference` from now on.
    ///
    /// # Errors
    /// Input: those that it has were compared by another one.
    pub fn compare_by(&self, reference: [u8; 32]) -> Result<()> {
        let mut state = self.state();
        if state.contents.shapes && state.contents.reference != Some(reference) {
            let found =
                "shapes relative to real modes whose last digits differ: the processor is of another type";
            let fault =
                Fault::new(self.path.display().to_string(), found, "the same real modes, bit for bit");
            let help = match self.head.part {
                Some(_) => "Compute all parts, and merge them, on processors of one type",
                None => "Resume it on a processor of that type, or run without --resume",
            };
            return Err(Error::input(fault.with_help(help)));
        }
        state.reference = Some(reference);
        Ok(())
    }

    /// Whether there is an answer of a study at a place.
    pub fn has(&self, study: &str, place: &[u64]) -> bool {
        self.state().contents.answers.find(study, place).is_some()
    }

    /// The answer of a study at a place, if it is known: modes, or why there are none.
    pub fn answer(&self, study: &str, place: &[u64]) -> Option<Result<Modes>> {
        let mut state = self.state();
        let at = state.contents.answers.find(study, place)?;
        match state.entry(&self.path, at) {
            Ok(Entry::Answer { study: of, place: at, modes }) if of == study && at == place => Some(modes),
            Ok(_) => Some(Err(damaged(&self.path, "it was changed while it was read"))),
            Err(error) => Some(Err(error)),
        }
    }

    /// Adds an answer of a study.
    ///
    /// # Errors
    /// [`Error::Io`]: the record cannot be written, here and below.
    pub fn keep(&self, study: &str, place: &[u64], modes: &Result<Modes>) -> Result<()> {
        let mut state = self.state();
        if let Some(reference) = state.reference.filter(|own| state.contents.reference != Some(*own)) {
            state.add(&self.head, &entry::reference(&reference));
            state.contents.reference = Some(reference);
        }
        let at = state.add(&self.head, &entry::answer(study, place, modes));
        state.contents.shapes |= modes.as_ref().is_ok_and(|modes| modes.vectors.nrows() > 0);
        state.contents.answers.insert(study, place, at);
        state.write(&self.path)?;
        state.save(&self.path)
    }

    /// Begins its file.
    pub(super) fn begin(&self) -> Result<()> {
        let mut state = self.state();
        state.add_head(&self.head);
        state.write(&self.path)
    }

    /// Begins a run in time. It counts with the first rows.
    pub fn begin_transient(&self, recording: &Recording) {
        let names = recording.channels.iter().map(|channel| channel.name.as_str());
        self.state().add(&self.head, &entry::transient(names, recording.modes));
    }

    /// Adds rows of the run in time and the state from which it resumes after them.
    ///
    /// # Errors
    /// As [`Record::keep`].
    pub fn add_piece(&self, piece: &RecordPiece) -> Result<()> {
        let mut state = self.state();
        state.add(&self.head, &entry::rows(piece));
        state.write(&self.path)?;
        let Contents { length, followed: digest, .. } = state.contents;
        state.waiting = Some(Saved { length, digest, march: piece.checkpoint.clone() });
        state.save(&self.path)
    }

    /// Adds the motion of all nodes. It counts with the next rows.
    pub fn add_field(&self, field: &FieldSnapshot) {
        self.state().add(&self.head, &entry::field(field));
    }

    /// Says that the work has ended by itself, so that it may be replaced, if there was any.
    ///
    /// # Errors
    /// As [`Record::keep`].
    pub fn end(&self) -> Result<()> {
        let mut state = self.state();
        if state.contents.length > 0 && !state.contents.ended {
            state.add(&self.head, &entry::end());
            state.write(&self.path)?;
            state.contents.ended = true;
        }
        state.synchronise(&self.path)
    }
}

impl State {
    /// Adds the head, unless it is there.
    fn add_head(&mut self, head: &Head) {
        if self.contents.head.is_none() {
            self.contents.head = Some(head.clone());
            self.contents.hasher = Sha256::new_with_prefix(FORMAT);
            self.pending.extend(FORMAT);
            self.add_block(&entry::head(head));
        }
    }

    /// Adds an entry, and says where it will be in the file.
    fn add(&mut self, head: &Head, entry: &[u8]) -> u64 {
        self.add_head(head);
        self.contents.ended = false;
        self.add_block(entry)
    }

    fn add_block(&mut self, entry: &[u8]) -> u64 {
        let at = self.contents.length + self.pending.len() as u64;
        let (block, checksum) = block(entry, &mut self.contents.hasher);
        self.contents.followed = checksum;
        self.pending.extend(block);
        at
    }

    /// Hands all that was added to the operating system.
    fn write(&mut self, path: &Path) -> Result<()> {
        let refused = |source: std::io::Error| refusal(path, source);
        let dir = path.parent().unwrap_or(Path::new(""));
        check_held(dir)?;
        if !self.appends {
            match path.file_name() {
                Some(name) if name == RECORD => own(dir, RECORD)?,
                _ => prepare_folder(dir)?,
            }
            let options = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
            let file = options.map_err(refused)?;
            // Nothing but what counts.
            file.set_len(self.contents.length).map_err(refused)?;
            (self.file, self.appends) = (Some(file), true);
        }
        let file = self.file.as_mut().expect("opened above");
        let written = file.seek(SeekFrom::Start(self.contents.length));
        written.and_then(|_| file.write_all(&self.pending)).map_err(refused)?;
        self.contents.length += self.pending.len() as u64;
        self.pending.clear();
        Ok(())
    }

    /// Waits for the disk, unless it did so a moment ago.
    fn save(&mut self, path: &Path) -> Result<()> {
        if self.due.is_some_and(|due| Instant::now() < due) { Ok(()) } else { self.synchronise(path) }
    }

    /// Waits until all that was written is on the disk, then replaces the state that follows it.
    fn synchronise(&mut self, path: &Path) -> Result<()> {
        let begun = Instant::now();
        if self.appends {
            synchronise(path).map_err(|source| refusal(path, source))?;
        }
        if let Some(saved) = self.waiting.take() {
            write_durably(path.parent().unwrap_or(Path::new("")), CHECKPOINT, &saved.to_bytes())?;
        }
        self.due = Some(Instant::now() + PAUSE * begun.elapsed());
        Ok(())
    }

    /// The entry that begins at this byte.
    fn entry(&mut self, path: &Path, at: u64) -> Result<Entry> {
        let refused = |source: std::io::Error| refusal(path, source);
        if self.file.is_none() {
            self.file = Some(File::open(path).map_err(refused)?);
        }
        let file = self.file.as_mut().expect("opened above");
        let mut length = [0; 8];
        file.seek(SeekFrom::Start(at)).and_then(|_| file.read_exact(&mut length)).map_err(refused)?;
        let mut content = Vec::new();
        file.take(u64::from_le_bytes(length)).read_to_end(&mut content).map_err(refused)?;
        Entry::read(&content).map_err(|what| damaged(path, what))
    }
}

impl Drop for Record {
    /// A run that fails leaves all that it has.
    fn drop(&mut self) {
        let mut state = self.state();
        if state.waiting.is_some() {
            // The failure is reported; the state before this one stays.
            let _ = state.synchronise(&self.path);
        }
    }
}
