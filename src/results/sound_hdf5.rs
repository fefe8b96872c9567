//! What a run in time looks and sounds like, in `/transient` of `results.h5`.

use super::TransientResult;
use super::hdf5::{Datasets, attribute};
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
    sound.group().write_hdf5(transient)
}
