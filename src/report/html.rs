//! Parts of a page: plain HTML with its style and its pictures inside, no script.

use super::section::{Display, Item, ReportSection};
use super::table::{ReportColumn, ReportTable};
use crate::error::text::printable_lines;

/// The style sheet, for light, dark and paper.
const STYLE: &str = include_str!("page.css");

/// A page with its style.
pub(super) fn document(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n{body}</body>\n</html>\n",
        escape(title)
    )
}

/// A picture with its caption.
pub(super) fn figure(svg: &str, caption: &str) -> String {
    format!(
        "<figure><div class=\"picture\">{svg}</div><figcaption>{}</figcaption></figure>\n",
        escape(caption)
    )
}

/// A table under its caption.
pub(super) fn titled_table(content: &ReportTable) -> String {
    table(content)
}

/// A section with its heading.
pub(super) fn section(section: &ReportSection) -> String {
    let heading = match section.heading.as_str() {
        "" => String::new(),
        heading => format!("<h2>{}</h2>\n", escape(heading)),
    };
    let item = |item: &Item| match item {
        Item::Picture(picture) => figure(&picture.svg, &picture.caption),
        Item::Table(content, display) => shown(content, *display),
        Item::Words(words) => format!("<p>{}</p>\n", escape(words)),
    };
    heading + &section.items.iter().map(item).collect::<String>()
}

/// A table with this many rows is long.
const LONG: usize = 25;

fn shown(content: &ReportTable, display: Display) -> String {
    let closed = match display {
        Display::Closed => true,
        Display::Folded => content.rows.len() > LONG,
        Display::Titled | Display::Untitled => false,
    };
    if closed {
        let (caption, inner) = (escape(&content.caption), untitled(content));
        let rows = content.rows.len();
        return format!("<details><summary>{caption} ({rows} rows)</summary>\n{inner}</details>\n");
    }
    if display == Display::Untitled { untitled(content) } else { table(content) }
}

/// A table whose caption a heading above it gives already.
pub(super) fn untitled(content: &ReportTable) -> String {
    table(&ReportTable { caption: String::new(), ..content.clone() })
}

fn table(content: &ReportTable) -> String {
    let class = |column: &ReportColumn| if column.words { " class=\"w\"" } else { "" };
    let alarm = if content.alarming { " bad" } else { "" };
    let mut text = format!("<div class=\"scroll{alarm}\"><table>\n");
    if !content.caption.is_empty() {
        text += &format!("<caption>{}</caption>\n", escape(&content.caption));
    }
    let headings: String =
        content.columns.iter().map(|c| format!("<th{}>{}</th>", class(c), escape(c.heading))).collect();
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
    text + "</tbody></table></div>\n" + &notes(content)
}

pub(super) fn notes(content: &ReportTable) -> String {
    content.notes.iter().map(|note| format!("<p class=\"note\">{}</p>\n", escape(note))).collect()
}

/// `text` without characters that XML 1.0 forbids; they, and those that turn the direction of writing, become `\u{…}`.
pub(super) fn allowed(text: &str) -> String {
    printable_lines(text).replace(['\u{fffe}', '\u{ffff}'], "")
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
    use super::STYLE;
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
    fn text_stands_out_in_light_dark_and_on_paper() {
        assert!((contrast("#ffffff", "#000000") - 21.0).abs() < 1e-9);
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
