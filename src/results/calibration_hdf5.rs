//! A calibration in `results.h5`.

use super::hdf5::{Datasets, attribute, text_attribute};
use super::{CalibratedDatum, CalibratedNumber, CalibratedResponse, CalibrationResult, ResultsFile};
use crate::error::Result;
use ndarray::Array2;

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
                let left_out = |r: &CalibratedResponse| {
                    r.left_out.clone().unwrap_or(vec![f64::NAN; r.frequencies_hz.len()])
                };
                let left_out: Vec<f64> = result.responses.iter().flat_map(left_out).collect();
                group.list("response_left_out", &left_out, "SI", "predicted from all other data, or NaN")?;
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
