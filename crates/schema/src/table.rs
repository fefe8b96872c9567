//! Declarations of keys that hold tables.

use super::invalidates::Invalidates;
use super::key::Field;
use super::keys::is_name;
use super::value::{Blank, Value};
use super::{Key, Kind, Table, Visitor};
use std::collections::BTreeMap;

/// When a table is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// Always, with defaults where the document has none.
    Always,
    /// It must be in the document; what is expected.
    Required(&'static str),
    /// Where the document has it.
    Optional,
    /// Under names of the user's, `[key.NAME]`.
    Named,
}

/// A table, or named tables, with their declaration.
pub trait TableSlot {
    /// When it is there.
    fn presence(&self) -> Presence;
    /// Results that a change in the table invalidates; `None` for those of the table around it.
    fn invalidates(&self) -> Option<Invalidates>;
    /// Makes the table, under `name` where there are several, and gives it.
    fn make(&mut self, name: &str) -> &mut dyn Table;
    /// Hands the tables that are there to `each`, with their names.
    fn each(&mut self, each: &mut dyn FnMut(Option<&str>, &mut dyn Table));
}

/// Declares a table that is there always.
pub fn table() -> OneTable {
    OneTable { presence: Presence::Always, invalidates: None }
}

/// Declares named tables.
pub fn named() -> NamedTables {
    NamedTables { invalidates: None }
}

/// Declares the keys of another declaration as keys of this table.
pub fn flat() -> Flat {
    Flat
}

/// Declares a table whose keys are free, each with a value as `value` declares it; `expected` is what a key must be.
pub fn values<T>(value: fn() -> Field<T>, expected: &'static str, is_key: fn(&str) -> bool) -> MapOf<T> {
    MapOf { value, expected, is_key, invalidates: None }
}

/// A table that is there always, or must be.
pub struct OneTable {
    presence: Presence,
    invalidates: Option<Invalidates>,
}

impl OneTable {
    /// It must be in the document; `expected` is said where it is not.
    pub fn required(self, expected: &'static str) -> OneTable {
        OneTable { presence: Presence::Required(expected), ..self }
    }

    /// It may be absent.
    pub fn optional<T>(self) -> MaybeOne<T> {
        MaybeOne { invalidates: self.invalidates, beforehand: None }
    }

    /// Sets the results that a change in the table invalidates.
    pub fn invalidates(self, what: Invalidates) -> OneTable {
        OneTable { invalidates: Some(what), ..self }
    }
}

/// Preparation of a table before its keys are visited.
type Preparation<T> = Box<dyn Fn(&mut T)>;

/// A table that may be absent.
pub struct MaybeOne<T> {
    invalidates: Option<Invalidates>,
    beforehand: Option<Preparation<T>>,
}

impl<T> MaybeOne<T> {
    /// Sets the preparation of the table before its keys are visited, where they depend on keys around it.
    pub fn beforehand(self, act: impl Fn(&mut T) + 'static) -> MaybeOne<T> {
        MaybeOne { beforehand: Some(Box::new(act)), ..self }
    }
}

/// Tables under names of the user's.
pub struct NamedTables {
    invalidates: Option<Invalidates>,
}

impl NamedTables {
    /// Sets the results that a change in the tables invalidates.
    pub fn invalidates(self, what: Invalidates) -> NamedTables {
        NamedTables { invalidates: Some(what) }
    }
}

/// The keys of another declaration.
pub struct Flat;

impl<T: Table> Kind<T> for Flat {
    fn visit(self, _: Key, value: &mut T, visitor: &mut dyn Visitor) {
        visitor.flat(value);
    }
}

struct One<'a, T>(OneTable, &'a mut T);

impl<T: Table + Blank> Kind<T> for OneTable {
    fn visit(self, key: Key, value: &mut T, visitor: &mut dyn Visitor) {
        visitor.table(key, &mut One(self, value));
    }
}

impl<T: Table + Blank> TableSlot for One<'_, T> {
    fn presence(&self) -> Presence {
        self.0.presence
    }

    fn invalidates(&self) -> Option<Invalidates> {
        self.0.invalidates
    }

    fn make(&mut self, _: &str) -> &mut dyn Table {
        self.1
    }

    fn each(&mut self, each: &mut dyn FnMut(Option<&str>, &mut dyn Table)) {
        each(None, self.1);
    }
}

struct Maybe<'a, T>(MaybeOne<T>, &'a mut Option<T>);

impl<T: Table + Blank> Kind<Option<T>> for MaybeOne<T> {
    fn visit(self, key: Key, value: &mut Option<T>, visitor: &mut dyn Visitor) {
        visitor.table(key, &mut Maybe(self, value));
    }
}

impl<T: Table + Blank> TableSlot for Maybe<'_, T> {
    fn presence(&self) -> Presence {
        Presence::Optional
    }

    fn invalidates(&self) -> Option<Invalidates> {
        self.0.invalidates
    }

    fn make(&mut self, _: &str) -> &mut dyn Table {
        let table = self.1.insert(T::blank());
        self.0.beforehand.iter().for_each(|act| act(table));
        table
    }

    fn each(&mut self, each: &mut dyn FnMut(Option<&str>, &mut dyn Table)) {
        if let Some(table) = self.1 {
            self.0.beforehand.iter().for_each(|act| act(table));
            each(None, table);
        }
    }
}

struct Named<'a, T>(NamedTables, &'a mut BTreeMap<String, T>);

impl<T: Table + Blank> Kind<BTreeMap<String, T>> for NamedTables {
    fn visit(self, key: Key, value: &mut BTreeMap<String, T>, visitor: &mut dyn Visitor) {
        visitor.table(key, &mut Named(self, value));
    }
}

impl<T: Table + Blank> TableSlot for Named<'_, T> {
    fn presence(&self) -> Presence {
        Presence::Named
    }

    fn invalidates(&self) -> Option<Invalidates> {
        self.0.invalidates
    }

    fn make(&mut self, name: &str) -> &mut dyn Table {
        self.1.entry(name.to_string()).or_insert_with(T::blank)
    }

    fn each(&mut self, each: &mut dyn FnMut(Option<&str>, &mut dyn Table)) {
        for (name, table) in self.1.iter_mut() {
            each(Some(name), table);
        }
    }
}

/// A table whose keys are free.
pub struct MapOf<T> {
    value: fn() -> Field<T>,
    expected: &'static str,
    is_key: fn(&str) -> bool,
    invalidates: Option<Invalidates>,
}

impl<T> MapOf<T> {
    /// Sets the results that a change in the table invalidates.
    pub fn invalidates(self, what: Invalidates) -> MapOf<T> {
        MapOf { invalidates: Some(what), ..self }
    }
}

/// A table whose keys are free, with its values.
pub struct FreeKeys<'a, T>(MapOf<T>, &'a mut BTreeMap<String, T>);

impl<T: Value> Kind<BTreeMap<String, T>> for MapOf<T> {
    fn visit(self, key: Key, value: &mut BTreeMap<String, T>, visitor: &mut dyn Visitor) {
        visitor.table(Key { doc: key.doc, ..key }, &mut FreeKeys(self, value));
    }
}

impl<T: Value> TableSlot for FreeKeys<'_, T> {
    fn presence(&self) -> Presence {
        Presence::Always
    }

    fn invalidates(&self) -> Option<Invalidates> {
        self.0.invalidates
    }

    fn make(&mut self, _: &str) -> &mut dyn Table {
        self
    }

    fn each(&mut self, each: &mut dyn FnMut(Option<&str>, &mut dyn Table)) {
        each(None, self);
    }
}

impl<T: Value> Table for FreeKeys<'_, T> {
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        let FreeKeys(map, entries) = self;
        for name in
            visitor.free_keys(map.is_key, map.expected).unwrap_or_else(|| entries.keys().cloned().collect())
        {
            let value = entries.entry(name.clone()).or_insert_with(T::blank);
            (map.value)().visit(Key { name: &name, doc: "" }, value, visitor);
        }
    }

    fn doc(&self) -> &'static str {
        ""
    }
}

/// Whether a name of the user's may stand in a file name: letters, digits, `-` and `_`.
pub fn is_file_name(name: &str) -> bool {
    is_name(name) && name.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_')
}
