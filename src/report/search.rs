//! The page of a search: which facts the case meets with the numbers that were found, how the cost fell, and which number
//! matters most.

use super::chart::{Axis, Chart, WIDTH, ends, wide};
use super::colours::{ALARM, CALM, INK, MEASURED, MUTED};
use super::finding::FindingClass;
use super::format::{fixed, given, significant};
use super::html::{self, PageLayout, escape};
use super::provenance::{as_written, origin};
use super::svg::{Sheet, fill, ink, sheer, stroke};
use super::table::ReportTable;
use super::text_table::render;
use crate::error::Result;
use crate::results::record::InputFile;
use crate::results::{Provenance, SearchResult, SearchedNumber, passed, write_result};
use std::path::Path;

const LABELS: f64 = 210.0;
const ROW: f64 = 24.0;

/// Writes `search.html`, `search_cost.svg` and `search_weights.svg` into the folder `dir`; `inputs` are the cases and the files
/// that they read.
///
/// # Errors
/// [`crate::error::Error::Io`] when the folder cannot be made or a file not be written.
pub fn write_search(
    dir: &Path,
    result: &SearchResult,
    provenance: &Provenance,
    inputs: &[InputFile],
) -> Result<()> {
    let (cost, weights) = (cost_picture(result), weight_picture(result));
    write_result(dir, "search_cost.svg", cost.as_bytes())?;
    write_result(dir, "search_weights.svg", weights.as_bytes())?;
    let (title, facts) = (&result.title, std::slice::from_ref(&result.facts));
    let [all, met] = passed(facts);
    let class = match met == all {
        true if result.numbers.len() < all => FindingClass::Good,
        true => FindingClass::Attention,
        false => FindingClass::Bad,
    };
    let sentences = words(result);
    let (first, others) = sentences.split_first().expect("how many facts are met");
    let others: String = others.iter().map(|w| format!("<p>{}</p>\n", html::prose(w))).collect();
    let mut layout = PageLayout::beside(["search_weights.svg", "search_cost.svg"].map(String::from));
    let body = format!(
        "<h1>{}</h1>\n<p class=\"sub\">{} {} · {} evaluations</p>\n",
        escape(title),
        env!("CARGO_PKG_NAME"),
        env!("CARGO_PKG_VERSION"),
        result.history.len(),
    ) + &html::finding_box(class, first, &others)
        + &layout.table(&fact_table(result))
        + &layout.table(&number_table(result))
        + &layout.figure(
            &weights,
            "search_weights",
            "How much the cost rises when one number is moved by a twentieth of its bounds, the others as found.",
            sentences.last().expect("how many facts are met"),
        )
        + &layout.figure(
            &cost,
            "search_cost",
            "The cost of every evaluation, and the least so far.",
            &sentences[1],
        );
    let ends = html::heading("page.provenance", "Provenance")
        + &origin(Some(provenance), inputs, &mut layout)
        + &html::heading("page.search", "The search")
        + &as_written("The file of the search", provenance);
    let body = body + &ends;
    write_result(dir, "search.html", html::document(title, &body).as_bytes())
}

/// Text printed on the command line, in lines of at most `width` columns; tables are as wide as they are without one.
pub fn search_text(result: &SearchResult, width: Option<usize>) -> String {
    let tables = [fact_table(result), number_table(result)];
    let words = words(result).into_iter().map(|w| super::lines::wrap(&w, width));
    tables.iter().map(|table| render(table, width)).chain(words).collect::<Vec<_>>().join("\n")
}

fn words(result: &SearchResult) -> Vec<String> {
    let [all, met] = passed(std::slice::from_ref(&result.facts));
    let free = result.numbers.len();
    let mut words = vec![
        format!("{met} of {all} facts are met within their tolerance, with {free} numbers free."),
        format!(
            "The cost fell from {} to {} in {} evaluations{}.",
            significant(result.costs[0], 4),
            significant(result.costs[1], 4),
            result.history.len(),
            match result.without_answer {
                0 => String::new(),
                count => format!(", {count} of them without an answer"),
            }
        ),
    ];
    if free >= all {
        words.push("There are no more facts than free numbers: that they are met proves nothing.".into());
    }
    let cost = result.costs[1];
    let each = result.numbers.iter().flat_map(|n| n.moved.iter().flatten().map(move |moved| (n, moved)));
    let least = each.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
    if let Some((number, moved)) = least.filter(|(_, moved)| moved.cost < cost) {
        words.push(format!(
            "The search is not at the bottom: with `{}` alone at {} {} the cost is {}. Start it again from found.toml.",
            number.name,
            given(moved.to),
            number.unit,
            significant(moved.cost, 4)
        ));
    }
    let by_weight = |a: &&SearchedNumber, b: &&SearchedNumber| a.weight(cost).total_cmp(&b.weight(cost));
    if let Some(number) = result.numbers.iter().max_by(by_weight).filter(|n| n.weight(cost) > 0.0) {
        let moved = number.moved.iter().flatten().max_by(|a, b| a.cost.total_cmp(&b.cost));
        if let Some(moved) = moved {
            words.push(format!(
                "What matters most is `{}`: at {} {} the cost is {}, most of all for “{}”.",
                number.name,
                given(moved.to),
                number.unit,
                significant(moved.cost, 4),
                result.facts.rows[moved.worst].quantity
            ));
        }
    }
    words
}

fn fact_table(result: &SearchResult) -> ReportTable {
    let mut table =
        ReportTable::new("Facts", &["<fact", "wanted", "tolerance", "before", "found", "÷ tol.", "<"]);
    table.alarming = true;
    for (row, before) in result.facts.rows.iter().zip(&result.before) {
        let tolerance = match row.relative {
            true => format!("{} %", given(100.0 * row.tolerance)),
            false => given(row.tolerance),
        };
        let cells = vec![
            shortened(&row.quantity),
            given(row.reference),
            tolerance,
            significant(*before, 5),
            significant(row.computed, 5),
            fixed(row.difference() / row.tolerance, 2),
            if row.passed() { "met" } else { "missed" }.to_string(),
        ];
        table.row(cells, !row.passed());
    }
    table.notes.push(format!("Source: {}.", result.facts.source.trim_end_matches('.')));
    table
}

/// The first words of a long name, so that the figures beside it fit.
fn shortened(words: &str) -> String {
    const MOST: usize = 42;
    match words.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &words[..end]),
        None => words.to_string(),
    }
}

fn number_table(result: &SearchResult) -> ReportTable {
    let headings = ["<number", "<unit", "from", "to", "before", "found", "weight", "<"];
    let mut table = ReportTable::new("Numbers", &headings);
    for number in &result.numbers {
        let cells = vec![
            number.name.clone(),
            number.unit.clone(),
            given(number.between[0]),
            given(number.between[1]),
            significant(number.before, 5),
            significant(number.after, 5),
            significant(number.weight(result.costs[1]), 3),
            if number.at_bound() { "at its bound" } else { "" }.to_string(),
        ];
        table.row(cells, number.at_bound());
    }
    table
        .notes
        .push("Weight: what the cost rises by when the number is moved by a twentieth of its bounds.".into());
    table
}

/// Every evaluation as a dot, the least so far as a line, the cost on a logarithmic axis.
fn cost_picture(result: &SearchResult) -> String {
    let costs = &result.history;
    let [low, high] = ends(costs.iter().copied().filter(|cost| *cost > 0.0));
    if low > high {
        return Sheet::new(WIDTH, 376.0).finish();
    }
    let name = format!("evaluations, 1 to {}", costs.len());
    let up = Axis::log("cost", low.log10() - 0.05..high.log10() + 0.05, 1.0);
    let across = Axis::new(name, 0.5..costs.len() as f64 + 0.5).bare();
    let mut chart = Chart::new(wide(16.0, 324.0), across, up);
    let mut least = f64::INFINITY;
    let mut line = Vec::new();
    let numbered = costs.iter().zip((1..).map(f64::from)).map(|(cost, k)| (cost.max(low), k));
    for (cost, k) in numbered.filter(|(cost, _)| cost.is_finite()) {
        chart.circle([k, cost], 2.2, &sheer(fill(CALM), 0.5));
        if cost < least {
            // Down from what was least before, if anything was.
            line.extend([least, cost].into_iter().filter(|c| c.is_finite()).map(|c| [k, c]));
            least = cost;
        }
    }
    line.push([costs.len() as f64 + 0.5, least]);
    chart.line(line, &stroke(ALARM, 2.0));
    chart.picture(376.0)
}

/// The weight of each number as a bar, the heaviest first.
fn weight_picture(result: &SearchResult) -> String {
    let cost = result.costs[1];
    let mut numbers: Vec<&SearchedNumber> = result.numbers.iter().collect();
    numbers.sort_by(|a, b| b.weight(cost).total_cmp(&a.weight(cost)));
    let mut sheet = Sheet::new(WIDTH, ROW * numbers.len() as f64 + 52.0);
    let largest = numbers.first().map_or(0.0, |n| n.weight(cost)).max(f64::MIN_POSITIVE);
    for (k, number) in numbers.iter().enumerate() {
        let y = 12.0 + ROW * k as f64;
        sheet.text([LABELS - 12.0, y + 13.0], &number.name, ink(12.0, INK).end());
        for (half, moved) in number.moved.iter().enumerate() {
            let Some(moved) = moved else { continue };
            let rise = (moved.cost - cost).max(0.0);
            let length = 0.45 * (WIDTH - LABELS) * rise / largest;
            let label = format!("{} {}", significant(moved.to, 4), number.unit);
            let fact = &result.facts.rows[moved.worst].quantity;
            let words = if rise > 0.02 * largest { format!("{label}: {fact}") } else { label };
            let hex = [MEASURED, ALARM][half];
            sheet.bar([LABELS, y + 9.0 * half as f64], [length, 8.0], hex, &words);
        }
    }
    let foot = "rise of the cost; blue: a smaller number, orange: a larger one, and the fact that gets worst";
    let bottom = ROW * numbers.len() as f64 + 36.0;
    sheet.text([0.5 * (LABELS + WIDTH), bottom], foot, ink(12.0, MUTED).middle());
    sheet.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{CheckedCase, CheckedQuantity, Moved};

    #[test]
    fn what_is_missed_and_what_matters_is_told() {
        let fact = |quantity: &str, computed: f64| CheckedQuantity {
            quantity: quantity.into(),
            computed,
            reference: 936.0,
            tolerance: 0.02,
            relative: true,
            reason: String::new(),
        };
        let moved = |cost: f64, worst: usize| Some(Moved { to: 2e7, cost, worst });
        let number = |name: &str, moved| SearchedNumber {
            name: name.into(),
            paths: vec!["contact.rim.normal.stiffness".into()],
            unit: "N/m".into(),
            between: [1e6, 1e8],
            before: 1e7,
            after: 1.9e7,
            moved,
        };
        let result = SearchResult {
            title: "A < B".into(),
            numbers: vec![
                number("stiffness", [moved(3.0, 1), moved(9.0, 0)]),
                number("lead", [None, moved(2.5, 1)]),
            ],
            facts: CheckedCase {
                name: "x".into(),
                title: "A < B".into(),
                source: "a paper.".into(),
                rows: vec![fact("peak", 940.0), fact("other peak", f64::NAN)],
                seconds: 1.0,
            },
            before: vec![900.0, f64::NAN],
            costs: [50.0, 2.0],
            history: vec![50.0, f64::INFINITY, 70.0, 2.0],
            without_answer: 1,
            found_case: String::new(),
        };
        let text = search_text(&result, None);
        assert!(!text.contains("bottom"));
        let mut better = result.clone();
        better.costs[1] = 2.6;
        assert!(search_text(&better, None).contains("not at the bottom: with `lead` alone"));
        for words in
            ["1 of 2 facts", "2 numbers free", "proves nothing", "`stiffness`", "“peak”", "1 of them without"]
        {
            assert!(text.contains(words), "{words} not in\n{text}");
        }
        let dir = tempfile::tempdir().unwrap();
        let provenance = Provenance::now("search.toml", "title = \"A < B\"\n");
        let case = InputFile::of_text("case.toml", "title = 1");
        write_search(dir.path(), &result, &provenance, &[case]).unwrap();
        let read = |name: &str| std::fs::read_to_string(dir.path().join(name)).unwrap();
        assert!(read("search.html").contains("A &lt; B") && read("search.html").contains("verdict bad"));
        for words in
            ["Provenance</h2>", "commit", "case.toml", "18eedd0d53ee", "title = &quot;A &lt; B&quot;"]
        {
            assert!(read("search.html").contains(words), "{words}");
        }
        assert_eq!(read("search_cost.svg").matches("<circle").count(), 3);
        assert!(read("search_weights.svg").contains("stiffness"));
    }
}
