//! A test in a TOML file of its own: points, modes and their shapes.
//!
//! ```toml
//! point.12 = ["75 mm", 0, 0]
//! [mode.first]
//! frequency = "330 Hz"
//! damping_ratio = 0.001
//! deviation = 0.002            # standard deviation of the frequency over the frequency
//! shape.12 = [0, 0, 1.0]       # motion of point 12 along x, y, z, in whatever scale
//! ```

use super::measured::is_number;
use crate::error::Result;
use crate::linalg::c64;
use crate::measured::{ModeRecord, TestRecords};
use crate::schema::units::{FREQUENCY, LENGTH, NUMBER};
use crate::schema::{Report, declare, key, read_table};
use std::collections::BTreeMap;

declare! {
    /// A test: points and modes.
    pub struct TestFile, checked by check {
        /// Points by number \[m\].
        pub point: BTreeMap<String, [f64; 3]> =
            key::values(|| key::quantities(LENGTH), "the number of a point of the test", is_number),
        /// Modes by name.
        pub mode: BTreeMap<String, TestMode> = key::named(),
    }
}

declare! {
    /// A mode of a test.
    pub struct TestMode {
        /// f \[Hz\].
        pub frequency: f64 = key::quantity(FREQUENCY).positive(),
        /// ζ.
        pub damping_ratio: Option<f64> = key::quantity(NUMBER)
            .check("a ratio from 0 to below 1", |z| (0.0..1.0).contains(z))
            .optional(),
        /// Standard deviation of the frequency over the frequency.
        pub deviation: Option<f64> = key::quantity(NUMBER)
            .check("a share above 0 and below 1", |v| *v > 0.0 && *v < 1.0)
            .optional(),
        /// Motion of points by number along x, y, z, in whatever scale.
        pub shape: BTreeMap<String, [f64; 3]> =
            key::values(|| key::quantities(NUMBER), "the number of a point", is_number),
    }
}

fn check(test: &TestFile, report: &mut Report) {
    if test.mode.is_empty() && !report.unread("mode") {
        report.fault("mode", "nothing", "tables such as [mode.1] with a `frequency`", "");
    }
}

/// Reads a test from TOML text; `file` names it in faults.
///
/// # Errors
/// Every fault of the file, each with its line and key.
pub fn read_test(file: &str, text: &str) -> Result<TestRecords> {
    let TestFile { point, mode } = read_table(file, text)?.table;
    let numbered = |all: BTreeMap<String, [f64; 3]>| {
        all.into_iter().filter_map(|(name, x)| Some((name.parse::<u64>().ok()?, x)))
    };
    let record = |mode: TestMode| ModeRecord {
        frequency_hz: mode.frequency,
        damping_ratio: mode.damping_ratio,
        deviation: mode.deviation,
        shape: numbered(mode.shape).map(|(point, u)| (point, u.map(|u| c64::new(u, 0.0)))).collect(),
    };
    let modes = mode.into_values().map(record).collect();
    Ok(TestRecords { points: numbered(point).collect(), modes, ..TestRecords::default() })
}

#[cfg(test)]
mod tests {
    use super::read_test;

    #[test]
    fn a_test_in_toml_is_read_and_its_faults_are_told_together() {
        let text = "point.2 = [\"1 mm\", 0, 0]\n[mode.a]\nfrequency = \"0.3 kHz\"\nshape.2 = [0, 0, -1]\n[mode.b]\nfrequency = 100\ndamping_ratio = 0.01\n";
        let (set, _) = read_test("t", text).unwrap().into_set();
        assert_eq!((set.modes[0].frequency_hz, set.modes[0].damping_ratio), (100.0, Some(0.01)));
        assert_eq!(set.modes[1].shape.as_ref().unwrap()[0].re, -1.0);
        assert_eq!(set.points[0].position[0], 1e-3);
        let wrong = "[mode.a]\nfrequenzy = 3\nshape.x = [1, 2]\ndeviation = 2\n";
        let text = read_test("t", wrong).unwrap_err().to_string();
        for part in ["frequenzy", "mode.a.frequency", "shape.x", "\"x\"", "deviation"] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(read_test("t", "").unwrap_err().to_string().contains("mode"));
    }
}
