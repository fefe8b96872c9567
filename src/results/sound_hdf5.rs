//! What a run in time looks and sounds like, in `/transient` of `results.h5`.

use super::TransientResult;
use super::hdf5::{Datasets, attribute, text_attribute};
use super::watched::TouchState;
use hdf5::Group;
use ndarray::Array2;

/// Spectrograms, limit cycles, states of the contact, and `/transient/sound`.
pub(super) fn write(transient: &Group, result: &TransientResult) -> hdf5::Result<()> {
    let watched = &result.watched;
    for (channel, spectrogram) in &watched.spectrograms {
        let channel = &result.channels[*channel];
        let group = Datasets(transient.create_group(&format!("spectrogram_{}", channel.name))?);
        attribute(&group.0, "begin_s", &spectrogram.begin)?;
        attribute(&group.0, "hop_s", &spectrogram.hop)?;
        attribute(&group.0, "segment_s", &spectrogram.segment)?;
        attribute(&group.0, "resolution_hz", &spectrogram.resolution_hz)?;
        let cells = Array2::from_shape_fn((spectrogram.columns(), spectrogram.rows), |(column, row)| {
            spectrogram.column(column)[row]
        });
        let story =
            "amplitude of the sine that gives each line; row r of a column stands at r · resolution_hz";
        group.write("amplitude", cells.view(), channel.unit, story)?;
    }
    for (channel, cycle) in &watched.cycles {
        let channel = &result.channels[*channel];
        let group = transient.create_group(&format!("limit_cycle_{}", channel.name))?;
        attribute(&group, "begin_s", &watched.window[0])?;
        attribute(&group, "end_s", &watched.window[1])?;
        attribute(&group, "amplitude", &cycle.amplitude)?;
        attribute(&group, "rms", &cycle.rms)?;
        attribute(&group, "mean", &cycle.mean)?;
        attribute(&group, "drift", &cycle.drift)?;
        attribute(&group, "steady", &cycle.steady())?;
    }
    if watched.contact.points > 0 {
        let group = Datasets(transient.create_group("contact_state")?);
        attribute(&group.0, "column_s", &watched.contact.column)?;
        attribute(&group.0, "points", &(watched.contact.points as u64))?;
        let counts = &watched.contact.counts;
        let cells = Array2::from_shape_fn((counts.len(), 4), |(column, state)| counts[column][state]);
        let names = TouchState::ALL.map(TouchState::name).join(", ");
        let story = format!("points times steps of each column that were {names}");
        group.write("counts", cells.view(), "1", &story)?;
    }
    let Some(sound) = &result.sound else { return Ok(()) };
    let group = Datasets(transient.create_group("sound")?);
    attribute(&group.0, "begin_s", &sound.window[0])?;
    attribute(&group.0, "end_s", &sound.window[1])?;
    attribute(&group.0, "resolution_hz", &sound.resolution_hz)?;
    let [level, weighted] = sound.power_levels();
    attribute(&group.0, "power_level_db", &level)?;
    attribute(&group.0, "power_level_db_a", &weighted)?;
    for (name, lines) in &sound.plates {
        let story = "sound power of both sides, what each line adds; line k stands at k · resolution_hz";
        group.list(&format!("power_{name}"), lines, "W", story)?;
    }
    group.list("mode_shares", &sound.mode_shares, "1", "share of each real mode in the sound power")?;
    for heard in &sound.microphones {
        let own = Datasets(group.0.create_group(&format!("microphone_{}", heard.name))?);
        own.list("at", &heard.at, "m", "where it stands")?;
        let [level, weighted] = heard.levels();
        attribute(&own.0, "pressure_level_db", &level)?;
        attribute(&own.0, "pressure_level_db_a", &weighted)?;
        let lines = &heard.spectrum.amplitude;
        own.list("amplitude", lines, "Pa", "amplitude of the sine that gives each line")?;
    }
    if let Some(first) = sound.microphones.first() {
        let own = Datasets(group.0.create_group("recording")?);
        text_attribute(&own.0, "microphone", &first.name)?;
        attribute(&own.0, "begin_s", &sound.recording.begin)?;
        attribute(&own.0, "samples_per_second", &sound.recording.rate)?;
        own.list("pressure", &sound.recording.pressure, "Pa", "sound pressure")?;
    }
    Ok(())
}
