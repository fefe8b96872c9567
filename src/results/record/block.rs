//! Blocks of `record.bin`: a byte for the kind, the length of the payload (8 bytes), the payload.

use super::bytes::{Bytes, Read, RecordCursor};
use crate::linalg::c64;
use crate::results::{FieldSnapshot, NodalField, RecordPiece};
use crate::sweep::{MapPoint, SampleModes};
use crate::transient::{Event, EventKind};

/// Bytes before the payload of a block.
pub(super) const HEAD: usize = 9;

/// Something that was computed.
#[derive(Debug, Clone, PartialEq)]
pub enum RecordBlock {
    /// A map begins, or begins again with more places that its reduced model is trained on.
    Map {
        /// The map.
        name: String,
        /// The places.
        trained: Vec<[f64; 2]>,
    },
    /// Points of a map.
    MapPoints {
        /// The map.
        name: String,
        /// The first of them.
        first: usize,
        /// Theirs.
        points: Vec<MapPoint>,
    },
    /// Samples of a study of uncertain scalars.
    Samples {
        /// The study.
        name: String,
        /// The first of them.
        first: usize,
        /// Theirs.
        modes: Vec<SampleModes>,
    },
    /// A run in time begins.
    Transient {
        /// The name of each channel.
        channels: Vec<String>,
        /// Real modes whose accelerations are recorded.
        modes: usize,
    },
    /// Rows of the run in time.
    Rows {
        /// The first of them.
        first: usize,
        /// The values of each channel.
        values: Vec<Vec<f64>>,
        /// The accelerations of each real mode.
        modal: Vec<Vec<f32>>,
        /// Events at the contact points.
        events: Vec<Event>,
    },
    /// The motion of all nodes.
    Field {
        /// How many came before.
        number: usize,
        /// Displacement \[m\] and velocity \[m/s\], in single precision; rotations are not kept.
        motion: [NodalField<f64>; 2],
    },
}

fn block(kind: u8, write: impl FnOnce(&mut Bytes)) -> Vec<u8> {
    let mut bytes = Bytes(vec![0; HEAD]);
    write(&mut bytes);
    let length = (bytes.0.len() - HEAD) as u64;
    bytes.0[0] = kind;
    bytes.0[1..HEAD].copy_from_slice(&length.to_le_bytes());
    bytes.0
}

pub(super) fn map(name: &str, trained: &[[f64; 2]]) -> Vec<u8> {
    block(1, |bytes| {
        bytes.text(name);
        bytes.count(trained.len());
        bytes.doubles(trained.as_flattened());
    })
}

pub(super) fn map_points(name: &str, first: usize, points: &[MapPoint]) -> Vec<u8> {
    block(2, |bytes| {
        bytes.text(name);
        bytes.count(first);
        bytes.count(points.len());
        for MapPoint { growth_rate, frequency_hz, unstable } in points {
            bytes.doubles([growth_rate, frequency_hz]);
            bytes.0.extend(unstable.to_le_bytes());
        }
    })
}

pub(super) fn samples(name: &str, first: usize, modes: &[SampleModes]) -> Vec<u8> {
    block(6, |bytes| {
        bytes.text(name);
        bytes.count(first);
        bytes.count(modes.len());
        for sample in modes {
            // Zero of one without an answer.
            bytes.count(sample.as_ref().map_or(0, |modes| modes.len() + 1));
            sample.iter().flatten().for_each(|z| bytes.doubles([&z.re, &z.im]));
        }
    })
}

pub(super) fn transient<'a>(channels: impl ExactSizeIterator<Item = &'a str>, modes: usize) -> Vec<u8> {
    block(3, |bytes| {
        bytes.count(modes);
        bytes.count(channels.len());
        channels.for_each(|name| bytes.text(name));
    })
}

pub(super) fn rows(piece: &RecordPiece) -> Vec<u8> {
    block(4, |bytes| {
        bytes.count(piece.first);
        bytes.count(piece.values.first().map_or(0, Vec::len));
        bytes.count(piece.values.len());
        piece.values.iter().for_each(|values| bytes.doubles(values));
        bytes.count(piece.modal.len());
        piece.modal.iter().for_each(|values| bytes.singles(values.iter().copied()));
        bytes.count(piece.events.len());
        for Event { time, point, kind } in piece.events {
            bytes.doubles([time]);
            bytes.count(*point);
            bytes.0.push(*kind as u8);
        }
    })
}

pub(super) fn field(field: &FieldSnapshot) -> Vec<u8> {
    block(5, |bytes| {
        bytes.count(field.number);
        bytes.count(field.displacement.len());
        for motion in [field.displacement, field.velocity] {
            motion.iter().for_each(|node| bytes.singles(node[..3].iter().map(|value| *value as f32)));
        }
    })
}

impl RecordBlock {
    /// The block of this kind with this payload.
    pub(super) fn read(kind: u8, payload: &[u8]) -> Read<RecordBlock> {
        let mut from = RecordCursor(payload);
        let block = match kind {
            1 => {
                let name = from.text()?;
                let count = from.count(16)?;
                let trained = from.doubles(2 * count)?.chunks_exact(2).map(|at| [at[0], at[1]]).collect();
                RecordBlock::Map { name, trained }
            }
            2 => {
                let name = from.text()?;
                let first = from.index()?;
                let count = from.count(20)?;
                let point = |_| {
                    let values = from.doubles(2)?;
                    let unstable = u32::from_le_bytes(from.array()?);
                    Ok(MapPoint { growth_rate: values[0], frequency_hz: values[1], unstable })
                };
                let points = (0..count).map(point).collect::<Read<_>>()?;
                RecordBlock::MapPoints { name, first, points }
            }
            3 => {
                let modes = from.index()?;
                let count = from.count(8)?;
                let channels = (0..count).map(|_| from.text()).collect::<Read<_>>()?;
                RecordBlock::Transient { channels, modes }
            }
            4 => read_rows(&mut from)?,
            5 => {
                let number = from.index()?;
                let nodes = from.count(24)?;
                RecordBlock::Field {
                    number,
                    motion: [read_motion(&mut from, nodes)?, read_motion(&mut from, nodes)?],
                }
            }
            6 => {
                let name = from.text()?;
                let first = from.index()?;
                let count = from.count(8)?;
                let modes = (0..count).map(|_| read_sample(&mut from)).collect::<Read<_>>()?;
                RecordBlock::Samples { name, first, modes }
            }
            _ => return Err("a block of an unknown kind"),
        };
        from.end(block)
    }
}

fn read_sample(from: &mut RecordCursor) -> Read<SampleModes> {
    let Some(modes) = from.index()?.checked_sub(1) else { return Ok(None) };
    let values = from.doubles(2 * modes)?;
    Ok(Some(values.chunks_exact(2).map(|z| c64::new(z[0], z[1])).collect()))
}

fn read_rows(from: &mut RecordCursor) -> Read<RecordBlock> {
    let first = from.index()?;
    let rows = from.count(8)?;
    if rows == 0 {
        return Err("a block without rows");
    }
    let channels = from.count(8 * rows)?;
    let values = (0..channels).map(|_| from.doubles(rows)).collect::<Read<_>>()?;
    let modes = from.count(4 * rows)?;
    let modal = (0..modes).map(|_| from.singles(rows)).collect::<Read<_>>()?;
    let count = from.count(17)?;
    let event = |_| {
        let time = f64::from_le_bytes(from.array()?);
        let point = from.index()?;
        let [kind] = from.array()?;
        let kind = EventKind::ALL.get(usize::from(kind)).copied().ok_or("an event of an unknown kind")?;
        Ok(Event { time, point, kind })
    };
    let events = (0..count).map(event).collect::<Read<_>>()?;
    Ok(RecordBlock::Rows { first, values, modal, events })
}

fn read_motion(from: &mut RecordCursor, nodes: usize) -> Read<NodalField<f64>> {
    let values = from.singles(3 * nodes)?;
    Ok(values.chunks_exact(3).map(|v| [v[0], v[1], v[2], 0.0, 0.0, 0.0].map(f64::from)).collect())
}
