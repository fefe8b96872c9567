//! The tables of a run as CSV files.

use super::{FileNames, RunResults, summary, write_result};
use crate::error::Result;
use std::path::Path;

/// Writes every table that has a file into the folder `dir`.
pub(crate) fn write_csv(dir: &Path, results: &RunResults) -> Result<()> {
    let mut names = FileNames::default();
    for table in summary::analyses(results).tables() {
        if let Some(file) = &table.file {
            let file = format!("{}.csv", names.once(file.clone()));
            write_result(dir, &file, table.to_csv().as_bytes())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::job::sample;
    use crate::results::ComplexResult;

    #[test]
    fn every_row_has_the_fields_of_its_header_and_reads_back_exactly() {
        let dir = tempfile::tempdir().unwrap();
        let results = sample::rig();
        write_csv(dir.path(), &results).unwrap();
        for name in ["modes_disc.csv", "modes_rig.csv", "contact_points.csv"] {
            let text = std::fs::read_to_string(dir.path().join(name)).unwrap();
            // Commas in quotes are part of names, as of (2, 0).
            let width =
                |line: &str| line.split('"').step_by(2).map(|s| s.matches(',').count()).sum::<usize>();
            let header = width(text.lines().next().unwrap());
            assert!(text.lines().count() > 5 && text.lines().all(|l| width(l) == header), "{name}");
        }
        let text = std::fs::read_to_string(dir.path().join("complex_modes.csv")).unwrap();
        let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
        assert_eq!(header[..4], ["mode", "frequency_hz", "growth_rate [1/s]", "damping_ratio"]);
        for (line, mode) in text.lines().skip(1).zip(&results.get::<ComplexResult>().unwrap().modes.modes) {
            let fields: Vec<&str> = line.split(',').collect();
            assert_eq!(fields[1].parse::<f64>().unwrap(), mode.frequency_hz());
            assert_eq!(fields[2].parse::<f64>().unwrap(), mode.growth_rate());
            let part = |k: usize| header[k].starts_with("growth_") && k > 2;
            let budget: f64 =
                (0..header.len()).filter(|k| part(*k)).map(|k| fields[k].parse::<f64>().unwrap()).sum();
            assert!(within((budget - mode.growth_rate()).abs(), 1e-9 * mode.eigenvalue.norm(), RoundOff));
        }
    }
}
