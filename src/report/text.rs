//! The tables for the terminal: aligned, at most 100 columns wide.

use super::finding::Finding;
use super::section::{Display, Item, ReportSection, findings};
use super::table::ReportTable;
use crate::results::RunResults;

const WIDTH: usize = 100;
/// More rows than this go to the CSV file only.
const ROWS: usize = 60;

/// Rows and columns of a table that the page keeps closed.
const CLOSED: [usize; 2] = [8, 6];

/// Everything the command line prints after a run: the tables of all sections, warnings, what was found.
pub fn summary(results: &RunResults) -> String {
    let sections = super::sections(results);
    let mut parts: Vec<String> = sections.iter().map(section).collect();
    parts.retain(|part| !part.is_empty());
    parts.extend(results.warnings.iter().map(|warning| wrap(&format!("Warning: {warning}"))));
    // The most urgent last, where the eye is.
    parts.extend(findings(&sections).iter().rev().map(|(_, finding)| verdict(finding)));
    parts.join("\n")
}

/// The tables and words of a section; its heading where no table has a caption.
fn section(section: &ReportSection) -> String {
    let titled = section.items.iter().any(|item| matches!(item, Item::Table(..)));
    let worded = section.items.iter().any(|item| matches!(item, Item::Words(_)));
    let heading = if worded && !titled { wrap(&section.heading) } else { String::new() };
    let mut parts: Vec<String> = Vec::new();
    for item in &section.items {
        match item {
            Item::Picture(_) | Item::Markup(_) | Item::Table(_, Display::Proof) => {}
            Item::Table(table, Display::Closed) => parts.push(render(&shortened(table))),
            Item::Table(table, _) => parts.push(render(table)),
            Item::Words(words) => match parts.last_mut() {
                Some(last) => last.push_str(&wrap(words)),
                None => parts.push(wrap(words)),
            },
        }
    }
    heading + &parts.join("\n")
}

/// The first rows and columns of a table.
fn shortened(table: &ReportTable) -> ReportTable {
    let [rows, columns] = CLOSED;
    let mut table = table.clone();
    table.rows.truncate(rows);
    table.columns.truncate(columns);
    table.rows.iter_mut().for_each(|row| row.cells.truncate(columns));
    table
}

/// What was found, with the table that belongs to it.
fn verdict(finding: &Finding) -> String {
    let sentence = wrap(&finding.words);
    match &finding.table {
        Some(table) if table.rows.is_empty() => sentence + &notes(table),
        Some(table) => format!("{sentence}\n{}", render(table)),
        None => sentence,
    }
}

pub(super) fn render(table: &ReportTable) -> String {
    let shown = &table.rows[..table.rows.len().min(ROWS)];
    let mut widths: Vec<usize> = table.columns.iter().map(|column| length(column.heading)).collect();
    for row in shown {
        widths.iter_mut().zip(&row.cells).for_each(|(width, cell)| *width = (*width).max(length(cell)));
    }
    let line = |cells: &[&str], lead: char| {
        let mut text = String::from(lead);
        for ((cell, width), column) in cells.iter().zip(&widths).zip(&table.columns) {
            text.push(' ');
            let blank = " ".repeat(width - length(cell));
            text.push_str(&if column.words { format!("{cell}{blank}") } else { format!("{blank}{cell}") });
            text.push(' ');
        }
        cut(text.trim_end()) + "\n"
    };
    let headings: Vec<&str> = table.columns.iter().map(|column| column.heading).collect();
    let mut text = format!("{}\n", cut(&table.caption)) + &line(&headings, ' ');
    let rule: usize = widths.iter().map(|width| width + 2).sum();
    text.push_str(&format!(" {}\n", "─".repeat(rule.min(WIDTH - 1))));
    for row in shown {
        let cells: Vec<&str> = row.cells.iter().map(String::as_str).collect();
        text.push_str(&line(&cells, if row.marked { '*' } else { ' ' }));
    }
    if shown.len() < table.rows.len() {
        text.push_str(&format!(" … and {} more in the results folder\n", table.rows.len() - shown.len()));
    }
    text + &notes(table)
}

fn notes(table: &ReportTable) -> String {
    table.notes.iter().map(|note| wrap(note)).collect()
}

fn length(text: &str) -> usize {
    text.chars().count()
}

/// At most [`WIDTH`] columns, the rest left out.
fn cut(text: &str) -> String {
    if length(text) <= WIDTH {
        return text.to_string();
    }
    text.chars().take(WIDTH - 1).chain(['…']).collect()
}

/// Lines of at most [`WIDTH`] columns, indented by one.
pub(super) fn wrap(text: &str) -> String {
    let (mut lines, mut line) = (String::new(), String::new());
    for word in text.split_whitespace() {
        if !line.is_empty() && length(&line) + length(word) + 2 > WIDTH {
            lines += &format!("{line}\n");
            line.clear();
        }
        line.push(' ');
        line.push_str(word);
    }
    lines + &cut(&line) + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::sample;
    use crate::results::{ComplexResult, NamedModes};

    #[test]
    fn tables_are_aligned_and_fit_the_terminal() {
        let mut results = sample::rig();
        results.get_mut::<ComplexResult>().unwrap().participation[0] = "a very long story ".repeat(20);
        let text = summary(&results);
        assert!(text.lines().all(|line| length(line) <= WIDTH), "{text}");
        let table = summary(&results);
        let ends: Vec<usize> =
            table.lines().filter_map(|l| l.find("UNSTABLE").map(|at| length(&l[..at]))).collect();
        assert_eq!(ends.len(), 3);
        assert!(ends.iter().all(|end| *end == ends[0]), "{table}");
    }

    #[test]
    fn measured_frequencies_stand_beside_their_modes() {
        let text = summary(&sample::rig());
        let row = text.lines().find(|line| line.contains("(4, 0)") && line.starts_with('*')).unwrap();
        // 974.8 Hz × 0.972 = 947.5 Hz, 1.23 % above 936 Hz.
        assert!(["974.8", "947.5", "936", "+1.23"].iter().all(|figure| row.contains(figure)), "{row}");
        assert!(text.contains("without a computed mode beside it: 2050 Hz"), "{text}");
        assert!(text.contains("None is missing"));
    }

    #[test]
    fn a_broken_certificate_and_a_stable_run_are_said() {
        let mut results = sample::rig();
        results.get_mut::<NamedModes>().unwrap().modes.certificate.counted = [21, 22];
        assert!(summary(&results).contains("NOT CERTIFIED"));
        results.get_mut::<ComplexResult>().unwrap().modes.modes.retain(|mode| !mode.unstable());
        let text = summary(&results);
        assert!(text.contains("Stable: none of the 11") && text.contains("936 Hz"), "{text}");
        assert_eq!(summary(&RunResults::default()), "");
    }
}
