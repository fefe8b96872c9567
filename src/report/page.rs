//! The page of a run: what was found first, then contents, the sections, and at the end where the results come from.

use super::finding::FindingClass;
use super::html::{PageLayout, document, escape, finding_box, heading, notes, prose, rows};
use super::provenance::{provenance, the_case};
use super::section::{ReportSection, findings};
use crate::results::RunResults;
use std::collections::BTreeSet;

/// The whole page; `files` are the names of those beside it.
pub(super) fn page(results: &RunResults, sections: &[ReportSection], files: BTreeSet<String>) -> String {
    let title = if results.title.is_empty() { "Results" } else { &results.title };
    let mut layout = PageLayout::beside(files);
    let ids: Vec<String> = sections.iter().map(|section| layout.id(&section.heading)).collect();
    let mut body =
        format!("<h1>{}</h1>\n<p class=\"sub\">{}</p>\n", escape(title), escape(&subtitle(results)));
    // The picture of what is most urgent stands beside the words, and not again in its section.
    let lead = findings(sections).first().and_then(|(k, found)| Some((sections[*k].drawn().next()?, *found)));
    let picture = lead.map_or(String::new(), |(picture, found)| layout.picture(picture, &found.words));
    body += &headline(results, sections, &ids, picture);
    for warning in &results.warnings {
        body += &format!("<div class=\"warn\">{}</div>\n", prose(warning));
    }
    let named = sections.iter().zip(&ids).map(|(section, id)| (id.as_str(), section.heading.as_str()));
    let ends = [
        (!results.assumptions.is_empty(), ASSUMPTIONS),
        (true, PROVENANCE),
        (!results.resolved_case.is_empty(), CASE),
    ];
    let [assumptions, others @ ..] = ends.map(|(there, names)| there.then_some(names));
    body += &contents(assumptions.into_iter().chain(named).chain(others.into_iter().flatten()));
    if let Some((id, words)) = assumptions {
        let items: String = results.assumptions.iter().map(|a| format!("<li>{}</li>", prose(a))).collect();
        body += &format!("{}<ul>{items}</ul>\n", heading(id, words));
    }
    for (section, id) in sections.iter().zip(&ids) {
        body += &layout.section(section, id, lead.map(|(picture, _)| picture));
    }
    body += &heading(PROVENANCE.0, PROVENANCE.1);
    body += &provenance(results, &mut layout);
    if !results.resolved_case.is_empty() {
        body += &heading(CASE.0, CASE.1);
        body += &the_case(results);
    }
    document(title, &body)
}

/// Names and headings of what is on every page. The name of a section has no full stop.
const ASSUMPTIONS: (&str, &str) = ("page.assumptions", "Assumptions");
const PROVENANCE: (&str, &str) = ("page.provenance", "Provenance");
const CASE: (&str, &str) = ("page.case", "The case");

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

/// A failure, then the findings, each with a link to its section; those that are neither good nor bad in one box.
/// The findings; `picture` is that of the first.
fn headline(results: &RunResults, sections: &[ReportSection], ids: &[String], picture: String) -> String {
    let failed = results.failed.iter();
    let mut text: String = failed
        .map(|error| finding_box(FindingClass::Bad, &format!("This run failed. {error}"), ""))
        .collect();
    let mut neutral = String::new();
    let mut picture = Some(picture);
    for (k, finding) in findings(sections) {
        let link = format!("<a href=\"#{}\">{}</a>", ids[k], escape(&sections[k].heading));
        if finding.class >= FindingClass::Neutral && finding.table.is_none() {
            let class = finding.class.name();
            neutral += &format!("<p class=\"{class}\">{} {link}</p>\n", prose(&finding.words));
            continue;
        }
        let more = finding.table.as_ref().map_or(String::new(), |table| match table.rows.is_empty() {
            true => notes(table),
            false => rows(table, "") + &notes(table),
        });
        text += &finding_box(finding.class, &finding.words, &format!("{more}<p class=\"note\">{link}</p>\n"));
        text += &picture.take().unwrap_or_default();
    }
    if !neutral.is_empty() {
        text += &format!("<div class=\"verdict neutral\">{neutral}</div>\n");
    }
    text += &picture.unwrap_or_default();
    if text.is_empty() { finding_box(FindingClass::Neutral, "This run has no results.", "") } else { text }
}

/// Links to all headings.
fn contents<'a>(headings: impl Iterator<Item = (&'a str, &'a str)>) -> String {
    let links: String =
        headings.map(|(id, words)| format!("<li><a href=\"#{id}\">{}</a></li>\n", escape(words))).collect();
    format!("<nav aria-label=\"Contents\"><b>Contents</b>\n<ul>\n{links}</ul></nav>\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use crate::results::NamedModes;

    #[test]
    fn the_page_opens_with_the_verdict_and_needs_nothing_else() {
        let results = sample::rig();
        let page = page(&results, &super::super::sections(&results), BTreeSet::new());
        let at = |text: &str| page.find(text).unwrap_or_else(|| panic!("no {text}"));
        let order = [
            "Unstable: 3 of 16",
            "331.9",
            "Growth rate over frequency: 3 of 16 modes are unstable",
            "Kirchhoff",
            "<nav",
            "Assumptions</h2>",
            "The model: disc, slider, bar",
            "Real modes beside the measured frequencies</h2>",
            "Measured without a computed mode beside it: 2050 Hz",
            "Steady sliding</h2>",
            "Complex eigenvalues</h2>",
            "Calibration</h2>",
            "Provenance</h2>",
            "Wall time",
            "The case</h2>",
            "Every value as the run used it",
        ];
        assert!(order.windows(2).all(|pair| at(pair[0]) < at(pair[1])));
        // The picture of the verdict stands there, and there alone.
        assert_eq!(page.matches("aria-label=\"Growth rate over frequency: 3 of 16").count(), 1);
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
        let page = page(&results, &super::super::sections(&results), BTreeSet::new());
        assert!(
            page.matches("<script").count() == 3
                && page.matches("</script").count() == 3
                && !page.contains("<b>disc")
                && !page.contains(['\u{1}', '\u{ffff}', '\u{202e}'])
        );
        assert!(page.contains("Disc on slider &lt;reference &amp; &quot;first&quot; case&gt;"));
        assert_eq!(page.matches("<div").count(), page.matches("</div>").count());
    }

    #[test]
    fn a_run_without_results_still_has_a_page() {
        let page = page(&RunResults::default(), &[], BTreeSet::new());
        assert!(page.contains("This run has no results.") && page.ends_with("</html>\n"));
    }

    #[test]
    fn every_link_leads_somewhere_and_every_number_and_name_is_there_once() {
        let mut results = sample::rig();
        // Names of a user that would be the same, and would end an attribute.
        results.get_mut::<NamedModes>().unwrap().name = "a\" b".into();
        let files = ["complex_modes.csv", "growth.svg", "mode <1>.csv"].map(String::from);
        let page = page(&results, &super::super::sections(&results), BTreeSet::from(files));
        let all = |mark: &str| -> Vec<String> {
            page.split(mark).skip(1).map(|rest| rest.split('"').next().unwrap().to_string()).collect()
        };
        let ids = all(" id=\"");
        let unique: BTreeSet<&String> = ids.iter().collect();
        assert_eq!(ids.len(), unique.len(), "{ids:?}");
        for target in all("href=\"#").iter().chain(&all("aria-describedby=\"")) {
            assert!(unique.contains(target), "{target} is nowhere");
        }
        let pictures = page.matches("<figure id=\"figure-").count();
        assert!(pictures > 15 && page.contains(&format!("<b>Figure {pictures}.</b>")));
        assert_eq!(page.matches("class=\"picture\" role=\"img\" aria-label=").count(), pictures);
        for seen in [
            "Growth rate over frequency: 3 of 16 modes are unstable",
            "The model: disc, slider, bar; 6 of 14 contact points are closed",
            "Steady sliding: rim carries",
        ] {
            assert!(page.contains(&format!("aria-label=\"{seen}")), "{seen}");
        }
        for file in ["complex_modes.csv", "growth.svg", "mode%20%3C1%3E.csv"] {
            assert!(page.contains(&format!("href=\"{file}\"")), "{file}");
        }
        assert!(!page.contains("href=\"sensitivity.svg\""), "a file that is not there");
    }
}
