//! The section `$PhysicalNames`, text also in binary files.

use stridor_base::error::read::not_text;
use stridor_base::error::{Error, Fault, Result};

/// Names of physical groups with their dimension and number, in the order of the file.
pub(super) type Names = Vec<((usize, i64), String)>;

/// Reads the names; none when there is no such section.
///
/// Each line is `dimension number "name"`; the line before them says how many.
pub(super) fn parse(bytes: &[u8], place: &str) -> Result<Names> {
    let Some(start) = line_with(bytes, "$PhysicalNames") else { return Ok(Names::new()) };
    let section = &bytes[start..];
    let wrong = |found: String, expected: &str| {
        Error::input(Fault::new(format!("{place}: $PhysicalNames"), found, expected))
    };
    let Some(end) = find(section, b"\n$EndPhysicalNames") else {
        return Err(wrong("no end of the section".into(), "`$EndPhysicalNames`"));
    };
    let text = std::str::from_utf8(&section[..end])
        .map_err(|error| Error::input(not_text(bytes, start + error.valid_up_to(), place)))?;
    let mut lines = text.lines().skip(1).map(str::trim).filter(|l| !l.is_empty());
    let count: usize = match lines.next().map(str::parse) {
        Some(Ok(count)) => count,
        _ => return Err(wrong("no count".into(), "the number of names")),
    };
    let mut names = Names::new();
    for line in lines {
        let mut words = line.splitn(3, char::is_whitespace);
        let entry = (|| {
            let dimension = words.next()?.parse().ok()?;
            let number = words.next()?.parse().ok()?;
            let name = words.next()?.trim().strip_prefix('"')?.strip_suffix('"')?;
            (!name.is_empty()).then(|| ((dimension, number), name.to_string()))
        })();
        match entry {
            Some(entry) => names.push(entry),
            None => return Err(wrong(format!("{line:?}"), "`dimension number \"name\"`")),
        }
    }
    if names.len() != count {
        return Err(wrong(format!("{} names", names.len()), &format!("{count}, as stated in the section")));
    }
    Ok(names)
}

/// The first byte of the first line that begins with `word`.
pub(super) fn line_with(bytes: &[u8], word: &str) -> Option<usize> {
    if bytes.starts_with(word.as_bytes()) {
        return Some(0);
    }
    find(bytes, format!("\n{word}").as_bytes()).map(|end| end + 1)
}

/// Where `word` begins.
fn find(bytes: &[u8], word: &[u8]) -> Option<usize> {
    bytes.windows(word.len()).position(|w| w == word)
}
