//! `/transient` of `results.h5`: every channel preallocated and filled during the run, so that a killed run leaves what it had
//! reached.
//!
//! | in `/transient` | |
//! |---|---|
//! | attribute `rows` | how many values of every channel are there; the others are not a number |
//! | `history/time_s` | the time of every step, the start included: the coordinate of the following |
//! | `history/<channel>` | a value for every step |
//! | `history/modal_acceleration/<k>` | the same of real mode k, from 1, where sound is requested |
//! | `events/time_s`, `events/point`, `events/kind` | what happened at the contact points; attribute `events` says how many |
//! | the rest | what [`TransientResult`] says in the end, under the names that it has in `summary.json` |
//!
//! The number of events is not known in advance: when their datasets are full the file is copied with twice the capacity.

use super::events_hdf5 as events;
use super::file::preallocated;
use super::{
    MODAL_ABOUT, MODAL_UNIT, RecordPiece, Recording, ResultsFile, TIME, TransientResult, TransientTables,
    modal_channel,
};
use crate::dataset::{Describe, Table, attach_scale, attribute, describe, text_attribute};
use crate::error::Result;
use hdf5::Group;
use ndarray::s;
use std::ops::Range;

/// The group of the channels.
const HISTORY: &str = "history";
/// Times that are written at once.
const AT_ONCE: usize = 1 << 16;

impl ResultsFile {
    /// Begins a run in time with space allocated for the whole record. The file can take its place then.
    pub fn begin_transient(&mut self, recording: &Recording) -> Result<()> {
        self.keep(|root| preallocate(&root.create_group("transient")?, recording))?;
        self.tables = TransientTables::new(recording);
        Ok(())
    }

    /// Adds new rows. They count when they are on the disk.
    pub fn write_transient_piece(&mut self, piece: &RecordPiece) -> Result<()> {
        self.reserve_events(piece.events.len())?;
        let tables = std::mem::take(&mut self.tables);
        let filled = self.fill(|root| {
            let group = root.group("transient")?;
            tables.history(piece.first, piece.values).fill_hdf5(&group, piece.first)?;
            if !piece.modal.is_empty() {
                let mut modal = tables.modal(piece.first, piece.modal);
                // The times are those of the group around it.
                modal.columns.remove(0);
                modal.fill_hdf5(&group.group(HISTORY)?, piece.first)?;
            }
            events::write(&group, piece.events)
        });
        self.tables = tables;
        filled?;
        let end = piece.first + piece.values.first().map_or(0, Vec::len);
        self.fill(|root| {
            let group = root.group("transient")?;
            group.attr("rows")?.write_scalar(&(end as u64))?;
            let events = group.attr("events")?;
            events.write_scalar(&(events.read_scalar::<u64>()? + piece.events.len() as u64))
        })
    }

    /// Rows of a channel of the run in time.
    pub fn read_transient(&self, channel: &str, rows: Range<usize>) -> Result<Vec<f64>> {
        self.read(|root| {
            let dataset = root.group("transient")?.group(HISTORY)?.dataset(channel)?;
            Ok(dataset.read_slice_1d::<f64, _>(s![rows])?.to_vec())
        })
    }

    /// Writes what the whole record says.
    pub fn finish_transient(&mut self, result: &TransientResult) -> Result<()> {
        self.stage(|root| {
            let group = root.group("transient")?;
            events::fit(&group)?;
            result.describe().write_hdf5(root)?;
            group.attr("complete")?.write_scalar(&true)
        })
    }
}

fn preallocate(group: &Group, recording: &Recording) -> hdf5::Result<()> {
    attribute(group, "complete", &false)?;
    attribute(group, "rows", &0_u64)?;
    attribute(group, "events", &0_u64)?;
    events::preallocate(group, events::FIRST)?;
    let history = &group.create_group(HISTORY)?;
    text_attribute(history, "description", "motion and forces at every step")?;
    let tables = TransientTables::new(recording);
    for column in &tables.history(0, &[]).columns {
        let dataset = preallocated(history, &column.key, recording.rows, f64::NAN)?;
        describe(&dataset, &column.unit, &column.description)?;
    }
    for first in (0..recording.rows).step_by(AT_ONCE) {
        let times = tables.times(first, AT_ONCE.min(recording.rows - first));
        Table::along(HISTORY, times.dimensions[0].clone(), vec![times]).fill_hdf5(group, first)?;
    }
    if recording.modes > 0 {
        history.create_group("modal_acceleration")?;
    }
    for mode in 0..recording.modes {
        let dataset = preallocated(history, &modal_channel(mode), recording.rows, f32::NAN)?;
        describe(&dataset, MODAL_UNIT, MODAL_ABOUT)?;
    }
    let channels = recording.channels.iter().map(|channel| channel.name.clone());
    let all: Vec<String> = channels.chain((0..recording.modes).map(modal_channel)).collect();
    attach_scale(history, TIME, &all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::Channel;
    use crate::transient::{Checkpoint, Event, EventKind};

    const ROWS: usize = 5000;
    const MODES: usize = 2;

    fn value(channel: usize, row: usize) -> f64 {
        (row as f64 + 0.25) * (1.0 + channel as f64)
    }

    fn modal(mode: usize, row: usize) -> f32 {
        row as f32 - mode as f32
    }

    /// So many events at every row.
    fn events(rows: Range<usize>, often: usize) -> Vec<Event> {
        let event = |k: usize| Event { time: k as f64, point: k % 7, kind: EventKind::ALL[k % 3] };
        (rows.start * often..rows.end * often).map(event).collect()
    }

    fn begin(file: &mut ResultsFile) {
        let channels = ["a", "b"].map(|name| Channel::new(name.into(), "m", "a channel".into()));
        file.begin_transient(&Recording {
            time_step: 1e-5,
            rows: ROWS,
            done: 0,
            modes: MODES,
            happened: 0,
            channels: &channels,
            pairs: &[],
            fields: None,
        })
        .unwrap();
        file.take_place().unwrap();
    }

    fn add(file: &mut ResultsFile, rows: Range<usize>, often: usize) {
        let values = [0, 1].map(|channel| rows.clone().map(|row| value(channel, row)).collect::<Vec<f64>>());
        let modal = [0, 1].map(|mode| rows.clone().map(|row| modal(mode, row)).collect::<Vec<f32>>());
        let (first, checkpoint) = (rows.start, Checkpoint::default());
        let events = events(rows, often);
        file.write_transient_piece(&RecordPiece {
            first,
            values: &values,
            modal: &modal,
            events: &events,
            checkpoint: &checkpoint,
        })
        .unwrap();
    }

    /// The events that count.
    fn happened(file: &ResultsFile) -> Vec<Event> {
        let read =
            |transient: &Group| events::read(&transient.group("events")?, 0..events::count(transient)?);
        file.read(|root| read(&root.group("transient")?)).unwrap()
    }

    /// Where the numbers of the datasets of a group stand in the file.
    fn ranges(group: &Group, found: &mut Vec<Range<usize>>) {
        for dataset in group.datasets().unwrap() {
            let begin = dataset.offset().unwrap_or(0) as usize;
            let each = dataset.dtype().unwrap().size();
            found.push(begin..begin + each * dataset.size());
        }
        group.groups().unwrap().iter().for_each(|inner| ranges(inner, found));
    }

    #[test]
    fn a_run_under_way_changes_numbers_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let home = dir.path().join("results.h5");
        let mut file = ResultsFile::create(dir.path()).unwrap();
        begin(&mut file);
        let before = std::fs::read(&home).unwrap();
        let mut numbers = Vec::new();
        ranges(&file.read(|root| root.group("transient")).unwrap(), &mut numbers);
        for first in (0..4500).step_by(900) {
            add(&mut file, first..first + 900, 1);
        }
        let after = std::fs::read(&home).unwrap();
        assert_eq!(before.len(), after.len());
        let elsewhere = |at: &usize| !numbers.iter().any(|range| range.contains(at));
        let changed: Vec<usize> =
            (0..before.len()).filter(|k| before[*k] != after[*k]).filter(elsewhere).collect();
        // The two counts, 8 bytes each.
        assert!(changed.len() <= 16 && numbers.len() == 6 + MODES, "{changed:?}");
    }

    #[test]
    fn rows_and_events_are_as_they_were_written() {
        let dir = tempfile::tempdir().unwrap();
        let mut file = ResultsFile::create(dir.path()).unwrap();
        begin(&mut file);
        (0..ROWS).step_by(1000).for_each(|first| add(&mut file, first..first + 1000, 2));
        for (channel, name) in ["a", "b"].into_iter().enumerate() {
            let all = file.read_transient(name, 0..ROWS).unwrap();
            assert!(all.iter().enumerate().all(|(row, v)| *v == value(channel, row)), "{name}");
        }
        for mode in 0..MODES {
            let all = file.read_transient(&modal_channel(mode), 0..ROWS).unwrap();
            assert!(all.iter().enumerate().all(|(row, v)| *v == f64::from(modal(mode, row))));
        }
        assert_eq!(happened(&file), events(0..ROWS, 2));
        let times = file.read_transient(TIME, 0..ROWS).unwrap();
        assert!(times.iter().enumerate().all(|(row, time)| *time == row as f64 * 1e-5));
    }

    #[test]
    fn times_are_the_coordinate_of_what_is_recorded_from_the_beginning() {
        let dir = tempfile::tempdir().unwrap();
        let mut file = ResultsFile::create(dir.path()).unwrap();
        begin(&mut file);
        let home = hdf5::File::open(dir.path().join("results.h5")).unwrap();
        let transient = home.group("transient").unwrap();
        let of = |path: &str, attribute: &str| transient.dataset(path).unwrap().attr(attribute);
        for scale in ["history/time_s", "events/time_s"] {
            assert!(of(scale, "CLASS").is_ok() && of(scale, "REFERENCE_LIST").is_ok(), "{scale}");
        }
        let history =
            ["a", "b", "modal_acceleration/1", "modal_acceleration/2"].map(|name| format!("history/{name}"));
        for path in history.iter().map(String::as_str).chain(["events/point", "events/kind"]) {
            assert_eq!(of(path, "DIMENSION_LIST").unwrap().shape(), [1], "{path}");
        }
        assert_eq!(
            transient.dataset("history/time_s").unwrap().read_1d::<f64>().unwrap()[ROWS - 1],
            4999.0 * 1e-5
        );
    }

    #[test]
    fn there_is_always_room_for_events() {
        let dir = tempfile::tempdir().unwrap();
        let mut file = ResultsFile::create(dir.path()).unwrap();
        begin(&mut file);
        let capacity = |file: &ResultsFile| {
            file.read(|root| Ok(root.dataset("transient/events/time_s")?.size())).unwrap()
        };
        assert_eq!(capacity(&file), events::FIRST);
        add(&mut file, 0..1500, 20);
        add(&mut file, 1500..ROWS, 20);
        assert!(capacity(&file) >= 20 * ROWS);
        // A copy has taken the place, and is the one that is written.
        let home = hdf5::File::open(dir.path().join("results.h5")).unwrap();
        let written = home.group("transient").unwrap().attr("events").unwrap().read_scalar::<u64>().unwrap();
        drop(home);
        assert_eq!(written as usize, 20 * ROWS);
        assert!(happened(&file) == self::events(0..ROWS, 20));
        let fit = |file: &mut ResultsFile| file.stage(|root| events::fit(&root.group("transient")?));
        fit(&mut file).unwrap();
        assert!(capacity(&file) == 20 * ROWS && happened(&file) == self::events(0..ROWS, 20));
    }
}
