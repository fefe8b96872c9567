//! Numbers for people.

use crate::linalg::c64;
use crate::numbers::{growth, minus};
pub(super) use crate::numbers::{hertz, significant};
use crate::stability::ROUND_OFF;

/// The growth rate σ of an eigenvalue \[1/s\].
pub(super) fn rate(lambda: c64) -> String {
    growth(lambda.re, lambda.norm(), ROUND_OFF)
}

/// A value that a person gave: as short as it was written, at most six significant digits.
pub(super) fn given(value: f64) -> String {
    let text = significant(value, 6);
    match text.split_once('.') {
        Some((whole, decimals)) if !text.contains('e') => {
            let decimals = decimals.trim_end_matches('0');
            if decimals.is_empty() { whole.to_string() } else { format!("{whole}.{decimals}") }
        }
        _ => text,
    }
}

/// `value` with a fixed number of decimals; a dash when it is not finite.
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    if value.is_finite() { minus(&format!("{value:.decimals$}")) } else { "–".into() }
}

/// The same with a plus sign when positive.
pub(super) fn signed(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    if value > 0.0 && value.is_finite() { format!("+{text}") } else { text }
}

/// An error measure as a power of ten with two digits, `–` when it is not finite.
pub(super) fn power(value: f64) -> String {
    if value.is_finite() { format!("{value:.1e}") } else { "–".into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_significant_digits() {
        assert_eq!(
            (given(936.0), given(0.5), given(1e-9)),
            ("936".into(), "0.5".into(), "1.00000e−9".into())
        );
        assert_eq!(fixed(-0.0004, 2), "0.00");
        assert_eq!(signed(1.25, 1), "+1.2");
        assert_eq!(signed(-1.26, 1), "−1.3");
    }
}
