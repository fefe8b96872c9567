//! Binary OUTPUT4: records of Fortran, each between its length in bytes twice. Words have four bytes, or eight where the first record has 48
//! bytes instead of 24 (MODE=ILP64), in either byte order; a number of double precision has eight bytes.

use super::super::found::File;
use super::matrix::{Block, Deviation, Matrix, deviation};

/// Bytes of a word, and their order.
#[derive(Debug, Clone, Copy)]
struct Words {
    bytes: usize,
    little: bool,
}

impl Words {
    fn of(bytes: &[u8]) -> Option<Self> {
        let (bytes, little) = match bytes.first_chunk()? {
            [24, 0, 0, 0] => (4, true),
            [0, 0, 0, 24] => (4, false),
            [48, 0, 0, 0] => (8, true),
            [0, 0, 0, 48] => (8, false),
            _ => return None,
        };
        Some(Words { bytes, little })
    }

    /// The bytes as one of eight, the first of them the least.
    fn least_first(self, bytes: &[u8]) -> [u8; 8] {
        let mut all = [0; 8];
        all[..bytes.len()].copy_from_slice(bytes);
        if !self.little {
            all[..bytes.len()].reverse();
        }
        all
    }

    /// The whole number of a word of four or eight bytes.
    fn integer(self, word: &[u8]) -> i64 {
        let all = self.least_first(word);
        let number = i64::from_le_bytes(all);
        if word.len() == 4 { i64::from(number as i32) } else { number }
    }

    fn number(self, bytes: &[u8]) -> f64 {
        let all = self.least_first(bytes);
        match bytes.len() {
            4 => f64::from(f32::from_le_bytes([all[0], all[1], all[2], all[3]])),
            _ => f64::from_le_bytes(all),
        }
    }
}

pub(super) fn is(bytes: &[u8]) -> bool {
    Words::of(bytes).is_some()
}

/// The records of a file.
struct Records<'f> {
    bytes: &'f [u8],
    words: Words,
    at: usize,
    /// Where the last one begins.
    begin: usize,
}

impl<'f> Records<'f> {
    fn next(&mut self) -> std::result::Result<&'f [u8], Deviation> {
        self.begin = self.at;
        let rest = &self.bytes[self.at..];
        let length = |at: usize| rest.get(at..at.checked_add(4)?).map(|mark| self.words.integer(mark));
        let Some(first) = length(0) else {
            return deviation(
                format!("the end of the file after {} bytes", self.bytes.len()),
                "one more record",
            );
        };
        let body = usize::try_from(first).ok().and_then(|n| rest.get(4..n.checked_add(4)?));
        match body {
            Some(body) if length(4 + body.len()) == Some(first) => {
                self.at += body.len() + 8;
                Ok(body)
            }
            _ => {
                let found = format!("a record of {first} bytes, {} before the end of the file", rest.len());
                deviation(found, "its length again after it")
            }
        }
    }
}

/// The next whole numbers of a record, `count` of them.
fn integers(words: Words, record: &mut &[u8], count: usize) -> std::result::Result<Vec<i64>, Deviation> {
    let Some((body, rest)) = record.split_at_checked(count * words.bytes) else {
        return deviation(
            format!("{} bytes", record.len()),
            format!("{count} numbers of {} bytes", words.bytes),
        );
    };
    *record = rest;
    Ok(body.chunks(words.bytes).map(|word| words.integer(word)).collect())
}

/// Puts the values of a string, which come next in a record, into a matrix.
fn push(
    matrix: &mut Matrix,
    words: Words,
    record: &mut &[u8],
    block: Block,
) -> std::result::Result<(), Deviation> {
    let size = matrix.words as usize * words.bytes;
    let Some((body, rest)) = record.split_at_checked(block.numbers as usize * size) else {
        let expected = format!("{} numbers of {size} bytes in column {}", block.numbers, matrix.column);
        return deviation(format!("{} bytes", record.len()), expected);
    };
    *record = rest;
    let numbers: Vec<f64> = body.chunks(size).map(|bytes| words.number(bytes)).collect();
    matrix.push(block, &numbers)
}

/// Every matrix of a file, or the place of what is wrong.
pub(super) fn read(file: &File) -> std::result::Result<Vec<Matrix>, (String, Deviation)> {
    let words = Words::of(file.bytes).unwrap_or(Words { bytes: 4, little: true });
    let mut records = Records { bytes: file.bytes, words, at: 0, begin: 0 };
    let mut all = Vec::new();
    while records.at < file.bytes.len() {
        match matrix(file, &mut records) {
            Ok(matrix) => all.push(matrix),
            Err(deviation) => return Err((format!("{} byte {}", file.name, records.begin), deviation)),
        }
    }
    Ok(all)
}

fn matrix(file: &File, records: &mut Records<'_>) -> std::result::Result<Matrix, Deviation> {
    let words = records.words;
    let mut first = records.next()?;
    let four = integers(words, &mut first, 4)?;
    let &[columns, rows, form, kind] = four.as_slice() else { unreachable!("four") };
    if first.len() != 2 * words.bytes {
        return deviation(format!("{} bytes", first.len()), format!("a name of {} bytes", 2 * words.bytes));
    }
    // Words of eight bytes hold four characters each, or all eight.
    let name = if words.bytes == 8 && first[4..8] == *b"    " {
        [&first[..4], &first[8..12]].concat()
    } else {
        first.to_vec()
    };
    let name = String::from_utf8_lossy(&name).trim().to_string();
    let double = (8 / words.bytes) as i64;
    let place = format!("{} byte {}", file.name, records.begin);
    let mut matrix = Matrix::new([columns, rows, form, kind], name, double, place)?;
    loop {
        let mut record = records.next()?;
        let three = integers(words, &mut record, 3)?;
        let &[column, row, count] = three.as_slice() else { unreachable!("three") };
        if !matrix.begin(column)? {
            return Ok(matrix);
        }
        if record.len() as i64 != count.saturating_mul(words.bytes as i64) || count < 1 {
            let found = format!("{count} words in column {column}, of {} bytes", record.len());
            return deviation(found, "as many words as the record has");
        }
        if row != 0 {
            let block = matrix.checked(Block { row, numbers: count / matrix.words })?;
            push(&mut matrix, words, &mut record, block)?;
        }
        while row == 0 && !record.is_empty() {
            let string = integers(words, &mut record, matrix.header())?;
            let (block, _) = matrix.string(&string)?;
            push(&mut matrix, words, &mut record, block)?;
        }
        if !record.is_empty() {
            return deviation(format!("{} bytes after the values of column {column}", record.len()), "none");
        }
    }
}
