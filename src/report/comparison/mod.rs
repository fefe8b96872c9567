//! Measured beside computed: tables, the MAC of shapes, frequencies with their scatter, responses.

mod finding;
mod frequencies;
mod level;
mod mac;
mod responses;
mod table;

pub(super) use responses::{HEIGHTS, MOST};
use table::{modes_table, responses_table};

use super::section::{Display, Picture, ReportSection};
use crate::results::{MeasuredComparison, MeasuredResponses, NamedModes, RunResults};

/// Every test beside what was computed.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    let sets = results.all::<NamedModes>();
    let modes = results.all::<MeasuredComparison>().into_iter().filter_map(|test| {
        let set = sets.iter().find(|set| test.is_of(set))?;
        let section = ReportSection::new(format!("Measured beside computed modes: {}", test.name));
        let section = section.findings([finding::modes(test)]);
        Some(section.pictures(pictures(test, set)).tables(Display::Titled, [modes_table(test, set)]))
    });
    let responses = results.all::<MeasuredResponses>().into_iter().map(|test| {
        let section = ReportSection::new(format!("Measured beside computed responses: {}", test.name));
        let section = section.findings([finding::responses(test)]);
        section.pictures(responses::picture(test)).tables(Display::Titled, [responses_table(test)])
    });
    modes.chain(responses).collect()
}

fn pictures(test: &MeasuredComparison, set: &NamedModes) -> impl Iterator<Item = Picture> {
    [mac::picture(test, set), frequencies::picture(test, set)].into_iter().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;

    #[test]
    fn both_sides_are_told_with_what_has_no_partner() {
        let results = sample::rig();
        let table = modes_table(results.all::<MeasuredComparison>()[0], results.all::<NamedModes>()[0]);
        // 955.4 Hz × 0.97 = 926.7 Hz beside 936 Hz.
        let row = &table.rows[1].cells;
        assert!(
            ["936", "926.7", "−0.99", "0.97", "(4, 0) ×2"].iter().all(|c| row.iter().any(|cell| cell == c)),
            "{row:?}"
        );
        assert!(table.rows[3].cells.iter().any(|cell| cell == "none"));
        let notes = table.notes.join(" ");
        assert!(notes.contains("(3, 0) ×2 549.7 Hz") && notes.contains("7.39 mm"), "{notes}");
        assert!(
            !notes.contains("(2, 0)") && !notes.contains("2501"),
            "paired, or beyond the measured: {notes}"
        );
        let responses = responses_table(results.all::<MeasuredResponses>()[0]);
        assert!(responses.rows[0].cells.iter().any(|c| c == "0.489"), "{:?}", responses.rows);
        assert!(responses.notes.join(" ").contains("side"));
    }

    #[test]
    fn without_shapes_there_is_no_picture_of_the_mac() {
        let results = sample::rig();
        let set = results.all::<NamedModes>()[0];
        let test = results.all::<MeasuredComparison>()[0].clone();
        assert_eq!(pictures(&test, set).count(), 2);
        let bare = MeasuredComparison { mac: vec![Vec::new(); 4], ..test };
        assert_eq!(pictures(&bare, set).count(), 1);
    }
}
