//! A table with its caption, once for the terminal and the page.

use crate::dataset;
use std::borrow::Cow;

/// A table with its caption and the notes below it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ReportTable {
    pub caption: String,
    pub columns: Vec<ReportColumn>,
    pub rows: Vec<ReportRow>,
    pub notes: Vec<String>,
    /// Whether its marked rows are bad news.
    pub alarming: bool,
    /// The file with the same rows and more columns, without the extension `csv`.
    pub file: Option<String>,
}

/// A column's heading and whether it holds words (set left) or numbers (set right).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ReportColumn {
    pub heading: Cow<'static, str>,
    pub words: bool,
}

/// A row; `marked` rows stand out.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ReportRow {
    pub cells: Vec<String>,
    pub marked: bool,
}

impl ReportTable {
    /// An empty table; a heading that begins with `<` is that of a column of words.
    pub(super) fn new(caption: impl Into<String>, headings: &[&'static str]) -> Self {
        let column = |heading: &&'static str| match heading.strip_prefix('<') {
            Some(heading) => ReportColumn { heading: heading.into(), words: true },
            None => ReportColumn { heading: (*heading).into(), words: false },
        };
        ReportTable {
            caption: caption.into(),
            columns: headings.iter().map(column).collect(),
            rows: vec![],
            notes: vec![],
            alarming: false,
            file: None,
        }
    }

    /// The columns of a table that are shown to people, proofs left out, after the number of the row where `numbered`.
    pub(super) fn of(caption: impl Into<String>, data: &dataset::Table, numbered: bool) -> Self {
        Self::chosen(caption, data, numbered, |shown| !shown.proof)
    }

    /// The columns that prove the others, after those with the headings `beside`.
    pub(super) fn proof_of(
        caption: impl Into<String>,
        data: &dataset::Table,
        numbered: bool,
        beside: &[&str],
    ) -> Self {
        Self::chosen(caption, data, numbered, |shown| shown.proof || beside.contains(&shown.heading))
    }

    fn chosen(
        caption: impl Into<String>,
        data: &dataset::Table,
        numbered: bool,
        choose: impl Fn(&dataset::Shown) -> bool,
    ) -> Self {
        let mut table = ReportTable::new(caption, if numbered { &["no."] } else { &[] });
        table.file.clone_from(&data.file);
        let shown = data.columns.iter().filter_map(|column| column.shown.as_ref());
        let shown: Vec<_> = shown.filter(|shown| choose(shown)).collect();
        let column =
            |shown: &&dataset::Shown| ReportColumn { heading: shown.heading.into(), words: shown.words };
        table.columns.extend(shown.iter().map(column));
        for k in 0..data.rows.length {
            let number = numbered.then(|| (k + 1).to_string());
            table.row(
                number.into_iter().chain(shown.iter().map(|shown| shown.cells[k].clone())).collect(),
                false,
            );
        }
        table
    }

    /// Without the columns of which `idle` holds for every cell; those of a table without rows stay.
    #[must_use]
    pub(super) fn without_columns(mut self, idle: impl Fn(&str) -> bool) -> Self {
        let stays: Vec<bool> = (0..self.columns.len())
            .map(|k| self.rows.is_empty() || self.rows.iter().any(|row| !idle(&row.cells[k])))
            .collect();
        let mut stay = stays.iter();
        self.columns.retain(|_| *stay.next().unwrap_or(&true));
        for row in &mut self.rows {
            let mut stay = stays.iter();
            row.cells.retain(|_| *stay.next().unwrap_or(&true));
        }
        self
    }

    pub(super) fn row(&mut self, cells: Vec<String>, marked: bool) {
        self.rows.push(ReportRow { cells, marked });
    }
}

/// Whether a cell says nothing: empty, a dash, or zero.
pub(super) fn idle(cell: &str) -> bool {
    matches!(cell, "" | "–") || cell.parse::<f64>() == Ok(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_that_say_nothing_are_left_out() {
        let mut table = ReportTable::new("", &["f", "zeros", "<empty", "both"]);
        assert_eq!(table.clone().without_columns(idle).columns.len(), 4);
        table.row(["1", "0.0", "", "0"].map(String::from).to_vec(), false);
        table.row(["2", "0.00", "–", "−0.1"].map(String::from).to_vec(), false);
        let table = table.without_columns(idle);
        let headings: Vec<&str> = table.columns.iter().map(|column| &*column.heading).collect();
        assert_eq!(
            (headings, &table.rows[1].cells[..]),
            (vec!["f", "both"], &["2".into(), "−0.1".to_string()][..])
        );
    }
}
