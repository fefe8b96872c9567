//! The numbers of tables: each has a path, a value, a unit and bounds, and can be set.

use super::invalidates::{Derivative, Invalidates};
use super::keys::dotted;
use super::{Key, Slot, Table, TableSlot, Variants, Visitor};
use std::ops::{Bound, RangeBounds};

/// A number of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Scalar {
    /// Keys joined by dots; entries of lists by their index from 0.
    pub path: String,
    /// Name of the quantity with its symbol and what it belongs to, for axes: `friction coefficient μ₀ of rim`.
    pub label: String,
    /// Its value in SI units.
    pub value: f64,
    /// The SI unit; empty for a pure number.
    pub unit: &'static str,
    /// The values that it may have.
    pub bounds: (Bound<f64>, Bound<f64>),
    /// Results that must be computed again when it changes.
    pub invalidates: Invalidates,
    /// Whether eigenvalues have a derivative by it.
    pub derivative: Derivative,
}

impl Scalar {
    /// Whether it may have `value`.
    pub fn accepts(&self, value: f64) -> bool {
        value.is_finite() && self.bounds.contains(&value)
    }
}

/// A walk over the numbers of a table.
struct Walk<'a> {
    /// Only what lies on this path.
    only: Option<&'a str>,
    path: String,
    /// Names of the tables that the user named.
    owner: String,
    invalidates: Invalidates,
    each: &'a mut dyn FnMut(Scalar, &mut f64),
}

/// Every number of `table`, in the order of declaration. A key whose table says nothing invalidates the structure.
pub fn scalars<T: Table + Clone>(table: &T) -> Vec<Scalar> {
    let mut all = Vec::new();
    walk(&mut table.clone(), None, &mut |scalar, _| all.push(scalar));
    all
}

/// The number at `path`.
pub fn scalar<T: Table + Clone>(table: &T, path: &str) -> Option<Scalar> {
    let mut found = None;
    walk(&mut table.clone(), Some(path), &mut |scalar, _| {
        if scalar.path == path {
            found = Some(scalar);
        }
    });
    found
}

/// Sets the number at `path`; `false` when there is none.
pub fn set_scalar(table: &mut dyn Table, path: &str, value: f64) -> bool {
    let mut found = false;
    walk(table, Some(path), &mut |scalar, slot| {
        if scalar.path == path {
            *slot = value;
            found = true;
        }
    });
    found
}

fn walk(table: &mut dyn Table, only: Option<&str>, each: &mut dyn FnMut(Scalar, &mut f64)) {
    table.visit(&mut Walk {
        only,
        path: String::new(),
        owner: String::new(),
        invalidates: Invalidates::Structure,
        each,
    });
}

impl Walk<'_> {
    fn path_of(&self, key: &str) -> String {
        let key = dotted(key);
        if self.path.is_empty() { key.into_owned() } else { format!("{}.{key}", self.path) }
    }

    /// Whether what has `path` is asked for, or may have in it what is.
    fn wanted(&self, path: &str) -> bool {
        self.only.is_none_or(|only| only.starts_with(path))
    }

    /// The label of the number at index `at` of a key.
    fn label(&self, key: Key, words: Option<&str>, at: &[usize]) -> String {
        let mut label = words.map_or_else(|| key.name.replace('_', " "), String::from);
        if let Some(symbol) = symbol(key.doc).filter(|_| at.is_empty()) {
            label += &format!(" {symbol}");
        }
        if !self.owner.is_empty() {
            label += &format!(" of {}", self.owner);
        }
        at.iter().fold(label, |label, k| format!("{label}, entry {}", k + 1))
    }
}

/// The symbol with which a documentation begins: `E \[Pa\].`, `μ_s, at rest.`
fn symbol(doc: &str) -> Option<&str> {
    let doc = doc.trim();
    let end = doc.find([' ', ',', ':', '.', '\\']).unwrap_or(doc.len());
    let (word, rest) = doc.split_at(end);
    let base = word.split('_').next().unwrap_or_default();
    let greek = word.starts_with(|c| ('Α'..='ω').contains(&c));
    let alone = greek || rest.starts_with([',', ':', '.']) || rest.starts_with(" \\[");
    (alone && (1..=2).contains(&base.chars().count())).then_some(word)
}

impl Visitor for Walk<'_> {
    fn value(&mut self, key: Key, slot: &mut dyn Slot) {
        let path = self.path_of(key.name);
        if !self.wanted(&path) {
            return;
        }
        let about = slot.about();
        let (bounds, derivative, words) = (about.bounds, about.derivative, about.label);
        let invalidates = about.invalidates.unwrap_or(self.invalidates);
        let units: [&'static str; 2] = [0, 1].map(|k| about.units.at(k).map_or("", |d| d.symbol));
        slot.numbers(&mut |at, value| {
            let path = at.iter().fold(path.clone(), |path, k| format!("{path}.{k}"));
            let unit = units[at.last().map_or(0, |k| (*k).min(1))];
            let derivative =
                if invalidates == Invalidates::Question { Derivative::Zero } else { derivative(at, *value) };
            let label = self.label(key, words, at);
            let scalar = Scalar { path, label, value: *value, unit, bounds, invalidates, derivative };
            (self.each)(scalar, value);
        });
    }

    fn table(&mut self, key: Key, slot: &mut dyn TableSlot) {
        let path = self.path_of(key.name);
        if !self.wanted(&path) {
            return;
        }
        let invalidates = slot.invalidates().unwrap_or(self.invalidates);
        slot.each(&mut |name, table| {
            let path = name.map_or(path.clone(), |name| format!("{path}.{}", dotted(name)));
            if !self.wanted(&path) {
                return;
            }
            let owner = [self.owner.as_str(), name.unwrap_or_default()].join(" ").trim().to_string();
            table.visit(&mut Walk { only: self.only, path, owner, invalidates, each: &mut *self.each });
        });
    }

    fn variants(&mut self, _: &Variants, current: usize, visit: &mut dyn FnMut(usize, &mut dyn Visitor)) {
        visit(current, self);
    }

    fn flat(&mut self, table: &mut dyn Table) {
        table.visit(self);
    }
}
