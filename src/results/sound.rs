//! How loud a run in time is, as plain data.

use crate::signal::{Peak, Spectrum};
use crate::sound::{Air, a_weighting, power_level, pressure_level, wav};
use serde_json::{Value, json};
use std::path::Path;

/// Sound of the plates over the steady part of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Sound {
    /// The first and last time of what the levels are taken from \[s\].
    pub window: [f64; 2],
    /// What carries it.
    pub air: Air,
    /// Δf \[Hz\]: line k stands at k Δf. The last line is the highest frequency that counts.
    pub resolution_hz: f64,
    /// Each plate's name, and the power \[W\] that it sends out in each line, both sides.
    pub plates: Vec<(String, Vec<f64>)>,
    /// The share of each real mode in the power; a mode that takes up what others send counts below zero.
    pub mode_shares: Vec<f64>,
    /// The peaks of the power, strongest lines of it: amplitude² is their height in W.
    pub tones: Vec<Tone>,
    /// What is heard where.
    pub microphones: Vec<Heard>,
    /// The pressure at the first microphone.
    pub recording: Sounding,
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

/// What a microphone hears.
#[derive(Debug, Clone, PartialEq)]
pub struct Heard {
    /// Its name.
    pub name: String,
    /// Where it stands \[m\].
    pub at: [f64; 3],
    /// The pressure over frequency \[Pa\], as many lines as the power has.
    pub spectrum: Spectrum,
}

/// A pressure that can be listened to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sounding {
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

    /// The sound pressure level, in dB re 20 µPa and in dB(A), of the mean square over all directions at a `distance`
    /// \[m\] in the free field: p̄² = ρ₀ c W/(4πr²).
    pub fn mean_levels(&self, distance: f64) -> [f64; 2] {
        let per_watt = self.air.density * self.air.speed / (4.0 * std::f64::consts::PI * distance * distance);
        self.power_levels().map(|level| pressure_level(1e-12 * per_watt) + level)
    }
}

impl Heard {
    /// The sound pressure level in dB re 20 µPa and, A-weighted, in dB(A).
    pub fn levels(&self) -> [f64; 2] {
        let sum = |weight: &dyn Fn(f64) -> f64| -> f64 {
            let line = |k| weight(self.spectrum.frequency_hz(k)).powi(2) * self.spectrum.mean_square(k);
            (0..self.spectrum.amplitude.len()).map(line).sum()
        };
        [pressure_level(sum(&|_| 1.0)), pressure_level(sum(&a_weighting))]
    }
}

impl Sounding {
    /// The pressure that is the largest number of the WAV file \[Pa\]: the loudest moment reaches 0.9 of it.
    pub fn full_scale(&self) -> f64 {
        let loudest = self.pressure.iter().fold(0.0f64, |m, p| m.max(p.abs()));
        if loudest > 0.0 { loudest / LOUDEST } else { 1.0 }
    }
}

/// Writes `sound_<microphone>.wav` and `sound_spectrum.csv` into the folder `dir`.
pub(super) fn write(dir: &Path, sound: &Sound) -> crate::error::Result<()> {
    let Some(first) = sound.microphones.first() else { return Ok(()) };
    let scale = sound.recording.full_scale();
    let [x, y, z] = first.at;
    let comment = format!(
        "Sound pressure at microphone {} ({x:.3}, {y:.3}, {z:.3}) m; full scale is {scale:.6e} Pa; begins at {:.6} s",
        first.name, sound.recording.begin
    );
    let bytes = wav(&sound.recording.pressure, sound.recording.rate, scale, &comment);
    super::write_result(dir, &format!("sound_{}.wav", first.name), &bytes)?;
    super::write_result(dir, "sound_spectrum.csv", table(sound).as_bytes())
}

fn table(sound: &Sound) -> String {
    use crate::dataset::{CsvTable as Table, number};
    let plates = sound.plates.iter().map(|(name, _)| format!("sound power of {name} [W]"));
    let heard = sound.microphones.iter().map(|m| format!("mean square pressure at {} [Pa^2]", m.name));
    let headings: Vec<String> = std::iter::once("frequency [Hz]".into()).chain(plates).chain(heard).collect();
    let mut table = Table::new(&headings.iter().map(String::as_str).collect::<Vec<_>>());
    for k in 0..sound.lines() {
        let plates = sound.plates.iter().map(|(_, lines)| lines[k]);
        let heard = sound.microphones.iter().map(|m| match m.spectrum.amplitude.get(k) {
            Some(_) => m.spectrum.mean_square(k),
            None => 0.0,
        });
        let row: Vec<String> =
            std::iter::once(sound.frequency_hz(k)).chain(plates).chain(heard).map(number).collect();
        table.row(&row);
    }
    table.text
}

/// The part of `summary.json` on sound; a level of nothing is `null`.
pub(super) fn summary(sound: &Sound) -> Value {
    let [level, weighted] = sound.power_levels();
    let whole: f64 = (0..sound.lines()).map(|k| sound.power(k)).sum();
    let plate = |(name, lines): &(String, Vec<f64>)| {
        let power: f64 = lines.iter().sum();
        json!({ "name": name, "power_w": power, "share": power / whole })
    };
    let tone = |tone: &Tone| {
        json!({
            "frequency_hz": tone.peak.frequency_hz,
            "power_level_db": power_level(tone.power),
            "share": tone.share,
            "relation": tone.peak.relation,
        })
    };
    let heard = |m: &Heard| {
        let [level, weighted] = m.levels();
        json!({ "name": m.name, "at_m": m.at, "pressure_level_db": level, "pressure_level_db_a": weighted })
    };
    let wav = sound.microphones.first().map(|first| {
        json!({
            "file": format!("sound_{}.wav", first.name),
            "begin_s": sound.recording.begin,
            "full_scale_pa": sound.recording.full_scale(),
        })
    });
    json!({
        "window_s": sound.window,
        "up_to_hz": sound.frequency_hz(sound.lines().saturating_sub(1)),
        "resolution_hz": sound.resolution_hz,
        "air": { "density_kg_per_m3": sound.air.density, "speed_m_per_s": sound.air.speed },
        "power_w": whole,
        "power_level_db": level,
        "power_level_db_a": weighted,
        "mean_pressure_level_at_1_m_db": sound.mean_levels(1.0)[0],
        "mean_pressure_level_at_1_m_db_a": sound.mean_levels(1.0)[1],
        "plates": sound.plates.iter().map(plate).collect::<Vec<_>>(),
        "mode_shares": sound.mode_shares,
        "tones": sound.tones.iter().map(tone).collect::<Vec<_>>(),
        "microphones": sound.microphones.iter().map(heard).collect::<Vec<_>>(),
        "wav": wav,
        "limits": "each plate in an infinite rigid baffle, free field: an upper estimate below coincidence",
    })
}

#[cfg(test)]
mod tests {
    use super::super::sample;

    #[test]
    fn levels_follow_from_power_and_files_say_their_scale() {
        let results = sample::rig();
        let sound = results.transient.as_ref().unwrap().sound.as_ref().unwrap();
        let whole: f64 = (0..sound.lines()).map(|k| sound.power(k)).sum();
        let [level, weighted] = sound.power_levels();
        assert!((level - 10.0 * (whole / 1e-12).log10()).abs() < 1e-9);
        // Nearly all of it is at 1668 Hz, where the weight is +1.0 dB.
        assert!((weighted - level - 1.0).abs() < 0.1, "{weighted} {level}");
        // A watt makes 120 dB, and 109.1 dB in the mean at 1 m: ρ₀c/(4π · 400) of it.
        assert!((sound.mean_levels(1.0)[0] - level + 10.85).abs() < 0.01);
        assert!((sound.mean_levels(2.0)[1] - sound.mean_levels(1.0)[1] + 6.02).abs() < 0.01);
        let dir = tempfile::tempdir().unwrap();
        super::write(dir.path(), sound).unwrap();
        let wav = std::fs::read(dir.path().join("sound_axis.wav")).unwrap();
        assert!(wav.windows(22).any(|w| w == b"full scale is 3.333333"), "0.3 Pa is 0.9 of it");
        let table = std::fs::read_to_string(dir.path().join("sound_spectrum.csv")).unwrap();
        assert!(table.lines().count() == 501 && table.starts_with("frequency [Hz],sound power of disc [W]"));
        let summary = super::summary(sound);
        assert_eq!(summary["wav"]["file"], "sound_axis.wav");
        assert!((summary["plates"][0]["share"].as_f64().unwrap() - 1.0 / 1.02).abs() < 1e-9);
    }
}
