//! Numbers found from measured frequencies, shapes and responses: tables, words and pictures.

mod finding;
mod picture;
mod words;

use super::format::{fixed, given, hertz, power, short, signed, significant};
use super::section::{Display, ReportSection};
use super::table::ReportTable;
use crate::results::{CalibratedNumber, CalibrationResult, RunResults};
use words::words;

/// A calibration, where the run has one.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    let Some(result) = results.get::<CalibrationResult>() else { return Vec::new() };
    let modes = !result.data.is_empty();
    let shapes = result.shapes().next().is_some();
    let responses = picture::responses(result);
    let response_table = responses.as_ref().map(|_| response_table(result));
    let section = ReportSection::new("Calibration")
        .findings([finding::finding(result)])
        .pictures(modes.then(|| picture::errors(result)))
        .tables(Display::Titled, modes.then(|| fit_table(result)))
        .tables(Display::Titled, shapes.then(|| shape_table(result)))
        .pictures(responses)
        .tables(Display::Titled, response_table)
        .pictures([picture::numbers(result)])
        .tables(Display::Titled, [number_table(result)])
        .words(words(result))
        .tables(Display::Titled, modes.then(|| assignment_table(result)));
    vec![section]
}

/// How like the computed shapes are to the measured ones, before and after.
fn shape_table(result: &CalibrationResult) -> ReportTable {
    let headings = ["<mode", "measured [Hz]", "components", "MAC before", "MAC after", "MAC from the others"];
    let mut table = ReportTable::new("Calibration: measured and computed shapes", &headings);
    for d in &result.data {
        let Some(shape) = d.shape else { continue };
        let mac = |mac: Option<f64>| mac.map_or("–".into(), |mac| fixed(mac, 4));
        let cells = vec![
            d.level.clone(),
            given(d.measured_hz),
            shape.components.to_string(),
            mac(shape.before),
            mac(shape.after),
            mac(shape.left_out),
        ];
        table.row(cells, false);
    }
    table
}

/// How far the computed responses are from the measured ones, before and after.
fn response_table(result: &CalibrationResult) -> ReportTable {
    let headings = [
        "<place",
        "lines",
        "from [Hz]",
        "to [Hz]",
        "before [dB]",
        "after [dB]",
        "[deviations]",
        "from the others [dB]",
        "[deviations]",
        "<response",
    ];
    let mut table = ReportTable::new("Calibration: measured and computed frequency responses", &headings);
    for r in &result.responses {
        let left_out = |apart: &dyn Fn(&[f64]) -> f64| {
            r.left_out.as_ref().map_or("–".into(), |sizes| fixed(apart(sizes), 2))
        };
        let end = |hz: Option<&f64>| hz.map_or("–".into(), |hz| hertz(*hz, 1));
        let cells = vec![
            r.place.clone(),
            r.frequencies_hz.len().to_string(),
            end(r.frequencies_hz.first()),
            end(r.frequencies_hz.last()),
            fixed(r.apart_db(&r.before), 2),
            fixed(r.apart_db(&r.after), 2),
            fixed(r.apart(&r.after), 2),
            left_out(&|sizes| r.apart_db(sizes)),
            left_out(&|sizes| r.apart(sizes)),
            r.name.clone(),
        ];
        table.row(cells, false);
    }
    table.notes.push(
        "Root mean square of 20 log₁₀ of computed over measured size; what is below a twentieth of the median, as at an \
         antiresonance, counts as no smaller. Deviations: the same over the standard deviation of a line, as the fit weighs it. Half \
         of the lines lie evenly, half where the measured response changes most. From the others: what the numbers predict \
         when they are found without this response."
            .into(),
    );
    table
}

/// Measured beside computed frequencies, before and after.
fn fit_table(result: &CalibrationResult) -> ReportTable {
    let sets = result.data.iter().any(|d| d.set != result.data[0].set);
    let grows = result.data.iter().any(|d| d.growth.is_some());
    let mut headings = vec![
        "<mode",
        "measured [Hz]",
        "before [Hz]",
        "error [%]",
        "after [Hz]",
        "error [%]",
        "from the others [Hz]",
        "error [%]",
    ];
    if sets {
        headings.insert(0, "<set");
    }
    if grows {
        headings.push("σ [1/s]");
    }
    let mut table = ReportTable::new("Calibration: measured and computed frequencies", &headings);
    for d in &result.data {
        let mut cells = vec![d.level.clone(), given(d.measured_hz)];
        for hz in [d.before_hz, d.after_hz, d.left_out_hz] {
            cells.push(hz.map_or("–".into(), |hz| hertz(hz, 1)));
            cells.push(d.error_percent(hz).map_or("–".into(), |e| signed(e, 2)));
        }
        if sets {
            cells.insert(0, d.set.clone());
        }
        if grows {
            cells.push(d.growth.map_or("–".into(), |g| signed(g, 2)));
        }
        table.row(cells, false);
    }
    let kept = if result.responses.is_empty() { "" } else { "; the responses stay" };
    table.notes.push(format!(
        "From the others: what the numbers predict when they are found without this frequency and its shape{kept}."
    ));
    table
}

/// The numbers with their intervals.
fn number_table(result: &CalibrationResult) -> ReportTable {
    let headings = [
        "<number",
        "before",
        "found",
        "95 % from",
        "to",
        "scaled from",
        "to",
        "<bounds",
        "<expected",
        "<unit",
        "<",
    ];
    let mut table = ReportTable::new("Numbers found", &headings);
    for n in &result.numbers {
        let value = |v: f64| significant(v, 4);
        let scaled = |k: usize| n.scaled_interval.map_or("–".into(), |ends| value(ends[k]));
        let cells = vec![
            n.name.clone(),
            value(n.before),
            significant(n.after, 5),
            value(n.interval[0]),
            value(n.interval[1]),
            scaled(0),
            scaled(1),
            format!("{} to {}", short(n.between[0]), short(n.between[1])),
            expected(n),
            n.unit.clone(),
            if n.at_bound { "at its bound".into() } else { String::new() },
        ];
        table.row(cells, n.at_bound);
    }
    table.alarming = true;
    table.notes.push(
        "95 %: the stated deviations trusted, with what was expected. Scaled: deviations as large as the misfit shows, with \
         Student's t. Both end at the bounds."
            .into(),
    );
    table.without_columns(str::is_empty)
}

fn expected(n: &CalibratedNumber) -> String {
    match n.deviation {
        Some(d) if n.log => format!("{} ± {} %", short(n.expected), short(100.0 * d)),
        Some(d) => format!("{} ± {}", short(n.expected), short(d)),
        None => "all alike".into(),
    }
}

/// The assignments that were fitted.
fn assignment_table(result: &CalibrationResult) -> ReportTable {
    let mut headings =
        vec!["<modes, in the order of the measured frequencies", "χ²", "largest error [%]", "weight", "<"];
    let shapes = result.shapes().next().is_some();
    if shapes {
        headings.insert(3, "least MAC");
    }
    let mut table = ReportTable::new("Assignments of modes to measured frequencies", &headings);
    for r in &result.calibration.ranked {
        let modes: Vec<&str> = r.assignment.iter().map(|k| result.levels[*k].as_str()).collect();
        let mut cells = vec![
            modes.join(", "),
            significant(r.fit.chi2, 4),
            fixed(100.0 * r.largest_error, 2),
            if r.weight > 1e-3 { significant(r.weight, 2) } else { power(r.weight) },
            if r.fit.converged { String::new() } else { "not converged".into() },
        ];
        if shapes {
            cells.insert(3, r.least_mac.map_or("–".into(), |mac| fixed(mac, 3)));
        }
        table.row(cells, false);
    }
    table.notes.push(
        "χ²: of all that was measured and expected, responses included. Weight: exp(−Δχ²/2) beside the best, with the stated deviations; where the misfit is larger than they explain, the \
         weights are too sharp."
            .into(),
    );
    table.without_columns(str::is_empty)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;

    #[test]
    fn tables_words_and_pictures_tell_the_same() {
        let mut results = sample::rig();
        let result = results.get_mut::<CalibrationResult>().unwrap();
        let response = &mut result.responses[0];
        (response.deviation, response.frequencies_hz) = (0.1, vec![300.0, 330.0, 400.0]);
        (response.measured, response.before) = (vec![1.0, 10.0, 2.0], vec![2.0, 5.0, 2.0]);
        (response.after, response.left_out) = (vec![1.0, 9.0, 2.0], Some(vec![1.0, 8.0, 2.0]));
        // The second combination is known to 2.5 of its unit, and a second assignment has not converged.
        result.calibration.knowledge.singular_values = vec![30.0, 0.4];
        let mut second = result.calibration.ranked[0].clone();
        second.fit.converged = false;
        result.calibration.ranked.push(second);
        let result = results.get::<CalibrationResult>().unwrap();
        let table = fit_table(result);
        assert_eq!((table.rows.len(), table.columns.len()), (2, 8));
        let shapes = shape_table(result);
        assert_eq!((shapes.rows.len(), &shapes.rows[0].cells[4][..]), (2, "0.9659"));
        // 945.1 Hz beside 936 Hz.
        assert!(table.rows[1].cells.contains(&"+0.97".to_string()), "{:?}", table.rows[1]);
        let numbers = number_table(result);
        assert!(numbers.rows[1].marked && numbers.rows[1].cells.last().unwrap() == "at its bound");
        let [section] = &sections(&results)[..] else { panic!("one section") };
        assert_eq!(section.drawn().count(), 3);
        // 20 log₁₀ of 2, of 2 and of 1; of 10/9 and of 10/8 at one of three lines; a deviation is 0.87 dB.
        let cells = &response_table(result).rows[0].cells;
        assert_eq!(cells[4..9], ["4.92", "0.53", "0.61", "1.12", "1.29"]);
        let page = crate::report::html::PageLayout::default().section(section, "x", None);
        assert!(page.contains("not converged") && page.contains("scale"));
        let words = words(result).join(" ");
        for expected in [
            "2 numbers",
            "2 measured",
            "determine 1 of 2",
            "best 1 on the linearised model were fitted to the modes",
            "ranked by the χ² of all",
            "Chance is asked about the frequencies alone",
            "by chance",
            "of 10 trials",
            "at its bound",
        ] {
            assert!(words.contains(expected), "{expected} not in {words}");
        }
        assert!(sections(&RunResults::default()).is_empty());
    }
}
