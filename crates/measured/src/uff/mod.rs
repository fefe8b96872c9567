//! The Universal File Format of test-data programs (SDRC, *Universal File Datasets Summary*; binary form 58b by the
//! University of Cincinnati's Structural Dynamics Research Laboratory).
//!
//! | dataset | read | written |
//! |---|---|---|
//! | 15, 2411: points | yes | 15 |
//! | 55: modes, real and complex | yes | real |
//! | 58: functions, in text | yes | complex, double precision |
//! | 58b: functions, in IEEE 754 numbers of either byte order | yes | complex, double precision |
//! | 164: units | yes | SI |
//! | 151: header | skipped | |
//!
//! Anything else is skipped with a warning.

mod dataset;
mod file;
mod form;
mod function;
mod nodes;
mod record;
mod shape;
mod units;

pub use function::Function;
pub use shape::RealShape;

use super::records::TestRecords;
use std::collections::BTreeMap;
use stridor_base::error::{Faults, Result};

/// Datasets that say nothing about the test.
const SILENT: [u32; 1] = [151];

/// Reads the bytes of a universal file called `file`; lengths are in `unit` \[m\] where the file does not state it.
///
/// # Errors
/// Every dataset that cannot be read, with file and line, or the byte of binary numbers.
pub fn read(file: &str, bytes: &[u8], unit: f64) -> Result<TestRecords> {
    let mut records = TestRecords::default();
    let mut faults = Faults::new();
    let mut units = None;
    let mut skipped: BTreeMap<String, usize> = BTreeMap::new();
    let (mut local, mut unstated) = (Vec::new(), 0);
    for dataset in file::datasets(file, bytes)? {
        let mut skip = |what: String| *skipped.entry(what).or_insert(0) += 1;
        match dataset.kind {
            15 | 2411 => {
                let unit = units.map_or(unit, |u: units::UnitFactors| u.length);
                let found = faults.take(nodes::read(&dataset, unit, &mut records.points));
                local.extend(found.unwrap_or_default());
            }
            55 => match faults.take(shape::read(&dataset)) {
                Some(Ok(mode)) => records.modes.push(mode),
                Some(Err(what)) => skip(what),
                None => {}
            },
            58 => match faults.take(function::read(&dataset, units)) {
                Some(Ok((function, stated))) => {
                    unstated += usize::from(!stated);
                    records.functions.push(function);
                }
                Some(Err(what)) => skip(what),
                None => {}
            },
            164 => units = faults.take(units::read(&dataset)).or(units),
            kind if SILENT.contains(&kind) => {}
            kind => skip(format!("dataset {kind}")),
        }
    }
    let counted = |(what, count): (&String, &usize)| match count {
        1 => format!("{file}: skipped {what}"),
        count => format!("{file}: skipped {count} times {what}"),
    };
    records.warnings.extend(skipped.iter().map(counted));
    if unstated > 0 {
        let words = "frequency responses do not state their units; they are taken as SI";
        records.warnings.push(format!("{file}: {unstated} {words}"));
    }
    if let Some(first) = local.first() {
        let words = "are given in a coordinate system of their own; they are taken as global";
        records.warnings.push(format!("{file}: {} points, {first} the first, {words}", local.len()));
    }
    faults.0.truncate(20);
    faults.into_result(records)
}

/// A universal file in SI: units, points by label \[m\], real modes.
pub fn modes_text<'a>(
    title: &str,
    points: impl Iterator<Item = (u64, [f64; 3])>,
    modes: impl Iterator<Item = RealShape<'a>>,
) -> String {
    let modes: String = modes.map(|mode| shape::write(title, mode)).collect();
    units::SI.to_string() + &nodes::write(points) + &modes
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
