//! Check of the memory and disk space for the record of a run in time, before the run begins.

use super::Recording;
use crate::error::{Error, Result};
use crate::memory::{Available, available};
use std::path::Path;

/// Bytes of a number in `results.h5` and `record.bin`, of a modal acceleration there, in `transient.csv`, and of the motion of
/// a node in `transient.vtkhdf` and `record.bin`: three displacements and three velocities.
const NUMBER: f64 = 8.0;
const MODAL: f64 = 4.0;
const TEXT: f64 = 10.0;
const NODE: f64 = 24.0;
const HELP: &str =
    "Make `transient.duration` shorter or `transient.time_step` longer, or `transient.fields_every` longer";

/// Dimensions that determine the size of the record of a run in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordSize {
    /// Steps, the start included.
    pub rows: usize,
    /// How many of them an earlier run has recorded.
    pub done: usize,
    /// Numbers of a step.
    pub channels: usize,
    /// Modal accelerations of a step.
    pub modes: usize,
    /// Nodes whose motion is recorded.
    pub nodes: usize,
    /// At how many times.
    pub fields: usize,
    /// At how many of them an earlier run has.
    pub fields_done: usize,
}

impl From<&Recording<'_>> for RecordSize {
    fn from(recording: &Recording<'_>) -> Self {
        let fields = recording.fields.as_ref();
        RecordSize {
            rows: recording.rows,
            done: recording.done,
            channels: recording.channels.len(),
            modes: recording.modes,
            nodes: fields.map_or(0, |fields| fields.geometry.nodes.len()),
            fields: fields.map_or(0, |fields| fields.count),
            fields_done: fields.map_or(0, |fields| fields.done),
        }
    }
}

/// Refuses a record for which the disk of the folder `dir` has no space; the folder may be one that is still to be made.
///
/// # Errors
/// [`Error::Io`]: there is none.
pub fn fits_on_disk(dir: &Path, record: &RecordSize) -> Result<()> {
    let place = std::path::absolute(dir).unwrap_or_else(|_| dir.to_path_buf());
    match place.ancestors().find_map(free_on_disk) {
        Some(free) => fits(record, record.bytes_on_disk(), free, "the disk")
            .map_err(|source| Error::io(dir, source, format!("{HELP}, or name a folder on a larger disk."))),
        None => Ok(()),
    }
}

/// Refuses a record that does not fit in memory.
///
/// # Errors
/// [`Error::Analysis`]: there is none.
pub fn fits_in_memory(record: &RecordSize) -> Result<()> {
    let bytes = record.rows as f64 * NUMBER * (record.channels + record.modes) as f64;
    match available() {
        Some(Available { bytes: free, by }) => fits(record, bytes, free as f64, "memory").map_err(|found| {
            Error::analysis("transient", format!("{found} ({by})"), format!("{HELP}, or record to a folder"))
        }),
        None => Ok(()),
    }
}

impl RecordSize {
    /// Size still to be written \[bytes\].
    fn bytes_on_disk(&self) -> f64 {
        let channels = self.channels as f64;
        let numbers = NUMBER * channels + MODAL * self.modes as f64;
        let (rows, new) = (self.rows as f64, self.rows.saturating_sub(self.done) as f64);
        let new_fields = self.fields.saturating_sub(self.fields_done);
        let fields = NODE * self.nodes as f64 * (self.fields + new_fields) as f64;
        // A resumed run rewrites results.h5, with the times, and the tables, and appends to record.bin.
        rows * (NUMBER + numbers + TEXT * (channels + 1.0)) + new * numbers + fields
    }
}

/// Error when `bytes` are more than the `free` ones.
fn fits(record: &RecordSize, bytes: f64, free: f64, place: &str) -> std::result::Result<(), String> {
    if bytes <= free {
        return Ok(());
    }
    let modes = match record.modes {
        0 => String::new(),
        modes => format!(" and {modes} modes"),
    };
    let fields = match record.fields {
        0 => String::new(),
        fields => format!(", the motion of {} nodes at {fields} times", record.nodes),
    };
    Err(format!(
        "the record of {} steps of {} channels{modes}{fields} takes {}, and {place} has {} free",
        record.rows - 1,
        record.channels,
        size(bytes),
        size(free)
    ))
}

fn size(bytes: f64) -> String {
    match bytes {
        b if b < 1e9 => format!("{:.1} MB", b / 1e6),
        b => format!("{:.1} GB", b / 1e9),
    }
}

/// Bytes that a user may still write to the disk of a folder; `None` where the system does not say.
#[cfg(unix)]
fn free_on_disk(dir: &Path) -> Option<f64> {
    use std::os::unix::ffi::OsStrExt;
    let path = std::ffi::CString::new(dir.as_os_str().as_bytes()).ok()?;
    let mut found = std::mem::MaybeUninit::<libc::statvfs>::uninit();
    // SAFETY: the path ends in a zero and `found` is large enough for the answer, which is read only where the call succeeded.
    let found = unsafe {
        if libc::statvfs(path.as_ptr(), found.as_mut_ptr()) != 0 {
            return None;
        }
        found.assume_init()
    };
    Some(found.f_bavail as f64 * found.f_frsize as f64)
}

#[cfg(not(unix))]
fn free_on_disk(_: &Path) -> Option<f64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(rows: usize, done: usize) -> RecordSize {
        RecordSize { rows, done, channels: 15, modes: 3, nodes: 0, fields: 0, fields_done: 0 }
    }

    #[test]
    fn a_record_that_has_no_room_is_refused_with_its_size() {
        let dir = tempfile::tempdir().unwrap();
        let endless = record(1_000_000_000_000_001, 0);
        for place in [dir.path().to_path_buf(), dir.path().join("still/to be made")] {
            let text = fits_on_disk(&place, &endless).unwrap_err().to_string();
            for part in
                ["1000000000000000 steps of 15 channels and 3 modes", "GB", "time_step", "larger disk"]
            {
                assert!(text.contains(part), "{text}");
            }
        }
        assert_eq!(fits_on_disk(dir.path(), &endless).unwrap_err().exit_code(), 1);
        assert!(fits_in_memory(&endless).unwrap_err().to_string().contains("memory has"));
        let short = record(11, 0);
        fits_on_disk(dir.path(), &short).unwrap();
        fits_in_memory(&short).unwrap();
        // 15 numbers and 3 short ones in results.h5 and in record.bin, the times in results.h5; 16 numbers as text.
        assert_eq!(short.bytes_on_disk(), 11.0 * (8.0 + 2.0 * (15.0 * 8.0 + 3.0 * 4.0) + 160.0));
        assert_eq!(record(11, 5).bytes_on_disk(), 11.0 * (8.0 + 132.0 + 160.0) + 6.0 * 132.0);
        let fields = RecordSize { nodes: 10, fields: 4, fields_done: 1, ..short };
        assert_eq!(fields.bytes_on_disk() - short.bytes_on_disk(), 240.0 * (4.0 + 3.0));
    }
}
