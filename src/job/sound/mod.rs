//! How loud a run in time is.
//!
//! [`ears`] looks at the case before anything is computed: which plates are heard, from where. A [`Listener`] takes the
//! accelerations of the run, step by step, and gives the [`crate::results::Sound`] in the end.

mod ears;
mod listener;
#[cfg(test)]
mod tests;

pub use ears::{Ears, ears};
pub use listener::Listener;
