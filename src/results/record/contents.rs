//! Contents of a record as they are read back.

use super::earlier::Earlier;
use super::entry::{Entry, Head};
use crate::error::{Error, Fault, Result};
use crate::results::folder::refusal;
use sha2::{Digest, Sha256};
use std::collections::{BTreeSet, HashMap};
use std::fs::File;
use std::io::{BufReader, ErrorKind, Read};
use std::path::Path;

/// The record of a run.
pub(crate) const RECORD: &str = "record.bin";
/// The state from which its run in time resumes.
pub(in crate::results) const CHECKPOINT: &str = "checkpoint.bin";
/// The format of a record and its version, its first bytes.
pub(super) const FORMAT: &[u8; 16] = b"stridor record 1";

/// Where answers are in the file. There may be millions: the key is 128 bits of the SHA-256 of the study that asks for them and the place.
#[derive(Debug, Default)]
pub(super) struct Index {
    /// The studies that have answers.
    pub(super) studies: BTreeSet<String>,
    offsets: HashMap<u128, u64>,
}

impl Index {
    /// The byte at which an answer begins.
    pub(super) fn find(&self, study: &str, place: &[u64]) -> Option<u64> {
        self.offsets.get(&key(study, place)).copied()
    }

    pub(super) fn insert(&mut self, study: &str, place: &[u64], at: u64) {
        self.offsets.insert(key(study, place), at);
        if !self.studies.contains(study) {
            self.studies.insert(study.to_string());
        }
    }
}

fn key(study: &str, place: &[u64]) -> u128 {
    let mut hasher = Sha256::new_with_prefix(study);
    place.iter().for_each(|value| hasher.update(value.to_le_bytes()));
    u128::from_le_bytes(hasher.finalize()[..16].try_into().expect("sixteen"))
}

/// Where an entry is in its file.
pub(super) struct Span {
    pub(super) begin: u64,
    pub(super) end: u64,
    /// SHA-256 of all before it and of itself.
    pub(super) checksum: [u8; 32],
}

/// What a record holds.
#[derive(Debug, Default)]
pub(super) struct Contents {
    /// What it is of.
    pub(super) head: Option<Head>,
    /// SHA-256 of M Φ by which its shapes are compared.
    pub(super) reference: Option<[u8; 32]>,
    /// Whether it has shapes.
    pub(super) shapes: bool,
    pub(super) answers: Index,
    pub(super) in_time: Earlier,
    /// Whether the work had ended.
    pub(super) ended: bool,
    /// Bytes that count.
    pub(super) length: u64,
    /// Their SHA-256, to be continued.
    pub(super) hasher: Sha256,
    /// The checksum of the last entry that the state of the run in time follows.
    pub(super) followed: [u8; 32],
}

impl Contents {
    /// Reads the record at `path`; `None` where there is none, or not even its head.
    ///
    /// With `march`, the length at which a run in time resumes, entries of such a run that come later do not count.
    pub(super) fn read(path: &Path, march: Option<u64>) -> Result<Option<Self>> {
        let mut contents = Contents::default();
        let (length, hasher) = read_entries(path, &mut |Span { begin, end, checksum }, entry| {
            let in_time = matches!(entry, Entry::Transient { .. } | Entry::Rows { .. } | Entry::Field { .. });
            if in_time && march.is_some_and(|march| begin >= march) {
                return Ok(false);
            }
            if march == Some(end) {
                contents.followed = checksum;
            }
            contents.add(begin, &entry).map_err(|what| damaged(path, &format!("{what}, at byte {begin}")))?;
            Ok(true)
        })?;
        (contents.length, contents.hasher) = (length, hasher);
        Ok(contents.head.is_some().then_some(contents))
    }

    /// Adds the entry at byte `at`; says what is wrong when it does not follow those before.
    fn add(&mut self, at: u64, entry: &Entry) -> std::result::Result<(), &'static str> {
        if self.head.is_some() == matches!(entry, Entry::Head(_)) {
            return Err("the head of a record is not its first entry");
        }
        self.ended = matches!(entry, Entry::End);
        match entry {
            Entry::Head(head) => self.head = Some(head.clone()),
            Entry::Reference(digest) => self.reference = Some(*digest),
            Entry::Answer { study, place, modes } => {
                self.shapes |= modes.as_ref().is_ok_and(|modes| modes.vectors.nrows() > 0);
                self.answers.insert(study, place, at);
            }
            Entry::Transient { .. } | Entry::Rows { .. } | Entry::Field { .. } => self.in_time.add(entry)?,
            Entry::End => {}
        }
        Ok(())
    }
}

/// Hands on the entries of the record at `path`, as long as `each` says so. Gives the bytes that
/// count and their SHA-256: a process that is killed and a machine that loses power leave an end without its checksum.
/// Refuses a file that is no record, and an entry that is none but has its checksum.
pub(super) fn read_entries(
    path: &Path,
    each: &mut dyn FnMut(Span, Entry) -> Result<bool>,
) -> Result<(u64, Sha256)> {
    let file = match File::open(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok((0, Sha256::new())),
        file => file.map_err(|source| refusal(path, source))?,
    };
    let length = file.metadata().map_err(|source| refusal(path, source))?.len();
    read_from(path, BufReader::new(file), length, each)
}

/// The same of `input` with so many bytes.
pub(super) fn read_from(
    path: &Path,
    mut input: impl Read,
    length: u64,
    each: &mut dyn FnMut(Span, Entry) -> Result<bool>,
) -> Result<(u64, Sha256)> {
    let (mut hasher, mut at, mut left) = (Sha256::new(), 0, length);
    let refused = |source: std::io::Error| refusal(path, source);
    // As many bytes, where there are so many.
    let mut take = |count: u64| -> Result<Option<Vec<u8>>> {
        if count > left {
            return Ok(None);
        }
        let mut bytes = Vec::new();
        left -= count;
        input.by_ref().take(count).read_to_end(&mut bytes).map_err(refused)?;
        Ok((bytes.len() as u64 == count).then_some(bytes))
    };
    let Some(format) = take(FORMAT.len() as u64)? else { return Ok((at, hasher)) };
    if format != FORMAT {
        return Err(damaged(path, "it is not a record of this version of the program"));
    }
    hasher.update(&format);
    at += format.len() as u64;
    while let Some(length) = take(8)? {
        let count = u64::from_le_bytes(length[..].try_into().expect("eight"));
        let before = hasher.clone();
        let (Some(content), Some(checksum)) = (take(count)?, take(32)?) else { break };
        hasher.update(&length);
        hasher.update(&content);
        let sum: [u8; 32] = hasher.clone().finalize().into();
        if sum[..] != checksum[..] {
            if at == FORMAT.len() as u64 {
                return Err(damaged(path, "its checksum is wrong"));
            }
            return Ok((at, before));
        }
        let entry = Entry::read(&content).map_err(|what| damaged(path, &format!("{what}, at byte {at}")))?;
        let end = at + 8 + count + 32;
        if !each(Span { begin: at, end, checksum: sum }, entry)? {
            return Ok((at, before));
        }
        hasher.update(&checksum);
        at = end;
    }
    Ok((at, hasher))
}

/// The block of an entry after those in `hasher`, to which it is added, and its checksum.
pub(super) fn block(content: &[u8], hasher: &mut Sha256) -> (Vec<u8>, [u8; 32]) {
    let mut bytes = (content.len() as u64).to_le_bytes().to_vec();
    bytes.extend(content);
    hasher.update(&bytes);
    let checksum = hasher.clone().finalize().into();
    hasher.update(checksum);
    bytes.extend(checksum);
    (bytes, checksum)
}

/// A file that is not what the program has written.
pub(super) fn damaged(path: &Path, what: &str) -> Error {
    let of_run = path.file_name().is_some_and(|name| name == RECORD || name == CHECKPOINT);
    let (expected, help) = if of_run {
        (
            "the file as the interrupted run left it",
            "The file is damaged or of another program: put it back, or run without --resume (it is kept aside)",
        )
    } else {
        ("the file as --part left it", "Delete the file and compute the part again")
    };
    Error::input(Fault::new(path.display().to_string(), what, expected).with_help(help))
}
