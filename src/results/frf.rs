//! Frequency responses, as plain data, and their files.

use super::file_name;
use crate::dataset::{Describe, Dimension, Group, Table, Values, Variable, column};
use crate::linalg::c64;
use crate::measured::Quantity;
use crate::numbers::{growth, hertz};
use crate::stability::ROUND_OFF;
use std::f64::consts::TAU;

/// A peak is paired with a measured one that differs from it by less than this part.
const NEAR: f64 = 0.05;

/// Motion at some places for a harmonic force at another.
#[derive(Debug, Clone, PartialEq)]
pub struct FrfResult {
    /// Its name.
    pub name: String,
    /// Receptance, mobility or accelerance.
    pub quantity: Quantity,
    /// State of the contacts and method of the response, in words.
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
    /// λ \[1/s\] of the unstable modes about the state of the response, ascending in frequency: where there is one, no response is reached.
    pub unstable: Vec<c64>,
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

/// A real mode, with closed contacts and without friction where they slide, and how much of it shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Resonance {
    /// f \[Hz\].
    pub frequency_hz: f64,
    /// Its name.
    pub name: String,
    /// For each place |φ(place) φ(excitation)| over the largest of that product of any mode in the band: near zero where
    /// either of them stands on a node of the mode.
    pub seen: Vec<f64>,
    /// Whether nothing damps it: the response has no bound there, and no line.
    pub undamped: bool,
}

impl FrfResult {
    /// The resonances that nothing damps.
    pub fn undamped(&self) -> impl Iterator<Item = &Resonance> {
        self.resonances.iter().filter(|resonance| resonance.undamped)
    }

    /// Frequencies and growth rates of the unstable modes, no more than `most` of them: `the mode at 101.3 Hz (σ = +5.12 1/s)`.
    pub fn unstable_words(&self, most: usize) -> String {
        let mode =
            |l: &c64| format!("{} Hz (σ = {} 1/s)", hertz(l.im / TAU, 1), growth(l.re, l.norm(), ROUND_OFF));
        let named: Vec<String> = self.unstable.iter().take(most).map(mode).collect();
        let more = match self.unstable.len().saturating_sub(most) {
            0 => String::new(),
            rest => format!(" and {rest} more"),
        };
        let modes = if self.unstable.len() == 1 { "mode" } else { "modes" };
        format!("the {modes} at {}{more}", named.join(", "))
    }

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

impl FrfResponse {
    /// The response of place number `place` of `frf`.
    fn group<'a>(&'a self, place: usize, frf: &'a FrfResult) -> Group<'a> {
        let mut seen: Vec<&Resonance> = frf.resonances.iter().collect();
        seen.sort_by(|a, b| b.seen[place].total_cmp(&a.seen[place]));
        let seen_columns = [
            column("frequency_hz", "Hz", "frequency of the real mode", |r: &&Resonance| r.frequency_hz),
            column("share", "1", "|φ(place) φ(excitation)| over that of the mode with most in the band", {
                move |r: &&Resonance| r.seen[place]
            }),
        ];
        let beside: Vec<(f64, Option<f64>)> =
            frf.measured.iter().map(|hz| (*hz, frf.peak(place, *hz))).collect();
        let measured_columns = [
            column("frequency_hz", "Hz", "measured resonance", |(hz, _): &(f64, Option<f64>)| *hz),
            column("peak_hz", "Hz", "the highest peak near it", |(_, peak): &(f64, Option<f64>)| *peak),
        ];
        let largest = self.values.iter().map(|v| v.norm()).fold(0.0, f64::max);
        Group::new(&*self.name, "motion at a place over the force")
            .value("place", "text", "where it is", self.place.clone())
            .value("largest", frf.quantity.unit(), "largest magnitude", largest)
            .table(Table::of("measured", "resonance", &measured_columns, &beside))
            .table(Table::of("seen", "rank", &seen_columns, &seen))
    }
}

impl FrfResult {
    /// The responses over the frequency; a column a place.
    fn lines(&self) -> Table<'_> {
        let rows = Dimension::of_variable("frequency_hz", self.frequencies_hz.len());
        let along = || vec![rows.clone()];
        let hz = Variable::reals("frequency_hz", "Hz", "frequency", along(), self.frequencies_hz.clone());
        let response = |of: &FrfResponse| {
            let key = format!("{}_{}", self.quantity.word(), of.name);
            let story = format!("{} at {}; positive phase leads", self.quantity.word(), of.place);
            Variable::new(key, self.quantity.unit(), story, along(), Values::Complexes(of.values.clone()))
        };
        let columns = std::iter::once(hz).chain(self.responses.iter().map(response)).collect();
        let (key, fields, file) = ("lines".into(), Vec::new(), None);
        Table { key, rows: rows.clone(), columns, fields, file, json: false }
    }

    /// The responses.
    fn group(&self) -> Group<'_> {
        let ends = [self.frequencies_hz.first(), self.frequencies_hz.last()];
        let band = ends.map(|hz| hz.copied().unwrap_or(f64::NAN)).to_vec();
        let responses = self.responses.iter().enumerate();
        let undamped: Vec<&Resonance> = self.undamped().collect();
        let unstable_columns = [
            column("frequency_hz", "Hz", "ω/2π", |lambda: &c64| lambda.im / TAU),
            column(
                "growth_rate",
                "1/s",
                "σ of a mode that leaves the state of the response",
                |lambda: &c64| lambda.re,
            ),
        ];
        let undamped_columns = [column(
            "frequency_hz",
            "Hz",
            "frequency of a real mode that nothing damps: the response has no bound there, and no line",
            |r: &&Resonance| r.frequency_hz,
        )];
        Group::new(&*self.name, "motion at some places for a harmonic force at another")
            .value("quantity", "text", "what of the motion", self.quantity.word())
            .value("unit", "text", "its unit", self.quantity.unit())
            .value("about", "text", "what the contacts do, and how it was computed", self.about.clone())
            .value("excitation", "text", "where the force acts", self.excitation.clone())
            .value("frequencies", "1", "number of frequencies", self.frequencies_hz.len())
            .with(Variable::reals("band_hz", "Hz", "first and last of them", vec![Dimension::limits()], band))
            .value(
                "superposition_deviation",
                "1",
                "largest relative difference of superposition and direct solution",
                self.deviation,
            )
            .value("compared", "1", "frequencies at which both were compared", self.compared)
            .table(Table::of("undamped", "resonance", &undamped_columns, &undamped))
            .table(Table::of("unstable", "mode", &unstable_columns, &self.unstable))
            .list("responses", responses.map(|(place, of)| of.group(place, self)).collect())
            .table(self.lines().file(file_name("frf", &self.name)))
    }
}

impl Describe for FrfResult {
    fn describe(&self) -> Group<'_> {
        Group::new("", "").list("frf", vec![self.group()])
    }
}

#[cfg(test)]
mod tests {
    use super::FrfResult;
    use crate::bounds::{Origin::*, within};
    use crate::job::sample;

    #[test]
    fn measured_resonances_stand_beside_the_peaks_that_show() {
        let results = sample::rig();
        let frf = results.all::<FrfResult>()[0];
        let natural = |k: usize| frf.resonances[k].frequency_hz;
        let peaks = [(330.0, natural(3)), (560.0, natural(6))];
        for (measured, natural) in peaks {
            assert!(
                within((frf.peak(0, measured).unwrap() / natural - 1.0).abs(), 5e-3, Discretisation),
                "{measured}"
            );
        }
        assert!(frf.peak(0, 936.0).is_none());
        let dir = tempfile::tempdir().unwrap();
        super::super::uff::write_functions(dir.path(), &results.all::<FrfResult>()).unwrap();
        super::super::csv::write_csv(dir.path(), &results).unwrap();
        let table = std::fs::read_to_string(dir.path().join("frf_hammer.csv")).unwrap();
        assert!(
            table.lines().count() == frf.frequencies_hz.len() + 1
                && table.starts_with(
                    "frequency_hz,re_accelerance_rim [m/(N s^2)],im_accelerance_rim [m/(N s^2)],"
                )
        );
        assert!(dir.path().join("frf_hammer.uff").is_file());
    }
}
