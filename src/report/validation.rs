//! The page of the validation suite: every quantity beside its reference, with source and reason, and all differences as
//! parts of their tolerances in one picture.

use super::chart::{Axis, Chart, WIDTH};
use super::colours::{ALARM, INK, MEASURED};
use super::finding::FindingClass;
use super::format::{fixed, given, power, significant};
use super::html::{self, PageLayout};
use super::provenance::origin;
use super::svg::{fill, sheer, stroke};
use super::table::ReportTable;
use crate::error::Result;
use crate::results::record::InputFile;
use crate::results::{CheckedCase, Provenance, passed, write_atomically};
use std::path::Path;

const LABELS: f64 = 300.0;
const ROW: f64 = 24.0;
const TOP: f64 = 34.0;
/// The decades of difference ÷ tolerance that are drawn; what is smaller or larger stands at the ends.
const DECADES: [i32; 2] = [-4, 1];

/// Writes `validation.html` and `validation.svg` into the folder `dir`; `inputs` are the cases and their references.
///
/// # Errors
/// [`crate::error::Error::Io`] when the folder cannot be made or a file not be written.
pub fn write_validation(
    dir: &Path,
    cases: &[CheckedCase],
    provenance: &Provenance,
    inputs: &[InputFile],
) -> Result<()> {
    let svg = picture(cases);
    write_atomically(dir, "validation.svg", svg.as_bytes())?;
    write_atomically(dir, "validation.html", page(cases, &svg, (provenance, inputs)).as_bytes())
}

fn page(cases: &[CheckedCase], svg: &str, (provenance, inputs): (&Provenance, &[InputFile])) -> String {
    let [all, within] = passed(cases);
    let seconds: f64 = cases.iter().map(|case| case.seconds).sum();
    let class = if within == all { FindingClass::Good } else { FindingClass::Bad };
    let mut layout = PageLayout::beside(["validation.svg".into()]);
    let mut body = format!(
        "<h1>Validation</h1>\n<p class=\"sub\">{} {} · {} cases in {} s</p>\n",
        env!("CARGO_PKG_NAME"),
        env!("CARGO_PKG_VERSION"),
        cases.len(),
        fixed(seconds, 0),
    );
    body += &html::finding_box(class, &format!("{within} of {all} quantities within tolerance"), "");
    let caption = "Every quantity as a dot: its difference from the reference as a part of its tolerance. \
                   What is further left than the axis agrees better; right of the line fails.";
    let ratio = |row: &crate::results::CheckedQuantity| row.difference() / row.tolerance;
    let rows = cases.iter().flat_map(|case| case.rows.iter().map(move |row| (case, row)));
    let worst = rows.max_by(|a, b| ratio(a.1).total_cmp(&ratio(b.1)));
    let seen = worst.map_or(String::new(), |(case, row)| {
        let part = significant(ratio(row), 2);
        format!(
            "{within} of {all} differences are within their tolerances; the largest is {part} times its tolerance: {} of {}.",
            row.quantity, case.name
        )
    });
    body += &layout.figure(svg, "validation", caption, &seen);
    for case in cases {
        let id = layout.id(&case.name);
        body += &html::heading(&id, &case.title);
        body += &layout.table(&table(case));
    }
    body += &html::heading("page.provenance", "Provenance");
    body += &origin(Some(provenance), inputs, &mut layout);
    html::document("Validation", &body)
}

fn table(case: &CheckedCase) -> ReportTable {
    let headings = ["<quantity", "computed", "reference", "difference", "tolerance", "<"];
    let mut table = ReportTable::new(format!("Computed beside reference: {}", case.name), &headings);
    table.alarming = true;
    let mut reasons: Vec<&str> = Vec::new();
    for row in &case.rows {
        let verdict = if row.passed() { "pass" } else { "FAIL" };
        let cells = vec![
            row.quantity.clone(),
            significant(row.computed, 7),
            given(row.reference),
            power(row.difference()) + if row.relative { "" } else { " (absolute)" },
            power(row.tolerance),
            verdict.to_string(),
        ];
        table.row(cells, !row.passed());
        if !row.reason.is_empty() && !reasons.contains(&row.reason.as_str()) {
            reasons.push(&row.reason);
        }
    }
    table.notes.push(format!("Source: {}.", case.source.trim_end_matches('.')));
    table.notes.extend(reasons.iter().map(|reason| format!("Tolerance: {reason}")));
    table.notes.push(format!("validation/{}, {} s", case.name, fixed(case.seconds, 1)));
    table
}

fn picture(cases: &[CheckedCase]) -> String {
    let [low, high] = DECADES.map(f64::from);
    let label = |decade: i32| match 10f64.powi(decade) {
        1.0 => (1.0, "tolerance".to_string()),
        part => (part, given(part)),
    };
    let across = Axis::log("difference from the reference ÷ tolerance", low..high, 1.0);
    let across = across.at((DECADES[0]..=DECADES[1]).map(label));
    let bottom = TOP + ROW * cases.len() as f64;
    let names = cases.iter().map(|case| case.name.clone());
    let mut chart = Chart::new([LABELS, TOP - 6.0, WIDTH - 40.0, bottom], across, Axis::rows(names));
    chart.rule(0, 1.0, &stroke(INK, 1.4));
    for (k, case) in cases.iter().enumerate() {
        for row in &case.rows {
            let hex = if row.passed() { MEASURED } else { ALARM };
            let part = row.difference() / row.tolerance;
            let [least, most] = DECADES.map(|decade| 10f64.powi(decade));
            let part = if part.is_nan() { most } else { part.clamp(least, most) };
            chart.circle([part, k as f64 + 0.5], 4.2, &sheer(fill(hex), 0.55));
        }
    }
    chart.picture(bottom + 52.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::CheckedQuantity;

    #[test]
    fn a_failure_is_told_on_the_page_and_in_the_picture() {
        let row = |computed: f64| CheckedQuantity {
            quantity: "f < g".into(),
            computed,
            reference: 1.0,
            tolerance: 0.1,
            relative: true,
            reason: "because".into(),
        };
        let case = |rows: Vec<CheckedQuantity>| CheckedCase {
            name: "disc".into(),
            title: "A disc".into(),
            source: "a book".into(),
            rows,
            seconds: 1.0,
        };
        let dir = tempfile::tempdir().unwrap();
        let read = |name: &str| std::fs::read_to_string(dir.path().join(name)).unwrap();
        let provenance = Provenance::now("", "");
        let inputs = [InputFile::of_text("disc/case.toml", "title = 1")];
        let write = |case: CheckedCase| write_validation(dir.path(), &[case], &provenance, &inputs).unwrap();
        write(case(vec![row(1.01), row(1.0)]));
        let good = read("validation.html");
        assert!(good.contains("2 of 2") && !good.contains("verdict bad") && good.contains("f &lt; g"));
        assert!(!read("validation.svg").contains(ALARM));
        for words in ["Provenance</h2>", "commit", "disc/case.toml", "18eedd0d53ee"] {
            assert!(good.contains(words), "{words}");
        }
        write(case(vec![row(1.2), row(f64::NAN)]));
        let bad = read("validation.html");
        assert!(bad.contains("0 of 2") && bad.contains("verdict bad"));
        assert_eq!(read("validation.svg").matches(ALARM).count(), 2);
    }
}
