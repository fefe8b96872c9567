//! `[measured.NAME]`: what a test found, and where its geometry lies in the mesh.

use super::reader::Section;
use super::units::{FREQUENCY, LENGTH, NUMBER};
use serde::Serialize;
use std::collections::BTreeMap;

/// Where a coordinate system lies when nothing else is said.
const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];

/// What a test found: in a file, or frequencies in the case itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasuredData {
    /// The real-mode analysis whose modes these are; none where only frequency responses are compared.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// The frequency response that measured ones are compared with.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frf: Option<String>,
    /// A file: universal (`.uff`, `.unv`), `.csv` or `.toml`; relative to the case.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Natural frequencies \[Hz\], where there is no file.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub frequencies: Vec<f64>,
    /// ζ of each frequency; none are known when empty.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub damping_ratios: Vec<f64>,
    /// Standard deviation of each frequency over the frequency, where the file does not state it.
    pub deviation: f64,
    /// Standard deviation of a component of a measured shape over the root mean square of its components.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape_deviation: Option<f64>,
    /// Standard deviation of ln |h| at a line of a measured response, in a calibration.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub response_deviation: Option<f64>,
    /// The lowest and the highest line \[Hz\] of a response that a calibration takes; those of the `[frf]` where not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub response_band: Option<[f64; 2]>,
    /// The most lines of a response that a calibration takes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub response_lines: Option<usize>,
    /// Where the figures come from.
    pub source: String,
    /// Points of the test by number, in its own frame \[m\], where the file does not have them.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub point: BTreeMap<String, [f64; 3]>,
    /// Where the frame of the test lies in the mesh.
    pub transform: Transform,
    /// A point farther than this from every node is a fault \[m\].
    pub reach: f64,
}

/// x_mesh = origin + R x_test; the columns of R are the axes of the test, made orthonormal.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Transform {
    /// The origin of the test in the mesh \[m\].
    pub origin: [f64; 3],
    /// The test's x axis in the mesh.
    pub x_axis: [f64; 3],
    /// A vector of the mesh in the half of the test's xy plane where y > 0.
    pub y_axis: [f64; 3],
    /// `m`, `cm`, `mm` or `in`, for a file that does not state its unit.
    pub unit: String,
}

impl Default for Transform {
    fn default() -> Self {
        Transform { origin: [0.0; 3], x_axis: X, y_axis: Y, unit: "m".into() }
    }
}

pub(super) fn read(s: &Section) -> MeasuredData {
    let file = s.string("file").optional();
    let positive = |list: &Vec<f64>| list.iter().all(|f| *f > 0.0);
    let frequencies =
        s.quantity_list("frequencies", FREQUENCY).check("frequencies above zero", positive).or(Vec::new());
    match (&file, s.has("frequencies")) {
        (None, false) => {
            s.fault("", "no data", "a `file`, or `frequencies` such as [330, 936]", "");
        }
        (Some(_), true) => s.fault("frequencies", "both `file` and `frequencies`", "one of them", ""),
        _ => {}
    }
    let count = frequencies.len();
    let ratios = s
        .quantity_list("damping_ratios", NUMBER)
        .check("ratios from 0 to below 1", |list| list.iter().all(|z| (0.0..1.0).contains(z)))
        .check("one ratio a frequency", |list| list.len() == count);
    let damping_ratios = ratios.or(Vec::new());
    MeasuredData {
        of: s.string("of").optional(),
        frf: s.string("frf").optional(),
        file,
        frequencies,
        damping_ratios,
        deviation: s
            .quantity("deviation", NUMBER)
            .check("a share above 0 and below 1", |v| *v > 0.0 && *v < 1.0)
            .or(0.005),
        shape_deviation: s.quantity("shape_deviation", NUMBER).positive().optional(),
        response_deviation: s.quantity("response_deviation", NUMBER).positive().optional(),
        response_band: s
            .quantities("response_band", FREQUENCY)
            .check("two frequencies above zero, the lower one first", |[low, high]| 0.0 < *low && low < high)
            .optional(),
        response_lines: s.whole("response_lines").check("at least 2", |n| *n >= 2).optional(),
        source: s.text("source").or(String::new()),
        point: s.section("point", read_points).unwrap_or_default(),
        transform: s.section("transform", read_transform).unwrap_or_default(),
        reach: s.quantity("reach", LENGTH).positive().or(5e-3),
    }
}

pub(super) fn read_points(s: &Section) -> BTreeMap<String, [f64; 3]> {
    for name in s.names().iter().filter(|name| name.parse::<u64>().is_err()) {
        s.fault(name, format!("the name \"{name}\""), "the number of a point of the test", "");
    }
    s.names().into_iter().map(|name| (name.clone(), s.quantities(&name, LENGTH).or([0.0; 3]))).collect()
}

fn read_transform(s: &Section) -> Transform {
    let (x_axis, y_axis) = (s.direction("x_axis").or(X), s.direction("y_axis").or(Y));
    let [a, b] = [x_axis, y_axis].map(|v| v.map(|c| c / v.iter().map(|c| c * c).sum::<f64>().sqrt()));
    let cosine: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
    if cosine.abs() > 1.0 - 1e-6 {
        s.fault("y_axis", "a vector along the `x_axis`", "a vector across the `x_axis`", "");
    }
    Transform {
        origin: s.quantities("origin", LENGTH).or([0.0; 3]),
        x_axis,
        y_axis,
        unit: s.choice("unit", &["m", "cm", "mm", "in"]).or("m").to_string(),
    }
}

/// Names that must stand elsewhere in the case.
pub(super) fn check(root: &Section, case: &super::Case) {
    let modes: Vec<&str> = case.modes.keys().map(String::as_str).collect();
    let frfs: Vec<&str> = case.frf.keys().map(String::as_str).collect();
    for (name, data) in &case.measured {
        let named =
            [("of", &data.of, "[modes] analysis", &modes), ("frf", &data.frf, "[frf] analysis", &frfs)];
        for (key, wanted, kind, known) in named {
            if let Some(wanted) = wanted.as_deref().filter(|wanted| !known.contains(wanted)) {
                super::read::unknown_name(root, &format!("measured.{name}.{key}"), wanted, kind, known);
            }
        }
        if case.modes.get(name).is_some_and(|analysis| !analysis.measured.is_empty()) {
            let expected = "another name, or no `measured` in that analysis";
            let found = format!("the name of [modes.{name}], which has measured frequencies itself");
            root.fault(&format!("measured.{name}"), found, expected, "");
        }
        if data.of.is_none() && (data.frf.is_none() || !data.frequencies.is_empty()) {
            let expected = "the [modes] analysis whose modes were measured";
            root.fault(&format!("measured.{name}.of"), "nothing", expected, "");
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
