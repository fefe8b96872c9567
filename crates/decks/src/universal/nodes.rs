//! Nodes (15, 781, 2411) and the coordinate systems that they are in (2420).

use crate::deck::{Deck, Node, Place};
use crate::ledger::Weight;
use crate::text::Files;
use std::collections::BTreeMap;
use stridor_base::error::{Error, Result};
use stridor_base::universal::record::{fields, float};
use stridor_base::universal::{Dataset, shown};

/// Columns of a line of dataset 15: label, systems of coordinates and of motion, colour, x, y, z.
const SINGLE: [usize; 7] = [10, 10, 10, 10, 13, 13, 13];

/// The nodes of a file, in the systems that they are given in.
#[derive(Debug, Default)]
pub(super) struct Nodes {
    all: Vec<Record>,
    systems: BTreeMap<i64, System>,
}

#[derive(Debug)]
struct Record {
    label: u64,
    system: i64,
    coordinates: [f64; 3],
    place: Place,
}

/// Kind 0 is Cartesian, 1 cylindrical with angles in degrees; unit vectors and origin in x, y, z.
#[derive(Debug)]
struct System {
    kind: i64,
    axes: [[f64; 3]; 3],
    origin: [f64; 3],
}

impl Nodes {
    /// Reads a dataset of nodes.
    pub fn read(&mut self, dataset: &Dataset<'_>, file: u32, faults: &mut impl FnMut(Error)) {
        let step = if dataset.kind == 15 { 1 } else { 2 };
        let mut index = 0;
        while index < dataset.lines.len() {
            let line = &dataset.lines[index];
            if line.text.trim().is_empty() {
                index += 1;
                continue;
            }
            let place = Place { file, line: line.number as u32 };
            match node(dataset, index, place) {
                Ok(node) => self.all.push(node),
                Err(error) => faults(error),
            }
            index += step;
        }
    }

    /// Reads dataset 2420: a part with its name, then number and kind, a name, unit vectors and the origin of each system.
    pub fn systems(&mut self, dataset: &Dataset<'_>, faults: &mut impl FnMut(Error)) {
        let mut index = 2;
        while index + 5 < dataset.lines.len() {
            let read = dataset.wholes(index, [10; 3]).and_then(|[number, kind, _]| {
                let rows = [2, 3, 4, 5].map(|k| three(dataset, index + k));
                let [x, y, z, origin] = rows;
                Ok((number, System { kind, axes: [x?, y?, z?], origin: origin? }))
            });
            match read {
                Ok((number, system)) => _ = self.systems.insert(number, system),
                Err(error) => faults(error),
            }
            index += 6;
        }
    }

    /// Nodes by number, in x, y, z.
    pub fn finish(mut self, deck: &mut Deck, files: &mut Files) {
        self.all.sort_by_key(|node| (node.label, node.place));
        let nodes = std::mem::take(&mut self.all);
        for Record { label, system, coordinates, place } in nodes {
            let position = match self.systems.get(&system) {
                _ if system == 0 => coordinates,
                Some(system) => match system.place(coordinates) {
                    Some(position) => position,
                    None => {
                        let found = format!("node {label} in a coordinate system of kind {}", system.kind);
                        files.fault(place, found, "a Cartesian (0) or a cylindrical one (1)");
                        continue;
                    }
                },
                // The first one is the global system of most writers.
                None => {
                    if system != 1 {
                        let why =
                            "coordinates in a system that the file does not give are taken as global ones";
                        deck.ledger.note(Weight::Matters, format!("coordinate system {system}"), why, place);
                    }
                    coordinates
                }
            };
            match deck.nodes.last() {
                Some(last) if last.number == label && last.position == position => {
                    let why = "the same place again";
                    deck.ledger.note(Weight::Nothing, "nodes that stand twice", why, place);
                }
                Some(last) if last.number == label => {
                    let found = format!("node {label} at another place than in line {}", last.place.line);
                    files.fault(place, found, "each node once");
                }
                _ => deck.nodes.push(Node { number: label, position, place }),
            }
        }
    }
}

impl System {
    fn place(&self, [a, b, c]: [f64; 3]) -> Option<[f64; 3]> {
        let own = match self.kind {
            0 => [a, b, c],
            1 => {
                let (sin, cos) = b.to_radians().sin_cos();
                [a * cos, a * sin, c]
            }
            _ => return None,
        };
        Some(std::array::from_fn(|k| self.origin[k] + (0..3).map(|i| own[i] * self.axes[i][k]).sum::<f64>()))
    }
}

/// The node at a line.
fn node(dataset: &Dataset<'_>, index: usize, place: Place) -> Result<Record> {
    let (label, system, coordinates) = if dataset.kind == 15 {
        let fields = fields(dataset.line(index)?, &SINGLE);
        let number = |field: &String| {
            float(field).ok_or_else(|| dataset.fault(index, shown(field), "a finite number"))
        };
        let numbers = fields.iter().map(number).collect::<Result<Vec<f64>>>()?;
        // Whole numbers that fit: labels have at most ten digits.
        (numbers[0] as i64, numbers[1] as i64, [numbers[4], numbers[5], numbers[6]])
    } else {
        let [label, system, ..] = dataset.wholes(index, [10; 4])?;
        (label, system, three(dataset, index + 1)?)
    };
    match u64::try_from(label) {
        Ok(label) if label > 0 => Ok(Record { label, system, coordinates, place }),
        _ => Err(dataset.fault(index, format!("node {label}"), "a number of a node above zero")),
    }
}

/// Three numbers of a line.
fn three(dataset: &Dataset<'_>, index: usize) -> Result<[f64; 3]> {
    let numbers = dataset.numbers(index, &[25])?;
    let count = numbers.len();
    <[f64; 3]>::try_from(numbers)
        .map_err(|_| dataset.fault(index, format!("{count} numbers"), "three coordinates"))
}
