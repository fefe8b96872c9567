//! `[transient]`: motion in time.

use super::sound::SoundAnalysis;
use crate::schema::raw::MOST;
use crate::schema::units::{ANGLE, FORCE, FREQUENCY, LENGTH, NUMBER, TIME};
use crate::schema::{Report, choices, declare, key, variants};
use std::collections::BTreeMap;
use std::ops::Bound;

/// `contact_tolerance` where it is not given.
pub const CONTACT_TOLERANCE: f64 = 0.1;
/// Steps of a run.
const MOST_STEPS: f64 = 1e8;
/// The shortest time step with sound \[s\]: one of 200 to a period of 50 kHz, far beyond what is heard.
const SHORTEST_HEARD: f64 = 1e-7;

declare! {
    /// A run in time from steady sliding.
    pub struct TransientAnalysis, checked by check {
        /// How long \[s\].
        pub duration: f64 = key::quantity(TIME).positive(),
        /// Δt \[s\].
        pub time_step: f64 = key::quantity(TIME).positive(),
        /// The relative error of frequencies beyond which a step is split into shorter ones; none are when absent.
        pub tolerance: Option<f64> =
            key::quantity(NUMBER).within(Bound::Excluded(0.0), Bound::Excluded(1.0)).optional(),
        /// The integrator.
        pub scheme: SchemeChoice = key::flat(),
        /// The full finite-element model, or one reduced to its modes and the responses to its contacts.
        pub model: Option<ModelChoice> =
            key::choice().optional().or_by("reduced with more than 500 contact points, full with fewer", None),
        /// How many steps of a reduced model are compared with the full one; by itself only one of up to 500 contact points is.
        pub compare_steps: Option<usize> = {
            let full = *model == Some(ModelChoice::Full);
            key::whole(0..=MOST)
                .optional()
                .check("no such key beside the full model", move |steps| !full || steps.is_none())
                .or_by("100 with a reduced model of up to 500 contact points", None)
        },
        /// The relative error of the deflections under contact forces up to which a model of more than 500 contact points is reduced.
        pub contact_tolerance: f64 =
            key::quantity(NUMBER).within(Bound::Excluded(0.0), Bound::Excluded(1.0)).or(CONTACT_TOLERANCE),
        /// Newton's method on the whole instead of the condensed step, to compare.
        pub full_newton: bool = key::flag(false),
        /// How often the motion of all nodes is written, to the nearest time step \[s\]; never when absent.
        pub fields_every: Option<f64> = {
            let (step, duration) = (*time_step, *duration);
            key::quantity(TIME)
                .check("a time between the time step and the duration", move |t| (step..=duration).contains(t))
                .optional()
        },
        /// Initial state of the motion.
        pub start: StartChoice = key::choice().or(StartChoice::Steady),
        /// What contacts keep in motion that a load closes.
        pub hold: Option<HoldChoice> = key::choice().optional().or_by("load of a contact with `load.NAME`, approach of the others", None),
        /// Initial disturbance.
        pub disturbance: Option<Disturbance> = key::table().optional(),
        /// Pushes by name.
        pub push: BTreeMap<String, PushedRegion> = key::named(),
        /// Where the motion is recorded, by name.
        pub probe: BTreeMap<String, Probe> = key::named(),
        /// How the counter-body of a contact slides, by the contact's name; constantly where it is not named.
        pub slide: BTreeMap<String, Slide> = key::named(),
        /// How a force, or the load that closes a contact, runs in time, by its name.
        pub load: BTreeMap<String, Course> = key::named(),
        /// How loud it is, if asked for.
        pub sound: Option<SoundAnalysis> = key::table().optional(),
    }
}

impl TransientAnalysis {
    /// Whether a reduced model moves: where the case does not say, of contacts of many points.
    pub fn is_reduced(&self, many_points: bool) -> bool {
        self.model.map_or(many_points, |model| model == ModelChoice::Reduced)
    }

    /// What a contact keeps in motion that a load closes. Where the case does not say: a load that runs in time is a device whose
    /// motion is known by its force; a constant one only says where the bodies stand, as in the complex eigenvalues.
    pub fn hold_of(&self, contact: &str) -> HoldChoice {
        let runs = self.load.contains_key(contact);
        self.hold.unwrap_or(if runs { HoldChoice::Load } else { HoldChoice::Approach })
    }
}

fn check(run: &TransientAnalysis, report: &mut Report) {
    let TransientAnalysis { duration, time_step, .. } = *run;
    let mut refuse = |found: String, expected: String| report.fault("time_step", found, expected, "");
    if time_step > duration {
        refuse(format!("{time_step:?}"), "a time step that is shorter than the duration".into());
    }
    if duration > MOST_STEPS * time_step {
        let fewest = duration / MOST_STEPS;
        let expected = format!("{fewest:e} s or more, as a run has {MOST_STEPS:e} steps at most");
        refuse(format!("{time_step:?}"), expected);
    }
    if run.sound.is_some() && time_step > 0.0 && time_step < SHORTEST_HEARD {
        let expected = format!("{SHORTEST_HEARD:e} s or more beside [transient.sound]");
        refuse(format!("{time_step:e} s"), expected);
    }
}

choices! {
    /// Initial state of a run in time.
    pub enum StartChoice {
        /// Steady sliding at the velocities and loads of t = 0.
        Steady = "steady",
        /// Equilibrium without friction: nothing has slid yet. Friction that acts at t = 0 accelerates the structure at once.
        Rest = "rest",
    }
}

choices! {
    /// What a contact keeps in motion that a `load` closes; one with an `approach` always keeps that. Without this key a contact with
    /// `[transient.load.NAME]` keeps its load, and one with a constant load the approach.
    pub enum HoldChoice {
        /// The approach at which it carries its load at rest, as in the complex eigenvalues: the bodies are clamped together, and
        /// ΣN varies with the motion.
        Approach = "approach",
        /// The load: a device without inertia and friction follows, and ΣN is the load at the end of every step. A contact of
        /// one point then has a constant normal force, so that its friction does not couple modes.
        Load = "load",
    }
}

choices! {
    /// Model that is integrated in time.
    pub enum ModelChoice {
        /// The full finite-element model.
        Full = "full",
        /// The real modes up to `cea.basis_below`, and the residual attachment of contacts and forces.
        Reduced = "reduced",
    }
}

variants! {
    /// The family of integrators.
    #[derive(Copy)]
    pub enum SchemeChoice by tag "scheme" or "hht" {
        /// Newmark's method, β = ¼, γ = ½: no numerical damping.
        Newmark "newmark" {}
        /// Hilber, Hughes & Taylor's method.
        Hht "hht" {
            /// α ∈ \[−1/3, 0\].
            alpha: f64 = key::quantity(NUMBER)
                .within(Bound::Included(-1.0 / 3.0), Bound::Included(0.0))
                .or(-0.05),
        }
        /// Chung & Hulbert's method.
        GeneralisedAlpha "generalised_alpha" {
            /// ρ∞ ∈ \[0, 1\].
            rho: f64 = key::quantity(NUMBER).within(Bound::Included(0.0), Bound::Included(1.0)).or(0.9),
        }
    }
}

declare! {
    /// A complex mode that the motion starts along.
    pub struct Disturbance {
        /// The mode nearest to this frequency \[Hz\], one that grows if any does; the one that grows fastest when absent.
        pub mode_near: Option<f64> = key::quantity(FREQUENCY).positive().optional(),
        /// The largest translation of any node \[m\].
        pub amplitude: f64 = key::quantity(LENGTH).positive().expecting("a length such as \"1 nm\""),
    }
}

declare! {
    /// A half-sine force on a region.
    pub struct PushedRegion {
        /// The region, whose nodes share the force equally.
        pub on: String = key::name("a region"),
        /// The force at its peak \[N\].
        pub force: [f64; 3] = key::quantities(FORCE).expecting("three forces such as [0, \"1 N\", 0]"),
        /// When it begins \[s\].
        pub begin: f64 = key::quantity(TIME).non_negative().or(0.0),
        /// How long it lasts \[s\].
        pub duration: f64 = key::quantity(TIME).positive(),
    }
}

declare! {
    /// A place whose motion is recorded.
    pub struct Probe, checked by check_probe {
        /// A spring, whose force is recorded, as by a load cell; or the motion of …
        pub spring: Option<String> = key::name("the name of a [spring]").optional(),
        /// … a region, the mean of its nodes where it has several …
        pub on: Option<String> = key::name("a region").optional(),
        /// … or a place \[m\], whose nearest node it is.
        pub at: Option<[f64; 3]> = key::quantities(LENGTH).optional(),
        /// The direction of motion.
        pub direction: Option<[f64; 3]> = key::direction().optional(),
        /// Peaks that a sensor in its place measured \[Hz\], to compare.
        pub measured: Vec<f64> = key::quantity_list(FREQUENCY).or(Vec::new()),
    }
}

fn check_probe(probe: &Probe, report: &mut Report) {
    let given = [probe.on.is_some(), probe.at.is_some(), probe.spring.is_some()];
    if given.iter().filter(|given| **given).count() != 1 {
        let found = if given.contains(&true) { "several of `on`, `at` and `spring`" } else { "nothing" };
        report.fault("on", found, "a region `on`, a place `at` as three lengths, or a `spring`", "");
    }
    match (&probe.spring, &probe.direction) {
        (Some(_), Some(_)) => {
            report.fault("direction", "a vector", "none beside a `spring`, which has its own", "");
        }
        (None, None) => report.fault("direction", "nothing", "a vector such as [1, 0, 0]", ""),
        _ => {}
    }
}

declare! {
    /// How a counter-body slides.
    pub struct Slide {
        /// Its velocity, in parts of the contact's `sliding_velocity` or of the speed of its `rotation`.
        pub course: Course = key::flat(),
        /// Whether the contact runs over the mesh of the counter-body, or stays in its place, as one that turns by `rotation` always does.
        pub travels: bool = key::flag(true),
    }
}

variants! {
    /// How something runs in time, as factors of what the case gives for it.
    pub enum Course by tag "motion" {
        /// The whole at all times.
        Constant "constant" {}
        /// Linearly from a part of it to the whole.
        Ramp "ramp" {
            /// The part at the start.
            from: f64 = key::quantity(NUMBER).or(0.0),
            /// How long it takes \[s\].
            duration: f64 = key::quantity(TIME).positive(),
        }
        /// Times cos(2π f t + φ).
        Reciprocating "reciprocating" {
            /// f \[Hz\].
            frequency: f64 = key::quantity(FREQUENCY).positive(),
            /// φ \[rad\].
            phase: f64 = key::quantity(ANGLE).or(0.0),
        }
        /// Linear between given times.
        Table "table" {
            /// Times \[s\], ascending.
            time: Vec<f64> = key::quantity_list(TIME)
                .expecting("a list of times")
                .check("times in ascending order", |t| !t.is_empty() && t.windows(2).all(|w| w[0] < w[1])),
            /// Factors, one a time.
            factor: Vec<f64> = {
                let count = time.len();
                key::quantity_list(NUMBER)
                    .expecting("a list of factors, one a time")
                    .check("one factor a time", move |f| f.len() == count)
            },
        }
    }
}

impl Course {
    /// The least and the greatest factor.
    pub fn range(&self) -> [f64; 2] {
        match self {
            Course::Constant {} => [1.0, 1.0],
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
