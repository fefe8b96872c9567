//! Reads what tests found: the tables `[measured.NAME]` and their files.

use super::table::{MOST_FAULTS, TextTable};
use crate::case::{Case, MeasuredData, read_test};
use crate::error::read::{read_bytes, read_text};
use crate::error::{Error, Fault, Faults, Result};
use crate::measured::uff::{self, Unstated};
use crate::measured::{MeasuredSet, ModeRecord, TestRecords};
use crate::mesh::unit_in_metres;
use crate::numbers::significant;
use std::collections::BTreeMap;

/// The columns of a CSV file of modes.
const COLUMNS: [&str; 3] = ["frequency_hz", "damping_ratio", "deviation"];

/// The data of `[measured.NAME]`, and what the user should know about them. Every mode has a deviation: that of the file, or
/// that of the case.
///
/// # Errors
/// A file that is not there, of another kind, or whose content cannot be read; a file without modes and responses.
pub fn measured_set(case: &Case, name: &str) -> Result<(MeasuredSet, Vec<String>)> {
    let data = &case.measured[name];
    let mut records = match &data.file {
        None => listed(data),
        Some(file) => read_file(case, name, file)?,
    };
    let given = data.point.iter().filter_map(|(number, x)| Some((number.parse().ok()?, *x)));
    records.points.extend(given);
    let (mut set, mut warnings) = records.into_set();
    warnings.extend(in_percent(&set));
    for mode in &mut set.modes {
        mode.deviation.get_or_insert(data.deviation);
    }
    if set.modes.is_empty() && set.frfs.is_empty() {
        let place = format!("`measured.{name}.file`");
        let mut fault = Fault::new(place, "no mode and no frequency response in the file", "some of either");
        if !warnings.is_empty() {
            fault = fault.with_help(warnings.join("; "));
        }
        return Err(Error::input(fault));
    }
    Ok((set, warnings.into_iter().map(|warning| format!("Measured {name}: {warning}")).collect()))
}

/// The warning that damping ratios are most likely percentages: their median is that of no structure of metal, nor of a brake.
fn in_percent(set: &MeasuredSet) -> Option<String> {
    const LARGE: f64 = 0.05;
    let mut ratios: Vec<f64> = set.modes.iter().filter_map(|mode| mode.damping_ratio).collect();
    ratios.sort_by(f64::total_cmp);
    let median = *ratios.get(ratios.len() / 2)?;
    (median >= LARGE).then(|| {
        let [given, meant] = [median * 100.0, median].map(|percent| significant(percent, 3));
        format!(
            "damping ratios about {} mean {given} %: if {meant} % is meant, divide them by 100",
            significant(median, 3)
        )
    })
}

/// The frequencies in the case itself.
fn listed(data: &MeasuredData) -> TestRecords {
    let mode = |(k, hz): (usize, &f64)| ModeRecord {
        frequency_hz: *hz,
        damping_ratio: data.damping_ratios.get(k).copied(),
        deviation: None,
        shape: BTreeMap::new(),
    };
    TestRecords { modes: data.frequencies.iter().enumerate().map(mode).collect(), ..TestRecords::default() }
}

fn read_file(case: &Case, name: &str, file: &str) -> Result<TestRecords> {
    let data = &case.measured[name];
    let unstated = Unstated { unit: unit_in_metres(data.transform.unit.word()), quantity: data.quantity };
    let path = case.folder.join(file);
    let shown = path.display().to_string();
    let kind = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let key = format!("`measured.{name}.file`");
    match kind.as_str() {
        "csv" => modes_of(&TextTable::read(&path, &COLUMNS[..1], &COLUMNS)?),
        "toml" => read_test(&shown, &read_text(&path, "a test in TOML")?),
        "uff" | "unv" | "uf" | "ufb" => uff::read(&shown, &read_bytes(&path, "a universal file")?, unstated),
        _ => Err(Error::input(Fault::new(key, format!("\"{file}\""), "a file .uff, .unv, .csv or .toml"))),
    }
}

/// The modes in the CSV `text` of the file `name`: a heading that names the columns, then one mode a line.
///
/// # Errors
/// Every fault of the heading, and the first faults of the lines.
pub fn read_modes(name: &str, text: &str) -> Result<TestRecords> {
    modes_of(&TextTable::parse(name.to_string(), text.to_string(), &COLUMNS[..1], &COLUMNS)?)
}

fn modes_of(table: &TextTable) -> Result<TestRecords> {
    let mut faults = Faults::new();
    let mut modes = Vec::new();
    for row in table.rows() {
        if faults.0.len() >= MOST_FAULTS {
            break;
        }
        let mut share = |column: &str, low: f64| {
            if row.cell(column).is_empty() {
                return None;
            }
            let value = row.number(column, low, &mut faults);
            if !(low..1.0).contains(&value) {
                let place = format!("{} `{column}`", row.place());
                let fault = Fault::new(place, format!("{value}"), format!("a share from {low} to below 1"));
                faults.push(fault.with_help("Divide percentages by 100"));
            }
            Some(value)
        };
        let (damping_ratio, deviation) = (share(COLUMNS[1], 0.0), share(COLUMNS[2], f64::MIN_POSITIVE));
        let frequency_hz = row.number(COLUMNS[0], 0.0, &mut faults);
        if frequency_hz <= 0.0 {
            let place = format!("{} `{}`", row.place(), COLUMNS[0]);
            faults.push(Fault::new(place, format!("\"{}\"", row.cell(COLUMNS[0])), "a frequency above zero"));
        }
        modes.push(ModeRecord { frequency_hz, damping_ratio, deviation, shape: BTreeMap::new() });
    }
    faults.0.truncate(MOST_FAULTS);
    faults.into_result(TestRecords { modes, warnings: table.warnings(), ..TestRecords::default() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(file: &str, content: &[u8]) -> Result<(MeasuredSet, Vec<String>)> {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join(file), content).unwrap();
        let text = format!(
            "[point]\na = [0, 0, 0]\n[modes.m]\ncount = 1\n[measured.t]\nof = \"m\"\nfile = \"{file}\"\n"
        );
        measured_set(&Case::parse("case", &text, dir.path().into()).unwrap(), "t")
    }

    #[test]
    fn a_table_gives_modes_in_order_and_the_case_their_deviation() {
        let (set, _) =
            set("a.csv", b"frequency_hz;damping_ratio;deviation\n936;;0.01\n330;0.002;\n").unwrap();
        assert_eq!(set.modes.iter().map(|m| m.frequency_hz).collect::<Vec<_>>(), [330.0, 936.0]);
        assert_eq!((set.modes[0].damping_ratio, set.modes[0].deviation), (Some(0.002), Some(0.005)));
        assert_eq!((set.modes[1].damping_ratio, set.modes[1].deviation), (None, Some(0.01)));
    }

    #[test]
    fn wrong_files_are_told() {
        let said = |file: &str, content: &[u8]| set(file, content).unwrap_err().to_string();
        assert!(said("a.xlsx", b"").contains("a.xlsx") && said("a.csv", b"hz\n1\n").contains("frequency_hz"));
        let wrong = said("a.csv", b"frequency_hz,deviation\n-1,0.1\n330,2\nx,\n");
        assert!(["a.csv:2", "a.csv:3 `deviation`", "a.csv:4"].iter().all(|p| wrong.contains(p)), "{wrong}");
        assert!(said("a.csv", b"frequency_hz\n").contains("no mode and no frequency response"));
        let (_, told) = set("a.csv", b"frequency_hz,damping_ratio\n330,0.3\n936,0.2\n").unwrap();
        assert!(told[0].contains("about 0.300 mean 30.0 %") && told[0].contains("0.300 %"), "{told:?}");
        assert!(set("a.csv", b"frequency_hz,damping_ratio\n330,0.003\n").unwrap().1.is_empty());
        assert!(said("a.uff", b"    -1\n  2412\n    -1\n").contains("dataset 2412"));
        assert!(said("a.toml", b"x = 1\n").contains("a.toml:1 `x`"));
    }
}
