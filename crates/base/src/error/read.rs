//! Files of the input, whole: bytes, or text.
//!
//! Text is UTF-8, or UTF-16 of either byte order, with or without a byte order mark; its lines end in LF, CR LF or CR.

use super::{Error, Fault, Result};
use std::borrow::Cow;
use std::io::ErrorKind;
use std::path::Path;

/// Content expected by [`decode`].
const EXPECTED: &str = "text in UTF-8";

/// Reads the text file at `path`; `expected` says in faults what it should be.
///
/// # Errors
/// A file that is not there or cannot be read, and what [`decode`] refuses.
pub fn read_text(path: &Path, expected: &str) -> Result<String> {
    decode(&read_bytes(path, expected)?, &path.display().to_string())
}

/// Reads the file at `path`; `expected` says in faults what it should be.
///
/// # Errors
/// A file that is not there or cannot be read.
pub fn read_bytes(path: &Path, expected: &str) -> Result<Vec<u8>> {
    crate::input::read(path).map_err(|error| {
        let missing = path.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.exists());
        let found = match (error.kind(), missing) {
            (ErrorKind::NotFound, Some(folder)) => {
                format!("no file there, as there is no folder \"{}\"", folder.display())
            }
            (ErrorKind::NotFound, None) => "no file there".to_string(),
            (ErrorKind::IsADirectory, _) => "a folder".to_string(),
            (ErrorKind::PermissionDenied, _) => "a file that may not be read (permission denied)".to_string(),
            _ => format!("a file that cannot be read ({error})"),
        };
        let help = if error.kind() == ErrorKind::NotFound { path_help(path) } else { "" };
        Error::input(Fault::new(path.display().to_string(), found, expected).with_help(help))
    })
}

/// Advice on a path that no file has: backslashes, and what TOML makes of them inside `"…"`.
fn path_help(path: &Path) -> &'static str {
    let text = path.to_string_lossy();
    if text.contains(|c: char| c.is_control()) {
        "In TOML `\\t`, `\\n`, `\\b` and the like in \"…\" are characters of control: write a path with / between its folders, or in '…'"
    } else if cfg!(not(windows)) && text.contains('\\') {
        "Write a path with / between its folders"
    } else {
        ""
    }
}

/// The text in `bytes` as UTF-8 without a byte order mark, its lines ended by LF or CR LF; `bytes` themselves where they are that.
/// What is no text stays as it is.
///
/// ```
/// use stridor_base::error::read::plain;
/// assert_eq!(&*plain(b"\xff\xfea\0\r\0b\0"), b"a\nb");
/// ```
pub fn plain(bytes: &[u8]) -> Cow<'_, [u8]> {
    let mut text = match utf_16(bytes) {
        Some(text) => Cow::Owned(text.into_bytes()),
        None => Cow::Borrowed(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)),
    };
    if text.ends_with(b"\r") || text.windows(2).any(|pair| pair[0] == b'\r' && pair[1] != b'\n') {
        let text = text.to_mut();
        for at in 0..text.len() {
            if text[at] == b'\r' && text.get(at + 1) != Some(&b'\n') {
                text[at] = b'\n';
            }
        }
    }
    text
}

/// The text in `bytes` where they are UTF-16: by their mark, or as every other one of the first four is zero. What is no
/// character is U+FFFD.
pub fn utf_16(bytes: &[u8]) -> Option<String> {
    let (big_endian, body) = match bytes {
        [0xff, 0xfe, body @ ..] => (false, body),
        [0xfe, 0xff, body @ ..] => (true, body),
        [0, a, 0, b, ..] if *a != 0 && *b != 0 => (true, bytes),
        [a, 0, b, 0, ..] if *a != 0 && *b != 0 => (false, bytes),
        _ => return None,
    };
    let unit = |pair: &[u8]| match <[u8; 2]>::try_from(pair) {
        Ok(pair) if big_endian => u16::from_be_bytes(pair),
        Ok(pair) => u16::from_le_bytes(pair),
        // Half a character, at the end of a file that is cut off.
        Err(_) => 0xfffd,
    };
    Some(char::decode_utf16(body.chunks(2).map(unit)).map(|c| c.unwrap_or('\u{fffd}')).collect())
}

/// The text that `bytes` are, as [`plain`] has it; `place` names the file in faults.
///
/// # Errors
/// The first byte that is not UTF-8 or is NUL, with its line and column.
pub fn decode(bytes: &[u8], place: &str) -> Result<String> {
    let bytes = &*plain(bytes);
    let text = std::str::from_utf8(bytes);
    let end = text.as_ref().map_or_else(|error| error.valid_up_to(), |text| text.len());
    let bad = bytes[..end].iter().position(|b| *b == 0).or((end < bytes.len()).then_some(end));
    match (bad, text) {
        (None, Ok(text)) => Ok(text.to_string()),
        (bad, _) => Err(Error::input(not_text(bytes, bad.unwrap_or(end), place))),
    }
}

/// The fault that byte `at` of the file called `place` is no text, with its line and column.
pub fn not_text(bytes: &[u8], at: usize, place: &str) -> Fault {
    let before = String::from_utf8_lossy(&bytes[..at]);
    let start = before.rfind('\n').map_or(0, |n| n + 1);
    let (line, column) = (1 + before.matches('\n').count(), 1 + before[start..].chars().count());
    let (found, help) = match bytes[at] {
        0 => ("a NUL byte (0x00)".to_string(), "A text file has none: is it the right file?".to_string()),
        byte => {
            // From there on Latin-1 and the Windows code page agree.
            let latin = if byte < 0xa0 {
                String::new()
            } else {
                format!("; in Latin-1 it is `{}`", char::from(byte))
            };
            (format!("the byte 0x{byte:02X}, which is not UTF-8"), format!("Save the file as UTF-8{latin}"))
        }
    };
    Fault::new(format!("{place}:{line}, column {column}"), found, EXPECTED).with_help(help)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_are_not_text_are_named_with_line_and_column() {
        let said = |bytes: &[u8]| decode(bytes, "a.toml").unwrap_err().to_string();
        let text = said(b"a = 1\r\nb = \"Gr\xc3\xbc\xdfe\"\n");
        assert!(text.contains("a.toml:2, column 9") && text.contains("0xDF") && text.contains('ß'), "{text}");
        let text = said(b"a = 1\n\0\0\n\xff");
        assert!(text.contains("a.toml:2, column 1") && text.contains("NUL"), "{text}");
        assert!(said(b"\xe4").contains("a.toml:1, column 1"));
        assert_eq!(decode(b"\xef\xbb\xbfa\r\n", "").unwrap(), "a\r\n");
        assert_eq!(decode(b"", "").unwrap(), "");
    }

    /// Every way to store a text gives the same text, but for CR LF, which stays.
    #[test]
    fn text_is_read_however_it_is_stored() {
        let text = "a = 1\nb = \"Grüße 😀\"\n\nc";
        for end in ["\n", "\r\n", "\r"] {
            let stored = text.replace('\n', end);
            let expected = if end == "\r" { text.to_string() } else { stored.clone() };
            for mark in ["", "\u{feff}"] {
                let marked = format!("{mark}{stored}");
                let units = || marked.encode_utf16();
                for bytes in [
                    marked.clone().into_bytes(),
                    units().flat_map(u16::to_le_bytes).collect(),
                    units().flat_map(u16::to_be_bytes).collect(),
                ] {
                    assert_eq!(decode(&bytes, "").unwrap(), expected, "{end:?} {mark:?}");
                }
            }
        }
        // What is cut off within a character is no reason to panic.
        assert_eq!(decode(b"\xff\xfea\0b", "").unwrap(), "a\u{fffd}");
    }

    #[test]
    fn a_path_with_backslashes_is_told_how_to_write_it() {
        let said = |path: &str| read_bytes(Path::new(path), "a mesh").unwrap_err().to_string();
        assert!(said("no/meshes\\disc.msh").contains("with / between"));
        assert!(said("no/meshes\table.msh").contains("In TOML"));
        assert!(!said("no/meshes/disc.msh").contains(" / "));
    }
}
