//! `[transient]`: motion in time.

use super::read::collect;
use super::reader::Section;
use super::sound::SoundAnalysis;
use super::units::{ANGLE, FORCE, FREQUENCY, LENGTH, NUMBER, TIME};
use serde::Serialize;
use std::collections::BTreeMap;
use std::ops::Bound;

/// Steps of a run.
const MOST_STEPS: f64 = 1e8;
/// The shortest time step with sound \[s\]: one of 200 to a period of 50 kHz, far beyond what is heard.
const SHORTEST_HEARD: f64 = 1e-7;

/// Steps of a reduced model that are compared with the full one, when the case does not say.
const COMPARED: f64 = 100.0;

/// A run in time from steady sliding.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TransientAnalysis {
    /// How long \[s\].
    pub duration: f64,
    /// Δt \[s\].
    pub time_step: f64,
    /// The relative error of frequencies beyond which a step is split into shorter ones; none are when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
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
    /// How often the motion of all nodes is written, to the nearest time step \[s\]; never when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fields_every: Option<f64>,
    /// What the motion begins with.
    pub start: StartChoice,
    /// What disturbs it at the start.
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
    /// How a force, or the load that closes a contact, runs in time, by its name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub load: BTreeMap<String, Course>,
    /// How loud it is, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sound: Option<SoundAnalysis>,
}

/// What a run in time begins with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum StartChoice {
    /// Steady sliding at the velocities and loads of t = 0.
    Steady,
    /// Equilibrium without friction: nothing has slid yet.
    Rest,
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
    /// A spring, whose force is recorded, as by a load cell; or the motion of …
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spring: Option<String>,
    /// … a region, the mean of its nodes where it has several …
    #[serde(skip_serializing_if = "Option::is_none")]
    pub on: Option<String>,
    /// … or a place \[m\], whose nearest node it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
    /// The direction of motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// Peaks that a sensor in its place measured \[Hz\], to compare.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub measured: Vec<f64>,
}

/// How a counter-body slides.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Slide {
    /// Its velocity, in parts of the contact's `sliding_velocity`.
    #[serde(flatten)]
    pub course: Course,
    /// Whether the contact runs over the mesh of the counter-body, or stays in its place.
    pub travels: bool,
}

/// How something runs in time, as factors of what the case gives for it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "motion", rename_all = "snake_case")]
pub enum Course {
    /// The whole at all times.
    Constant,
    /// Linearly from a part of it to the whole.
    Ramp {
        /// The part at the start.
        from: f64,
        /// How long it takes \[s\].
        duration: f64,
    },
    /// Times cos(2π f t + φ).
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

impl Course {
    /// The least and the greatest factor.
    pub fn range(&self) -> [f64; 2] {
        match self {
            Course::Constant => [1.0, 1.0],
            Course::Ramp { from, .. } => [from.min(1.0), from.max(1.0)],
            Course::Reciprocating { .. } => [-1.0, 1.0],
            Course::Table { factor, .. } => {
                let ends = factor
                    .iter()
                    .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], f| [low.min(*f), high.max(*f)]);
                if factor.is_empty() { [1.0, 1.0] } else { ends }
            }
        }
    }
}

pub(super) fn read(s: &Section) -> TransientAnalysis {
    let duration = s.quantity("duration", TIME).positive().required(TIME.name);
    let fewest = format!("{:e} s or more, as a run has {MOST_STEPS:e} steps at most", duration / MOST_STEPS);
    let time_step = s
        .quantity("time_step", TIME)
        .positive()
        .check("a time step that is shorter than the duration", |step| *step <= duration)
        .check(&fewest, |step| duration <= MOST_STEPS * step)
        .required(TIME.name);
    if s.has("sound") && time_step > 0.0 && time_step < SHORTEST_HEARD {
        let expected = format!("{SHORTEST_HEARD:e} s or more beside [transient.sound]");
        s.fault("time_step", format!("{time_step:e} s"), expected, "");
    }
    let reduced = s.choice("model", &["full", "reduced"]).or("full") == "reduced";
    let unit = |key: &str, low: f64, high: f64, default: f64| {
        s.quantity(key, NUMBER).within(Bound::Included(low), Bound::Included(high)).or(default)
    };
    TransientAnalysis {
        duration,
        time_step,
        tolerance: s
            .quantity("tolerance", NUMBER)
            .within(Bound::Excluded(0.0), Bound::Excluded(1.0))
            .optional(),
        scheme: match s.choice("scheme", &["newmark", "hht", "generalised_alpha"]).or("hht") {
            "newmark" => SchemeChoice::Newmark,
            "hht" => SchemeChoice::Hht { alpha: unit("alpha", -1.0 / 3.0, 0.0, -0.05) },
            _ => SchemeChoice::GeneralisedAlpha { rho: unit("rho", 0.0, 1.0, 0.9) },
        },
        model: if reduced { ModelChoice::Reduced } else { ModelChoice::Full },
        compare_steps: reduced.then(|| {
            let steps =
                s.quantity("compare_steps", NUMBER).within(Bound::Included(0.0), Bound::Included(1e9));
            steps.check("a whole number", |n| n.fract() == 0.0).or(COMPARED) as usize
        }),
        full_newton: s.boolean("full_newton").or(false),
        start: match s.choice("start", &["steady", "rest"]).or("steady") {
            "rest" => StartChoice::Rest,
            _ => StartChoice::Steady,
        },
        fields_every: s
            .quantity("fields_every", TIME)
            .check("a time between the time step and the duration", |t| (time_step..=duration).contains(t))
            .optional(),
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
        load: collect(s, "load", read_course),
        sound: s.section("sound", super::sound::read),
    }
}

fn read_probe(s: &Section) -> Probe {
    let (on, at) = (s.string("on").optional(), s.quantities("at", LENGTH).optional());
    let spring = s.string("spring").optional();
    let given = ["on", "at", "spring"].map(|key| s.has(key));
    if given.iter().filter(|given| **given).count() != 1 {
        let found = if given.contains(&true) { "several of `on`, `at` and `spring`" } else { "nothing" };
        s.fault("on", found, "a region `on`, a place `at` as three lengths, or a `spring`", "");
    }
    let direction = s.direction("direction");
    let direction = if spring.is_some() {
        direction.optional()
    } else {
        Some(direction.required("a vector such as [1, 0, 0]"))
    };
    if spring.is_some() && direction.is_some() {
        s.fault("direction", "a vector", "none beside a `spring`, which has its own", "");
    }
    let measured = s.quantity_list("measured", FREQUENCY).or(Vec::new());
    Probe { spring, on, at, direction, measured }
}

fn read_slide(s: &Section) -> Slide {
    Slide { course: read_course(s), travels: s.boolean("travels").or(true) }
}

fn read_course(s: &Section) -> Course {
    const MOTIONS: [&str; 4] = ["constant", "ramp", "reciprocating", "table"];
    match s.choice("motion", &MOTIONS).required("constant, ramp, reciprocating or table") {
        "constant" => Course::Constant,
        "reciprocating" => Course::Reciprocating {
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
            Course::Table { time, factor }
        }
        _ => Course::Ramp {
            from: s.quantity("from", NUMBER).or(0.0),
            duration: s.quantity("duration", TIME).positive().required(TIME.name),
        },
    }
}

#[cfg(test)]
mod tests {
    use crate::case::Case;

    fn faults(transient: &str) -> String {
        let text = format!("[cea]\nband = [0, 1]\n[transient]\n{transient}");
        Case::parse("case.toml", &text, ".".into()).unwrap_err().to_string()
    }

    #[test]
    fn steps_without_number_are_refused() {
        let text = faults("duration = 1e3\ntime_step = 1e-6");
        assert!(text.contains("1e-5 s or more, as a run has 1e8 steps at most"), "{text}");
        let text = faults("duration = 1e-9\ntime_step = \"1e-10 us\"\n[transient.sound]\ndistance = 2000");
        assert!(text.contains("found 1e-16 s; expected 1e-7 s or more beside [transient.sound]"), "{text}");
        assert!(text.contains("transient.sound.distance") && text.contains("1 km at most"), "{text}");
        let text = faults("duration = 1e-9\ntime_step = \"1e-10 us\"");
        assert!(!text.contains("time_step"), "{text}");
    }
}
