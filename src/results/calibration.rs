//! Numbers of a case that were found from measured frequencies and shapes, as plain data, and their files.

use super::csv::{Table, number};
use super::hdf5::{Datasets, attribute, text_attribute};
use super::{ResultsFile, write_atomically};
use crate::calibration::{Calibration, Ranked};
use crate::error::Result;
use crate::measured::Quantity;
use ndarray::Array2;
use serde_json::{Value, json};
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
}

impl CalibratedResponse {
    /// Root mean square of 20 log₁₀ (computed/measured) \[dB\].
    pub fn apart_db(&self, computed: &[f64]) -> f64 {
        let squares = computed.iter().zip(&self.measured).map(|(a, b)| (20.0 * (a / b).log10()).powi(2));
        (squares.sum::<f64>() / computed.len().max(1) as f64).sqrt()
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
    /// The largest |error| of `pick` among the data \[%\]; none where one of them has none.
    pub fn largest_percent(&self, pick: impl Fn(&CalibratedDatum) -> Option<f64>) -> Option<f64> {
        let errors = self.data.iter().map(|datum| Some(datum.error_percent(pick(datum))?.abs()));
        errors.collect::<Option<Vec<f64>>>().map(|all| all.into_iter().fold(0.0, f64::max))
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
    write_atomically(dir, "calibrated.toml", result.calibrated_case.as_bytes())?;
    if !result.responses.is_empty() {
        write_atomically(dir, "calibration_responses.csv", responses(result).as_bytes())?;
    }
    write_atomically(dir, "calibration.csv", table(result).as_bytes())
}

fn responses(result: &CalibrationResult) -> String {
    let mut table =
        Table::new(&["set", "response", "place", "frequency [Hz]", "measured", "before", "after", "unit"]);
    for r in &result.responses {
        for (k, hz) in r.frequencies_hz.iter().enumerate() {
            let words = [&r.set, &r.name, &r.place].map(String::clone);
            let numbers = [*hz, r.measured[k], r.before[k], r.after[k]].map(number);
            let unit = [r.quantity.unit().to_string()];
            table.row(&words.into_iter().chain(numbers).chain(unit).collect::<Vec<_>>());
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

impl ResultsFile {
    /// Writes a calibration to `/calibration`.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn write_calibration(&mut self, result: &CalibrationResult) -> Result<()> {
        self.stage(|root| {
            let group = Datasets(root.create_group("calibration")?);
            let (numbers, data) = (&result.numbers, &result.data);
            let of = |pick: fn(&CalibratedNumber) -> f64| numbers.iter().map(pick).collect::<Vec<f64>>();
            let names: Vec<&str> = numbers.iter().map(|n| n.name.as_str()).collect();
            let best = result.calibration.best();
            text_attribute(&group.0, "numbers", &names.join(", "))?;
            text_attribute(&group.0, "calibrated_case", &result.calibrated_case)?;
            attribute(&group.0, "chi2", &best.fit.chi2)?;
            group.list("before", &of(|n| n.before), "SI", "values of the case, one a number")?;
            group.list("after", &of(|n| n.after), "SI", "values that were found")?;
            group.list("lower_95", &of(|n| n.interval[0]), "SI", "lower end of the 95 % interval")?;
            group.list("upper_95", &of(|n| n.interval[1]), "SI", "upper end of the 95 % interval")?;
            let of = |pick: fn(&CalibratedDatum) -> Option<f64>| -> Vec<f64> {
                data.iter().map(|d| pick(d).unwrap_or(f64::NAN)).collect()
            };
            group.list("measured_hz", &of(|d| Some(d.measured_hz)), "Hz", "measured frequencies")?;
            group.list("before_hz", &of(|d| d.before_hz), "Hz", "computed with the values of the case")?;
            group.list("after_hz", &of(|d| d.after_hz), "Hz", "computed with the values that were found")?;
            group.list(
                "left_out_hz",
                &of(|d| d.left_out_hz),
                "Hz",
                "predicted from the other frequencies",
            )?;
            if result.shapes().next().is_some() {
                let words = "MAC of each measured shape with its level; NaN where no shape was measured";
                group.list("mac_before", &of(|d| d.mac(|s| s.before)), "1", words)?;
                group.list("mac_after", &of(|d| d.mac(|s| s.after)), "1", words)?;
                group.list("mac_left_out", &of(|d| d.mac(|s| s.left_out)), "1", words)?;
            }
            if !result.responses.is_empty() {
                let of = |pick: fn(&CalibratedResponse) -> &[f64]| -> Vec<f64> {
                    result.responses.iter().flat_map(|r| pick(r).iter().copied()).collect()
                };
                let each = result.responses.iter().enumerate();
                let which: Vec<f64> =
                    each.flat_map(|(k, r)| vec![k as f64; r.frequencies_hz.len()]).collect();
                let names: Vec<&str> = result.responses.iter().map(|r| r.name.as_str()).collect();
                text_attribute(&group.0, "responses", &names.join("; "))?;
                group.list("response", &which, "1", "which frequency response each line is of")?;
                group.list("response_hz", &of(|r| &r.frequencies_hz), "Hz", "lines of the responses")?;
                let size = "sqrt(|h|^2 + n^2) with the floor n";
                group.list("response_measured", &of(|r| &r.measured), "SI", size)?;
                group.list("response_before", &of(|r| &r.before), "SI", "with the values of the case")?;
                group.list("response_after", &of(|r| &r.after), "SI", "with the values that were found")?;
            }
            let slope = |(i, j): (usize, usize)| {
                best.fit.computed.levels[best.assignment[i]].as_ref().map_or(f64::NAN, |level| level.slope[j])
            };
            let slopes = Array2::from_shape_fn((data.len(), numbers.len()), slope);
            let story = "d ln f by each number, in units of its deviation or half the width of its bounds";
            group.write("sensitivity", slopes.view(), "1", story)?;
            let correlations = &result.calibration.knowledge.correlations;
            let square = Array2::from_shape_fn((numbers.len(), numbers.len()), |(i, j)| correlations[i][j]);
            group.write("correlation", square.view(), "1", "correlation of the numbers")
        })
    }
}

/// The part of `summary.json` on a calibration.
pub(super) fn summary(result: &CalibrationResult) -> Value {
    let found = &result.calibration;
    let known = &found.knowledge;
    let number = |n: &CalibratedNumber| {
        json!({
            "name": n.name,
            "paths": n.paths,
            "unit": n.unit,
            "between": n.between,
            "expected": n.expected,
            "prior_deviation": n.deviation,
            "log": n.log,
            "before": n.before,
            "after": n.after,
            "deviation": n.deviation_after,
            "interval_95": n.interval,
            "scaled_interval_95": n.scaled_interval,
            "at_bound": n.at_bound,
        })
    };
    let datum = |d: &CalibratedDatum| {
        json!({
            "set": d.set,
            "mode": d.level,
            "measured_hz": d.measured_hz,
            "relative_deviation": d.deviation,
            "before_hz": d.before_hz,
            "after_hz": d.after_hz,
            "before_percent": d.error_percent(d.before_hz),
            "error_percent": d.error_percent(d.after_hz),
            "left_out_hz": d.left_out_hz,
            "left_out_percent": d.error_percent(d.left_out_hz),
            "growth_rate": d.growth,
            "shape": d.shape.map(|s| json!({
                "components": s.components,
                "mac_before": s.before,
                "mac_after": s.after,
                "mac_left_out": s.left_out,
            })),
        })
    };
    let response = |r: &CalibratedResponse| {
        json!({
            "set": r.set,
            "name": r.name,
            "place": r.place,
            "lines": r.frequencies_hz.len(),
            "band_hz": [r.frequencies_hz.first(), r.frequencies_hz.last()],
            "deviation": r.deviation,
            "before_db": r.apart_db(&r.before),
            "after_db": r.apart_db(&r.after),
        })
    };
    let ranked = |r: &Ranked| {
        json!({
            "modes": r.assignment.iter().map(|k| &result.levels[*k]).collect::<Vec<_>>(),
            "chi2": r.fit.chi2,
            "linear_chi2": r.linear_chi2,
            "largest_error_percent": 100.0 * r.largest_error,
            "least_mac": r.least_likeness,
            "weight": r.weight,
            "converged": r.fit.converged,
            "iterations": r.fit.iterations,
            "evaluations": r.fit.evaluations,
            "gradient": r.fit.gradient,
        })
    };
    let chance = found.chance.map(|c| {
        json!({
            "draws": c.draws,
            "as_good_by_largest_error": c.by_error,
            "as_good_by_chi2": c.by_chi2,
            "probability_by_largest_error": c.probability(c.by_error),
            "probability_by_chi2": c.probability(c.by_chi2),
        })
    });
    let share = |covered: &Vec<usize>, of: usize| -> Vec<f64> {
        covered.iter().map(|c| *c as f64 / of as f64).collect()
    };
    let trials = found.trials.as_ref().map(|t| {
        json!({
            "count": t.count,
            "converged": t.converged,
            "model_error": t.model_error,
            "coverage": share(&t.covered, t.count),
            "least_coverage": share(&t.covered, t.count).into_iter().fold(1.0, f64::min),
            "scaled_coverage": t.scaled_covered.as_ref().map(|c| share(c, t.count)),
        })
    });
    json!({
        "parameters": result.numbers.iter().map(number).collect::<Vec<_>>(),
        "data": result.data.iter().map(datum).collect::<Vec<_>>(),
        "responses": result.responses.iter().map(response).collect::<Vec<_>>(),
        "largest_error_percent": result.largest_percent(|d| d.after_hz),
        "least_mac": result.least_mac(|s| s.after),
        "least_left_out_mac": result.least_mac(|s| s.left_out),
        "largest_left_out_percent": result.largest_percent(|d| d.left_out_hz),
        "chi2": found.best().fit.chi2,
        "degrees_of_freedom": known.freedom,
        "reduced_chi2": known.reduced_chi2,
        "chi2_probability": known.chi2_probability,
        "converged": found.best().fit.converged,
        "assignments": found.ranked.iter().map(ranked).collect::<Vec<_>>(),
        "plausible_assignments": found.plausible,
        "all_assignments_counted": found.all_counted,
        "all_assignments_searched": found.all_searched,
        "levels": result.levels.len(),
        "singular_values": known.singular_values,
        "directions": known.directions,
        "condition": known.condition(),
        "determined_combinations": known.determined(),
        "correlations": known.correlations,
        "chance": chance,
        "trials": trials,
    })
}

/// A made-up calibration: two numbers, the second at its bound and not determined, three data.
#[cfg(test)]
pub(super) fn sample() -> CalibrationResult {
    use crate::calibration::{Chance, Computed, Fit, Knowledge, LeftOut, Level, Trials};
    let level = |frequency_hz: f64| {
        Some(Level { frequency_hz, slope: vec![0.1, 0.02], split: vec![0.0; 2], span: None })
    };
    let fit = |converged: bool| Fit {
        x: vec![0.2, 1.0],
        computed: Computed { levels: [333.3, 936.0, 1705.0].map(level).to_vec(), lines: vec![] },
        chi2: 5.2,
        iterations: 4,
        evaluations: 4,
        gradient: 1e-9,
        converged,
    };
    let ranked = |weight: f64| Ranked {
        assignment: vec![0, 1, 2],
        fit: fit(weight == 1.0),
        linear_chi2: 5.3,
        largest_error: 0.01,
        least_likeness: Some(0.97),
        weight,
    };
    let number = |name: &str, unit: &str, after: f64, at_bound: bool| CalibratedNumber {
        name: name.into(),
        paths: vec!["mesh.annulus.hub_radius".into()],
        unit: unit.into(),
        between: [0.015, 0.025],
        expected: 0.02,
        deviation: (!at_bound).then_some(0.002),
        log: at_bound,
        before: 0.02,
        after,
        deviation_after: 2e-4,
        interval: [after - 4e-4, (after + 4e-4).min(0.025)],
        scaled_interval: Some([after - 2e-3, (after + 2e-3).min(0.025)]),
        at_bound,
    };
    let datum = |measured_hz: f64, after: f64, level: &str| CalibratedDatum {
        set: "disc".into(),
        measured_hz,
        deviation: 0.005,
        level: level.into(),
        before_hz: Some(1.05 * measured_hz),
        after_hz: Some(after),
        left_out_hz: Some(0.97 * measured_hz),
        growth: None,
        shape: (measured_hz < 1e3).then_some(CalibratedShape {
            components: 24,
            before: Some(0.9),
            after: Some(0.97),
            left_out: Some(0.96),
        }),
    };
    CalibrationResult {
        numbers: vec![number("hub", "m", 0.021, false), number("stiffness", "N/m", 0.025, true)],
        data: vec![
            datum(330.0, 333.3, "disc (2, 0)"),
            datum(936.0, 936.0, "disc (4, 0)"),
            datum(1697.0, 1705.0, "disc (0, 1)"),
        ],
        responses: vec![CalibratedResponse {
            set: "tap".into(),
            name: "1, 2+x/1+x".into(),
            place: "rim".into(),
            quantity: Quantity::Accelerance,
            deviation: 0.1,
            frequencies_hz: vec![300.0, 330.0, 400.0],
            measured: vec![1.0, 10.0, 2.0],
            before: vec![2.0, 5.0, 2.0],
            after: vec![1.0, 9.0, 2.0],
        }],
        levels: ["disc (2, 0)", "disc (4, 0)", "disc (0, 1)"].map(String::from).to_vec(),
        level_sets: vec!["disc".into(); 3],
        calibration: Calibration {
            before: Computed { levels: [340.0, 980.0, 1750.0].map(level).to_vec(), lines: vec![] },
            ranked: vec![ranked(1.0), ranked(0.03)],
            plausible: 24,
            all_counted: true,
            all_searched: true,
            knowledge: Knowledge {
                freedom: 2,
                singular_values: vec![30.0, 0.4],
                directions: vec![vec![0.98, 0.2], vec![-0.2, 0.98]],
                deviations: vec![0.04, 2.5],
                correlations: vec![vec![1.0, 0.3], vec![0.3, 1.0]],
                intervals: vec![[0.1, 0.3], [-1.0, 1.0]],
                scaled_intervals: Some(vec![[0.0, 0.4], [-1.0, 1.0]]),
                reduced_chi2: Some(2.6),
                chi2_probability: Some(0.07),
            },
            left_out: vec![
                LeftOut {
                    x: vec![0.1, 1.0],
                    predicted_hz: Some(320.0),
                    likeness: Some(0.96),
                    converged: true
                };
                3
            ],
            chance: Some(Chance { draws: 999, by_error: 49, by_chi2: 59 }),
            trials: Some(Trials {
                count: 100,
                converged: 100,
                covered: vec![95, 96],
                scaled_covered: Some(vec![94, 97]),
                model_error: 1e-3,
                scatter: vec![0.1, 1.0],
            }),
        },
        calibrated_case: "title = \"calibrated\"\n".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{RunResults, summary_json, write_files};
    use super::*;

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
        let dir = tempfile::tempdir().unwrap();
        write_files(dir.path(), &results).unwrap();
        let table = std::fs::read_to_string(dir.path().join("calibration.csv")).unwrap();
        assert!(table.lines().count() == 4 && table.contains("disc,\"disc (2, 0)\""), "{table}");
        assert!(dir.path().join("calibrated.toml").is_file());
        let mut file = ResultsFile::create(dir.path()).unwrap();
        file.write_calibration(&sample()).unwrap();
    }
}
