//! Single values of TOML: how they are read, and how a fault reports them.

use super::keys::is_name;
use super::units::{Dimension, parse_of_any_scalar, parse_quantity};
use stridor_base::error::nearest;
use toml::de::DeValue;

/// The largest size of a quantity in SI units; the least that is not zero is one over it. Products of several stay finite.
pub const LARGEST: f64 = 1e60;
/// The largest whole number.
pub const MOST: usize = 1_000_000_000;

/// A number, or a string with a unit of the dimension; of any dimension where none is given.
pub fn quantity_of(value: &DeValue, dimension: Option<Dimension>) -> Result<f64, String> {
    let number = match value {
        DeValue::Integer(i) => {
            i64::from_str_radix(&i.as_str().replace('_', ""), i.radix()).ok().map(|v| v as f64)
        }
        DeValue::Float(f) => f.as_str().replace('_', "").parse().ok(),
        DeValue::String(text) => Some(match dimension {
            Some(dimension) => parse_quantity(text, dimension)?,
            None => parse_of_any_scalar(text)?,
        }),
        _ => None,
    };
    match number {
        Some(v) if v == 0.0 || (1.0 / LARGEST..=LARGEST).contains(&v.abs()) => Ok(v),
        Some(v) if v.is_finite() => Err(format!("{v:e}, which is not from 1e-60 to 1e60 in size")),
        Some(v) => Err(format!("{v}, which is not finite")),
        None => Err(describe(value)),
    }
}

/// The value that belongs to one of some words.
pub fn word_of<T: Copy>(value: &DeValue, words: &[(&str, T)]) -> Result<T, String> {
    let text = string_of(value)?;
    let near = nearest(&text, words.iter().map(|(word, _)| *word));
    let meant = near.map_or(String::new(), |near| format!(" (did you mean \"{near}\"?)"));
    words.iter().find(|(word, _)| *word == text).map(|(_, value)| *value).ok_or(format!("\"{text}\"{meant}"))
}

pub fn string_of(value: &DeValue) -> Result<String, String> {
    value.as_str().map(str::to_string).ok_or_else(|| describe(value))
}

/// A name: not empty, without control characters.
pub fn name_of(value: &DeValue) -> Result<String, String> {
    let name = string_of(value)?;
    if is_name(&name) { Ok(name) } else { Err(format!("the string {name:?}")) }
}

pub fn whole_of(value: &DeValue, least: usize) -> Result<usize, String> {
    let number = value.as_integer().and_then(|i| usize::from_str_radix(i.as_str(), i.radix()).ok());
    number.filter(|n| (least..=MOST).contains(n)).ok_or_else(|| describe(value))
}

pub fn list_of<T>(value: &DeValue, item: impl Fn(&DeValue) -> Result<T, String>) -> Result<Vec<T>, String> {
    let array = value.as_array().ok_or_else(|| describe(value))?;
    array.iter().map(|v| item(v.get_ref())).collect()
}

pub fn describe(value: &DeValue) -> String {
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
