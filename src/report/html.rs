//! Parts of a page: HTML with its style, its pictures and its scripts inside.

use super::finding::FindingClass;
use super::section::{Display, Item, Picture, ReportSection};
use super::table::{ReportColumn, ReportTable};
use crate::error::text::printable_lines;
use crate::results::FileNames;
use std::collections::BTreeSet;

/// The style sheet, for light, dark and paper.
const STYLE: &str = include_str!("page.css");

/// Values under the pointer and zoom for the charts.
const SCRIPT: &str = include_str!("charts.js");

/// A page with its style.
pub(super) fn document(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n{body}<script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        escape(title)
    )
}

/// What is numbered and named once on a page, and which files stand beside it.
#[derive(Debug, Default)]
pub(super) struct PageLayout {
    figures: usize,
    tables: usize,
    ids: FileNames,
    /// Names of the files of the run.
    pub files: BTreeSet<String>,
}

impl PageLayout {
    /// Of a page beside these files.
    pub(super) fn beside(files: impl IntoIterator<Item = String>) -> Self {
        PageLayout { files: files.into_iter().collect(), ..PageLayout::default() }
    }

    /// A name for an element with this heading, unlike all others on the page.
    pub(super) fn id(&mut self, heading: &str) -> String {
        self.ids.next(&heading.to_lowercase())
    }

    /// A link to a file beside the page; nothing where the run has not written it.
    pub(super) fn link(&self, file: &str) -> Option<String> {
        let address: String = file.bytes().map(address_byte).collect();
        self.files.contains(file).then(|| format!("<a href=\"{address}\">{}</a>", escape(file)))
    }

    /// A picture with its number and caption; `file` names it, without the extension. Its alternative text is its description
    /// or, where it has none, what was `found`.
    pub(super) fn figure(&mut self, svg: &str, file: &str, caption: &str, found: &str) -> String {
        self.figures += 1;
        let id = format!("figure-{}", self.figures);
        let alternative = match description(svg) {
            Some(words) => words.to_string(),
            None if found.is_empty() => escape(caption),
            None => escape(&found.replace('`', "")),
        };
        let link = self.link(&format!("{file}.svg")).map_or(String::new(), |link| format!(" ({link})"));
        format!(
            "<figure id=\"{id}\"><div class=\"picture\" role=\"img\" aria-label=\"{alternative}\" aria-describedby=\"{id}-caption\">{svg}</div>\
             <figcaption id=\"{id}-caption\"><b>Figure {}.</b> {}{link}</figcaption></figure>\n",
            self.figures,
            escape(caption)
        )
    }

    /// A table with its number and caption.
    pub(super) fn table(&mut self, content: &ReportTable) -> String {
        let caption = format!("<caption>{}</caption>\n", self.caption(content));
        rows(content, &caption) + &notes(content)
    }

    /// A table that is opened with a click.
    pub(super) fn closed_table(&mut self, content: &ReportTable) -> String {
        let caption = self.caption(content);
        format!(
            "<details><summary>{caption} ({} rows)</summary>\n{}{}</details>\n",
            content.rows.len(),
            rows(content, ""),
            notes(content)
        )
    }

    fn caption(&mut self, content: &ReportTable) -> String {
        self.tables += 1;
        let file = content.file.as_ref().and_then(|file| self.link(&format!("{file}.csv")));
        let link = file.map_or(String::new(), |link| format!(" <small>({link})</small>"));
        format!("Table {}. {}{link}", self.tables, escape(&content.caption))
    }

    /// A picture; `found` as for [`PageLayout::figure`].
    pub(super) fn picture(&mut self, picture: &Picture, found: &str) -> String {
        self.figure(&picture.svg, &picture.file, &picture.caption, found)
    }

    /// A section with its heading, which gets the name `id`, without the picture that is `shown` elsewhere.
    pub(super) fn section(&mut self, section: &ReportSection, id: &str, shown: Option<&Picture>) -> String {
        let mut text = heading(id, &section.heading);
        for finding in &section.findings {
            text += &format!("<p class=\"finding\">{}</p>\n", prose(&finding.words));
        }
        let found = section.findings.first().map_or("", |finding| finding.words.as_str());
        for item in &section.items {
            text += &match item {
                Item::Picture(picture) if shown.is_some_and(|shown| std::ptr::eq(shown, picture)) => {
                    String::new()
                }
                Item::Picture(picture) => self.picture(picture, found),
                Item::Table(content, display) => match display {
                    Display::Closed | Display::Proof => self.closed_table(content),
                    Display::Folded if content.rows.len() > LONG => self.closed_table(content),
                    Display::Titled | Display::Folded => self.table(content),
                },
                Item::Markup(html) => html.clone(),
                Item::Words(words) => format!("<p>{}</p>\n", prose(words)),
            };
        }
        text
    }
}

/// A picture with a description for those who do not see it.
pub(super) fn described(svg: &str, words: &str) -> String {
    match svg.split_once('>') {
        Some((head, rest)) => format!("{head}><desc>{}</desc>{rest}", escape(words)),
        None => svg.to_string(),
    }
}

/// A picture that narrow windows show whole, as its words matter less than its shape.
pub(super) fn whole(svg: &str) -> String {
    svg.replacen("<svg", "<svg class=\"whole\"", 1)
}

/// The description of a picture, escaped.
fn description(svg: &str) -> Option<&str> {
    Some(svg.split_once("<desc>")?.1.split_once("</desc>")?.0)
}

/// A table with this many rows is long.
const LONG: usize = 25;

/// A byte of a file name in an address: letters, digits and a few marks as they are (RFC 3986, 2.3).
fn address_byte(byte: u8) -> String {
    match byte {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'_' | b'.' | b'~' => char::from(byte).to_string(),
        byte => format!("%{byte:02X}"),
    }
}

/// A heading that contents lists lead to.
pub(super) fn heading(id: &str, words: &str) -> String {
    format!("<h2 id=\"{id}\">{}</h2>\n", escape(words))
}

/// The rows of a table without caption and notes.
pub(super) fn rows(content: &ReportTable, caption: &str) -> String {
    let class = |column: &ReportColumn| if column.words { " class=\"w\"" } else { "" };
    let alarm = if content.alarming { " bad" } else { "" };
    let mut text = format!("<div class=\"scroll{alarm}\"><table>\n{caption}");
    let headings: String = content
        .columns
        .iter()
        .map(|c| format!("<th scope=\"col\"{}>{}</th>", class(c), escape(&c.heading)))
        .collect();
    text += &format!("<thead><tr>{headings}</tr></thead>\n<tbody>\n");
    for row in &content.rows {
        let cells: String = row
            .cells
            .iter()
            .zip(&content.columns)
            .map(|(cell, column)| format!("<td{}>{}</td>", class(column), escape(cell)))
            .collect();
        text += &format!("<tr{}>{cells}</tr>\n", if row.marked { " class=\"m\"" } else { "" });
    }
    text + "</tbody></table></div>\n"
}

/// The notes below a table.
pub(super) fn notes(content: &ReportTable) -> String {
    content.notes.iter().map(|note| format!("<p class=\"note\">{}</p>\n", prose(note))).collect()
}

/// The box of a finding; `more` is HTML that belongs to it.
pub(super) fn finding_box(class: FindingClass, words: &str, more: &str) -> String {
    format!("<div class=\"verdict {}\"><p>{}</p>\n{more}</div>\n", class.name(), prose(words))
}

/// `text` without characters that XML 1.0 forbids; they, and those that turn the direction of writing, become `\u{…}`.
pub(super) fn allowed(text: &str) -> String {
    printable_lines(text).replace(['\u{fffe}', '\u{ffff}'], "")
}

/// Sentences in HTML; what stands between back-ticks, as names of keys and commands do, is code.
pub(super) fn prose(text: &str) -> String {
    let safe = escape(text);
    let parts: Vec<&str> = safe.split('`').collect();
    if parts.len().is_multiple_of(2) {
        return safe;
    }
    let each = parts.iter().enumerate();
    each.map(|(k, part)| if k % 2 == 1 { format!("<code>{part}</code>") } else { part.to_string() }).collect()
}

/// User text made harmless in HTML and XML.
pub(super) fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in allowed(text).chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            c => safe.push(c),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::{PageLayout, STYLE, described, prose};
    use crate::bounds::{Origin::*, within};
    use std::collections::BTreeMap;

    /// Relative luminance of `#rrggbb` (WCAG 2.2).
    fn luminance(colour: &str) -> f64 {
        let channel = |k: usize| {
            let v = f64::from(u8::from_str_radix(&colour[k..k + 2], 16).unwrap()) / 255.0;
            if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5)
    }

    fn contrast(a: &str, b: &str) -> f64 {
        let [a, b] = [luminance(a), luminance(b)];
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn names_in_sentences_are_code() {
        assert_eq!(prose("`a<b` and `c`"), "<code>a&lt;b</code> and <code>c</code>");
        assert_eq!(prose("one ` alone <"), "one ` alone &lt;");
    }

    #[test]
    fn a_figure_says_what_is_seen() {
        let svg = "<svg xmlns=\"x\"><rect/></svg>";
        let label = |svg: &str, found: &str| {
            let figure = PageLayout::default().figure(svg, "x", "The caption", found);
            let label = figure.split_once("aria-label=\"").unwrap().1;
            label.split('"').next().unwrap().to_string()
        };
        assert_eq!(label(svg, ""), "The caption");
        assert_eq!(label(svg, "`a` grows"), "a grows");
        let own = described(svg, "3 \"modes\"");
        assert_eq!(own, "<svg xmlns=\"x\"><desc>3 &quot;modes&quot;</desc><rect/></svg>");
        assert_eq!(label(&own, "`a` grows"), "3 &quot;modes&quot;");
    }

    #[test]
    fn text_stands_out_in_light_dark_and_on_paper() {
        assert!(within((contrast("#ffffff", "#000000") - 21.0).abs(), 1e-9, RoundOff));
        let blocks: Vec<&str> =
            STYLE.split(":root {").skip(1).map(|b| b.split('}').next().unwrap()).collect();
        assert_eq!(blocks.len(), 3);
        let mut colours: BTreeMap<&str, &str> = BTreeMap::new();
        for block in blocks {
            let lines = block.lines().filter_map(|line| line.trim().strip_prefix("--")?.split_once(": "));
            colours.extend(lines.map(|(name, value)| (name, value.trim_end_matches(';'))));
            let grounds = colours.iter().filter(|(name, _)| name.ends_with("ground") || **name == "raised");
            for (ground, under) in grounds {
                for text in ["ink", "muted", "link"] {
                    assert!(contrast(colours[text], under) >= 4.5, "{text} on {ground}");
                }
            }
            for class in ["good", "attention", "bad", "neutral"] {
                let ground = format!("{class}-ground");
                assert!(contrast(colours[class], colours[&*ground]) >= 4.5, "{class}");
            }
        }
    }
}
