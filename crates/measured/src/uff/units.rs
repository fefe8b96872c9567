//! Units: dataset 164, and the labels of axes.

use super::dataset::Dataset;
use stridor_base::error::Result;

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

/// Factor to SI of the unit that an axis is labelled with.
pub(super) fn labelled(label: &str) -> Option<f64> {
    const KNOWN: [(&str, f64); 17] = [
        ("m", 1.0),
        ("mm", 1e-3),
        ("um", 1e-6),
        ("in", 0.0254),
        ("m/s", 1.0),
        ("mm/s", 1e-3),
        ("in/s", 0.0254),
        ("m/s2", 1.0),
        ("mm/s2", 1e-3),
        ("in/s2", 0.0254),
        ("g", 9.80665),
        ("n", 1.0),
        ("kn", 1e3),
        ("lbf", 4.448_221_615_260_5),
        ("lb", 4.448_221_615_260_5),
        ("newton", 1.0),
        ("m/sec2", 1.0),
    ];
    let plain: String = label
        .to_lowercase()
        .replace('²', "2")
        .replace(['µ', 'μ'], "u")
        .chars()
        .filter(|c| c.is_ascii_alphanumeric() || *c == '/')
        .collect();
    let plain = plain.strip_suffix("/n").unwrap_or(&plain);
    KNOWN.iter().find(|(name, _)| *name == plain).map(|(_, unit)| *unit)
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
