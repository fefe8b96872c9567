//! The tables of a run as CSV files.

use super::{RunResults, TransientResult, summary, write_result};
use crate::dataset::{CsvTable, number};
use crate::error::Result;
use std::path::Path;

/// Writes every table that has a file into the folder `dir`.
///
/// # Errors
/// [`crate::error::Error::Io`] when the folder cannot be made or a file not be written.
pub(crate) fn write_csv(dir: &Path, results: &RunResults) -> Result<()> {
    for table in summary::analyses(results).tables() {
        if let Some(file) = &table.file {
            write_result(dir, file, table.to_csv().as_bytes())?;
        }
    }
    if let Some(transient) = &results.transient {
        for table in transient.sound.iter().map(super::Sound::spectrum) {
            write_result(dir, "sound_spectrum.csv", table.to_csv().as_bytes())?;
        }
        write_result(dir, "transient_spectrum.csv", spectra(transient).as_bytes())?;
    }
    Ok(())
}

fn spectra(transient: &TransientResult) -> String {
    let named: Vec<String> =
        transient.spectra.iter().map(|of| transient.channels[of.channel].heading()).collect();
    let headings: Vec<&str> =
        std::iter::once("frequency [Hz]").chain(named.iter().map(String::as_str)).collect();
    let mut table = CsvTable::new(&headings);
    let Some(first) = transient.spectra.first() else { return table.text };
    for k in 0..first.spectrum.amplitude.len() {
        let values = transient.spectra.iter().map(|of| number(of.spectrum.amplitude[k]));
        let row: Vec<String> =
            std::iter::once(number(first.spectrum.frequency_hz(k))).chain(values).collect();
        table.row(&row);
    }
    table.text
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    #[test]
    fn every_row_has_the_fields_of_its_header_and_reads_back_exactly() {
        let dir = tempfile::tempdir().unwrap();
        let results = sample::rig();
        write_csv(dir.path(), &results).unwrap();
        for name in ["modes_disc.csv", "modes_rig_with_closed_contact.csv", "contact_points.csv"] {
            let text = std::fs::read_to_string(dir.path().join(name)).unwrap();
            let width = text.lines().next().unwrap().split(',').count();
            assert!(
                text.lines().count() > 5 && text.lines().all(|l| l.split(',').count() == width),
                "{name}"
            );
        }
        let text = std::fs::read_to_string(dir.path().join("complex_modes.csv")).unwrap();
        let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
        assert_eq!(header[..4], ["mode", "frequency_hz", "growth_rate [1/s]", "damping_ratio"]);
        for (line, mode) in text.lines().skip(1).zip(&results.complex.as_ref().unwrap().modes.modes) {
            let fields: Vec<&str> = line.split(',').collect();
            assert_eq!(fields[1].parse::<f64>().unwrap(), mode.frequency_hz());
            assert_eq!(fields[2].parse::<f64>().unwrap(), mode.growth_rate());
            let part = |k: usize| header[k].starts_with("growth_") && k > 2;
            let budget: f64 =
                (0..header.len()).filter(|k| part(*k)).map(|k| fields[k].parse::<f64>().unwrap()).sum();
            assert!((budget - mode.growth_rate()).abs() < 1e-9 * (1.0 + mode.growth_rate().abs()));
        }
    }
}
