//! Tables and sentences for the terminal, of the width of its window.

use super::finding::Finding;
use super::lines::wrap;
use super::section::{Display, Item, ReportSection, findings};
use super::table::ReportTable;
use super::text_table::{notes, render};
use crate::results::RunResults;

/// Rows and columns that a window shows of a table that the page keeps closed.
const CLOSED: [usize; 2] = [8, 6];

/// Everything the command line prints after a run: the tables of all sections, warnings, what was found.
///
/// Lines have at most `width` columns; without a width, such as in a file, tables are as wide and as long as they are.
pub fn summary(results: &RunResults, width: Option<usize>) -> String {
    let sections = super::sections(results);
    let mut parts: Vec<String> = sections.iter().map(|part| section(part, width)).collect();
    parts.retain(|part| !part.is_empty());
    parts.extend(results.warnings.iter().map(|warning| wrap(&format!("Warning: {warning}"), width)));
    // The most urgent last, where the eye is.
    parts.extend(findings(&sections).iter().rev().map(|(_, finding)| verdict(finding, width)));
    parts.join("\n")
}

/// The tables and words of a section; its heading where no table has a caption.
fn section(section: &ReportSection, width: Option<usize>) -> String {
    let titled = section.items.iter().any(|item| matches!(item, Item::Table(..)));
    let worded = section.items.iter().any(|item| matches!(item, Item::Words(_)));
    let heading = if worded && !titled { wrap(&section.heading, width) } else { String::new() };
    let mut parts: Vec<String> = Vec::new();
    for item in &section.items {
        match item {
            Item::Picture(_) | Item::Markup(_) | Item::Table(_, Display::Proof) => {}
            Item::Table(table, Display::Closed) if width.is_some() => {
                parts.push(render(&shortened(table), width));
            }
            Item::Table(table, _) => parts.push(render(table, width)),
            Item::Words(words) => match parts.last_mut() {
                Some(last) => last.push_str(&wrap(words, width)),
                None => parts.push(wrap(words, width)),
            },
        }
    }
    heading + &parts.join("\n")
}

/// The first rows and columns of a table, and how many more there are.
fn shortened(table: &ReportTable) -> ReportTable {
    let [rows, columns] = CLOSED;
    let mut table = table.clone();
    let more = [(table.rows.len(), rows, "rows"), (table.columns.len(), columns, "columns")];
    let more = more.iter().filter(|(all, shown, _)| all > shown);
    let more: Vec<String> = more.map(|(all, shown, what)| format!("{} more {what}", all - shown)).collect();
    if !more.is_empty() {
        table.notes.push(format!("… and {} in the results folder", more.join(" and ")));
    }
    table.rows.truncate(rows);
    table.columns.truncate(columns);
    table.rows.iter_mut().for_each(|row| row.cells.truncate(columns));
    table
}

/// What was found, with the table that belongs to it.
fn verdict(finding: &Finding, width: Option<usize>) -> String {
    let sentence = wrap(&finding.words, width);
    match &finding.table {
        Some(table) if table.rows.is_empty() => sentence + &notes(table, width),
        Some(table) => format!("{sentence}\n{}", render(table, width)),
        None => sentence,
    }
}

#[cfg(test)]
mod tests {
    use super::super::complex;
    use super::super::lines::length;
    use super::*;
    use crate::job::sample;
    use crate::results::{ComplexResult, NamedModes};

    #[test]
    fn tables_are_aligned_fit_the_window_and_say_all() {
        let mut results = sample::rig();
        results.get_mut::<ComplexResult>().unwrap().participation[0] = "a very long story ".repeat(20);
        let words = |text: &str| -> Vec<String> {
            let mut words: Vec<String> = text.split_whitespace().map(str::to_string).collect();
            words.retain(|word| !word.starts_with('─') && word != "*");
            words.sort();
            words.dedup();
            words
        };
        let whole = summary(&results, None);
        let modes = |width| {
            let mut sections = complex::sections(&results);
            // A window shows the first rows and columns of a closed table.
            sections[0].items.retain(|item| !matches!(item, Item::Table(_, Display::Closed)));
            let found: String =
                findings(&sections).iter().map(|(_, finding)| verdict(finding, width)).collect();
            section(&sections[0], width) + &found
        };
        for width in [60, 80, 120] {
            let text = summary(&results, Some(width));
            assert!(text.lines().all(|line| length(line) <= width), "{text}");
            let (whole, text) = (modes(None), modes(Some(width)));
            let missing: Vec<String> =
                words(&whole).into_iter().filter(|w| !words(&text).contains(w)).collect();
            assert!(missing.is_empty(), "at {width} columns {missing:?} are not in\n{text}");
        }
        let ends: Vec<usize> =
            whole.lines().filter_map(|l| l.find("UNSTABLE").map(|at| length(&l[..at]))).collect();
        assert_eq!(ends.len(), 3);
        assert!(ends.iter().all(|end| *end == ends[0]), "{whole}");
    }

    #[test]
    fn measured_frequencies_stand_beside_their_modes() {
        let text = summary(&sample::rig(), Some(100));
        let row = text.lines().find(|line| line.contains("(4, 0)") && line.starts_with('*')).unwrap();
        // 955.4 Hz × 0.97 = 926.7 Hz, 0.99 % below 936 Hz.
        assert!(["955.4", "926.7", "936", "−0.99"].iter().all(|figure| row.contains(figure)), "{row}");
        assert!(text.contains("without a computed mode beside it: 2050 Hz"), "{text}");
        assert!(text.contains("None is missing"));
    }

    #[test]
    fn a_broken_certificate_and_a_stable_run_are_said() {
        let mut results = sample::rig();
        results.get_mut::<NamedModes>().unwrap().modes.certificate.counted = [21, 22];
        assert!(summary(&results, None).contains("NOT CERTIFIED"));
        results.get_mut::<ComplexResult>().unwrap().modes.modes.retain(|mode| !mode.unstable());
        let text = summary(&results, None);
        assert!(text.contains("Stable: none of the 13") && text.contains("936 Hz"), "{text}");
        assert_eq!(summary(&RunResults::default(), None), "");
    }
}
