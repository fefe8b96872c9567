//! Magnitude and phase over frequency, as frequency responses are drawn: magnitude on a logarithmic scale.

use super::axes::{Chart, Words, labelled};
use super::chart::Area;
use super::curve::{LinearChart, Pen, draw_curve};
use super::format::{fixed, given};
use crate::measured::Quantity;
use std::error::Error;
use std::ops::Range;

/// Decades below the highest magnitude that are shown.
const DECADES: f64 = 6.0;
/// Half a turn \[°\]: where the phase leaves the chart on one side it comes in on the other.
const HALF: f64 = 180.0;
const MARGIN: f64 = 5.0;

/// Axes for the sizes of a quantity over the frequencies.
pub(super) fn magnitude_axes<'a>(
    area: &Area<'a>,
    hz: &[f64],
    quantity: Quantity,
    sizes: impl Iterator<Item = f64>,
    below: Option<&str>,
) -> Result<Chart<'a>, Box<dyn Error>> {
    let sizes: Vec<f64> = sizes.filter(|v| *v > 0.0 && v.is_finite()).collect();
    let largest = sizes.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let top = largest.log10() + 0.3;
    let low = (sizes.iter().copied().fold(largest, f64::min).log10() - 0.3).max(top - DECADES);
    let beside = format!("{} [{}]", quantity.word(), quantity.unit());
    let value = |v: f64| format!("{:.0e}", 10f64.powf(v));
    let words =
        Words { below, beside: &beside, across: &given, up: &value, labels: 10, decades: 1.0, grid: true };
    labelled(area, (band(hz), low..top), &words)
}

/// Axes for the phase over the frequencies, which stand below.
pub(super) fn phase_axes<'a>(
    area: &Area<'a>,
    hz: &[f64],
    below: Option<&str>,
) -> Result<Chart<'a>, Box<dyn Error>> {
    let degrees = |v: f64| fixed(v, 0);
    let words = Words {
        below,
        beside: "phase [°]",
        across: &given,
        up: &degrees,
        labels: 10,
        decades: 0.0,
        grid: true,
    };
    labelled(area, (band(hz), -HALF - MARGIN..HALF + MARGIN), &words)
}

fn band(hz: &[f64]) -> Range<f64> {
    hz.first().copied().unwrap_or(0.0)..hz.last().copied().unwrap_or(1.0)
}

/// Draws sizes over frequencies on [`magnitude_axes`].
pub(super) fn draw_magnitude(
    chart: &LinearChart,
    points: impl Iterator<Item = (f64, f64)>,
    pen: Pen,
) -> Result<(), Box<dyn Error>> {
    draw_curve(chart, points.map(|(hz, v)| (hz, v.max(f64::MIN_POSITIVE).log10())), pen)
}

/// Draws phases \[rad\] over frequencies on [`phase_axes`].
pub(super) fn draw_phase(
    chart: &LinearChart,
    points: impl Iterator<Item = (f64, f64)>,
    pen: Pen,
) -> Result<(), Box<dyn Error>> {
    let pieces = unbroken(points.map(|(hz, phase)| (hz, phase.to_degrees())));
    pieces.into_iter().try_for_each(|piece| draw_curve(chart, piece, pen))
}

/// Phases from −180° to 180° as lines that end at ±180° where the next one lies beyond, and continue at ∓180°.
fn unbroken(points: impl Iterator<Item = (f64, f64)>) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = vec![Vec::new()];
    let mut last: Option<(f64, f64)> = None;
    for (hz, phase) in points {
        if let Some((from_hz, from)) = last.filter(|(_, from)| (phase - from).abs() > HALF) {
            let edge = HALF.copysign(from);
            let beyond = phase + 2.0 * edge;
            let cross = from_hz + (hz - from_hz) * (edge - from) / (beyond - from);
            pieces.last_mut().expect("one at least").push((cross, edge));
            pieces.push(vec![(cross, -edge)]);
        }
        pieces.last_mut().expect("one at least").push((hz, phase));
        last = Some((hz, phase));
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phase_goes_on_at_the_other_side() {
        let pieces = unbroken([(1.0, 90.0), (2.0, 150.0), (3.0, -150.0), (4.0, 170.0)].into_iter());
        assert_eq!(
            pieces,
            [
                vec![(1.0, 90.0), (2.0, 150.0), (2.5, 180.0)],
                vec![(2.5, -180.0), (3.0, -150.0), (3.75, -180.0)],
                vec![(3.75, 180.0), (4.0, 170.0)]
            ]
        );
        assert_eq!(unbroken([(1.0, -90.0), (2.0, 90.0)].into_iter()).len(), 1);
    }
}
