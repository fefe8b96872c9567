//! Tables of a TOML file, each key declared once: its type, unit, bounds, default, one line of documentation, and what a
//! change of it invalidates. Reading, checking, writing, the list of scalars, the JSON Schema and the reference of the keys are
//! visitors of these declarations.
//!
//! `declare!` makes a struct of a table, `variants!` an enum of tables that a
//! key tells apart, `choices!` an enum of words.

mod check;
mod defaults;
mod describe;
mod invalidates;
mod json;
pub mod key;
mod keys;
mod macros;
mod markdown;
mod places;
#[doc(hidden)]
pub mod raw;
mod read;
pub mod reader;
mod scalars;
mod table;
#[cfg(test)]
mod tests;
pub mod units;
mod value;
mod write;

pub use check::{Report, check};
pub use defaults::with_defaults;
pub use describe::{Content, DescribedKey, DescribedTable, DescribedVariants, describe};
pub use invalidates::{Derivative, Invalidates};
pub use json::json_schema;
pub use key::{About, Field};
pub use keys::{dotted, keys_of};
pub use markdown::key_reference;
pub use places::Places;
pub use read::{ReadTable, read_table};
pub use scalars::{Scalar, scalar, scalars, set_scalar};
pub use table::{Presence, TableSlot};
pub use units::Dimension;
pub use value::{Blank, Form, Units, Value};
pub use write::to_toml;

#[doc(hidden)]
pub use toml;
use toml::de::DeValue;

/// A table with declared keys.
pub trait Table {
    /// Hands every key to `visitor`, in the order of declaration.
    fn visit(&mut self, visitor: &mut dyn Visitor);

    /// Reports what is wrong between the keys; each by itself has been checked.
    fn check(&self, _report: &mut Report) {}

    /// One line of documentation.
    fn doc(&self) -> &'static str;
}

/// A key of a table.
#[derive(Debug, Clone, Copy)]
pub struct Key<'a> {
    /// Its name.
    pub name: &'a str,
    /// One line of documentation, as it stands in the source.
    pub doc: &'static str,
}

/// How the value of a key is declared: a [`Field`], or one of the kinds of tables.
pub trait Kind<T> {
    /// Hands the key and its value to `visitor`.
    fn visit(self, key: Key, value: &mut T, visitor: &mut dyn Visitor);
}

/// The value of a key together with its declaration.
pub trait Slot {
    /// The declaration.
    fn about(&self) -> &About;
    /// Takes the value of a document; the error says what was found.
    fn read(&mut self, value: &DeValue) -> Result<(), String>;
    /// Takes the default; `false` when there is none.
    fn set_default(&mut self) -> bool;
    /// The default as TOML; `None` when there is none or it is nothing.
    fn default_toml(&self) -> Option<toml::Value>;
    /// The value as TOML; `None` where it is nothing.
    fn to_toml(&self) -> Option<toml::Value>;
    /// Faults of the value: (found, expected).
    fn faults(&self) -> Vec<(String, String)>;
    /// Hands every number to `each`, with its indices in lists.
    fn numbers(&mut self, each: &mut dyn FnMut(&[usize], &mut f64));
    /// Form of the value in TOML.
    fn form(&self) -> Form;
}

/// Visitor of declared keys.
pub trait Visitor {
    /// A key with a value.
    fn value(&mut self, key: Key, slot: &mut dyn Slot);

    /// A key with a table, or with named tables.
    fn table(&mut self, key: Key, slot: &mut dyn TableSlot);

    /// Tables of which one stands here; `visit` walks over the keys of the one with the index that it gets.
    fn variants(
        &mut self,
        variants: &Variants,
        current: usize,
        visit: &mut dyn FnMut(usize, &mut dyn Visitor),
    );

    /// Keys of another declaration in the same table.
    fn flat(&mut self, table: &mut dyn Table);

    /// The keys of a table whose keys are free, where the visitor decides; `is_key` says what may be one, `expected` in words.
    fn free_keys(&mut self, _is_key: fn(&str) -> bool, _expected: &str) -> Option<Vec<String>> {
        None
    }
}

/// Tables of which one stands in a place.
#[derive(Debug, Clone, Copy)]
pub struct Variants {
    /// Criterion that selects the variant.
    pub by: By,
    /// Word and documentation of each.
    pub each: &'static [(&'static str, &'static str)],
    /// The one that stands there when nothing is said.
    pub default: Option<usize>,
}

/// Criterion that selects a variant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum By {
    /// The word at this key.
    Tag(&'static str),
    /// Which of the words is a key of the table.
    Presence,
}

/// A documentation line without the marks of Markdown.
pub fn plain(doc: &str) -> String {
    doc.trim().replace("\\[", "[").replace("\\]", "]")
}
