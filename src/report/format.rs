//! Numbers for people.

use crate::linalg::c64;
use crate::numbers::growth;
pub(super) use crate::numbers::{fixed, given, hertz, power, signed, significant};
use crate::stability::ROUND_OFF;

/// The growth rate σ of an eigenvalue \[1/s\].
pub(super) fn rate(lambda: c64) -> String {
    growth(lambda.re, lambda.norm(), ROUND_OFF)
}

/// A value that a person gave; with two digits where it takes a power of ten.
pub(super) fn short(value: f64) -> String {
    let text = given(value);
    if text.contains('e') { significant(value, 2) } else { text }
}
