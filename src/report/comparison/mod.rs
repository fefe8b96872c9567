//! What was measured beside what was computed: tables, the MAC of shapes, frequencies with their scatter, responses.

mod frequencies;
mod mac;
mod responses;
mod table;

pub(super) use responses::{Curve, Panel, stacked};
pub(super) use table::{modes_table, responses_table};

use super::html::{escape, figure, titled_table};
use crate::results::{FileNames, MeasuredComparison, NamedModes, RunResults, write_result};
use std::ops::Range;
use std::path::Path;

/// A picture with its file name and its caption.
struct Drawn {
    file: String,
    caption: String,
    svg: String,
}

/// Writes `mac_<name>.svg`, `frequencies_<name>.svg` and `measured_frf_<name>.svg` into the folder.
pub(super) fn write(dir: &Path, results: &RunResults) -> crate::error::Result<()> {
    let (mut names, mut frf_names) = (FileNames::default(), FileNames::default());
    let modes = results.measured.iter().flat_map(|c| mode_pictures(c, results, &names.next(&c.name)));
    for drawn in modes.collect::<Vec<_>>() {
        write_result(dir, &drawn.file, drawn.svg.as_bytes())?;
    }
    for responses in &results.measured_frfs {
        let drawn = responses::picture(responses, &frf_names.next(&responses.name));
        drawn.into_iter().try_for_each(|d| write_result(dir, &d.file, d.svg.as_bytes()))?;
    }
    Ok(())
}

fn mode_pictures(comparison: &MeasuredComparison, results: &RunResults, name: &str) -> Vec<Drawn> {
    let Some(set) = results.modes.get(comparison.modes) else { return Vec::new() };
    [mac::picture(comparison, set, name), frequencies::picture(comparison, set, name)]
        .into_iter()
        .flatten()
        .collect()
}

/// The part of the page on measured data; empty when the run has none.
pub(super) fn section(results: &RunResults) -> String {
    let mut body = String::new();
    let draw = |drawn: &Drawn| figure(&drawn.svg, &drawn.caption);
    for comparison in &results.measured {
        let Some(table) = modes_table(results, comparison) else { continue };
        body += &format!("<h2>Measured beside computed modes: {}</h2>\n", escape(&comparison.name));
        body += &mode_pictures(comparison, results, "").iter().map(draw).collect::<String>();
        body += &titled_table(&table);
    }
    for measured in &results.measured_frfs {
        body += &format!("<h2>Measured beside computed responses: {}</h2>\n", escape(&measured.name));
        body += &responses::picture(measured, "").iter().map(draw).collect::<String>();
        body += &titled_table(&responses_table(measured));
    }
    body
}

/// What a level is called: `(2, 0) ×2`, `mode 7`.
fn level_name(set: &NamedModes, level: &Range<usize>) -> String {
    let name = match set.names.get(level.start).copied().flatten() {
        Some(name) => format!("({}, {})", name.nodal_diameters, name.nodal_circles),
        None => format!("mode {}", level.start + 1),
    };
    if level.len() > 1 { format!("{name} ×{}", level.len()) } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::sample;

    #[test]
    fn both_sides_are_told_with_what_has_no_partner() {
        let results = sample::rig();
        let table = modes_table(&results, &results.measured[0]).unwrap();
        // 974.8 Hz × 0.972 = 947.5 Hz beside 936 Hz.
        let row = &table.rows[1].cells;
        assert!(
            ["936", "947.5", "+1.23", "0.97", "(4, 0) ×2"].iter().all(|c| row.iter().any(|cell| cell == c)),
            "{row:?}"
        );
        assert!(table.rows[3].cells.iter().any(|cell| cell == "none"));
        let notes = table.notes.join(" ");
        assert!(notes.contains("(3, 0) ×2 566.3 Hz") && notes.contains("1.20 mm"), "{notes}");
        assert!(
            !notes.contains("(2, 0)") && !notes.contains("2570"),
            "paired, or beyond the measured: {notes}"
        );
        let responses = responses_table(&results.measured_frfs[0]);
        assert!(responses.rows[0].cells.iter().any(|c| c == "1.000"), "{:?}", responses.rows);
        assert!(responses.notes.join(" ").contains("inside"));
    }

    #[test]
    fn every_picture_is_written_and_stands_on_the_page() {
        let dir = tempfile::tempdir().unwrap();
        let results = sample::rig();
        write(dir.path(), &results).unwrap();
        let section = section(&results);
        for file in ["mac_impact.svg", "frequencies_impact.svg", "measured_frf_impact.svg"] {
            let svg = std::fs::read_to_string(dir.path().join(file)).unwrap();
            assert!(svg.starts_with("<svg") && section.contains(&svg) && !svg.contains("NaN"), "{file}");
        }
        let mut bare = results;
        bare.measured[0].mac = vec![Vec::new(); 4];
        assert_eq!(mode_pictures(&bare.measured[0], &bare, "x").len(), 1, "no shapes, no mac");
    }
}
