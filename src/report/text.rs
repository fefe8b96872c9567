//! The tables for the terminal: aligned, at most 100 columns wide.

use super::explored::{critical_table, damping_table, map_words, sweep_words};
use super::tables::{self, Table};
use crate::results::RunResults;

const WIDTH: usize = 100;
/// More rows than this go to the CSV file only.
const ROWS: usize = 60;

/// Everything the command line prints after a run: modes, steady sliding, complex eigenvalues, the verdict.
pub fn summary(results: &RunResults) -> String {
    let mut parts: Vec<String> = (0..results.modes.len()).map(|k| modes(results, k)).collect();
    let compared = results.measured.iter().filter_map(|c| super::comparison::modes_table(results, c));
    parts.extend(compared.map(|table| render(&table)));
    let responses = results.measured_frfs.iter().map(super::comparison::responses_table);
    parts.extend(responses.map(|table| render(&table)));
    parts.extend(results.frfs.iter().map(|frf| render(&super::frf::table(frf))));
    parts.extend([steady(results), complex(results)].into_iter().flatten());
    parts.extend(sensitivity(results));
    parts.extend(results.transient.iter().map(|run| render(&super::transient::table(run))));
    parts.extend(sound(results));
    let check = results.transient.iter().filter_map(|run| run.reduced_check.as_ref());
    parts.extend(check.map(|check| render(&super::reduced_check::table(check, results.complex.as_ref()))));
    parts.extend(explored(results));
    parts.extend(calibration(results));
    parts.extend(results.warnings.iter().map(|warning| wrap(&format!("Warning: {warning}"))));
    parts.push(verdict(results));
    parts.join("\n")
}

/// What the sweeps and maps found, and what damping decides.
fn explored(results: &RunResults) -> Vec<String> {
    let say = |words: Vec<String>| words.iter().map(|w| wrap(w)).collect::<String>();
    let mut parts = Vec::new();
    for result in &results.sweeps {
        parts.push(format!("{}{}", render(&critical_table(result)), say(sweep_words(result))));
    }
    parts.extend(results.maps.iter().map(|m| format!("Map {}\n{}", m.name, say(map_words(m)))));
    parts.extend(results.damping.iter().map(|d| render(&damping_table(d))));
    parts
}

/// What was found from measured frequencies, and what it is worth.
fn calibration(results: &RunResults) -> Vec<String> {
    use super::calibration::{tables, words};
    let Some(result) = &results.calibration else { return Vec::new() };
    let worth: String = words(result).iter().map(|w| wrap(w)).collect();
    tables(result).iter().map(render).chain([worth]).collect()
}

/// The modes of set `index` of [`RunResults::modes`] beside the measured frequencies.
pub fn modes(results: &RunResults, index: usize) -> String {
    render(&tables::modes(results, index))
}

/// Steady sliding, when the run has it.
pub fn steady(results: &RunResults) -> Option<String> {
    results.steady.as_ref().map(|steady| render(&tables::steady(steady)))
}

/// The complex eigenvalues, when the run has them.
pub fn complex(results: &RunResults) -> Option<String> {
    results.complex.as_ref().map(|complex| render(&tables::complex(complex)))
}

/// What the modes answer to most and what would calm them, when the run has it.
pub fn sensitivity(results: &RunResults) -> Option<String> {
    const SHOWN: usize = 8;
    const COLUMNS: usize = 6;
    let result = results.sensitivity.as_ref()?;
    let mode = |mode| {
        let mut table = tables::sensitivity(mode);
        table.rows.truncate(SHOWN);
        table.columns.truncate(COLUMNS);
        table.rows.iter_mut().for_each(|row| row.cells.truncate(COLUMNS));
        render(&table)
    };
    let mut parts: Vec<String> = result.modes.iter().map(mode).collect();
    if result.modes.iter().any(|mode| !mode.best.is_empty()) {
        parts.push(render(&tables::advice(result)));
    }
    Some(parts.join("\n") + &notes(&tables::left_out(result)))
}

/// How loud it is, when the run has it.
pub fn sound(results: &RunResults) -> Option<String> {
    let modes = results.complex.as_ref().map_or(&[][..], |complex| &complex.real_modes);
    Some(render(&super::transient::sound_table(results.transient.as_ref()?, modes)?))
}

/// The verdict and the unstable modes.
pub fn verdict(results: &RunResults) -> String {
    let unstable = results.complex.as_ref().map(tables::unstable);
    match unstable.filter(|table| !table.rows.is_empty() || !table.notes.is_empty()) {
        Some(table) if table.rows.is_empty() => {
            format!("{}\n{}", wrap(&tables::verdict(results)), notes(&table))
        }
        Some(table) => format!("{}\n{}", wrap(&tables::verdict(results)), render(&table)),
        None => wrap(&tables::verdict(results)),
    }
}

pub(super) fn render(table: &Table) -> String {
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

fn notes(table: &Table) -> String {
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

    #[test]
    fn tables_are_aligned_and_fit_the_terminal() {
        let mut results = sample::rig();
        results.complex.as_mut().unwrap().participation[0] = "a very long story ".repeat(20);
        let text = summary(&results);
        assert!(text.lines().all(|line| length(line) <= WIDTH), "{text}");
        let table = complex(&results).unwrap();
        let ends: Vec<usize> =
            table.lines().filter_map(|l| l.find("UNSTABLE").map(|at| length(&l[..at]))).collect();
        assert_eq!(ends.len(), 3);
        assert!(ends.iter().all(|end| *end == ends[0]), "{table}");
    }

    #[test]
    fn measured_frequencies_stand_beside_their_modes() {
        let text = modes(&sample::rig(), 0);
        let row = text.lines().find(|line| line.contains("(4, 0)") && line.starts_with('*')).unwrap();
        // 974.8 Hz × 0.972 = 947.5 Hz, 1.23 % above 936 Hz.
        assert!(["974.8", "947.5", "936", "+1.23"].iter().all(|figure| row.contains(figure)), "{row}");
        assert!(text.contains("without a computed mode beside it: 2050 Hz"), "{text}");
        assert!(text.contains("None is missing"));
    }

    #[test]
    fn a_broken_certificate_and_a_stable_run_are_said() {
        let mut results = sample::rig();
        results.modes[0].modes.certificate.counted = [21, 22];
        assert!(modes(&results, 0).contains("NOT CERTIFIED"));
        results.complex.as_mut().unwrap().modes.modes.retain(|mode| !mode.unstable());
        let text = verdict(&results);
        assert!(text.contains("Stable: none of the 11") && text.contains("936 Hz"), "{text}");
        assert!(verdict(&RunResults::default()).contains("says nothing about squeal"));
    }
}
