//! `[transient]`: motion in time.

use super::read::collect;
use super::reader::Section;
use super::units::{ANGLE, FORCE, FREQUENCY, LENGTH, NUMBER, TIME};
use serde::Serialize;
use std::collections::BTreeMap;
use std::ops::Bound;

/// Steps of a reduced model that are compared with the full one, when the case does not say.
const COMPARED: f64 = 100.0;

/// A run in time from steady sliding.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TransientAnalysis {
    /// How long \[s\].
    pub duration: f64,
    /// Δt \[s\].
    pub time_step: f64,
    /// The integrator.
    #[serde(flatten)]
    pub scheme: SchemeChoice,
    /// The full finite-element model, or one reduced to its modes and the responses to its contacts.
    pub model: ModelChoice,
    /// How many steps of a reduced model are compared with the full one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compare_steps: Option<usize>,
    /// Newton's method on the whole instead of the condensed step, to compare.
    pub full_newton: bool,
    /// What disturbs steady sliding at the start.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub disturbance: Option<Disturbance>,
    /// Pushes by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub push: BTreeMap<String, PushedRegion>,
    /// Where the motion is recorded, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub probe: BTreeMap<String, Probe>,
    /// How the counter-body of a contact slides, by the contact's name; constantly where it is not named.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub slide: BTreeMap<String, Slide>,
}

/// What moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ModelChoice {
    /// The full finite-element model.
    Full,
    /// The real modes up to `cea.basis_below`, and the residual attachment of contacts and forces.
    Reduced,
}

/// The family of integrators.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "scheme", rename_all = "snake_case")]
pub enum SchemeChoice {
    /// Newmark's method, β = ¼, γ = ½: no numerical damping.
    Newmark,
    /// Hilber, Hughes & Taylor's method.
    Hht {
        /// α ∈ \[−1/3, 0\].
        alpha: f64,
    },
    /// Chung & Hulbert's method.
    GeneralisedAlpha {
        /// ρ∞ ∈ \[0, 1\].
        rho: f64,
    },
}

/// A complex mode that the motion starts along.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Disturbance {
    /// The mode nearest to this frequency \[Hz\], one that grows if any does; the one that grows fastest when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mode_near: Option<f64>,
    /// The largest translation of any node \[m\].
    pub amplitude: f64,
}

/// A half-sine force on a region.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PushedRegion {
    /// The region, whose nodes share the force equally.
    pub on: String,
    /// The force at its peak \[N\].
    pub force: [f64; 3],
    /// When it begins \[s\].
    pub begin: f64,
    /// How long it lasts \[s\].
    pub duration: f64,
}

/// A place whose motion is recorded.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Probe {
    /// A region, the mean of its nodes where it has several …
    #[serde(skip_serializing_if = "Option::is_none")]
    pub on: Option<String>,
    /// … or a place \[m\], whose nearest node it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
    /// The direction.
    pub direction: [f64; 3],
}

/// How a sliding velocity runs in time, as factors of the contact's `sliding_velocity`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "motion", rename_all = "snake_case")]
pub enum Slide {
    /// Linearly from a part of the velocity to the whole of it.
    Ramp {
        /// The part at the start.
        from: f64,
        /// How long it takes \[s\].
        duration: f64,
    },
    /// V cos(2π f t + φ).
    Reciprocating {
        /// f \[Hz\].
        frequency: f64,
        /// φ \[rad\].
        phase: f64,
    },
    /// Linear between given times.
    Table {
        /// Times \[s\], ascending.
        time: Vec<f64>,
        /// Factors, one a time.
        factor: Vec<f64>,
    },
}

impl Slide {
    /// Whether the velocity reaches zero, or turns round.
    pub fn stops(&self) -> bool {
        match self {
            Slide::Ramp { from, .. } => *from <= 0.0,
            Slide::Reciprocating { .. } => true,
            Slide::Table { factor, .. } => {
                factor.iter().any(|f| *f <= 0.0) && factor.iter().any(|f| *f >= 0.0)
            }
        }
    }
}

pub(super) fn read(s: &Section) -> TransientAnalysis {
    let duration = s.quantity("duration", TIME).positive().required(TIME.name);
    let time_step = s
        .quantity("time_step", TIME)
        .positive()
        .check("a time step that is shorter than the duration", |step| *step <= duration)
        .required(TIME.name);
    let reduced = s.choice("model", &["full", "reduced"]).or("full") == "reduced";
    let unit = |key: &str, low: f64, high: f64, default: f64| {
        s.quantity(key, NUMBER).within(Bound::Included(low), Bound::Included(high)).or(default)
    };
    TransientAnalysis {
        duration,
        time_step,
        scheme: match s.choice("scheme", &["newmark", "hht", "generalised_alpha"]).or("hht") {
            "newmark" => SchemeChoice::Newmark,
            "hht" => SchemeChoice::Hht { alpha: unit("alpha", -1.0 / 3.0, 0.0, -0.05) },
            _ => SchemeChoice::GeneralisedAlpha { rho: unit("rho", 0.0, 1.0, 0.9) },
        },
        model: if reduced { ModelChoice::Reduced } else { ModelChoice::Full },
        compare_steps: reduced.then(|| {
            let steps = s.quantity("compare_steps", NUMBER).non_negative();
            steps.check("a whole number", |n| n.fract() == 0.0).or(COMPARED) as usize
        }),
        full_newton: s.boolean("full_newton").or(false),
        disturbance: s.section("disturbance", |d| Disturbance {
            mode_near: d.quantity("mode_near", FREQUENCY).positive().optional(),
            amplitude: d.quantity("amplitude", LENGTH).positive().required("a length such as \"1 nm\""),
        }),
        push: collect(s, "push", |p| PushedRegion {
            on: p.string("on").required("a region"),
            force: p.quantities("force", FORCE).required("three forces such as [0, \"1 N\", 0]"),
            begin: p.quantity("begin", TIME).non_negative().or(0.0),
            duration: p.quantity("duration", TIME).positive().required(TIME.name),
        }),
        probe: collect(s, "probe", read_probe),
        slide: collect(s, "slide", read_slide),
    }
}

fn read_probe(s: &Section) -> Probe {
    let (on, at) = (s.string("on").optional(), s.quantities("at", LENGTH).optional());
    if s.has("on") == s.has("at") {
        let found = if s.has("on") { "both `on` and `at`" } else { "nothing" };
        s.fault("on", found, "a region `on`, or a place `at` as three lengths", "");
    }
    Probe {
        on,
        at,
        direction: s
            .quantities("direction", NUMBER)
            .check("a vector that is not zero", |v| v.iter().any(|x| *x != 0.0))
            .required("a vector such as [1, 0, 0]"),
    }
}

fn read_slide(s: &Section) -> Slide {
    match s.choice("motion", &["ramp", "reciprocating", "table"]).required("ramp, reciprocating or table") {
        "reciprocating" => Slide::Reciprocating {
            frequency: s.quantity("frequency", FREQUENCY).positive().required(FREQUENCY.name),
            phase: s.quantity("phase", ANGLE).or(0.0),
        },
        "table" => {
            let time = s
                .quantity_list("time", TIME)
                .check("times in ascending order", |t| !t.is_empty() && t.windows(2).all(|w| w[0] < w[1]))
                .required("a list of times");
            let factor = s
                .quantity_list("factor", NUMBER)
                .check("one factor a time", |f| f.len() == time.len())
                .required("a list of factors, one a time");
            Slide::Table { time, factor }
        }
        _ => Slide::Ramp {
            from: s.quantity("from", NUMBER).or(0.0),
            duration: s.quantity("duration", TIME).positive().required(TIME.name),
        },
    }
}
