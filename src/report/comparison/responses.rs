//! `measured_frf_<name>.svg`: measured over computed responses, one panel each.

use super::super::axes::{WIDTH, axes};
use super::super::chart::{Area, colour, sheet, text};
use super::super::colours::{ALARM, INK, MEASURED};
use super::super::format::fixed;
use super::Drawn;
use crate::linalg::c64;
use crate::results::{MeasuredResponses, ResponsePair};
use plotters::prelude::*;
use std::error::Error;

/// Panels in one picture; the others are in the table.
const MOST: usize = 6;
const PANEL: u32 = 260;
/// Decades below the highest magnitude that are shown.
const DECADES: f64 = 6.0;

pub(super) fn picture(responses: &MeasuredResponses, name: &str) -> Option<Drawn> {
    let shown = &responses.pairs[..responses.pairs.len().min(MOST)];
    if shown.is_empty() {
        return None;
    }
    let height = PANEL * shown.len() as u32 + 26;
    let svg = sheet((WIDTH, height), |area| {
        let mut rest = area.clone();
        for (k, pair) in shown.iter().enumerate() {
            let last = k + 1 == shown.len();
            let (panel, below) = rest.split_vertically(PANEL + if last { 26 } else { 0 });
            draw(&panel, pair, last)?;
            rest = below;
        }
        Ok(())
    })?;
    let more = if responses.pairs.len() > MOST { format!("; the first {MOST}") } else { String::new() };
    let caption = format!(
        "Measured responses ({}) over the computed ones ({}){more}. FRAC is 1 where they are alike over the band.",
        responses.name, responses.frf
    );
    Some(Drawn { file: format!("measured_frf_{name}.svg"), caption, svg })
}

fn draw(area: &Area, pair: &ResponsePair, last: bool) -> Result<(), Box<dyn Error>> {
    let sizes = || pair.measured.iter().chain(&pair.computed).map(|v| v.norm()).filter(|v| *v > 0.0);
    let largest = sizes().fold(f64::MIN_POSITIVE, f64::max);
    let top = largest.log10() + 0.3;
    let low = (sizes().fold(largest, f64::min).log10() - 0.3).max(top - DECADES);
    let hz = &pair.frequencies_hz;
    let ends = hz.first().copied().unwrap_or(0.0)..hz.last().copied().unwrap_or(1.0);
    let (legend, main) = area.split_vertically(26);
    let words = |x: i32, hex: &str, words: &str| -> Result<(), Box<dyn Error>> {
        legend.draw(&Rectangle::new([(x, 10), (x + 16, 14)], colour(hex).filled()))?;
        legend.draw_text(words, &text(13.0, INK), (x + 22, 4))?;
        Ok(())
    };
    words(120, MEASURED, &format!("measured: {}", pair.name.chars().take(36).collect::<String>()))?;
    let place = pair.place.replace('_', " ");
    words(470, ALARM, &format!("computed: {place}, FRAC {}", fixed(pair.assurance, 3)))?;
    let exponent = |v: f64| format!("{:.0e}", 10f64.powf(v));
    let beside = format!("{} [{}]", pair.quantity.name(), pair.quantity.unit());
    let below = last.then_some("frequency [Hz]");
    let mut chart = axes(&main, (ends, low..top), below, &beside, exponent)?;
    let curve = |values: &[c64]| -> Vec<(f64, f64)> {
        hz.iter().zip(values).map(|(hz, v)| (*hz, v.norm().max(f64::MIN_POSITIVE).log10().max(low))).collect()
    };
    chart.draw_series([PathElement::new(curve(&pair.computed), colour(ALARM).stroke_width(1))])?;
    chart.draw_series([PathElement::new(curve(&pair.measured), colour(MEASURED).stroke_width(2))])?;
    Ok(())
}
