//! The page: one plain HTML file with its style and its pictures inside, no script.

use super::tables::{self, Table};
use crate::error::text::printable_lines;
use crate::results::RunResults;

/// A picture with its file name and its caption.
#[derive(Debug, Clone)]
pub(super) struct Picture {
    pub file: &'static str,
    pub caption: String,
    pub svg: String,
}

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

/// The whole page.
pub(super) fn page(results: &RunResults, pictures: &[Picture]) -> String {
    let title = if results.title.is_empty() { "Results" } else { &results.title };
    let mut body =
        format!("<h1>{}</h1>\n<p class=\"sub\">{}</p>\n", escape(title), escape(&subtitle(results)));
    body += &verdict(results);
    let failed = results.failed.iter().map(|error| format!("This run failed. {error}"));
    for warning in failed.chain(results.warnings.iter().cloned()) {
        body += &format!("<div class=\"warn\">{}</div>\n", escape(&warning));
    }
    if !results.assumptions.is_empty() {
        let items: String = results.assumptions.iter().map(|a| format!("<li>{}</li>", escape(a))).collect();
        body += &format!("<h2>Assumptions</h2>\n<ul>{items}</ul>\n");
    }
    body += &figures(pictures, &["rig.svg"]);
    if let Some(steady) = &results.steady {
        body += &format!("<h2>Steady sliding</h2>\n{}", untitled(tables::steady(steady)));
        body += &figures(pictures, &["contact.svg"]);
    }
    if !results.modes.is_empty() {
        body += "<h2>Real modes beside the measured frequencies</h2>\n";
        body += &figures(pictures, &["modes_disc.svg"]);
        for k in 0..results.modes.len() {
            body += &folded(&tables::modes(results, k));
        }
    }
    body += &super::comparison::section(results);
    body += &super::frf::section(results);
    if let Some(complex) = &results.complex {
        body += "<h2>Complex eigenvalues</h2>\n";
        body += &figures(pictures, &["growth.svg", "growth_budget.svg", "participation.svg"]);
        body += &untitled(tables::complex(complex));
    }
    if let Some(sensitivity) = &results.sensitivity {
        body += "<h2>What the modes answer to, and what would calm them</h2>\n";
        body += &figures(pictures, &["sensitivity.svg", "advice.svg"]);
        body += &untitled(tables::advice(sensitivity));
        for mode in &sensitivity.modes {
            body += &opened(&tables::sensitivity(mode));
        }
        body += &notes(&tables::left_out(sensitivity));
    }
    if let Some(transient) = &results.transient {
        body += "<h2>Motion in time</h2>\n";
        body += &figures(pictures, &super::transient::FILES);
        body += &untitled(super::transient::table(transient));
        let modes = results.complex.as_ref().map_or(&[][..], |complex| &complex.real_modes);
        body += &super::transient::sound_table(transient, modes).map_or(String::new(), |t| table(&t));
        if let Some(check) = &transient.reduced_check {
            body += &table(&super::reduced_check::table(check, results.complex.as_ref()));
        }
    }
    body += &super::explored::section(results);
    body += &super::calibration::section(results);
    if !results.timings.is_empty() {
        body += &format!("<h2>Wall time</h2>\n{}", untitled(tables::timings(results)));
    }
    if !results.resolved_case.is_empty() {
        let case = escape(&results.resolved_case);
        body += &format!(
            "<h2>The case</h2>\n<details><summary>Every value as the run used it</summary><pre>{case}</pre></details>\n"
        );
    }
    document(title, &body)
}

/// A page with its style.
pub(super) fn document(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{body}</body>\n</html>\n",
        escape(title)
    )
}

fn subtitle(results: &RunResults) -> String {
    let size = &results.size;
    format!(
        "{} {} · {} nodes, {} elements, {} degrees of freedom, {} contact points",
        env!("CARGO_PKG_NAME"),
        env!("CARGO_PKG_VERSION"),
        size.nodes,
        size.elements,
        size.dofs,
        size.contact_points
    )
}

fn verdict(results: &RunResults) -> String {
    let unstable = results.complex.as_ref().map(tables::unstable);
    let bad = unstable.as_ref().is_some_and(|t| !t.rows.is_empty());
    let class = if bad { "verdict bad" } else { "verdict" };
    let shown = match &unstable {
        Some(t) if bad => untitled(t.clone()),
        Some(t) => notes(t),
        None => String::new(),
    };
    format!("<div class=\"{class}\"><p>{}</p>\n{shown}</div>\n", escape(&tables::verdict(results)))
}

/// The pictures called `files`, in that order, those there are.
fn figures(pictures: &[Picture], files: &[&str]) -> String {
    let chosen = files.iter().filter_map(|file| pictures.iter().find(|p| p.file == *file));
    chosen.map(|p| figure(&p.svg, &p.caption)).collect()
}

/// A picture with its caption.
pub(super) fn figure(svg: &str, caption: &str) -> String {
    format!("<figure>{svg}<figcaption>{}</figcaption></figure>\n", escape(caption))
}

/// A table under its caption.
pub(super) fn titled_table(content: &Table) -> String {
    table(content)
}

/// A table that the reader opens when it is long.
fn folded(content: &Table) -> String {
    if content.rows.len() <= 25 {
        return table(content);
    }
    let caption = escape(&content.caption);
    let inner = untitled(content.clone());
    format!("<details><summary>{caption} ({} modes)</summary>\n{inner}</details>\n", content.rows.len())
}

/// A table that the reader opens.
fn opened(content: &Table) -> String {
    let inner = untitled(content.clone());
    format!("<details><summary>{}</summary>\n{inner}</details>\n", escape(&content.caption))
}

/// A table whose caption a heading above it gives already.
fn untitled(content: Table) -> String {
    table(&Table { caption: String::new(), ..content })
}

fn table(content: &Table) -> String {
    let class = |column: &tables::Column| if column.words { " class=\"w\"" } else { "" };
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

fn notes(content: &Table) -> String {
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
    use super::*;
    use crate::results::sample;

    #[test]
    fn the_page_opens_with_the_verdict_and_needs_nothing_else() {
        let results = sample::rig();
        let pictures = [Picture { file: "rig.svg", caption: "a & b".into(), svg: "<svg></svg>".into() }];
        let page = page(&results, &pictures);
        let at = |text: &str| page.find(text).unwrap_or_else(|| panic!("no {text}"));
        let order = [
            "Unstable: 3 of 14",
            "1668.3",
            "is thick for Kirchhoff",
            "Assumptions",
            "<svg",
            "Steady sliding",
        ];
        assert!(order.windows(2).all(|pair| at(pair[0]) < at(pair[1])));
        assert!(
            at("2050 Hz") > at("Real modes beside") && at("Every value as the run used it") > at("Wall time")
        );
        assert!(!page.contains("<script") && !page.contains("<link") && !page.contains("src="));
    }

    #[test]
    fn user_text_cannot_break_the_page() {
        let mut results = sample::rig();
        results.warnings = vec!["</div><script>alert('x')</script>\u{1}\u{ffff}\u{202e}".into()];
        results.resolved_case = "a = \"</pre><script>\"".into();
        results.modes[0].name = "<b>disc</b>".into();
        let page = page(&results, &[]);
        assert!(
            !page.contains("<script")
                && !page.contains("<b>")
                && !page.contains(['\u{1}', '\u{ffff}', '\u{202e}'])
        );
        assert!(page.contains("Disc on slider &lt;reference &amp; &quot;first&quot; case&gt;"));
        assert_eq!(page.matches("<div").count(), page.matches("</div>").count());
    }

    #[test]
    fn a_run_without_results_still_has_a_page() {
        let page = page(&RunResults::default(), &[]);
        assert!(page.contains("says nothing about squeal") && page.ends_with("</html>\n"));
    }
}
