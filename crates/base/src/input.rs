//! Input files, read whole: regular files only, of a bounded size.
//!
//! A pipe would wait for a writer, and a device such as `/dev/zero` has no end: both are refused before they are opened.

use std::fs::{File, metadata};
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;

/// The largest file \[bytes\].
const LARGEST: u64 = 16 << 30;

/// The bytes of the file at `path`.
///
/// ```
/// let error = stridor_base::input::read(std::path::Path::new("/")).unwrap_err();
/// assert!(error.to_string().contains("a folder"));
/// ```
///
/// # Errors
/// The error of the operating system; a folder, a pipe, a device or a socket; more than 16 GiB.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    read_up_to(path, LARGEST)
}

fn read_up_to(path: &Path, largest: u64) -> Result<Vec<u8>> {
    let refused = |kind: ErrorKind, what: String| Err(Error::new(kind, what));
    let about = metadata(path)?;
    if about.is_dir() {
        return refused(ErrorKind::IsADirectory, "a folder, not a file".into());
    }
    if !about.is_file() {
        return refused(ErrorKind::InvalidInput, "a pipe, a device or a socket, not a regular file".into());
    }
    let too_large = |size: u64| {
        let (size, most) = (size as f64 / f64::from(1 << 30), largest >> 30);
        refused(ErrorKind::FileTooLarge, format!("{size:.3} GiB; {most} GiB at most"))
    };
    if about.len() > largest {
        return too_large(about.len());
    }
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(about.len() as usize).map_err(|_| {
        let size = about.len() as f64 / f64::from(1 << 20);
        Error::new(ErrorKind::OutOfMemory, format!("{size:.0} MiB, more than the memory that is left"))
    })?;
    // Files may grow meanwhile, and those of /proc do not say how long they are.
    File::open(path)?.take(largest + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > largest { too_large(bytes.len() as u64) } else { Ok(bytes) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_of_a_bounded_size_are_read() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("case.toml");
        std::fs::write(&path, "a = 1\n").unwrap();
        assert_eq!(read(&path).unwrap(), b"a = 1\n");
        let said = |path: &Path| read(path).unwrap_err().to_string();
        assert!(said(dir.path()).contains("a folder"));
        assert_eq!(read(&dir.path().join("none")).unwrap_err().kind(), ErrorKind::NotFound);
        // A file with a hole takes no space on the disk.
        File::create(&path).unwrap().set_len(100 << 30).unwrap();
        assert_eq!(said(&path), "100.000 GiB; 16 GiB at most");
    }

    #[cfg(unix)]
    #[test]
    fn devices_and_pipes_are_refused() {
        assert!(read(Path::new("/dev/zero")).unwrap_err().to_string().contains("a device"));
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("mesh.msh");
        let name = std::ffi::CString::new(path.to_str().unwrap()).unwrap();
        // SAFETY: a call to the system with the name of a file, which ends in a zero.
        assert_eq!(unsafe { libc::mkfifo(name.as_ptr(), 0o600) }, 0);
        assert!(read(&path).unwrap_err().to_string().contains("a pipe"));
    }
}
