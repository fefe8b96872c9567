//! The Universal File Format of test-data programs (SDRC, *Universal File Datasets Summary*; binary form 58b by the
//! University of Cincinnati's Structural Dynamics Research Laboratory).
//!
//! | dataset | read | written |
//! |---|---|---|
//! | 15, 2411: points | yes | 15 with functions, 2411 with modes |
//! | 18, 2420: coordinate systems of points and of their motion, Cartesian and cylindrical | yes | |
//! | 55: modes, real and complex | yes | real |
//! | 58: functions, in text | yes | complex, double precision |
//! | 58b: functions, in IEEE 754 numbers of either byte order | yes | complex, double precision |
//! | 164: units | yes | SI |
//! | 2412: elements | skipped | with modes |
//! | 151: header | skipped | |
//!
//! Anything else is skipped with a warning. What cannot be used costs itself: a point, a mode, a response or a frequency of it is
//! left out with a warning that names file, line and reason.

mod elements;
mod function;
mod nodes;
mod shape;
mod systems;
mod units;

pub use elements::Element;
pub use function::Function;
pub use shape::RealShape;

use super::records::TestRecords;
use super::set::Quantity;
use std::collections::BTreeMap;
use stridor_base::error::read::utf_16;
use stridor_base::error::{Error, Result};
use stridor_base::universal::datasets;
use systems::Systems;

/// Datasets that say nothing about the test.
const SILENT: [u32; 1] = [151];
/// Elements of a model.
const ELEMENTS: u32 = 2412;

/// The most warnings of records that are left out.
const TOLD: usize = 20;

/// What is taken of a file where it does not state it.
#[derive(Debug, Clone, Copy)]
pub struct Unstated {
    /// The unit of lengths \[m\].
    pub unit: f64,
    /// What responses of unknown ordinates are.
    pub quantity: Option<Quantity>,
}

/// Reads the bytes of a universal file called `file`.
///
/// # Errors
/// A file without any dataset. What else cannot be read is left out with a warning.
pub fn read(file: &str, bytes: &[u8], unstated: Unstated) -> Result<TestRecords> {
    let text = utf_16(bytes);
    let bytes = text.as_ref().map_or(bytes, |text| text.as_bytes());
    let mut records = TestRecords::default();
    let mut lost = LeftOut::default();
    let mut units = None;
    let mut skipped: BTreeMap<String, usize> = BTreeMap::new();
    let (mut points, mut systems) = (Vec::new(), Systems::default());
    let (mut without_unit, mut elements) = (0, 0);
    for dataset in datasets(file, bytes, &mut |error| lost.note(error))? {
        let mut skip = |what: String| *skipped.entry(what).or_insert(0) += 1;
        let length = units.map_or(unstated.unit, |u: units::UnitFactors| u.length);
        match dataset.kind {
            15 | 2411 => nodes::read(&dataset, length, &mut points, &mut |error| lost.note(error)),
            18 | 2420 => _ = lost.take(systems.read(&dataset, length)),
            55 => match lost.take(shape::read(&dataset)) {
                Some(Ok(mode)) => records.modes.push(mode),
                Some(Err(what)) => skip(what),
                None => {}
            },
            58 => match lost.take(function::read(&dataset, units, unstated.quantity)) {
                Some(Ok(read)) => {
                    without_unit += usize::from(!read.stated);
                    records.functions.push(read.record);
                    lost.0.extend(read.left_out);
                }
                Some(Err(what)) => skip(what),
                None => {}
            },
            164 => units = lost.take(units::read(&dataset)).or(units),
            ELEMENTS => elements += 1,
            kind if SILENT.contains(&kind) => {}
            kind => skip(format!("dataset {kind}")),
        }
    }
    // A model beside what was measured is as it should be, alone it is not what is sought.
    if elements > 0 && records.modes.is_empty() && records.functions.is_empty() {
        skipped.insert(format!("dataset {ELEMENTS}"), elements);
    }
    let counted = |(what, count): (&String, &usize)| match count {
        1 => format!("{file}: skipped {what}"),
        count => format!("{file}: skipped {count} times {what}"),
    };
    records.warnings = lost.warnings(file);
    records.warnings.extend(skipped.iter().map(counted));
    if without_unit > 0 {
        let words = "frequency responses do not state their units; they are taken as SI";
        records.warnings.push(format!("{file}: {without_unit} {words}"));
    }
    place(file, &mut records, &points, &systems);
    Ok(records)
}

/// Gives points their places and motions their directions, in the frame of the test.
fn place(file: &str, records: &mut TestRecords, points: &[nodes::PointRecord], systems: &Systems) {
    let placed = nodes::place(file, points, systems);
    for mode in &mut records.modes {
        mode.shape.retain(|label, _| !placed.unknown.contains(label));
    }
    for function in &mut records.functions {
        for (label, direction) in [&mut function.excitation, &mut function.response] {
            if let Some(axes) = placed.axes.get(label) {
                let own = *direction;
                *direction = [0, 1, 2].map(|k| (0..3).map(|axis| own[axis] * axes[axis][k]).sum());
            }
        }
    }
    let stated =
        |(label, direction): &(u64, [f64; 3])| *direction == [0.0; 3] || !placed.unknown.contains(label);
    records.functions.retain(|function| stated(&function.excitation) && stated(&function.response));
    records.warnings.extend(placed.warnings);
    (records.points, records.axes) = (placed.points, placed.axes);
}

/// What cannot be used, in words.
#[derive(Default)]
struct LeftOut(Vec<String>);

impl LeftOut {
    fn note(&mut self, error: Error) {
        match error {
            Error::Input(faults) => self.0.extend(faults.0.iter().map(|fault| {
                format!("{}: found {}; expected {}: left out", fault.place, fault.found, fault.expected)
            })),
            other => self.0.push(other.to_string()),
        }
    }

    fn take<T>(&mut self, result: Result<T>) -> Option<T> {
        result.map_err(|error| self.note(error)).ok()
    }

    /// The first of them, and how many there are.
    fn warnings(mut self, file: &str) -> Vec<String> {
        let more = self.0.len().saturating_sub(TOLD);
        self.0.truncate(TOLD);
        if more > 0 {
            self.0.push(format!("{file}: {more} records more were left out"));
        }
        self.0
    }
}

/// A universal file in SI: units, points by label \[m\], real modes.
pub fn modes_text<'a>(
    title: &str,
    points: impl Iterator<Item = (u64, [f64; 3])>,
    elements: impl Iterator<Item = Element>,
    modes: impl Iterator<Item = RealShape<'a>>,
) -> String {
    let modes: String = modes.map(|mode| shape::write(title, mode)).collect();
    units::SI.to_string() + &nodes::write_double(points) + &elements::write(elements) + &modes
}

/// A universal file in SI: units, points by label \[m\], frequency responses with their numbers in text or `binary`.
pub fn functions_file<'a>(
    points: impl Iterator<Item = (u64, [f64; 3])>,
    functions: impl Iterator<Item = Function<'a>>,
    binary: bool,
) -> Vec<u8> {
    let write = if binary { function::write_binary } else { function::write };
    let mut bytes = (units::SI.to_string() + &nodes::write(points)).into_bytes();
    bytes.extend(functions.flat_map(|f| write(&f)));
    bytes
}

#[cfg(test)]
mod tests;
