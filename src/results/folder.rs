//! The results folder: made when missing, never emptied, each file replaced whole.

use crate::error::{Error, Result};
use std::path::Path;

/// Makes the folder `dir` and its parents when they are missing.
pub(super) fn prepare_folder(dir: &Path) -> Result<()> {
    if dir.exists() && !dir.is_dir() {
        return Err(refusal(dir, "a file stands where the results folder should be"));
    }
    std::fs::create_dir_all(dir).map_err(|source| refusal(dir, source))
}

/// Writes `dir/name` whole or not at all: a reader sees the old file or the new one, and a refused or interrupted
/// write leaves the old one as it was.
pub(crate) fn write_atomically(dir: &Path, name: &str, bytes: &[u8]) -> Result<()> {
    prepare_folder(dir)?;
    let path = dir.join(name);
    let partial = dir.join(format!(".{name}.part"));
    std::fs::write(&partial, bytes).and_then(|()| std::fs::rename(&partial, &path)).map_err(|source| {
        // What was written of it is of no use; the first error is the one to tell.
        let _ = std::fs::remove_file(&partial);
        refusal(&path, source)
    })
}

/// The machine's refusal of `path`, with the advice that fits every such case.
pub(super) fn refusal(path: &Path, source: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> Error {
    let help = "Make room on the disk or make the folder writable, or name another folder for the results.";
    Error::io(path, source, help)
}

/// Gives every name a form fit for file and group names, each once: `rig, closed` → `rig_closed`.
#[derive(Debug, Default)]
pub(crate) struct FileNames(Vec<String>);

impl FileNames {
    /// The next name's form; letters, digits, `-` and `_` stay, a run of anything else becomes one `_`.
    pub(crate) fn next(&mut self, name: &str) -> String {
        let words: Vec<&str> = name
            .split(|c: char| !(c.is_alphanumeric() || c == '-' || c == '_'))
            .filter(|w| !w.is_empty())
            .collect();
        let plain = if words.is_empty() { "unnamed".to_string() } else { words.join("_") };
        let unique = (1..)
            .map(|k| if k == 1 { plain.clone() } else { format!("{plain}_{k}") })
            .find(|candidate| !self.0.contains(candidate))
            .expect("some number is free");
        self.0.push(unique.clone());
        unique
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_safe_and_unique() {
        let mut names = FileNames::default();
        assert_eq!(names.next("disc"), "disc");
        assert_eq!(names.next("disc"), "disc_2");
        assert_eq!(names.next("../rig / closed"), "rig_closed");
        assert_eq!(names.next("//"), "unnamed");
    }

    #[test]
    fn a_file_in_the_way_and_a_folder_that_takes_no_files_are_refused_in_one_sentence() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("occupied");
        std::fs::write(&file, "keep").unwrap();
        let error = write_atomically(&file, "summary.json", b"{}").unwrap_err();
        assert_eq!(error.exit_code(), 1);
        assert!(error.to_string().contains("a file stands where"), "{error}");
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "keep");
        assert!(matches!(prepare_folder(Path::new("/proc/no_such_place")), Err(Error::Io { .. })));
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_full_disk_leaves_the_old_file() {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join("summary.json"), "old").unwrap();
        std::os::unix::fs::symlink("/dev/full", dir.path().join(".summary.json.part")).unwrap();
        let error = write_atomically(dir.path(), "summary.json", b"new").unwrap_err();
        assert!(error.to_string().contains("No space left on device"), "{error}");
        assert_eq!(std::fs::read_to_string(dir.path().join("summary.json")).unwrap(), "old");
    }
}
