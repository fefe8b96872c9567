//! `checkpoint.bin`: the state from which a run in time resumes, and which rows of the record it follows; replaced whole.
//!
//! Sixteen bytes that name the format, the content, and the SHA-256 of all before it (32 bytes).

use super::bytes::{Bytes, Read, RecordCursor};
use crate::transient::Checkpoint;
use sha2::{Digest, Sha256};

/// The format and its version.
const FORMAT: &[u8; 16] = b"stridor resume 2";

/// How far a run in time has come.
#[derive(Debug, Clone, PartialEq)]
pub struct Saved {
    /// Bytes of `record.bin` that it follows.
    pub length: u64,
    /// Their SHA-256.
    pub digest: [u8; 32],
    /// State from which the run resumes.
    pub march: Checkpoint,
}

impl Saved {
    /// Contents of `checkpoint.bin`.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Bytes(FORMAT.to_vec());
        bytes.0.extend(self.length.to_le_bytes());
        bytes.0.extend(self.digest);
        bytes.count(self.march.arrays.len());
        for (name, values) in &self.march.arrays {
            bytes.text(name);
            bytes.count(values.len());
            bytes.doubles(values);
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
        let (content, digest) = from.0.split_at_checked(from.0.len().saturating_sub(32)).expect("shorter");
        if Sha256::digest(&bytes[..FORMAT.len() + content.len()])[..] != *digest {
            return Err("its checksum is wrong");
        }
        let mut from = RecordCursor(content);
        let (length, digest) = (from.whole()?, from.array()?);
        let count = from.count(16)?;
        let array = |_| {
            let name = from.text()?;
            let count = from.count(8)?;
            Ok((name, from.doubles(count)?))
        };
        let arrays = (0..count).map(array).collect::<Read<_>>()?;
        from.end(Saved { length, digest, march: Checkpoint { arrays } })
    }
}
