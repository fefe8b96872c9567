//! How loud a run in time is.
//!
//! [`acoustics`] checks the case before anything is computed: which plates radiate, where the microphones are. A [`SoundAccumulator`] takes the
//! accelerations of the modes, as they are read back from the record, and gives the [`crate::results::Sound`] in the end.

mod accumulator;
mod acoustics;
#[cfg(test)]
mod tests;

pub use accumulator::{BLOCK, SoundAccumulator};
pub use acoustics::{Acoustics, acoustics};
