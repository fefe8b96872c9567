//! The report: tables for the terminal and the page, pictures as SVG, and one self-contained HTML page.
//!
//! * [`text`]: the tables that the command line prints.
//! * [`write_validation`]: the page of the validation suite.
//! * [`write_report`]: `report.html` and the pictures `rig.svg`, `modes_disc.svg`, `contact.svg`, `growth.svg`,
//!   `growth_budget.svg`, `participation.svg`, `part_shares.svg`, `sensitivity.svg`, `advice.svg`, `transient.svg`, `transient_spectrum.svg`,
//!   `transient_spectrogram.svg`, `transient_phase.svg`, `transient_contact.svg`, `sound.svg`, `frf_<name>.svg`, those of them that the run has something for;
//!   `mac_<name>.svg`, `frequencies_<name>.svg` and `measured_frf_<name>.svg` of measured data;
//!   `sweep_<name>.svg`, `sweep_<name>_places.svg`, `root_locus_<name>.svg` and `map_<name>.svg` of every sweep and map;
//!   `uncertainty_<name>.svg`, `…_growth.svg` and `…_scalars.svg` of every study of uncertain scalars.
//!
//! The page's scripts: `shapes/viewer.js` moves the mode shapes, `charts.js` shows values under the pointer and zooms.
//!
//! [`chart`] is the one chart under all pictures with axes, [`svg`] the sheet that it and the drawings of models are on.
//!
//! Each analysis has a function that gives its sections from the results: what it found in a sentence with its class, tables and
//! words, which are shown in either form, and pictures, each a pure function from the results to SVG. `SECTIONS` lists them. The
//! findings of all sections come first on the page, the most urgent before the others, and last on the terminal.

mod advice;
mod axis;
mod budget;
mod calibration;
pub mod chart;
mod colours;
mod comparison;
mod complex;
mod contact;
mod contact_face;
mod contact_plane;
mod contours;
mod disc_modes;
mod explored;
mod finding;
mod format;
mod frf;
mod growth;
mod html;
mod lines;
mod magnitude;
mod page;
mod part_shares;
mod participation;
mod plate;
mod player;
mod provenance;
mod real_modes;
mod reduced_check;
mod rig;
mod search;
mod section;
mod sensitivity;
mod shapes;
mod squeal;
mod steady;
pub mod svg;
mod table;
pub mod text;
mod text_table;
mod tornado;
mod transient;
mod uncertainty;
mod validation;
mod view;

pub use search::{search_text, write_search};
pub use validation::write_validation;

use crate::error::Result;
use crate::results::{FileNames, RunResults, write_result, written_files};
use section::ReportSection;
use std::path::Path;

/// Sections of each analysis, in the order of the report: one line an analysis.
const SECTIONS: [fn(&RunResults) -> Vec<ReportSection>; 12] = [
    rig::sections,
    shapes::sections,
    real_modes::sections,
    comparison::sections,
    frf::sections,
    steady::sections,
    complex::sections,
    sensitivity::sections,
    transient::sections,
    explored::sections,
    uncertainty::sections,
    calibration::sections,
];

/// The sections that a run has something for.
fn sections(results: &RunResults) -> Vec<ReportSection> {
    SECTIONS.iter().flat_map(|section| section(results)).collect()
}

/// Writes `report.html` and its pictures into the folder `dir`.
///
/// # Errors
/// [`crate::error::Error::Io`] when the folder cannot be made or a file not be written.
pub fn write_report(dir: &Path, results: &RunResults) -> Result<()> {
    let sections = sections(results);
    let mut names = FileNames::default();
    for picture in sections.iter().flat_map(ReportSection::drawn) {
        let file = format!("{}.svg", names.once(picture.file.clone()));
        write_result(dir, &file, picture.svg.as_bytes())?;
    }
    write_result(dir, "report.html", page::page(results, &sections, written_files(dir)).as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;

    #[test]
    fn every_picture_stands_beside_the_page_and_in_it() {
        let dir = tempfile::tempdir().unwrap();
        write_report(dir.path(), &sample::rig()).unwrap();
        let page = std::fs::read_to_string(dir.path().join("report.html")).unwrap();
        let files = "rig modes_disc mac_impact frequencies_impact measured_frf_hammer frf_hammer contact growth growth_budget \
                     participation part_shares sensitivity advice transient transient_spectrum transient_spectrogram transient_phase \
                     transient_contact sound sweep_friction sweep_friction_places root_locus_friction map_friction_and_speed \
                     uncertainty_all uncertainty_all_growth uncertainty_all_scalars \
                     calibration_errors calibration_responses calibration_numbers";
        for file in files.split(' ').map(|stem| format!("{stem}.svg")) {
            let svg = std::fs::read_to_string(dir.path().join(&file)).unwrap();
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
