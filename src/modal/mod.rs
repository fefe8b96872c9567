//! Real modes of the structure, without friction: K φ = ω² M φ.
//!
//! * [`compute`]: the modes up to a frequency, with the count that proves that none is missing.
//! * [`Disc`]: a plate that is a disc, whose modes have names; [`DiscPoints`]: the names, from the transverse displacement.
//! * [`modal_damping`]: C = M Φ diag(2ζω) Φᵀ M; [`damping_ratios`]: ζ of every mode by all damping.
//! * [`near`]: the mode that a frequency means; [`given_ratios`]: damping ratios that are given by frequency.
//! * [`levels`]: which of them are the two of a double mode.
//! * [`effective_mass`]: how much of the mass a mode moves along a direction.

mod compute;
mod damping;
mod disc;
mod effective_mass;
mod levels;
mod naming;
mod near;
#[cfg(test)]
pub(crate) mod samples;

pub use compute::{ModesWanted, ShiftedStiffness, compute, compute_from, real_modes};
pub use damping::{damping_ratios, modal_damping};
pub use disc::Disc;
pub use effective_mass::{EffectiveMass, effective_mass};
pub use levels::levels;
pub use naming::DiscPoints;
pub use near::{GivenRatios, NEAR, given_ratios, near};

use faer::Mat;

/// Real modes, ascending in frequency, with the proof that none is missing.
#[derive(Debug, Clone)]
pub struct RealModes {
    /// ω² \[rad²/s²\], ascending; rigid-body modes are those counted by `rigid_bodies`, with ω² set as computed.
    pub eigenvalues: Vec<f64>,
    /// Mass-normalised shapes φᵀMφ = 1, one a column, n_dofs × n_modes.
    pub shapes: Mat<f64>,
    /// ‖Kφ − ω²Mφ‖ / ((‖K‖ + |ω²| ‖M‖) ‖φ‖), one a mode.
    pub backward_errors: Vec<f64>,
    /// How many of the first modes are rigid-body motions.
    pub rigid_bodies: usize,
    /// How many of the first modes have ω² < 0 beyond rounding: the state is unstable, as that of a structure loaded beyond its
    /// buckling load is, and leaves it as exp(√(−ω²) t).
    pub negative: usize,
    /// The Sturm count.
    pub certificate: SturmCertificate,
}

/// The number of modes below a frequency, *counted* by the inertia of K − ω²M (Sylvester's law), at two nearby
/// shifts, and compared with the number found.
#[derive(Debug, Clone, PartialEq)]
pub struct SturmCertificate {
    /// The frequency up to which the count holds \[Hz\].
    pub below_hz: f64,
    /// The two shifts at which the inertia was taken \[Hz\], either side of `below_hz` with no mode between.
    pub shifts_hz: [f64; 2],
    /// Negative pivots at each shift.
    pub counted: [usize; 2],
    /// Modes found below `below_hz`.
    pub found: usize,
}

impl SturmCertificate {
    /// Whether no mode is missing.
    pub fn holds(&self) -> bool {
        self.counted == [self.found; 2]
    }
}

impl RealModes {
    /// Natural frequency of mode `k` \[Hz\]; 0 where ω² is negative, as by round-off of a rigid-body mode, or really (`negative`).
    pub fn frequency_hz(&self, k: usize) -> f64 {
        self.eigenvalues[k].max(0.0).sqrt() / std::f64::consts::TAU
    }

    /// The lowest modes that `wanted` asks for, if all of them are here. The certificate stays that of the whole set:
    /// none is missing up to its frequency.
    pub fn lowest(&self, wanted: ModesWanted) -> Option<RealModes> {
        let count = match wanted {
            ModesWanted::BelowHz(hz) => (hz <= self.certificate.below_hz)
                .then(|| (0..self.len()).take_while(|k| self.frequency_hz(*k) < hz).count()),
            ModesWanted::Count(count) => (count <= self.len()).then_some(count),
        }?;
        Some(RealModes {
            eigenvalues: self.eigenvalues[..count].to_vec(),
            shapes: self.shapes.subcols(0, count).to_owned(),
            backward_errors: self.backward_errors[..count].to_vec(),
            rigid_bodies: self.rigid_bodies.min(count),
            negative: self.negative.min(count),
            certificate: self.certificate.clone(),
        })
    }

    /// The number of modes.
    pub fn len(&self) -> usize {
        self.eigenvalues.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.eigenvalues.is_empty()
    }
}

/// The name of a disc's bending mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DiscModeName {
    /// n: lines through the centre on which the disc is at rest.
    pub nodal_diameters: usize,
    /// s: circles on which the disc is at rest, a clamped hub not counted.
    pub nodal_circles: usize,
}
