//! How complex eigenvalues answer the scalars of the case and small things mounted on its nodes, as plain data.

use crate::dataset::{Column, Describe, Dimension, Group, Table, Values, Variable, column};
use crate::linalg::c64;
use crate::numbers::{given, power, significant};
use std::f64::consts::TAU;

/// The sensitivities of the chosen complex modes.
#[derive(Debug, Clone, Default)]
pub struct SensitivityResult {
    /// The chosen modes, ascending in frequency.
    pub modes: Vec<ModeSensitivity>,
    /// Requested scalars that have no derivative, with the reason.
    pub left_out: Vec<(String, String)>,
}

/// One complex mode: what it answers to.
#[derive(Debug, Clone)]
pub struct ModeSensitivity {
    /// Index into the complex modes.
    pub mode: usize,
    /// λ = σ + iω \[1/s\].
    pub eigenvalue: c64,
    /// Every scalar, that which moves the growth rate most by a hundredth of itself first.
    pub parameters: Vec<ParameterRate>,
    /// Effect of small additions at each node.
    pub advice: Option<AdviceField>,
    /// The best place for a mass, and for a damper.
    pub best: Vec<Mounted>,
}

/// dλ/dp of one scalar.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterRate {
    /// Its path in the case.
    pub path: String,
    /// Its value \[SI\].
    pub value: f64,
    /// Its SI unit; empty for a pure number.
    pub unit: String,
    /// dσ/dp + i dω/dp \[1/s per unit\].
    pub rate: c64,
    /// Estimated |error| of the rate.
    pub error: f64,
    /// Whether the slopes to the two sides differ; the rate is their mean.
    pub kink: bool,
    /// |λ| \[1/s\].
    pub size: f64,
}

impl ParameterRate {
    /// df/dp \[Hz per unit\].
    pub fn frequency_rate(&self) -> f64 {
        self.rate.im / TAU
    }

    /// Change of the growth rate when the scalar grows by 1 % \[1/s\].
    pub fn growth_per_percent(&self) -> f64 {
        0.01 * self.value * self.rate.re
    }

    /// Whether a change of σ or ω by 1 % of the scalar \[1/s\] is more than rounding of λ.
    fn is_more_than_rounding(&self, change: f64) -> bool {
        const ROUNDING: f64 = 1e-14;
        change.abs() > ROUNDING * self.size
    }

    /// Whether the scalar moves the growth rate by more than rounding and the error of the slope.
    pub fn moves_growth(&self) -> bool {
        let change = self.growth_per_percent();
        self.is_more_than_rounding(change) && change.abs() > 0.01 * (self.value * self.error).abs()
    }

    /// `value`, a multiple of a part of the rate, with so many digits; zero where the change by 1 % is rounding.
    fn shown(&self, part: f64, value: f64, digits: usize) -> String {
        let nothing = self.value != 0.0 && !self.is_more_than_rounding(0.01 * self.value * part);
        significant(if nothing { 0.0 } else { value }, digits)
    }

    /// Change of the frequency when the scalar grows by 1 % \[Hz\].
    pub fn frequency_per_percent(&self) -> f64 {
        0.01 * self.value * self.frequency_rate()
    }
}

/// dλ per unit of a thing mounted at each node of the structure as it slides steadily; zero at nodes that are held.
#[derive(Debug, Clone, Default)]
pub struct AdviceField {
    /// Point mass \[1/(s kg)\].
    pub mass: Vec<c64>,
    /// Spring to the ground along x, y, z and the surface's normal \[1/s per N/m\].
    pub stiffness: Vec<[c64; 4]>,
    /// Damper to the ground along x, y, z and the surface's normal \[1/s per N s/m\].
    pub damping: Vec<[c64; 4]>,
}

/// A thing at the place where it calms a mode most.
#[derive(Debug, Clone)]
pub struct Mounted {
    /// `mass` or `damper`.
    pub kind: &'static str,
    /// How much of it \[kg or N s/m\].
    pub amount: f64,
    /// The unit of the amount.
    pub unit: &'static str,
    /// The node.
    pub node: usize,
    /// Where that is \[m\].
    pub position: [f64; 3],
    /// Along which a damper acts.
    pub direction: Option<[f64; 3]>,
    /// Change of λ by the slope \[1/s\].
    pub predicted: c64,
    /// Change of λ when it is mounted on the model and everything is recomputed; where it differs from `predicted` the
    /// thing is too large for a slope.
    pub done: Option<c64>,
    /// How far the change by a thousandth of it, really mounted, is from the slope, relative to it.
    pub slope_error: Option<f64>,
}

fn rate_columns() -> Vec<Column<ParameterRate>> {
    type Rate = ParameterRate;
    let error = |rate: &Rate| {
        let relative = if rate.rate.norm() > 0.0 { rate.error / rate.rate.norm() } else { 0.0 };
        if rate.kink { format!("{} †", power(relative)) } else { power(relative) }
    };
    vec![
        column("parameter", "text", "path of the scalar p in the case", |p: &Rate| p.path.clone())
            .shown("scalar", |p| p.path.clone()),
        column("value", "unit", "its value", |p: &Rate| p.value).shown("value", |p| given(p.value)),
        column("unit", "text", "its SI unit", |p: &Rate| p.unit.clone()).shown("unit", |p| p.unit.clone()),
        column("growth_per_percent", "1/s", "change of σ when p grows by 1 %", Rate::growth_per_percent)
            .shown("σ per 1 % [1/s]", |p| p.shown(p.rate.re, p.growth_per_percent(), 3)),
        column(
            "frequency_per_percent",
            "Hz",
            "change of the frequency when p grows by 1 %",
            Rate::frequency_per_percent,
        )
        .shown("f per 1 % [Hz]", |p| p.shown(p.rate.im, p.frequency_per_percent(), 3)),
        column("error", "1/s per unit", "estimated |error| of dλ/dp", |p: &Rate| p.error)
            .shown("error", error),
        column("dsigma_dp", "1/s per unit", "dσ/dp", |p: &Rate| p.rate.re)
            .shown("dσ/dp", |p| p.shown(p.rate.re, p.rate.re, 4)),
        column("dfrequency_dp", "Hz per unit", "df/dp", Rate::frequency_rate)
            .shown("df/dp", |p| p.shown(p.rate.im, p.frequency_rate(), 4)),
        column(
            "kink",
            "1",
            "whether the slopes to the two sides differ; the rate is their mean",
            |p: &Rate| p.kink,
        ),
    ]
}

fn mounted_columns() -> Vec<Column<Mounted>> {
    vec![
        column("kind", "text", "mass or damper", |m: &Mounted| m.kind),
        column("amount", "unit", "how much of it", |m: &Mounted| m.amount),
        column("unit", "text", "unit of the amount", |m: &Mounted| m.unit),
        column("node", "1", "index of the node, from 0", |m: &Mounted| m.node),
        column("position_m", "m", "position", |m: &Mounted| m.position).along(Dimension::axes()),
        column("direction", "1", "along which a damper acts", |m: &Mounted| m.direction)
            .along(Dimension::axes()),
        column("predicted_growth_rate", "1/s", "change of σ by the slope", |m: &Mounted| m.predicted.re),
        column("predicted_frequency_hz", "Hz", "change of the frequency by the slope", |m: &Mounted| {
            m.predicted.im / TAU
        }),
        column("done_growth_rate", "1/s", "change of σ, mounted and recomputed", |m: &Mounted| {
            m.done.map(|change| change.re)
        }),
        column(
            "done_frequency_hz",
            "Hz",
            "change of the frequency, mounted and recomputed",
            |m: &Mounted| m.done.map(|change| change.im / TAU),
        ),
        column(
            "slope_error",
            "1",
            "relative error of the slope, by a thousandth of the amount",
            |m: &Mounted| m.slope_error,
        ),
    ]
}

impl ModeSensitivity {
    /// The scalars, one a row.
    pub(crate) fn rates(&self) -> Table<'static> {
        let file = format!("sensitivities_mode_{}", self.mode + 1);
        Table::by("parameters", "parameter", &rate_columns(), &self.parameters).file(file)
    }

    fn group(&self) -> Group<'_> {
        let group = Group::new(format!("mode {}", self.mode + 1), "derivatives of a complex eigenvalue λ")
            .value("mode", "1", "number of the complex mode, from 1", self.mode + 1)
            .value("frequency_hz", "Hz", "ω/2π", self.eigenvalue.im / TAU)
            .value("growth_rate", "1/s", "σ", self.eigenvalue.re)
            .table(self.rates())
            .table(Table::of("best", "thing", &mounted_columns(), &self.best));
        let Some(advice) = &self.advice else { return group };
        let nodes = Dimension::indexed("node", advice.mass.len());
        let along = Dimension::named("along", &["x", "y", "z", "normal"]);
        let mass = Values::ComplexRows(Box::new(|node| vec![advice.mass[node]]));
        let spring = Values::ComplexRows(Box::new(|node| advice.stiffness[node].to_vec()));
        let damper = Values::ComplexRows(Box::new(|node| advice.damping[node].to_vec()));
        let both = vec![nodes.clone(), along];
        group
            .with(Variable::new("point_mass", "1/(s kg)", "dλ/dm of a point mass", vec![nodes], mass))
            .with(Variable::new(
                "point_spring",
                "1/s per N/m",
                "dλ/dk of a spring to the ground",
                both.clone(),
                spring,
            ))
            .with(Variable::new(
                "point_damper",
                "1/s per N s/m",
                "dλ/dc of a damper to the ground",
                both,
                damper,
            ))
    }
}

impl Describe for SensitivityResult {
    fn describe(&self) -> Group<'_> {
        let left_out = [
            column("parameter", "text", "path of the scalar", |(path, _): &(String, String)| path.clone()),
            column("reason", "text", "why it has no derivative", |(_, reason): &(String, String)| {
                reason.clone()
            }),
        ];
        Group::new(
            "sensitivity",
            "how complex eigenvalues answer scalars of the case and things mounted on its nodes",
        )
        .list("modes", self.modes.iter().map(ModeSensitivity::group).collect())
        .table(Table::by("left_out", "parameter", &left_out, &self.left_out))
    }
}

impl SensitivityResult {}
