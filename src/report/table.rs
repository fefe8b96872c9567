//! A table with its caption, once for the terminal and the page.

use crate::dataset;

/// A table with its caption and the notes below it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ReportTable {
    pub caption: String,
    pub columns: Vec<ReportColumn>,
    pub rows: Vec<ReportRow>,
    pub notes: Vec<String>,
    /// Whether its marked rows are bad news.
    pub alarming: bool,
}

/// A column's heading and whether it holds words (set left) or numbers (set right).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ReportColumn {
    pub heading: &'static str,
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
            Some(heading) => ReportColumn { heading, words: true },
            None => ReportColumn { heading, words: false },
        };
        ReportTable {
            caption: caption.into(),
            columns: headings.iter().map(column).collect(),
            rows: vec![],
            notes: vec![],
            alarming: false,
        }
    }

    /// The columns of a table that are shown to people, after the number of the row where `numbered`.
    pub(super) fn of(caption: impl Into<String>, data: &dataset::Table, numbered: bool) -> Self {
        let mut table = ReportTable::new(caption, if numbered { &["no."] } else { &[] });
        let shown: Vec<_> = data.columns.iter().filter_map(|column| column.shown.as_ref()).collect();
        let column = |shown: &&dataset::Shown| ReportColumn { heading: shown.heading, words: shown.words };
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

    pub(super) fn row(&mut self, cells: Vec<String>, marked: bool) {
        self.rows.push(ReportRow { cells, marked });
    }
}
