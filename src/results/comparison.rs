//! What was measured beside what was computed: modes and frequency responses.

use super::explored::ends;
use super::summary::sentences;
use super::{FileNames, NamedModes, RunResults};
use crate::dataset::{Column, Dimension, Group, Table, Variable, column};
use crate::linalg::c64;
use crate::measured::Quantity;
use std::ops::Range;

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
    /// MAC with the level of that mode.
    pub mac: Option<f64>,
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

/// A measured mode with its test and the computed modes.
type Row<'a> = (&'a MeasuredComparison, &'a NamedModes, MeasuredRow);

fn mode_columns<'a>() -> Vec<Column<Row<'a>>> {
    let computed = |(test, set, row): &Row| row.mode.map(|mode| test.computed_hz(set, mode));
    vec![
        column("measured_hz", "Hz", "measured frequency", |(.., row): &Row| row.frequency_hz),
        column(
            "deviation",
            "1",
            "standard deviation of the frequency over the frequency",
            |(.., row): &Row| row.deviation,
        ),
        column("measured_damping_ratio", "1", "measured ζ", |(.., row): &Row| row.damping_ratio),
        column("mode", "1", "number of the computed mode beside it", |(.., row): &Row| {
            row.mode.map(|mode| mode + 1)
        }),
        column("computed_hz", "Hz", "its frequency times the scale", move |row: &Row| computed(row)),
        column("computed_damping_ratio", "1", "its ζ", |(_, set, row): &Row| {
            row.mode.and_then(|mode| set.damping_ratio.get(mode)).copied()
        }),
        column("difference_percent", "%", "(computed − measured)/measured", move |row: &Row| {
            computed(row).map(|hz| 100.0 * (hz / row.2.frequency_hz - 1.0))
        }),
        column("mac", "1", "MAC with the level of that mode", |(.., row): &Row| row.mac),
    ]
}

/// A level of computed modes: its number, its modes and its frequency.
type Level = (usize, Range<usize>, f64);

fn level_columns() -> Vec<Column<Level>> {
    vec![
        column("modes", "1", "numbers of its first and its last mode", |(_, modes, _): &Level| {
            [modes.start + 1, modes.end]
        })
        .along(ends()),
        column("frequency_hz", "Hz", "frequency of the first times the scale", |(.., hz): &Level| *hz),
    ]
}

impl MeasuredComparison {
    /// The frequency of a computed mode times the scale \[Hz\].
    fn computed_hz(&self, set: &NamedModes, mode: usize) -> f64 {
        self.frequency_scale * set.modes.frequency_hz(mode)
    }

    /// Both sides; `file` is the part of the CSV file's name that is the test's.
    fn group<'a>(&'a self, name: String, set: &'a NamedModes, file: &str) -> Group<'a> {
        let rows: Vec<Row> = self.rows.iter().map(|row| (self, set, *row)).collect();
        let modes = Table::of("modes", "measured_mode", &mode_columns(), &rows)
            .file(format!("comparison_{file}.csv"));
        let rows = Dimension::numbered("measured_mode", self.rows.len());
        let columns = Dimension::numbered("level", self.levels.len());
        let mut mac = vec![f64::NAN; rows.length * columns.length];
        for (shape, known) in mac.chunks_mut(columns.length.max(1)).zip(&self.mac) {
            shape.iter_mut().zip(known).for_each(|(mac, known)| *mac = *known);
        }
        let story = "MAC of each measured shape with each level of computed modes";
        let mac = Variable::reals("mac", "1", story, vec![rows, columns], mac);
        let levels = self.levels.iter().enumerate();
        let levels: Vec<Level> =
            levels.map(|(k, level)| (k + 1, level.clone(), self.computed_hz(set, level.start))).collect();
        let missed = self.computed_alone(set);
        let missed: Vec<Level> =
            levels.iter().filter(|(_, modes, _)| missed.contains(modes)).cloned().collect();
        let mut missed_columns = level_columns();
        missed_columns.insert(0, column("level", "1", "number of the level", |(k, ..): &Level| *k));
        let alone = self.rows.iter().filter(|row| row.mode.is_none()).map(|row| row.frequency_hz);
        let alone: Vec<f64> = alone.collect();
        let numbers = Dimension::of_variable("measured_alone_hz", alone.len());
        Group::new(name, "measured modes beside computed ones")
            .value("set", "text", "name of the computed modes", set.name.clone())
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
type Line<'a> = (&'a ResponsePair, usize);

fn line_columns<'a>() -> Vec<Column<Line<'a>>> {
    vec![
        column("response", "text", "what the test calls it", |(p, _): &Line| p.name.clone()),
        column("quantity", "text", "what of the motion was measured", |(p, _): &Line| p.quantity.word()),
        column("unit", "text", "its unit", |(p, _): &Line| p.quantity.unit()),
        column("frequency_hz", "Hz", "frequency", |(p, k): &Line| p.frequencies_hz[*k]),
        column("measured", "unit", "measured response", |(p, k): &Line| p.measured[*k]),
        column("computed", "unit", "computed response", |(p, k): &Line| p.computed[*k]),
    ]
}

impl MeasuredResponses {
    /// Both sides; `file` is the part of the CSV file's name that is the test's.
    fn group(&self, file: &str) -> Group<'_> {
        let lines = self.pairs.iter().flat_map(|pair| (0..pair.frequencies_hz.len()).map(move |k| (pair, k)));
        let lines = Table::of("lines", "line", &line_columns(), &lines.collect::<Vec<Line>>());
        Group::new(&*self.name, "measured frequency responses beside computed ones")
            .value("frf", "text", "name of the computed response", self.frf.clone())
            .value("source", "text", "where the measured figures come from", self.source.clone())
            .table(Table::of("responses", "response", &pair_columns(), &self.pairs))
            .with(sentences("measured_alone", "what was measured alone, and why", &self.measured_alone))
            .with(sentences("computed_alone", "places that were computed alone", &self.computed_alone))
            .table(lines.file(format!("comparison_{file}.csv")).long())
    }
}

impl RunResults {
    /// What was measured beside what was computed.
    pub(crate) fn compared(&self) -> Group<'_> {
        let mut files = FileNames::default();
        let mut names: Vec<String> = Vec::new();
        let mut modes = Vec::new();
        for test in &self.measured {
            let file = files.next(&test.name);
            // Frequencies of an analysis and a test may have the same name.
            let numbered = (2..).map(|k| format!("{} {k}", test.name));
            let name = std::iter::once(test.name.clone()).chain(numbered).find(|name| !names.contains(name));
            names.extend(name.clone());
            let sides = name.zip(self.modes.get(test.modes));
            modes.extend(sides.map(|(name, set)| test.group(name, set, &file)));
        }
        let responses = self.measured_frfs.iter();
        let responses =
            responses.map(|test| test.group(&files.next(&format!("{}_frf", test.name)))).collect();
        Group::new("", "").list("comparison", modes).list("comparison_frf", responses)
    }
}
