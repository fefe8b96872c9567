//! The results folder: what is in it belongs together.
//!
//! The folder is made when missing; each file is replaced whole. The names of the files that a run writes are kept in
//! `.files`, so that a later run can delete them, before it puts its own first one there, and nothing else ([`retire`]).
//! An interrupted record is not deleted: with all the files of its run it is moved to `interrupted-1`, `interrupted-2` …,
//! each a results folder by itself ([`super::set_aside()`]).
//!
//! A process that is killed loses nothing that it has written, but a machine that loses power does until the disk has it.
//! [`write_durably`] waits for the disk, and so does the end of a run, once for all its files ([`make_durable`]).

use super::held::check_held;
use crate::error::{Error, Result};
use std::collections::BTreeSet;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// The file with the names of the files of a run, a line each.
pub(super) const FILES: &str = ".files";

/// Makes the folder `dir` and its parents when they are missing.
///
/// A folder that this process has locked must still be the one that it has locked.
pub(super) fn prepare_folder(dir: &Path) -> Result<()> {
    check_held(dir)?;
    if dir.exists() && !dir.is_dir() {
        let found =
            std::io::Error::new(ErrorKind::NotADirectory, "a file stands where the results folder should be");
        return Err(refusal(dir, found));
    }
    std::fs::create_dir_all(dir).map_err(|source| refusal(dir, source))
}

/// Writes `dir/name` whole or not at all: a reader sees the old file or the new one, and a refused or interrupted
/// write leaves the old one as it was.
pub(crate) fn write_atomically(dir: &Path, name: &str, bytes: &[u8]) -> Result<()> {
    replace(dir, name, bytes, false)
}

/// The same of a file of the run that must outlive a loss of power.
pub(super) fn write_durably(dir: &Path, name: &str, bytes: &[u8]) -> Result<()> {
    own(dir, name)?;
    replace(dir, name, bytes, true)
}

/// The same, of a file that outlives a loss of power where it is `durable`.
pub(super) fn replace(dir: &Path, name: &str, bytes: &[u8], durable: bool) -> Result<()> {
    prepare_folder(dir)?;
    let path = dir.join(name);
    let partial = dir.join(format!(".{name}.part"));
    let written = std::fs::write(&partial, bytes)
        .and_then(|()| if durable { synchronise(&partial) } else { Ok(()) })
        .and_then(|()| std::fs::rename(&partial, &path))
        .and_then(|()| if durable { synchronise(dir) } else { Ok(()) });
    written.map_err(|source| {
        // What was written of it is of no use; the first error is the one to report.
        let _ = std::fs::remove_file(&partial);
        refusal(&path, source)
    })
}

/// Waits until the files of the run in the folder `dir`, and `more`, are on the disk.
pub(super) fn make_durable(dir: &Path, more: &Path) -> Result<()> {
    check_held(dir)?;
    let names = owned(dir).into_iter().chain([FILES.into()]);
    let files = names.map(|name| dir.join(name)).filter(|path| path.is_file());
    for path in files.chain([more.to_path_buf(), dir.to_path_buf()]) {
        synchronise(&path).map_err(|source| refusal(&path, source))?;
    }
    Ok(())
}

/// Waits until a file or the names in a folder are on the disk.
pub(super) fn synchronise(path: &Path) -> std::io::Result<()> {
    // Elsewhere folders cannot be opened.
    if cfg!(not(unix)) && path.is_dir() {
        return Ok(());
    }
    match std::fs::File::open(path)?.sync_all() {
        // Some network file systems do not offer it.
        Err(error) if matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => Ok(()),
        done => done,
    }
}

/// The same of a file that is one of a run's results.
pub(crate) fn write_result(dir: &Path, name: &str, bytes: &[u8]) -> Result<()> {
    own(dir, name)?;
    write_atomically(dir, name, bytes)
}

/// Notes that the run writes a file of this name in the folder `dir`.
pub(super) fn own(dir: &Path, name: &str) -> Result<()> {
    prepare_folder(dir)?;
    if owned(dir).contains(name) {
        return Ok(());
    }
    let path = dir.join(FILES);
    let file = std::fs::OpenOptions::new().append(true).create(true).open(&path);
    let noted = file.and_then(|mut file| file.write_all(format!("{name}\n").as_bytes()));
    noted.map_err(|source| refusal(&path, source))
}

/// The files of the run in the folder. A name that leads elsewhere is none.
pub(super) fn owned(dir: &Path) -> BTreeSet<String> {
    let text = std::fs::read(dir.join(FILES)).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let names =
        text.lines().filter(|name| !name.is_empty() && Path::new(name).file_name() == Some(name.as_ref()));
    names.map(str::to_string).collect()
}

/// The files of the run in the folder that others read, `results.h5` among them when it is about to take its place.
pub(crate) fn written_files(dir: &Path) -> BTreeSet<String> {
    let mut names = owned(dir);
    if dir.join("results.new.h5").exists() {
        names.insert("results.h5".into());
    }
    names.retain(|name| !name.ends_with(".bin"));
    names
}

/// Deletes the files of an earlier run in the folder `dir`, but those in `spared`: names, or whole paths of files that the
/// run reads.
pub(crate) fn retire(dir: &Path, spared: &[PathBuf]) -> Result<()> {
    check_held(dir)?;
    let names = owned(dir);
    if names.is_empty() {
        return Ok(());
    }
    let spared: Vec<PathBuf> = spared.iter().filter_map(|path| dir.join(path).canonicalize().ok()).collect();
    let (mut kept, mut refused) = (String::new(), None);
    for name in names {
        let path = dir.join(&name);
        if path.canonicalize().is_ok_and(|path| spared.contains(&path)) {
            kept += &format!("{name}\n");
        } else if let Err(source) = std::fs::remove_file(&path)
            && source.kind() != ErrorKind::NotFound
        {
            refused.get_or_insert(refusal(&path, source));
        }
    }
    refused.map_or_else(|| write_atomically(dir, FILES, kept.as_bytes()), Err)
}

/// The machine's refusal of `path`, with the advice that fits it.
pub(super) fn refusal(path: &Path, source: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> Error {
    let source = source.into();
    let kind = source.downcast_ref::<std::io::Error>().map(std::io::Error::kind);
    let help = match (dangling(path), kind) {
        _ if path.to_str().is_none() => {
            "The path is no text in UTF-8: name another folder for the results.".into()
        }
        (Some((link, target)), _) => format!(
            "\"{}\" is a link to \"{}\", which is not there: make that folder, or name another one for the results.",
            link.display(),
            target.display()
        ),
        (_, Some(ErrorKind::StorageFull | ErrorKind::QuotaExceeded)) => {
            "Free disk space, or name another folder for the results.".into()
        }
        (_, Some(ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem)) => {
            "Make the folder writable, or name another folder for the results.".into()
        }
        (_, Some(ErrorKind::NotADirectory | ErrorKind::AlreadyExists | ErrorKind::InvalidFilename)) => {
            "Name another folder for the results.".into()
        }
        _ => {
            "Free disk space or make the folder writable, or name another folder for the results.".to_string()
        }
    };
    Error::io(path, source, help)
}

/// The first link on the way to `path` whose target is not there, and that target.
fn dangling(path: &Path) -> Option<(PathBuf, PathBuf)> {
    let ways: Vec<&Path> = path.ancestors().collect();
    let link = ways.into_iter().rev().find(|way| way.is_symlink() && !way.exists())?;
    Some((link.to_path_buf(), std::fs::read_link(link).ok()?))
}

/// Gives every name a form fit for file and group names, each once: `rig, closed` → `rig_closed`.
#[derive(Debug, Default)]
pub(crate) struct FileNames(Vec<String>);

impl FileNames {
    /// The next name's form.
    pub(crate) fn next(&mut self, name: &str) -> String {
        self.once(plain_name(name))
    }

    /// `plain`, or with the next free number where it was given before.
    pub(crate) fn once(&mut self, plain: String) -> String {
        let unique = (1..)
            .map(|k| if k == 1 { plain.clone() } else { format!("{plain}_{k}") })
            .find(|candidate| !self.0.contains(candidate))
            .expect("some number is free");
        self.0.push(unique.clone());
        unique
    }
}

/// A name fit for a file: letters, digits, `-` and `_` stay, a run of anything else becomes one `_`.
fn plain_name(name: &str) -> String {
    let kept = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    let words: Vec<&str> = name.split(|c: char| !kept(c)).filter(|w| !w.is_empty()).collect();
    if words.is_empty() { "unnamed".to_string() } else { words.join("_") }
}

/// The name of the file of one of several results of a kind, without its extension: `frf_hammer`.
pub(crate) fn file_name(kind: &str, name: &str) -> String {
    format!("{kind}_{}", plain_name(name))
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

    /// Each kind of refusal has its own advice; that of a full disk only where the disk is full.
    #[cfg(unix)]
    #[test]
    fn refusals_advise_what_helps() {
        use std::os::unix::ffi::OsStrExt;
        let dir = tempfile::tempdir().unwrap();
        let said = |path: &Path, kind: ErrorKind| refusal(path, std::io::Error::from(kind)).to_string();
        let link = dir.path().join("link");
        std::os::unix::fs::symlink("nowhere", &link).unwrap();
        for path in [link.clone(), link.join("results"), link.join("a/b")] {
            let text = said(&path, ErrorKind::NotFound);
            assert!(text.contains("is a link to \"nowhere\"") && !text.contains("disk"), "{text}");
            assert!(prepare_folder(&path).unwrap_err().to_string().contains("is a link to"));
        }
        let latin = dir.path().join(std::ffi::OsStr::from_bytes(b"gr\xfc\xdfe"));
        let text = said(&latin, ErrorKind::Other);
        assert!(text.contains("UTF-8") && !text.contains("disk"), "{text}");
        let plain = dir.path().join("plain");
        assert!(said(&plain, ErrorKind::StorageFull).contains("Free disk space, or"));
        for kind in [ErrorKind::PermissionDenied, ErrorKind::NotADirectory] {
            assert!(!said(&plain, kind).contains("disk"));
        }
    }

    fn names(dir: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(dir).unwrap().flatten();
        let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        names.collect::<BTreeSet<String>>().into_iter().collect()
    }

    #[test]
    fn files_of_an_earlier_run_are_deleted_and_no_others() {
        let parent = tempfile::tempdir().unwrap();
        let dir = &parent.path().join("out");
        write_result(dir, "modes_disc.csv", b"1").unwrap();
        write_result(dir, "modes_disc.csv", b"2").unwrap();
        write_result(dir, "calibrated.toml", b"title = 1").unwrap();
        write_atomically(dir, "mass.mtx", b"exported").unwrap();
        std::fs::write(dir.join("notes.txt"), "mine").unwrap();
        std::fs::write(parent.path().join("outside"), "mine").unwrap();
        let listed = std::fs::read_to_string(dir.join(FILES)).unwrap();
        assert_eq!(listed, "modes_disc.csv\ncalibrated.toml\n");
        // Names that lead out of the folder delete nothing.
        std::fs::write(dir.join(FILES), listed + "../outside\n..\n/etc/hostname\n\n").unwrap();
        retire(dir, &[dir.join("calibrated.toml")]).unwrap();
        assert_eq!(names(dir), [FILES, "calibrated.toml", "mass.mtx", "notes.txt"]);
        assert_eq!(names(parent.path()), ["out", "outside"]);
        retire(dir, &[]).unwrap();
        assert_eq!(names(dir), [FILES, "mass.mtx", "notes.txt"]);
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
