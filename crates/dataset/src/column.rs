//! A quantity of a kind of record: what all rows of a table have in common.

use super::variable::{Dimension, Kind, Shown, Values, Variable};
use num_complex::Complex64 as c64;
use std::borrow::Cow;
use std::fmt;

/// A quantity that every record of a kind has.
pub struct Column<R> {
    key: &'static str,
    unit: Cow<'static, str>,
    description: &'static str,
    kind: Kind,
    /// Dimensions beyond the rows.
    dimensions: Vec<Dimension>,
    shown: Option<(&'static str, Text<R>)>,
    proof: bool,
    value: Box<dyn Fn(&R) -> Cell>,
}

/// How a record shows a quantity to people.
type Text<R> = Box<dyn Fn(&R) -> String>;

impl<R> fmt::Debug for Column<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Column").field("key", &self.key).field("unit", &self.unit).finish_non_exhaustive()
    }
}

/// Values of a quantity in a record.
#[derive(Debug, Clone)]
pub enum Cell {
    /// Yes or no.
    Flag(bool),
    /// Whole numbers.
    Integers(Vec<i64>),
    /// A whole number or none.
    Sparse(Option<i64>),
    /// Numbers.
    Reals(Vec<f64>),
    /// A complex number.
    Complex(c64),
    /// Words.
    Texts(Vec<Option<String>>),
}

/// Type that can be a value of a quantity.
pub trait IntoCell: Clone {
    /// The type of the values.
    const KIND: Kind;
    /// The value.
    fn cell(self) -> Cell;
}

/// `key`, `unit` and a sentence of a quantity, and how a record has it.
pub fn column<R, V: IntoCell>(
    key: &'static str,
    unit: impl Into<Cow<'static, str>>,
    description: &'static str,
    value: impl Fn(&R) -> V + 'static,
) -> Column<R> {
    let value = Box::new(move |record: &R| value(record).cell());
    let (unit, kind) = (unit.into(), V::KIND);
    Column { key, unit, description, kind, dimensions: Vec::new(), shown: None, proof: false, value }
}

impl<R> Column<R> {
    /// With several values a record.
    #[must_use]
    pub fn along(mut self, dimension: Dimension) -> Self {
        self.dimensions.push(dimension);
        self
    }

    /// In tables for people, too: the words above it, and the value as they see it.
    #[must_use]
    pub fn shown(mut self, heading: &'static str, text: impl Fn(&R) -> String + 'static) -> Self {
        self.shown = Some((heading, Box::new(text)));
        self
    }

    /// The same of an error or a condition number, which proves the other columns: in a table beside theirs.
    #[must_use]
    pub fn proof(mut self, heading: &'static str, text: impl Fn(&R) -> String + 'static) -> Self {
        self.proof = true;
        self.shown(heading, text)
    }

    /// The quantity of one record.
    pub(super) fn of<'a>(&self, record: &R) -> Variable<'a> {
        self.variable(self.dimensions.clone(), std::slice::from_ref(record))
    }

    /// The quantity of all records.
    pub(super) fn over<'a>(&self, rows: &Dimension, records: &[R]) -> Variable<'a> {
        let dimensions = std::iter::once(rows).chain(&self.dimensions).cloned().collect();
        self.variable(dimensions, records)
    }

    fn variable<'a>(&self, dimensions: Vec<Dimension>, records: &[R]) -> Variable<'a> {
        let mut values = Values::empty(self.kind);
        for record in records {
            match (&mut values, (self.value)(record)) {
                (Values::Flags(all), Cell::Flag(value)) => all.push(value),
                (Values::Integers(all), Cell::Integers(value)) => all.extend(value),
                (Values::Sparse(all), Cell::Sparse(value)) => all.push(value),
                (Values::Reals(all), Cell::Reals(value)) => all.extend(value),
                (Values::Complexes(all), Cell::Complex(value)) => all.push(value),
                (Values::Texts(all), Cell::Texts(value)) => all.extend(value),
                _ => unreachable!("the kind is that of the values"),
            }
        }
        let mut variable = Variable::new(self.key, self.unit.clone(), self.description, dimensions, values);
        variable.shown = self.shown.as_ref().map(|(heading, text)| Shown {
            heading,
            cells: records.iter().map(text).collect(),
            words: self.kind == Kind::Text,
            proof: self.proof,
        });
        variable
    }
}

macro_rules! cells {
    ($($type:ty: $kind:ident, $value:ident => $cell:expr;)*) => {
        $(impl IntoCell for $type {
            const KIND: Kind = Kind::$kind;
            fn cell(self) -> Cell {
                let $value = self;
                $cell
            }
        })*
    };
}

cells! {
    bool: Flag, v => Cell::Flag(v);
    usize: Integer, v => Cell::Integers(vec![v as i64]);
    u64: Integer, v => Cell::Integers(vec![v as i64]);
    u32: Integer, v => Cell::Integers(vec![i64::from(v)]);
    i64: Integer, v => Cell::Integers(vec![v]);
    Option<usize>: Sparse, v => Cell::Sparse(v.map(|v| v as i64));
    f64: Real, v => Cell::Reals(vec![v]);
    Option<f64>: Real, v => Cell::Reals(vec![v.unwrap_or(f64::NAN)]);
    Vec<f64>: Real, v => Cell::Reals(v);
    c64: Complex, v => Cell::Complex(v);
    Option<c64>: Complex, v => Cell::Complex(v.unwrap_or(c64::new(f64::NAN, f64::NAN)));
    &'static str: Text, v => Cell::Texts(vec![Some(v.into())]);
    String: Text, v => Cell::Texts(vec![Some(v)]);
    Option<String>: Text, v => Cell::Texts(vec![v]);
    Vec<String>: Text, v => Cell::Texts(v.into_iter().map(Some).collect());
}

impl<const N: usize> IntoCell for [f64; N] {
    const KIND: Kind = Kind::Real;
    fn cell(self) -> Cell {
        Cell::Reals(self.to_vec())
    }
}

impl<const N: usize> IntoCell for Option<[f64; N]> {
    const KIND: Kind = Kind::Real;
    fn cell(self) -> Cell {
        Cell::Reals(self.unwrap_or([f64::NAN; N]).to_vec())
    }
}

impl<const N: usize> IntoCell for [usize; N] {
    const KIND: Kind = Kind::Integer;
    fn cell(self) -> Cell {
        Cell::Integers(self.iter().map(|v| *v as i64).collect())
    }
}
