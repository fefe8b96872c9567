//! `checkpoint.bin`: the valid length of `record.bin` and the state from which a run in time resumes, replaced whole.
//!
//! Sixteen bytes that name the format, the payload, and the SHA-256 of all before it (32 bytes).

use super::bytes::{Bytes, Read, RecordCursor};
use super::origin::RecordOrigin;
use crate::transient::Checkpoint;
use sha2::{Digest, Sha256};

/// The format and its version.
const FORMAT: &[u8; 16] = b"stridor resume 1";

/// How far a run has come.
#[derive(Debug, Clone, PartialEq)]
pub struct Saved {
    /// The version of the program.
    pub program_version: String,
    /// The case and the files it reads.
    pub origin: RecordOrigin,
    /// Whether the run has ended by itself, with results or without.
    pub ended: bool,
    /// Bytes of `record.bin` that count.
    pub length: u64,
    /// Their SHA-256.
    pub digest: [u8; 32],
    /// State from which a run in time resumes.
    pub march: Option<Checkpoint>,
}

impl Saved {
    /// Nothing recorded yet.
    pub(super) fn new(origin: RecordOrigin) -> Self {
        let program_version = env!("CARGO_PKG_VERSION").into();
        let digest = Sha256::digest([]).into();
        Saved { program_version, origin, ended: false, length: 0, digest, march: None }
    }

    /// Contents of `checkpoint.bin`.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Bytes(FORMAT.to_vec());
        bytes.text(&self.program_version);
        self.origin.write(&mut bytes);
        bytes.0.push(u8::from(self.ended));
        bytes.0.extend(self.length.to_le_bytes());
        bytes.0.extend(self.digest);
        bytes.0.push(u8::from(self.march.is_some()));
        if let Some(march) = &self.march {
            bytes.count(march.arrays.len());
            for (name, values) in &march.arrays {
                bytes.text(name);
                bytes.count(values.len());
                bytes.doubles(values);
            }
        }
        let digest = Sha256::digest(&bytes.0);
        bytes.0.extend(digest);
        bytes.0
    }

    /// Reads `checkpoint.bin`; what is wrong with it otherwise.
    ///
    /// # Errors
    /// Bytes that are not what [`Saved::to_bytes`] writes.
    pub fn from_bytes(bytes: &[u8]) -> std::result::Result<Saved, &'static str> {
        let mut from = RecordCursor(bytes);
        if from.take(FORMAT.len()).ok() != Some(FORMAT) {
            return Err("it is not a checkpoint of this version of the program");
        }
        let (said, digest) =
            bytes.split_at_checked(bytes.len().saturating_sub(32)).ok_or("it ends too early")?;
        if said.len() < FORMAT.len() || Sha256::digest(said)[..] != *digest {
            return Err("its checksum is wrong");
        }
        let mut from = RecordCursor(&said[FORMAT.len()..]);
        let program_version = from.text()?;
        let origin = RecordOrigin::read(&mut from)?;
        let ended = from.array::<1>()? != [0];
        let length = from.whole()?;
        let digest = from.array()?;
        let march = if from.array::<1>()? == [0] { None } else { Some(read_march(&mut from)?) };
        from.end(Saved { program_version, origin, ended, length, digest, march })
    }
}

fn read_march(from: &mut RecordCursor) -> Read<Checkpoint> {
    let count = from.count(16)?;
    let array = |_| {
        let name = from.text()?;
        let count = from.count(8)?;
        Ok((name, from.doubles(count)?))
    };
    Ok(Checkpoint { arrays: (0..count).map(array).collect::<Read<_>>()? })
}
