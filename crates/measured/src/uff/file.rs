//! A universal file cut into its datasets: text lines, and for a binary one its bytes.

use super::dataset::{Binary, Dataset, DatasetLine, shown};
use super::form::ValueLayout;
use super::record::whole;
use stridor_base::error::{Error, Fault, Result};

/// Lines of text before the numbers of a dataset 58.
const HEADER: usize = 11;

/// Reads lines from the front of a file.
struct FileCursor<'a> {
    bytes: &'a [u8],
    at: usize,
    number: usize,
}

impl<'a> FileCursor<'a> {
    fn line(&mut self) -> Option<DatasetLine<'a>> {
        let rest = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
        self.at += length + 1;
        self.number += 1;
        let text = rest[..length].strip_suffix(b"\r").unwrap_or(&rest[..length]);
        Some(DatasetLine { text: String::from_utf8_lossy(text), number: self.number })
    }

    fn skip(&mut self, bytes: usize) {
        let end = (self.at + bytes).min(self.bytes.len());
        self.number += self.bytes[self.at.min(end)..end].iter().filter(|b| **b == b'\n').count();
        self.at = end;
    }
}

/// Whether a line begins or ends a dataset: −1 in the first six columns.
fn delimits(text: &str) -> bool {
    text.trim() == "-1" && text.find('-').is_some_and(|at| at <= 4)
}

/// The datasets of a file called `file`. Refused are a line outside of datasets, a dataset that does not end, binary numbers of unknown form.
pub(super) fn datasets<'a>(file: &'a str, bytes: &'a [u8]) -> Result<Vec<Dataset<'a>>> {
    let mut cursor = FileCursor { bytes, at: 0, number: 0 };
    let mut all = Vec::new();
    let wrong = |number: usize, found: String, expected: &str| {
        Error::input(Fault::new(format!("{file}:{number}"), found, expected))
    };
    while let Some(line) = cursor.line() {
        let text = line.text.trim_start_matches('\u{feff}');
        if text.trim().is_empty() {
            continue;
        }
        if !delimits(text) {
            let expected = "`    -1`, which begins a dataset of a universal file";
            return Err(wrong(line.number, shown(text), expected));
        }
        let first = line.number + 1;
        let Some(name) = cursor.line() else {
            return Err(wrong(first, "the end of the file".into(), "the number of a dataset"));
        };
        let word = name.text.split_whitespace().next().unwrap_or("");
        let (digits, binary) = match word.strip_suffix(['b', 'B']) {
            Some(digits) => (digits, true),
            None => (word, false),
        };
        let Ok(kind) = digits.parse::<u32>() else {
            return Err(wrong(first, shown(word), "the number of a dataset"));
        };
        let mut dataset = Dataset { kind, lines: Vec::new(), binary: None, file, first };
        if binary {
            read_binary(&mut dataset, &name.text, &mut cursor)?;
        }
        loop {
            match cursor.line() {
                Some(line) if delimits(&line.text) => break,
                Some(line) if dataset.binary.is_none() => dataset.lines.push(line),
                Some(line) if line.text.trim().is_empty() => {}
                _ => {
                    let found = format!("dataset {kind}, which does not end");
                    return Err(wrong(first, found, "`    -1` after it: the file is cut off"));
                }
            }
        }
        all.push(dataset);
    }
    Ok(all)
}

/// The header and the bytes of a binary dataset. The length is worked out from the header: the byte count of the
/// first line is wrong in many files.
fn read_binary<'a>(dataset: &mut Dataset<'a>, name: &str, cursor: &mut FileCursor<'a>) -> Result<()> {
    let words: Vec<i64> = name.split_whitespace().skip(1).map(|word| whole(word).unwrap_or(-1)).collect();
    let word = |k: usize| words.get(k).copied().unwrap_or(-1);
    if dataset.kind != 58 {
        // Of no interest: as many lines and bytes as it says.
        (0..word(2).max(0)).map_while(|_| cursor.line()).for_each(drop);
        cursor.skip(usize::try_from(word(3)).unwrap_or(0));
        return Ok(());
    }
    let [order, floats] = [word(0), word(1)];
    if !matches!(order, 1 | 2) || floats != 2 {
        let found = format!("byte order {order}, floating-point format {floats}");
        let expected =
            "byte order 1 (little endian) or 2 (big endian), and floating-point format 2 (IEEE 754)";
        return Err(dataset.fault(usize::MAX, found, expected));
    }
    dataset.lines.extend((0..HEADER).map_while(|_| cursor.line()));
    let form = ValueLayout::read(dataset)?;
    let at = cursor.at.min(cursor.bytes.len());
    let rest = &cursor.bytes[at..];
    let closes = |length: &usize| {
        let tail = rest.get(*length..).unwrap_or_default();
        let blank = tail.iter().take_while(|b| matches!(b, b'\r' | b'\n')).count();
        tail[blank..].starts_with(b"    -1")
    };
    let length = |sizes: &[usize; 2]| form.count.checked_mul(sizes[0] + sizes[1] * form.parts());
    let found = form.sizes().into_iter().find(|sizes| length(sizes).is_some_and(|length| closes(&length)));
    let Some(sizes) = found else {
        let place = format!("{}, byte {at}, dataset 58b", dataset.file);
        let found = format!("binary numbers that are not {} of the type {}", form.count, form.kind);
        return Err(Error::input(Fault::new(
            place,
            found,
            "as many numbers as stated in the header, then `    -1`",
        )));
    };
    let length = length(&sizes).unwrap_or(0);
    let big_endian = order == 2;
    dataset.binary = Some(Binary { data: &rest[..length], at, big_endian, sizes });
    cursor.skip(length);
    Ok(())
}
