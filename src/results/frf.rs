//! Frequency responses, as plain data, and their files.

use super::folder::FileNames;
use super::hdf5::{Datasets, attribute, text_attribute};
use super::{ResultsFile, uff, write_result};
use crate::dataset::{CsvTable as Table, number};
use crate::error::Result;
use crate::linalg::c64;
use crate::measured::Quantity;
use ndarray::Array2;
use serde_json::{Value, json};
use std::path::Path;

/// A peak stands beside a measured one that differs from it by less than this part.
const NEAR: f64 = 0.05;

/// Motion at some places for a harmonic force at another.
#[derive(Debug, Clone, PartialEq)]
pub struct FrfResult {
    /// Its name.
    pub name: String,
    /// What of the motion.
    pub quantity: Quantity,
    /// What the contacts do, and how it was computed, in words.
    pub about: String,
    /// Where the force acts, in words.
    pub excitation: String,
    /// Where and along what.
    pub force: PlaceAndDirection,
    /// f \[Hz\], ascending; closer where the response bends.
    pub frequencies_hz: Vec<f64>,
    /// Motion over force, by place.
    pub responses: Vec<FrfResponse>,
    /// The real modes in the band.
    pub resonances: Vec<Resonance>,
    /// Resonances that were measured \[Hz\].
    pub measured: Vec<f64>,
    /// At some of the frequencies, the largest difference of superposition and direct solution over the latter.
    pub deviation: f64,
    /// How many of them.
    pub compared: usize,
    /// Whether its universal file has binary numbers (dataset 58b).
    pub binary: bool,
}

/// A place and a direction.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlaceAndDirection {
    /// \[m\].
    pub position: [f64; 3],
    /// A unit vector.
    pub direction: [f64; 3],
}

/// The response of a place.
#[derive(Debug, Clone, PartialEq)]
pub struct FrfResponse {
    /// Its name.
    pub name: String,
    /// Where it is, in words.
    pub place: String,
    /// Where, and along what.
    pub at: PlaceAndDirection,
    /// One value a frequency, in the unit of the quantity; positive phase leads.
    pub values: Vec<c64>,
}

/// A real mode, and how much of it shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Resonance {
    /// f \[Hz\].
    pub frequency_hz: f64,
    /// What it is called.
    pub name: String,
    /// For each place |φ(place) φ(excitation)| over the largest of that product of any mode in the band: near zero where
    /// either of them stands on a node of the mode.
    pub seen: Vec<f64>,
}

impl FrfResult {
    /// The frequency \[Hz\] of the highest peak of a place that differs from `hz` by less than 5 %; a peak stands above
    /// both its neighbours.
    pub fn peak(&self, place: usize, hz: f64) -> Option<f64> {
        let height = |k: usize| self.responses[place].values[k].norm();
        let near = |k: &usize| (self.frequencies_hz[*k] / hz - 1.0).abs() < NEAR;
        let stands = |k: &usize| height(*k) > height(k - 1) && height(*k) > height(k + 1);
        let inner = 1..self.frequencies_hz.len().saturating_sub(1);
        let peaks = inner.filter(near).filter(stands);
        peaks.max_by(|a, b| height(*a).total_cmp(&height(*b))).map(|k| self.frequencies_hz[k])
    }
}

/// Writes `frf_<name>.csv` and `frf_<name>.uff` into the folder `dir`.
pub(super) fn write(dir: &Path, frfs: &[FrfResult]) -> Result<()> {
    let mut names = FileNames::default();
    for frf in frfs {
        let name = names.next(&frf.name);
        write_result(dir, &format!("frf_{name}.csv"), table(frf).as_bytes())?;
        write_result(dir, &format!("frf_{name}.uff"), &uff::functions(frf))?;
    }
    Ok(())
}

fn table(frf: &FrfResult) -> String {
    let (quantity, unit) = (frf.quantity.word(), frf.quantity.unit());
    let parts = |of: &FrfResponse| {
        let name = of.name.replace('_', " ");
        [format!("re {quantity} {name} [{unit}]"), format!("im {quantity} {name} [{unit}]")]
    };
    let headings: Vec<String> =
        std::iter::once("frequency [Hz]".into()).chain(frf.responses.iter().flat_map(parts)).collect();
    let mut table = Table::new(&headings.iter().map(String::as_str).collect::<Vec<_>>());
    for (k, hz) in frf.frequencies_hz.iter().enumerate() {
        let values = frf.responses.iter().flat_map(|of| [of.values[k].re, of.values[k].im]);
        table.row(&std::iter::once(*hz).chain(values).map(number).collect::<Vec<_>>());
    }
    table.text
}

impl ResultsFile {
    /// Writes a frequency response to `/frf/<name>`.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn write_frf(&mut self, frf: &FrfResult) -> Result<()> {
        self.stage(|root| {
            let all = match root.link_exists("frf") {
                true => root.group("frf")?,
                false => root.create_group("frf")?,
            };
            let group = Datasets(all.create_group(&frf.name.replace('/', "_"))?);
            text_attribute(&group.0, "quantity", frf.quantity.word())?;
            text_attribute(&group.0, "about", &frf.about)?;
            text_attribute(&group.0, "excitation", &frf.excitation)?;
            attribute(&group.0, "superposition_deviation", &frf.deviation)?;
            group.list("frequency_hz", &frf.frequencies_hz, "Hz", "where the response is known")?;
            for of in &frf.responses {
                let cells = Array2::from_shape_fn((of.values.len(), 2), |(k, part)| match part {
                    0 => of.values[k].re,
                    _ => of.values[k].im,
                });
                let story = format!("{} at {}: real and imaginary part", frf.quantity.word(), of.place);
                group.write(&of.name, cells.view(), frf.quantity.unit(), &story)?;
            }
            Ok(())
        })
    }
}

/// The part of `summary.json` on a frequency response.
pub(super) fn summary(frf: &FrfResult) -> Value {
    let response = |(place, of): (usize, &FrfResponse)| {
        let mut seen: Vec<(f64, f64)> =
            frf.resonances.iter().map(|r| (r.seen[place], r.frequency_hz)).collect();
        seen.sort_by(|a, b| b.0.total_cmp(&a.0));
        let largest = of.values.iter().map(|v| v.norm()).fold(0.0, f64::max);
        let measured =
            frf.measured.iter().map(|hz| json!({ "frequency_hz": hz, "peak_hz": frf.peak(place, *hz) }));
        json!({
            "name": of.name,
            "place": of.place,
            "largest": largest,
            "measured": measured.collect::<Vec<_>>(),
            "seen": seen.iter().map(|(seen, hz)| json!({ "frequency_hz": hz, "share": seen })).collect::<Vec<_>>(),
        })
    };
    json!({
        "name": frf.name,
        "quantity": frf.quantity.word(),
        "unit": frf.quantity.unit(),
        "about": frf.about,
        "excitation": frf.excitation,
        "frequencies": frf.frequencies_hz.len(),
        "band_hz": [frf.frequencies_hz.first(), frf.frequencies_hz.last()],
        "superposition_deviation": frf.deviation,
        "compared": frf.compared,
        "responses": frf.responses.iter().enumerate().map(response).collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::super::sample;

    #[test]
    fn measured_resonances_stand_beside_the_peaks_that_show() {
        let results = sample::rig();
        let frf = &results.frfs[0];
        assert!((frf.peak(0, 330.0).unwrap() - 338.0).abs() < 5.0 && frf.peak(0, 1697.0).unwrap() == 1745.0);
        assert!(frf.peak(0, 936.0).is_none());
        let dir = tempfile::tempdir().unwrap();
        super::write(dir.path(), &results.frfs).unwrap();
        let table = std::fs::read_to_string(dir.path().join("frf_hammer.csv")).unwrap();
        assert!(
            table.lines().count() == 401
                && table.starts_with("frequency [Hz],re accelerance rim [m/(N s^2)]")
        );
        assert!(dir.path().join("frf_hammer.uff").is_file());
    }
}
