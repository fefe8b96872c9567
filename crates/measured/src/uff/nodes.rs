//! Points: dataset 15 (single precision) and 2411 (double precision).

use super::dataset::{Dataset, shown};
use super::record::e_format;
use std::collections::BTreeMap;
use stridor_base::error::Result;

/// Fields of a line of dataset 15: label, two coordinate systems, colour, coordinates.
const SINGLE: [usize; 7] = [10, 10, 10, 10, 13, 13, 13];

/// Reads dataset 15 or 2411; lengths are multiplied by `unit` \[m\]. Gives the labels whose coordinates are not global.
pub(super) fn read(
    dataset: &Dataset<'_>,
    unit: f64,
    points: &mut BTreeMap<u64, [f64; 3]>,
) -> Result<Vec<u64>> {
    let mut local = Vec::new();
    let double = dataset.kind == 2411;
    let mut index = 0;
    while index < dataset.lines.len() {
        if dataset.line(index)?.trim().is_empty() {
            index += 1;
            continue;
        }
        let (head, numbers) = if double {
            let head = dataset.wholes(index, [10, 10, 10, 10])?;
            let numbers = dataset.numbers(index + 1, &[25])?;
            (head, numbers)
        } else {
            let numbers = super::record::fields(dataset.line(index)?, &SINGLE);
            let number = |field: &String| {
                super::record::float(field)
                    .ok_or_else(|| dataset.fault(index, shown(field), "a finite number"))
            };
            let numbers = numbers.iter().map(number).collect::<Result<Vec<f64>>>()?;
            // Whole numbers that fit: labels have at most ten digits.
            ([numbers[0] as i64, numbers[1] as i64, 0, 0], numbers[4..].to_vec())
        };
        let [x, y, z] = numbers[..] else {
            let found = format!("{} numbers", numbers.len());
            return Err(dataset.fault(index + usize::from(double), found, "three coordinates"));
        };
        let label = u64::try_from(head[0])
            .map_err(|_| dataset.fault(index, format!("label {}", head[0]), "a label above zero"))?;
        if points.insert(label, [x, y, z].map(|c| c * unit)).is_some() {
            return Err(dataset.fault(index, format!("point {label} again"), "each point once"));
        }
        // 0 and 1 are the global system.
        local.extend((head[1] > 1).then_some(label));
        index += if double { 2 } else { 1 };
    }
    Ok(local)
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
