//! A part of the report: what one analysis found, in tables, words and pictures, once for the terminal and the page.

use super::finding::Finding;
use super::table::ReportTable;

/// A picture with the name of its file, without the extension, and its caption.
#[derive(Debug, Clone)]
pub(super) struct Picture {
    pub file: String,
    pub caption: String,
    pub svg: String,
}

/// Section of one analysis.
#[derive(Debug, Clone)]
pub(super) struct ReportSection {
    /// Its heading on the page.
    pub heading: String,
    /// What was found, in a sentence or a few each.
    pub findings: Vec<Finding>,
    pub items: Vec<Item>,
}

/// A part of a section.
#[derive(Debug, Clone)]
pub(super) enum Item {
    Picture(Picture),
    Table(ReportTable, Display),
    Words(String),
    /// Markup of the page alone, with all text in it escaped.
    Markup(String),
}

/// How the page shows a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Display {
    /// Open.
    Titled,
    /// Closed when it is long.
    Folded,
    /// Closed; the terminal shows its first rows and columns.
    Closed,
    /// Closed; the terminal leaves it out: errors and condition numbers of another table.
    Proof,
}

impl ReportSection {
    /// An empty section.
    pub(super) fn new(heading: impl Into<String>) -> Self {
        ReportSection { heading: heading.into(), findings: Vec::new(), items: Vec::new() }
    }

    /// With findings.
    #[must_use]
    pub(super) fn findings(mut self, findings: impl IntoIterator<Item = Finding>) -> Self {
        self.findings.extend(findings);
        self
    }

    /// With pictures.
    #[must_use]
    pub(super) fn pictures(mut self, pictures: impl IntoIterator<Item = Picture>) -> Self {
        self.items.extend(pictures.into_iter().map(Item::Picture));
        self
    }

    /// With tables; of one without rows only what is written below it, after its title.
    #[must_use]
    pub(super) fn tables(mut self, display: Display, tables: impl IntoIterator<Item = ReportTable>) -> Self {
        for table in tables {
            match table.rows.is_empty() {
                true if table.notes.is_empty() => {}
                true => {
                    let title = matches!(display, Display::Titled).then_some(table.caption);
                    self.items.extend(title.into_iter().chain(table.notes).map(Item::Words));
                }
                false => self.items.push(Item::Table(table, display)),
            }
        }
        self
    }

    /// With paragraphs.
    #[must_use]
    pub(super) fn words(mut self, words: impl IntoIterator<Item = String>) -> Self {
        self.items.extend(words.into_iter().map(Item::Words));
        self
    }

    /// With markup that the page alone shows.
    #[must_use]
    pub(super) fn markup(mut self, html: impl IntoIterator<Item = String>) -> Self {
        self.items.extend(html.into_iter().map(Item::Markup));
        self
    }

    /// Its pictures.
    pub(super) fn drawn(&self) -> impl Iterator<Item = &Picture> {
        self.items.iter().filter_map(|item| match item {
            Item::Picture(picture) => Some(picture),
            _ => None,
        })
    }
}

/// The findings of all sections with the numbers of their sections, the most urgent first, else in the order of the
/// report.
pub(super) fn findings(sections: &[ReportSection]) -> Vec<(usize, &Finding)> {
    let each = sections.iter().enumerate();
    let mut all: Vec<_> =
        each.flat_map(|(k, section)| section.findings.iter().map(move |f| (k, f))).collect();
    all.sort_by_key(|(_, finding)| finding.class);
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::finding::FindingClass;

    #[test]
    fn a_table_without_rows_is_left_out() {
        let empty = ReportTable { notes: vec!["none".into()], ..ReportTable::new("x", &["a"]) };
        let mut full = ReportTable::new("y", &["a"]);
        full.row(vec!["1".into()], false);
        let nothing = ReportTable::new("z", &["a"]);
        let section = ReportSection::new("s").tables(Display::Titled, [empty, full, nothing]);
        assert!(
            matches!(&section.items[..], [Item::Words(title), Item::Words(words), Item::Table(..)] if title == "x" && words == "none")
        );
    }

    #[test]
    fn the_most_urgent_comes_first_and_equals_keep_their_order() {
        let section = |class, words: &str| ReportSection::new("x").findings([Finding::new(class, words)]);
        use FindingClass::{Attention, Bad, Good, Neutral};
        let sections = [section(Neutral, "a"), section(Bad, "b"), section(Good, "c"), section(Bad, "d")];
        let sections = [&sections[..], &[section(Attention, "e")]].concat();
        let order: Vec<(usize, &str)> = findings(&sections).iter().map(|(k, f)| (*k, &*f.words)).collect();
        assert_eq!(order, [(1, "b"), (3, "d"), (4, "e"), (2, "c"), (0, "a")]);
    }
}
