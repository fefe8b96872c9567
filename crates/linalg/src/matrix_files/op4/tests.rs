//! Matrices written as text and binary, dense and sparse, read again; and every whole number of such a file changed.

use super::super::{Found, parse};
use crate::matrix_market::MarketMatrix;

/// Entries of columns: first row from 0, real and imaginary parts.
type Column = Vec<(usize, Vec<[f64; 2]>)>;

#[derive(Debug, Clone, Copy)]
struct Style {
    binary: bool,
    /// Bytes of a word.
    word: usize,
    little: bool,
    kind: i64,
    sparse: bool,
    big: bool,
}

/// Text and bytes side by side: a whole number, a value, the ends of records.
struct Writer {
    style: Style,
    out: Vec<u8>,
    record: Vec<u8>,
}

impl Writer {
    fn integers(&mut self, numbers: &[i64]) {
        if !self.style.binary {
            numbers.iter().for_each(|number| self.out.extend(format!("{number:>8}").bytes()));
            self.out.push(b'\n');
            return;
        }
        for number in numbers {
            let mut bytes = number.to_le_bytes()[..self.style.word].to_vec();
            self.record.extend(self.ordered(&mut bytes));
        }
    }

    fn ordered(&self, bytes: &mut Vec<u8>) -> Vec<u8> {
        if !self.style.little {
            bytes.reverse();
        }
        std::mem::take(bytes)
    }

    fn values(&mut self, values: &[f64]) {
        if !self.style.binary {
            for line in values.chunks(3) {
                line.iter().for_each(|value| self.out.extend(fortran(*value).bytes()));
                self.out.push(b'\n');
            }
            return;
        }
        for value in values {
            let single = self.style.word == 4 && self.style.kind % 2 == 1;
            let mut bytes =
                if single { (*value as f32).to_le_bytes().to_vec() } else { value.to_le_bytes().to_vec() };
            self.record.extend(self.ordered(&mut bytes));
        }
    }

    fn end(&mut self) {
        if self.style.binary {
            let mark = self.ordered(&mut (self.record.len() as u32).to_le_bytes().to_vec());
            self.out.extend(&mark);
            self.out.append(&mut self.record);
            self.out.extend(&mark);
        }
    }
}

/// 23 characters.
fn fortran(value: f64) -> String {
    let text = format!("{value:.16e}");
    let (mantissa, exponent) = text.split_once('e').unwrap();
    format!("{mantissa:>19}E{:+03}", exponent.parse::<i32>().unwrap())
}

fn written(style: Style, rows: i64, form: i64, columns: &[Column]) -> Vec<u8> {
    let mut writer = Writer { style, out: Vec::new(), record: Vec::new() };
    let Style { binary, word, kind, sparse, big, .. } = style;
    let each = if kind > 2 { 2 } else { 1 };
    let words = if kind % 2 == 0 && (word == 4 || !binary) { 2 } else { 1 };
    let head = [columns.len() as i64, if big { -rows } else { rows }, form, kind];
    writer.integers(&head);
    if binary {
        writer.record.extend(if word == 4 { &b"KAA     "[..] } else { &b"KAA             "[..] });
    } else {
        writer.out.pop();
        writer.out.extend(b"KAA     1P,3E23.16\n");
    }
    writer.end();
    let flat = |values: &[[f64; 2]]| values.iter().flat_map(|z| z[..each].to_vec()).collect::<Vec<f64>>();
    for (j, column) in columns.iter().enumerate().filter(|(_, column)| !column.is_empty()) {
        let strings: Vec<(usize, Vec<f64>)> =
            column.iter().map(|(row, values)| (*row, flat(values))).collect();
        if sparse {
            let headers = if big { 2 } else { 1 };
            let all: usize = strings.iter().map(|(_, values)| values.len() * words + headers).sum();
            writer.integers(&[j as i64 + 1, 0, all as i64]);
            for (row, values) in strings {
                let (length, row) = ((values.len() * words) as i64, row as i64 + 1);
                if big {
                    writer.integers(&[length + 1, row]);
                } else {
                    writer.integers(&[row + 65_536 * (length + 1)]);
                }
                writer.values(&values);
            }
        } else {
            let first = strings[0].0;
            let (last, end) = strings.last().unwrap();
            let mut values = vec![0.0; (last - first) * each + end.len()];
            for (row, own) in &strings {
                values[(row - first) * each..][..own.len()].copy_from_slice(own);
            }
            let count = if binary { values.len() * words } else { values.len() };
            writer.integers(&[j as i64 + 1, first as i64 + 1, count as i64]);
            writer.values(&values);
        }
        writer.end();
    }
    writer.integers(&[columns.len() as i64 + 1, 1, 1]);
    writer.values(&[1.0]);
    writer.end();
    writer.out
}

fn styles() -> impl Iterator<Item = Style> {
    let files = [(false, 4, true), (true, 4, true), (true, 4, false), (true, 8, true), (true, 8, false)];
    let forms = [(false, false), (true, false), (true, true)];
    files.into_iter().flat_map(move |(binary, word, little)| {
        let kinds = (1..=4).flat_map(move |kind| forms.map(|(sparse, big)| (kind, sparse, big)));
        kinds.map(move |(kind, sparse, big)| Style { binary, word, little, kind, sparse, big })
    })
}

/// Five rows, four columns, one of them empty; numbers that single precision has.
fn columns() -> Vec<Column> {
    let z = |re: f64, im: f64| [re, im];
    vec![
        vec![(0, vec![z(4.0, 0.5), z(-1.5, 0.0)]), (4, vec![z(0.25, -1.0)])],
        Vec::new(),
        vec![(3, vec![z(7.0, 2.0)])],
        vec![(1, vec![z(1.0, 1.0)]), (3, vec![z(-2.0, 3.0), z(9.0, -8.0)])],
    ]
}

fn read(bytes: &[u8]) -> crate::matrix_files::Result<MarketMatrix> {
    match parse("a", bytes, 'K', 0)? {
        Found::Whole(matrix) => Ok(matrix),
        Found::Labelled(_) => panic!("by number"),
    }
}

#[test]
fn every_kind_of_file_reads_back_as_it_was_written() {
    for style in styles() {
        let columns = columns();
        let matrix =
            read(&written(style, 5, 2, &columns)).unwrap_or_else(|error| panic!("{style:?}: {error}"));
        assert_eq!(matrix.im.is_some(), style.kind > 2);
        for (j, column) in columns.iter().enumerate() {
            for i in 0..5_usize {
                let own = column.iter().find_map(|(row, values)| values.get(i.checked_sub(*row)?).copied());
                let [re, im] = own.unwrap_or_default();
                let value = |a: &crate::SparseMatrix| a.get(i, j).copied().unwrap_or(0.0);
                assert_eq!(value(&matrix.re), re, "{style:?} {i} {j}");
                assert!(matrix.im.as_ref().is_none_or(|a| value(a) == im), "{style:?} {i} {j}");
            }
        }
        // Half of a symmetric matrix is completed; of another form it is as it is.
        let lower: Vec<Column> = vec![vec![(0, vec![[4.0, 0.0], [-1.5, 0.0]])], vec![(1, vec![[8.0, 0.0]])]];
        for (form, wanted) in [(6, -1.5), (1, 0.0)] {
            let matrix = read(&written(style, 2, form, &lower)).unwrap();
            assert_eq!(matrix.re.get(0, 1).copied().unwrap_or(0.0), wanted, "{style:?}");
        }
    }
}

/// Columns out of order, twice, or beyond the last; rows beyond the last; counts that are negative or too large; a file cut anywhere before
/// the last value.
#[test]
fn wrong_numbers_and_cut_files_are_faults() {
    let refused = |bytes: &[u8], what: &str, style: Style| {
        let message = read(bytes).expect_err(what).to_string();
        let place = if style.binary { "a byte " } else { "a:" };
        assert!(message.starts_with(place) && message.contains("expected"), "{style:?} {what}: {message}");
    };
    let full = || -> Vec<Column> { (0..3).map(|j| vec![(j, vec![[2.0, 1.0]])]).collect() };
    for style in styles() {
        let good = written(style, 3, 1, &full());
        assert!(read(&good).is_ok(), "{style:?}");
        // By their numbers, each of which stands once as the number of a column, with that of another one.
        let columns = [(1, "first"), (2, "second"), (3, "third"), (4, "the end")];
        let first = record_starts(&good, style);
        for (at, (number, what)) in columns.into_iter().enumerate() {
            for other in [-1, 0, 1, 2, 3, 4, 5, 70_000] {
                // A column in the place of an empty one is as good, and so is an earlier end if nothing follows.
                let as_good = number == 3 && other == 4;
                if other != number && !as_good {
                    let mut bytes = good.clone();
                    set(&mut bytes, first[at + 1], other, style);
                    refused(&bytes, &format!("{what} column, {other}"), style);
                }
            }
        }
        // Columns, rows and kind; form.
        for (k, values) in
            [(0, &[-3, 0, 2, i64::MAX][..]), (1, &[0, 2, i64::MAX]), (2, &[0, 3, -1]), (3, &[0, 5, -2])]
        {
            for value in values {
                let mut bytes = good.clone();
                set(&mut bytes, first[0] + k * width(style), *value, style);
                refused(&bytes, &format!("number {k} of the head, {value}"), style);
            }
        }
        // The first row and the number of words of the last column.
        for (k, values) in [(1, &[-1, 4, 70_000][..]), (2, &[-1, 0, 7, 70_000])] {
            for value in values {
                let mut bytes = good.clone();
                set(&mut bytes, first[3] + k * width(style), *value, style);
                refused(&bytes, &format!("number {k} of column 3, {value}"), style);
            }
        }
        for end in 1..first[4] {
            let error = read(&good[..end]).expect_err("cut").to_string();
            assert!(error.contains("expected"), "{style:?} {end}: {error}");
        }
    }
}

/// Bytes of a whole number.
fn width(style: Style) -> usize {
    if style.binary { style.word } else { 8 }
}

/// Where the first number of each record is: the head, columns 1 to 3, the end.
fn record_starts(bytes: &[u8], style: Style) -> Vec<usize> {
    if !style.binary {
        let mut starts = vec![0];
        let mut at = 0;
        for line in bytes.split_inclusive(|byte| *byte == b'\n') {
            if line.len() == 25 && starts.len() < 5 {
                starts.push(at);
            }
            at += line.len();
        }
        return starts;
    }
    let (mut starts, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        let mark: [u8; 4] = bytes[at..at + 4].try_into().unwrap();
        starts.push(at + 4);
        at += 8 + if style.little { u32::from_le_bytes(mark) } else { u32::from_be_bytes(mark) } as usize;
    }
    starts
}

fn set(bytes: &mut [u8], at: usize, value: i64, style: Style) {
    let width = width(style);
    if !style.binary {
        let text = format!("{value:>8}");
        bytes[at..at + 8].copy_from_slice(&text.as_bytes()[..8]);
        return;
    }
    let mut number =
        if style.word == 4 { (value as i32).to_le_bytes().to_vec() } else { value.to_le_bytes().to_vec() };
    if !style.little {
        number.reverse();
    }
    bytes[at..at + width].copy_from_slice(&number);
}
