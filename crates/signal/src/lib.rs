//! Analysis of a record of motion: its spectrum, its peaks and their relations, its growth, its spectrogram, its final
//! amplitude.

mod akima;
mod growth;
mod hann;
mod harmonics;
mod limit_cycle;
mod peaks;
mod resample;
mod spectrogram;
mod spectrum;

pub use akima::akima;
pub use growth::{Growth, growth};
pub use hann::{Hann, NOISE_BANDWIDTH};
pub use harmonics::Tones;
pub use limit_cycle::{LimitCycle, limit_cycle};
pub use peaks::{Peak, peaks};
pub use resample::Resampler;
pub use spectrogram::{ShortTime, Spectrogram, spectrogram};
pub use spectrum::{Spectrum, Welch, spectrum};
