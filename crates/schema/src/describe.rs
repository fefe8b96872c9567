//! Declarations as data, for the JSON Schema and the reference of the keys.

use super::value::Blank;
use super::{By, Form, Key, Presence, Slot, Table, TableSlot, Variants, Visitor, plain};
use std::ops::Bound;

/// A table.
#[derive(Debug, Clone, Default)]
pub struct DescribedTable {
    /// Documentation, one line.
    pub doc: String,
    /// Its keys, in the order of declaration.
    pub keys: Vec<DescribedKey>,
    /// Keys of which one set stands there.
    pub variants: Vec<DescribedVariants>,
    /// Content of a key, where the names of keys are free.
    pub free: Option<Box<DescribedKey>>,
}

/// Sets of keys of which one stands in a table.
#[derive(Debug, Clone)]
pub struct DescribedVariants {
    /// Criterion that selects the variant.
    pub by: By,
    /// The index of the one that stands there when nothing is said.
    pub default: Option<usize>,
    /// Word, documentation and keys of each.
    pub each: Vec<(&'static str, String, DescribedTable)>,
}

/// A key.
#[derive(Debug, Clone)]
pub struct DescribedKey {
    /// Its name.
    pub name: String,
    /// Documentation, one line.
    pub doc: String,
    /// Content: a value, a table, variants.
    pub content: Content,
}

/// Content of a key.
#[derive(Debug, Clone)]
pub enum Content {
    /// A value.
    Value {
        /// Form in TOML.
        form: Form,
        /// Expected value, in words.
        expected: String,
        /// The SI unit of its numbers; empty for pure numbers.
        unit: &'static str,
        /// The values that its numbers may have.
        bounds: (Bound<f64>, Bound<f64>),
        /// Whether it must be there.
        required: bool,
        /// The default as TOML, or in words.
        default: Option<String>,
    },
    /// A table, or named tables.
    Table(Presence, DescribedTable),
}

/// Description of tables of the type `T`.
pub fn describe<T: Table + Blank>() -> DescribedTable {
    described(&mut T::blank())
}

fn described(table: &mut dyn Table) -> DescribedTable {
    let mut all = DescribedTable { doc: plain(table.doc()), ..DescribedTable::default() };
    table.visit(&mut all);
    all
}

/// The key of a table whose keys are free.
const FREE: &str = "*";

impl Visitor for DescribedTable {
    fn value(&mut self, key: Key, slot: &mut dyn Slot) {
        let about = slot.about();
        let of_key = about.default_words.map(String::from);
        let content = Content::Value {
            form: slot.form(),
            expected: about.expected.to_string(),
            unit: about.units.at(0).map_or("", |dimension| dimension.symbol),
            bounds: about.bounds,
            required: about.required,
            default: of_key.or_else(|| slot.default_toml().map(|value| value.to_string())),
        };
        let described = DescribedKey { name: key.name.to_string(), doc: plain(key.doc), content };
        if key.name == FREE { self.free = Some(Box::new(described)) } else { self.keys.push(described) }
    }

    fn table(&mut self, key: Key, slot: &mut dyn TableSlot) {
        let content = Content::Table(slot.presence(), described(slot.make("NAME")));
        self.keys.push(DescribedKey { name: key.name.to_string(), doc: plain(key.doc), content });
    }

    fn variants(&mut self, variants: &Variants, _: usize, visit: &mut dyn FnMut(usize, &mut dyn Visitor)) {
        let each = variants.each.iter().enumerate().map(|(k, (word, doc))| {
            let mut keys = DescribedTable::default();
            visit(k, &mut keys);
            (*word, plain(doc), keys)
        });
        let each = each.collect();
        self.variants.push(DescribedVariants { by: variants.by, default: variants.default, each });
    }

    fn flat(&mut self, table: &mut dyn Table) {
        table.visit(self);
    }

    fn free_keys(&mut self, _: fn(&str) -> bool, _: &str) -> Option<Vec<String>> {
        Some(vec![FREE.into()])
    }
}
