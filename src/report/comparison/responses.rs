//! `measured_frf_<name>.svg`: measured over computed responses, one panel each.

use super::super::axes::{WIDTH, axes};
use super::super::chart::{Area, colour, sheet, text};
use super::super::colours::{ALARM, INK, MEASURED};
use super::super::format::fixed;
use super::Drawn;
use crate::linalg::c64;
use crate::measured::Quantity;
use crate::results::{MeasuredResponses, ResponsePair};
use plotters::prelude::*;
use std::error::Error;

/// Panels in one picture; the others are in the table.
const MOST: usize = 6;
const PANEL: u32 = 260;
/// Decades below the highest magnitude that are shown.
const DECADES: f64 = 6.0;

/// Responses over one another: what stands in the legend, the colour, and the size at each frequency.
pub(in crate::report) struct Panel {
    /// \[Hz\].
    pub frequencies_hz: Vec<f64>,
    /// What of the motion.
    pub quantity: Quantity,
    /// The last is drawn on top.
    pub curves: Vec<(String, &'static str, Vec<f64>)>,
}

pub(super) fn picture(responses: &MeasuredResponses, name: &str) -> Option<Drawn> {
    let panel = |pair: &ResponsePair| {
        let sizes = |values: &[c64]| values.iter().map(|v| v.norm()).collect::<Vec<f64>>();
        let short = pair.name.chars().take(36).collect::<String>();
        let place = pair.place.replace('_', " ");
        let computed = format!("computed: {place}, FRAC {}", fixed(pair.assurance, 3));
        Panel {
            frequencies_hz: pair.frequencies_hz.clone(),
            quantity: pair.quantity,
            curves: vec![
                (computed, ALARM, sizes(&pair.computed)),
                (format!("measured: {short}"), MEASURED, sizes(&pair.measured)),
            ],
        }
    };
    let panels: Vec<Panel> = responses.pairs.iter().take(MOST).map(panel).collect();
    let svg = stacked(&panels)?;
    let more = if responses.pairs.len() > MOST { format!("; the first {MOST}") } else { String::new() };
    let caption = format!(
        "Measured responses ({}) over the computed ones ({}){more}. FRAC is 1 where they are alike over the band.",
        responses.name, responses.frf
    );
    Some(Drawn { file: format!("measured_frf_{name}.svg"), caption, svg })
}

/// The first panels, one below the other; `None` where there are none.
pub(in crate::report) fn stacked(panels: &[Panel]) -> Option<String> {
    let shown = &panels[..panels.len().min(MOST)];
    if shown.is_empty() {
        return None;
    }
    sheet((WIDTH, PANEL * shown.len() as u32 + 26), |area| {
        let mut rest = area.clone();
        for (k, own) in shown.iter().enumerate() {
            let last = k + 1 == shown.len();
            let (panel, below) = rest.split_vertically(PANEL + if last { 26 } else { 0 });
            draw(&panel, own, last)?;
            rest = below;
        }
        Ok(())
    })
}

fn draw(area: &Area, panel: &Panel, last: bool) -> Result<(), Box<dyn Error>> {
    let sizes = || panel.curves.iter().flat_map(|(_, _, values)| values).copied().filter(|v| *v > 0.0);
    let largest = sizes().fold(f64::MIN_POSITIVE, f64::max);
    let top = largest.log10() + 0.3;
    let low = (sizes().fold(largest, f64::min).log10() - 0.3).max(top - DECADES);
    let hz = &panel.frequencies_hz;
    let ends = hz.first().copied().unwrap_or(0.0)..hz.last().copied().unwrap_or(1.0);
    let (legend, main) = area.split_vertically(26);
    let mut x = 120;
    for (words, hex, _) in panel.curves.iter().rev() {
        legend.draw(&Rectangle::new([(x, 10), (x + 16, 14)], colour(hex).filled()))?;
        legend.draw_text(words, &text(13.0, INK), (x + 22, 4))?;
        x += 60 + 8 * words.chars().count() as i32;
    }
    let exponent = |v: f64| format!("{:.0e}", 10f64.powf(v));
    let beside = format!("{} [{}]", panel.quantity.name(), panel.quantity.unit());
    let below = last.then_some("frequency [Hz]");
    let mut chart = axes(&main, (ends, low..top), below, &beside, exponent)?;
    for (k, (_, hex, values)) in panel.curves.iter().enumerate() {
        let point = |(hz, v): (&f64, &f64)| (*hz, v.max(f64::MIN_POSITIVE).log10().max(low));
        let curve: Vec<(f64, f64)> = hz.iter().zip(values).map(point).collect();
        let width = if k + 1 == panel.curves.len() { 2 } else { 1 };
        chart.draw_series([PathElement::new(curve, colour(hex).stroke_width(width))])?;
    }
    Ok(())
}
