//! How complex eigenvalues answer the scalars of the case and small things mounted on its nodes, as plain data.

use crate::linalg::c64;
use std::f64::consts::TAU;

/// The sensitivities of the chosen complex modes.
#[derive(Debug, Clone, Default)]
pub struct SensitivityResult {
    /// The chosen modes, ascending in frequency.
    pub modes: Vec<ModeSensitivity>,
    /// Scalars that were asked for and have no derivative, with the reason.
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
    /// What a thing mounted at each node does.
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
    /// Change of λ when it is really mounted and everything is computed anew; where it differs from `predicted` the
    /// thing is too large for a slope.
    pub done: Option<c64>,
    /// How far the change by a thousandth of it, really mounted, is from the slope, relative to it.
    pub slope_error: Option<f64>,
}
