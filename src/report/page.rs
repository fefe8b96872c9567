//! The page of a run: the verdict first, then the sections, then times and the case.

use super::complex::{unstable, verdict};
use super::format::significant;
use super::html::{document, escape, notes, section, untitled};
use super::section::ReportSection;
use super::table::ReportTable;
use crate::results::{ComplexResult, RunResults};

/// The whole page.
pub(super) fn page(results: &RunResults, sections: &[ReportSection]) -> String {
    let title = if results.title.is_empty() { "Results" } else { &results.title };
    let mut body =
        format!("<h1>{}</h1>\n<p class=\"sub\">{}</p>\n", escape(title), escape(&subtitle(results)));
    body += &verdict_box(results);
    let failed = results.failed.iter().map(|error| format!("This run failed. {error}"));
    for warning in failed.chain(results.warnings.iter().cloned()) {
        body += &format!("<div class=\"warn\">{}</div>\n", escape(&warning));
    }
    if !results.assumptions.is_empty() {
        let items: String = results.assumptions.iter().map(|a| format!("<li>{}</li>", escape(a))).collect();
        body += &format!("<h2>Assumptions</h2>\n<ul>{items}</ul>\n");
    }
    body += &sections.iter().map(section).collect::<String>();
    if !results.timings.is_empty() {
        body += &format!("<h2>Wall time</h2>\n{}", untitled(&timings(results)));
    }
    if !results.resolved_case.is_empty() {
        let case = escape(&results.resolved_case);
        body += &format!(
            "<h2>The case</h2>\n<details><summary>Every value as the run used it</summary><pre>{case}</pre></details>\n"
        );
    }
    document(title, &body)
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

fn verdict_box(results: &RunResults) -> String {
    let unstable = results.get::<ComplexResult>().map(unstable);
    let bad = unstable.as_ref().is_some_and(|t| !t.rows.is_empty());
    let class = if bad { "verdict bad" } else { "verdict" };
    let shown = match &unstable {
        Some(t) if bad => untitled(t),
        Some(t) => notes(t),
        None => String::new(),
    };
    format!("<div class=\"{class}\"><p>{}</p>\n{shown}</div>\n", escape(&verdict(results)))
}

/// Where the wall time went.
fn timings(results: &RunResults) -> ReportTable {
    let mut table = ReportTable::new("Wall time", &["<phase", "seconds"]);
    for (phase, seconds) in &results.timings {
        table.row(vec![phase.clone(), significant(*seconds, 3)], false);
    }
    let total: f64 = results.timings.iter().map(|(_, seconds)| seconds).sum();
    table.row(vec!["all".into(), significant(total, 3)], true);
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::NamedModes;
    use crate::results::sample;

    #[test]
    fn the_page_opens_with_the_verdict_and_needs_nothing_else() {
        let results = sample::rig();
        let page = page(&results, &super::super::sections(&results));
        let at = |text: &str| page.find(text).unwrap_or_else(|| panic!("no {text}"));
        let order = [
            "Unstable: 3 of 14",
            "1668.3",
            "is thick for Kirchhoff",
            "Assumptions",
            "<svg",
            "Real modes beside",
            "2050 Hz",
            "<h2>Steady sliding",
            "<h2>Complex eigenvalues",
            "<h2>Calibration",
            "Wall time",
            "Every value as the run used it",
        ];
        assert!(order.windows(2).all(|pair| at(pair[0]) < at(pair[1])));
        // Nothing comes from outside: sources are in the page or beside it.
        assert!(!page.contains("<link") && !page.contains("<script src") && !page.contains("@import"));
        let sources = page.split("src=\"").skip(1).chain(page.split("href=\"").skip(1));
        for source in sources.map(|rest| rest.split('"').next().unwrap()) {
            assert!(
                source.starts_with("data:") || source.starts_with('#') || !source.contains(':'),
                "{source}"
            );
        }
    }

    #[test]
    fn user_text_cannot_break_the_page() {
        let mut results = sample::rig();
        results.warnings = vec!["</div><script>alert('x')</script>\u{1}\u{ffff}\u{202e}".into()];
        results.resolved_case = "a = \"</pre><script>\"".into();
        results.get_mut::<NamedModes>().unwrap().name = "<b>disc</b>".into();
        let page = page(&results, &super::super::sections(&results));
        assert!(
            page.matches("<script").count() == 3
                && page.matches("</script").count() == 3
                && !page.contains("<b>")
                && !page.contains(['\u{1}', '\u{ffff}', '\u{202e}'])
        );
        assert!(page.contains("Disc on slider &lt;reference &amp; &quot;first&quot; case&gt;"));
        assert_eq!(page.matches("<div").count(), page.matches("</div>").count());
    }

    #[test]
    fn a_run_without_results_still_has_a_page() {
        let page = page(&RunResults::default(), &[]);
        assert!(page.contains("makes no statement about squeal") && page.ends_with("</html>\n"));
    }
}
