//! How loud a run in time is.
//!
//! [`acoustics`] checks the case before anything is computed: which plates radiate, where the microphones are. A [`Listener`] takes the
//! accelerations of the modes, as they are read back from the record, and gives the [`crate::results::Sound`] in the end.

mod acoustics;
mod listener;
#[cfg(test)]
mod tests;

pub use acoustics::{Acoustics, acoustics};
pub use listener::{BLOCK, Listener};
