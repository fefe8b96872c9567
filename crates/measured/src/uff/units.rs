//! Units: dataset 164, and the labels of axes.

use stridor_base::error::Result;
use stridor_base::universal::Dataset;

/// Factors from the units of the file to SI.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnitFactors {
    /// \[m\].
    pub length: f64,
    /// \[N\].
    pub force: f64,
}

/// Reads dataset 164: a quantity of the file divided by its factor is in SI.
pub(super) fn read(dataset: &Dataset<'_>) -> Result<UnitFactors> {
    let mut factors = Vec::new();
    for index in 1..dataset.lines.len() {
        factors.extend(dataset.numbers(index, &[25])?);
    }
    match factors[..] {
        [length, force, ..] if length > 0.0 && force > 0.0 => {
            Ok(UnitFactors { length: 1.0 / length, force: 1.0 / force })
        }
        _ => Err(dataset.fault(
            1,
            format!("{} factors", factors.len()),
            "factors of length and force above zero",
        )),
    }
}

/// Dataset 164 of a file in SI.
pub(super) const SI: &str = "    -1\n   164\n         1SI: Meter (newton)           2\n   1.0000000000000000D+00   1.0000000000000000D+00   1.0000000000000000D+00\n   2.7315000000000000D+02\n    -1\n";

/// Units: name, how often a length in it is differentiated (a force: none), factor to SI.
const KNOWN: [(&str, Option<u8>, f64); 18] = [
    ("m", Some(0), 1.0),
    ("mm", Some(0), 1e-3),
    ("um", Some(0), 1e-6),
    ("in", Some(0), 0.0254),
    ("m/s", Some(1), 1.0),
    ("mm/s", Some(1), 1e-3),
    ("in/s", Some(1), 0.0254),
    ("m/s2", Some(2), 1.0),
    ("mm/s2", Some(2), 1e-3),
    ("in/s2", Some(2), 0.0254),
    ("m/sec2", Some(2), 1.0),
    ("g", Some(2), 9.80665),
    ("n", None, 1.0),
    ("newton", None, 1.0),
    ("newtons", None, 1.0),
    ("kn", None, 1e3),
    ("lbf", None, 4.448_221_615_260_5),
    ("lb", None, 4.448_221_615_260_5),
];

/// What is known of the unit that an axis is labelled with.
fn known(label: &str) -> Option<(Option<u8>, f64)> {
    let plain: String = label
        .to_lowercase()
        .replace('²', "2")
        .replace(['µ', 'μ'], "u")
        .chars()
        .filter(|c| c.is_ascii_alphanumeric() || *c == '/')
        .collect();
    let plain = plain.strip_suffix("/n").unwrap_or(&plain);
    KNOWN.iter().find(|(name, ..)| *name == plain).map(|(_, order, unit)| (*order, *unit))
}

/// Factor to SI of the unit that an axis is labelled with.
pub(super) fn labelled(label: &str) -> Option<f64> {
    known(label).map(|(_, unit)| unit)
}

/// Factor to Hz of the unit that an axis of frequencies is labelled with; 1 where it is none that is known.
pub(super) fn hertz(label: &str) -> f64 {
    match label.to_lowercase().as_str() {
        "khz" => 1e3,
        "rad/s" | "rad/sec" => 1.0 / std::f64::consts::TAU,
        "rpm" | "1/min" => 1.0 / 60.0,
        _ => 1.0,
    }
}

/// 0 of a unit of displacement, 1 of velocity, 2 of acceleration.
pub(super) fn order(label: &str) -> Option<u8> {
    known(label).and_then(|(order, _)| order)
}

/// Whether an axis is labelled with a unit of force.
pub(super) fn is_force(label: &str) -> bool {
    known(label).is_some_and(|(order, _)| order.is_none())
}

#[cfg(test)]
mod tests {
    use super::labelled;

    #[test]
    fn labels_are_known_however_they_are_written() {
        assert_eq!(labelled("m/s^2"), Some(1.0));
        assert_eq!(labelled("(m/s²)/N"), Some(1.0));
        assert_eq!(labelled(" G "), Some(9.80665));
        assert_eq!(labelled("NONE"), None);
        assert_eq!(labelled(""), None);
    }
}
