//! A table in lines of text: as wide as it is in a file, and fitted to the window of a terminal.
//!
//! A table that is wider than the window first gets its columns of words narrower, their cells in several lines. Where that is not
//! enough it comes in blocks below each other, each of which begins with the first column: nothing is left out.

use super::lines::{length, wrap, wrapped};
use super::table::ReportTable;

/// More rows than this a window does not show.
const ROWS: usize = 60;
/// What a column of words is made narrower to, at the least.
const NARROW: usize = 24;
/// Blanks between two columns.
const BETWEEN: usize = 2;

/// The sentences below a table.
pub(super) fn notes(table: &ReportTable, width: Option<usize>) -> String {
    table.notes.iter().map(|note| wrap(note, width)).collect()
}

/// The table with its caption and notes, in lines of at most `width` columns; without a width as wide and long as it is.
pub(super) fn render(table: &ReportTable, width: Option<usize>) -> String {
    let shown = table.rows.len().min(if width.is_some() { ROWS } else { usize::MAX });
    let (widths, blocks) = layout(table, shown, width.unwrap_or(usize::MAX));
    let mut text = match width {
        Some(_) => wrap(&table.caption, width).trim_start_matches(' ').replace("\n ", "\n"),
        None => format!("{}\n", table.caption),
    };
    for columns in &blocks {
        let headings: Vec<&str> = table.columns.iter().map(|column| &*column.heading).collect();
        text += &lines(table, &headings, &widths, columns, ' ');
        let rule: usize = columns.iter().map(|c| widths[*c] + BETWEEN).sum();
        text += &format!(" {}\n", "─".repeat(rule - 1));
        for row in &table.rows[..shown] {
            let cells: Vec<&str> = row.cells.iter().map(String::as_str).collect();
            text += &lines(table, &cells, &widths, columns, if row.marked { '*' } else { ' ' });
        }
    }
    if shown < table.rows.len() {
        text += &format!(" … and {} more in the results folder\n", table.rows.len() - shown);
    }
    text + &notes(table, width)
}

/// The widths of the columns, and the columns of each block.
fn layout(table: &ReportTable, shown: usize, width: usize) -> (Vec<usize>, Vec<Vec<usize>>) {
    let all: Vec<usize> = (0..table.columns.len()).collect();
    let mut widths: Vec<usize> = table.columns.iter().map(|column| length(&column.heading)).collect();
    for row in &table.rows[..shown] {
        widths.iter_mut().zip(&row.cells).for_each(|(width, cell)| *width = (*width).max(length(cell)));
    }
    let total = |widths: &[usize], columns: &[usize]| -> usize {
        columns.iter().map(|c| widths[*c] + BETWEEN).sum::<usize>()
    };
    // The widest column of words first.
    while total(&widths, &all) > width {
        let words = all.iter().filter(|c| table.columns[**c].words && widths[**c] > NARROW);
        let Some(widest) = words.max_by_key(|c| widths[**c]).copied() else { break };
        let over = total(&widths, &all) - width;
        widths[widest] = widths[widest].saturating_sub(over).max(NARROW);
    }
    let mut blocks: Vec<Vec<usize>> = vec![Vec::new()];
    for column in all {
        let block = blocks.last_mut().expect("there is one");
        if block.len() > 1 && total(&widths, block) + widths[column] + BETWEEN > width {
            blocks.push(vec![0, column]);
        } else {
            block.push(column);
        }
    }
    (widths, blocks)
}

/// One row: as many lines as its highest cell.
fn lines(table: &ReportTable, cells: &[&str], widths: &[usize], columns: &[usize], lead: char) -> String {
    let cell = |c: usize| match length(cells[c]) > widths[c] {
        true => wrapped(cells[c], widths[c]),
        false => vec![cells[c].to_string()],
    };
    let cells: Vec<Vec<String>> = columns.iter().map(|c| cell(*c)).collect();
    let height = cells.iter().map(Vec::len).max().unwrap_or(1);
    let mut text = String::new();
    for k in 0..height {
        let mut line = String::from(if k == 0 { lead } else { ' ' });
        for (n, (c, cell)) in columns.iter().zip(&cells).enumerate() {
            let cell = cell.get(k).map_or("", String::as_str);
            let blank = " ".repeat(widths[*c] - length(cell));
            line += if n == 0 { " " } else { "  " };
            line +=
                &if table.columns[*c].words { format!("{cell}{blank}") } else { format!("{blank}{cell}") };
        }
        text += &format!("{}\n", line.trim_end());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> ReportTable {
        let mut table = ReportTable::new("Three columns", &["no.", "a long heading", "<words"]);
        for k in 1..=70 {
            let cells = vec![k.to_string(), format!("{k}.5"), "some words that say what it is".to_string()];
            table.row(cells, k == 2);
        }
        table
    }

    #[test]
    fn a_file_has_every_row_in_one_line() {
        let text = render(&table(), None);
        assert_eq!(text.lines().count(), 3 + 70);
        let row = format!("*   2  {:>14}  some words that say what it is", "2.5");
        assert_eq!(text.lines().nth(4), Some(row.as_str()));
        assert!(!text.contains('…'));
    }

    #[test]
    fn a_narrow_window_gets_narrow_words_and_then_blocks() {
        // 3 + 14 + 30 columns and what is between them take 53: three less are left for the words.
        let text = render(&table(), Some(50));
        assert!(text.contains(" no.  a long heading  words\n"), "{text}");
        let row = format!("    1  {:>14}  some words that say what it\n{:23}is\n", "1.5", "");
        assert!(text.contains(&row), "{text}");
        assert!(text.contains("… and 10 more"), "{text}");
        let text = render(&table(), Some(40));
        assert!(text.contains(" no.  a long heading\n") && text.contains(" no.  words\n"), "{text}");
        assert!(text.lines().all(|line| length(line) <= 40), "{text}");
    }
}
