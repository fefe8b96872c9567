//! How loud a run in time is.

use super::{Air, a_weighting, power_level, pressure_level};
use stridor_signal::{Peak, Spectrum};

/// Sound of the plates over the steady part of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Sound {
    /// The first and last time of what the levels are taken from \[s\].
    pub window: [f64; 2],
    /// Air around the plates.
    pub air: Air,
    /// Δf \[Hz\]: line k stands at k Δf. The last line is the highest frequency that counts.
    pub resolution_hz: f64,
    /// Each plate's name, and the power \[W\] that it sends out in each line, both sides.
    pub plates: Vec<(String, Vec<f64>)>,
    /// The share of each real mode in the power; negative for a mode that absorbs power radiated by others.
    pub mode_shares: Vec<f64>,
    /// A few words on each of these modes, once they are named.
    pub mode_names: Vec<String>,
    /// The peaks of the power, strongest lines of it: amplitude² is their height in W.
    pub tones: Vec<Tone>,
    /// Pressure at each microphone.
    pub microphones: Vec<MicrophoneSound>,
}

/// A peak of the sound power.
#[derive(Debug, Clone, PartialEq)]
pub struct Tone {
    /// Where it is, and what it is of stronger ones; its amplitude is the root of its highest line \[√W\].
    pub peak: Peak,
    /// The power of the five lines about it \[W\].
    pub power: f64,
    /// Its part of the whole.
    pub share: f64,
}

/// Sound pressure at a microphone.
#[derive(Debug, Clone, PartialEq)]
pub struct MicrophoneSound {
    /// Its name.
    pub name: String,
    /// Where it stands \[m\].
    pub at: [f64; 3],
    /// The pressure over frequency \[Pa\], as many lines as the power has.
    pub spectrum: Spectrum,
    /// The pressure over time.
    pub recording: PressureRecord,
}

/// Pressure at a microphone as an audio record.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PressureRecord {
    /// The time of the first sample \[s\].
    pub begin: f64,
    /// Samples a second.
    pub rate: u32,
    /// p \[Pa\].
    pub pressure: Vec<f64>,
}

/// The part of the full scale that the loudest moment of a recording reaches.
const LOUDEST: f64 = 0.9;

impl Sound {
    /// The frequency of line k \[Hz\].
    pub fn frequency_hz(&self, k: usize) -> f64 {
        k as f64 * self.resolution_hz
    }

    /// The power of all plates in line k \[W\].
    pub fn power(&self, k: usize) -> f64 {
        self.plates.iter().map(|(_, lines)| lines[k]).sum()
    }

    /// The number of lines.
    pub fn lines(&self) -> usize {
        self.plates.first().map_or(0, |(_, lines)| lines.len())
    }

    /// The whole sound power level in dB re 1 pW and, A-weighted, in dB(A).
    pub fn power_levels(&self) -> [f64; 2] {
        let sum = |weight: &dyn Fn(f64) -> f64| -> f64 {
            (0..self.lines()).map(|k| weight(self.frequency_hz(k)).powi(2) * self.power(k)).sum()
        };
        [power_level(sum(&|_| 1.0)), power_level(sum(&a_weighting))]
    }

    /// Gives each tone the relation of the nearest of the named peaks of the motion, within a line: power has no phase of its own.
    pub fn name_tones<'p>(&mut self, peaks: impl Iterator<Item = &'p Peak>) {
        let named: Vec<&Peak> = peaks.filter(|peak| !peak.relation.is_empty()).collect();
        for tone in &mut self.tones {
            let away = |peak: &&&Peak| (peak.frequency_hz - tone.peak.frequency_hz).abs();
            let nearest = named.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
            if let Some(peak) = nearest.filter(|peak| away(peak) < self.resolution_hz) {
                tone.peak.relation.clone_from(&peak.relation);
            }
        }
    }

    /// The sound pressure level, in dB re 20 µPa and in dB(A), of the mean square over all directions at a `distance`
    /// \[m\] in the free field: p̄² = ρ₀ c W/(4πr²).
    pub fn mean_levels(&self, distance: f64) -> [f64; 2] {
        let per_watt = self.air.density * self.air.speed / (4.0 * std::f64::consts::PI * distance * distance);
        self.power_levels().map(|level| pressure_level(1e-12 * per_watt) + level)
    }
}

impl MicrophoneSound {
    /// The sound pressure level in dB re 20 µPa and, A-weighted, in dB(A).
    pub fn levels(&self) -> [f64; 2] {
        let sum = |weight: &dyn Fn(f64) -> f64| -> f64 {
            let line = |k| weight(self.spectrum.frequency_hz(k)).powi(2) * self.spectrum.mean_square(k);
            (0..self.spectrum.amplitude.len()).map(line).sum()
        };
        [pressure_level(sum(&|_| 1.0)), pressure_level(sum(&a_weighting))]
    }
}

impl PressureRecord {
    /// The pressure that is the largest number of the WAV file \[Pa\]: the loudest moment reaches 0.9 of it.
    pub fn full_scale(&self) -> f64 {
        let loudest = self.pressure.iter().fold(0.0f64, |m, p| m.max(p.abs()));
        if loudest > 0.0 { loudest / LOUDEST } else { 1.0 }
    }
}
