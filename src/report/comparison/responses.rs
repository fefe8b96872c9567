//! `measured_frf_<name>.svg`: measured over computed responses, one panel each.

use super::super::axes::WIDTH;
use super::super::chart::{Area, sheet, text};
use super::super::colours::{ALARM, INK, MEASURED};
use super::super::curve::{Dash, Pen, legend_line, pen};
use super::super::format::fixed;
use super::super::magnitude::{draw_magnitude, draw_phase, magnitude_axes, phase_axes};
use crate::linalg::c64;
use crate::measured::Quantity;
use crate::report::section::Picture;
use crate::results::{MeasuredResponses, ResponsePair, file_name};
use std::error::Error;

/// Panels in one picture; the others are in the table.
const MOST: usize = 6;
/// Heights: of the magnitudes with their legend, of the phases, of the words below the last panel, of the legend.
const SIZES: u32 = 260;
const PHASES: u32 = 120;
const WORDS: u32 = 26;
const LEGEND: u32 = 26;

/// Responses over one another.
pub(in crate::report) struct ResponsePanel {
    /// \[Hz\].
    pub frequencies_hz: Vec<f64>,
    /// Receptance, mobility or accelerance.
    pub quantity: Quantity,
    /// The last is drawn on top.
    pub curves: Vec<ResponseCurve>,
}

/// One of them.
pub(in crate::report) struct ResponseCurve {
    /// Text of the legend.
    pub words: String,
    /// Its line: dashed where it lies over another.
    pub pen: Pen<'static>,
    /// Its magnitude at each frequency.
    pub sizes: Vec<f64>,
    /// Its phase at each frequency \[rad\]; empty where only magnitudes are compared.
    pub phases: Vec<f64>,
}

/// A solid line under the measured one.
pub(in crate::report) fn computed_pen() -> Pen<'static> {
    pen(ALARM, 3.5)
}

/// Dashes over the computed line, both of which are seen where the two coincide.
pub(in crate::report) fn measured_pen() -> Pen<'static> {
    Pen { dash: Dash::Dashed, ..pen(MEASURED, 1.6) }
}

pub(super) fn picture(responses: &MeasuredResponses) -> Option<Picture> {
    let panel = |pair: &ResponsePair| {
        let curve = |words: String, pen: Pen<'static>, values: &[c64]| ResponseCurve {
            words,
            pen,
            sizes: values.iter().map(|v| v.norm()).collect(),
            phases: values.iter().map(|v| v.arg()).collect(),
        };
        let short = pair.name.chars().take(36).collect::<String>();
        let place = pair.place.replace('_', " ");
        let computed = format!("computed: {place}, FRAC {}", fixed(pair.assurance, 3));
        ResponsePanel {
            frequencies_hz: pair.frequencies_hz.clone(),
            quantity: pair.quantity,
            curves: vec![
                curve(computed, computed_pen(), &pair.computed),
                curve(format!("measured: {short}"), measured_pen(), &pair.measured),
            ],
        }
    };
    let panels: Vec<ResponsePanel> = responses.pairs.iter().take(MOST).map(panel).collect();
    let svg = stacked(&panels)?;
    let more = if responses.pairs.len() > MOST { format!("; the first {MOST}") } else { String::new() };
    let caption = format!(
        "Measured responses ({}, dashed) over the computed ones ({}, solid){more}. FRAC is 1 where they are alike over the band.",
        responses.name, responses.frf
    );
    Some(Picture { file: file_name("measured_frf", &responses.name), caption, svg })
}

/// The first panels, one below the other; `None` where there are none.
pub(in crate::report) fn stacked(panels: &[ResponsePanel]) -> Option<String> {
    let shown = &panels[..panels.len().min(MOST)];
    if shown.is_empty() {
        return None;
    }
    let heights = shown.iter().map(ResponsePanel::height).sum::<u32>();
    sheet((WIDTH, heights + WORDS), |area| {
        let mut rest = area.clone();
        for (k, own) in shown.iter().enumerate() {
            let last = k + 1 == shown.len();
            let (panel, below) = rest.split_vertically(own.height() + if last { WORDS } else { 0 });
            own.draw(&panel, last.then_some("frequency [Hz]"))?;
            rest = below;
        }
        Ok(())
    })
}

impl ResponsePanel {
    fn has_phases(&self) -> bool {
        self.curves.iter().any(|curve| !curve.phases.is_empty())
    }

    fn height(&self) -> u32 {
        SIZES + if self.has_phases() { PHASES } else { 0 }
    }

    fn draw(&self, area: &Area, below: Option<&str>) -> Result<(), Box<dyn Error>> {
        let hz = &self.frequencies_hz;
        let (legend, main) = area.split_vertically(LEGEND);
        let mut x = 120;
        for curve in self.curves.iter().rev() {
            legend_line(&legend, (x, 12), curve.pen)?;
            legend.draw_text(&curve.words, &text(13.0, INK), (x + 36, 4))?;
            x += 74 + 8 * curve.words.chars().count() as i32;
        }
        let (upper, lower) = match self.has_phases() {
            true => main.split_vertically(SIZES - LEGEND),
            false => (main.clone(), main),
        };
        let sizes = self.curves.iter().flat_map(|curve| curve.sizes.iter().copied());
        let under_sizes = below.filter(|_| !self.has_phases());
        let chart = magnitude_axes(&upper, hz, self.quantity, sizes, under_sizes)?;
        for curve in &self.curves {
            let points = hz.iter().copied().zip(curve.sizes.iter().copied());
            draw_magnitude(&chart, points, curve.pen)?;
        }
        if !self.has_phases() {
            return Ok(());
        }
        let chart = phase_axes(&lower, hz, below)?;
        for curve in &self.curves {
            let points = hz.iter().copied().zip(curve.phases.iter().copied());
            draw_phase(&chart, points, curve.pen)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::sample;

    #[test]
    fn a_measured_curve_is_dashed_over_a_computed_one_that_is_equal() {
        let results = sample::rig();
        let mut responses = results.all::<MeasuredResponses>()[0].clone();
        for pair in &mut responses.pairs {
            pair.measured = pair.computed.clone();
        }
        responses.pairs.truncate(1);
        let svg = picture(&responses).unwrap().svg;
        let lines: Vec<&str> =
            svg.split("<path ").skip(1).map(|rest| rest.split("/>").next().unwrap()).collect();
        let of = |hex: &str| lines.iter().position(|line| line.contains(hex) && line.len() > 300).unwrap();
        let (below, above) = (lines[of(ALARM)], lines[of(MEASURED)]);
        let points = |line: &str| line.split('"').nth(1).unwrap().to_string();
        assert!(of(ALARM) < of(MEASURED) && points(below) == points(above));
        assert!(below.contains("dasharray=\"none\"") && above.contains("dasharray=\"7 5\""), "{above}");
    }
}
