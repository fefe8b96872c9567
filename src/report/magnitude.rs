//! Frequency responses over one another: magnitude on a logarithmic scale, and phase below it.

use super::chart::{Axis, Chart, WIDTH, ends, wide};
use super::colours::{ALARM, MEASURED, MUTED};
use super::format::given;
use super::svg::{DASHED, DOTTED, Key, Sheet, Style, ink, sheer, stroke};
use crate::measured::Quantity;

/// Decades below the highest magnitude that are shown.
const DECADES: f64 = 6.0;
/// Half a turn \[°\]: where the phase leaves the chart on one side it comes in on the other.
const HALF: f64 = 180.0;
const MARGIN: f64 = 5.0;
/// Space for the labels below a chart, and for the name of the axis below the last \[px\].
const LABELS: f64 = 34.0;
const NAME: f64 = 22.0;

/// Responses over one another.
pub(super) struct ResponsePanel {
    /// \[Hz\].
    pub frequencies_hz: Vec<f64>,
    /// Receptance, mobility or accelerance.
    pub quantity: Quantity,
    /// The last is drawn on top.
    pub curves: Vec<ResponseCurve>,
    /// Natural frequencies \[Hz\].
    pub natural_hz: Vec<f64>,
    /// Measured frequencies \[Hz\].
    pub measured_hz: Vec<f64>,
    /// Heights of the charts of magnitude and phase \[px\].
    pub heights: [f64; 2],
}

/// One of them.
pub(super) struct ResponseCurve {
    /// Text of the legend.
    pub words: String,
    /// Its line: dashed where it lies over another.
    pub style: Style,
    /// Its magnitude at each frequency.
    pub sizes: Vec<f64>,
    /// Its phase at each frequency \[rad\]; empty where only magnitudes are compared.
    pub phases: Vec<f64>,
}

/// A solid line under the measured one.
pub(super) fn computed_line() -> Style {
    stroke(ALARM, 3.5)
}

/// Dashes over the computed line, both of which are seen where the two coincide.
pub(super) fn measured_line() -> Style {
    stroke(MEASURED, 1.6) + DASHED
}

/// The panels, one below the other; `None` where there are none.
pub(super) fn stacked(panels: &[ResponsePanel]) -> Option<String> {
    let mut sheet = Sheet::new(WIDTH, 0.0);
    for (k, panel) in panels.iter().enumerate() {
        panel.draw(&mut sheet, if k + 1 == panels.len() { "frequency [Hz]" } else { "" });
    }
    sheet.height += NAME;
    (!panels.is_empty()).then(|| sheet.finish())
}

impl ResponsePanel {
    /// Draws it below what is on the sheet.
    fn draw(&self, sheet: &mut Sheet, below: &str) {
        let hz = &self.frequencies_hz;
        let band = || hz.first().copied().unwrap_or(0.0)..hz.last().copied().unwrap_or(1.0);
        let keys = self.curves.iter().map(|curve| (Key::Line(curve.style.clone()), curve.words.clone()));
        let top = sheet.keys([112.0, sheet.height + 8.0], keys) + 8.0;
        let has_phases = self.curves.iter().any(|curve| !curve.phases.is_empty());
        let name = if has_phases { "" } else { below };
        let area = wide(top, top + self.heights[0]);
        let mut chart = Chart::new(area, Axis::new(name, band()), self.magnitude_axis());
        self.mark(&mut chart, true);
        for curve in &self.curves {
            chart.line(
                hz.iter().zip(&curve.sizes).map(|(hz, v)| [*hz, v.max(f64::MIN_POSITIVE)]),
                &curve.style,
            );
        }
        chart.draw(sheet);
        sheet.height = top + self.heights[0] + LABELS;
        if !has_phases {
            return;
        }
        let degrees = [-HALF, -0.5 * HALF, 0.0, 0.5 * HALF, HALF].map(|v| (v, given(v)));
        let up = Axis::new("phase [°]", -HALF - MARGIN..HALF + MARGIN).at(degrees);
        let area = wide(sheet.height, sheet.height + self.heights[1]);
        let mut chart = Chart::new(area, Axis::new(below, band()), up);
        self.mark(&mut chart, false);
        for curve in &self.curves {
            let points = hz.iter().zip(&curve.phases).map(|(hz, phase)| [*hz, phase.to_degrees()]);
            unbroken(points).into_iter().for_each(|piece| chart.line(piece, &curve.style));
        }
        chart.draw(sheet);
        sheet.height += self.heights[1] + LABELS;
    }

    fn magnitude_axis(&self) -> Axis {
        let sizes = self.curves.iter().flat_map(|curve| curve.sizes.iter().copied());
        let [least, largest] = ends(sizes.filter(|v| *v > 0.0));
        let largest = if largest > 0.0 { largest } else { f64::MIN_POSITIVE };
        let top = largest.log10() + 0.3;
        let low = (least.min(largest).log10() - 0.3).max(top - DECADES);
        Axis::log(format!("{} [{}]", self.quantity.word(), self.quantity.unit()), low..top, 1.0)
    }

    /// Dotted lines at the natural frequencies, blue ones at the measured, which are named on the first chart.
    fn mark(&self, chart: &mut Chart, named: bool) {
        for hz in &self.natural_hz {
            chart.rule(0, *hz, &(sheer(stroke(MUTED, 1.0), 0.6) + DOTTED));
        }
        let [low, high] = ends(self.frequencies_hz.iter().copied());
        for hz in self.measured_hz.iter().filter(|hz| (low..high).contains(hz)) {
            let style = sheer(stroke(MEASURED, 1.0), 0.7);
            match named {
                true => chart.flag(*hz, &given(*hz), &style, ink(11.5, MEASURED)),
                false => chart.rule(0, *hz, &style),
            }
        }
    }
}

/// Phases from −180° to 180° as lines that end at ±180° where the next one lies beyond, and continue at ∓180°.
fn unbroken(points: impl Iterator<Item = [f64; 2]>) -> Vec<Vec<[f64; 2]>> {
    let mut pieces: Vec<Vec<[f64; 2]>> = vec![Vec::new()];
    let mut last: Option<[f64; 2]> = None;
    for [hz, phase] in points {
        if let Some([from_hz, from]) = last.filter(|[_, from]| (phase - from).abs() > HALF) {
            let edge = HALF.copysign(from);
            let beyond = phase + 2.0 * edge;
            let cross = from_hz + (hz - from_hz) * (edge - from) / (beyond - from);
            pieces.last_mut().expect("one at least").push([cross, edge]);
            pieces.push(vec![[cross, -edge]]);
        }
        pieces.last_mut().expect("one at least").push([hz, phase]);
        last = Some([hz, phase]);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phase_goes_on_at_the_other_side() {
        let pieces = unbroken([[1.0, 90.0], [2.0, 150.0], [3.0, -150.0], [4.0, 170.0]].into_iter());
        assert_eq!(
            pieces,
            [
                vec![[1.0, 90.0], [2.0, 150.0], [2.5, 180.0]],
                vec![[2.5, -180.0], [3.0, -150.0], [3.75, -180.0]],
                vec![[3.75, 180.0], [4.0, 170.0]]
            ]
        );
        assert_eq!(unbroken([[1.0, -90.0], [2.0, 90.0]].into_iter()).len(), 1);
    }
}
