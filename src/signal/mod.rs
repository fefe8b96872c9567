//! What a record of motion says: its spectrum, its peaks and what they are of each other, how it grows.

mod growth;
mod peaks;
mod spectrum;

pub use growth::{Growth, growth};
pub use peaks::{Peak, name_peaks, peaks};
pub use spectrum::{Spectrum, spectrum};
