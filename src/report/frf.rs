//! Frequency responses: magnitude and phase, and which resonances show.

use super::axes::{Chart, WIDTH};
use super::chart::{Area, sheet, text};
use super::colours::{ALARM, INK, MEASURED, MUTED, PARTS, SECOND};
use super::curve::{Dash, Pen, draw_curve, legend_line, pen};
use super::finding::{Finding, FindingClass};
use super::format::{fixed, given, hertz, power, prefixed};
use super::magnitude::{draw_magnitude, draw_phase, magnitude_axes, phase_axes};
use super::section::{Display, Picture, ReportSection};
use super::table::{ReportTable, idle};
use crate::results::{FrfResult, RunResults, file_name};
use std::error::Error;

/// A mode with less than this part of the largest product of shapes does not show.
const HIDDEN: f64 = 0.01;
/// Superposition that differs from the direct solution by more than this part is reported first.
const DEVIATION: f64 = 0.01;
/// A measured resonance is paired with a mode that differs from it by less than this part.
const NEAR: f64 = 0.05;

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
    format!(
        "{} for a force at {}; {}. Dotted: natural frequencies.{measured}",
        capital(frf.quantity.word()),
        frf.excitation,
        frf.about
    )
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn picture(frf: &FrfResult) -> Option<Picture> {
    if !magnitudes(frf).any(|size| size > 0.0) {
        return None;
    }
    let svg = sheet((WIDTH, 620), |area| {
        let (legend, main) = area.split_vertically(34);
        let (upper, lower) = main.split_vertically(390);
        for (k, response) in frf.responses.iter().enumerate() {
            let x = 120 + 190 * (k % 4) as i32;
            legend_line(&legend, (x, 18), line(k))?;
            legend.draw_text(&response.name.replace('_', " "), &text(13.0, INK), (x + 36, 10))?;
        }
        let hz = &frf.frequencies_hz;
        let sizes = magnitude_axes(&upper, hz, frf.quantity, magnitudes(frf), None)?;
        let phases = phase_axes(&lower, hz, Some("frequency [Hz]"))?;
        marks(&sizes, frf)?;
        marks(&phases, frf)?;
        name_measured(&upper, &sizes, frf)?;
        for (k, response) in frf.responses.iter().enumerate() {
            let points = || hz.iter().copied().zip(&response.values);
            draw_magnitude(&sizes, points().map(|(hz, v)| (hz, v.norm())), line(k))?;
            draw_phase(&phases, points().map(|(hz, v)| (hz, v.arg())), line(k))?;
        }
        Ok(())
    })?;
    Some(Picture { file: file_name("frf", &frf.name), caption: caption(frf), svg })
}

fn magnitudes(frf: &FrfResult) -> impl Iterator<Item = f64> + '_ {
    frf.responses.iter().flat_map(|of| &of.values).map(|v| v.norm()).filter(|v| v.is_finite())
}

/// The line of response `k`: dashes show the lines below where responses coincide.
fn line(k: usize) -> Pen<'static> {
    let dash = [Dash::Solid, Dash::Dashed, Dash::Chain, Dash::Dotted][k % 4];
    Pen { dash, ..pen([ALARM, SECOND, PARTS[2][0], INK][k % 4], if k == 0 { 2.0 } else { 1.5 }) }
}

/// Dotted lines at the natural frequencies, blue ones at the measured.
fn marks(chart: &Chart, frf: &FrfResult) -> Result<(), Box<dyn Error>> {
    let up = chart.y_range();
    for resonance in &frf.resonances {
        let line = [(resonance.frequency_hz, up.start), (resonance.frequency_hz, up.end)];
        draw_curve(chart, line, Pen { opacity: 0.6, dash: Dash::Dotted, ..pen(MUTED, 1.0) })?;
    }
    for measured in shown(chart, frf) {
        let line = [(measured, up.start), (measured, up.end)];
        draw_curve(chart, line, Pen { opacity: 0.7, ..pen(MEASURED, 1.0) })?;
    }
    Ok(())
}

/// The measured frequencies in figures, each at the top of its line.
fn name_measured(area: &Area, chart: &Chart, frf: &FrfResult) -> Result<(), Box<dyn Error>> {
    for measured in shown(chart, frf) {
        let (x, y) = chart.backend_coord(&(measured, chart.y_range().end));
        let (left, upper) = area.get_base_pixel();
        area.draw_text(&given(measured), &text(11.5, MEASURED), (x - left + 4, y - upper))?;
    }
    Ok(())
}

/// The measured frequencies inside the chart.
fn shown(chart: &Chart, frf: &FrfResult) -> Vec<f64> {
    let band = chart.x_range();
    frf.measured.iter().copied().filter(|hz| band.contains(hz)).collect()
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
            let why = if seen < HIDDEN { "hidden: a node of it" } else { "" };
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
    use crate::results::sample;

    #[test]
    fn every_response_has_a_picture_and_hidden_modes_are_named() {
        let results = sample::rig();
        let [section] = &sections(&results)[..] else { panic!("one section") };
        let picture = section.drawn().next().unwrap();
        assert!(picture.file == "frf_hammer" && picture.svg.contains("1697"));
        let table = table(results.all::<FrfResult>()[0]);
        assert_eq!(table.rows.len(), 4);
        assert!(table.rows[3].cells[5].starts_with("hidden") && table.rows[2].cells[2] == "1697");
        assert!(
            crate::report::html::PageLayout::default()
                .section(section, "x")
                .contains("Superposition differs")
        );
    }
}
