//! Declarations of keys that hold values: [`quantity`] and its like, then bounds, default, checks.

pub use super::keys::is_name;
pub use super::table::{flat, is_file_name, named, table, values};

use super::invalidates::{Derivative, Invalidates};
use super::raw::MOST;
use super::units::Dimension;
use super::value::{Form, Units, Value};
use super::{Key, Kind, Slot, Visitor};
use std::borrow::Cow;
use std::ops::{Bound, RangeBounds, RangeInclusive};
use toml::de::DeValue;

/// Declaration of a key beside its type.
pub struct About {
    /// Expected value, in words, for messages.
    pub expected: Cow<'static, str>,
    /// The units of its numbers.
    pub units: Units,
    /// The values that each of its numbers may have.
    pub bounds: (Bound<f64>, Bound<f64>),
    /// Results that a change invalidates; `None` for those of its table.
    pub invalidates: Option<Invalidates>,
    /// Whether eigenvalues have a derivative by its numbers, by their indices in lists.
    pub derivative: fn(&[usize], f64) -> Derivative,
    /// Whether it must be there.
    pub required: bool,
    /// The default in words, where it follows from other keys.
    pub default_words: Option<&'static str>,
    /// Name of the quantity for axes, where the words of the key are none.
    pub label: Option<&'static str>,
}

/// A condition on a value, with what is expected in words.
type Condition<T> = (Cow<'static, str>, Box<dyn Fn(&T) -> bool>);

/// The declaration of a key that holds a value.
pub struct Field<T> {
    about: About,
    default: Option<T>,
    conditions: Vec<Condition<T>>,
}

fn field<T: Value>(expected: impl Into<Cow<'static, str>>, units: Units) -> Field<T> {
    let about = About {
        expected: expected.into(),
        units,
        bounds: (Bound::Unbounded, Bound::Unbounded),
        invalidates: None,
        derivative: |_, _| Derivative::Exists,
        required: true,
        default_words: None,
        label: None,
    };
    Field { about, default: None, conditions: Vec::new() }
}

/// A quantity: a number in SI units, or a string with its unit.
pub fn quantity(dimension: Dimension) -> Field<f64> {
    field(dimension.name, Units::one(dimension))
}

/// A quantity in the unit of another scalar, which is checked where that scalar is known.
pub fn quantity_of_scalar() -> Field<f64> {
    field("a value in the unit of the parameter", Units::any())
}

/// `N` quantities in units of other scalars.
pub fn quantities_of_scalars<const N: usize>() -> Field<[f64; N]> {
    field(format!("a list of {N} values in the units of the parameters"), Units::any())
}

/// A list of `N` quantities.
pub fn quantities<const N: usize>(dimension: Dimension) -> Field<[f64; N]> {
    field(format!("a list of {N} values, each {}", dimension.name), Units::one(dimension))
}

/// A vector that is not zero, of whatever length.
pub fn direction() -> Field<[f64; 3]> {
    quantities(super::units::NUMBER).check("a vector that is not zero", |v| v.iter().any(|x| *x != 0.0))
}

/// A list of quantities of any length.
pub fn quantity_list(dimension: Dimension) -> Field<Vec<f64>> {
    field(format!("a list, each {}", dimension.name), Units::one(dimension))
}

/// A list of quantities in the unit of another scalar, which is checked where that scalar is known.
pub fn quantity_list_of_scalar() -> Field<Vec<f64>> {
    field("a list of values in the unit of another scalar", Units::any())
}

/// A list of lists of two quantities, each with its own dimension.
pub fn pairs(dimensions: [Dimension; 2]) -> Field<Vec<[f64; 2]>> {
    field("a list of lists of two values", Units::each(&dimensions))
}

/// A list of rows of numbers.
pub fn rows(dimension: Dimension) -> Field<Vec<Vec<f64>>> {
    field("a list of rows of numbers", Units::one(dimension))
}

/// A string for people to read, of any length; none when absent.
pub fn text() -> Field<String> {
    field("a string", Units::none()).or(String::new())
}

/// A list of such strings, none when absent; a single one is a list of one.
pub fn texts() -> Field<Vec<String>> {
    field("a list of strings", Units::none()).or(Vec::new())
}

/// The name of something, or the path of a file; `expected` is said where it is missing.
pub fn name(expected: &'static str) -> Field<String> {
    field(expected, Units::none())
        .check("a string of at least one character, on one line", |name: &String| is_name(name))
}

/// A list of names; a single string is a list of one.
pub fn names(expected: &'static str) -> Field<Vec<String>> {
    let expected_of_each = "a list of strings, each of at least one character, on one line";
    field(expected, Units::none())
        .check(expected_of_each, |list: &Vec<String>| list.iter().all(|n| is_name(n)))
}

/// `true` or `false`.
pub fn flag(default: bool) -> Field<bool> {
    field("true or false", Units::none()).or(default)
}

/// A whole number from one to a billion.
pub fn count() -> Field<usize> {
    whole(1..=MOST)
}

/// A whole number of this range, a billion at most.
pub fn whole(range: RangeInclusive<usize>) -> Field<usize> {
    let [low, high] = [range.start(), range.end()].map(|n| match *n {
        MOST => "a billion".into(),
        1_000_000 => "a million".into(),
        n => n.to_string(),
    });
    let expected = format!("a whole number from {low} to {high}");
    let mut whole = field(expected.clone(), Units::none());
    let end = if *range.end() == MOST { Bound::Unbounded } else { Bound::Included(*range.end() as f64) };
    whole.about.bounds = (Bound::Included(*range.start() as f64), end);
    whole.check(expected, move |n| range.contains(n))
}

/// A value of another type, with what is expected in words.
pub fn value<T: Value>(expected: &'static str) -> Field<T> {
    field(expected, Units::one(super::units::NUMBER))
}

/// One of the words of an enum.
pub fn choice<T: Value>() -> Field<T> {
    let Form::Choice(words) = T::form() else { unreachable!("an enum of words") };
    let words: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
    field(format!("one of {}", words.join(", ")), Units::none())
}

impl<T: Value> Field<T> {
    /// The value when the key is absent.
    pub fn or(mut self, default: T) -> Self {
        self.default = Some(default);
        self.about.required = false;
        self
    }

    /// The value when the key is absent, which follows from other keys as `words` say.
    pub fn or_by(mut self, words: &'static str, default: T) -> Self {
        self.about.default_words = Some(words);
        self.or(default)
    }

    /// The key must be there, but not always: as `words` say.
    pub fn required_sometimes(mut self, words: &'static str) -> Self {
        self.about.default_words = Some(words);
        self.about.required = false;
        self
    }

    /// Sets the expected value, in words, for messages about an absent key or another type.
    pub fn expecting(mut self, words: &'static str) -> Self {
        self.about.expected = words.into();
        self
    }

    /// Refuses values that do not hold.
    pub fn check(
        mut self,
        expected: impl Into<Cow<'static, str>>,
        holds: impl Fn(&T) -> bool + 'static,
    ) -> Self {
        self.conditions.push((expected.into(), Box::new(holds)));
        self
    }

    /// Sets the results that a change of the value invalidates, where they differ from those of its table.
    pub fn invalidates(mut self, what: Invalidates) -> Self {
        self.about.invalidates = Some(what);
        self
    }

    /// Sets the name of the quantity for axes, where the words of the key are none.
    pub fn label(mut self, words: &'static str) -> Self {
        self.about.label = Some(words);
        self
    }

    /// Whether eigenvalues have a derivative by its numbers, by their indices in lists.
    pub fn derivative(mut self, of: fn(&[usize], f64) -> Derivative) -> Self {
        self.about.derivative = of;
        self
    }

    /// The key may be absent, and then there is no value.
    pub fn optional(self) -> Field<Option<T>> {
        let about = About { required: false, ..self.about };
        let each = |(expected, holds): Condition<T>| -> Condition<Option<T>> {
            (expected, Box::new(move |value| value.as_ref().is_none_or(&holds)))
        };
        Field { about, default: Some(None), conditions: self.conditions.into_iter().map(each).collect() }
    }
}

impl<T: Value> Field<Vec<T>> {
    /// Refuses a list of nothing.
    pub fn not_empty(self) -> Self {
        self.check("at least one", |list| !list.is_empty())
    }
}

impl Field<f64> {
    /// Refuses zero and below.
    pub fn positive(self) -> Self {
        self.within(Bound::Excluded(0.0), Bound::Unbounded)
    }

    /// Refuses values below zero.
    pub fn non_negative(self) -> Self {
        self.within(Bound::Included(0.0), Bound::Unbounded)
    }

    /// Refuses values outside these bounds.
    pub fn within(mut self, lower: Bound<f64>, upper: Bound<f64>) -> Self {
        self.about.bounds = (lower, upper);
        self.check(describe_bounds(lower, upper), move |v| (lower, upper).contains(v))
    }
}

/// Bounds in words: "a value above 0", "a value from 0 to 1".
pub(super) fn describe_bounds(lower: Bound<f64>, upper: Bound<f64>) -> String {
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

impl<T: Value> Kind<T> for Field<T> {
    fn visit(self, key: Key, value: &mut T, visitor: &mut dyn Visitor) {
        visitor.value(key, &mut Declared { field: self, value });
    }
}

/// A value with its declaration.
struct Declared<'a, T> {
    field: Field<T>,
    value: &'a mut T,
}

impl<T: Value> Slot for Declared<'_, T> {
    fn about(&self) -> &About {
        &self.field.about
    }

    fn read(&mut self, value: &DeValue) -> Result<(), String> {
        *self.value = T::read(value, &self.field.about.units, 0)?;
        Ok(())
    }

    fn set_default(&mut self) -> bool {
        if let Some(default) = &self.field.default {
            *self.value = default.clone();
        }
        self.field.default.is_some()
    }

    fn default_toml(&self) -> Option<toml::Value> {
        self.field.default.as_ref()?.to_toml()
    }

    fn to_toml(&self) -> Option<toml::Value> {
        let is_nothing = |value: &toml::Value| match value {
            toml::Value::Array(list) => list.is_empty(),
            toml::Value::String(text) => text.is_empty(),
            _ => false,
        };
        let value = self.value.to_toml()?;
        // Nothing need not be said where it is the default.
        if is_nothing(&value) && self.default_toml().as_ref() == Some(&value) { None } else { Some(value) }
    }

    fn faults(&self) -> Vec<(String, String)> {
        let broken = self.field.conditions.iter().filter(|(_, holds)| !holds(self.value));
        broken.map(|(expected, _)| (self.value.in_words(), expected.to_string())).take(1).collect()
    }

    fn numbers(&mut self, each: &mut dyn FnMut(&[usize], &mut f64)) {
        self.value.numbers(&mut Vec::new(), each);
    }

    fn form(&self) -> Form {
        T::form()
    }
}
