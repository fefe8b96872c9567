//! Text of the input: how it is read from a file, and how messages show it.

use super::{Error, Fault, Result};
use std::io::ErrorKind;
use std::path::Path;

/// What [`decode`] expects.
const EXPECTED: &str = "text in UTF-8";
/// The most characters of one piece of the input that a message shows.
const PIECE: usize = 80;
/// The most characters of one phrase of a message.
const PHRASE: usize = 800;

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

/// `text` with the characters that steer a terminal, turn the direction of writing or are not seen as `\u{…}`.
pub fn printable(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_control() || is_unseen(c) { safe.extend(c.escape_debug()) } else { safe.push(c) }
    }
    safe
}

/// [`printable`] line by line.
pub fn printable_lines(text: &str) -> String {
    text.split('\n').map(printable).collect::<Vec<_>>().join("\n")
}

/// Format characters of Unicode: marks of direction, joiners, separators, tags.
fn is_unseen(c: char) -> bool {
    matches!(
        c,
        '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}'
    )
}

/// A phrase of a message: printable, what it quotes and its words cut in the middle, and all cut at the end.
pub(super) fn phrase(text: &str) -> String {
    let whole = cut_pieces(text, true);
    match whole.char_indices().nth(PHRASE) {
        Some((end, _)) => format!("{}…", &whole[..end]),
        None => whole,
    }
}

/// The place of a fault: printable, what it quotes cut in the middle; the path of a file stays whole.
pub(super) fn place(text: &str) -> String {
    cut_pieces(text, false)
}

/// Cuts what stands between quotation marks or back-ticks and, if `words`, words outside of them.
fn cut_pieces(text: &str, words: bool) -> String {
    let text = printable(text);
    let mut rest = text.as_str();
    let mut whole = String::with_capacity(rest.len());
    while !rest.is_empty() {
        let quoted = rest.find(['"', '`']).and_then(|start| {
            let mark = rest[start..].chars().next()?;
            Some((start, start + 1 + rest[start + 1..].find(mark)?))
        });
        let (start, end) = quoted.unwrap_or((rest.len(), rest.len()));
        for word in rest[..start].split_inclusive(' ') {
            whole += &if words { cut(word) } else { word.to_string() };
        }
        if start < end {
            let mark = &rest[start..=start];
            whole += &format!("{mark}{}{mark}", cut(&rest[start + 1..end]));
        }
        rest = rest.get(end + 1..).unwrap_or("");
    }
    whole
}

/// `text` with `…` in the place of its middle when it has more than [`PIECE`] characters.
fn cut(text: &str) -> String {
    let count = text.chars().count();
    if count <= PIECE {
        return text.to_string();
    }
    let head: String = text.chars().take(PIECE / 2).collect();
    let tail: String = text.chars().skip(count + 1 + PIECE / 2 - PIECE).collect();
    format!("{head}…{tail}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_quoted_is_cut_in_the_middle_on_whole_characters() {
        let long: String = "ä".repeat(5000) + " m";
        let text = phrase(&format!("\"{long}\", a unit of another dimension"));
        let (_, quoted) = text.split_once('"').unwrap();
        let (quoted, rest) = quoted.split_once('"').unwrap();
        assert_eq!(quoted.chars().count(), PIECE);
        assert!(quoted.starts_with("ää") && quoted.contains('…') && quoted.ends_with("ä m"), "{quoted}");
        assert_eq!(rest, ", a unit of another dimension");
        // Without quotation marks, with only one of them, and many short ones.
        assert_eq!(phrase(&"7".repeat(900)).chars().count(), PIECE);
        assert!(phrase(&format!("\"{}", "7".repeat(900))).chars().count() <= PIECE);
        assert_eq!(phrase(&"\"7\" ".repeat(900)).chars().count(), PHRASE + 1);
        assert_eq!(phrase("\"1 mm\", a `key`"), "\"1 mm\", a `key`");
    }

    #[test]
    fn paths_stay_whole_and_keys_are_cut() {
        let path = format!("/{}/rig.toml:3", "folder/".repeat(40));
        let shown = place(&format!("{path} `contact.{}.stiffness`", "x".repeat(500)));
        assert!(shown.starts_with(&path), "{shown}");
        assert!(shown.contains("`contact.x") && shown.ends_with("x.stiffness`"), "{shown}");
        assert!(shown.chars().count() < path.len() + 4 + PIECE);
    }

    #[test]
    fn nothing_steers_the_terminal() {
        let shown = printable("a\u{1b}[31mb\u{202e}c\r\n\u{7}\u{9b}\u{200d}é\u{301}");
        assert_eq!(shown, "a\\u{1b}[31mb\\u{202e}c\\r\\n\\u{7}\\u{9b}\\u{200d}é\u{301}");
        assert_eq!(printable_lines("a\n\u{1b}b\n"), "a\n\\u{1b}b\n");
    }

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
