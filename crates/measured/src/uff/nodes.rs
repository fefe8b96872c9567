//! Points: dataset 15 (single precision) and 2411 (double precision).

use super::systems::{System, Systems};
use std::collections::{BTreeMap, BTreeSet};
use stridor_base::error::{Error, Result};
use stridor_base::universal::record::e_format;
use stridor_base::universal::{Dataset, shown};

/// Fields of a line of dataset 15: label, two coordinate systems, colour, coordinates.
const SINGLE: [usize; 7] = [10, 10, 10, 10, 13, 13, 13];
/// Places of one point that differ by less than this share of them are one: dataset 15 has six digits.
const SAME: f64 = 2e-5;

/// A point as a dataset gives it.
#[derive(Debug, Clone)]
pub(super) struct PointRecord {
    label: u64,
    /// In the system `definition`.
    coordinates: [f64; 3],
    /// \[m\].
    unit: f64,
    /// Numbers of the systems of its coordinates and of its motion.
    definition: i64,
    displacement: i64,
    /// Whether its numbers have double precision.
    double: bool,
    /// The line.
    line: usize,
}

/// Reads dataset 15 or 2411, whose lengths are in `unit` \[m\]; points that cannot be read go to `lost`.
pub(super) fn read(
    dataset: &Dataset<'_>,
    unit: f64,
    points: &mut Vec<PointRecord>,
    lost: &mut impl FnMut(Error),
) {
    let double = dataset.kind == 2411;
    let step = if double { 2 } else { 1 };
    let mut index = 0;
    while index < dataset.lines.len() {
        if dataset.lines[index].text.trim().is_empty() {
            index += 1;
            continue;
        }
        match point(dataset, index, unit) {
            Ok(point) => {
                points.push(point);
                index += step;
            }
            // A line of the next point may follow.
            Err(error) => {
                lost(error);
                index += 1;
            }
        }
    }
}

/// The point at a line.
fn point(dataset: &Dataset<'_>, index: usize, unit: f64) -> Result<PointRecord> {
    let double = dataset.kind == 2411;
    let (head, numbers) = if double {
        let [label, definition, displacement, _] = dataset.wholes(index, [10; 4])?;
        ([label, definition, displacement], dataset.numbers(index + 1, &[25])?)
    } else {
        let fields = stridor_base::universal::record::fields(dataset.line(index)?, &SINGLE);
        let number = |field: &String| {
            stridor_base::universal::record::float(field)
                .ok_or_else(|| dataset.fault(index, shown(field), "a finite number"))
        };
        let numbers = fields.iter().map(number).collect::<Result<Vec<f64>>>()?;
        // Whole numbers that fit: labels have at most ten digits.
        ([0, 1, 2].map(|k| numbers[k] as i64), numbers[4..].to_vec())
    };
    let [x, y, z] = numbers[..] else {
        let found = format!("{} numbers", numbers.len());
        return Err(dataset.fault(index + usize::from(double), found, "three coordinates"));
    };
    let [label, definition, displacement] = head;
    let label = u64::try_from(label)
        .map_err(|_| dataset.fault(index, format!("label {label}"), "a label above zero"))?;
    let line = dataset.lines[index].number;
    Ok(PointRecord { label, coordinates: [x, y, z], unit, definition, displacement, double, line })
}

/// Where points are and along what their motion is, in the frame of the test.
#[derive(Debug, Default)]
pub(super) struct Placed {
    /// Places by label \[m\].
    pub points: BTreeMap<u64, [f64; 3]>,
    /// Directions of motion by label, where they are not x, y, z.
    pub axes: BTreeMap<u64, [[f64; 3]; 3]>,
    /// Points whose directions are not known.
    pub unknown: BTreeSet<u64>,
    /// Warnings.
    pub warnings: Vec<String>,
}

/// Places the points of the file called `file`.
///
/// A system that the file does not give and that all coordinates are in is the frame of the test. Other points in a system that
/// is not known are left out, and so are the data at points whose directions are not known.
pub(super) fn place(file: &str, records: &[PointRecord], systems: &Systems) -> Placed {
    let mut placed = Placed::default();
    let common = records.first().map(|first| first.definition);
    let common = common.filter(|number| records.iter().all(|record| record.definition == *number));
    let frame = common.filter(|number| systems.is_empty() && systems.find(*number).is_err());
    if let Some(number) = frame {
        placed.warnings.push(format!(
            "{file}: all points are in system {number}, which no dataset 18 or 2420 gives; it is taken as the frame of the test"
        ));
    }
    let find = |number: i64| match systems.find(number) {
        Err(_) if Some(number) == frame => systems.find(0),
        found => found,
    };
    let [mut nowhere, mut undirected]: [BTreeMap<String, Vec<u64>>; 2] = Default::default();
    let mut double: BTreeSet<u64> = BTreeSet::new();
    for record in records {
        let label = record.label;
        let place = match find(record.definition) {
            Ok(system) => system.place(record.coordinates, record.unit),
            Err(words) => {
                nowhere.entry(words).or_default().push(label);
                continue;
            }
        };
        let again = placed.points.get(&label).copied();
        if let Some(before) = again {
            let gap =
                [0, 1, 2].map(|k| place[k] - before[k]).iter().fold(0.0, |gap: f64, d| gap.max(d.abs()));
            let size = place.iter().chain(&before).fold(0.0, |size: f64, x| size.max(x.abs()));
            if gap > SAME * size {
                placed.warnings.push(format!(
                    "{file}:{}: point {label} again, at another place; the first one counts",
                    record.line
                ));
                continue;
            }
        }
        if again.is_none() || (record.double && !double.contains(&label)) {
            placed.points.insert(label, place);
        }
        if record.double {
            double.insert(label);
        }
        if again.is_some() {
            continue;
        }
        let directions = |system: System| match system.directions(place) {
            _ if system.is_global() => Ok(None),
            Some(axes) => Ok(Some(axes)),
            None => Err(format!("system {}, on whose axis it lies", record.displacement)),
        };
        match find(record.displacement).and_then(directions) {
            Ok(axes) => placed.axes.extend(axes.map(|axes| (label, axes))),
            Err(words) => {
                undirected.entry(words).or_default().push(label);
                placed.unknown.insert(label);
            }
        }
    }
    let told = |words: &str, labels: &[u64], what: &str| {
        let few: Vec<String> = labels.iter().take(8).map(u64::to_string).collect();
        let more = if labels.len() > few.len() { " …" } else { "" };
        format!("{file}: {what} in {words}: left out (points {}{more})", few.join(", "))
    };
    let lost = nowhere.iter().map(|(words, labels)| told(words, labels, "coordinates"));
    let data = undirected.iter().map(|(words, labels)| told(words, labels, "motion"));
    placed.warnings.extend(lost.chain(data));
    placed
}

/// Dataset 15 with points by label \[m\].
pub(super) fn write(points: impl Iterator<Item = (u64, [f64; 3])>) -> String {
    let mut text = String::from("    -1\n    15\n");
    for (label, [x, y, z]) in points {
        let number = |v| e_format(v, 13, 5);
        text += &format!("{label:10}{:10}{:10}{:10}{}{}{}\n", 0, 0, 1, number(x), number(y), number(z));
    }
    text + "    -1\n"
}

/// Dataset 2411 with points by label \[m\].
pub(super) fn write_double(points: impl Iterator<Item = (u64, [f64; 3])>) -> String {
    let mut text = String::from("    -1\n  2411\n");
    for (label, place) in points {
        let [x, y, z] = place.map(|v| e_format(v, 25, 16).replace('E', "D"));
        text += &format!("{label:10}{:10}{:10}{:10}\n{x}{y}{z}\n", 0, 0, 1);
    }
    text + "    -1\n"
}
