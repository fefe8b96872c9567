//! Measured beside computed: modes and frequency responses.

use super::explored::ends;
use super::summary::sentences;
use super::{NamedModes, file_name};
use crate::dataset::{Column, Describe, Dimension, Group, Table, Variable, column};
use crate::linalg::c64;
use crate::measured::Quantity;
use std::ops::Range;

/// Computed modes without a measured one are reported within this share beyond the measured frequencies.
const BEYOND: f64 = 0.1;

/// Measured modes and the computed modes set beside them.
#[derive(Debug, Clone, Default)]
pub struct MeasuredComparison {
    /// Its name in the case; that of the analysis, where the case gives frequencies there. Each is there once.
    pub name: String,
    /// The name of the computed modes.
    pub set: String,
    /// Where the figures come from.
    pub source: String,
    /// One row a measured mode.
    pub rows: Vec<MeasuredRow>,
    /// Computed frequencies were multiplied by this before comparison (an assumption of the case); 1 for none.
    pub frequency_scale: f64,
    /// Computed modes that are one level; rigid-body modes are in none.
    pub levels: Vec<Range<usize>>,
    /// Frequency of the first mode of each level, times the scale \[Hz\].
    pub levels_hz: Vec<f64>,
    /// MAC of each measured mode with each level; empty for a mode without a shape.
    pub mac: Vec<Vec<f64>>,
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
    /// Frequency of that mode times the frequency scale \[Hz\].
    pub computed_hz: Option<f64>,
    /// ζ of that mode.
    pub computed_damping_ratio: Option<f64>,
    /// MAC with the level of that mode.
    pub mac: Option<f64>,
}

impl MeasuredRow {
    /// 100 (computed − measured)/measured \[%\]: positive where the computed frequency is too high.
    pub fn difference_percent(&self) -> Option<f64> {
        self.computed_hz.map(|computed| 100.0 * (computed / self.frequency_hz - 1.0))
    }
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
    /// Measured responses that have no computed response beside them, with the reason.
    pub measured_alone: Vec<String>,
    /// Names of computed places without a measured response.
    pub computed_alone: Vec<String>,
}

/// A measured frequency response and the computed one at the same frequencies.
#[derive(Debug, Clone)]
pub struct ResponsePair {
    /// Name in the test.
    pub name: String,
    /// The place of the computed response.
    pub place: String,
    /// Whether force and motion changed places, by reciprocity.
    pub swapped: bool,
    /// How far the places of the test are from those of the case: force, motion \[m\].
    pub away: [f64; 2],
    /// Receptance, mobility or accelerance.
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
    /// Whether the test is of the computed modes `set`.
    pub fn is_of(&self, set: &NamedModes) -> bool {
        self.set == set.name
    }

    /// The levels between the measured frequencies, and a tenth beyond, of which no mode is paired.
    pub fn computed_alone(&self) -> Vec<Range<usize>> {
        let measured = || self.rows.iter().map(|row| row.frequency_hz);
        let low = (1.0 - BEYOND) * measured().fold(f64::INFINITY, f64::min);
        let high = (1.0 + BEYOND) * measured().fold(0.0, f64::max);
        let paired =
            |level: &Range<usize>| self.rows.iter().any(|row| row.mode.is_some_and(|k| level.contains(&k)));
        let levels = self.levels.iter().zip(&self.levels_hz);
        let alone = levels.filter(|(level, hz)| (low..=high).contains(*hz) && !paired(level));
        alone.map(|(level, _)| level.clone()).collect()
    }

    /// The level that a mode belongs to.
    pub fn level_of(&self, mode: usize) -> Option<usize> {
        self.levels.iter().position(|level| level.contains(&mode))
    }
}

fn mode_columns() -> Vec<Column<MeasuredRow>> {
    type Row = MeasuredRow;
    vec![
        column("measured_hz", "Hz", "measured frequency", |row: &Row| row.frequency_hz),
        column("deviation", "1", "standard deviation of the frequency over the frequency", |row: &Row| {
            row.deviation
        }),
        column("measured_damping_ratio", "1", "measured ζ", |row: &Row| row.damping_ratio),
        column("mode", "1", "number of the computed mode beside it", |row: &Row| {
            row.mode.map(|mode| mode + 1)
        }),
        column("computed_hz", "Hz", "its frequency times the scale", |row: &Row| row.computed_hz),
        column("computed_damping_ratio", "1", "its ζ", |row: &Row| row.computed_damping_ratio),
        column("difference_percent", "%", "(computed − measured)/measured", |row: &Row| {
            row.difference_percent()
        }),
        column("mac", "1", "MAC with the level of that mode", |row: &Row| row.mac),
    ]
}

/// A level of computed modes: its number, its modes and its frequency.
type LevelRow = (usize, Range<usize>, f64);

fn level_columns() -> Vec<Column<LevelRow>> {
    vec![
        column("modes", "1", "numbers of its first and its last mode", |(_, modes, _): &LevelRow| {
            [modes.start + 1, modes.end]
        })
        .along(ends()),
        column("frequency_hz", "Hz", "frequency of the first times the scale", |(.., hz): &LevelRow| *hz),
    ]
}

impl Describe for MeasuredComparison {
    fn describe(&self) -> Group<'_> {
        Group::new("", "").list("comparison", vec![self.group()])
    }
}

impl MeasuredComparison {
    /// Both sides.
    fn group(&self) -> Group<'_> {
        let modes = Table::of("modes", "measured_mode", &mode_columns(), &self.rows)
            .file(file_name("comparison", &self.name));
        let rows = Dimension::numbered("measured_mode", self.rows.len());
        let columns = Dimension::numbered("level", self.levels.len());
        let mut mac = vec![f64::NAN; rows.length * columns.length];
        for (shape, known) in mac.chunks_mut(columns.length.max(1)).zip(&self.mac) {
            shape.iter_mut().zip(known).for_each(|(mac, known)| *mac = *known);
        }
        let story = "MAC of each measured shape with each level of computed modes";
        let mac = Variable::reals("mac", "1", story, vec![rows, columns], mac);
        let levels = self.levels.iter().zip(&self.levels_hz).enumerate();
        let levels: Vec<LevelRow> = levels.map(|(k, (level, hz))| (k + 1, level.clone(), *hz)).collect();
        let missed = self.computed_alone();
        let missed: Vec<LevelRow> =
            levels.iter().filter(|(_, modes, _)| missed.contains(modes)).cloned().collect();
        let mut missed_columns = level_columns();
        missed_columns.insert(0, column("level", "1", "number of the level", |(k, ..): &LevelRow| *k));
        let alone = self.rows.iter().filter(|row| row.mode.is_none()).map(|row| row.frequency_hz);
        let alone: Vec<f64> = alone.collect();
        let numbers = Dimension::of_variable("measured_alone_hz", alone.len());
        Group::new(&*self.name, "measured modes beside computed ones")
            .value("set", "text", "name of the computed modes", self.set.clone())
            .value("source", "text", "where the measured figures come from", self.source.clone())
            .value("frequency_scale", "1", "computed frequencies are multiplied by it", self.frequency_scale)
            .table(modes)
            .with(Variable::reals(
                "measured_alone_hz",
                "Hz",
                "measured frequencies without a computed mode",
                vec![numbers],
                alone,
            ))
            .table(Table::of("computed_alone", "missed_level", &missed_columns, &missed))
            .table(Table::of("levels", "level", &level_columns(), &levels))
            .with(mac)
            .optional("geometry", self.placed.as_ref().map(Placed::group))
    }
}

impl Placed {
    fn group(&self) -> Group<'static> {
        Group::new("geometry", "how the geometry of the test fits the mesh")
            .value("points", "1", "points with a shape", self.points)
            .value("directions", "1", "directions at them in all", self.dofs)
            .value("largest_distance_m", "m", "largest distance of a point from its node", self.largest)
            .value("mean_distance_m", "m", "mean distance", self.mean)
    }
}

fn pair_columns() -> Vec<Column<ResponsePair>> {
    type Pair = ResponsePair;
    vec![
        column("measured", "text", "what the test calls it", |p: &Pair| p.name.clone()),
        column("computed", "text", "the place of the computed response", |p: &Pair| p.place.clone()),
        column("swapped", "1", "whether force and motion changed places", |p: &Pair| p.swapped),
        column("away_m", "m", "distance of the places of the test from those of the case", |p: &Pair| p.away)
            .along(Dimension::named("place", &["force", "motion"])),
        column("quantity", "text", "what of the motion was measured", |p: &Pair| p.quantity.word()),
        column("frequencies", "1", "number of frequencies", |p: &Pair| p.frequencies_hz.len()),
        column("frac", "1", "|Σ H_m H_c*|²/(Σ|H_m|² Σ|H_c|²)", |p: &Pair| p.assurance),
    ]
}

/// A pair at one of its frequencies.
type ResponseLineRow<'a> = (&'a ResponsePair, usize);

fn line_columns<'a>() -> Vec<Column<ResponseLineRow<'a>>> {
    vec![
        column("response", "text", "what the test calls it", |(p, _): &ResponseLineRow| p.name.clone()),
        column("quantity", "text", "what of the motion was measured", |(p, _): &ResponseLineRow| {
            p.quantity.word()
        }),
        column("unit", "text", "its unit", |(p, _): &ResponseLineRow| p.quantity.unit()),
        column("frequency_hz", "Hz", "frequency", |(p, k): &ResponseLineRow| p.frequencies_hz[*k]),
        column("measured", "unit", "measured response", |(p, k): &ResponseLineRow| p.measured[*k]),
        column("computed", "unit", "computed response", |(p, k): &ResponseLineRow| p.computed[*k]),
    ]
}

impl Describe for MeasuredResponses {
    fn describe(&self) -> Group<'_> {
        Group::new("", "").list("comparison_frf", vec![self.group()])
    }
}

impl MeasuredResponses {
    /// Both sides.
    fn group(&self) -> Group<'_> {
        let lines = self.pairs.iter().flat_map(|pair| (0..pair.frequencies_hz.len()).map(move |k| (pair, k)));
        let lines = Table::of("lines", "line", &line_columns(), &lines.collect::<Vec<ResponseLineRow>>());
        Group::new(&*self.name, "measured frequency responses beside computed ones")
            .value("frf", "text", "name of the computed response", self.frf.clone())
            .value("source", "text", "where the measured figures come from", self.source.clone())
            .table(Table::of("responses", "response", &pair_columns(), &self.pairs))
            .with(sentences("measured_alone", "what was measured alone, and why", &self.measured_alone))
            .with(sentences("computed_alone", "places that were computed alone", &self.computed_alone))
            .table(lines.file(file_name("comparison", &self.name) + "_frf").long())
    }
}
