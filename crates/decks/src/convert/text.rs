//! A case as text: tables with comments, keys with values.

use std::fmt::Write;

/// A case that is being written.
#[derive(Debug, Default)]
pub(super) struct CaseText {
    tables: Vec<Table>,
}

#[derive(Debug)]
struct Table {
    head: String,
    comments: Vec<String>,
    keys: Vec<(String, String)>,
}

impl CaseText {
    /// Begins the table `[kind.NAME]`.
    pub fn table(&mut self, kind: &str, name: &str) -> &mut Self {
        let name = if bare(name) { name.to_string() } else { quoted(name) };
        let head = if name == "\"\"" { kind.to_string() } else { format!("{kind}.{name}") };
        self.tables.push(Table { head, comments: Vec::new(), keys: Vec::new() });
        self
    }

    /// Begins the table `[kind.NAME.sub]`.
    pub fn sub_table(&mut self, kind: &str, name: &str, sub: &str) -> &mut Self {
        self.table(kind, name);
        if let Some(table) = self.tables.last_mut() {
            table.head += &format!(".{sub}");
        }
        self
    }

    /// Begins the table `[kind]`.
    pub fn only(&mut self, kind: &str) -> &mut Self {
        self.table(kind, "")
    }

    /// A comment above the table.
    pub fn comment(&mut self, text: impl Into<String>) -> &mut Self {
        if let Some(table) = self.tables.last_mut() {
            table.comments.push(text.into());
        }
        self
    }

    /// A key with a value as TOML has it.
    pub fn key(&mut self, key: &str, value: impl Into<String>) -> &mut Self {
        if let Some(table) = self.tables.last_mut() {
            table.keys.push((key.to_string(), value.into()));
        }
        self
    }

    /// The text of all tables; those of one kind stand together, in the order of the first of each.
    pub fn finish(self) -> String {
        let mut text = String::new();
        for table in self.tables {
            text.push('\n');
            for comment in &table.comments {
                for line in comment.lines() {
                    writeln!(text, "# {line}").expect("memory");
                }
            }
            writeln!(text, "[{}]", table.head).expect("memory");
            for (key, value) in &table.keys {
                writeln!(text, "{key} = {value}").expect("memory");
            }
        }
        text
    }
}

/// Whether TOML takes it as a key without quotation marks.
fn bare(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

/// A string of TOML.
pub(super) fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => quoted += "\\\"",
            '\\' => quoted += "\\\\",
            c if c.is_control() => write!(quoted, "\\u{:04x}", c as u32).expect("memory"),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}

/// A list of strings of TOML.
pub(super) fn strings<T: AsRef<str>>(texts: impl IntoIterator<Item = T>) -> String {
    let all: Vec<String> = texts.into_iter().map(|text| quoted(text.as_ref())).collect();
    format!("[{}]", all.join(", "))
}

/// A number: the fewest digits that differ from it by less than rounding.
pub(super) fn number(value: f64) -> String {
    let near = |text: &String| {
        text.parse::<f64>().is_ok_and(|other| (other - value).abs() <= 4.0 * f64::EPSILON * value.abs())
    };
    let digits = (0..17).map(|digits| format!("{value:.digits$e}")).find(near);
    let short: f64 = digits.and_then(|text| text.parse().ok()).unwrap_or(value);
    let plain = format!("{short}");
    if plain.len() <= 12 { plain } else { format!("{short:e}") }
}

/// Numbers of a list.
pub(super) fn numbers(values: [f64; 3]) -> String {
    format!("[{}]", values.map(|value| number(value + 0.0)).join(", "))
}

/// A quantity in a unit that is `size` of the SI one: `"210 GPa"`.
pub(super) fn quantity(value: f64, size: f64, unit: &str) -> String {
    format!("\"{} {unit}\"", number(value / size))
}
