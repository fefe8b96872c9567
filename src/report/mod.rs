//! The report: tables for the terminal and the page, pictures as SVG, and one self-contained HTML page.
//!
//! * [`text`]: the tables that the command line prints.
//! * [`write_validation`]: the page of the validation suite.
//! * [`write_report`]: `report.html` and the pictures `rig.svg`, `modes_disc.svg`, `contact.svg`, `growth.svg`,
//!   `growth_budget.svg`, `participation.svg`, `sensitivity.svg`, `advice.svg`, `transient.svg`, `transient_spectrum.svg`,
//!   `transient_spectrogram.svg`, `transient_phase.svg`, `transient_contact.svg`, `sound.svg`, `frf_<name>.svg`, those of them that the run has something for;
//!   `mac_<name>.svg`, `frequencies_<name>.svg` and `measured_frf_<name>.svg` of measured data;
//!   `sweep_<name>.svg`, `root_locus_<name>.svg` and `map_<name>.svg` of every sweep and map.
//!
//! A table is made once and shown in either form; a picture is a pure function from the results to SVG.

mod advice;
mod axes;
mod budget;
mod calibration;
mod chart;
mod colours;
mod comparison;
mod contact;
mod contours;
mod disc_modes;
mod explored;
mod format;
mod frf;
mod growth;
mod html;
mod magnitude;
mod participation;
mod plate;
mod reduced_check;
mod rig;
mod search;
mod svg;
mod tables;
pub mod text;
mod tornado;
mod transient;
mod validation;
mod view;

pub use search::{search_text, write_search};
pub use validation::write_validation;

use crate::error::Result;
use crate::results::{RunResults, write_result};
use html::Picture;
use std::path::Path;

/// Writes `report.html` and its pictures into the folder `dir`.
///
/// # Errors
/// [`crate::error::Error::Io`] when the folder cannot be made or a file not be written.
pub fn write_report(dir: &Path, results: &RunResults) -> Result<()> {
    let pictures = pictures(results);
    for picture in &pictures {
        write_result(dir, picture.file, picture.svg.as_bytes())?;
    }
    explored::write(dir, results)?;
    frf::write(dir, results)?;
    comparison::write(dir, results)?;
    write_result(dir, "report.html", html::page(results, &pictures).as_bytes())
}

/// Every picture that the run has something for.
fn pictures(results: &RunResults) -> Vec<Picture> {
    let all = [
        rig::picture(results),
        disc_modes::picture(results),
        contact::picture(results),
        growth::picture(results),
        budget::picture(results),
        participation::picture(results),
        tornado::picture(results),
        advice::picture(results),
    ];
    let more = transient::pictures(results).into_iter().chain(calibration::pictures(results));
    all.into_iter().flatten().chain(more).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::sample;

    #[test]
    fn every_picture_stands_beside_the_page_and_in_it() {
        let dir = tempfile::tempdir().unwrap();
        write_report(dir.path(), &sample::rig()).unwrap();
        let page = std::fs::read_to_string(dir.path().join("report.html")).unwrap();
        for file in [
            "rig.svg",
            "modes_disc.svg",
            "contact.svg",
            "growth.svg",
            "growth_budget.svg",
            "participation.svg",
            "sensitivity.svg",
            "advice.svg",
            "sweep_over_friction.svg",
            "root_locus_over_friction.svg",
            "map_load_and_speed.svg",
        ]
        .into_iter()
        .chain(transient::FILES)
        {
            let svg = std::fs::read_to_string(dir.path().join(file)).unwrap();
            assert!(svg.starts_with("<svg") && page.contains(&svg), "{file}");
        }
    }

    #[test]
    fn a_run_with_nothing_has_a_page_and_no_pictures() {
        let dir = tempfile::tempdir().unwrap();
        write_report(dir.path(), &RunResults::default()).unwrap();
        let mut files: Vec<_> =
            std::fs::read_dir(dir.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        files.sort();
        assert_eq!(files, [".files", "report.html"]);
    }
}
