//! One dataset of a universal file.

use super::record::{fields, whole};
use crate::error::{Error, Fault, Result};
use std::borrow::Cow;

/// A line with its number.
pub struct DatasetLine<'a> {
    /// Its text.
    pub text: Cow<'a, str>,
    /// Counted from 1.
    pub number: usize,
}

/// One dataset.
pub struct Dataset<'a> {
    /// Number of the type of dataset.
    pub kind: u32,
    /// Its lines of text.
    pub lines: Vec<DatasetLine<'a>>,
    /// Its numbers, where they are binary.
    pub binary: Option<Binary<'a>>,
    /// The file's name.
    pub file: &'a str,
    /// The number of its first line.
    pub first: usize,
}

/// Binary numbers.
pub struct Binary<'a> {
    /// Their bytes.
    pub data: &'a [u8],
    /// Whether the first byte of a number is the highest.
    pub big_endian: bool,
    /// Bytes of an abscissa (0 where it is even), and of a value.
    pub sizes: [usize; 2],
}

impl Dataset<'_> {
    /// A fault of the line with this index.
    pub fn fault(&self, index: usize, found: impl Into<String>, expected: impl Into<String>) -> Error {
        let number = self.lines.get(index).map_or(self.first, |line| line.number);
        let place = format!("{}:{number}, dataset {}", self.file, self.kind);
        Error::input(Fault::new(place, found, expected))
    }

    /// The file with the line in which the `k`-th number of the lines from `first` on stands, of which all but the last are of one
    /// length; that of the dataset where its numbers are binary.
    pub fn row_place(&self, first: usize, k: usize) -> String {
        let mut left = k;
        let holds = |line: &&DatasetLine<'_>| {
            let count = line.text.split_whitespace().count();
            let here = left < count;
            left = left.saturating_sub(count);
            here
        };
        let line = self.lines.iter().skip(first).find(holds);
        let number = line.map_or(self.first, |line| line.number);
        format!("{}:{number}, dataset {}", self.file, self.kind)
    }

    /// The line with this index.
    ///
    /// # Errors
    /// The dataset ends before it.
    pub fn line(&self, index: usize) -> Result<&str> {
        let cut = || self.fault(self.lines.len().saturating_sub(1), "the end of the dataset", "more lines");
        self.lines.get(index).map(|line| &*line.text).ok_or_else(cut)
    }

    /// Whole numbers at the beginning of a line.
    ///
    /// # Errors
    /// What is no whole number.
    pub fn wholes<const N: usize>(&self, index: usize, widths: [usize; N]) -> Result<[i64; N]> {
        let text = self.line(index)?;
        let mut numbers = [0; N];
        for (number, field) in numbers.iter_mut().zip(fields(text, &widths)) {
            *number = whole(&field).ok_or_else(|| self.fault(index, shown(&field), "a whole number"))?;
        }
        Ok(numbers)
    }

    /// All numbers of a line, NaN where a program could write none.
    ///
    /// # Errors
    /// What is no number.
    pub fn values(&self, index: usize, widths: &[usize]) -> Result<Vec<f64>> {
        let text = self.line(index)?;
        super::record::values(text, widths).map_err(|field| self.fault(index, shown(&field), "a number"))
    }

    /// All numbers of a line, finite.
    ///
    /// # Errors
    /// What is no finite number.
    pub fn numbers(&self, index: usize, widths: &[usize]) -> Result<Vec<f64>> {
        let text = self.line(index)?;
        super::record::numbers(text, widths)
            .map_err(|field| self.fault(index, shown(&field), "a finite number"))
    }
}

/// A field for a message.
pub fn shown(field: &str) -> String {
    match field.trim() {
        "" => "nothing".into(),
        field => format!("`{}`", field.chars().take(40).collect::<String>().escape_debug()),
    }
}
