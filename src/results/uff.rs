//! Frequency responses as datasets 58 of the Universal File Format, which test-data programs read
//! (SDRC's *Universal File Datasets Summary*; functions at nodal degrees of freedom).

use super::FrfResult;

/// Codes of dataset 58: frequency response function; complex in double precision.
const FRF: u32 = 4;
const COMPLEX_DOUBLE: u32 = 6;
/// Specific data types: frequency, excitation force.
const FREQUENCY: u32 = 18;
const FORCE: u32 = 13;

/// All places of a response, one dataset each: the excitation is node 1, the places are nodes 2, 3 …; directions are
/// scalar, since they need not be along an axis.
pub(super) fn datasets(frf: &FrfResult) -> String {
    let mut text = String::new();
    let (kind, label) = match frf.quantity[0] {
        "receptance" => (8, "Displacement"),
        "mobility" => (11, "Velocity"),
        _ => (12, "Acceleration"),
    };
    let unit = match kind {
        8 => "m",
        11 => "m/s",
        _ => "m/s^2",
    };
    for (k, response) in frf.responses.iter().enumerate() {
        let line = |text: &str| {
            format!("{:<80}\n", text.chars().filter(char::is_ascii).take(80).collect::<String>())
        };
        text += "    -1\n    58\n";
        text += &line(&format!("{} of {} for a force at {}", frf.quantity[0], response.name, frf.name));
        text += &line(&response.place);
        text += &line("NONE");
        text += &line(&frf.about);
        text += &line(&format!("Force: {}", frf.excitation));
        text += &format!(
            "{FRF:5}{:10}{:5}{:10} {:<10}{:10}{:4} {:<10}{:10}{:4}\n",
            0,
            0,
            0,
            "NONE",
            k + 2,
            0,
            "NONE",
            1,
            0
        );
        // Uneven: every line gives its own frequency.
        text += &format!(
            "{COMPLEX_DOUBLE:10}{:10}{:10}{}{}{}\n",
            frf.frequencies_hz.len(),
            0,
            number(0.0, 13, 5),
            number(0.0, 13, 5),
            number(0.0, 13, 5)
        );
        let axis = |kind: u32, label: &str, unit: &str| {
            format!("{kind:10}{:5}{:5}{:5} {label:<20} {unit:<20}\n", 0, 0, 0)
        };
        text += &axis(FREQUENCY, "Frequency", "Hz");
        text += &axis(kind, label, unit);
        text += &axis(FORCE, "Force", "N");
        text += &axis(0, "NONE", "NONE");
        for (hz, value) in frf.frequencies_hz.iter().zip(&response.values) {
            text +=
                &format!("{}{}{}\n", number(*hz, 13, 5), number(value.re, 20, 12), number(value.im, 20, 12));
        }
        text += "    -1\n";
    }
    text
}

/// Fortran's E format: ` 1.66123E+03`.
fn number(x: f64, width: usize, digits: usize) -> String {
    let plain = format!("{x:.digits$e}");
    let (mantissa, exponent) = plain.split_once('e').unwrap_or((&plain, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let sign = if exponent < 0 { '-' } else { '+' };
    let text = format!("{mantissa}E{sign}{:02}", exponent.abs());
    format!("{text:>width$}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::sample;

    #[test]
    fn datasets_have_the_columns_of_the_format() {
        let results = sample::rig();
        let frf = &results.frfs[0];
        let text = datasets(frf);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.iter().filter(|l| l.trim() == "-1").count(), 2 * frf.responses.len());
        assert_eq!(&lines[1][..6], "    58");
        assert_eq!(lines[7].len(), 5 + 10 + 5 + 10 + 1 + 10 + 10 + 4 + 1 + 10 + 10 + 4);
        assert_eq!(lines[8][10..20].trim().parse::<usize>().unwrap(), frf.frequencies_hz.len());
        let value = |line: &str| {
            [&line[..13], &line[13..33], &line[33..]].map(|part| part.trim().parse::<f64>().unwrap())
        };
        let [hz, re, im] = value(lines[13]);
        let exact = frf.responses[0].values[0];
        assert!((hz / frf.frequencies_hz[0] - 1.0).abs() < 1e-5);
        assert!(
            (re - exact.re).abs() <= 1e-12 * exact.norm() && (im - exact.im).abs() <= 1e-12 * exact.norm()
        );
        assert_eq!(number(-0.00123456789, 13, 5), " -1.23457E-03");
    }
}
