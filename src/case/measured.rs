//! `[measured.NAME]`: what a test found, and where its geometry lies in the mesh.

use super::LengthUnit;
use crate::measured::Quantity;
use crate::schema::raw::MOST;
use crate::schema::units::{FREQUENCY, LENGTH, NUMBER};
use crate::schema::{Report, declare, dotted, key};
use std::collections::BTreeMap;

declare! {
    /// Measured modes or frequency responses: in a file, or frequencies in the case itself.
    pub struct MeasuredData, checked by check_data {
        /// The real-mode analysis whose modes these are; none where only frequency responses are compared.
        pub of: Option<String> = key::name("the name of a [modes] analysis").optional(),
        /// The frequency response that measured ones are compared with.
        pub frf: Option<String> = key::name("the name of an [frf] analysis").optional(),
        /// A file: universal (`.uff`, `.unv`), `.csv` or `.toml`; relative to the case.
        pub file: Option<String> = key::name("the path of a file").optional(),
        /// What the responses of a universal file are whose ordinates have no data type (0) and no label: motion over force.
        pub quantity: Option<Quantity> = key::choice().optional(),
        /// Natural frequencies \[Hz\], where there is no file.
        pub frequencies: Vec<f64> = key::quantity_list(FREQUENCY)
            .check("frequencies above zero", |list| list.iter().all(|f| *f > 0.0))
            .or(Vec::new()),
        /// ζ of each frequency; none are known when empty.
        pub damping_ratios: Vec<f64> = {
            let count = frequencies.len();
            key::quantity_list(NUMBER)
                .check("ratios from 0 to below 1", |list| list.iter().all(|z| (0.0..1.0).contains(z)))
                .check("one ratio a frequency", move |list| list.is_empty() || list.len() == count)
                .or(Vec::new())
        },
        /// Standard deviation of each frequency over the frequency, where the file does not state it.
        pub deviation: f64 = key::quantity(NUMBER)
            .check("a share above 0 and below 1", |v| *v > 0.0 && *v < 1.0)
            .or(0.005),
        /// Standard deviation of a component of a measured shape over the root mean square of its components.
        pub shape_deviation: Option<f64> = key::quantity(NUMBER).positive().optional(),
        /// Standard deviation of ln |h| at a line of a measured response, in a calibration.
        pub response_deviation: Option<f64> = key::quantity(NUMBER).positive().optional(),
        /// The lowest and the highest line \[Hz\] of a response that a calibration takes; those of the `[frf]` where not given.
        pub response_band: Option<[f64; 2]> = key::quantities(FREQUENCY)
            .check("two frequencies above zero, the lower one first", |[low, high]| 0.0 < *low && low < high)
            .optional(),
        /// The most lines of a response that a calibration takes.
        pub response_lines: Option<usize> = key::whole(2..=MOST).optional(),
        /// Where the figures come from.
        pub source: String = key::text(),
        /// Points of the test by number, in its own frame \[m\], where the file does not have them.
        pub point: BTreeMap<String, [f64; 3]> =
            key::values(|| key::quantities(LENGTH), "the number of a point of the test", is_number),
        /// Where the frame of the test lies in the mesh.
        pub transform: Transform = key::table(),
        /// A point farther than this from every node is a fault \[m\].
        pub reach: f64 = key::quantity(LENGTH).positive().or(5e-3),
    }
}

declare! {
    /// x_mesh = origin + R x_test; the columns of R are the axes of the test, made orthonormal.
    pub struct Transform {
        /// The origin of the test in the mesh \[m\].
        pub origin: [f64; 3] = key::quantities(LENGTH).or([0.0; 3]),
        /// The test's x axis in the mesh.
        pub x_axis: [f64; 3] = key::direction().or([1.0, 0.0, 0.0]),
        /// A vector of the mesh in the half of the test's xy plane where y > 0.
        pub y_axis: [f64; 3] = {
            let x_axis = *x_axis;
            key::direction()
                .check("a vector across the `x_axis`", move |y_axis| !along(x_axis, *y_axis))
                .or([0.0, 1.0, 0.0])
        },
        /// The unit of a file that does not state it.
        pub unit: LengthUnit = key::choice().or(LengthUnit::Metre),
    }
}

/// Whether a name is the number of a point.
pub(super) fn is_number(name: &str) -> bool {
    name.parse::<u64>().is_ok()
}

fn check_data(data: &MeasuredData, report: &mut Report) {
    match (&data.file, data.frequencies.is_empty()) {
        (None, true) => report.fault("", "no data", "a `file`, or `frequencies` such as [330, 936]", ""),
        (Some(_), false) => {
            report.fault("frequencies", "both `file` and `frequencies`", "one of them", "");
        }
        _ => {}
    }
}

/// Whether two vectors lie along one line.
fn along(a: [f64; 3], b: [f64; 3]) -> bool {
    let [a, b] = [a, b].map(|v| v.map(|c| c / v.iter().map(|c| c * c).sum::<f64>().sqrt()));
    let cosine: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
    cosine.abs() > 1.0 - 1e-6
}

/// Names that must stand elsewhere in the case.
pub(super) fn check(root: &mut Report, case: &super::Case) {
    let modes: Vec<&str> = case.modes.keys().map(String::as_str).collect();
    let frfs: Vec<&str> = case.frf.keys().map(String::as_str).collect();
    for (name, data) in &case.measured {
        let named =
            [("of", &data.of, "[modes] analysis", &modes), ("frf", &data.frf, "[frf] analysis", &frfs)];
        for (key, wanted, kind, known) in named {
            if let Some(wanted) = wanted.as_deref().filter(|wanted| !known.contains(wanted)) {
                super::names::unknown_name(
                    root,
                    &format!("measured.{}.{key}", dotted(name)),
                    wanted,
                    kind,
                    known,
                );
            }
        }
        if case.modes.get(name).is_some_and(|analysis| !analysis.measured.is_empty()) {
            let expected = "another name, or no `measured` in that analysis";
            let found = format!("the name of [modes.{name}], which has measured frequencies itself");
            root.fault(&format!("measured.{}", dotted(name)), found, expected, "");
        }
        if data.of.is_none() && (data.frf.is_none() || !data.frequencies.is_empty()) {
            let expected = "the [modes] analysis whose modes were measured";
            root.fault(&format!("measured.{}.of", dotted(name)), "nothing", expected, "");
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::case::Case;

    const CASE: &str = r#"
[point]
a = [0, 0, 0]
[modes.disc]
count = 3
[measured.impact]
of = "disc"
frequencies = [330, "0.936 kHz"]
damping_ratios = [0.001, 0.002]
source = "a hammer"
transform = { origin = ["1 mm", 0, 0], x_axis = [0, 0, 2], unit = "mm" }
point.12 = ["1 mm", 0, 0]
"#;

    #[test]
    fn measured_data_have_units_defaults_and_come_back() {
        let case = Case::parse("t", CASE, ".".into()).unwrap();
        let data = &case.measured["impact"];
        assert_eq!((data.frequencies[1], data.damping_ratios[1]), (936.0, 0.002));
        assert_eq!((data.deviation, data.reach), (0.005, 5e-3));
        assert_eq!((data.transform.origin[0], data.transform.y_axis), (1e-3, [0.0, 1.0, 0.0]));
        let again = Case::parse("t", &case.to_toml(), ".".into()).unwrap();
        assert_eq!(again, case);
    }

    #[test]
    fn all_that_is_wrong_is_said_at_once() {
        let wrong = CASE
            .replace("of = \"disc\"", "of = \"disk\"\nfrf = \"hammer\"\nfile = \"a.uff\"")
            .replace("damping_ratios = [0.001,", "damping_ratios = [0.001, 0.001,")
            .replace("unit = \"mm\"", "unit = \"ell\", y_axis = [0, 0, 1]")
            .replace("point.12", "point.rim");
        let text = Case::parse("t", &wrong, ".".into()).unwrap_err().to_string();
        let said = ["disk", "measured.impact.frf", "both `file`", "one ratio", "unit", "y_axis", "\"rim\""];
        for part in said {
            assert!(text.contains(part), "{part}: {text}");
        }
        let nothing =
            CASE.replace("of = \"disc\"", "").replace("frequencies =", "# ").replace("damping_", "# ");
        let text = Case::parse("t", &nothing, ".".into()).unwrap_err().to_string();
        assert!(text.contains("no data") && text.contains("measured.impact.of"), "{text}");
    }
}
