//! Types of values: how they are read from TOML and written, and the numbers in them.

use super::raw::{MOST, describe, quantity_of};
use super::units::{Dimension, NUMBER};
use std::cell::RefCell;
use std::collections::BTreeMap;
use toml::de::DeValue;

/// A value before anything is known about it.
pub trait Blank {
    /// Zero, nothing, the first choice.
    fn blank() -> Self;
}

/// A type of values.
pub trait Value: Blank + Clone + std::fmt::Debug + 'static {
    /// The value of TOML, entry `k` of the list that it is in; the error says what was found.
    fn read(value: &DeValue, units: &Units, k: usize) -> Result<Self, String>;
    /// The value as TOML; `None` for nothing.
    fn to_toml(&self) -> Option<toml::Value>;
    /// Form of the value in TOML.
    fn form() -> Form;
    /// Hands every number to `each`, with its indices in lists, which begin with those of `at`.
    fn numbers(&mut self, _at: &mut Vec<usize>, _each: &mut dyn FnMut(&[usize], &mut f64)) {}
    /// The value in a fault.
    fn in_words(&self) -> String {
        format!("{self:?}")
    }
}

/// Form of a value in TOML.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// A number, or a string with a unit.
    Quantity,
    /// A whole number.
    Whole,
    /// `true` or `false`.
    Flag,
    /// A string.
    Text,
    /// One of some words, each with its documentation.
    Choice(&'static [(&'static str, &'static str)]),
    /// A list, of so many entries where that is fixed.
    List(Box<Form>, Option<usize>),
    /// Either of two.
    Either(Box<Form>, Box<Form>),
}

/// The units of the numbers of a value.
pub struct Units {
    /// One for all, or one for each entry of the innermost lists; any when empty.
    dimensions: Vec<Dimension>,
    /// The strings that were read where any unit is taken, with the entry of the list.
    pub given: RefCell<Vec<(usize, String)>>,
}

impl Units {
    /// The same for all numbers.
    pub fn one(dimension: Dimension) -> Units {
        Units { dimensions: vec![dimension], given: RefCell::default() }
    }

    /// One for each entry of the innermost lists.
    pub fn each(dimensions: &[Dimension]) -> Units {
        Units { dimensions: dimensions.to_vec(), given: RefCell::default() }
    }

    /// Any; strings are kept in [`Units::given`].
    pub fn any() -> Units {
        Units { dimensions: Vec::new(), given: RefCell::default() }
    }

    /// Of a value without quantities.
    pub fn none() -> Units {
        Units::one(NUMBER)
    }

    /// The dimension of entry `k`; `None` for any.
    pub fn at(&self, k: usize) -> Option<Dimension> {
        self.dimensions.get(k).or(self.dimensions.first()).copied()
    }
}

impl Blank for f64 {
    fn blank() -> f64 {
        0.0
    }
}

impl Value for f64 {
    fn read(value: &DeValue, units: &Units, k: usize) -> Result<f64, String> {
        if let (None, Some(text)) = (units.at(k), value.as_str()) {
            units.given.borrow_mut().push((k, text.to_string()));
        }
        quantity_of(value, units.at(k))
    }

    fn to_toml(&self) -> Option<toml::Value> {
        Some(toml::Value::Float(*self))
    }

    fn form() -> Form {
        Form::Quantity
    }

    fn numbers(&mut self, at: &mut Vec<usize>, each: &mut dyn FnMut(&[usize], &mut f64)) {
        each(at, self);
    }
}

impl Blank for usize {
    fn blank() -> usize {
        0
    }
}

impl Value for usize {
    fn read(value: &DeValue, _: &Units, _: usize) -> Result<usize, String> {
        let number = value.as_integer().and_then(|i| usize::from_str_radix(i.as_str(), i.radix()).ok());
        number.filter(|n| *n <= MOST).ok_or_else(|| describe(value))
    }

    fn to_toml(&self) -> Option<toml::Value> {
        i64::try_from(*self).ok().map(toml::Value::Integer)
    }

    fn form() -> Form {
        Form::Whole
    }

    fn in_words(&self) -> String {
        format!("the whole number {self}")
    }
}

impl Blank for bool {
    fn blank() -> bool {
        false
    }
}

impl Value for bool {
    fn read(value: &DeValue, _: &Units, _: usize) -> Result<bool, String> {
        value.as_bool().ok_or_else(|| describe(value))
    }

    fn to_toml(&self) -> Option<toml::Value> {
        Some(toml::Value::Boolean(*self))
    }

    fn form() -> Form {
        Form::Flag
    }
}

impl Blank for String {
    fn blank() -> String {
        String::new()
    }
}

impl Value for String {
    fn read(value: &DeValue, _: &Units, _: usize) -> Result<String, String> {
        value.as_str().map(str::to_string).ok_or_else(|| describe(value))
    }

    fn to_toml(&self) -> Option<toml::Value> {
        Some(toml::Value::String(self.clone()))
    }

    fn form() -> Form {
        Form::Text
    }

    fn in_words(&self) -> String {
        format!("the string {self:?}")
    }
}

impl<T> Blank for Option<T> {
    fn blank() -> Option<T> {
        None
    }
}

impl<T: Value> Value for Option<T> {
    fn read(value: &DeValue, units: &Units, k: usize) -> Result<Option<T>, String> {
        T::read(value, units, k).map(Some)
    }

    fn to_toml(&self) -> Option<toml::Value> {
        self.as_ref()?.to_toml()
    }

    fn form() -> Form {
        T::form()
    }

    fn numbers(&mut self, at: &mut Vec<usize>, each: &mut dyn FnMut(&[usize], &mut f64)) {
        self.iter_mut().for_each(|value| value.numbers(at, each));
    }

    fn in_words(&self) -> String {
        self.as_ref().map_or("nothing".into(), T::in_words)
    }
}

impl<T> Blank for Vec<T> {
    fn blank() -> Vec<T> {
        Vec::new()
    }
}

impl<T: Value> Value for Vec<T> {
    /// A single string is a list of one.
    fn read(value: &DeValue, units: &Units, _: usize) -> Result<Vec<T>, String> {
        match value.as_array() {
            Some(list) => {
                list.iter().enumerate().map(|(k, value)| T::read(value.get_ref(), units, k)).collect()
            }
            None if value.is_str() && T::form() == Form::Text => Ok(vec![T::read(value, units, 0)?]),
            None => Err(describe(value)),
        }
    }

    fn to_toml(&self) -> Option<toml::Value> {
        Some(toml::Value::Array(self.iter().filter_map(T::to_toml).collect()))
    }

    fn form() -> Form {
        let list = Form::List(Box::new(T::form()), None);
        if T::form() == Form::Text { Form::Either(Box::new(Form::Text), Box::new(list)) } else { list }
    }

    fn numbers(&mut self, at: &mut Vec<usize>, each: &mut dyn FnMut(&[usize], &mut f64)) {
        for (k, value) in self.iter_mut().enumerate() {
            at.push(k);
            value.numbers(at, each);
            at.pop();
        }
    }
}

impl<T: Blank, const N: usize> Blank for [T; N] {
    fn blank() -> [T; N] {
        std::array::from_fn(|_| T::blank())
    }
}

impl<T: Value, const N: usize> Value for [T; N] {
    fn read(value: &DeValue, units: &Units, _: usize) -> Result<[T; N], String> {
        let list = value.as_array().ok_or_else(|| describe(value))?;
        let entry = |(k, value): (usize, &toml::Spanned<DeValue>)| T::read(value.get_ref(), units, k);
        let list: Vec<T> = list.iter().enumerate().map(entry).collect::<Result<_, _>>()?;
        let count = list.len();
        list.try_into().map_err(|_| format!("a list of {count}"))
    }

    fn to_toml(&self) -> Option<toml::Value> {
        Some(toml::Value::Array(self.iter().filter_map(T::to_toml).collect()))
    }

    fn form() -> Form {
        Form::List(Box::new(T::form()), Some(N))
    }

    fn numbers(&mut self, at: &mut Vec<usize>, each: &mut dyn FnMut(&[usize], &mut f64)) {
        for (k, value) in self.iter_mut().enumerate() {
            at.push(k);
            value.numbers(at, each);
            at.pop();
        }
    }
}

impl<T> Blank for BTreeMap<String, T> {
    fn blank() -> Self {
        BTreeMap::new()
    }
}
