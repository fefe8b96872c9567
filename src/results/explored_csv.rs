//! `critical_values.csv`, `sweep_<name>.csv` and `map_<name>.csv`.

use super::explored_hdf5::kind_name;
use super::{MapResult, RunResults, SweepResult, write_result};
use crate::dataset::{CsvTable as Table, number};
use crate::error::Result;
use std::f64::consts::TAU;
use std::path::Path;

/// Writes the tables that the run has.
pub(super) fn write(dir: &Path, results: &RunResults) -> Result<()> {
    for result in &results.sweeps {
        write_result(dir, &format!("sweep_{}.csv", result.name), sweep(result).as_bytes())?;
    }
    for result in &results.maps {
        write_result(dir, &format!("map_{}.csv", result.name), map(result).as_bytes())?;
    }
    if !results.sweeps.is_empty() {
        write_result(dir, "critical_values.csv", critical(&results.sweeps).as_bytes())?;
    }
    Ok(())
}

fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_string() } else { format!("{name} [{unit}]") }
}

fn sweep(result: &SweepResult) -> String {
    let parameter = with_unit(&result.parameter, &result.unit);
    let mut table = Table::new(&["branch", &parameter, "frequency [Hz]", "growth rate [1/s]"]);
    for (b, branch) in result.sweep.branches.iter().enumerate() {
        for (k, z) in branch.eigenvalues.iter().enumerate() {
            let value = result.sweep.values[branch.first + k];
            table.row(&[(b + 1).to_string(), number(value), number(z.im / TAU), number(z.re)]);
        }
    }
    table.text
}

fn critical(all: &[SweepResult]) -> String {
    let mut table = Table::new(&[
        "sweep",
        "parameter",
        "unit",
        "critical value",
        "relative error",
        "frequency [Hz]",
        "kind",
        "becomes",
        "branch",
    ]);
    for result in all {
        for (k, c) in result.sweep.critical.iter().enumerate() {
            table.row(&[
                result.name.clone(),
                result.parameter.clone(),
                result.unit.clone(),
                number(c.value),
                number(result.value_error(k)),
                number(c.eigenvalue.im / TAU),
                kind_name(c.kind).to_string(),
                (if c.rises { "unstable" } else { "stable" }).to_string(),
                (c.branch + 1).to_string(),
            ]);
        }
    }
    table.text
}

fn map(result: &MapResult) -> String {
    let [a, b] = [0, 1].map(|k| with_unit(&result.parameters[k], &result.units[k]));
    let mut table =
        Table::new(&[&a, &b, "largest growth rate [1/s]", "its frequency [Hz]", "unstable modes"]);
    for (k, p) in result.points.iter().enumerate() {
        let n = result.axes[0].points;
        table.row(&[
            number(result.axes[0].value(k % n)),
            number(result.axes[1].value(k / n)),
            number(p.growth_rate),
            number(p.frequency_hz),
            p.unstable.to_string(),
        ]);
    }
    table.text
}
