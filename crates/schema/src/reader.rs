//! Reads TOML section by section, remembering every fault with its line: unknown keys, wrong types, wrong units.

use super::key::describe_bounds;
use super::keys::{dotted, is_name};
use super::places::Places;
use super::raw::{describe, list_of, name_of, quantity_of, string_of, whole_of, word_of};
use super::units::Dimension;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::{Bound, RangeBounds};
use stridor_base::error::{Error, Fault, Faults, Result, nearest};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A parsed TOML text and the faults found in it so far.
pub struct Reader<'a> {
    file: &'a str,
    /// Where each line begins.
    lines: Vec<usize>,
    /// Faults with the byte they are at.
    faults: RefCell<Vec<(usize, Fault)>>,
}

/// One table of the text. Each key is read by name; `finish` then refuses those that were not read.
pub struct TableReader<'a> {
    reader: &'a Reader<'a>,
    table: &'a DeTable<'a>,
    /// Keys of the tables around it, joined by dots.
    pub(super) path: String,
    start: usize,
    known: RefCell<Vec<String>>,
}

/// A value that may be absent, with where it stands.
pub struct Found<'a, T> {
    section: &'a TableReader<'a>,
    key: String,
    value: Option<T>,
    faulty: bool,
}

/// Parses `text` and hands its root to `read`, then gives its value, or every fault.
pub fn read_document<T>(file: &str, text: &str, read: impl FnOnce(&TableReader) -> T) -> Result<T> {
    let (value, faults) = read_parts(file, text, read)?;
    Faults(faults.into_iter().map(|(_, fault)| fault).collect()).into_result(value)
}

/// The same, with the value and the faults, each with its line, when the text is TOML.
pub(super) fn read_parts<T>(
    file: &str,
    text: &str,
    read: impl FnOnce(&TableReader) -> T,
) -> Result<(T, Vec<(usize, Fault)>)> {
    let reader = Reader {
        file,
        lines: std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect(),
        faults: RefCell::default(),
    };
    let root = DeTable::parse(text).map_err(|error| {
        let line = error.span().map_or(1, |span| reader.line(span.start));
        let found = text.lines().nth(line - 1).unwrap_or("").trim();
        let mut help = error.message().replace('\n', ", ");
        if found.split('"').skip(1).step_by(2).any(|quoted| quoted.contains('\\')) {
            help = "A backslash in \"…\" begins an escape such as \\n: write paths with / or in '…'".into();
        }
        Error::input(Fault::new(format!("{file}:{line}"), format!("`{found}`"), "TOML").with_help(help))
    })?;
    let section = TableReader {
        reader: &reader,
        table: root.get_ref(),
        path: String::new(),
        start: 0,
        known: RefCell::default(),
    };
    let value = read(&section);
    section.finish();
    drop(section);
    let mut faults = reader.faults.take();
    faults.sort_by_key(|(offset, _)| *offset);
    let with_line = |(offset, fault): (usize, Fault)| (reader.line(offset), fault);
    Ok((value, faults.into_iter().map(with_line).collect()))
}

impl Reader<'_> {
    fn line(&self, offset: usize) -> usize {
        self.lines.partition_point(|start| *start <= offset)
    }
}

impl<'a> TableReader<'a> {
    /// The keys of this table, for tables whose keys are names.
    pub fn names(&self) -> Vec<String> {
        self.table.keys().map(|key| key.get_ref().to_string()).collect()
    }

    /// The same; names that are empty or have control characters are faults, and left out.
    pub fn sound_names(&self) -> Vec<String> {
        let (sound, others): (Vec<_>, Vec<_>) = self.names().into_iter().partition(|name| is_name(name));
        for name in others {
            self.fault(
                &name,
                format!("the name {name:?}"),
                "a name of at least one character, on one line",
                "",
            );
            self.skip(&[&name]);
        }
        sound
    }

    /// Notes a fault of `key` in this table; `key` may be a dotted path below it.
    pub fn fault(&self, key: &str, found: impl Into<String>, expected: impl Into<String>, help: &str) {
        self.note(self.offset_of(key), &self.path_of(key), found, expected, help);
    }

    /// Where `key` begins, which may be a dotted path below this table; the table itself where there is none.
    fn offset_of(&self, key: &str) -> usize {
        let (mut offset, mut table, mut rest) = (self.start, self.table, key);
        loop {
            // A name may have dots itself.
            let mut ends = (0..=rest.len()).rev().filter(|k| *k == rest.len() || rest.as_bytes()[*k] == b'.');
            let found = ends.find_map(|end| Some((end, table.get_key_value(&rest[..end])?)));
            let Some((end, (name, value))) = found else { break };
            offset = name.span().start;
            let (Some(inner), true) = (value.get_ref().as_table(), end < rest.len()) else { break };
            (table, rest) = (inner, &rest[end + 1..]);
        }
        offset
    }

    fn note(
        &self,
        offset: usize,
        path: &str,
        found: impl Into<String>,
        expected: impl Into<String>,
        help: &str,
    ) {
        let Reader { file, .. } = self.reader;
        let place = match file.is_empty() {
            true => format!("`{path}`"),
            false => format!("{file}:{} `{path}`", self.reader.line(offset)),
        };
        let fault = Fault::new(place, found, expected).with_help(help);
        self.reader.faults.borrow_mut().push((offset, fault));
    }

    pub(super) fn path_of(&self, key: &str) -> String {
        match (self.path.as_str(), key) {
            ("", _) => key.to_string(),
            (path, "") => path.to_string(),
            (path, _) => format!("{path}.{key}"),
        }
    }

    /// The value of `key`, which is known from now on.
    pub(super) fn get(&self, key: &str) -> Option<&'a Spanned<DeValue<'a>>> {
        self.known.borrow_mut().push(key.to_string());
        self.table.get(key)
    }

    fn find<T>(
        &'a self,
        key: &str,
        expected: &str,
        convert: impl FnOnce(&DeValue) -> std::result::Result<T, String>,
    ) -> Found<'a, T> {
        let (value, faulty) = match self.get(key) {
            None => (None, false),
            Some(value) => match convert(value.get_ref()) {
                Ok(value) => (Some(value), false),
                Err(found) => {
                    self.fault(key, found, expected, "");
                    (None, true)
                }
            },
        };
        Found { section: self, key: key.to_string(), value, faulty }
    }

    /// Leaves `keys` unread without calling them unknown: their meaning is not known.
    pub fn skip(&self, keys: &[&str]) {
        self.known.borrow_mut().extend(keys.iter().map(|key| key.to_string()));
    }

    /// Where the keys of this table stand, and those of the tables in it.
    pub fn places(&self) -> Places {
        let mut lines = BTreeMap::new();
        let mut tables = vec![(self.path.clone(), self.table)];
        while let Some((path, table)) = tables.pop() {
            for (key, value) in table {
                let name = key.get_ref();
                let name = dotted(name);
                let path = if path.is_empty() { name.into_owned() } else { format!("{path}.{name}") };
                if let Some(table) = value.get_ref().as_table() {
                    tables.push((path.clone(), table));
                }
                lines.insert(path, self.reader.line(key.span().start));
            }
        }
        Places { file: self.reader.file.to_string(), lines, ..Places::default() }
    }

    /// Whether the table has `key`.
    pub fn has(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    /// A quantity: a number in SI units, or a string with its unit.
    pub fn quantity(&'a self, key: &str, dimension: Dimension) -> Found<'a, f64> {
        self.find(key, dimension.name, |value| quantity_of(value, Some(dimension)))
    }

    /// A list of `N` quantities.
    pub fn quantities<const N: usize>(&'a self, key: &str, dimension: Dimension) -> Found<'a, [f64; N]> {
        let expected = format!("a list of {N} values, each {}", dimension.name);
        self.find(key, &expected, |value| {
            let list = list_of(value, |item| quantity_of(item, Some(dimension)))?;
            let count = list.len();
            list.try_into().map_err(|_| format!("a list of {count}"))
        })
    }

    /// A list of quantities of any length.
    pub fn quantity_list(&'a self, key: &str, dimension: Dimension) -> Found<'a, Vec<f64>> {
        self.find(key, &format!("a list, each {}", dimension.name), |value| {
            list_of(value, |item| quantity_of(item, Some(dimension)))
        })
    }

    /// A string for people to read, of any length.
    pub fn text(&'a self, key: &str) -> Found<'a, String> {
        self.find(key, "a string", string_of)
    }

    /// The name of something, or the path of a file.
    pub fn string(&'a self, key: &str) -> Found<'a, String> {
        self.find(key, "a string of at least one character, on one line", name_of)
    }

    /// Whether the value of `key` is a table.
    pub fn is_table(&self, key: &str) -> bool {
        self.table.get(key).is_some_and(|value| value.get_ref().as_table().is_some())
    }

    /// `true` or `false`.
    pub fn boolean(&'a self, key: &str) -> Found<'a, bool> {
        self.find(key, "true or false", |value| value.as_bool().ok_or_else(|| describe(value)))
    }

    /// A whole number from one to a billion.
    pub fn count(&'a self, key: &str) -> Found<'a, usize> {
        self.find(key, "a whole number from 1 to a billion", |value| whole_of(value, 1))
    }

    /// One of `choices`.
    pub fn choice(&'a self, key: &str, choices: &[&'static str]) -> Found<'a, &'static str> {
        let words: Vec<(&'static str, &'static str)> = choices.iter().map(|word| (*word, *word)).collect();
        self.find(key, &format!("one of {}", choices.join(", ")), |value| word_of(value, &words))
    }

    /// A sub-table, read by `read` and then refused if it has unknown keys.
    pub fn section<T>(&self, key: &str, read: impl FnOnce(&TableReader) -> T) -> Option<T> {
        let value = self.get(key)?;
        let Some(table) = value.get_ref().as_table() else {
            self.fault(key, describe(value.get_ref()), format!("a table [{}]", self.path_of(key)), "");
            return None;
        };
        let start = self.table.get_key_value(key).map_or(self.start, |(k, _)| k.span().start);
        let section = TableReader {
            reader: self.reader,
            table,
            path: self.path_of(&dotted(key)),
            start,
            known: RefCell::default(),
        };
        let result = read(&section);
        section.finish();
        Some(result)
    }

    /// Named tables `[key.NAME]`, in the order of their names; none when they have no names. What stands right under `[key]` is
    /// one fault, as the name was left out.
    pub fn named<T>(&self, key: &str, mut read: impl FnMut(&str, &TableReader) -> T) -> Option<Vec<T>> {
        if !self.has(key) {
            self.skip(&[key]);
            return Some(Vec::new());
        }
        self.section(key, |all| {
            let stray: Vec<String> = all.names().into_iter().filter(|name| !all.is_table(name)).collect();
            if let Some(first) = stray.first() {
                let path = all.path_of("");
                let found = format!("`{}` right under [{path}]", stray.join("`, `"));
                all.fault(first, found, format!("a table with a name of its own, [{path}.NAME]"), "");
                all.skip(&all.names().iter().map(String::as_str).collect::<Vec<_>>());
                return None;
            }
            Some(
                all.sound_names()
                    .iter()
                    .filter_map(|name| all.section(name, |one| read(name, one)))
                    .collect(),
            )
        })
        .flatten()
    }

    /// Refuses keys that were not read, offering the nearest known one.
    fn finish(&self) {
        let known = self.known.borrow();
        for key in self.table.keys() {
            let name = key.get_ref().as_ref();
            if !known.iter().any(|k| k == name) {
                let mut words: Vec<&str> = known.iter().map(String::as_str).collect();
                words.sort_unstable();
                words.dedup();
                let help = nearest(name, words.iter().copied())
                    .map_or(String::new(), |near| format!("Did you mean `{near}`?"));
                let expected = if words.is_empty() {
                    "no key here".into()
                } else {
                    format!("one of {}", words.join(", "))
                };
                self.note(
                    key.span().start,
                    &self.path_of(name),
                    "an unknown key",
                    expected,
                    help.trim_end_matches('.'),
                );
            }
        }
    }
}

impl<'a, T> Found<'a, T> {
    /// The value, if it is there and valid.
    pub fn optional(self) -> Option<T> {
        self.value
    }

    /// The value, or `default` when it is absent.
    pub fn or(self, default: T) -> T {
        self.value.unwrap_or(default)
    }

    /// Notes a fault when the value is there and `holds` does not.
    pub fn check(mut self, expected: &str, holds: impl FnOnce(&T) -> bool) -> Self
    where
        T: std::fmt::Debug,
    {
        if let Some(value) = &self.value
            && !holds(value)
        {
            self.section.fault(&self.key, format!("{value:?}"), expected, "");
            self.value = None;
            self.faulty = true;
        }
        self
    }
}

impl<T: Default> Found<'_, T> {
    /// The value; a fault is noted when it is absent.
    pub fn required(self, expected: &str) -> T {
        if self.value.is_none() && !self.faulty {
            self.section.fault(&self.key, "nothing", expected, "");
        }
        self.value.unwrap_or_default()
    }
}

impl Found<'_, f64> {
    /// Refuses zero and below.
    pub fn positive(self) -> Self {
        self.within(Bound::Excluded(0.0), Bound::Unbounded)
    }

    /// Refuses values outside these bounds.
    pub fn within(self, lower: Bound<f64>, upper: Bound<f64>) -> Self {
        self.check(&describe_bounds(lower, upper), |v| (lower, upper).contains(v))
    }
}
