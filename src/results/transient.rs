//! A run in time, as plain data.

use super::ReducedCheck;
use crate::linalg::c64;
use crate::signal::{Growth, Peak, Spectrum};
use crate::transient::Work;

/// What is recorded at every step.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// `rim_velocity`, `pad_friction_force`, `heat` …
    pub name: String,
    /// The SI unit.
    pub unit: &'static str,
    /// What it is.
    pub about: String,
    /// One value a step, the start included.
    pub values: Vec<f64>,
}

impl Channel {
    /// `rim velocity [m/s]`.
    pub fn heading(&self) -> String {
        format!("{} [{}]", self.name.replace('_', " "), self.unit)
    }
}

/// A channel over frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectrumOf {
    /// Index of the channel.
    pub channel: usize,
    /// The first and last time of what was analysed \[s\].
    pub window: [f64; 2],
    /// Its spectrum.
    pub spectrum: Spectrum,
    /// The peaks of it.
    pub peaks: Vec<Peak>,
}

/// The growth of a small disturbance beside the complex mode that it started along.
#[derive(Debug, Clone, PartialEq)]
pub struct GrowthCompared {
    /// The complex mode, counted from 0.
    pub mode: usize,
    /// Its λ.
    pub eigenvalue: c64,
    /// What the transient shows while the penetration changes by less than 1 %; `None` when that time is too short.
    pub found: Option<Growth>,
}

/// A run in time.
#[derive(Debug, Clone, PartialEq)]
pub struct TransientResult {
    /// Δt \[s\].
    pub time_step: f64,
    /// The integrator, in words.
    pub scheme: String,
    /// Real modes and attachment shapes of a reduced model; `None` for the full one.
    pub reduced: Option<[usize; 2]>,
    /// A reduced model beside the full one.
    pub reduced_check: Option<ReducedCheck>,
    /// What was recorded.
    pub channels: Vec<Channel>,
    /// The channel that stands for the motion in pictures, and that of friction.
    pub shown: [usize; 2],
    /// Spectra of the second half of the run.
    pub spectra: Vec<SpectrumOf>,
    /// Growth beside the complex eigenvalue.
    pub growth: Option<GrowthCompared>,
    /// All work.
    pub work: Work,
    /// The largest |residual| of the energy balance of a step over the turnover of energy in it.
    pub worst_residual: f64,
    /// Steps that had to be split, and the most parts.
    pub split: (usize, usize),
    /// The share of time in which the most loaded point was open, and in which it slid backwards.
    pub open: f64,
    /// See [`TransientResult::open`].
    pub backwards: f64,
}

impl TransientResult {
    /// Steps recorded, the start included.
    pub fn len(&self) -> usize {
        self.channels.first().map_or(0, |c| c.values.len())
    }

    /// Whether nothing was recorded.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
