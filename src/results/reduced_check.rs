//! A reduced model beside the full one, as plain data.

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
    /// The same motion of both; `None` when it was not asked for.
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
