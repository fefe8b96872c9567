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

use super::measured::read_points;
use super::reader::{Section, read_document};
use super::units::{FREQUENCY, NUMBER};
use crate::error::Result;
use crate::linalg::c64;
use crate::measured::{ModeRecord, Records};
use std::collections::BTreeMap;

/// Reads a test from TOML text; `file` names it in faults.
///
/// # Errors
/// Every fault of the file, each with its line and key.
pub fn read_test(file: &str, text: &str) -> Result<Records> {
    let read = |root: &Section| {
        let points = root.section("point", read_points).unwrap_or_default();
        let modes = root.named("mode", |_, s| read_mode(s));
        if modes.is_empty() {
            root.fault("mode", "nothing", "tables such as [mode.1] with a `frequency`", "");
        }
        let number = |(name, x): (String, [f64; 3])| Some((name.parse().ok()?, x));
        Records { points: points.into_iter().filter_map(number).collect(), modes, ..Records::default() }
    };
    read_document(file, text, read).map(|(records, _)| records)
}

fn read_mode(s: &Section) -> ModeRecord {
    let shape = s.section("shape", |s| {
        let mut shape = BTreeMap::new();
        for name in s.names() {
            let motion = s.quantities::<3>(&name, NUMBER).or([0.0; 3]);
            match name.parse::<u64>() {
                Ok(number) => {
                    shape.insert(number, motion.map(|u| c64::new(u, 0.0)));
                }
                Err(_) => s.fault(&name, format!("the name \"{name}\""), "the number of a point", ""),
            }
        }
        shape
    });
    ModeRecord {
        frequency_hz: s.quantity("frequency", FREQUENCY).positive().required(FREQUENCY.name),
        damping_ratio: s
            .quantity("damping_ratio", NUMBER)
            .check("a ratio from 0 to below 1", |z| (0.0..1.0).contains(z))
            .optional(),
        deviation: s
            .quantity("deviation", NUMBER)
            .check("a share above 0 and below 1", |v| *v > 0.0 && *v < 1.0)
            .optional(),
        shape: shape.unwrap_or_default(),
    }
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
