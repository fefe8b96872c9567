//! Analysis of a record of motion: its spectrum, its peaks and their relations, its growth, its spectrogram, its final
//! amplitude.

mod growth;
mod hann;
mod limit_cycle;
mod peaks;
mod resample;
mod spectrogram;
mod spectrum;

pub use growth::{Growth, growth};
pub use hann::{Hann, NOISE_BANDWIDTH};
pub use limit_cycle::{LimitCycle, limit_cycle};
pub use peaks::{Peak, name_peaks, peaks};
pub use resample::Resampler;
pub use spectrogram::{ShortTime, Spectrogram, spectrogram};
pub use spectrum::{Spectrum, Welch, spectrum};
