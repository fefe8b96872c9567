//! A part of the report: what one analysis found, in tables, words and pictures, once for the terminal and the page.

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
    /// Its heading on the page; empty for none.
    pub heading: String,
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
    /// Under its caption.
    Titled,
    /// Without its caption: the heading of the section says the same.
    Untitled,
    /// Closed when it is long.
    Folded,
    /// Closed; the terminal shows its first rows and columns.
    Closed,
}

impl ReportSection {
    /// An empty section.
    pub(super) fn new(heading: impl Into<String>) -> Self {
        ReportSection { heading: heading.into(), items: Vec::new() }
    }

    /// With pictures.
    #[must_use]
    pub(super) fn pictures(mut self, pictures: impl IntoIterator<Item = Picture>) -> Self {
        self.items.extend(pictures.into_iter().map(Item::Picture));
        self
    }

    /// With tables.
    #[must_use]
    pub(super) fn tables(mut self, display: Display, tables: impl IntoIterator<Item = ReportTable>) -> Self {
        self.items.extend(tables.into_iter().map(|table| Item::Table(table, display)));
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
