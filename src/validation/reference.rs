//! `reference.toml`: what a validation case must show.

use super::kirchhoff::Edge;
use crate::case::{Case, read_case};
use crate::error::read::read_text;
use crate::error::{Faults, Result};
use crate::results::CheckedQuantity;
use crate::schema::reader::{TableReader, read_document};
use crate::schema::units::{FREQUENCY, LENGTH, NUMBER, RATE, TIME};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Bound;
use std::path::Path;

/// A validation case with its reference values.
#[derive(Debug)]
pub struct Reference {
    /// The folder's name.
    pub name: String,
    /// One line.
    pub title: String,
    /// Where the reference values come from.
    pub source: String,
    /// The cases to run, by their files.
    pub cases: BTreeMap<String, Case>,
    /// Checks.
    pub checks: Vec<Check>,
}

/// One quantity beside its reference.
#[derive(Debug)]
pub struct Check {
    /// Description of the quantity.
    pub quantity: String,
    /// How it is computed.
    pub of: CheckQuantity,
    /// The reference value; not a number where it is computed, too.
    pub reference: f64,
    /// The reference, computed in another way.
    pub second: Option<CheckQuantity>,
    /// The largest difference that passes.
    pub tolerance: f64,
    /// The difference is divided by the reference.
    pub relative: bool,
    /// Why this tolerance.
    pub reason: String,
}

/// A quantity of a case.
#[derive(Debug)]
pub struct CheckQuantity {
    /// The file of the case.
    pub case: String,
    /// How it is computed.
    pub kind: QuantityKind,
    /// Scalars of the case to set first.
    pub set: Vec<(String, f64)>,
}

/// The ways to compute a quantity.
#[derive(Debug)]
pub enum QuantityKind {
    /// A number of `summary.json`, by its JSON pointer; of a list its length, of true and false one and zero.
    Value(String),
    /// The derivative of such a number by a scalar, from differences of four runs.
    Slope {
        /// The JSON pointer.
        pointer: String,
        /// Path of the scalar.
        parameter: String,
        /// The two nearest values are so far from its own.
        step: f64,
    },
    /// The value of a scalar at which the first mode becomes unstable, by bisection between two bounds.
    Onset {
        /// Path of the scalar.
        parameter: String,
        /// A stable and an unstable value, in either order.
        between: [f64; 2],
        /// A mode is unstable when σ exceeds this part of |λ|.
        above: f64,
    },
    /// The largest |σ|/|λ| over all modes, for every one of some values of a scalar.
    LargestGrowth {
        /// Path of the scalar.
        parameter: String,
        /// Its values.
        values: Vec<f64>,
    },
    /// The largest relative change of any eigenvalue when scalars are changed.
    Change(Vec<(String, f64)>),
    /// The largest relative change of any eigenvalue when the case is exported as matrices and read again.
    Exported,
    /// In how many places the summary of a run that was stopped halfway and resumed differs from that of a whole run.
    Resumed,
    /// How many faults a case file has, which is named from the folder of the case.
    Faults(String),
    /// The frequency of the unstable mode nearest to a frequency \[Hz\].
    UnstableNear(f64),
    /// The growth rate of the unstable mode nearest to a frequency \[Hz\].
    GrowthNear(f64),
    /// |σ̂/σ − 1| (or |f̂/f − 1|) of the growth (or frequency) of a small disturbance in time, against the complex mode that
    /// it starts along.
    Disturbance {
        /// Growth, not frequency.
        growth: bool,
    },
    /// The largest growth rate of any mode \[1/s\].
    GrowthRate,
    /// Measure of a channel of the run in time between two times.
    InTime {
        /// Which and when.
        of: ChannelWindow,
        /// Its measure.
        measure: Measure,
        /// As a part of what the full model says, for a case whose model is reduced.
        over_full: bool,
    },
    /// At how many of the steps from one value of a scalar to the next something rises: the amplitude of a channel between
    /// two times, or the largest growth rate.
    Rises {
        /// Path of the scalar.
        parameter: String,
        /// Its values.
        values: Vec<f64>,
        /// Where the amplitude is taken.
        of: Option<ChannelWindow>,
    },
    /// The largest deviation of a channel from what Eqs. (3)–(5) of Rusli et al. (2020) give, integrated apart, as a part of
    /// its amplitude there.
    PaperEquations(ChannelWindow),
    /// The largest relative error of the modes of a round plate against Kirchhoff theory.
    RoundPlate {
        /// The real-mode analysis, which must be of this plate alone.
        modes: String,
        /// The shell part.
        part: String,
        /// The outer edge: a \[m\] and how it is held.
        outer: (f64, Edge),
        /// The inner edge, if there is a hole: b \[m\] and how it is held.
        inner: Option<(f64, Edge)>,
    },
}

/// A channel of the run in time, between two times \[s\].
#[derive(Debug, Clone)]
pub struct ChannelWindow {
    /// Its name.
    pub channel: String,
    /// The first and the last time.
    pub window: [f64; 2],
}

/// Measure of a channel.
#[derive(Debug, Clone)]
pub enum Measure {
    /// Half of what it spans.
    Amplitude,
    /// Its amplitude over that between two other times.
    AmplitudeOver([f64; 2]),
    /// The rate at which its amplitude has grown since the window between two other times, as long \[1/s\].
    GrowthSince([f64; 2]),
    /// Its largest value.
    Highest,
    /// Its smallest value.
    Lowest,
    /// Its period \[s\].
    Period,
    /// The amplitude of its strongest line.
    Tone,
    /// The frequency of its strongest line \[Hz\].
    ToneFrequency,
    /// The time from its lowest value in a period to the next highest \[s\].
    Rise,
    /// The frequency of the highest peak near the reference \[Hz\].
    PeakNear(Near),
    /// How high the lines near some frequencies are beside the highest of all \[dB\].
    Level(Near),
    /// How high the highest line is that is near none of some frequencies, beside the highest of all \[dB\].
    OtherLevel(Near),
}

/// Parts of a spectrum.
#[derive(Debug, Clone)]
pub struct Near {
    /// About these frequencies \[Hz\] …
    pub frequencies_hz: Vec<f64>,
    /// … as far as this share of them to either side.
    pub within: f64,
    /// Frequency above which nothing counts \[Hz\].
    pub below_hz: f64,
}

impl Check {
    /// The check with what was computed for it.
    pub fn beside(&self, computed: f64) -> CheckedQuantity {
        CheckedQuantity {
            computed,
            quantity: self.quantity.clone(),
            reference: self.reference,
            tolerance: self.tolerance,
            relative: self.relative,
            reason: self.reason.clone(),
        }
    }
}

/// Reads `folder/reference.toml` and its cases.
///
/// # Errors
/// Every fault of either file.
pub fn read(folder: &Path) -> Result<Reference> {
    let path = folder.join("reference.toml");
    let text = read_text(&path, "the reference values of a validation case, in TOML")?;
    let reference =
        Reference::parse(&path.display().to_string(), &text, |file| read_case(&folder.join(file)))?;
    Ok(Reference { name: folder.file_name().unwrap_or_default().to_string_lossy().into_owned(), ..reference })
}

impl Reference {
    /// The validation case of the `text` of the file `place`, without a name; `read` gives the case of a file.
    ///
    /// # Errors
    /// Every fault of the text, or of its cases.
    pub fn parse(place: &str, text: &str, read: impl Fn(&str) -> Result<Case>) -> Result<Reference> {
        let mut reference = read_document(place, text, |root| {
            let case = root.string("case").or("case.toml".into());
            let reason = root.text("reason").or(String::new());
            Reference {
                name: String::new(),
                title: root.text("title").required("one line"),
                source: root.text("source").required("where the reference values come from"),
                cases: BTreeMap::new(),
                checks: root
                    .named("check", |name, s| read_check(name, s, &case, &reason))
                    .unwrap_or_default(),
            }
        })?;
        let mut faults = Faults::new();
        let quantities =
            reference.checks.iter().flat_map(|check| std::iter::once(&check.of).chain(&check.second));
        let files: BTreeSet<&String> = quantities.map(|quantity| &quantity.case).collect();
        let cases =
            files.into_iter().filter_map(|file| faults.take(read(file)).map(|case| (file.clone(), case)));
        reference.cases = cases.collect();
        faults.into_result(reference)
    }
}

/// A quantity of the case file `case` with its reference, tolerance and the `reason` for it, which the table may state
/// otherwise.
pub fn read_check(name: &str, s: &TableReader, case: &str, reason: &str) -> Check {
    let relative = s.quantity("tolerance", NUMBER).positive().optional();
    let absolute = s.quantity("absolute_tolerance", NUMBER).positive().optional();
    if relative.is_some() == absolute.is_some() {
        s.fault(
            "tolerance",
            "both tolerances or neither",
            "`tolerance` (relative) or `absolute_tolerance`",
            "",
        );
    }
    let second =
        s.is_table("reference").then(|| s.section("reference", |second| read_quantity(second, case, "near")));
    let of = read_quantity(s, case, if second.is_some() { "near" } else { "reference" });
    let unit = match of.kind {
        QuantityKind::GrowthNear(_) | QuantityKind::GrowthRate => RATE,
        _ => FREQUENCY,
    };
    Check {
        quantity: s.string("quantity").or(name.to_string()),
        of,
        reference: if second.is_some() { f64::NAN } else { s.quantity("reference", unit).or(0.0) },
        second: second.flatten(),
        tolerance: relative.or(absolute).unwrap_or(0.0),
        relative: relative.is_some(),
        reason: s.text("reason").or(reason.to_string()),
    }
}

/// How a quantity is computed; a frequency near which it is sought is the number of the key `about`.
fn read_quantity(s: &TableReader, case: &str, about: &str) -> CheckQuantity {
    CheckQuantity {
        case: s.string("case").or(case.to_string()),
        kind: read_kind(s, about),
        set: read_set(s, "set"),
    }
}

fn read_kind(s: &TableReader, about: &str) -> QuantityKind {
    const KINDS: [&str; 28] = [
        "value",
        "slope",
        "exported",
        "resumed",
        "faults",
        "onset",
        "largest_growth",
        "change",
        "unstable_near",
        "growth_near",
        "growth_in_time",
        "frequency_in_time",
        "round_plate",
        "growth_rate",
        "rises",
        "paper_equations",
        "amplitude",
        "amplitude_over",
        "growth_since",
        "highest",
        "lowest",
        "period",
        "rise_time",
        "tone",
        "tone_frequency",
        "peak_near",
        "level",
        "other_level",
    ];
    let parameter = || s.string("parameter").required("the path of a scalar of the case");
    let earlier = || s.quantities("since", TIME).required("two times");
    let near = || s.quantity_list("near", FREQUENCY).required("a list of frequencies");
    let at = || s.quantity(about, FREQUENCY).required(FREQUENCY.name);
    let in_time = |measure: Measure| {
        let over_full = s.boolean("over_full").or(false);
        QuantityKind::InTime { of: read_span(s), measure, over_full }
    };
    match s.choice("kind", &KINDS).required("how it is computed") {
        "slope" => QuantityKind::Slope {
            pointer: s.string("pointer").required("a JSON pointer into summary.json"),
            parameter: parameter(),
            step: s.quantity("step", NUMBER).positive().required("a difference of the scalar in SI units"),
        },
        "exported" => QuantityKind::Exported,
        "resumed" => QuantityKind::Resumed,
        "faults" => QuantityKind::Faults(s.string("file").required("the name of a case file")),
        "onset" => QuantityKind::Onset {
            parameter: parameter(),
            between: s.quantities("between", NUMBER).required("a stable and an unstable value"),
            above: s.quantity("above", NUMBER).positive().or(1e-6),
        },
        "largest_growth" => QuantityKind::LargestGrowth {
            parameter: parameter(),
            values: s.quantity_list("values", NUMBER).required("a list of values"),
        },
        "change" => QuantityKind::Change(read_set(s, "to")),
        "unstable_near" => QuantityKind::UnstableNear(at()),
        "growth_near" => QuantityKind::GrowthNear(s.quantity("near", FREQUENCY).required(FREQUENCY.name)),
        "growth_in_time" => QuantityKind::Disturbance { growth: true },
        "frequency_in_time" => QuantityKind::Disturbance { growth: false },
        "growth_rate" => QuantityKind::GrowthRate,
        "rises" => QuantityKind::Rises {
            parameter: parameter(),
            values: s.quantity_list("values", NUMBER).required("a list of values"),
            of: s.has("channel").then(|| read_span(s)),
        },
        "paper_equations" => QuantityKind::PaperEquations(read_span(s)),
        "amplitude" => in_time(Measure::Amplitude),
        "amplitude_over" => in_time(Measure::AmplitudeOver(earlier())),
        "growth_since" => in_time(Measure::GrowthSince(earlier())),
        "highest" => in_time(Measure::Highest),
        "lowest" => in_time(Measure::Lowest),
        "period" => in_time(Measure::Period),
        "rise_time" => in_time(Measure::Rise),
        "tone" => in_time(Measure::Tone),
        "tone_frequency" => in_time(Measure::ToneFrequency),
        "peak_near" => in_time(Measure::PeakNear(read_near(s, vec![at()]))),
        "level" => in_time(Measure::Level(read_near(s, near()))),
        "other_level" => in_time(Measure::OtherLevel(read_near(s, near()))),
        "round_plate" => QuantityKind::RoundPlate {
            modes: s.string("modes").required("the name of an analysis"),
            part: s.string("part").required("the name of a shell"),
            outer: s.section("outer", read_edge).unwrap_or_else(|| {
                s.fault("outer", "no outer edge", "a table of `radius` and `edge`", "");
                (1.0, Edge::Free)
            }),
            inner: s.section("inner", read_edge),
        },
        _ => QuantityKind::Value(s.string("pointer").or(String::new())),
    }
}

fn read_edge(s: &TableReader) -> (f64, Edge) {
    let edge = match s.choice("edge", &["clamped", "simply_supported", "free"]).required("how it is held") {
        "clamped" => Edge::Clamped,
        "simply_supported" => Edge::SimplySupported,
        _ => Edge::Free,
    };
    (s.quantity("radius", LENGTH).positive().required(LENGTH.name), edge)
}

fn read_span(s: &TableReader) -> ChannelWindow {
    ChannelWindow {
        channel: s.string("channel").required("the name of a channel of the run in time"),
        window: s.quantities("window", TIME).required("two times"),
    }
}

fn read_near(s: &TableReader, frequencies_hz: Vec<f64>) -> Near {
    let within = s.quantity("within", NUMBER).within(Bound::Excluded(0.0), Bound::Excluded(1.0));
    let below_hz = s.quantity("below", FREQUENCY).positive();
    Near { frequencies_hz, within: within.or(0.03), below_hz: below_hz.or(f64::INFINITY) }
}

fn read_set(s: &TableReader, key: &str) -> Vec<(String, f64)> {
    s.section(key, |set| {
        let value = |path: &String| (path.clone(), set.quantity(path, NUMBER).or(0.0));
        set.names().iter().map(value).collect()
    })
    .unwrap_or_default()
}
