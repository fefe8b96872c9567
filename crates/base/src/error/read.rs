//! Files of the input, whole: bytes, or text in UTF-8.

use super::{Error, Fault, Result};
use std::io::ErrorKind;
use std::path::Path;

/// Content expected by [`decode`].
const EXPECTED: &str = "text in UTF-8";

/// Reads the text file at `path`, UTF-8 with or without a byte order mark; `expected` says in faults what it should be.
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
        Error::input(Fault::new(path.display().to_string(), found, expected))
    })
}

/// The text that `bytes` are in UTF-8, without a byte order mark; `place` names the file in faults.
///
/// # Errors
/// The first byte that is not UTF-8 or is NUL, with its line and column.
pub fn decode(bytes: &[u8], place: &str) -> Result<String> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        let fault = Fault::new(place, "text in UTF-16", EXPECTED);
        return Err(Error::input(fault.with_help("Save it as UTF-8")));
    }
    let text = std::str::from_utf8(bytes);
    let end = text.as_ref().map_or_else(|error| error.valid_up_to(), |text| text.len());
    let bad = bytes[..end].iter().position(|b| *b == 0).or((end < bytes.len()).then_some(end));
    match (bad, text) {
        (None, Ok(text)) => Ok(text.strip_prefix('\u{feff}').unwrap_or(text).to_string()),
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
        assert!(said(b"\xff\xfea\0").contains("UTF-16"));
        assert!(said(b"\xe4").contains("a.toml:1, column 1"));
        assert_eq!(decode(b"\xef\xbb\xbfa\r\n", "").unwrap(), "a\r\n");
        assert_eq!(decode(b"", "").unwrap(), "");
    }
}
