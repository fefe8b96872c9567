//! `measured_frf_<name>.svg`: measured over computed responses, one panel each.

use super::super::axes::WIDTH;
use super::super::chart::{Area, colour, sheet, text};
use super::super::colours::{ALARM, INK, MEASURED};
use super::super::format::fixed;
use super::super::magnitude::{draw_magnitude, draw_phase, magnitude_axes, phase_axes};
use crate::linalg::c64;
use crate::measured::Quantity;
use crate::report::section::Picture;
use crate::results::{MeasuredResponses, ResponsePair, file_name};
use plotters::prelude::{Color, Rectangle};
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
    /// Its colour.
    pub hex: &'static str,
    /// Its magnitude at each frequency.
    pub sizes: Vec<f64>,
    /// Its phase at each frequency \[rad\]; empty where only magnitudes are compared.
    pub phases: Vec<f64>,
}

pub(super) fn picture(responses: &MeasuredResponses) -> Option<Picture> {
    let panel = |pair: &ResponsePair| {
        let curve = |words: String, hex: &'static str, values: &[c64]| ResponseCurve {
            words,
            hex,
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
                curve(computed, ALARM, &pair.computed),
                curve(format!("measured: {short}"), MEASURED, &pair.measured),
            ],
        }
    };
    let panels: Vec<ResponsePanel> = responses.pairs.iter().take(MOST).map(panel).collect();
    let svg = stacked(&panels)?;
    let more = if responses.pairs.len() > MOST { format!("; the first {MOST}") } else { String::new() };
    let caption = format!(
        "Measured responses ({}) over the computed ones ({}){more}. FRAC is 1 where they are alike over the band.",
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
            legend.draw(&Rectangle::new([(x, 10), (x + 16, 14)], colour(curve.hex).filled()))?;
            legend.draw_text(&curve.words, &text(13.0, INK), (x + 22, 4))?;
            x += 60 + 8 * curve.words.chars().count() as i32;
        }
        let (upper, lower) = match self.has_phases() {
            true => main.split_vertically(SIZES - LEGEND),
            false => (main.clone(), main),
        };
        let sizes = self.curves.iter().flat_map(|curve| curve.sizes.iter().copied());
        let under_sizes = below.filter(|_| !self.has_phases());
        let mut chart = magnitude_axes(&upper, hz, self.quantity, sizes, under_sizes)?;
        for (k, curve) in self.curves.iter().enumerate() {
            let points = hz.iter().copied().zip(curve.sizes.iter().copied());
            draw_magnitude(&mut chart, points, (curve.hex, self.width(k)))?;
        }
        if !self.has_phases() {
            return Ok(());
        }
        let mut chart = phase_axes(&lower, hz, below)?;
        for (k, curve) in self.curves.iter().enumerate() {
            let points = hz.iter().copied().zip(curve.phases.iter().copied());
            draw_phase(&mut chart, points, (curve.hex, self.width(k)))?;
        }
        Ok(())
    }

    fn width(&self, curve: usize) -> u32 {
        if curve + 1 == self.curves.len() { 2 } else { 1 }
    }
}
