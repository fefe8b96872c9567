//! A reduced model beside the full one, as plain data.

use crate::dataset::{Column, Group, column};

/// How far a reduced model is from the full one.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReducedCheck {
    /// Complex modes in the band: of the full model, and those of them that have one of the reduced model beside them.
    pub modes: [usize; 2],
    /// The largest |Δλ|/|λ|.
    pub eigenvalue: Option<Deviation>,
    /// The largest |Δσ|/|σ| of the modes that grow; of the mode nearest to growth when none does. `None` where σ is zero
    /// but for round-off.
    pub growth: Option<Deviation>,
    /// The same motion of both; `None` when it was not requested.
    pub motion: Option<MotionCompared>,
}

/// A deviation and the complex mode of the full model that it belongs to, counted from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// Relative.
    pub relative: f64,
    /// The mode.
    pub mode: usize,
}

/// The first steps of a run in time, of the reduced model and of the full one.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionCompared {
    /// Their number.
    pub steps: usize,
    /// The first probe.
    pub probe: String,
    /// The largest deviation of its displacement, as a part of what that spans; `None` when nothing moved.
    pub displacement: Option<f64>,
    /// The same of the normal force of all contacts.
    pub normal_force: Option<f64>,
}

impl ReducedCheck {
    /// Modes, deviations of eigenvalues and of motion.
    pub(super) fn group(&self) -> Group<'_> {
        let [modes, found] = self.modes;
        let deviation = |key: &'static str, description: &'static str, deviation: Option<&Deviation>| {
            deviation.map(|deviation| Group::of(key, description, &deviation_columns(), deviation))
        };
        let motion = self
            .motion
            .as_ref()
            .map(|motion| Group::of("motion", "the first steps of both models", &motion_columns(), motion));
        Group::new("reduced_check", "the reduced model beside the full one")
            .value("modes", "1", "complex modes of the full model in the band", modes)
            .value("modes_found", "1", "those that the reduced model has, too", found)
            .optional("eigenvalue", deviation("eigenvalue", "largest |Δλ|/|λ|", self.eigenvalue.as_ref()))
            .optional("growth_rate", deviation("growth_rate", "largest |Δσ|/|σ|", self.growth.as_ref()))
            .optional("motion", motion)
    }
}

fn deviation_columns() -> Vec<Column<Deviation>> {
    vec![
        column("relative", "1", "relative deviation", |d: &Deviation| d.relative),
        column("mode", "1", "complex mode of the full model, from 1", |d: &Deviation| d.mode + 1),
    ]
}

fn motion_columns() -> Vec<Column<MotionCompared>> {
    type Motion = MotionCompared;
    vec![
        column("steps", "1", "steps that were compared", |m: &Motion| m.steps),
        column("probe", "text", "the first probe", |m: &Motion| m.probe.clone()),
        column(
            "displacement",
            "1",
            "largest deviation of its displacement over the range of that",
            |m: &Motion| m.displacement,
        ),
        column("normal_force", "1", "the same of the normal force of all contacts", |m: &Motion| {
            m.normal_force
        }),
    ]
}
