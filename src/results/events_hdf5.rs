//! `/transient/events` of `results.h5`: the events at the contact points, in datasets that are doubled when they are full.

use super::file::preallocated;
use super::{ResultsFile, TIME};
use crate::dataset::{attach_scale, describe, text_attribute};
use crate::error::Result;
use crate::transient::{Event, EventKind};
use hdf5::Group;
use ndarray::s;
use std::ops::Range;

const POINT: &str = "point";
const KIND: &str = "kind";
/// Number of events allocated at the start.
pub(super) const FIRST: usize = 1 << 14;
/// Events that are copied at once.
const AT_ONCE: usize = 1 << 16;

impl ResultsFile {
    /// Makes sure that some more events fit.
    pub(super) fn reserve_events(&mut self, more: usize) -> Result<()> {
        let (events, capacity) = self.read(|root| {
            let group = root.group("transient")?;
            Ok((count(&group)?, group.group("events")?.dataset(TIME)?.size()))
        })?;
        if events + more <= capacity {
            return Ok(());
        }
        let in_place = self.in_place();
        self.stage(|root| resize(&root.group("transient")?, (events + more).max(2 * capacity)))?;
        if in_place { self.take_place() } else { Ok(()) }
    }
}

/// How many there are.
pub(super) fn count(group: &Group) -> hdf5::Result<usize> {
    Ok(group.attr("events")?.read_scalar::<u64>()? as usize)
}

/// Adds events to those that count.
pub(super) fn write(group: &Group, events: &[Event]) -> hdf5::Result<()> {
    put(&group.group("events")?, count(group)?, events)
}

/// Truncates the datasets to the events recorded.
pub(super) fn fit(group: &Group) -> hdf5::Result<()> {
    resize(group, count(group)?)
}

pub(super) fn preallocate(group: &Group, events: usize) -> hdf5::Result<()> {
    let group = group.create_group("events")?;
    describe(&preallocated(&group, TIME, events, f64::NAN)?, "s", "when it happened")?;
    describe(&preallocated(&group, POINT, events, 0_u32)?, "1", "number of the contact point, from 1")?;
    let kind = preallocated(&group, KIND, events, 0_u8)?;
    describe(&kind, "1", "what it did: one of `flag_values`, which `flag_meanings` names")?;
    let values: Vec<u8> = EventKind::ALL.iter().map(|kind| *kind as u8).collect();
    kind.new_attr::<u8>().shape(values.len()).create("flag_values")?.write_raw(&values)?;
    text_attribute(&kind, "flag_meanings", &EventKind::ALL.map(EventKind::name).join(" "))?;
    attach_scale(&group, TIME, &[POINT, KIND].map(String::from))
}

fn resize(group: &Group, events: usize) -> hdf5::Result<()> {
    group.relink("events", "events_before")?;
    preallocate(group, events)?;
    let (from, to) = (group.group("events_before")?, group.group("events")?);
    let all = count(group)?;
    for first in (0..all).step_by(AT_ONCE) {
        put(&to, first, &read(&from, first..all.min(first + AT_ONCE))?)?;
    }
    group.unlink("events_before")
}

fn put(group: &Group, first: usize, events: &[Event]) -> hdf5::Result<()> {
    let part = s![first..first + events.len()];
    let time: Vec<f64> = events.iter().map(|e| e.time).collect();
    group.dataset(TIME)?.write_slice(&time, part)?;
    let point: Vec<u32> = events.iter().map(|e| e.point as u32 + 1).collect();
    group.dataset(POINT)?.write_slice(&point, part)?;
    let kind: Vec<u8> = events.iter().map(|e| e.kind as u8).collect();
    group.dataset(KIND)?.write_slice(&kind, part)
}

pub(super) fn read(group: &Group, part: Range<usize>) -> hdf5::Result<Vec<Event>> {
    let part = s![part];
    let time = group.dataset(TIME)?.read_slice_1d::<f64, _>(part)?;
    let point = group.dataset(POINT)?.read_slice_1d::<u32, _>(part)?;
    let kind = group.dataset(KIND)?.read_slice_1d::<u8, _>(part)?;
    let events = time.iter().zip(&point).zip(&kind).map(|((time, point), kind)| {
        let kind = EventKind::ALL.get(usize::from(*kind)).copied();
        let point = (*point as usize).checked_sub(1).ok_or("an event at no contact point")?;
        Ok(Event { time: *time, point, kind: kind.ok_or("an event of an unknown kind")? })
    });
    events.collect()
}
