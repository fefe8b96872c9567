//! What was measured beside what was computed: modes and frequency responses.

use super::hdf5::{Datasets, attribute, text_attribute};
use super::{FileNames, NamedModes, ResultsFile, RunResults, write_result};
use crate::dataset::{CsvTable as Table, number};
use crate::error::Result;
use crate::linalg::c64;
use crate::measured::Quantity;
use ndarray::Array2;
use serde_json::{Value, json};
use std::ops::Range;
use std::path::Path;

/// Computed modes without a measured one are told within this share beyond the measured frequencies.
const BEYOND: f64 = 0.1;

/// Measured modes and the computed modes set beside them.
#[derive(Debug, Clone, Default)]
pub struct MeasuredComparison {
    /// Its name in the case; that of the analysis, where the case gives frequencies there.
    pub name: String,
    /// Index into [`RunResults::modes`].
    pub modes: usize,
    /// Where the figures come from.
    pub source: String,
    /// One row a measured mode.
    pub rows: Vec<MeasuredRow>,
    /// Computed frequencies were multiplied by this before comparison (an assumption of the case); 1 for none.
    pub frequency_scale: f64,
    /// Computed modes that are one level; rigid-body modes are in none.
    pub levels: Vec<Range<usize>>,
    /// MAC of each measured mode with each level; empty for a mode without a shape.
    pub likeness: Vec<Vec<f64>>,
    /// How its geometry fits the mesh, where shapes are compared.
    pub placed: Option<Placed>,
}

/// A measured mode.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MeasuredRow {
    /// \[Hz\].
    pub frequency_hz: f64,
    /// Standard deviation of the frequency over the frequency.
    pub deviation: Option<f64>,
    /// ζ.
    pub damping_ratio: Option<f64>,
    /// The index of the mode that it is paired with, if any.
    pub mode: Option<usize>,
    /// MAC with the level of that mode.
    pub likeness: Option<f64>,
}

/// How the geometry of a test fits the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placed {
    /// Points with a shape.
    pub points: usize,
    /// Directions at them in all.
    pub dofs: usize,
    /// Largest distance of a point from its node \[m\].
    pub largest: f64,
    /// Mean distance \[m\].
    pub mean: f64,
}

/// The measured frequency responses of a set beside a computed one.
#[derive(Debug, Clone, Default)]
pub struct MeasuredResponses {
    /// Its name in the case.
    pub name: String,
    /// Where the figures come from.
    pub source: String,
    /// The name of the computed response.
    pub frf: String,
    /// Responses of both sides.
    pub pairs: Vec<ResponsePair>,
    /// What was measured and has no computed response beside it, with the reason.
    pub measured_alone: Vec<String>,
    /// Names of computed places without a measured response.
    pub computed_alone: Vec<String>,
}

/// A measured frequency response and the computed one at the same frequencies.
#[derive(Debug, Clone)]
pub struct ResponsePair {
    /// What the test calls it.
    pub name: String,
    /// The place of the computed response.
    pub place: String,
    /// Whether force and motion changed places, by reciprocity.
    pub swapped: bool,
    /// How far the places of the test are from those of the case: force, motion \[m\].
    pub away: [f64; 2],
    /// What of the motion was measured.
    pub quantity: Quantity,
    /// \[Hz\].
    pub frequencies_hz: Vec<f64>,
    /// In the SI unit of the quantity.
    pub measured: Vec<c64>,
    /// In the SI unit of the quantity.
    pub computed: Vec<c64>,
    /// FRAC = |Σ H_m H_c*|²/(Σ|H_m|² Σ|H_c|²) over the frequencies.
    pub assurance: f64,
}

impl MeasuredComparison {
    /// The levels between the measured frequencies, and a tenth beyond, of which no mode is paired.
    pub fn computed_alone(&self, set: &NamedModes) -> Vec<Range<usize>> {
        let measured = || self.rows.iter().map(|row| row.frequency_hz);
        let low = (1.0 - BEYOND) * measured().fold(f64::INFINITY, f64::min);
        let high = (1.0 + BEYOND) * measured().fold(0.0, f64::max);
        let inside = |level: &&Range<usize>| {
            let hz = self.frequency_scale * set.modes.frequency_hz(level.start);
            (low..=high).contains(&hz)
                && !self.rows.iter().any(|row| row.mode.is_some_and(|k| level.contains(&k)))
        };
        self.levels.iter().filter(inside).cloned().collect()
    }

    /// The level that a mode belongs to.
    pub fn level_of(&self, mode: usize) -> Option<usize> {
        self.levels.iter().position(|level| level.contains(&mode))
    }
}

/// Writes `comparison_<name>.csv` and `comparison_<name>_frf.csv`.
pub(super) fn write(dir: &Path, results: &RunResults) -> Result<()> {
    let mut names = FileNames::default();
    for comparison in &results.measured {
        let name = names.next(&comparison.name);
        let text = modes_table(comparison, results.modes.get(comparison.modes));
        write_result(dir, &format!("comparison_{name}.csv"), text.as_bytes())?;
    }
    let mut names = FileNames::default();
    for responses in &results.measured_frfs {
        let name = names.next(&responses.name);
        write_result(dir, &format!("comparison_{name}_frf.csv"), responses_table(responses).as_bytes())?;
    }
    Ok(())
}

fn modes_table(comparison: &MeasuredComparison, set: Option<&NamedModes>) -> String {
    let mut table = Table::new(&[
        "measured mode",
        "measured frequency [Hz]",
        "relative standard deviation",
        "measured damping ratio",
        "computed mode",
        "computed frequency [Hz]",
        "computed damping ratio",
        "difference [%]",
        "MAC",
    ]);
    let cell = |value: Option<f64>| value.map_or(String::new(), number);
    for (k, row) in comparison.rows.iter().enumerate() {
        let found = set.zip(row.mode);
        let computed = found.map(|(set, mode)| comparison.frequency_scale * set.modes.frequency_hz(mode));
        let damping = found.and_then(|(set, mode)| set.damping_ratio.get(mode).copied());
        table.row(&[
            (k + 1).to_string(),
            number(row.frequency_hz),
            cell(row.deviation),
            cell(row.damping_ratio),
            row.mode.map_or(String::new(), |mode| (mode + 1).to_string()),
            cell(computed),
            cell(damping),
            cell(computed.map(|hz| 100.0 * (hz / row.frequency_hz - 1.0))),
            cell(row.likeness),
        ]);
    }
    table.text
}

fn responses_table(responses: &MeasuredResponses) -> String {
    let mut table = Table::new(&[
        "response",
        "quantity",
        "frequency [Hz]",
        "re measured [SI]",
        "im measured [SI]",
        "re computed [SI]",
        "im computed [SI]",
    ]);
    for pair in &responses.pairs {
        for (k, hz) in pair.frequencies_hz.iter().enumerate() {
            let (measured, computed) = (pair.measured[k], pair.computed[k]);
            let mut row = vec![pair.name.clone(), pair.quantity.word().to_string()];
            row.extend([*hz, measured.re, measured.im, computed.re, computed.im].map(number));
            table.row(&row);
        }
    }
    table.text
}

/// The object `comparison` of `summary.json`: a key a name.
pub(super) fn summary(results: &RunResults) -> Value {
    let mut all = serde_json::Map::new();
    for comparison in &results.measured {
        let Some(set) = results.modes.get(comparison.modes) else { continue };
        all.insert(comparison.name.clone(), modes_summary(comparison, set));
    }
    for responses in &results.measured_frfs {
        let pair = |pair: &ResponsePair| {
            json!({
                "measured": pair.name,
                "computed": pair.place,
                "swapped": pair.swapped,
                "away_m": pair.away,
                "quantity": pair.quantity.word(),
                "frequencies": pair.frequencies_hz.len(),
                "frac": pair.assurance,
            })
        };
        let value = json!({
            "name": responses.frf,
            "source": responses.source,
            "responses": responses.pairs.iter().map(pair).collect::<Vec<_>>(),
            "measured_alone": responses.measured_alone,
            "computed_alone": responses.computed_alone,
        });
        let entry = all.entry(responses.name.clone()).or_insert_with(|| json!({}));
        entry["frf"] = value;
    }
    Value::Object(all)
}

fn modes_summary(comparison: &MeasuredComparison, set: &NamedModes) -> Value {
    let hz = |mode: usize| comparison.frequency_scale * set.modes.frequency_hz(mode);
    let row = |row: &MeasuredRow| {
        json!({
            "measured_hz": row.frequency_hz,
            "deviation": row.deviation,
            "measured_damping_ratio": row.damping_ratio,
            "mode": row.mode.map(|mode| mode + 1),
            "computed_hz": row.mode.map(hz),
            "computed_damping_ratio": row.mode.and_then(|mode| set.damping_ratio.get(mode)),
            "difference_percent": row.mode.map(|mode| 100.0 * (hz(mode) / row.frequency_hz - 1.0)),
            "mac": row.likeness,
        })
    };
    let alone = comparison.rows.iter().filter(|row| row.mode.is_none()).map(|row| row.frequency_hz);
    let level = |level: &Range<usize>| json!({ "modes": [level.start + 1, level.end], "frequency_hz": hz(level.start) });
    json!({
        "set": set.name,
        "source": comparison.source,
        "frequency_scale": comparison.frequency_scale,
        "modes": comparison.rows.iter().map(row).collect::<Vec<_>>(),
        "measured_alone_hz": alone.collect::<Vec<_>>(),
        "computed_alone": comparison.computed_alone(set).iter().map(level).collect::<Vec<_>>(),
        "levels": comparison.levels.iter().map(level).collect::<Vec<_>>(),
        "mac": comparison.likeness,
        "geometry": comparison.placed.map(|placed| json!({
            "points": placed.points,
            "directions": placed.dofs,
            "largest_distance_m": placed.largest,
            "mean_distance_m": placed.mean,
        })),
    })
}

impl ResultsFile {
    /// Writes the measured modes with the computed ones paired with them to `/measured/<k>`.
    pub fn write_measured(&mut self, measured: &[MeasuredComparison]) -> Result<()> {
        self.stage(|root| {
            for (k, comparison) in measured.iter().enumerate() {
                let group = Datasets(root.create_group(&format!("measured/{}", k + 1))?);
                text_attribute(&group.0, "name", &comparison.name)?;
                text_attribute(&group.0, "source", &comparison.source)?;
                attribute(&group.0, "mode_set", &(comparison.modes as u64))?;
                attribute(&group.0, "frequency_scale", &comparison.frequency_scale)?;
                if let Some(placed) = &comparison.placed {
                    attribute(&group.0, "points", &(placed.points as u64))?;
                    attribute(&group.0, "largest_distance_m", &placed.largest)?;
                    attribute(&group.0, "mean_distance_m", &placed.mean)?;
                }
                let of = |value: fn(&MeasuredRow) -> Option<f64>| -> Vec<f64> {
                    comparison.rows.iter().map(|row| value(row).unwrap_or(f64::NAN)).collect()
                };
                group.list(
                    "frequency_hz",
                    &of(|row| Some(row.frequency_hz)),
                    "Hz",
                    "measured frequencies",
                )?;
                let story = "standard deviation of the frequency over the frequency; NaN where not known";
                group.list("deviation", &of(|row| row.deviation), "1", story)?;
                let story = "measured damping ratio; NaN where not known";
                group.list("damping_ratio", &of(|row| row.damping_ratio), "1", story)?;
                let mode: Vec<i64> =
                    comparison.rows.iter().map(|row| row.mode.map_or(-1, |m| m as i64)).collect();
                group.list("mode", &mode, "1", "index of the paired mode, -1 for none")?;
                let first: Vec<u64> = comparison.levels.iter().map(|level| level.start as u64).collect();
                group.list(
                    "level",
                    &first,
                    "1",
                    "index of the first mode of each level of computed modes",
                )?;
                let at = |(i, j): (usize, usize)| {
                    comparison.likeness.get(i).and_then(|row| row.get(j)).copied().unwrap_or(f64::NAN)
                };
                let mac = Array2::from_shape_fn((comparison.rows.len(), comparison.levels.len()), at);
                let story = "squared cosine of each measured shape with each level; NaN without a shape";
                group.write("mac", mac.view(), "1", story)?;
            }
            Ok(())
        })
    }

    /// Writes the measured frequency responses with the computed ones to `/measured_frf/<name>/<k>`.
    pub fn write_measured_frfs(&mut self, all: &[MeasuredResponses]) -> Result<()> {
        self.stage(|root| {
            for responses in all {
                for (k, pair) in responses.pairs.iter().enumerate() {
                    let path = format!("measured_frf/{}/{}", responses.name.replace('/', "_"), k + 1);
                    let group = Datasets(root.create_group(&path)?);
                    text_attribute(&group.0, "name", &pair.name)?;
                    text_attribute(&group.0, "quantity", pair.quantity.word())?;
                    attribute(&group.0, "frac", &pair.assurance)?;
                    group.list("frequency_hz", &pair.frequencies_hz, "Hz", "where it was measured")?;
                    let unit = pair.quantity.unit();
                    group.list("measured", &pair.measured, unit, "measured response")?;
                    group.list("computed", &pair.computed, unit, "computed response")?;
                }
            }
            Ok(())
        })
    }
}
