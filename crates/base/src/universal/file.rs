//! A universal file cut into its datasets: text lines, and for a binary one its bytes.

use super::dataset::{Binary, Dataset, DatasetLine, shown};
use super::form::ValueLayout;
use super::record::whole;
use crate::error::{Error, Fault, Result};

/// Lines of text before the numbers of a dataset 58.
const HEADER: usize = 11;

/// Reads lines from the front of a file.
struct FileCursor<'a> {
    bytes: &'a [u8],
    at: usize,
    number: usize,
}

impl<'a> FileCursor<'a> {
    /// The next line, which ends in LF, CR LF or CR.
    fn line(&mut self) -> Option<DatasetLine<'a>> {
        let rest = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(rest.len());
        let returns = rest[length..].iter().take_while(|b| **b == b'\r').count();
        let feed = usize::from(rest.get(length + returns) == Some(&b'\n'));
        // Returns before a line feed are of this end; without one each is an end itself.
        let end = if feed == 1 { returns + 1 } else { returns.min(1) };
        self.at += length + end;
        self.number += 1;
        Some(DatasetLine { text: String::from_utf8_lossy(&rest[..length]), number: self.number })
    }

    fn skip(&mut self, bytes: usize) {
        let end = (self.at + bytes).min(self.bytes.len());
        self.number += self.bytes[self.at.min(end)..end].iter().filter(|b| **b == b'\n').count();
        self.at = end;
    }

    /// Goes to the next line that begins or ends a dataset, or to the end.
    fn skip_to_mark(&mut self) {
        const MARK: &[u8] = b"    -1";
        let rest = &self.bytes[self.at.min(self.bytes.len())..];
        let mark = (0..rest.len()).find(|at| {
            let begins = *at == 0 || matches!(rest[at - 1], b'\n' | b'\r');
            let tail = &rest[*at..];
            begins
                && tail.starts_with(MARK)
                && matches!(tail.get(MARK.len()), None | Some(b'\n' | b'\r' | b' '))
        });
        self.skip(mark.unwrap_or(rest.len()));
    }
}

/// Whether a line begins or ends a dataset: −1 in the first six columns.
fn delimits(text: &str) -> bool {
    text.trim() == "-1" && text.find('-').is_some_and(|at| at <= 4)
}

/// The number of a dataset, and whether its numbers are binary, in the line that begins it.
fn kind_of(text: &str) -> Option<(u32, bool)> {
    let word = text.split_whitespace().next()?;
    let digits = word.strip_suffix(['b', 'B']);
    Some((digits.unwrap_or(word).parse().ok()?, digits.is_some()))
}

/// The datasets of a file called `file`; what cannot be read goes to `lost`: text outside of datasets, a dataset that does not
/// end, binary numbers of unknown form. Refused is a file without any.
///
/// A mark `-1` too few or too many between two datasets is no reason to lose them.
pub fn datasets<'a>(
    file: &'a str,
    bytes: &'a [u8],
    lost: &mut impl FnMut(Error),
) -> Result<Vec<Dataset<'a>>> {
    let mut cursor = FileCursor { bytes, at: 0, number: 0 };
    let mut all = Vec::new();
    let wrong = |number: usize, found: String, expected: &str| {
        Error::input(Fault::new(format!("{file}:{number}"), found, expected))
    };
    const MARK: &str = "`    -1`, which begins a dataset of a universal file";
    // The first line of text outside, and whether a dataset ended just before it.
    let (mut outside, mut ended) = (false, false);
    while let Some(line) = cursor.line() {
        let text = line.text.trim_start_matches('\u{feff}');
        if text.trim().is_empty() {
            continue;
        }
        let name = if delimits(text) {
            let mut names = std::iter::from_fn(|| cursor.line());
            names.find(|name| !delimits(&name.text))
        } else if ended && (text.trim().parse::<u32>().is_ok() || kind_of(text).is_some_and(|(_, b)| b)) {
            Some(line)
        } else {
            if !std::mem::replace(&mut outside, true) {
                let error = wrong(line.number, shown(text), MARK);
                if all.is_empty() && !bytes.windows(6).any(|word| word == b"    -1") {
                    return Err(error);
                }
                lost(error);
            }
            ended = false;
            continue;
        };
        (outside, ended) = (false, true);
        // A mark alone at the end.
        let Some(name) = name else { break };
        let first = name.number;
        let Some((kind, binary)) = kind_of(&name.text) else {
            lost(wrong(first, shown(&name.text), "the number of a dataset"));
            cursor.skip_to_mark();
            cursor.line();
            continue;
        };
        let mut dataset = Dataset { kind, lines: Vec::new(), binary: None, file, first };
        let read = if binary { read_binary(&mut dataset, &name.text, &mut cursor) } else { Ok(()) };
        if let Err(error) = read {
            lost(error);
            cursor.skip_to_mark();
            cursor.line();
            continue;
        }
        let ends = loop {
            match cursor.line() {
                Some(line) if delimits(&line.text) => break true,
                Some(line) if dataset.binary.is_none() => dataset.lines.push(line),
                Some(line) if line.text.trim().is_empty() => {}
                _ => break false,
            }
        };
        if ends {
            all.push(dataset);
        } else {
            let found = format!("dataset {kind}, which does not end");
            lost(wrong(first, found, "`    -1` after it: the file is cut off"));
        }
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
    dataset.binary = Some(Binary { data: &rest[..length], big_endian, sizes });
    cursor.skip(length);
    Ok(())
}
