//! Numbers of a case that were found from measured modes and responses, as plain data, and their files.

use super::write_result;
use crate::calibration::Calibration;
use crate::dataset::{CsvTable as Table, number};
use crate::error::Result;
use crate::measured::Quantity;
use std::f64::consts::LN_10;
use std::path::Path;

/// A calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibrationResult {
    /// The numbers, in the order of their names.
    pub numbers: Vec<CalibratedNumber>,
    /// The measured frequencies beside the computed ones of the best assignment.
    pub data: Vec<CalibratedDatum>,
    /// The measured frequency responses beside the computed ones.
    pub responses: Vec<CalibratedResponse>,
    /// What each computed level is called.
    pub levels: Vec<String>,
    /// The set that each level belongs to.
    pub level_sets: Vec<String>,
    /// Fits, and what they are worth, in the units of the calibration.
    pub calibration: Calibration,
    /// The case with the values that were found, as TOML that loads from any folder.
    pub calibrated_case: String,
}

/// A number that was found \[SI\].
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedNumber {
    /// Its name.
    pub name: String,
    /// The scalars that have this value.
    pub paths: Vec<String>,
    /// Its SI unit; empty for a pure number.
    pub unit: String,
    /// Its bounds.
    pub between: [f64; 2],
    /// What was expected.
    pub expected: f64,
    /// Standard deviation of that; its share of the value where `log`. Without it every value inside the bounds was as good.
    pub deviation: Option<f64>,
    /// Whether equal ratios are equal steps.
    pub log: bool,
    /// The value of the case.
    pub before: f64,
    /// The value that was found.
    pub after: f64,
    /// Its standard deviation, the stated deviations trusted, with what was expected.
    pub deviation_after: f64,
    /// 95 %, the stated deviations trusted; inside the bounds.
    pub interval: [f64; 2],
    /// 95 %, the deviations scaled by what the fit leaves, with Student's t; none where no fact is left over.
    pub scaled_interval: Option<[f64; 2]>,
    /// Whether it ended at a bound.
    pub at_bound: bool,
}

/// A measured frequency beside the computed one.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedDatum {
    /// The set it belongs to: the name of real modes, or `squeal`.
    pub set: String,
    /// What was measured \[Hz\].
    pub measured_hz: f64,
    /// Its relative standard deviation.
    pub deviation: f64,
    /// What the mode is called.
    pub level: String,
    /// Computed with the values of the case \[Hz\].
    pub before_hz: Option<f64>,
    /// Computed with the values that were found \[Hz\].
    pub after_hz: Option<f64>,
    /// Computed with the values that the other data lead to \[Hz\]; none where they do not tell.
    pub left_out_hz: Option<f64>,
    /// Growth rate of the mode with the values that were found \[1/s\]; none of a real mode.
    pub growth: Option<f64>,
    /// Its shape, if it was measured and taken in.
    pub shape: Option<CalibratedShape>,
}

/// A measured frequency response beside the computed one, at the lines that were compared. Sizes are √(|h|² + n²), with a floor n
/// below which nothing is compared, in the SI unit of the quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedResponse {
    /// The name of the measured set.
    pub set: String,
    /// What the test calls it.
    pub name: String,
    /// What the case calls its place.
    pub place: String,
    /// What of the motion.
    pub quantity: Quantity,
    /// Standard deviation of ln |h|.
    pub deviation: f64,
    /// \[Hz\].
    pub frequencies_hz: Vec<f64>,
    /// Measured.
    pub measured: Vec<f64>,
    /// Computed with the values of the case.
    pub before: Vec<f64>,
    /// Computed with the values that were found.
    pub after: Vec<f64>,
    /// Computed with the values that all other data lead to; none where they do not tell.
    pub left_out: Option<Vec<f64>>,
}

impl CalibratedResponse {
    /// Root mean square of 20 log₁₀ (computed/measured) \[dB\].
    pub fn apart_db(&self, computed: &[f64]) -> f64 {
        let squares = computed.iter().zip(&self.measured).map(|(a, b)| (20.0 * (a / b).log10()).powi(2));
        (squares.sum::<f64>() / computed.len().max(1) as f64).sqrt()
    }

    /// Root mean square of ln (computed/measured) over its standard deviation: √(χ² a line).
    pub fn apart(&self, computed: &[f64]) -> f64 {
        self.apart_db(computed) * LN_10 / (20.0 * self.deviation)
    }
}

/// MAC of a measured shape with the computed level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CalibratedShape {
    /// How many components were measured.
    pub components: usize,
    /// With the values of the case.
    pub before: Option<f64>,
    /// With the values that were found.
    pub after: Option<f64>,
    /// With the values that the other data lead to; none where they do not tell.
    pub left_out: Option<f64>,
}

impl CalibratedDatum {
    /// 100 (computed − measured)/measured \[%\]: positive when the computed frequency is too high.
    pub fn error_percent(&self, computed_hz: Option<f64>) -> Option<f64> {
        computed_hz.map(|hz| 100.0 * (hz / self.measured_hz - 1.0))
    }

    /// One of the MAC of its shape.
    pub fn mac(&self, pick: impl Fn(&CalibratedShape) -> Option<f64>) -> Option<f64> {
        self.shape.as_ref().and_then(pick)
    }
}

impl CalibrationResult {
    /// The largest |error| of `pick` among the data \[%\]; none where there are none, or one of them has none.
    pub fn largest_percent(&self, pick: impl Fn(&CalibratedDatum) -> Option<f64>) -> Option<f64> {
        let errors = self.data.iter().map(|datum| Some(datum.error_percent(pick(datum))?.abs()));
        errors.collect::<Option<Vec<f64>>>()?.into_iter().reduce(f64::max)
    }

    /// The data with measured shapes.
    pub fn shapes(&self) -> impl Iterator<Item = &CalibratedShape> {
        self.data.iter().filter_map(|datum| datum.shape.as_ref())
    }

    /// The least MAC of `pick`; none where there are no shapes, or one of them has none.
    pub fn least_mac(&self, pick: impl Fn(&CalibratedShape) -> Option<f64>) -> Option<f64> {
        let all = self.shapes().map(pick).collect::<Option<Vec<f64>>>()?;
        all.into_iter().reduce(f64::min)
    }
}

/// Writes `calibrated.toml` and `calibration.csv` into the folder `dir`.
pub(super) fn write(dir: &Path, result: &CalibrationResult) -> Result<()> {
    write_result(dir, "calibrated.toml", result.calibrated_case.as_bytes())?;
    if !result.responses.is_empty() {
        write_result(dir, "calibration_responses.csv", responses(result).as_bytes())?;
    }
    write_result(dir, "calibration.csv", table(result).as_bytes())
}

fn responses(result: &CalibrationResult) -> String {
    let mut table = Table::new(&[
        "set",
        "response",
        "place",
        "frequency [Hz]",
        "measured",
        "before",
        "after",
        "from the others",
        "unit",
    ]);
    for r in &result.responses {
        for (k, hz) in r.frequencies_hz.iter().enumerate() {
            let words = [&r.set, &r.name, &r.place].map(String::clone);
            let numbers = [*hz, r.measured[k], r.before[k], r.after[k]].map(number);
            let left_out = r.left_out.as_ref().map(|sizes| number(sizes[k])).unwrap_or_default();
            let last = [left_out, r.quantity.unit().to_string()];
            table.row(&words.into_iter().chain(numbers).chain(last).collect::<Vec<_>>());
        }
    }
    table.text
}

fn table(result: &CalibrationResult) -> String {
    let mut table = Table::new(&[
        "set",
        "mode",
        "measured [Hz]",
        "relative deviation",
        "before [Hz]",
        "after [Hz]",
        "error [%]",
        "from the others [Hz]",
        "MAC before",
        "MAC after",
        "MAC from the others",
    ]);
    let cell = |value: Option<f64>| value.map(number).unwrap_or_default();
    for datum in &result.data {
        table.row(&[
            datum.set.clone(),
            datum.level.clone(),
            number(datum.measured_hz),
            number(datum.deviation),
            cell(datum.before_hz),
            cell(datum.after_hz),
            cell(datum.error_percent(datum.after_hz)),
            cell(datum.left_out_hz),
            cell(datum.mac(|shape| shape.before)),
            cell(datum.mac(|shape| shape.after)),
            cell(datum.mac(|shape| shape.left_out)),
        ]);
    }
    table.text
}

#[cfg(test)]
mod tests {
    use super::super::sample::calibration as sample;
    use super::super::{ResultsFile, RunResults, summary_json, write_files};
    use serde_json::json;

    #[test]
    fn the_files_say_what_was_found() {
        let results = RunResults { calibration: Some(sample()), ..RunResults::default() };
        let json = &summary_json(&results)["calibration"];
        assert!((json["largest_error_percent"].as_f64().unwrap() - 1.0).abs() < 1e-9);
        assert!((json["data"][0]["left_out_percent"].as_f64().unwrap() + 3.0).abs() < 1e-9);
        assert!((json["chance"]["probability_by_largest_error"].as_f64().unwrap() - 0.05).abs() < 1e-12);
        assert_eq!(json["trials"]["least_coverage"], 0.95);
        assert_eq!(
            (&json["data"][0]["shape"]["mac_after"], &json["least_mac"]),
            (&json!(0.97), &json!(0.97))
        );
        assert!(json["data"][2]["shape"].is_null());
        assert_eq!(json["assignments"][0]["modes"][2], "disc (0, 1)");
        // 8 beside 10 at one line of three, with a deviation of 0.1.
        let response = &json["responses"][0];
        let apart = 1.25f64.ln() / 3f64.sqrt();
        assert!((response["left_out_deviations"].as_f64().unwrap() - 10.0 * apart).abs() < 1e-12);
        assert!((response["left_out_db"].as_f64().unwrap() - 8.685889638 * apart).abs() < 1e-8);
        let dir = tempfile::tempdir().unwrap();
        write_files(dir.path(), &results).unwrap();
        let table = std::fs::read_to_string(dir.path().join("calibration.csv")).unwrap();
        assert!(table.lines().count() == 4 && table.contains("disc,\"disc (2, 0)\""), "{table}");
        assert!(dir.path().join("calibrated.toml").is_file());
        let lines = std::fs::read_to_string(dir.path().join("calibration_responses.csv")).unwrap();
        assert!(lines.lines().nth(2).unwrap().contains(",10,5,9,8,"), "{lines}");
        let mut file = ResultsFile::create(dir.path()).unwrap();
        file.write_calibration(&sample()).unwrap();
    }
}
