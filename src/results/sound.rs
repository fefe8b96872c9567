//! How loud a run in time is, as plain data.

use super::explored::window;
use crate::dataset::{Column, Dimension, Group, Table, Values, Variable, column};
use crate::sound::{power_level, wav};
use std::path::Path;

pub use crate::sound::{MicrophoneSound, PressureRecord, Sound, Tone};

/// The name of the WAV file of a microphone.
fn file(microphone: &MicrophoneSound) -> String {
    format!("sound_{}.wav", microphone.name)
}

/// A plate's name and the power that it sends out \[W\].
type PlatePower<'a> = (&'a str, f64);

fn plate_columns<'a>(whole: f64) -> Vec<Column<PlatePower<'a>>> {
    vec![
        column("name", "text", "name of the plate", |(name, _): &PlatePower| (*name).to_string()),
        column("power_w", "W", "sound power of both sides", |(_, power): &PlatePower| *power),
        column("share", "1", "its part of the whole", move |(_, power): &PlatePower| power / whole),
    ]
}

fn tone_columns() -> Vec<Column<Tone>> {
    vec![
        column("frequency_hz", "Hz", "frequency of the peak", |tone: &Tone| tone.peak.frequency_hz),
        column("power_level_db", "dB", "sound power level of the five lines about it", |tone: &Tone| {
            power_level(tone.power)
        }),
        column("share", "1", "its part of the whole", |tone: &Tone| tone.share),
        column("relation", "text", "relation to the fundamental of the motion", |tone: &Tone| {
            tone.peak.relation.clone()
        }),
    ]
}

fn microphone_columns() -> Vec<Column<MicrophoneSound>> {
    vec![
        column("name", "text", "name of the microphone", |microphone: &MicrophoneSound| {
            microphone.name.clone()
        }),
        column("at_m", "m", "position", |microphone: &MicrophoneSound| microphone.at)
            .along(Dimension::axes()),
        column(
            "pressure_level_db",
            "dB",
            "sound pressure level re 20 µPa",
            |microphone: &MicrophoneSound| microphone.levels()[0],
        ),
        column("pressure_level_db_a", "dB", "the same, A-weighted", |microphone: &MicrophoneSound| {
            microphone.levels()[1]
        }),
    ]
}

/// Levels, plates, tones, microphones, spectra and the recording; the level of nothing is −∞.
pub(super) fn group(sound: &Sound) -> Group<'_> {
    let [level, weighted] = sound.power_levels();
    let [mean, mean_weighted] = sound.mean_levels(1.0);
    let plates: Vec<PlatePower> =
        sound.plates.iter().map(|(name, lines)| (&**name, lines.iter().sum())).collect();
    let whole: f64 = (0..sound.lines()).map(|k| sound.power(k)).sum();
    let air = Group::new("air", "what carries the sound")
        .value("density_kg_per_m3", "kg/m^3", "density ρ₀", sound.air.density)
        .value("speed_m_per_s", "m/s", "speed of sound c", sound.air.speed);
    let modes = vec![Dimension::numbered("mode", sound.mode_shares.len())];
    let limits = "each plate in an infinite rigid baffle, free field: an upper estimate below coincidence";
    Group::new("sound", "sound of the plates over the steady part of the run")
        .with(window(sound.window, "the first and the last time of what the levels are taken from"))
        .value("up_to_hz", "Hz", "the highest line", sound.frequency_hz(sound.lines().saturating_sub(1)))
        .value("resolution_hz", "Hz", "Δf, from line to line", sound.resolution_hz)
        .group(air)
        .value("power_w", "W", "sound power of all plates", whole)
        .value("power_level_db", "dB", "sound power level re 1 pW", level)
        .value("power_level_db_a", "dB", "the same, A-weighted", weighted)
        .value(
            "mean_pressure_level_at_1_m_db",
            "dB",
            "sound pressure level re 20 µPa of the mean square over all directions at 1 m",
            mean,
        )
        .value("mean_pressure_level_at_1_m_db_a", "dB", "the same, A-weighted", mean_weighted)
        .table(Table::of("plates", "plate", &plate_columns(whole), &plates))
        .with(Variable::reals(
            "mode_shares",
            "1",
            "share of each real mode in the sound power",
            modes,
            sound.mode_shares.clone(),
        ))
        .table(Table::of("tones", "tone", &tone_columns(), &sound.tones))
        .table(Table::of("microphones", "microphone", &microphone_columns(), &sound.microphones))
        .table(spectrum(sound))
        .list("recordings", sound.microphones.iter().map(recording).collect())
        .with(Variable::text("limits", "what the levels suppose", limits))
}

/// Power and mean square pressure over frequency.
fn spectrum(sound: &Sound) -> Table<'static> {
    let rows = Dimension::of_variable("frequency_hz", sound.lines());
    let over_lines =
        |key: String, unit: &'static str, description: &'static str, of: &dyn Fn(usize) -> f64| {
            let values = (0..sound.lines()).map(of).collect();
            Variable::reals(key, unit, description, vec![rows.clone()], values)
        };
    let frequency = over_lines(rows.name.into(), "Hz", "frequency", &|k| sound.frequency_hz(k));
    let plates = sound.plates.iter().map(|(name, lines)| {
        over_lines(format!("power_{name}"), "W", "sound power of both sides, what each line adds", &|k| {
            lines[k]
        })
    });
    let microphones = sound.microphones.iter().map(|microphone| {
        let spectrum = &microphone.spectrum;
        let square = |k: usize| spectrum.amplitude.get(k).map_or(0.0, |_| spectrum.mean_square(k));
        let key = format!("mean_square_pressure_{}", microphone.name);
        over_lines(key, "Pa^2", "mean square sound pressure, what each line adds", &square)
    });
    let columns = std::iter::once(frequency).chain(plates).chain(microphones).collect();
    Table::along("spectrum", rows.clone(), columns).file("sound_spectrum").long()
}

/// The pressure at a microphone, and its audio file.
fn recording(at: &MicrophoneSound) -> Group<'_> {
    let record = &at.recording;
    let time = Dimension::of_variable("time_s", record.pressure.len());
    let times = Values::RealRows(Box::new(|k| vec![record.begin + k as f64 / f64::from(record.rate)]));
    let pressures = Values::RealRows(Box::new(|k| vec![record.pressure[k]]));
    Group::new(&*at.name, "sound pressure at a microphone")
        .value("file", "text", "name of the WAV file", file(at))
        .value("microphone", "text", "name of the microphone", at.name.clone())
        .value("begin_s", "s", "time of the first sample", record.begin)
        .value("samples_per_second", "Hz", "samples a second", record.rate)
        .value("full_scale_pa", "Pa", "the largest number of the WAV file", record.full_scale())
        .with(Variable::new("time_s", "s", "time", vec![time.clone()], times))
        .with(Variable::new("pressure_pa", "Pa", "sound pressure p", vec![time], pressures))
}

/// Writes `sound_<microphone>.wav` of each microphone into the folder `dir`.
pub(super) fn write_sound(dir: &Path, sound: &Sound) -> crate::error::Result<()> {
    for microphone in &sound.microphones {
        let record = &microphone.recording;
        let scale = record.full_scale();
        let [x, y, z] = microphone.at;
        let comment = format!(
            "Sound pressure at microphone {} ({x:.3}, {y:.3}, {z:.3}) m; full scale is {scale:.6e} Pa; begins at {:.6} s",
            microphone.name, record.begin
        );
        let bytes = wav(&record.pressure, record.rate, scale, &comment);
        super::write_result(dir, &file(microphone), &bytes)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::bounds::{Origin::*, within};
    use crate::job::sample;
    use crate::results::TransientResult;
    use crate::sound::a_weighting;

    #[test]
    fn levels_follow_from_power_and_files_say_their_scale() {
        let results = sample::rig();
        let sound = results.get::<TransientResult>().unwrap().sound.as_ref().unwrap();
        let whole: f64 = (0..sound.lines()).map(|k| sound.power(k)).sum();
        let [level, weighted] = sound.power_levels();
        assert!(within((level - 10.0 * (whole / 1e-12).log10()).abs(), 1e-9, RoundOff));
        // The weight of the whole is the mean of that of the lines, by their power.
        let share = |k: usize| sound.power(k) / whole * a_weighting(sound.frequency_hz(k)).powi(2);
        let weight = 10.0 * (1..sound.lines()).map(share).sum::<f64>().log10();
        assert!(
            within((weighted - level - weight).abs(), 0.01, Discretisation),
            "{weighted} {level} {weight}"
        );
        // A watt makes 120 dB, and 109.1 dB in the mean at 1 m: ρ₀c/(4π · 400) of it.
        assert!(within((sound.mean_levels(1.0)[0] - level + 10.85).abs(), 0.01, Reference));
        assert!(within(
            (sound.mean_levels(2.0)[1] - sound.mean_levels(1.0)[1] + 6.02).abs(),
            0.01,
            Reference
        ));
        let dir = tempfile::tempdir().unwrap();
        super::write_sound(dir.path(), sound).unwrap();
        let wav = std::fs::read(dir.path().join("sound_axis.wav")).unwrap();
        let record = &sound.microphones[0].recording;
        let peak = record.pressure.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
        assert!(
            within((record.full_scale() - peak / 0.9).abs(), 1e-12 * peak, RoundOff),
            "the peak is 0.9 of it"
        );
        let scale = format!("full scale is {:.6e} Pa", record.full_scale());
        assert!(wav.windows(scale.len()).any(|w| w == scale.as_bytes()));
        let table = super::spectrum(sound).to_csv();
        let header = "frequency_hz,power_disc [W],power_slider [W],mean_square_pressure_axis [Pa^2],mean_square_pressure_side [Pa^2]\n";
        assert!(table.lines().count() == sound.lines() + 1 && table.starts_with(header), "{table}");
        let summary = super::group(sound).to_json();
        let files = [0, 1].map(|k| summary["recordings"][k]["file"].as_str().unwrap());
        assert_eq!(files, ["sound_axis.wav", "sound_side.wav"]);
        assert!(files.iter().all(|file| dir.path().join(file).exists()));
        let disc = sound.plates[0].1.iter().sum::<f64>();
        assert!(within(
            (summary["plates"][0]["share"].as_f64().unwrap() - disc / whole).abs(),
            1e-9,
            RoundOff
        ));
    }
}
