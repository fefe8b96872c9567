//! `/transient` of `results.h5`: room for every channel, filled as the run goes on, so that a killed run leaves what it had
//! reached and can be taken up.
//!
//! | in `/transient` | |
//! |---|---|
//! | attribute `rows` | how many values of every channel are there; the others are not a number |
//! | `<channel>` | a value for every step, the start included |
//! | `modal_acceleration/<k>` | the same of real mode k, counted from 0, where sound is asked for |
//! | `checkpoint/0`, `checkpoint/1` | what the run goes on from after its last rows and, in turn, after those before |
//! | attribute `latest` | which of the two is whole, -1 for none; changed when the other is on the disk |
//! | `events/time`, `events/point`, `events/kind` | what happened at the contact points; attribute `events` says how many |
//! | `spectrum_<channel>`, `spectrogram_<channel>`, `limit_cycle_<channel>` | lines and peaks; over time, too; the size in the end |
//! | `contact_state`, `sound` | what the contact points did; how loud it is |
//!
//! Nobody knows how many events there will be: when their room is full the file is copied with twice the room.

use super::events_hdf5 as events;
use super::file::room;
use super::hdf5::{Datasets, attribute, describe, text_attribute};
use super::{Piece, Recording, ResultsFile, TransientResult, modal_channel};
use crate::error::Result;
use crate::transient::Checkpoint;
use hdf5::Group;
use ndarray::s;
use std::ops::Range;

/// Groups that are written while the run goes on; the others say what the whole record says.
const RECORDED: [&str; 3] = ["modal_acceleration", "checkpoint", "events"];
/// Attributes that a whole run has.
const SAID: [&str; 2] = ["scheme", "worst_energy_residual"];

impl ResultsFile {
    /// Begins a run in time with room for all it is going to record, or takes it up where [`ResultsFile::stopped`] has
    /// an answer. The file takes its place then.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn begin_transient(&mut self, recording: &Recording) -> Result<()> {
        let goes_on = self.stopped()?.is_some();
        self.keep(|root| {
            if goes_on {
                let group = root.group("transient")?;
                let groups = group.groups()?.into_iter().map(|inner| inner.name());
                let names = groups.filter_map(|path| path.rsplit('/').next().map(str::to_string));
                let said = names.filter(|name| !RECORDED.contains(&name.as_str()));
                said.into_iter().try_for_each(|name| group.unlink(&name))?;
                let said = group.attr_names()?.into_iter().filter(|name| SAID.contains(&name.as_str()));
                said.into_iter().try_for_each(|name| group.delete_attr(&name))?;
                group.attr("rows")?.write_scalar(&(recording.done as u64))?;
                group.attr("events")?.write_scalar(&(recording.happened as u64))?;
                return group.attr("complete")?.write_scalar(&false);
            }
            if root.link_exists("transient") {
                root.unlink("transient")?;
            }
            make_room(&root.create_group("transient")?, recording)
        })?;
        self.channels = recording.channels.iter().map(|channel| channel.name.clone()).collect();
        self.take_place()
    }

    /// Adds new rows and the checkpoint after them. They count when they are on the disk.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn write_transient_piece(&mut self, piece: &Piece) -> Result<()> {
        self.room_for_events(piece.events.len())?;
        let slot = self.read(|root| latest(&root.group("transient")?))?.map_or(0, |slot| 1 - slot);
        let end = piece.first + piece.values.first().map_or(0, Vec::len);
        let channels = std::mem::take(&mut self.channels);
        let filled = self.fill(|root| {
            let group = root.group("transient")?;
            for (name, values) in channels.iter().zip(piece.values) {
                group.dataset(name)?.write_slice(values, s![piece.first..end])?;
            }
            for (mode, values) in piece.modal.iter().enumerate() {
                group.dataset(&modal_channel(mode))?.write_slice(values, s![piece.first..end])?;
            }
            events::write(&group, piece.events)?;
            let group = group.group(&format!("checkpoint/{slot}"))?;
            for (name, values) in &piece.checkpoint.arrays {
                group.dataset(name)?.write(values)?;
            }
            Ok(())
        });
        self.channels = channels;
        filled?;
        self.fill(|root| {
            let group = root.group("transient")?;
            group.attr("rows")?.write_scalar(&(end as u64))?;
            let events = group.attr("events")?;
            events.write_scalar(&(events.read_scalar::<u64>()? + piece.events.len() as u64))?;
            group.attr("latest")?.write_scalar(&slot)
        })
    }

    /// Where the run in time of an earlier run stopped, if there is one to be taken up.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn stopped(&self) -> Result<Option<Checkpoint>> {
        self.read(|root| {
            if !root.link_exists("transient") {
                return Ok(None);
            }
            let group = root.group("transient")?;
            let Some(slot) = latest(&group)? else { return Ok(None) };
            let group = group.group(&format!("checkpoint/{slot}"))?;
            let array = |name: String| Ok((name.clone(), group.dataset(&name)?.read_raw::<f64>()?));
            let arrays = group.member_names()?.into_iter().map(array).collect::<hdf5::Result<_>>()?;
            Ok(Some(Checkpoint { arrays }))
        })
    }

    /// Rows of a channel of the run in time.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn read_transient(&self, channel: &str, rows: Range<usize>) -> Result<Vec<f64>> {
        self.read(|root| {
            let dataset = root.group("transient")?.dataset(channel)?;
            Ok(dataset.read_slice_1d::<f64, _>(s![rows])?.to_vec())
        })
    }

    /// Writes what the whole record says.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn finish_transient(&mut self, result: &TransientResult) -> Result<()> {
        self.stage(|root| {
            let group = root.group("transient")?;
            text_attribute(&group, SAID[0], &result.scheme)?;
            attribute(&group, SAID[1], &result.worst_residual)?;
            for of in &result.spectra {
                let channel = &result.channels[of.channel];
                let spectrum = Datasets(group.create_group(&format!("spectrum_{}", channel.name))?);
                attribute(&spectrum.0, "resolution_hz", &of.spectrum.resolution_hz)?;
                let story = "amplitude of the sine that gives each line; line k stands at k · resolution_hz";
                spectrum.list("amplitude", &of.spectrum.amplitude, channel.unit, story)?;
                let hz: Vec<f64> = of.peaks.iter().map(|p| p.frequency_hz).collect();
                spectrum.list("peak_frequency_hz", &hz, "Hz", "its peaks")?;
                let height: Vec<f64> = of.peaks.iter().map(|p| p.amplitude).collect();
                spectrum.list("peak_amplitude", &height, channel.unit, "their amplitudes")?;
                spectrum.list("measured_hz", &of.measured, "Hz", "peaks that were measured")?;
            }
            events::fit(&group)?;
            super::sound_hdf5::write(&group, result)?;
            group.attr("complete")?.write_scalar(&true)
        })
    }
}

/// Which checkpoint is whole.
fn latest(group: &Group) -> hdf5::Result<Option<i64>> {
    // A run of an earlier version of the program has none.
    if !group.link_exists("checkpoint") {
        return Ok(None);
    }
    let slot = group.attr("latest")?.read_scalar::<i64>()?;
    Ok((slot >= 0).then_some(slot))
}

fn make_room(group: &Group, recording: &Recording) -> hdf5::Result<()> {
    attribute(group, "time_step", &recording.time_step)?;
    attribute(group, "complete", &false)?;
    attribute(group, "rows", &0_u64)?;
    attribute(group, "latest", &-1_i64)?;
    attribute(group, "events", &0_u64)?;
    events::make_room(group, events::FIRST)?;
    for channel in recording.channels {
        describe(&room(group, &channel.name, recording.rows, f64::NAN)?, channel.unit, &channel.about)?;
    }
    if recording.modes > 0 {
        group.create_group("modal_acceleration")?;
    }
    for mode in 0..recording.modes {
        let room = room(group, &modal_channel(mode), recording.rows, f32::NAN)?;
        describe(&room, "sqrt(kg) m/s^2", "acceleration of a mass-normalised real mode")?;
    }
    for slot in ["checkpoint/0", "checkpoint/1"] {
        let slot = group.create_group(slot)?;
        for (name, values) in &recording.checkpoint.arrays {
            describe(&room(&slot, name, values.len(), f64::NAN)?, "SI", "what the run goes on from")?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::Channel;
    use crate::transient::{Event, EventKind};
    use std::path::Path;

    const ROWS: usize = 5000;
    const MODES: usize = 2;

    fn value(channel: usize, row: usize) -> f64 {
        (row as f64 + 0.25) * (1.0 + channel as f64)
    }

    fn modal(mode: usize, row: usize) -> f32 {
        row as f32 - mode as f32
    }

    fn checkpoint(row: usize) -> Checkpoint {
        let mut checkpoint = Checkpoint::default();
        // In the order of their names, as a file has them.
        checkpoint.put("counts", &[row as f64]);
        checkpoint.put("motion", &[row as f64; 777]);
        checkpoint.put("nothing", &[]);
        checkpoint
    }

    /// So many events at every row.
    fn events(rows: Range<usize>, often: usize) -> Vec<Event> {
        let event = |k: usize| Event { time: k as f64, point: k % 7, kind: EventKind::ALL[k % 3] };
        (rows.start * often..rows.end * often).map(event).collect()
    }

    fn begin(file: &mut ResultsFile, done: usize) {
        let channels = ["a", "b"].map(|name| Channel::new(name.into(), "m", "a channel".into()));
        file.begin_transient(&Recording {
            time_step: 1e-5,
            rows: ROWS,
            done,
            modes: MODES,
            happened: 2 * done,
            channels: &channels,
            pairs: &[],
            checkpoint: &checkpoint(0),
            fields: None,
        })
        .unwrap();
    }

    fn add(file: &mut ResultsFile, rows: Range<usize>, often: usize) {
        let values = [0, 1].map(|channel| rows.clone().map(|row| value(channel, row)).collect::<Vec<f64>>());
        let modal = [0, 1].map(|mode| rows.clone().map(|row| modal(mode, row)).collect::<Vec<f32>>());
        let (first, checkpoint) = (rows.start, checkpoint(rows.end - 1));
        let events = events(rows, often);
        file.write_transient_piece(&Piece {
            first,
            values: &values,
            modal: &modal,
            events: &events,
            checkpoint: &checkpoint,
        })
        .unwrap();
    }

    fn happened(file: &ResultsFile) -> usize {
        file.read(|root| events::count(&root.group("transient")?)).unwrap()
    }

    /// Where the numbers of the datasets of a group stand in the file.
    fn rooms(group: &Group, found: &mut Vec<Range<usize>>) {
        for dataset in group.datasets().unwrap() {
            let begin = dataset.offset().unwrap_or(0) as usize;
            let each = dataset.dtype().unwrap().size();
            found.push(begin..begin + each * dataset.size());
        }
        group.groups().unwrap().iter().for_each(|inner| rooms(inner, found));
    }

    #[test]
    fn a_run_under_way_changes_numbers_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let home = dir.path().join("results.h5");
        let mut file = ResultsFile::create(dir.path()).unwrap();
        begin(&mut file, 0);
        let before = std::fs::read(&home).unwrap();
        let mut numbers = Vec::new();
        rooms(&file.read(|root| root.group("transient")).unwrap(), &mut numbers);
        for first in (0..4500).step_by(900) {
            add(&mut file, first..first + 900, 1);
        }
        let after = std::fs::read(&home).unwrap();
        assert_eq!(before.len(), after.len());
        let elsewhere = |at: &usize| !numbers.iter().any(|room| room.contains(at));
        let changed: Vec<usize> =
            (0..before.len()).filter(|k| before[*k] != after[*k]).filter(elsewhere).collect();
        // The three counts, 8 bytes each.
        assert!(changed.len() <= 24 && numbers.len() == 11 + MODES, "{changed:?}");
    }

    /// Copies what is on the disk at a moment, as a kill leaves it, and takes it up.
    #[test]
    fn what_is_on_the_disk_at_any_moment_is_taken_up() {
        let dir = tempfile::tempdir().unwrap();
        let mut file = ResultsFile::create(dir.path()).unwrap();
        begin(&mut file, 0);
        let copy = |name: &str| {
            let other = dir.path().join(name);
            std::fs::create_dir(&other).unwrap();
            std::fs::copy(dir.path().join("results.h5"), other.join("results.h5")).unwrap();
            other
        };
        let reached = |dir: &Path| {
            let file = ResultsFile::resume(dir).unwrap();
            file.stopped().unwrap().map(|checkpoint| checkpoint.numbers::<1>("counts").unwrap()[0])
        };
        assert_eq!(reached(&copy("none")), None);
        add(&mut file, 0..1000, 2);
        add(&mut file, 1000..2000, 2);
        assert_eq!(reached(&copy("two")), Some(1999.0));
        // Half of a third piece: its rows and its checkpoint are there and do not count.
        file.fill(|root| {
            root.dataset("transient/a")?.write_slice(&[-1.0; 700], s![2000..2700])?;
            root.dataset("transient/checkpoint/0/motion")?.write(&[-1.0; 777])
        })
        .unwrap();
        let half = copy("half");
        assert_eq!(reached(&half), Some(1999.0));
        let mut again = ResultsFile::resume(&half).unwrap();
        assert!(again.stopped().unwrap() == Some(checkpoint(1999)));
        begin(&mut again, 2000);
        add(&mut again, 2000..ROWS, 2);
        for (channel, name) in ["a", "b"].into_iter().enumerate() {
            let all = again.read_transient(name, 0..ROWS).unwrap();
            assert!(all.iter().enumerate().all(|(row, v)| *v == value(channel, row)), "{name}");
        }
        for mode in 0..MODES {
            let all = again.read_transient(&modal_channel(mode), 0..ROWS).unwrap();
            assert!(all.iter().enumerate().all(|(row, v)| *v == f64::from(modal(mode, row))));
        }
        assert_eq!(again.read_events(0..happened(&again)).unwrap(), events(0..ROWS, 2));
    }

    #[test]
    fn there_is_always_room_for_events() {
        let dir = tempfile::tempdir().unwrap();
        let mut file = ResultsFile::create(dir.path()).unwrap();
        begin(&mut file, 0);
        let room =
            |file: &ResultsFile| file.read(|root| Ok(root.dataset("transient/events/time")?.size())).unwrap();
        assert_eq!(room(&file), events::FIRST);
        add(&mut file, 0..1500, 20);
        add(&mut file, 1500..ROWS, 20);
        assert!(room(&file) >= 20 * ROWS);
        // A copy has taken the place, and is the one that is written.
        let killed = tempfile::tempdir().unwrap();
        std::fs::copy(dir.path().join("results.h5"), killed.path().join("results.h5")).unwrap();
        let again = ResultsFile::resume(killed.path()).unwrap();
        assert_eq!(happened(&again), 20 * ROWS);
        assert!(again.read_events(0..20 * ROWS).unwrap() == self::events(0..ROWS, 20));
        let fit = |file: &mut ResultsFile| file.stage(|root| events::fit(&root.group("transient")?));
        fit(&mut file).unwrap();
        assert!(
            room(&file) == 20 * ROWS && file.read_events(0..20 * ROWS).unwrap() == self::events(0..ROWS, 20)
        );
    }
}
