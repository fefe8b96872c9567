//! A matrix of OUTPUT4 while its records are read: what they may say.

use crate::c64;
use crate::matrix_market::{Entry, LARGEST};

/// What is not as it should be: what was found, what is expected.
pub type Deviation = (String, String);

pub fn deviation<T>(
    found: impl Into<String>,
    expected: impl Into<String>,
) -> std::result::Result<T, Deviation> {
    Err((found.into(), expected.into()))
}

/// From so many rows on a string has its length and first row by themselves.
const MANY_ROWS: i64 = 65_536;

/// Where a string of values is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block {
    /// The first row, from 1.
    pub row: i64,
    /// How many numbers follow; two of each complex value.
    pub numbers: i64,
}

/// A matrix while its records are read.
#[derive(Debug)]
pub struct Matrix {
    pub name: String,
    pub rows: i64,
    pub columns: i64,
    pub form: i64,
    pub complex: bool,
    /// Words of a number.
    pub words: i64,
    /// Whether a string has two numbers above it.
    big: bool,
    /// The place of its first line or record.
    pub place: String,
    pub entries: Vec<Entry>,
    /// The column that is read, and the first row of it that may follow.
    pub column: i64,
    row: i64,
}

impl Matrix {
    /// From the four numbers that it begins with; `double` is the number of words of a number of double precision.
    pub fn new(
        [columns, rows, form, kind]: [i64; 4],
        name: String,
        double: i64,
        place: String,
    ) -> std::result::Result<Self, Deviation> {
        let most = LARGEST as i64;
        let size = rows.checked_abs().unwrap_or(i64::MAX);
        if !(1..=most).contains(&columns) || !(1..=most).contains(&size) {
            return deviation(
                format!("{rows} rows and {columns} columns"),
                format!("between 1 and {LARGEST} of each"),
            );
        }
        if !(1..=4).contains(&kind) {
            return deviation(format!("kind {kind} of numbers"), "1, 2, 3 or 4");
        }
        Ok(Matrix {
            name,
            rows: size,
            columns,
            form,
            complex: kind > 2,
            words: if kind % 2 == 0 { double } else { 1 },
            big: !(0..MANY_ROWS).contains(&rows),
            place,
            entries: Vec::new(),
            column: 0,
            row: 1,
        })
    }

    /// Begins a column; whether there is one, or the end of the matrix.
    pub fn begin(&mut self, column: i64) -> std::result::Result<bool, Deviation> {
        if column <= self.column || column > self.columns + 1 {
            let (first, last) = (self.column + 1, self.columns);
            let expected = if first > last {
                format!("{first}, which ends {}", self.name)
            } else {
                format!("one from {first} to {last}, or {}, which ends {}", last + 1, self.name)
            };
            return deviation(format!("column {column}"), expected);
        }
        (self.column, self.row) = (column, 1);
        Ok(column <= self.columns)
    }

    /// The rows of a string of numbers are in the matrix, and below those before.
    pub fn checked(&self, block: Block) -> std::result::Result<Block, Deviation> {
        let Block { row, numbers } = block;
        let each = if self.complex { 2 } else { 1 };
        if numbers < 1 || numbers % each != 0 {
            let whole = if self.complex { "an even number of numbers" } else { "one number or more" };
            return deviation(format!("{numbers} numbers in column {}", self.column), whole);
        }
        if row < self.row || numbers / each > self.rows - row + 1 {
            let found = format!("{} values from row {row} on in column {}", numbers / each, self.column);
            return deviation(found, format!("rows from {} to {}", self.row, self.rows));
        }
        Ok(block)
    }

    /// The string whose length and first row are `numbers`, one or two of them, and how many words it takes with these.
    pub fn string(&self, numbers: &[i64]) -> std::result::Result<(Block, i64), Deviation> {
        let (words, row) = match numbers {
            [length, row] => (length.saturating_sub(1), *row),
            [is] => (is / MANY_ROWS - 1, is % MANY_ROWS),
            _ => unreachable!("one or two"),
        };
        if words < 1 || words % self.words != 0 {
            let expected = format!("a string of {} words or a multiple", self.words);
            return deviation(format!("a string of {words} words in column {}", self.column), expected);
        }
        let block = self.checked(Block { row, numbers: words / self.words })?;
        Ok((block, words.saturating_add(numbers.len() as i64)))
    }

    /// Numbers on each string.
    pub fn header(&self) -> usize {
        if self.big { 2 } else { 1 }
    }

    /// The values of a string that was [checked](Self::checked).
    pub fn push(&mut self, block: Block, numbers: &[f64]) -> std::result::Result<(), Deviation> {
        let at = |k: i64| Entry {
            row: (block.row - 1 + k) as u32,
            column: (self.column - 1) as u32,
            value: c64::new(0.0, 0.0),
        };
        if let Some(wrong) = numbers.iter().find(|number| !number.is_finite()) {
            return deviation(format!("{wrong} in column {}", self.column), "finite numbers");
        }
        let each = if self.complex { 2 } else { 1 };
        self.row = block.row;
        for (k, value) in numbers.chunks(each).enumerate() {
            let value = c64::new(value[0], value.get(1).copied().unwrap_or(0.0));
            self.entries.push(Entry { value, ..at(k as i64) });
            self.row += 1;
        }
        Ok(())
    }
}
