//! Small tables in text files: a heading that names the columns, then one row a line (CSV, RFC 4180).
//!
//! Columns are separated by semicolons, tabs or commas, whichever the heading has; cells may stand in quotation marks. Numbers have
//! decimal points, or decimal commas where nothing else in the table speaks against them.

use crate::error::read::read_text;
use crate::error::{Error, Fault, Faults, Result, nearest};
use std::path::Path;

/// The most faults that are reported of one file.
pub(super) const MOST_FAULTS: usize = 20;

/// A table with the file it comes from.
pub struct TextTable {
    name: String,
    text: String,
    separator: char,
    columns: Vec<String>,
    /// Lines before the first row.
    heading: usize,
    decimal_commas: bool,
    /// Columns that are not read.
    unread: Vec<String>,
}

/// One row with its line.
#[derive(Clone, Copy)]
pub struct TextRow<'a> {
    table: &'a TextTable,
    line: usize,
    text: &'a str,
}

/// The cells of a row, without blanks and quotation marks about them; a mark inside of a quoted cell is doubled.
struct Cells<'a> {
    rest: Option<&'a str>,
    separator: char,
}

impl<'a> Iterator for Cells<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        let text = self.rest?;
        let blank = |c: char| c.is_whitespace() && c != self.separator;
        let begin = text.trim_start_matches(blank);
        if let Some(quoted) = begin.strip_prefix('"') {
            let mut from = 0;
            let end = loop {
                match quoted[from..].find('"').map(|k| from + k) {
                    Some(k) if quoted[k + 1..].starts_with('"') => from = k + 2,
                    Some(k) => break k,
                    None => break quoted.len(),
                }
            };
            let behind = quoted.get(end + 1..).unwrap_or("");
            self.rest = behind.find(self.separator).map(|k| &behind[k + 1..]);
            return Some(quoted[..end].trim());
        }
        match text.split_once(self.separator) {
            Some((cell, rest)) => {
                self.rest = Some(rest);
                Some(cell.trim())
            }
            None => {
                self.rest = None;
                Some(text.trim())
            }
        }
    }
}

/// The separator of the columns in a heading.
fn separator(heading: &str) -> char {
    let outside = |wanted: char| heading.split('"').step_by(2).any(|part| part.contains(wanted));
    [';', '\t'].into_iter().find(|c| outside(*c)).unwrap_or(',')
}

/// What a cell says of the decimal mark of its table.
enum Decimal {
    Point,
    /// Whether what follows can only be decimals, and not thousands.
    Comma(bool),
    Neither,
}

fn decimal(cell: &str) -> Decimal {
    if cell.contains('.') && cell.parse::<f64>().is_ok() {
        return Decimal::Point;
    }
    match cell.split_once(',') {
        Some((whole, part)) if !whole.contains('.') && cell.replacen(',', ".", 1).parse::<f64>().is_ok() => {
            let digits = whole.trim_start_matches(['+', '-']);
            Decimal::Comma(
                part.len() != 3 || digits.is_empty() || digits.starts_with('0') || digits.len() > 3,
            )
        }
        _ => Decimal::Neither,
    }
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

    /// The table of the `text` of the file `name`, whose heading must name all columns of `required`; of the others those among
    /// `known` are read.
    ///
    /// # Errors
    /// Columns that are missing or named twice, or whose name is nearly that of a known one; rows of another length; decimal
    /// commas that cannot be distinguished from separators or thousands.
    pub fn parse(name: String, text: String, required: &[&str], known: &[&str]) -> Result<TextTable> {
        let blank = text.lines().take_while(|line| line.trim().is_empty()).count();
        let heading = text.lines().nth(blank).unwrap_or("");
        let separator = separator(heading);
        // Beyond these, every further column is not known or there twice.
        let most = known.len() + MOST_FAULTS;
        let cells = Cells { rest: Some(heading), separator };
        let columns: Vec<String> = cells.take(most).map(str::to_lowercase).collect();
        let mut faults = Faults::new();
        let place = format!("{name}:{}", blank + 1);
        let all = format!("columns among {}", known.join(", "));
        let missing: Vec<&&str> =
            required.iter().filter(|c| !columns.iter().any(|have| have == *c)).collect();
        if !missing.is_empty() {
            let [missing, found] = [
                missing.iter().map(|c| format!("\"{c}\"")).collect::<Vec<_>>(),
                columns.iter().map(|c| format!("\"{c}\"")).collect(),
            ]
            .map(|list| list.join(", "));
            let plural = if required.len() > 1 { "s" } else { "" };
            let found = format!("no column{plural} {missing} in the heading {found}");
            faults.push(Fault::new(place, found, all).with_help("Name the columns in the first line"));
            return faults.into_result(()).map(|()| unreachable!("there is a fault"));
        }
        let mut unread = Vec::new();
        for (k, column) in columns.iter().enumerate() {
            let found = format!("the column \"{column}\"");
            if columns[..k].contains(column) {
                if known.contains(&column.as_str()) {
                    faults.push(Fault::new(&*place, format!("{found} again"), "each column once"));
                }
            } else if known.contains(&column.as_str()) || column.is_empty() {
            } else if let Some(near) = nearest(column, known.iter().copied().filter(|name| name.len() > 3)) {
                let fault = Fault::new(&*place, found, all.clone());
                faults.push(fault.with_help(format!("Did you mean `{near}`?")));
            } else {
                unread.push(column.clone());
            }
        }
        let mut table =
            TextTable { name, separator, columns, text, heading: blank + 1, decimal_commas: false, unread };
        table.check_rows(&mut faults);
        table.decimal_commas = faults.take(table.find_decimal_commas(known)).unwrap_or(false);
        faults.0.truncate(MOST_FAULTS);
        faults.into_result(table)
    }

    /// Rows of another length than the heading, but for empty cells at their ends.
    fn check_rows(&self, faults: &mut Faults) {
        let width = self.columns.len();
        for row in self.rows() {
            if faults.0.len() >= MOST_FAULTS {
                break;
            }
            let count = row.cells().count();
            let surplus = count > width && row.cells().skip(width).any(|cell| !cell.is_empty());
            if count >= width && !surplus {
                continue;
            }
            let mut fault =
                Fault::new(row.place(), format!("{count} cells"), format!("{width}, as in the heading"));
            let commas = surplus && self.separator == ',' && !row.text.contains(['.', '"']);
            if commas {
                let help = "Commas between columns and decimal commas cannot be told apart: separate columns by semicolons or \
                            write decimal points";
                fault = fault.with_help(help);
            }
            faults.push(fault);
            // The same holds for the other rows.
            if commas {
                break;
            }
        }
    }

    /// Whether numbers have decimal commas.
    fn find_decimal_commas(&self, known: &[&str]) -> Result<bool> {
        let known: Vec<bool> = self.columns.iter().map(|c| known.contains(&c.as_str())).collect();
        let (mut comma, mut point, mut certain) = (None, None, false);
        for row in self.rows() {
            let cells = row.cells().zip(&known).filter(|(_, known)| **known);
            for (cell, _) in cells {
                match decimal(cell) {
                    Decimal::Point => point = point.or(Some((row, cell))),
                    Decimal::Comma(only_decimals) => {
                        comma = comma.or(Some((row, cell)));
                        certain |= only_decimals;
                    }
                    Decimal::Neither => {}
                }
            }
        }
        let Some((row, cell)) = comma else { return Ok(false) };
        let fault = |found: String, expected: &str| {
            let help = "Write decimal points in the whole file, and no separators of thousands";
            Err(Error::input(Fault::new(row.place(), found, expected).with_help(help)))
        };
        match point {
            Some((other, number)) => {
                let found = format!("\"{cell}\" beside \"{number}\" in line {}", other.line);
                fault(found, "one decimal mark in the file")
            }
            None if !certain => {
                fault(format!("\"{cell}\", which may be thousands or decimals"), "decimal points")
            }
            None => Ok(true),
        }
    }

    /// The rows that are not empty.
    pub fn rows(&self) -> impl Iterator<Item = TextRow<'_>> {
        let lines = self.text.lines().enumerate().skip(self.heading);
        let lines = lines.filter(|(_, line)| !line.trim().is_empty());
        lines.map(|(k, text)| TextRow { table: self, line: k + 1, text })
    }

    /// The file's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What the user should know of how the table was read.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.decimal_commas {
            warnings.push(format!("{}: its commas were read as decimal points", self.name));
        }
        if !self.unread.is_empty() {
            let list: Vec<String> = self.unread.iter().map(|column| format!("\"{column}\"")).collect();
            warnings.push(format!("{}: columns that are not read: {}", self.name, list.join(", ")));
        }
        warnings
    }

    /// The columns that are not read as one fault, where all must be among the `known` ones.
    ///
    /// # Errors
    /// A column that is not.
    pub fn all_read(self, known: &[&str]) -> Result<TextTable> {
        let mut faults = Faults::new();
        if !self.unread.is_empty() {
            let list: Vec<String> = self.unread.iter().map(|column| format!("\"{column}\"")).collect();
            let columns = if list.len() == 1 { "column" } else { "columns" };
            let found = format!("the {columns} {}", list.join(", "));
            let expected = format!("no others than {}", known.join(", "));
            let fault = Fault::new(format!("{}:{}", self.name, self.heading), found, expected);
            faults.push(fault.with_help("Remove what is not read, or name it as what it is"));
        }
        faults.into_result(self)
    }
}

impl<'a> TextRow<'a> {
    /// File and line.
    pub fn place(&self) -> String {
        format!("{}:{}", self.table.name, self.line)
    }

    fn cells(&self) -> Cells<'a> {
        Cells { rest: Some(self.text), separator: self.table.separator }
    }

    /// The cell in `column`; empty when there is no such column.
    pub fn cell(&self, column: &str) -> &'a str {
        let index = self.table.columns.iter().position(|c| c == column);
        index.and_then(|i| self.cells().nth(i)).unwrap_or("")
    }

    /// The number in `column`, or `default` when the cell is empty.
    pub fn number(&self, column: &str, default: f64, faults: &mut Faults) -> f64 {
        let cell = self.cell(column);
        let value = match self.table.decimal_commas {
            true => cell.replacen(',', ".", 1).parse::<f64>(),
            false => cell.parse::<f64>(),
        };
        match value {
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

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMNS: [&str; 3] = ["frequency_hz", "damping_ratio", "deviation"];

    fn table(text: &str) -> Result<TextTable> {
        TextTable::parse("a.csv".into(), text.into(), &COLUMNS[..1], &COLUMNS)
    }

    /// Separators, quotation marks, columns of other things in any place, decimal marks: the same numbers.
    #[test]
    fn the_same_numbers_are_read_however_they_are_written() {
        let numbers = [[410.82, 0.003], [1616.1, 0.0025], [-3.0, 0.5]];
        for separator in [",", ";", "\t", " ; "] {
            for (quote, decimal) in [("", "."), ("\"", "."), ("\"", ","), ("", ",")] {
                if separator == "," && quote.is_empty() && decimal == "," {
                    continue;
                }
                for place in 0..3 {
                    let line = |cells: [String; 2], remark: &str| {
                        let mut cells = cells.map(|cell| format!("{quote}{cell}{quote}")).to_vec();
                        cells.insert(place, format!("\"{remark}\""));
                        cells.join(separator) + "\n"
                    };
                    let mut text = line(["Frequency_Hz", "damping_ratio"].map(String::from), "comment");
                    for row in numbers {
                        text +=
                            &line(row.map(|x| format!("{x}").replace('.', decimal)), "a, b; \"\"c\"\"\t1.5");
                    }
                    let table = table(&text).unwrap_or_else(|error| panic!("{text}\n{error}"));
                    let mut faults = Faults::new();
                    for (row, expected) in table.rows().zip(numbers) {
                        let read = [0, 1].map(|k| row.number(COLUMNS[k], 0.0, &mut faults));
                        assert_eq!(read, expected, "{text}");
                    }
                    assert!(faults.0.is_empty() && table.rows().count() == 3);
                    let said = table.warnings().join("\n");
                    assert_eq!(said.contains("decimal points"), decimal == ",", "{said}");
                    assert!(said.contains("\"comment\"") && table.all_read(&["f"]).is_err());
                }
            }
        }
    }

    #[test]
    fn what_cannot_be_told_is_one_clear_fault() {
        for (text, expected) in [
            ("frequency_hz,damping_ratio\n410,82,0,003\n1,5,0,1\n", "semicolons"),
            ("frequency_hz;damping_ratio\n410,82;0.003\n1,5;0.1\n", "one decimal mark"),
            ("frequency_hz\n\"1,234\"\n\"2,345\"\n", "thousands or decimals"),
            (
                "Frequenz [Hz];Dämpfung [%]\n410,82;0,3\n",
                "no column \"frequency_hz\" in the heading \"frequenz [hz]\"",
            ),
            ("frequency_hz;damping_ration\n1;2\n", "Did you mean `damping_ratio`"),
            ("frequency_hz;frequency_hz\n1;2\n", "again"),
            ("frequency_hz;deviation\n1\n", "found 1 cells; expected 2"),
        ] {
            let Err(Error::Input(faults)) = table(text) else { panic!("{text}") };
            assert!(faults.0.len() == 1 && faults.to_string().contains(expected), "{faults}");
        }
        assert_eq!(table("\n\nfrequency_hz;\n1;\n2;;\n").unwrap().rows().count(), 2);
    }
}
