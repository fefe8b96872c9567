//! Results described once. A quantity is a [`Variable`]: a key, a unit, a sentence, dimensions and values, as in netCDF and xarray.
//! Variables stand in a [`Group`], or, one value a row, in a [`Table`]. All files come from these by the same writers, so that every
//! file holds the same quantities under the same names:
//!
//! | here | JSON | HDF5 | CSV | tables for people |
//! |---|---|---|---|---|
//! | [`Variable`] | a value, or nested lists | a dataset with `units`, `description` and dimension scales | a column | a column, where it is [`Shown`] |
//! | [`Group`] | an object | a group | | |
//! | [`Table`] | a list of objects | a group with a dataset a column | a file, where it has a name | a table |
//! | [`Entry::List`] | a list of objects, each with its `name` | a group of groups | | |
//! | [`Entry::Parts`] | one list of objects | a group of groups | a file each | |
//!
//! Rows are counted from 1, by the coordinate of their dimension (`mode` of a table of modes), or have a name. What is not there is `null` in JSON, an
//! empty field in CSV, and in HDF5 not a number, the `_FillValue` of a whole number, or an empty text. Complex numbers are compounds
//! `{r, i}` in HDF5, objects `{re, im}` in JSON and two columns in CSV.

mod column;
mod csv;
#[cfg(feature = "hdf5")]
mod hdf5;
mod json;
mod variable;

pub use column::{Cell, Column, IntoCell, column};
pub use csv::{CsvTable, number};
#[cfg(feature = "hdf5")]
pub use hdf5::{attach_scale, attribute, describe, link, opened, text_attribute};
pub use variable::{Dimension, Kind, Labels, Shown, Values, Variable};

use std::borrow::Cow;

/// A result that is described by named quantities.
pub trait Describe {
    /// Its quantities, in the group in which they stand in files.
    fn describe(&self) -> Group<'_>;
}

/// Quantities and groups of quantities, with a name.
#[derive(Debug)]
pub struct Group<'a> {
    /// The name; empty for what stands at the top of a file.
    pub key: Cow<'a, str>,
    /// One sentence.
    pub description: &'static str,
    /// Contents, in order.
    pub entries: Vec<Entry<'a>>,
}

/// A part of a [`Group`].
#[derive(Debug)]
pub enum Entry<'a> {
    /// A quantity.
    Variable(Variable<'a>),
    /// Some that belong together.
    Group(Group<'a>),
    /// Rows.
    Table(Table<'a>),
    /// Groups that are alike, each with a name of its own; the key of the list.
    List(&'static str, Vec<Group<'a>>),
    /// Tables that are alike: the key of all, the column that says which, and each with a name of its own as its key.
    Parts(&'static str, &'static str, Vec<Table<'a>>),
    /// Something that this run has not got.
    Absent(&'static str),
}

/// Variables with one value a row.
#[derive(Debug)]
pub struct Table<'a> {
    /// The name.
    pub key: Cow<'a, str>,
    /// The rows; the name of the dimension is that of the column with their numbers.
    pub rows: Dimension,
    /// The columns; all have the rows as their first dimension.
    pub columns: Vec<Variable<'a>>,
    /// Fields over the rows that are too large for JSON and CSV.
    pub fields: Vec<Variable<'a>>,
    /// The name of its CSV file without the extension, if it gets one.
    pub file: Option<String>,
    /// Whether it is in JSON; long tables are not.
    pub json: bool,
}

impl<'a> Group<'a> {
    /// An empty group.
    pub fn new(key: impl Into<Cow<'a, str>>, description: &'static str) -> Self {
        Group { key: key.into(), description, entries: Vec::new() }
    }

    /// The quantities of one record.
    pub fn of<R>(
        key: impl Into<Cow<'a, str>>,
        description: &'static str,
        columns: &[Column<R>],
        record: &R,
    ) -> Self {
        let mut group = Group::new(key, description);
        group.entries = columns.iter().map(|column| Entry::Variable(column.of(record))).collect();
        group
    }

    /// With one more quantity.
    #[must_use]
    pub fn with(mut self, variable: Variable<'a>) -> Self {
        self.entries.push(Entry::Variable(variable));
        self
    }

    /// With a single value.
    #[must_use]
    pub fn value<V: IntoCell>(
        self,
        key: &'static str,
        unit: &'static str,
        description: &'static str,
        value: V,
    ) -> Self {
        self.with(column(key, unit, description, |v: &V| v.clone()).of(&value))
    }

    /// With a group in it.
    #[must_use]
    pub fn group(mut self, group: Group<'a>) -> Self {
        self.entries.push(Entry::Group(group));
        self
    }

    /// With a group in it, if it is there.
    #[must_use]
    pub fn optional(mut self, key: &'static str, group: Option<Group<'a>>) -> Self {
        self.entries.push(group.map_or(Entry::Absent(key), Entry::Group));
        self
    }

    /// With a table in it.
    #[must_use]
    pub fn table(mut self, table: Table<'a>) -> Self {
        self.entries.push(Entry::Table(table));
        self
    }

    /// With groups that are alike, each with a name of its own.
    #[must_use]
    pub fn list(mut self, key: &'static str, groups: Vec<Group<'a>>) -> Self {
        self.entries.push(Entry::List(key, groups));
        self
    }

    /// With tables that are alike, distinguished by the column `by`.
    #[must_use]
    pub fn parts(mut self, key: &'static str, by: &'static str, tables: Vec<Table<'a>>) -> Self {
        self.entries.push(Entry::Parts(key, by, tables));
        self
    }

    /// With what another group holds at the top of a file: its entries where it has no name, the group itself where it has
    /// one. Lists of one key become one.
    #[must_use]
    pub fn merged(mut self, other: Group<'a>) -> Self {
        if !other.key.is_empty() {
            return self.group(other);
        }
        for entry in other.entries {
            let same = self.entries.iter_mut().find_map(|own| match (own, &entry) {
                (Entry::List(own, groups), Entry::List(key, _)) if own == key => Some(Ok(groups)),
                (Entry::Parts(own, _, tables), Entry::Parts(key, ..)) if own == key => Some(Err(tables)),
                _ => None,
            });
            match (same, entry) {
                (Some(Ok(groups)), Entry::List(_, more)) => groups.extend(more),
                (Some(Err(tables)), Entry::Parts(_, _, more)) => tables.extend(more),
                (_, entry) => self.entries.push(entry),
            }
        }
        self
    }

    /// All tables of the group and its groups, in order.
    pub fn tables(&self) -> Vec<&Table<'a>> {
        let mut found = Vec::new();
        for entry in &self.entries {
            match entry {
                Entry::Table(table) => found.push(table),
                Entry::Parts(_, _, tables) => found.extend(tables),
                Entry::Group(group) => found.extend(group.tables()),
                Entry::List(_, groups) => groups.iter().for_each(|group| found.extend(group.tables())),
                Entry::Variable(_) | Entry::Absent(_) => {}
            }
        }
        found
    }
}

impl<'a> Table<'a> {
    /// The columns of `records`, numbered from 1 by the dimension `rows`.
    pub fn of<R>(
        key: impl Into<Cow<'a, str>>,
        rows: &'static str,
        columns: &[Column<R>],
        records: &[R],
    ) -> Self {
        Self::over(key, Dimension::numbered(rows, records.len()), columns, records)
    }

    /// The columns of `records`, named by the column `by`.
    pub fn by<R>(
        key: impl Into<Cow<'a, str>>,
        by: &'static str,
        columns: &[Column<R>],
        records: &[R],
    ) -> Self {
        Self::over(key, Dimension::of_variable(by, records.len()), columns, records)
    }

    fn over<R>(key: impl Into<Cow<'a, str>>, rows: Dimension, columns: &[Column<R>], records: &[R]) -> Self {
        let columns = columns.iter().map(|column| column.over(&rows, records)).collect();
        Self::along(key, rows, columns)
    }

    /// Columns over a dimension, which is their first.
    pub fn along(key: impl Into<Cow<'a, str>>, rows: Dimension, columns: Vec<Variable<'a>>) -> Self {
        Table { key: key.into(), rows, columns, fields: Vec::new(), file: None, json: true }
    }

    /// With a field over the rows, in HDF5 only.
    #[must_use]
    pub fn field(mut self, field: Variable<'a>) -> Self {
        self.fields.push(field);
        self
    }

    /// With a CSV file of this name, which gets its extension when it is written.
    #[must_use]
    pub fn file(mut self, name: impl Into<String>) -> Self {
        self.file = Some(name.into());
        self
    }

    /// Left out of JSON.
    #[must_use]
    pub fn long(mut self) -> Self {
        self.json = false;
        self
    }
}
