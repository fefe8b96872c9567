//! Numbers of a case that were found from measured modes and responses, as plain data, and their files.

use super::write_result;
use crate::calibration::{Calibration, Chance, Ranked, Trials};
use crate::dataset::{Column, Describe, Dimension, Group, Table, Variable, column};
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
    /// Name of each computed level.
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
    /// Expected value.
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
    /// Measured frequency \[Hz\].
    pub measured_hz: f64,
    /// Its relative standard deviation.
    pub deviation: f64,
    /// Name of the mode.
    pub level: String,
    /// Computed with the values of the case \[Hz\].
    pub before_hz: Option<f64>,
    /// Computed with the values that were found \[Hz\].
    pub after_hz: Option<f64>,
    /// Computed with the values that the other data lead to \[Hz\]; none where they do not determine it.
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
    /// Name in the test.
    pub name: String,
    /// Name of its place in the case.
    pub place: String,
    /// Receptance, mobility or accelerance.
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
    /// Computed with the values that all other data lead to; none where they do not determine it.
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
    /// With the values that the other data lead to; none where they do not determine it.
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

fn parameter_columns() -> Vec<Column<CalibratedNumber>> {
    type Number = CalibratedNumber;
    vec![
        column("unit", "text", "its SI unit", |n: &Number| n.unit.clone()),
        column("between", "unit", "its bounds", |n: &Number| n.between).along(Dimension::limits()),
        column("expected", "unit", "what was expected", |n: &Number| n.expected),
        column(
            "prior_deviation",
            "unit",
            "standard deviation of that; its share of the value where `log`",
            |n: &Number| n.deviation,
        ),
        column("log", "1", "whether equal ratios are equal steps", |n: &Number| n.log),
        column("before", "unit", "the value of the case", |n: &Number| n.before),
        column("after", "unit", "the value that was found", |n: &Number| n.after),
        column("deviation", "unit", "its standard deviation", |n: &Number| n.deviation_after),
        column("interval_95", "unit", "95 %, the stated deviations trusted", |n: &Number| n.interval)
            .along(Dimension::limits()),
        column(
            "scaled_interval_95",
            "unit",
            "95 %, the deviations scaled by what the fit leaves",
            |n: &Number| n.scaled_interval,
        )
        .along(Dimension::limits()),
        column("at_bound", "1", "whether it ended at a bound", |n: &Number| n.at_bound),
    ]
}

impl CalibratedNumber {
    fn group(&self) -> Group<'_> {
        let group = Group::of(&*self.name, "a number that was found", &parameter_columns(), self);
        let paths = Dimension::numbered("path", self.paths.len());
        group.with(Variable::texts("paths", "the scalars that have this value", paths, self.paths.clone()))
    }
}

/// A measured frequency, and ∂ ln f by each number.
type DatumRow<'a> = (&'a CalibratedDatum, Vec<f64>);

fn data_columns<'a>(numbers: usize) -> Vec<Column<DatumRow<'a>>> {
    vec![
        column("set", "text", "name of real modes, or `squeal`", |(d, _): &DatumRow| d.set.clone()),
        column("mode", "text", "the mode it was taken for", |(d, _): &DatumRow| d.level.clone()),
        column("measured_hz", "Hz", "measured frequency", |(d, _): &DatumRow| d.measured_hz),
        column("relative_deviation", "1", "its relative standard deviation", |(d, _): &DatumRow| d.deviation),
        column("before_hz", "Hz", "computed with the values of the case", |(d, _): &DatumRow| d.before_hz),
        column("after_hz", "Hz", "computed with the values that were found", |(d, _): &DatumRow| d.after_hz),
        column("before_percent", "%", "100 (before − measured)/measured", |(d, _): &DatumRow| {
            d.error_percent(d.before_hz)
        }),
        column("error_percent", "%", "100 (after − measured)/measured", |(d, _): &DatumRow| {
            d.error_percent(d.after_hz)
        }),
        column("left_out_hz", "Hz", "predicted from all other data", |(d, _): &DatumRow| d.left_out_hz),
        column("left_out_percent", "%", "100 (predicted − measured)/measured", |(d, _): &DatumRow| {
            d.error_percent(d.left_out_hz)
        }),
        column("growth_rate", "1/s", "σ with the values that were found", |(d, _): &DatumRow| d.growth),
        column("shape_components", "1", "measured components of its shape", |(d, _): &DatumRow| {
            d.shape.map(|shape| shape.components)
        }),
        column("mac_before", "1", "MAC of its shape with the values of the case", |(d, _): &DatumRow| {
            d.mac(|shape| shape.before)
        }),
        column("mac_after", "1", "MAC of its shape with the values that were found", |(d, _): &DatumRow| {
            d.mac(|shape| shape.after)
        }),
        column(
            "mac_left_out",
            "1",
            "MAC of its shape, predicted from all other data",
            |(d, _): &DatumRow| d.mac(|shape| shape.left_out),
        ),
        column(
            "sensitivity",
            "1",
            "∂ ln f by each number, in units of its deviation or half the width of its bounds",
            |(_, slopes): &DatumRow| slopes.clone(),
        )
        .along(Dimension::numbered("parameter", numbers)),
    ]
}

fn response_columns() -> Vec<Column<CalibratedResponse>> {
    type Response = CalibratedResponse;
    let band = |r: &Response| {
        [r.frequencies_hz.first(), r.frequencies_hz.last()].map(|hz| hz.copied().unwrap_or(f64::NAN))
    };
    vec![
        column("set", "text", "name of the measured set", |r: &Response| r.set.clone()),
        column("name", "text", "what the test calls it", |r: &Response| r.name.clone()),
        column("place", "text", "what the case calls its place", |r: &Response| r.place.clone()),
        column("lines", "1", "lines that were compared", |r: &Response| r.frequencies_hz.len()),
        column("band_hz", "Hz", "the first and the last of them", band).along(Dimension::limits()),
        column("deviation", "1", "standard deviation of ln |h|", |r: &Response| r.deviation),
        column("before_db", "dB", "r.m.s. of 20 log₁₀(before/measured)", |r: &Response| {
            r.apart_db(&r.before)
        }),
        column("after_db", "dB", "r.m.s. of 20 log₁₀(after/measured)", |r: &Response| {
            r.apart_db(&r.after)
        }),
        column("left_out_db", "dB", "r.m.s. of 20 log₁₀(predicted/measured)", |r: &Response| {
            r.left_out.as_ref().map(|sizes| r.apart_db(sizes))
        }),
        column(
            "after_deviations",
            "1",
            "r.m.s. of ln(after/measured) over its standard deviation",
            |r: &Response| r.apart(&r.after),
        ),
        column(
            "left_out_deviations",
            "1",
            "r.m.s. of ln(predicted/measured) over its standard deviation",
            |r: &Response| r.left_out.as_ref().map(|sizes| r.apart(sizes)),
        ),
    ]
}

/// A line of a response: the number of the response, the response, and the line.
type CalibrationLineRow<'a> = (usize, &'a CalibratedResponse, usize);

fn line_columns<'a>() -> Vec<Column<CalibrationLineRow<'a>>> {
    vec![
        column("response", "1", "number of the response, from 1", |(number, ..): &CalibrationLineRow| {
            *number
        }),
        column("set", "text", "name of the measured set", |(_, r, _): &CalibrationLineRow| r.set.clone()),
        column("name", "text", "what the test calls it", |(_, r, _): &CalibrationLineRow| r.name.clone()),
        column("place", "text", "what the case calls its place", |(_, r, _): &CalibrationLineRow| {
            r.place.clone()
        }),
        column("frequency_hz", "Hz", "frequency", |(_, r, k): &CalibrationLineRow| r.frequencies_hz[*k]),
        column(
            "measured",
            "unit",
            "√(|h|² + n²) with the floor n, measured",
            |(_, r, k): &CalibrationLineRow| r.measured[*k],
        ),
        column("before", "unit", "with the values of the case", |(_, r, k): &CalibrationLineRow| {
            r.before[*k]
        }),
        column("after", "unit", "with the values that were found", |(_, r, k): &CalibrationLineRow| {
            r.after[*k]
        }),
        column("left_out", "unit", "predicted from all other data", |(_, r, k): &CalibrationLineRow| {
            r.left_out.as_ref().map(|sizes| sizes[*k])
        }),
        column("unit", "text", "SI unit of the quantity", |(_, r, _): &CalibrationLineRow| r.quantity.unit()),
    ]
}

/// An assignment with the names of all levels.
type Assigned<'a> = (&'a Ranked, &'a [String]);

fn assignment_columns<'a>(data: usize) -> Vec<Column<Assigned<'a>>> {
    vec![
        column("modes", "text", "the mode that each datum was taken for", |(r, levels): &Assigned| {
            r.assignment.iter().map(|k| levels[*k].clone()).collect::<Vec<String>>()
        })
        .along(Dimension::numbered("datum", data)),
        column("chi2", "1", "χ² of the fit", |(r, _): &Assigned| r.fit.chi2),
        column("linear_chi2", "1", "χ² by the linearised model", |(r, _): &Assigned| r.linear_chi2),
        column("largest_error_percent", "%", "largest |error| of a frequency", |(r, _): &Assigned| {
            100.0 * r.largest_error
        }),
        column("least_mac", "1", "least MAC of a shape", |(r, _): &Assigned| r.least_mac),
        column("weight", "1", "exp(−Δχ²/2) beside the best", |(r, _): &Assigned| r.weight),
        column("converged", "1", "whether the fit has converged", |(r, _): &Assigned| r.fit.converged),
        column("iterations", "1", "iterations of the fit", |(r, _): &Assigned| r.fit.iterations),
        column("evaluations", "1", "evaluations of the model", |(r, _): &Assigned| r.fit.evaluations),
        column("gradient", "1", "size of the projected gradient at the end", |(r, _): &Assigned| {
            r.fit.gradient
        }),
    ]
}

impl Describe for CalibrationResult {
    fn describe(&self) -> Group<'_> {
        let best = self.calibration.best();
        let slopes = |k: &usize| match &best.fit.computed.levels[*k] {
            Some(level) => level.slope.clone(),
            None => vec![f64::NAN; self.numbers.len()],
        };
        let data: Vec<DatumRow> = self.data.iter().zip(best.assignment.iter().map(slopes)).collect();
        let assigned: Vec<Assigned> =
            self.calibration.ranked.iter().map(|ranked| (ranked, &*self.levels)).collect();
        let mut group =
            Group::new("calibration", "numbers of the case found from measured modes and responses")
                .list("parameters", self.numbers.iter().map(CalibratedNumber::group).collect())
                .table(
                    Table::of("data", "datum", &data_columns(self.numbers.len()), &data).file("calibration"),
                )
                .table(Table::of("responses", "response", &response_columns(), &self.responses));
        if !self.responses.is_empty() {
            let each = self.responses.iter().enumerate();
            let lines: Vec<CalibrationLineRow> =
                each.flat_map(|(k, r)| (0..r.frequencies_hz.len()).map(move |i| (k + 1, r, i))).collect();
            let lines = Table::of("response_lines", "line", &line_columns(), &lines);
            group = group.table(lines.file("calibration_responses").long());
        }
        self.worth(group.table(Table::of(
            "assignments",
            "assignment",
            &assignment_columns(self.data.len()),
            &assigned,
        )))
        .with(Variable::text(
            "calibrated_case",
            "the case with the values that were found, as TOML",
            &self.calibrated_case,
        ))
    }
}

impl CalibrationResult {
    /// `group` with the figures of the whole.
    fn worth<'a>(&self, group: Group<'a>) -> Group<'a> {
        let found = &self.calibration;
        let (fit, known) = (&found.best().fit, &found.knowledge);
        let group = group
            .value(
                "largest_error_percent",
                "%",
                "largest |error| of a frequency",
                self.largest_percent(|d| d.after_hz),
            )
            .value("least_mac", "1", "least MAC of a shape", self.least_mac(|s| s.after))
            .value(
                "least_left_out_mac",
                "1",
                "the same, predicted from all other data",
                self.least_mac(|s| s.left_out),
            )
            .value(
                "largest_left_out_percent",
                "%",
                "largest |error| of a frequency, predicted from all other data",
                self.largest_percent(|d| d.left_out_hz),
            )
            .value("chi2", "1", "χ² of the best fit", fit.chi2)
            .value("degrees_of_freedom", "1", "facts beyond the numbers", known.freedom)
            .value("reduced_chi2", "1", "χ² over the degrees of freedom", known.reduced_chi2)
            .value("chi2_probability", "1", "probability of a larger χ²", known.chi2_probability)
            .value("converged", "1", "whether the best fit has converged", fit.converged)
            .value("plausible_assignments", "1", "assignments that are plausible", found.plausible)
            .value("tried_assignments", "1", "assignments that were fitted", found.tried)
            .value("all_assignments_counted", "1", "whether all were counted", found.all_counted)
            .value("all_assignments_searched", "1", "whether all were searched", found.all_searched)
            .value("levels", "1", "computed levels", self.levels.len());
        let parameter = || Dimension::numbered("parameter", self.numbers.len());
        let direction = || Dimension::numbered("direction", known.singular_values.len());
        let square = |rows: &[Vec<f64>]| rows.concat();
        group
            .with(Variable::reals(
                "singular_values",
                "1",
                "singular values of the data's sensitivities to the numbers",
                vec![direction()],
                known.singular_values.clone(),
            ))
            .with(Variable::reals(
                "directions",
                "1",
                "the combination of numbers that belongs to each",
                vec![direction(), parameter()],
                square(&known.directions),
            ))
            .value("condition", "1", "largest over least singular value", known.condition())
            .value(
                "determined_combinations",
                "1",
                "combinations of numbers that the data determine",
                known.determined(),
            )
            .with(Variable::reals(
                "correlations",
                "1",
                "correlation of the numbers",
                vec![parameter(), Dimension::numbered("other_parameter", self.numbers.len())],
                square(&known.correlations),
            ))
            .optional("chance", found.chance.as_ref().map(chance))
            .optional("trials", found.trials.as_ref().map(trials))
    }
}

/// How often frequencies match as well by chance.
fn chance(chance: &Chance) -> Group<'static> {
    Group::new("chance", "how often drawn frequencies match as well")
        .value("draws", "1", "draws", chance.draws)
        .value("as_good_by_largest_error", "1", "as good by the largest error", chance.by_error)
        .value("as_good_by_chi2", "1", "as good by χ²", chance.by_chi2)
        .value(
            "probability_by_largest_error",
            "1",
            "probability of that by the largest error",
            chance.probability(chance.by_error),
        )
        .value("probability_by_chi2", "1", "probability of that by χ²", chance.probability(chance.by_chi2))
}

/// Whether the intervals hold the truth of data that are made up.
fn trials(trials: &Trials) -> Group<'static> {
    let share =
        |covered: &[usize]| -> Vec<f64> { covered.iter().map(|c| *c as f64 / trials.count as f64).collect() };
    let coverage = |key: &'static str, description: &'static str, shares: Vec<f64>| {
        Variable::reals(key, "1", description, vec![Dimension::numbered("parameter", shares.len())], shares)
    };
    let covered = share(&trials.covered);
    let least = covered.iter().fold(1.0, |least: f64, share| least.min(*share));
    let group = Group::new("trials", "calibrations to data made up from known numbers")
        .value("count", "1", "trials", trials.count)
        .value("converged", "1", "trials that have converged", trials.converged)
        .value(
            "model_error",
            "1",
            "largest error of a residual by the linearised model, in standard deviations",
            trials.model_error,
        )
        .with(coverage("coverage", "share of trials whose interval holds the number", covered))
        .value("least_coverage", "1", "the least of these shares", least);
    match &trials.scaled_covered {
        Some(covered) => {
            group.with(coverage("scaled_coverage", "the same of the scaled intervals", share(covered)))
        }
        None => group.optional("scaled_coverage", None),
    }
}

/// Writes `calibrated.toml` into the folder `dir`.
pub(super) fn write_calibrated(dir: &Path, result: &CalibrationResult) -> Result<()> {
    write_result(dir, "calibrated.toml", result.calibrated_case.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::super::{RunResults, summary_json, write_files};
    use super::{CalibratedResponse, CalibrationResult};
    use crate::bounds::{Origin::*, within};
    use crate::calibration::Chance;
    use crate::job::sample;
    use serde_json::json;

    #[test]
    fn the_files_say_what_was_found() {
        let mut record = sample::rig().take::<CalibrationResult>().unwrap();
        // 8 beside 10 at one line of three, with a deviation of 0.1.
        record.responses[0] = CalibratedResponse {
            deviation: 0.1,
            frequencies_hz: vec![300.0, 330.0, 400.0],
            measured: vec![1.0, 10.0, 2.0],
            before: vec![2.0, 5.0, 2.0],
            after: vec![1.0, 9.0, 2.0],
            left_out: Some(vec![1.0, 8.0, 2.0]),
            ..record.responses[0].clone()
        };
        record.calibration.chance = Some(Chance { draws: 999, by_error: 49, by_chi2: 59 });
        record.data[1].shape = None;
        let mut results = RunResults::default();
        results.records.push(record.clone());
        let json = &summary_json(&results)["calibration"];
        let [first, second] = &record.data[..] else { panic!("two frequencies") };
        let error = |hz: Option<f64>, measured: f64| 100.0 * (hz.unwrap() / measured - 1.0);
        let largest = [first, second].map(|d| error(d.after_hz, d.measured_hz).abs());
        assert!(within(
            (json["largest_error_percent"].as_f64().unwrap() - largest[0].max(largest[1])).abs(),
            1e-9,
            RoundOff
        ));
        let left_out = error(first.left_out_hz, first.measured_hz);
        assert!(within(
            (json["data"][0]["left_out_percent"].as_f64().unwrap() - left_out).abs(),
            1e-9,
            RoundOff
        ));
        assert!(within(
            (json["chance"]["probability_by_largest_error"].as_f64().unwrap() - 0.05).abs(),
            1e-12,
            RoundOff
        ));
        let trials = record.calibration.trials.as_ref().unwrap();
        let least = *trials.covered.iter().min().unwrap() as f64 / trials.count as f64;
        assert_eq!(json["trials"]["least_coverage"], least);
        assert_eq!(json["data"][0]["mac_after"], json!(first.shape.unwrap().after));
        assert_eq!(json["least_mac"], json!(record.least_mac(|shape| shape.after)));
        assert_eq!(json["data"][0]["shape_components"], 32);
        assert!(["shape_components", "mac_after"].iter().all(|key| json["data"][1][key].is_null()));
        assert_eq!(json["assignments"][0]["modes"][1], "disc (4, 0)");
        let response = &json["responses"][0];
        let apart = 1.25f64.ln() / 3f64.sqrt();
        assert!(within(
            (response["left_out_deviations"].as_f64().unwrap() - 10.0 * apart).abs(),
            1e-12,
            RoundOff
        ));
        assert!(within(
            (response["left_out_db"].as_f64().unwrap() - 8.685889638 * apart).abs(),
            1e-8,
            Reference
        ));
        let dir = tempfile::tempdir().unwrap();
        write_files(dir.path(), &results).unwrap();
        let table = std::fs::read_to_string(dir.path().join("calibration.csv")).unwrap();
        assert!(table.lines().count() == 3 && table.contains("1,disc,\"disc (2, 0)\",330,"), "{table}");
        assert!(dir.path().join("calibrated.toml").is_file());
        let lines = std::fs::read_to_string(dir.path().join("calibration_responses.csv")).unwrap();
        assert!(lines.lines().nth(2).unwrap().ends_with(",330,10,5,9,8,m/(N s^2)"), "{lines}");
    }
}
