//! `[calibrate]`: the numbers of a case that make its modes and responses those that were measured.
//!
//! [`measurements`](facts::measurements) says what was measured, a [`Coordinate`] turns a number of the case into an unknown,
//! [`CaseModel`] computes frequencies, shapes and responses with their slopes, and [`crate::calibration`] does the rest.

mod coordinate;
mod facts;
mod follow;
mod model;
mod neighbours;
mod real;
#[cfg(test)]
mod response_tests;
mod responses;
#[cfg(test)]
mod shape_tests;
mod shapes;
#[cfg(test)]
mod tests;
mod unstable;

pub use self::coordinate::Coordinate;
use self::facts::{Fact, MeasuredModeSet, Measurements};
use self::model::{CaseModel, scalars};
use self::responses::{MeasuredFrfData, Response};
use super::prepared::Prepared;
use crate::calibration::{self, Calibration, CalibrationOptions, CalibrationProblem, Computed, Curve, Datum};
use crate::case::{CalibrateAnalysis, Case};
use crate::error::{Error, Fault, Faults, Result};
use crate::progress::Observer;
use crate::results::{
    CalibratedDatum, CalibratedNumber, CalibratedResponse, CalibratedShape, CalibrationResult,
};

/// A calibration whose faults have been reported.
pub struct Calibrate<'a> {
    prepared: &'a Prepared<'a>,
    wanted: &'a CalibrateAnalysis,
    coordinates: Vec<Coordinate<'a>>,
    measured: Measurements,
}

impl<'a> Calibrate<'a> {
    /// The calibration that the case asks for.
    ///
    /// # Errors
    /// Values outside their bounds, scalars that share a number and differ, scalars that no mode has a derivative by.
    pub fn new(prepared: &'a Prepared<'a>, wanted: &'a CalibrateAnalysis) -> Result<Self> {
        let mut faults = Faults::new();
        let mut coordinates = Vec::new();
        for (name, parameter) in &wanted.parameter {
            let place = |key: &str| format!("`calibrate.parameter.{name}.{key}`");
            let coordinate = Coordinate::new(parameter);
            faults.take(parameter.start(prepared.case, place));
            if let Err(error) = scalars(prepared.case, &coordinate) {
                let expected = "a scalar that modes have a derivative by";
                let found = match &error {
                    Error::Analysis { found, .. } => found.clone(),
                    other => other.to_string(),
                };
                faults.push(Fault::new(place("path"), found, expected));
            }
            coordinates.push(coordinate);
        }
        let measured = faults.take(facts::measurements(prepared)).unwrap_or_default();
        faults.into_result(Calibrate { prepared, wanted, coordinates, measured })
    }

    /// Calibrates.
    ///
    /// # Errors
    /// A model that cannot be computed, or measured frequencies that nothing comes near.
    pub fn run(&self, observer: &dyn Observer) -> Result<CalibrationResult> {
        let case = self.prepared.case;
        let model = CaseModel::new(self.prepared, &self.coordinates, &self.measured)?;
        let problem = self.problem(&model);
        let options = CalibrationOptions {
            reach: self.wanted.mode_reach,
            leave_one_out: self.wanted.leave_one_out,
            chance_draws: self.wanted.chance_draws,
            trials: self.wanted.trials,
        };
        let found = calibration::calibrate(&model, &problem, model.start(), &options, observer)?;
        let best = found.best();
        let values = model.values(&best.fit.x);
        let numbers = self.numbers(&problem, &found, &values)?;
        let names = model.level_names();
        let growth = model.growth(&best.fit.x)?;
        let datum = |(i, datum): (usize, &Datum)| {
            let k = best.assignment[i];
            let hz = |there: &Computed| there.levels[k].as_ref().map(|level| level.frequency_hz);
            CalibratedDatum {
                set: self.measured.modes[datum.set].of.name().to_string(),
                measured_hz: datum.frequency_hz,
                deviation: datum.deviation,
                level: names[k].clone(),
                before_hz: hz(&found.before),
                after_hz: hz(&best.fit.computed),
                left_out_hz: found.left_out.data.get(i).and_then(|left| left.predicted_hz),
                growth: growth[k],
                shape: datum.shape.as_ref().map(|shape| {
                    let mac = |there: &Computed| {
                        there.levels[k].as_ref()?.span.as_ref().map(|span| span.mac(shape))
                    };
                    CalibratedShape {
                        components: shape.len(),
                        before: mac(&found.before),
                        after: mac(&best.fit.computed),
                        left_out: found.left_out.data.get(i).and_then(|left| left.mac),
                    }
                }),
            }
        };
        Ok(CalibrationResult {
            data: problem.data.iter().enumerate().map(datum).collect(),
            responses: self.compared(&problem.curves, &found),
            levels: names,
            level_sets: problem
                .level_sets
                .iter()
                .map(|k| self.measured.modes[*k].of.name().to_string())
                .collect(),
            calibrated_case: calibrated_case(case, &values)?,
            numbers,
            calibration: found,
        })
    }
}

impl Calibrate<'_> {
    /// Unknowns and what was measured.
    fn problem(&self, model: &CaseModel) -> CalibrationProblem {
        let data = |(set, facts): (usize, &MeasuredModeSet)| {
            let datum = move |fact: &Fact| Datum {
                set,
                frequency_hz: fact.frequency_hz,
                deviation: fact.deviation,
                shape: fact.shape.clone(),
            };
            facts.modes.iter().map(datum).collect::<Vec<_>>()
        };
        CalibrationProblem {
            unknowns: self.coordinates.iter().map(Coordinate::unknown).collect(),
            data: self.measured.modes.iter().enumerate().flat_map(data).collect(),
            level_sets: model.level_sets(),
            level_modes: model.level_modes(),
            curves: self.curves(),
        }
    }

    /// The numbers that were found, one an unknown.
    fn numbers(
        &self,
        problem: &CalibrationProblem,
        found: &Calibration,
        values: &[f64],
    ) -> Result<Vec<CalibratedNumber>> {
        let best = found.best();
        let known = &found.knowledge;
        let both = |j: usize, ends: [f64; 2]| ends.map(|x| self.coordinates[j].value(x));
        let number = |(j, (name, c)): (usize, (&String, &Coordinate))| -> Result<CalibratedNumber> {
            let parameter = c.parameter;
            let scalar = self.prepared.case.parameter(&parameter.path[0])?;
            Ok(CalibratedNumber {
                name: name.clone(),
                paths: parameter.path.clone(),
                unit: scalar.unit.to_string(),
                between: parameter.between,
                expected: parameter.expectation(),
                deviation: parameter.deviation,
                log: parameter.log,
                before: scalar.value,
                after: values[j],
                deviation_after: known.deviations[j] * c.rate(values[j]),
                interval: both(j, known.intervals[j]),
                scaled_interval: known.scaled_intervals.as_ref().map(|all| both(j, all[j])),
                at_bound: problem.unknowns[j].bounds.contains(&best.fit.x[j]),
            })
        };
        self.wanted.parameter.keys().zip(&self.coordinates).enumerate().map(number).collect()
    }

    fn responses(&self) -> impl Iterator<Item = &Response> {
        self.measured.responses.iter().flat_map(|measured| &measured.responses)
    }

    /// The measured responses, whose lines the model gives in their order.
    fn curves(&self) -> Vec<Curve> {
        let mut first = 0;
        let curve = |own: &Response| {
            let curve = Curve { first, values: own.levels().collect(), deviation: own.deviation };
            first = curve.lines().end;
            curve
        };
        self.responses().map(curve).collect()
    }

    /// The measured responses beside the computed ones.
    fn compared(&self, curves: &[Curve], found: &Calibration) -> Vec<CalibratedResponse> {
        let sets =
            self.measured.responses.iter().flat_map(|set| set.responses.iter().map(move |own| (set, own)));
        let compared = |(i, ((set, own), curve)): (usize, ((&MeasuredFrfData, &Response), &Curve))| {
            let sizes = |there: &Computed| -> Vec<f64> {
                there.lines[curve.lines()].iter().map(|line| line.value.exp()).collect()
            };
            let left_out = found.left_out.curves.get(i).and_then(|left| left.predicted.as_ref());
            CalibratedResponse {
                set: set.name.clone(),
                name: own.name.clone(),
                place: own.place.clone(),
                quantity: own.quantity,
                deviation: own.deviation,
                frequencies_hz: own.frequencies_hz.clone(),
                measured: curve.values.iter().map(|value| value.exp()).collect(),
                before: sizes(&found.before),
                after: sizes(&found.best().fit.computed),
                left_out: left_out.map(|values| values.iter().map(|value| value.exp()).collect()),
            }
        };
        sets.zip(curves).enumerate().map(compared).collect()
    }
}

/// The case with the values that were found, as TOML that loads from any folder.
fn calibrated_case(case: &Case, values: &[f64]) -> Result<String> {
    Ok(case.with_calibrated(values)?.with_absolute_paths().to_toml())
}
