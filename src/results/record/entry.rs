//! Entries of a record as bytes: one for the kind, then the content.

use super::bytes::{Bytes, Read, RecordCursor};
use super::origin::RecordOrigin;
use super::part::Part;
use crate::error::{Error, Fault, Faults, Result};
use crate::linalg::c64;
use crate::results::{FieldSnapshot, NodalField, RecordPiece};
use crate::sweep::Modes;
use crate::transient::{Event, EventKind};
use faer::Mat;

/// Something that was computed, or what it is of.
#[derive(Debug, Clone)]
pub enum Entry {
    /// The first of every record.
    Head(Head),
    /// SHA-256 of M Φ of the real modes by which the shapes that follow are compared.
    Reference([u8; 32]),
    /// Modes of a study at a place, or why there are none.
    Answer {
        /// Table of the study in the case: `sweep.NAME`, `map.NAME`, `uncertainty.NAME`.
        study: String,
        /// The bits of the values of its scalars.
        place: Vec<u64>,
        /// The modes.
        modes: Result<Modes>,
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
    /// The work has ended by itself, with results or without.
    End,
}

/// What a record is of.
#[derive(Debug, Clone, PartialEq)]
pub struct Head {
    /// Version and commit of the program.
    pub program: String,
    /// The case and the files it reads.
    pub origin: RecordOrigin,
    /// Which part of the studies it is of, if it is not of all.
    pub part: Option<Part>,
}

impl Head {
    pub(super) fn new(origin: RecordOrigin, part: Option<Part>) -> Self {
        let commit = crate::COMMIT.unwrap_or("unknown commit");
        Head { program: format!("{} ({commit})", env!("CARGO_PKG_VERSION")), origin, part }
    }
}

fn entry(kind: u8, write: impl FnOnce(&mut Bytes)) -> Vec<u8> {
    let mut bytes = Bytes(vec![kind]);
    write(&mut bytes);
    bytes.0
}

pub(super) fn head(Head { program, origin, part }: &Head) -> Vec<u8> {
    entry(0, |bytes| {
        bytes.text(program);
        origin.write(bytes);
        let Part { of, number } = part.unwrap_or(Part { of: 0, number: 0 });
        bytes.count(of);
        bytes.count(number);
    })
}

pub(super) fn reference(digest: &[u8; 32]) -> Vec<u8> {
    entry(1, |bytes| bytes.0.extend(digest))
}

pub(super) fn answer(study: &str, place: &[u64], modes: &Result<Modes>) -> Vec<u8> {
    entry(2, |bytes| {
        bytes.text(study);
        bytes.count(place.len());
        place.iter().for_each(|value| bytes.0.extend(value.to_le_bytes()));
        write_modes(bytes, modes);
    })
}

pub(super) fn transient<'a>(channels: impl ExactSizeIterator<Item = &'a str>, modes: usize) -> Vec<u8> {
    entry(3, |bytes| {
        bytes.count(modes);
        bytes.count(channels.len());
        channels.for_each(|name| bytes.text(name));
    })
}

pub(super) fn rows(piece: &RecordPiece) -> Vec<u8> {
    entry(4, |bytes| {
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
    entry(5, |bytes| {
        bytes.count(field.number);
        bytes.count(field.displacement.len());
        for motion in [field.displacement, field.velocity] {
            motion.iter().for_each(|node| bytes.singles(node[..3].iter().map(|value| *value as f32)));
        }
    })
}

pub(super) fn end() -> Vec<u8> {
    entry(6, |_| ())
}

impl Entry {
    /// Its bytes.
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        match self {
            Entry::Head(of) => head(of),
            Entry::Reference(digest) => reference(digest),
            Entry::Answer { study, place, modes } => answer(study, place, modes),
            Entry::Transient { channels, modes } => transient(channels.iter().map(String::as_str), *modes),
            Entry::Rows { first, values, modal, events } => {
                let checkpoint = &Default::default();
                rows(&RecordPiece { first: *first, values, modal, events, checkpoint })
            }
            Entry::Field { number, motion: [displacement, velocity] } => {
                field(&FieldSnapshot { number: *number, displacement, velocity })
            }
            Entry::End => end(),
        }
    }

    /// The entry with these bytes.
    pub(super) fn read(bytes: &[u8]) -> Read<Entry> {
        let mut from = RecordCursor(bytes);
        let [kind] = from.array()?;
        let entry = match kind {
            0 => {
                let program = from.text()?;
                let origin = RecordOrigin::read(&mut from)?;
                let part = Part { of: from.index()?, number: from.index()? };
                Entry::Head(Head { program, origin, part: (part.of > 0).then_some(part) })
            }
            1 => Entry::Reference(from.array()?),
            2 => {
                let study = from.text()?;
                let values = from.count(8)?;
                let place = (0..values).map(|_| from.whole()).collect::<Read<_>>()?;
                Entry::Answer { study, place, modes: read_modes(&mut from)? }
            }
            3 => {
                let modes = from.index()?;
                let count = from.count(8)?;
                let channels = (0..count).map(|_| from.text()).collect::<Read<_>>()?;
                Entry::Transient { channels, modes }
            }
            4 => read_rows(&mut from)?,
            5 => {
                let number = from.index()?;
                let nodes = from.count(24)?;
                Entry::Field {
                    number,
                    motion: [read_motion(&mut from, nodes)?, read_motion(&mut from, nodes)?],
                }
            }
            6 => Entry::End,
            _ => return Err("an entry of an unknown kind"),
        };
        from.end(entry)
    }
}

fn read_rows(from: &mut RecordCursor) -> Read<Entry> {
    let first = from.index()?;
    let rows = from.count(8)?;
    if rows == 0 {
        return Err("an entry without rows");
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
    Ok(Entry::Rows { first, values, modal, events })
}

fn read_motion(from: &mut RecordCursor, nodes: usize) -> Read<NodalField<f64>> {
    let values = from.singles(3 * nodes)?;
    Ok(values.chunks_exact(3).map(|v| [v[0], v[1], v[2], 0.0, 0.0, 0.0].map(f64::from)).collect())
}

fn write_modes(bytes: &mut Bytes, modes: &Result<Modes>) {
    let mut kind = |kind: u8| bytes.0.push(kind);
    match modes {
        Ok(Modes { eigenvalues, vectors }) => {
            kind(0);
            bytes.count(eigenvalues.len());
            bytes.count(vectors.nrows());
            let shapes = (0..vectors.ncols()).flat_map(|k| vectors.col_as_slice(k));
            eigenvalues.iter().chain(shapes).for_each(|z| bytes.doubles([&z.re, &z.im]));
        }
        Err(Error::Analysis { what, found, help }) => {
            kind(1);
            [what, found, help].into_iter().for_each(|text| bytes.text(text));
        }
        Err(Error::Io { path, source, help }) => {
            kind(2);
            [&path.display().to_string(), &source.to_string(), help]
                .into_iter()
                .for_each(|text| bytes.text(text));
        }
        Err(Error::Input(Faults(faults))) => {
            kind(3);
            bytes.count(faults.len());
            let texts = faults.iter().flat_map(|f| [&f.place, &f.found, &f.expected, &f.help]);
            texts.for_each(|text| bytes.text(text));
        }
    }
}

fn read_modes(from: &mut RecordCursor) -> Read<Result<Modes>> {
    let [kind] = from.array()?;
    Ok(match kind {
        0 => {
            let count = from.count(16)?;
            let rows = from.count(16 * count)?;
            let mut complex = |count: usize| -> Read<Vec<c64>> {
                let values = from.doubles(2 * count)?;
                Ok(values.chunks_exact(2).map(|z| c64::new(z[0], z[1])).collect())
            };
            let (eigenvalues, shapes) = (complex(count)?, complex(rows * count)?);
            Ok(Modes { eigenvalues, vectors: Mat::from_fn(rows, count, |i, j| shapes[i + rows * j]) })
        }
        1 => Err(Error::analysis(from.text()?, from.text()?, from.text()?)),
        2 => Err(Error::io(from.text()?, from.text()?, from.text()?)),
        3 => {
            let count = from.count(32)?;
            let fault = |_| {
                let fault = Fault::new(from.text()?, from.text()?, from.text()?);
                Ok(fault.with_help(from.text()?))
            };
            Err(Error::Input(Faults((0..count).map(fault).collect::<Read<_>>()?)))
        }
        _ => return Err("an answer of an unknown kind"),
    })
}
