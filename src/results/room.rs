//! Whether the record of a run in time finds room, before the run begins.

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

/// Refuses a record that the disk of the folder `dir` has no room for.
///
/// # Errors
/// [`Error::Io`]: there is none.
pub fn room_on_disk(dir: &Path, recording: &Recording) -> Result<()> {
    match free_on_disk(dir) {
        Some(free) => fits(recording, bytes_on_disk(recording), free, "the disk")
            .map_err(|source| Error::io(dir, source, format!("{HELP}, or name a folder on a larger disk."))),
        None => Ok(()),
    }
}

/// Refuses a record that is kept in memory and that memory has no room for.
///
/// # Errors
/// [`Error::Analysis`]: there is none.
pub fn room_in_memory(recording: &Recording) -> Result<()> {
    let bytes = recording.rows as f64 * NUMBER * (recording.channels.len() + recording.modes) as f64;
    match available() {
        Some(Available { bytes: free, by }) => {
            fits(recording, bytes, free as f64, "memory").map_err(|found| {
                Error::analysis(
                    "transient",
                    format!("{found} ({by})"),
                    format!("{HELP}, or record to a folder"),
                )
            })
        }
        None => Ok(()),
    }
}

/// What is still to be written.
fn bytes_on_disk(recording: &Recording) -> f64 {
    let channels = recording.channels.len() as f64;
    let numbers = NUMBER * channels + MODAL * recording.modes as f64;
    let (rows, new) = (recording.rows as f64, recording.rows.saturating_sub(recording.done) as f64);
    let fields = recording.fields.as_ref().map_or(0.0, |fields| {
        let new = fields.count.saturating_sub(fields.done);
        NODE * fields.geometry.nodes.len() as f64 * (fields.count + new) as f64
    });
    // A run that goes on writes results.h5 and the tables anew, and adds to record.bin.
    rows * (numbers + TEXT * (channels + 1.0)) + new * numbers + fields
}

/// What is wrong where `bytes` are more than the `free` ones.
fn fits(recording: &Recording, bytes: f64, free: f64, place: &str) -> std::result::Result<(), String> {
    if bytes <= free {
        return Ok(());
    }
    let modes = match recording.modes {
        0 => String::new(),
        modes => format!(" and {modes} modes"),
    };
    let fields = recording.fields.as_ref().map_or(String::new(), |fields| {
        format!(", the motion of {} nodes at {} times", fields.geometry.nodes.len(), fields.count)
    });
    Err(format!(
        "the record of {} steps of {} channels{modes}{fields} takes {}, and {place} has {} free",
        recording.rows - 1,
        recording.channels.len(),
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
    // SAFETY: the path ends in a zero and `found` has room for the answer, which is read only where the call succeeded.
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
    use crate::results::Channel;

    fn recording(rows: usize, done: usize, channels: &[Channel]) -> Recording<'_> {
        Recording { time_step: 1e-6, rows, done, happened: 0, channels, modes: 3, pairs: &[], fields: None }
    }

    #[test]
    fn a_record_that_has_no_room_is_refused_with_its_size() {
        let channels: Vec<Channel> =
            (0..15).map(|k| Channel::new(format!("c{k}"), "m", String::new())).collect();
        let dir = tempfile::tempdir().unwrap();
        let endless = recording(1_000_000_000_000_001, 0, &channels);
        let text = room_on_disk(dir.path(), &endless).unwrap_err().to_string();
        for part in ["1000000000000000 steps of 15 channels and 3 modes", "GB", "time_step", "larger disk"] {
            assert!(text.contains(part), "{text}");
        }
        assert_eq!(room_on_disk(dir.path(), &endless).unwrap_err().exit_code(), 1);
        assert!(room_in_memory(&endless).unwrap_err().to_string().contains("memory has"));
        let short = recording(11, 0, &channels);
        room_on_disk(dir.path(), &short).unwrap();
        room_in_memory(&short).unwrap();
        // 15 numbers and 3 short ones in results.h5 and in record.bin; 16 numbers as text.
        assert_eq!(bytes_on_disk(&short), 11.0 * (2.0 * (15.0 * 8.0 + 3.0 * 4.0) + 160.0));
        assert_eq!(bytes_on_disk(&recording(11, 5, &channels)), 11.0 * (132.0 + 160.0) + 6.0 * 132.0);
    }
}
