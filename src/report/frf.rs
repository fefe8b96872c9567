//! Frequency responses: magnitude and phase, and which resonances show.

use super::colours::{ALARM, INK, PARTS, SECOND};
use super::finding::{Finding, FindingClass};
use super::format::{fixed, given, hertz, power, prefixed};
use super::magnitude::{ResponseCurve, ResponsePanel, stacked};
use super::section::{Display, Picture, ReportSection};
use super::svg::{CHAIN, DASHED, DOTTED, Style, stroke};
use super::table::{ReportTable, idle};
use crate::error::text::capital;
use crate::results::{FrfResponse, FrfResult, RunResults, file_name};

/// A mode with less than this part of the largest product of shapes does not show.
const HIDDEN: f64 = 0.01;
/// Superposition that differs from the direct solution by more than this part is reported first.
const DEVIATION: f64 = 0.01;
/// A measured resonance is paired with a mode that differs from it by less than this part.
const NEAR: f64 = 0.05;
/// Unstable modes that a finding names.
const NAMED: usize = 3;

/// Every frequency response.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    let section = |frf: &FrfResult| {
        ReportSection::new(format!("Frequency response: {}", frf.name))
            .findings([finding(frf)])
            .pictures(picture(frf))
            .tables(Display::Titled, [table(frf)])
    };
    results.all::<FrfResult>().into_iter().map(section).collect()
}

/// The largest response, and whether superposition and the direct solution agree.
fn finding(frf: &FrfResult) -> Finding {
    if !frf.unstable.is_empty() {
        let words = format!(
            "Frequency response {}: about an unstable state ({}); no test measures it.",
            frf.name,
            frf.unstable_words(NAMED)
        );
        return Finding::new(FindingClass::Attention, words);
    }
    let undamped = frf.undamped().count();
    if undamped > 0 {
        let words = format!(
            "Frequency response {}: without a bound at {undamped} resonance{} that nothing damps.",
            frf.name,
            if undamped == 1 { "" } else { "s" }
        );
        return Finding::new(FindingClass::Attention, words);
    }
    let values = frf.responses.iter().flat_map(|of| {
        frf.frequencies_hz.iter().zip(&of.values).map(move |(hz, value)| (value.norm(), *hz, of))
    });
    let largest = values.filter(|(size, ..)| size.is_finite()).max_by(|a, b| a.0.total_cmp(&b.0));
    let Some((size, hz, of)) = largest else {
        let words = format!("Frequency response {}: no value is finite.", frf.name);
        return Finding::new(FindingClass::Attention, words);
    };
    let mut words = format!(
        "Frequency response {}: the largest {} is {} at {} Hz, at {}.",
        frf.name,
        frf.quantity.word(),
        prefixed(size, frf.quantity.unit(), 3),
        hertz(hz, 1),
        of.name.replace('_', " ")
    );
    if frf.compared > 0 && frf.deviation > DEVIATION {
        words += &format!(
            " At one of {} frequencies superposition differs from the direct solution by {} times the latter.",
            frf.compared,
            power(frf.deviation)
        );
        return Finding::new(FindingClass::Attention, words);
    }
    Finding::new(FindingClass::Neutral, words)
}

fn caption(frf: &FrfResult) -> String {
    let measured = if frf.measured.is_empty() { "" } else { " Blue: measured resonances." };
    let unstable =
        if frf.unstable.is_empty() { "" } else { " About an unstable state: not what a test measures." };
    format!(
        "{} for a force at {}; {}. Dotted: natural frequencies.{measured}{unstable}",
        capital(frf.quantity.word()),
        frf.excitation,
        frf.about
    )
}

fn picture(frf: &FrfResult) -> Option<Picture> {
    let curve = |(k, response): (usize, &FrfResponse)| ResponseCurve {
        words: response.name.replace('_', " "),
        style: line(k),
        sizes: response.values.iter().map(|v| v.norm()).collect(),
        phases: response.values.iter().map(|v| v.arg()).collect(),
    };
    let panel = ResponsePanel {
        frequencies_hz: frf.frequencies_hz.clone(),
        quantity: frf.quantity,
        curves: frf.responses.iter().enumerate().map(curve).collect(),
        natural_hz: frf.resonances.iter().map(|resonance| resonance.frequency_hz).collect(),
        measured_hz: frf.measured.clone(),
        heights: [356.0, 160.0],
    };
    let known =
        panel.curves.iter().flat_map(|curve| &curve.sizes).any(|size| *size > 0.0 && size.is_finite());
    let svg = stacked(&[panel]).filter(|_| known)?;
    Some(Picture { file: file_name("frf", &frf.name), caption: caption(frf), svg })
}

/// The line of response `k`: dashes show the lines below where responses coincide.
fn line(k: usize) -> Style {
    let hex = [ALARM, SECOND, PARTS[2][0], INK][k % 4];
    stroke(hex, if k == 0 { 2.0 } else { 1.5 }) + ["", DASHED, CHAIN, DOTTED][k % 4]
}

/// The real modes of the band, and how much of each shows at each place.
fn table(frf: &FrfResult) -> ReportTable {
    let headings = ["<mode", "f [Hz]", "measured [Hz]", "<place", "seen [%]", "<why"];
    let mut table = ReportTable::new(
        format!("Frequency response {}: {} for a force at {}", frf.name, frf.quantity.word(), frf.excitation),
        &headings,
    );
    table.file = Some(file_name("frf", &frf.name));
    let beside = beside(frf);
    for (k, resonance) in frf.resonances.iter().enumerate() {
        for (place, response) in frf.responses.iter().enumerate() {
            let seen = resonance.seen[place];
            let why = match (resonance.undamped, seen < HIDDEN) {
                (true, _) => "nothing damps it: without a bound",
                (false, true) => "hidden: a node of it",
                _ => "",
            };
            let first = place == 0;
            let cells = vec![
                if first { resonance.name.clone() } else { String::new() },
                if first { hertz(resonance.frequency_hz, 1) } else { String::new() },
                if first { beside[k].clone() } else { String::new() },
                response.name.replace('_', " "),
                fixed(100.0 * seen, 1),
                why.to_string(),
            ];
            table.row(cells, false);
        }
    }
    let mut table = table.without_columns(idle);
    let node = "Hidden: the place or the force stands on a node of the mode.";
    table.notes.push(node.into());
    table.notes.push(format!("{}; {} frequencies.", capital(&frf.about), frf.frequencies_hz.len()));
    if !frf.unstable.is_empty() {
        table
            .notes
            .push(format!("Unstable: {}; no steady response is reached.", frf.unstable_words(usize::MAX)));
    }
    table.notes.push(format!(
        "Superposition differs from the direct solution by {} at most, at {} frequencies.",
        power(frf.deviation),
        frf.compared
    ));
    table
}

/// Measured frequency beside each mode: that of the nearest mode that shows somewhere, if it is near.
fn beside(frf: &FrfResult) -> Vec<String> {
    let mut beside = vec![String::new(); frf.resonances.len()];
    for measured in &frf.measured {
        let away = |k: &usize| (measured / frf.resonances[*k].frequency_hz - 1.0).abs();
        let shows = |k: &usize| frf.resonances[*k].seen.iter().any(|seen| *seen >= HIDDEN);
        let nearest = (0..beside.len()).filter(shows).min_by(|a, b| away(a).total_cmp(&away(b)));
        if let Some(k) = nearest.filter(|k| away(k) < NEAR) {
            beside[k] = given(*measured);
        }
    }
    beside
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;

    #[test]
    fn every_response_has_a_picture_and_hidden_modes_are_named() {
        let results = sample::rig();
        let [section] = &sections(&results)[..] else { panic!("one section") };
        let picture = section.drawn().next().unwrap();
        assert!(picture.file == "frf_hammer" && picture.svg.contains("560"));
        let frf = results.all::<FrfResult>()[0];
        let table = table(frf);
        assert_eq!(table.rows.len(), 2 * frf.resonances.len());
        // 560 Hz was measured near the second mode (3, 0), of 566.9 Hz: the rim is at rest in the first.
        assert!(table.rows[10].cells[5].starts_with("hidden") && table.rows[12].cells[2] == "560");
        assert!(
            crate::report::html::PageLayout::default()
                .section(section, "x", None)
                .contains("Superposition differs")
        );
    }
}
