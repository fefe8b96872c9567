//! One process at a time in a results folder, or at a part of one.

use super::folder::{prepare_folder, refusal};
use super::held::{Held, LOCK};
use crate::error::{Error, Result};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Read, Write};
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

/// Characters of a command that are shown.
const SHOWN: usize = 80;

/// The lock of a results folder, or of a part. The operating system releases it when the process ends, however it ends.
#[derive(Debug)]
pub struct FolderLock {
    // The lock lives as long as the open file.
    _file: Option<File>,
    /// The folder, where all of it is locked.
    _held: Option<Held>,
}

impl FolderLock {
    /// Locks the folder `dir`, which is made when missing.
    ///
    /// # Errors
    /// [`Error::Io`]: another process holds the lock (which one, since when), or the folder cannot be written.
    pub fn take(dir: &Path) -> Result<Self> {
        let mut lock = Self::take_file(dir, LOCK, "the folder")?;
        lock._held = lock._file.as_ref().and_then(|file| Held::new(dir, file));
        Ok(lock)
    }

    /// Takes the file of the lock of the folder `dir` away, where nothing is resumed.
    pub fn remove(self, dir: &Path) {
        // One that is left locks nothing.
        let _ = std::fs::remove_file(dir.join(LOCK));
    }

    /// Locks what the file `name` of the folder `dir` stands for, called `what` in messages.
    pub(super) fn take_file(dir: &Path, name: &str, what: &str) -> Result<Self> {
        prepare_folder(dir)?;
        let path = dir.join(name);
        let refused = |source: std::io::Error| refusal(&path, source);
        let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path);
        let mut file = file.map_err(refused)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(in_use(dir, what, &holder(&mut file))),
            // Some network file systems have no locks.
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {
                return Ok(FolderLock { _file: None, _held: None });
            }
            Err(TryLockError::Error(error)) => return Err(refused(error)),
        }
        let command: Vec<String> =
            std::env::args_os().map(|word| word.to_string_lossy().into_owned()).collect();
        let said = format!("{}\n{}\n{}\n", std::process::id(), seconds_now(), command.join(" "));
        file.set_len(0).and_then(|()| file.write_all(said.as_bytes())).map_err(refused)?;
        Ok(FolderLock { _file: Some(file), _held: None })
    }
}

fn in_use(dir: &Path, what: &str, holder: &str) -> Error {
    let help = "Wait until it ends, or name another folder for the results.";
    Error::io(dir, format!("{what} is in use by {holder}"), help)
}

/// Who holds the lock, from what it wrote: process, command and how long it runs.
fn holder(file: &mut File) -> String {
    let mut said = Vec::new();
    // Without an answer the lock is held all the same.
    let _ = file.take(4096).read_to_end(&mut said);
    describe(&String::from_utf8_lossy(&said), seconds_now())
}

fn describe(said: &str, now: u64) -> String {
    let mut lines = said.lines();
    let [pid, since] = [(); 2].map(|()| lines.next().and_then(|line| line.parse::<u64>().ok()));
    let (Some(pid), Some(since)) = (pid, since) else { return "another process".into() };
    let command = lines.next().unwrap_or_default().chars().filter(|c| !c.is_control());
    let command: String = command.take(SHOWN).collect();
    format!("process {pid} (`{command}`, started {} s ago)", now.saturating_sub(since))
}

/// Seconds since 1970; 0 with a clock before that.
fn seconds_now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_locked_folder_says_who_holds_it_and_is_free_afterwards() {
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path().join("new");
        let lock = FolderLock::take(&folder).unwrap();
        let error = FolderLock::take(&folder).unwrap_err();
        let holder = format!("in use by process {}", std::process::id());
        assert!(error.exit_code() == 1 && error.to_string().contains(&holder), "{error}");
        drop(lock);
        FolderLock::take(&folder).unwrap();
    }

    /// A folder that is removed, moved, emptied or replaced in the middle of a run takes nothing more of it.
    #[test]
    #[cfg(unix)]
    fn a_folder_that_another_takes_the_place_of_is_not_written_into() {
        use super::super::folder::{make_durable, own, write_atomically, write_durably, write_result};
        for k in 0..5 {
            let parent = tempfile::tempdir().unwrap();
            let dir = parent.path().join("out");
            let lock = FolderLock::take(&dir).unwrap();
            write_result(&dir, "first.csv", b"1").unwrap();
            match k {
                0 => std::fs::remove_dir_all(&dir).unwrap(),
                1 => std::fs::rename(&dir, parent.path().join("moved")).unwrap(),
                2 => std::fs::remove_file(dir.join(LOCK)).unwrap(),
                _ => {
                    std::fs::remove_dir_all(&dir).unwrap();
                    std::fs::create_dir(&dir).unwrap();
                    std::fs::write(dir.join(LOCK), "another run").unwrap();
                    if k == 4 {
                        std::fs::write(dir.join("first.csv"), "other").unwrap();
                    }
                }
            }
            let before = std::fs::read(dir.join("first.csv")).ok();
            let tries = [
                write_result(&dir, "first.csv", b"2"),
                write_durably(&dir, "second.csv", b"2"),
                write_atomically(&dir, "third.csv", b"2"),
                own(&dir, "fourth.csv"),
                make_durable(&dir, &dir),
            ];
            for tried in tries {
                let error = tried.unwrap_err();
                assert!(
                    error.exit_code() == 1 && error.to_string().contains("was removed, moved"),
                    "{k}: {error}"
                );
            }
            assert_eq!(std::fs::read(dir.join("first.csv")).ok(), before);
            assert!(k > 1 || !dir.exists());
            assert!(!dir.join("second.csv").exists());
            drop(lock);
            write_result(&dir, "first.csv", b"3").unwrap();
        }
    }

    #[test]
    fn what_a_lock_file_says_is_cut_and_clean() {
        let long = format!("12\n100\nstridor \u{1b}[31mrun {}\n", "x".repeat(500));
        let text = describe(&long, 160);
        assert!(text.starts_with("process 12 (`stridor [31mrun xxx") && text.ends_with("started 60 s ago)"));
        assert!(text.len() < 150 && !text.contains('\u{1b}'), "{text}");
        // A clock that was set back.
        assert!(describe("12\n100\nstridor\n", 50).contains("started 0 s ago"));
        assert_eq!(describe("", 0), "another process");
        assert_eq!(describe("-1\nx\n", 0), "another process");
    }
}
