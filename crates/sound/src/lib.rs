//! How loud vibrating plates are: Rayleigh's integral.
//!
//! A plate that moves with the acceleration a(x, t) along its normal sends into the half-space in front of it
//!
//! p(r, t) = ρ₀/(2π) ∫ a(x, t − R/c) dA / R, R = |r − x|,
//!
//! and the opposite behind it, as if it were set in a rigid plane baffle without end (Lord Rayleigh, *The Theory of
//! Sound*, vol. 2, 1896, § 278). Several plates are each in a baffle of their own; their pressures are added at a
//! microphone, their powers in the sum. What this leaves out:
//!
//! * without the baffle air flows round the edges from the front to the back: below the frequency at which bending
//!   waves are as fast as sound a free plate is quieter, so that the figures are an upper estimate there;
//! * nothing is reflected or shaded: no floor, no room, no other part of the rig;
//! * air neither loads nor damps the plates, and the sound of one does not move another;
//! * bars and edges are silent; of solids flat faces are heard, each on its outer side only.
//!
//! Plates move in modes, so that everything is linear in the modal accelerations q̈: [`Receiver`] gives the pressure at
//! a point, step by step, [`Radiation`] the resistance that gives the power of [`CrossSpectra`]. [`a_weighting`] and
//! the levels are those of IEC 61672-1. [`wav`] makes the pressure audible. A [`SoundAccumulator`] does all of it during a run and
//! gives the [`Sound`] in the end.

mod accumulator;
mod cross;
mod levels;
mod loud;
mod plate;
mod radiation;
mod receiver;
mod surface;
mod wav;
mod weighting;

pub use accumulator::{Acoustics, BLOCK, SoundAccumulator};
pub use cross::CrossSpectra;
pub use levels::{MicrophoneSound, PressureRecord, Sound, Tone};
pub use loud::LoudHalf;
pub use plate::Plate;
pub use radiation::Radiation;
pub use receiver::Receiver;
pub use surface::Surface;
pub use wav::wav;
pub use weighting::{a_weighting, power_level, pressure_level};

/// Properties of the air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// ρ₀ \[kg/m³\].
    pub density: f64,
    /// c \[m/s\].
    pub speed: f64,
}

impl Default for Air {
    /// 20 °C at sea level.
    fn default() -> Self {
        Air { density: 1.204, speed: 343.0 }
    }
}
