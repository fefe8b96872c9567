//! Small tables in text files: a heading that names the columns, then one row a line (CSV without quotes).

use crate::error::read::read_text;
use crate::error::{Fault, Faults, Result};
use std::path::Path;

/// The most faults that are reported of one file.
pub(super) const MOST_FAULTS: usize = 20;

/// A table with the file it comes from.
pub struct TextTable {
    name: String,
    text: String,
    separator: char,
    columns: Vec<String>,
}

/// One row with its line.
#[derive(Clone, Copy)]
pub struct TextRow<'a> {
    table: &'a TextTable,
    line: usize,
    text: &'a str,
}

impl TextTable {
    /// Reads the file at `path`; see [`TextTable::parse`].
    ///
    /// # Errors
    /// No such file, and those of [`TextTable::parse`].
    pub fn read(path: &Path, required: &[&str], known: &[&str]) -> Result<TextTable> {
        let name = path.display().to_string();
        let text = read_text(path, "a table (CSV)")?;
        TextTable::parse(name, text, required, known)
    }

    /// The table of the `text` of the file `name`; its heading may only name columns among `known` and must name all of
    /// `required`.
    ///
    /// # Errors
    /// Columns that are not known, missing or named twice, rows of another length.
    pub fn parse(name: String, text: String, required: &[&str], known: &[&str]) -> Result<TextTable> {
        let heading = text.lines().next().unwrap_or("");
        let separator = if heading.contains(';') { ';' } else { ',' };
        // Beyond these, every further column is not known or there twice.
        let most = known.len() + MOST_FAULTS;
        let columns: Vec<String> =
            heading.split(separator).take(most).map(|c| c.trim().to_lowercase()).collect();
        let mut faults = Faults::new();
        let all = format!("columns among {}", known.join(", "));
        for (k, column) in columns.iter().enumerate() {
            if !known.contains(&column.as_str()) || columns[..k].contains(column) {
                faults.push(Fault::new(format!("{name}:1"), format!("the column \"{column}\""), all.clone()));
            }
        }
        for column in required.iter().filter(|c| !columns.iter().any(|have| have == *c)) {
            faults.push(Fault::new(format!("{name}:1"), format!("no column \"{column}\""), all.clone()));
        }
        let table = TextTable { name, separator, columns, text };
        let width = table.columns.len();
        for row in table.rows() {
            if faults.0.len() >= MOST_FAULTS {
                break;
            }
            let cells = row.text.split(separator).count();
            if cells != width {
                faults.push(Fault::new(
                    row.place(),
                    format!("{cells} cells"),
                    format!("{width}, as in the heading"),
                ));
            }
        }
        faults.0.truncate(MOST_FAULTS);
        faults.into_result(table)
    }

    /// The rows that are not empty.
    pub fn rows(&self) -> impl Iterator<Item = TextRow<'_>> {
        let lines = self.text.lines().enumerate().skip(1).filter(|(_, line)| !line.trim().is_empty());
        lines.map(|(k, text)| TextRow { table: self, line: k + 1, text })
    }

    /// The file's name.
    pub fn name(&self) -> &str {
        &self.name
    }
}

impl<'a> TextRow<'a> {
    /// File and line.
    pub fn place(&self) -> String {
        format!("{}:{}", self.table.name, self.line)
    }

    /// The cell in `column`; empty when there is no such column.
    pub fn cell(&self, column: &str) -> &'a str {
        let index = self.table.columns.iter().position(|c| c == column);
        index.and_then(|i| self.text.split(self.table.separator).nth(i)).unwrap_or("").trim()
    }

    /// The number in `column`, or `default` when the cell is empty.
    pub fn number(&self, column: &str, default: f64, faults: &mut Faults) -> f64 {
        let cell = self.cell(column);
        match cell.parse::<f64>() {
            _ if cell.is_empty() => default,
            Ok(value) if value.is_finite() => value,
            _ => {
                faults.push(Fault::new(
                    format!("{} `{column}`", self.place()),
                    format!("\"{cell}\""),
                    "a finite number",
                ));
                default
            }
        }
    }
}
