//! Reads TOML section by section, remembering every fault with its line: unknown keys, wrong types, wrong units.

use super::keys::dotted;
use super::places::Places;
use super::units::{Dimension, NUMBER, parse_quantity};
use crate::error::{Error, Fault, Faults, Result, nearest};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::ops::{Bound, RangeBounds};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The largest size of a quantity in SI units; the least that is not zero is one over it. Products of several stay finite.
pub const LARGEST: f64 = 1e60;
/// The largest whole number.
const MOST: usize = 1_000_000_000;

/// A parsed TOML text and the faults found in it so far.
pub struct Reader<'a> {
    file: &'a str,
    /// Where each line begins.
    lines: Vec<usize>,
    /// Faults with the byte they are at.
    faults: RefCell<Vec<(usize, Fault)>>,
    /// Whether a table of named tables is none, so that names are unknown that the text may have meant to define.
    nameless: Cell<bool>,
    quantities: RefCell<Vec<Quantity>>,
}

/// A number that the text gives, with what its reader knows about it.
#[derive(Debug, Clone)]
pub struct Quantity {
    /// Keys joined by dots; entries of lists by their index from 0.
    pub path: String,
    /// The value in SI units.
    pub value: f64,
    /// The SI unit; empty for a pure number.
    pub unit: &'static str,
    /// The values that the case accepts.
    pub bounds: (Bound<f64>, Bound<f64>),
}

/// One table of the text. Each key is asked for by name; [`Section::finish`] then refuses those nobody asked for.
pub struct Section<'a> {
    reader: &'a Reader<'a>,
    table: &'a DeTable<'a>,
    path: String,
    start: usize,
    known: RefCell<Vec<String>>,
}

/// A value that may be absent, with where it stands.
pub struct Found<'a, T> {
    section: &'a Section<'a>,
    key: String,
    value: Option<T>,
    faulty: bool,
}

/// Parses `text` and hands its root to `read`, then gives the value and the quantities it read, or every fault.
pub fn read_document<T>(
    file: &str,
    text: &str,
    read: impl FnOnce(&Section) -> T,
) -> Result<(T, Vec<Quantity>)> {
    let reader = Reader {
        file,
        lines: std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect(),
        faults: RefCell::default(),
        nameless: Cell::new(false),
        quantities: RefCell::default(),
    };
    let root = DeTable::parse(text).map_err(|error| {
        let line = error.span().map_or(1, |span| reader.line(span.start));
        let found = format!("`{}`", text.lines().nth(line - 1).unwrap_or("").trim());
        Error::input(
            Fault::new(format!("{file}:{line}"), found, "TOML")
                .with_help(error.message().replace('\n', ", ")),
        )
    })?;
    let section = Section {
        reader: &reader,
        table: root.get_ref(),
        path: String::new(),
        start: 0,
        known: RefCell::default(),
    };
    let value = read(&section);
    section.finish();
    drop(section);
    let mut faults = reader.faults.into_inner();
    faults.sort_by_key(|(offset, _)| *offset);
    let faults = Faults(faults.into_iter().map(|(_, fault)| fault).collect());
    faults.into_result((value, reader.quantities.into_inner()))
}

impl Reader<'_> {
    fn line(&self, offset: usize) -> usize {
        self.lines.partition_point(|start| *start <= offset)
    }
}

impl<'a> Section<'a> {
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
        self.note(offset, &self.path_of(key), found, expected, help);
    }

    /// The value of `result`; its faults are noted.
    pub fn take<T>(&self, result: Result<T>) -> Option<T> {
        let mut faults = Faults::new();
        let value = faults.take(result);
        self.reader.faults.borrow_mut().extend(faults.0.into_iter().map(|fault| (self.start, fault)));
        value
    }

    fn note(
        &self,
        offset: usize,
        path: &str,
        found: impl Into<String>,
        expected: impl Into<String>,
        help: &str,
    ) {
        let place = format!("{}:{} `{path}`", self.reader.file, self.reader.line(offset));
        let fault = Fault::new(place, found, expected).with_help(help);
        self.reader.faults.borrow_mut().push((offset, fault));
    }

    fn path_of(&self, key: &str) -> String {
        match (self.path.as_str(), key) {
            ("", _) => key.to_string(),
            (path, "") => path.to_string(),
            (path, _) => format!("{path}.{key}"),
        }
    }

    fn get(&self, key: &str) -> Option<&'a Spanned<DeValue<'a>>> {
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

    fn remember(&self, key: &str, value: impl IntoIterator<Item = f64>, dimension: Dimension) {
        let bounds = (Bound::Unbounded, Bound::Unbounded);
        let path = self.path_of(key);
        self.reader.quantities.borrow_mut().extend(value.into_iter().map(|value| Quantity {
            path: path.clone(),
            value,
            unit: dimension.symbol,
            bounds,
        }));
    }

    fn remember_list<'v>(&self, key: &str, values: impl IntoIterator<Item = &'v f64>, dimension: Dimension) {
        for (i, value) in values.into_iter().enumerate() {
            self.remember(&format!("{key}.{i}"), [*value], dimension);
        }
    }

    /// Leaves `keys` unread without calling them unknown: what they mean cannot be told.
    pub fn skip(&self, keys: &[&str]) {
        self.known.borrow_mut().extend(keys.iter().map(|key| key.to_string()));
    }

    /// Whether the text has no fault so far.
    pub fn sound_so_far(&self) -> bool {
        self.reader.faults.borrow().is_empty()
    }

    /// Whether every table of named tables is one, so that a name that is not there was not meant to be.
    pub fn all_named(&self) -> bool {
        !self.reader.nameless.get()
    }

    /// Where the keys of this table stand, and those of the tables in it.
    pub fn places(&self) -> Places {
        let mut lines = BTreeMap::new();
        let mut tables = vec![(self.path.clone(), self.table)];
        while let Some((path, table)) = tables.pop() {
            for (key, value) in table {
                let name = key.get_ref();
                let path = if path.is_empty() { name.to_string() } else { format!("{path}.{name}") };
                if let Some(table) = value.get_ref().as_table() {
                    tables.push((path.clone(), table));
                }
                lines.insert(path, self.reader.line(key.span().start));
            }
        }
        Places { file: self.reader.file.to_string(), lines }
    }

    /// Whether the table has `key`.
    pub fn has(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    /// A quantity: a number in SI units, or a string with its unit.
    pub fn quantity(&'a self, key: &str, dimension: Dimension) -> Found<'a, f64> {
        let found = self.find(key, dimension.name, |value| quantity_of(value, dimension));
        self.remember(&dotted(key), found.value, dimension);
        found
    }

    /// A vector that is not zero, of whatever length.
    pub fn direction(&'a self, key: &str) -> Found<'a, [f64; 3]> {
        self.quantities(key, NUMBER).check("a vector that is not zero", |v| v.iter().any(|x| *x != 0.0))
    }

    /// A list of `N` quantities.
    pub fn quantities<const N: usize>(&'a self, key: &str, dimension: Dimension) -> Found<'a, [f64; N]> {
        let expected = format!("a list of {N} values, each {}", dimension.name);
        let found: Found<'a, [f64; N]> = self.find(key, &expected, |value| {
            let list = list_of(value, |item| quantity_of(item, dimension))?;
            let count = list.len();
            list.try_into().map_err(|_| format!("a list of {count}"))
        });
        self.remember_list(&dotted(key), found.value.iter().flatten(), dimension);
        found
    }

    /// A list of two quantities, each with its own dimension.
    pub fn two_quantities(&'a self, key: &str, dimensions: [Dimension; 2]) -> Found<'a, [f64; 2]> {
        let expected = "a list of two values, one a parameter";
        let found = self.find(key, expected, |value| pair_of(value, dimensions));
        for k in 0..2 {
            self.remember(&format!("{}.{k}", dotted(key)), found.value.map(|v| v[k]), dimensions[k]);
        }
        found
    }

    /// A list of lists of two quantities, each with its own dimension.
    pub fn pairs(&'a self, key: &str, dimensions: [Dimension; 2]) -> Found<'a, Vec<[f64; 2]>> {
        let found = self.find(key, "a list of lists of two values", |value| {
            list_of(value, |row| pair_of(row, dimensions))
        });
        for (i, row) in found.value.iter().flatten().enumerate() {
            for k in 0..2 {
                self.remember(&format!("{}.{i}.{k}", dotted(key)), [row[k]], dimensions[k]);
            }
        }
        found
    }

    /// A list of quantities of any length.
    pub fn quantity_list(&'a self, key: &str, dimension: Dimension) -> Found<'a, Vec<f64>> {
        let found = self.find(key, &format!("a list, each {}", dimension.name), |value| {
            list_of(value, |item| quantity_of(item, dimension))
        });
        self.remember_list(&dotted(key), found.value.iter().flatten(), dimension);
        found
    }

    /// A list of rows of numbers.
    pub fn rows(&'a self, key: &str, dimension: Dimension) -> Found<'a, Vec<Vec<f64>>> {
        let found = self.find(key, "a list of rows of numbers", |value| {
            list_of(value, |row| list_of(row, |item| quantity_of(item, dimension)))
        });
        for (i, row) in found.value.iter().flatten().enumerate() {
            self.remember_list(&format!("{}.{i}", dotted(key)), row, dimension);
        }
        found
    }

    /// A string for people to read, of any length.
    pub fn text(&'a self, key: &str) -> Found<'a, String> {
        self.find(key, "a string", string_of)
    }

    /// A list of such strings; a single one is a list of one.
    pub fn texts(&'a self, key: &str) -> Found<'a, Vec<String>> {
        self.find(key, "a list of strings", |value| strings_of(value, string_of))
    }

    /// The name of something, or the path of a file.
    pub fn string(&'a self, key: &str) -> Found<'a, String> {
        self.find(key, "a string of at least one character, on one line", name_of)
    }

    /// A list of rows of strings.
    pub fn string_rows(&'a self, key: &str) -> Found<'a, Vec<Vec<String>>> {
        self.find(key, "a list of rows of strings", |value| list_of(value, |row| list_of(row, string_of)))
    }

    /// Whether the value of `key` is a string.
    pub fn is_string(&self, key: &str) -> bool {
        self.table.get(key).is_some_and(|value| value.get_ref().as_str().is_some())
    }

    /// Whether the value of `key` is a table.
    pub fn is_table(&self, key: &str) -> bool {
        self.table.get(key).is_some_and(|value| value.get_ref().as_table().is_some())
    }

    /// A list of names; a single string is a list of one.
    pub fn strings(&'a self, key: &str) -> Found<'a, Vec<String>> {
        let expected = "a list of strings, each of at least one character, on one line";
        self.find(key, expected, |value| strings_of(value, name_of))
    }

    /// `true` or `false`.
    pub fn boolean(&'a self, key: &str) -> Found<'a, bool> {
        self.find(key, "true or false", |value| value.as_bool().ok_or_else(|| describe(value)))
    }

    /// A whole number from one to a billion.
    pub fn count(&'a self, key: &str) -> Found<'a, usize> {
        self.find(key, "a whole number from 1 to a billion", |value| whole_of(value, 1))
    }

    /// A whole number from zero to a billion.
    pub fn whole(&'a self, key: &str) -> Found<'a, usize> {
        self.find(key, "a whole number from 0 to a billion", |value| whole_of(value, 0))
    }

    /// A list of two whole numbers from one to a billion.
    pub fn two_counts(&'a self, key: &str) -> Found<'a, [usize; 2]> {
        self.find(key, "a list of two whole numbers from 1 to a billion", |value| {
            let list = list_of(value, |item| whole_of(item, 1))?;
            let count = list.len();
            list.try_into().map_err(|_| format!("a list of {count}"))
        })
    }

    /// A list of two truth values.
    pub fn two_booleans(&'a self, key: &str) -> Found<'a, [bool; 2]> {
        self.find(key, "a list of two of true and false", |value| {
            let list = list_of(value, |item| item.as_bool().ok_or_else(|| describe(item)))?;
            let count = list.len();
            list.try_into().map_err(|_| format!("a list of {count}"))
        })
    }

    /// One of `choices`.
    pub fn choice(&'a self, key: &str, choices: &[&'static str]) -> Found<'a, &'static str> {
        self.find(key, &format!("one of {}", choices.join(", ")), |value| {
            let text = string_of(value)?;
            let near = nearest(&text, choices.iter().copied());
            let meant = near.map_or(String::new(), |near| format!(" (did you mean \"{near}\"?)"));
            choices.iter().find(|c| **c == text).copied().ok_or(format!("\"{text}\"{meant}"))
        })
    }

    /// A sub-table, read by `read` and then refused if it has unknown keys.
    pub fn section<T>(&self, key: &str, read: impl FnOnce(&Section) -> T) -> Option<T> {
        let value = self.get(key)?;
        let Some(table) = value.get_ref().as_table() else {
            self.fault(key, describe(value.get_ref()), format!("a table [{}]", self.path_of(key)), "");
            return None;
        };
        let start = self.table.get_key_value(key).map_or(self.start, |(k, _)| k.span().start);
        let section = Section {
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

    /// A table of named tables `[key.NAME]`, in the order of their names. What stands right under `[key]` is one fault,
    /// as the name was left out.
    pub fn named<T>(&self, key: &str, mut read: impl FnMut(&str, &Section) -> T) -> Vec<T> {
        if self.has(key) && !self.is_table(key) {
            self.reader.nameless.set(true);
        }
        self.section(key, |all| {
            let stray: Vec<String> = all.names().into_iter().filter(|name| !all.is_table(name)).collect();
            if let Some(first) = stray.first() {
                let path = all.path_of("");
                let found = format!("`{}` right under [{path}]", stray.join("`, `"));
                all.fault(first, found, format!("a table with a name of its own, [{path}.NAME]"), "");
                all.skip(&all.names().iter().map(String::as_str).collect::<Vec<_>>());
                all.reader.nameless.set(true);
                return Vec::new();
            }
            all.sound_names().iter().filter_map(|name| all.section(name, |one| read(name, one))).collect()
        })
        .unwrap_or_default()
    }

    /// Refuses keys that nobody asked for, offering the nearest known one.
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
    /// The value, if it is there and sound.
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

impl<T: std::fmt::Debug> Found<'_, Vec<T>> {
    /// Refuses a list of nothing.
    pub fn not_empty(self) -> Self {
        self.check("at least one", |list| !list.is_empty())
    }
}

impl Found<'_, f64> {
    /// Refuses zero and below.
    pub fn positive(self) -> Self {
        self.within(Bound::Excluded(0.0), Bound::Unbounded)
    }

    /// Refuses values below zero.
    pub fn non_negative(self) -> Self {
        self.within(Bound::Included(0.0), Bound::Unbounded)
    }

    /// Refuses values outside these bounds.
    pub fn within(self, lower: Bound<f64>, upper: Bound<f64>) -> Self {
        let path = self.section.path_of(&dotted(&self.key));
        let mut quantities = self.section.reader.quantities.borrow_mut();
        quantities.iter_mut().filter(|q| q.path == path).for_each(|q| q.bounds = (lower, upper));
        drop(quantities);
        self.check(&describe_bounds(lower, upper), |v| (lower, upper).contains(v))
    }
}

/// Bounds in words: "a value above 0", "a value from 0 to 1".
fn describe_bounds(lower: Bound<f64>, upper: Bound<f64>) -> String {
    let zero_or = |v: f64| if v == 0.0 { "zero".to_string() } else { v.to_string() };
    let low = match lower {
        Bound::Included(v) => format!(" of {} or more", zero_or(v)),
        Bound::Excluded(v) => format!(" above {}", zero_or(v)),
        Bound::Unbounded => String::new(),
    };
    let high = match upper {
        Bound::Included(v) => format!(" of {} or less", zero_or(v)),
        Bound::Excluded(v) => format!(" below {}", zero_or(v)),
        Bound::Unbounded => String::new(),
    };
    let and = if low.is_empty() || high.is_empty() { "" } else { " and" };
    format!("a value{low}{and}{high}")
}

fn quantity_of(value: &DeValue, dimension: Dimension) -> std::result::Result<f64, String> {
    let number = match value {
        DeValue::Integer(i) => {
            i64::from_str_radix(&i.as_str().replace('_', ""), i.radix()).ok().map(|v| v as f64)
        }
        DeValue::Float(f) => f.as_str().replace('_', "").parse().ok(),
        DeValue::String(text) => Some(parse_quantity(text, dimension)?),
        _ => None,
    };
    match number {
        Some(v) if v == 0.0 || (1.0 / LARGEST..=LARGEST).contains(&v.abs()) => Ok(v),
        Some(v) if v.is_finite() => Err(format!("{v:e}, which is not from 1e-60 to 1e60 in size")),
        Some(v) => Err(format!("{v}, which is not finite")),
        None => Err(describe(value)),
    }
}

fn string_of(value: &DeValue) -> std::result::Result<String, String> {
    value.as_str().map(str::to_string).ok_or_else(|| describe(value))
}

/// A name: not empty, without control characters.
fn name_of(value: &DeValue) -> std::result::Result<String, String> {
    let name = string_of(value)?;
    if is_name(&name) { Ok(name) } else { Err(format!("the string {name:?}")) }
}

fn is_name(name: &str) -> bool {
    !name.is_empty() && !name.contains(char::is_control)
}

/// A list of strings; a single string is a list of one.
fn strings_of(
    value: &DeValue,
    item: fn(&DeValue) -> std::result::Result<String, String>,
) -> std::result::Result<Vec<String>, String> {
    if value.is_str() { Ok(vec![item(value)?]) } else { list_of(value, item) }
}

fn whole_of(value: &DeValue, least: usize) -> std::result::Result<usize, String> {
    let number = value.as_integer().and_then(|i| usize::from_str_radix(i.as_str(), i.radix()).ok());
    number.filter(|n| (least..=MOST).contains(n)).ok_or_else(|| describe(value))
}

fn pair_of(value: &DeValue, dimensions: [Dimension; 2]) -> std::result::Result<[f64; 2], String> {
    match value.as_array() {
        Some(list) if list.len() == 2 => {
            let at = |k: usize| quantity_of(list[k].get_ref(), dimensions[k]);
            Ok([at(0)?, at(1)?])
        }
        Some(list) => Err(format!("a list of {}", list.len())),
        None => Err(describe(value)),
    }
}

fn list_of<T>(
    value: &DeValue,
    item: impl Fn(&DeValue) -> std::result::Result<T, String>,
) -> std::result::Result<Vec<T>, String> {
    let array = value.as_array().ok_or_else(|| describe(value))?;
    array.iter().map(|v| item(v.get_ref())).collect()
}

fn describe(value: &DeValue) -> String {
    match value {
        DeValue::String(s) => format!("the string \"{s}\""),
        DeValue::Integer(i) => format!("the whole number {}", i.as_str()),
        DeValue::Float(f) => format!("the number {}", f.as_str()),
        DeValue::Boolean(b) => format!("{b}"),
        DeValue::Datetime(d) => format!("the date {d}"),
        DeValue::Array(a) => format!("a list of {}", a.len()),
        DeValue::Table(_) => "a table".into(),
    }
}
