//! Numbers for people.

use crate::linalg::c64;
use crate::numbers::growth;
pub(super) use crate::numbers::{fixed, given, hertz, power, signed, significant};
use crate::stability::ROUND_OFF;

/// The growth rate σ of an eigenvalue \[1/s\].
pub(super) fn rate(lambda: c64) -> String {
    growth(lambda.re, lambda.norm(), ROUND_OFF)
}

/// `value` rounded to `digits` significant digits, of which [`given`] shows no more than it has.
pub(super) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// A value that a person gave; with two digits where it takes a power of ten.
pub(super) fn short(value: f64) -> String {
    let text = given(value);
    if text.contains('e') { significant(value, 2) } else { text }
}

/// A decimal multiple of an SI unit: µm, mm/s, kN.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Multiple {
    /// Its size in the SI unit.
    pub size: f64,
    /// How it is written.
    pub unit: String,
}

/// 1000 over the least number that is 1000 with three digits.
const ROUNDED: f64 = 1000.0 / 999.5;

/// The multiple of `unit` in which `value` has one to three digits before the point. Units whose first part is not a bare unit (a
/// square, a ratio of numbers) have none but themselves, nor have numbers beyond all prefixes.
pub(super) fn multiple(value: f64, unit: &str) -> Multiple {
    const PREFIXES: [(i32, &str); 7] =
        [(-12, "p"), (-9, "n"), (-6, "µ"), (-3, "m"), (0, ""), (3, "k"), (6, "M")];
    let written = unit.replace("^2", "²");
    let first = unit.split(['/', ' ']).next().unwrap_or("");
    let takes = ["m", "N", "J", "W", "Pa", "V", "rad"].contains(&first) && value != 0.0 && value.is_finite();
    // Lengths and angles above one have no prefix: kilometres per second squared are no unit of vibration.
    let most = if ["m", "rad"].contains(&first) { 0 } else { 6 };
    // With three digits 999.5 is 1000, one of the next.
    let thousand = (((value.abs() * ROUNDED).log10() / 3.0).floor() as i32).saturating_mul(3).min(most);
    match PREFIXES.iter().find(|(power, _)| takes && *power == thousand) {
        Some((power, prefix)) => Multiple { size: 10f64.powi(*power), unit: format!("{prefix}{written}") },
        None => Multiple { size: 1.0, unit: written },
    }
}

/// `value` in a multiple of its unit: 1.2e−5 m as `12.0 µm`.
pub(super) fn prefixed(value: f64, unit: &str, digits: usize) -> String {
    let Multiple { size, unit } = multiple(value, unit);
    format!("{} {unit}", significant(value / size, digits)).trim_end().to_string()
}

#[cfg(test)]
mod tests {
    use super::{given, prefixed, rounded};

    #[test]
    fn rounded_values_are_as_short_as_they_can_be() {
        let shown = [20.0, 0.589815, 3141.59, 0.0, 1e-18].map(|v| given(rounded(v, 4)));
        assert_eq!(shown, ["20", "0.5898", "3142", "0", "1e−18"]);
    }

    #[test]
    fn prefixes_keep_the_digits_short() {
        let shown = [
            (9.9999e-7, "m"),
            (1.2e-5, "m"),
            (-0.345, "m/s"),
            (7930.0, "m/s^2"),
            (1234.0, "N"),
            (3e-15, "m"),
            (0.0, "m"),
            (2e-4, "1"),
        ];
        let shown = shown.map(|(value, unit)| prefixed(value, unit, 3));
        assert_eq!(
            shown,
            ["1.000 µm", "12.0 µm", "−345 mm/s", "7930 m/s²", "1.23 kN", "3.00e−15 m", "0 m", "0.000200 1"]
        );
    }
}
