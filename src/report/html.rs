//! Parts of a page: plain HTML with its style, its pictures and its scripts inside.

use super::section::{Display, Item, ReportSection};
use super::table::{ReportColumn, ReportTable};
use crate::error::text::printable_lines;

const STYLE: &str = "\
body{font:16px/1.5 system-ui,'Segoe UI',Helvetica,Arial,sans-serif;color:#1b1f24;background:#fff;\
max-width:1040px;margin:2.5rem auto;padding:0 1.2rem}\
h1{font-size:1.7rem;line-height:1.25;margin:0 0 .3rem}h2{font-size:1.2rem;margin:2.4rem 0 .6rem;\
border-bottom:1px solid #d5dae0;padding-bottom:.25rem}\
.sub{color:#5b6570;margin:0 0 1.4rem}.verdict{border-left:6px solid #009e73;background:#eef7f4;\
padding:.8rem 1.1rem;margin:1rem 0}.verdict.bad{border-color:#d55e00;background:#fdf3ec}\
.verdict p{font-size:1.1rem;font-weight:600;margin:.1rem 0 .5rem}\
.scroll{overflow-x:auto}table{border-collapse:collapse;font-size:.9rem;margin:.5rem 0;\
font-variant-numeric:tabular-nums}caption{text-align:left;font-weight:600;padding:.3rem 0}\
th,td{padding:.22rem .7rem;text-align:right;white-space:nowrap;border-bottom:1px solid #e6e9ed}\
th{border-bottom:2px solid #9aa4af;font-weight:600}.w{text-align:left}\
tr.m td{background:#eef5fa;font-weight:600}.bad tr.m td{background:#fdf3ec}.note{color:#5b6570;font-size:.88rem;margin:.15rem 0}\
figure{margin:1.2rem 0}figure svg{max-width:100%;height:auto;display:block}\
figcaption{color:#5b6570;font-size:.9rem;margin-top:.3rem}\
.warn{border-left:6px solid #e69f00;background:#fdf8ec;padding:.4rem 1.1rem;margin:.5rem 0}\
pre{background:#f5f6f8;padding:.8rem 1rem;overflow-x:auto;font-size:.84rem}summary{cursor:pointer;font-weight:600}\
@media print{body{margin:0;max-width:none;font-size:11pt}details{display:none}}";

/// Values under the pointer and zoom for the charts.
const SCRIPT: &str = include_str!("charts.js");

/// A page with its style.
pub(super) fn document(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{body}<script>{SCRIPT}</script>\n</body>\n</html>\n",
        escape(title)
    )
}

/// A picture with its caption.
pub(super) fn figure(svg: &str, caption: &str) -> String {
    format!("<figure>{svg}<figcaption>{}</figcaption></figure>\n", escape(caption))
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
        Item::Markup(html) => html.clone(),
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
