//! Record from which an interrupted run is resumed: two files of the results folder that only this program reads. The parts of a
//! job array ([`PartFile`]) are files of their own.
//!
//! - `record.bin` grows during a map, a study of samples or a run in time: every point and row as soon as it is computed ([`RecordBlock`]).
//! - `checkpoint.bin` says how many bytes of it count, their SHA-256, what the case and its files were, and the state that
//!   the run resumes from ([`Saved`]). It has a checksum of its own and is replaced in one step, after what it counts is on the
//!   disk. A process that is killed and a machine that loses power at any moment leave one that fits; what `record.bin` has
//!   beyond it does not count.
//!
//! Both are read as bytes with every length checked before memory is taken. `results.h5`, `transient.csv`, `events.csv` and
//! `transient.vtkhdf` are written again from them; none of these is read.

mod block;
mod bytes;
mod origin;
mod part;
mod saved;

pub use block::RecordBlock;
pub use origin::{InputFile, RecordOrigin};
pub use part::{Part, PartFile, PartRecord, read_parts};
pub use saved::Saved;

use self::origin::START_OVER;
use super::folder::{own, refusal, synchronise, write_durably};
use super::{FieldSnapshot, RecordPiece, Recording};
use crate::error::{Error, Fault, Result};
use crate::sweep::{MapPoint, SampleModes};
use crate::transient::Checkpoint;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The points computed so far.
pub(super) const RECORD: &str = "record.bin";
/// How far they count.
pub(super) const CHECKPOINT: &str = "checkpoint.bin";

/// A disk may take long for a checkpoint: the next is written after so many times that time, which costs at most a percent.
const PAUSE: u32 = 100;

/// The points of a map, and the places that its reduced model was trained on.
pub type EarlierMap = (Vec<MapPoint>, Vec<[f64; 2]>);

/// Record of an earlier run.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Earlier {
    /// The maps by name.
    pub maps: BTreeMap<String, EarlierMap>,
    /// First samples of the studies of uncertain scalars, by name.
    pub samples: BTreeMap<String, Vec<SampleModes>>,
    /// The channels of the run in time, each with its first value.
    pub channels: Vec<(String, f64)>,
    /// Rows of the run in time.
    pub rows: usize,
    /// Events in them.
    pub events: usize,
    /// Motions of all nodes in them.
    pub fields: usize,
    /// State from which the run in time resumes.
    pub march: Option<Checkpoint>,
    modes: usize,
}

impl Earlier {
    /// Adds a block; says what is wrong when it does not follow those before.
    fn add(&mut self, block: &RecordBlock) -> std::result::Result<(), &'static str> {
        match block {
            RecordBlock::Map { name, trained } => {
                self.maps.insert(name.clone(), (Vec::new(), trained.clone()));
            }
            RecordBlock::MapPoints { name, first, points } => {
                let map = self.maps.get_mut(name).filter(|(before, _)| before.len() == *first);
                map.ok_or("points of a map that do not follow those before")?.0.extend(points);
            }
            RecordBlock::Samples { name, first, modes } => {
                let samples = self.samples.entry(name.clone()).or_default();
                if samples.len() != *first {
                    return Err("samples that do not follow those before");
                }
                samples.extend_from_slice(modes);
            }
            RecordBlock::Transient { channels, modes } => {
                if self.rows > 0 {
                    return Err("two runs in time");
                }
                let channels = channels.iter().map(|name| (name.clone(), f64::NAN)).collect();
                let (maps, samples) = (std::mem::take(&mut self.maps), std::mem::take(&mut self.samples));
                *self = Earlier { maps, samples, channels, ..Earlier::default() };
                self.modes = *modes;
            }
            RecordBlock::Rows { first, values, modal, events } => {
                if *first != self.rows || values.len() != self.channels.len() || modal.len() != self.modes {
                    return Err("rows that do not follow those before");
                }
                if self.rows == 0 {
                    self.channels.iter_mut().zip(values).for_each(|(channel, all)| channel.1 = all[0]);
                }
                self.rows += values.first().map_or(0, Vec::len);
                self.events += events.len();
            }
            RecordBlock::Field { number, .. } => {
                if *number != self.fields {
                    return Err("motion that does not follow that before");
                }
                self.fields += 1;
            }
        }
        Ok(())
    }
}

/// Reads the first `length` bytes of a `record.bin`, block after block.
///
/// # Errors
/// Input: what is wrong with them, with `path` named. What `each` returns.
pub fn read_record(
    path: &Path,
    mut input: impl Read,
    length: u64,
    each: &mut dyn FnMut(RecordBlock) -> Result<()>,
) -> Result<Earlier> {
    let mut earlier = Earlier::default();
    let mut left = length;
    let wrong = |what: &str, left: u64| damaged(path, &format!("{what}, at byte {}", length - left));
    while left > 0 {
        let mut head = Vec::new();
        let head_bytes = block::HEAD as u64;
        take(&mut input, head_bytes.min(left), &mut head, path)?;
        let (Some(kind), Some(size)) = (head.first(), head.get(1..block::HEAD)) else {
            return Err(wrong("it ends too early", left));
        };
        let size = u64::from_le_bytes(size.try_into().expect("eight"));
        let mut payload = Vec::new();
        if size <= left - head_bytes {
            take(&mut input, size, &mut payload, path)?;
        }
        if payload.len() as u64 != size {
            return Err(wrong("it ends too early", left));
        }
        let block = RecordBlock::read(*kind, &payload).map_err(|what| wrong(what, left))?;
        earlier.add(&block).map_err(|what| wrong(what, left))?;
        each(block)?;
        left -= head_bytes + size;
    }
    Ok(earlier)
}

fn take(input: &mut impl Read, count: u64, bytes: &mut Vec<u8>, path: &Path) -> Result<()> {
    let read = input.by_ref().take(count).read_to_end(bytes);
    read.map(|_| ()).map_err(|source| refusal(path, source))
}

fn damaged(path: &Path, what: &str) -> Error {
    let fault = Fault::new(path.display().to_string(), what, "the file as the interrupted run left it");
    let help =
        "The file is damaged or of another program: put it back, or run without --resume (it is kept aside)";
    Error::input(fault.with_help(help))
}

/// Reads `checkpoint.bin` of the folder `dir`, if there is one.
pub(super) fn read_saved(dir: &Path) -> Result<Option<Saved>> {
    let path = dir.join(CHECKPOINT);
    if !path.exists() {
        return Ok(None);
    }
    let bytes = std::fs::read(&path).map_err(|source| refusal(&path, source))?;
    Saved::from_bytes(&bytes).map(Some).map_err(|what| damaged(&path, what))
}

/// Checks that what the folder `dir` holds is of `origin`, where its checkpoint says of what it is.
///
/// # Errors
/// Input: it is of another case, or of other files; the checkpoint is damaged.
pub fn check_origin(dir: &Path, origin: &RecordOrigin) -> Result<()> {
    read_saved(dir)?.map_or(Ok(()), |saved| origin.check(&saved.origin, dir, START_OVER))
}

/// Notes in the folder `dir` of what its results are, and whether the work that makes them has ended, where they are kept
/// in another file than `record.bin`.
///
/// # Errors
/// The machine refuses.
pub fn keep_origin(dir: &Path, origin: &RecordOrigin, ended: bool) -> Result<()> {
    let saved = Saved { ended, ..Saved::new(origin.clone()) };
    write_durably(dir, CHECKPOINT, &saved.to_bytes())
}

/// The record of a run under way.
#[derive(Debug)]
pub struct Record {
    dir: PathBuf,
    saved: Saved,
    /// SHA-256 of the bytes that count.
    hasher: Sha256,
    file: Option<File>,
    /// Whether something counts that the checkpoint in the folder does not have.
    waiting: bool,
    /// Before this moment the next checkpoint is not written.
    due: Option<Instant>,
}

impl Record {
    /// Begins a record in the folder `dir`; its files are made with the first block.
    pub fn new(dir: &Path, origin: RecordOrigin) -> Self {
        Record {
            dir: dir.to_path_buf(),
            saved: Saved::new(origin),
            hasher: Sha256::new(),
            file: None,
            waiting: false,
            due: None,
        }
    }

    /// Goes on with the record that an earlier run of the same case has left in the folder `dir`, if there is one.
    ///
    /// # Errors
    /// Input: it is of another case, of other files, of another version of the program, or damaged. The machine refuses.
    pub fn resume(dir: &Path, origin: &RecordOrigin) -> Result<Option<(Self, Earlier)>> {
        let Some(saved) = read_saved(dir)? else { return Ok(None) };
        origin.check(&saved.origin, dir, START_OVER)?;
        let own = env!("CARGO_PKG_VERSION");
        if saved.program_version != own {
            let found = format!("results of version {:.20}", saved.program_version);
            let fault = Fault::new(dir.display().to_string(), found, format!("version {own}"));
            return Err(Error::input(
                fault.with_help("Take it up with that version, or run without --resume"),
            ));
        }
        let path = dir.join(RECORD);
        let mut hasher = Sha256::new();
        let mut file = open(&path)?.take(saved.length);
        let mut buffer = vec![0; 1 << 16];
        loop {
            match file.read(&mut buffer).map_err(|source| refusal(&path, source))? {
                0 => break,
                count => hasher.update(&buffer[..count]),
            }
        }
        let digest: [u8; 32] = hasher.clone().finalize().into();
        if digest != saved.digest {
            return Err(damaged(&path, "not the record of the checkpoint (its checksum is wrong)"));
        }
        let mut earlier = read_record(&path, open(&path)?, saved.length, &mut |_| Ok(()))?;
        earlier.march.clone_from(&saved.march);
        let record = Record { dir: dir.to_path_buf(), saved, hasher, file: None, waiting: false, due: None };
        Ok(Some((record, earlier)))
    }

    /// Whether the earlier run had ended by itself.
    pub fn ended(&self) -> bool {
        self.saved.ended
    }

    /// The paths of its files.
    pub fn files(&self) -> [PathBuf; 2] {
        [RECORD, CHECKPOINT].map(PathBuf::from)
    }

    /// Hands on every block that counts.
    ///
    /// # Errors
    /// The file was changed since; what `each` returns.
    pub fn replay(&self, each: &mut dyn FnMut(RecordBlock) -> Result<()>) -> Result<()> {
        let path = self.dir.join(RECORD);
        read_record(&path, open(&path)?, self.saved.length, each).map(|_| ())
    }

    /// Begins a map, or begins it again, with points that are known.
    ///
    /// # Errors
    /// The machine refuses, here and below.
    pub fn begin_map(&mut self, name: &str, known: &[MapPoint], trained: &[[f64; 2]]) -> Result<()> {
        self.append(&block::map(name, trained))?;
        self.add_map_points(name, 0, known)
    }

    /// Adds points of a map.
    ///
    /// # Errors
    /// As above.
    pub fn add_map_points(&mut self, name: &str, first: usize, points: &[MapPoint]) -> Result<()> {
        if points.is_empty() {
            return Ok(());
        }
        self.append(&block::map_points(name, first, points))?;
        self.save()
    }

    /// Adds samples of a study of uncertain scalars.
    ///
    /// # Errors
    /// As above.
    pub fn add_samples(&mut self, name: &str, first: usize, modes: &[SampleModes]) -> Result<()> {
        self.append(&block::samples(name, first, modes))?;
        self.save()
    }

    /// Begins a run in time.
    ///
    /// # Errors
    /// As above.
    pub fn begin_transient(&mut self, recording: &Recording) -> Result<()> {
        self.saved.march = None;
        self.append(&block::transient(recording.channels.iter().map(|c| c.name.as_str()), recording.modes))
    }

    /// Adds rows of the run in time and the state from which it resumes after them.
    ///
    /// # Errors
    /// As above.
    pub fn add_piece(&mut self, piece: &RecordPiece) -> Result<()> {
        self.append(&block::rows(piece))?;
        self.saved.march = Some(piece.checkpoint.clone());
        self.save()
    }

    /// Adds the motion of all nodes. It counts with the next rows.
    ///
    /// # Errors
    /// As above.
    pub fn add_field(&mut self, field: &FieldSnapshot) -> Result<()> {
        self.append(&block::field(field))
    }

    /// Says that the run has ended by itself, so that it may be replaced.
    ///
    /// # Errors
    /// As above.
    pub fn end(&mut self) -> Result<()> {
        if self.file.is_none() && self.saved.length == 0 {
            return Ok(());
        }
        self.saved.ended = true;
        self.write()
    }

    fn append(&mut self, block: &[u8]) -> Result<()> {
        let path = self.dir.join(RECORD);
        let refused = |source: std::io::Error| refusal(&path, source);
        if self.file.is_none() {
            own(&self.dir, RECORD)?;
            let file = OpenOptions::new().write(true).create(true).truncate(false).open(&path);
            let mut file = file.map_err(refused)?;
            // Nothing but what counts.
            file.set_len(self.saved.length).map_err(refused)?;
            file.seek(SeekFrom::End(0)).map_err(refused)?;
            self.file = Some(file);
        }
        let file = self.file.as_mut().expect("opened above");
        file.write_all(block).map_err(refused)?;
        self.hasher.update(block);
        Ok(())
    }

    /// From now on all that was added counts.
    fn save(&mut self) -> Result<()> {
        let path = self.dir.join(RECORD);
        let length = self.file.as_mut().map(Seek::stream_position);
        if let Some(length) = length {
            self.saved.length = length.map_err(|source| refusal(&path, source))?;
        }
        self.saved.digest = self.hasher.clone().finalize().into();
        self.saved.ended = false;
        self.waiting = true;
        if self.due.is_some_and(|due| Instant::now() < due) { Ok(()) } else { self.write() }
    }

    /// Writes the checkpoint, after what it counts is on the disk.
    fn write(&mut self) -> Result<()> {
        let begun = Instant::now();
        self.waiting = false;
        if self.file.is_some() {
            let path = self.dir.join(RECORD);
            synchronise(&path).map_err(|source| refusal(&path, source))?;
        }
        write_durably(&self.dir, CHECKPOINT, &self.saved.to_bytes())?;
        self.due = Some(Instant::now() + PAUSE * begun.elapsed());
        Ok(())
    }
}

impl Drop for Record {
    /// A run that fails leaves all that it has.
    fn drop(&mut self) {
        if self.waiting {
            // The failure is reported; the checkpoint before this one stays.
            let _ = self.write();
        }
    }
}

fn open(path: &Path) -> Result<BufReader<File>> {
    File::open(path).map(BufReader::new).map_err(|source| {
        if source.kind() == std::io::ErrorKind::NotFound {
            damaged(path, "nothing")
        } else {
            refusal(path, source)
        }
    })
}

#[cfg(test)]
mod tests;
