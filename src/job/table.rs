//! Small tables in text files: a heading that names the columns, then one row a line (CSV, RFC 4180).
//!
//! Columns are separated by semicolons, tabs or commas, whichever the heading has; cells may stand in quotation marks. Numbers have
//! decimal points, or decimal commas where nothing else in the table speaks against them. A first line `sep=;` names the separator, and
//! a cell in quotation marks may go on in the next lines.

use crate::error::read::read_text;
use crate::error::{Error, Fault, Faults, Result, nearest};
use std::ops::Range;
use std::path::Path;

/// The most faults that are reported of one file.
pub(super) const MOST_FAULTS: usize = 20;
/// The most lines of one row.
const MOST_LINES: usize = 100;

/// A table with the file it comes from.
pub struct TextTable {
    name: String,
    text: String,
    separator: char,
    columns: Vec<String>,
    /// The line of the heading.
    heading: usize,
    /// The rows that are not empty: the first line of each and where its text is.
    records: Vec<(usize, Range<usize>)>,
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
    /// Whether the last cell began with a quotation mark that is not closed.
    open: bool,
}

impl<'a> Cells<'a> {
    fn of(text: &'a str, separator: char) -> Self {
        Cells { rest: Some(text), separator, open: false }
    }
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
                    None => {
                        self.open = true;
                        break quoted.len();
                    }
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

/// The separator that a first line such as `sep=;` names.
fn named_separator(line: &str) -> Option<char> {
    let line = line.trim_matches(|c| c == '"' || c == ' ' || c == '\r');
    let (key, mark) = line.split_at_checked(4)?;
    let mut marks = mark.chars();
    let named = key.eq_ignore_ascii_case("sep=").then(|| marks.next().unwrap_or(','))?;
    // A spreadsheet fills the line up with separators.
    marks.all(|c| c == ',' || c == ';' || c == '\t').then_some(named)
}

/// Where the text of the row ends that begins at `begin`: at the end of the line in which `open` no longer says that a quotation mark is
/// open; with the number of its lines.
///
/// # Errors
/// No such line among the next ones.
fn end_of_row(
    text: &str,
    begin: usize,
    open: impl Fn(&str) -> bool,
) -> std::result::Result<(usize, usize), ()> {
    let mut end = begin;
    for (k, line) in text[begin..].split_inclusive('\n').take(MOST_LINES).enumerate() {
        end += line.len();
        if !open(&text[begin..end]) {
            return Ok((end, k + 1));
        }
    }
    Err(())
}

/// What a column in kHz is to be instead.
fn in_khz(columns: &[String], known: &[&str]) -> Option<String> {
    let column = columns.iter().find(|column| column.contains("khz"))?;
    let hz: Vec<String> = known.iter().filter(|c| c.ends_with("_hz")).map(|c| format!("`{c}`")).collect();
    (!hz.is_empty()).then(|| {
        format!("\"{column}\" is in kHz: give 1000 times its numbers, in Hz, as {}", hz.join(" or "))
    })
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
        let mut faults = Faults::new();
        let mut never_closed = |line: usize| {
            let fault =
                Fault::new(format!("{name}:{line}"), "a quotation mark that is not closed", "its other one");
            faults.push(fault.with_help("Close it, or remove it"));
        };
        let (mut begin, mut line, mut named) = (0, 1, None);
        for text in text.split_inclusive('\n') {
            let mark = named_separator(text.trim_end_matches(['\n', '\r'])).filter(|_| named.is_none());
            if mark.is_none() && !text.trim().is_empty() {
                break;
            }
            named = named.or(mark);
            (begin, line) = (begin + text.len(), line + 1);
        }
        let first = line;
        // What separates the columns is known once the whole heading is.
        let odd = |heading: &str| heading.matches('"').count() % 2 == 1;
        let (mut end, lines) = end_of_row(&text, begin, odd).unwrap_or_else(|()| {
            let end = text[begin..].find('\n').map_or(text.len(), |k| begin + k + 1);
            (end, 1)
        });
        line += lines;
        let heading = &text[begin..end];
        let separator = named.unwrap_or_else(|| separator(heading));
        // Beyond these, every further column is not known or there twice.
        let most = known.len() + MOST_FAULTS;
        let cells = Cells::of(heading, separator);
        let words = |cell: &str| cell.split_whitespace().collect::<Vec<_>>().join(" ").to_lowercase();
        let columns: Vec<String> = cells.take(most).map(words).collect();
        let mut records = Vec::new();
        let open = |row: &str| {
            let mut cells = Cells::of(row, separator);
            cells.by_ref().for_each(drop);
            cells.open
        };
        while end < text.len() {
            let begin = end;
            let Ok((next, lines)) = end_of_row(&text, begin, open) else {
                never_closed(line);
                break;
            };
            end = next;
            let row = text[begin..end].trim_end_matches(['\n', '\r']);
            if !row.trim().is_empty() {
                records.push((line, begin..begin + row.len()));
            }
            line += lines;
        }
        let place = format!("{name}:{first}");
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
            let help = in_khz(&columns, known).unwrap_or("Name the columns in the first line".to_string());
            faults.push(Fault::new(place, found, all).with_help(help));
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
            } else if let Some(help) = in_khz(&columns[k..=k], known) {
                faults.push(Fault::new(&*place, found, all.clone()).with_help(help));
            } else if let Some(near) = nearest(column, known.iter().copied().filter(|name| name.len() > 3)) {
                let fault = Fault::new(&*place, found, all.clone());
                faults.push(fault.with_help(format!("Did you mean `{near}`?")));
            } else {
                unread.push(column.clone());
            }
        }
        let heading = first;
        let mut table =
            TextTable { name, separator, columns, heading, records, decimal_commas: false, unread, text };
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
        let row = |(line, at): &(usize, Range<usize>)| (*line, &self.text[at.clone()]);
        self.records.iter().map(row).map(|(line, text)| TextRow { table: self, line, text })
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
        Cells::of(self.text, self.table.separator)
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

    /// A first line that names the separator, cells that go on in the next lines, in the heading too, and blank lines: the same numbers,
    /// each with its line.
    #[test]
    fn what_spreadsheets_add_is_read() {
        for separator in [';', ',', '\t', '|'] {
            for named in ["", "sep=", "SEP=", "\"sep="] {
                if named.is_empty() && separator == '|' {
                    continue;
                }
                for (end, remark, lines) in [
                    ("\n", "plain", 1),
                    ("\r\n", "two\r\nlines; a,b", 2),
                    ("\n", "\"\"three\"\"\n\nlines", 3),
                ] {
                    let mut text = match named {
                        "" => String::new(),
                        _ => format!(
                            "{named}{separator}{}{end}",
                            if named.starts_with('"') { "\"" } else { "" }
                        ),
                    };
                    text += end;
                    let s = separator;
                    text += &format!("\"Frequency_Hz\"{s}\"{remark}\"{s}deviation{end}");
                    let before = text.matches('\n').count();
                    for k in 0..3 {
                        text += &format!("{k}.5{s}\"{remark}\"{s}{k}{end}{end}");
                    }
                    let table = table(&text).unwrap_or_else(|error| panic!("{text}\n{error}"));
                    let mut faults = Faults::new();
                    let read = |row: TextRow, faults: &mut Faults| {
                        (
                            row.line,
                            row.number("frequency_hz", 0.0, faults),
                            row.number("deviation", 9.0, faults),
                        )
                    };
                    let rows: Vec<_> = table.rows().map(|row| read(row, &mut faults)).collect();
                    let expected = |k: usize| (before + 1 + k * (lines + 1), k as f64 + 0.5, k as f64);
                    assert_eq!(rows, [0, 1, 2].map(expected), "{text:?}");
                    assert!(faults.0.is_empty());
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
            ("frequency_khz;deviation\n1;2\n", "\"frequency_khz\" is in kHz: give 1000 times"),
            ("Frequency [kHz]\n1\n", "in Hz, as `frequency_hz`"),
            ("frequency_hz;f_kHz\n1;2\n", "\"f_khz\" is in kHz"),
            ("frequency_hz;remark\n1;a\n2;\"b\n3;c\n", "a.csv:3: found a quotation mark that is not closed"),
        ] {
            let Err(Error::Input(faults)) = table(text) else { panic!("{text}") };
            assert!(faults.0.len() == 1 && faults.to_string().contains(expected), "{faults}");
        }
        assert_eq!(table("\n\nfrequency_hz;\n1;\n2;;\n").unwrap().rows().count(), 2);
    }
}
