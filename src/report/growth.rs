//! `growth.svg`: growth rate over frequency, unstable modes marked, measured squeal as bands.

use super::axes::Chart;
use super::chart::{Area, above, bold, colour, sheet, text, widened};
use super::colours::{ALARM, CALM, INK, MEASURED, MUTED};
use super::curve::{Pen, draw_curve, draw_dot, draw_ring, pen};
use super::format::{fixed, given, hertz, signed};
use super::html::described;
use super::labels::{LABEL_HEIGHT, Labels, label_unstable, local};
use super::readout::{axes_of, linear, title_at};
use super::section::Picture;
use super::squeal::SQUEAL_TOLERANCE;
use crate::results::{ComplexResult, RunResults};
use crate::stability::ComplexMode;
use plotters::prelude::*;
use std::error::Error;

const SIZE: (u32, u32) = (980, 520);
/// Stable modes farther below zero than this many times the largest growth are drawn at the lower edge.
const DEEPEST: f64 = 2.0;
/// Unstable modes with a label; the others have their mark only.
const LABELS: usize = 10;

/// The picture, when the run has complex modes.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let complex = results.get::<ComplexResult>().filter(|c| !c.modes.modes.is_empty())?;
    let svg = sheet(SIZE, |area| draw(area, complex))?;
    let squeal = match complex.measured_squeal_hz.is_empty() {
        true => String::new(),
        false => {
            format!(" Bands: measured squeal ± {} %.", fixed(100.0 * SQUEAL_TOLERANCE, 0))
        }
    };
    let caption = format!(
        "Growth rate of the complex modes: above zero a mode grows (orange), below it dies away (grey; a triangle where it lies below the axis).{squeal}"
    );
    Some(Picture { file: "growth".into(), caption, svg: described(&svg, &seen(complex)) })
}

/// How many modes grow, and which grows most.
fn seen(complex: &ComplexResult) -> String {
    let modes = &complex.modes.modes;
    let unstable = modes.iter().filter(|m| m.unstable());
    let strongest = unstable.clone().max_by(|a, b| a.growth_rate().total_cmp(&b.growth_rate()));
    let largest = strongest.map_or(String::new(), |mode| {
        let (rate, hz) = (signed(mode.growth_rate(), 1), hertz(mode.frequency_hz(), 0));
        format!("; the largest growth rate is {rate} 1/s at {hz} Hz")
    });
    format!(
        "Growth rate over frequency: {} of {} modes are unstable{largest}.",
        unstable.count(),
        modes.len()
    )
}

/// Range of the axis of the growth rate.
fn growth_range(complex: &ComplexResult) -> std::ops::Range<f64> {
    let rates = || complex.modes.modes.iter().map(|m| m.growth_rate()).filter(|s| s.is_finite());
    let highest = rates().fold(0.0, f64::max);
    let lowest = rates().fold(0.0, f64::min);
    let floor = if highest > 0.0 { lowest.max(-DEEPEST * highest) } else { lowest };
    let length = (highest - floor).max(f64::MIN_POSITIVE);
    // Space above for the labels of modes and bands.
    let range = widened(floor, highest + 0.3 * length, 0.06);
    if range.end - range.start < 1e-9 { -1.0..1.0 } else { range }
}

fn draw(area: &Area, complex: &ComplexResult) -> Result<(), Box<dyn Error>> {
    let modes = &complex.modes.modes;
    let frequencies =
        modes.iter().map(|m| m.frequency_hz()).chain(complex.measured_squeal_hz.iter().map(|s| s.0));
    let (low, high) = frequencies
        .filter(|hz| hz.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), hz| (low.min(hz), high.max(hz)));
    let across = widened(low, high, 0.05);
    let up = growth_range(complex);
    let mut chart = ChartBuilder::on(area)
        .margin(16)
        .x_label_area_size(52)
        .y_label_area_size(78)
        .build_cartesian_2d(across.clone(), up.clone())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(colour("#e6e9ed"))
        .axis_style(colour(MUTED))
        .label_style(text(13.0, INK))
        .axis_desc_style(text(14.0, INK))
        .x_desc("frequency [Hz]")
        .y_desc("growth rate σ [1/s]")
        .x_labels(10)
        .x_label_formatter(&|hz| given(*hz))
        .y_label_formatter(&|sigma| given(*sigma))
        .draw()?;
    axes_of(area, &chart, ["frequency [Hz]", "growth rate σ [1/s]"].map(linear))?;
    let mut labels = Labels::default();
    draw_squeal(area, &mut chart, complex, &mut labels)?;
    draw_curve(&chart, [(across.start, 0.0), (across.end, 0.0)], pen(INK, 2.0))?;
    draw_stable(&mut chart, modes)?;
    draw_unstable(area, &mut chart, modes, &mut labels)?;
    modes.iter().enumerate().try_for_each(|(k, mode)| {
        let (hz, rate) = (hertz(mode.frequency_hz(), 1), signed(mode.growth_rate(), 2));
        let place = chart.backend_coord(&(mode.frequency_hz(), mode.growth_rate().max(up.start)));
        title_at(area, place, &format!("mode {}: {hz} Hz, σ {rate} 1/s", k + 1))
    })
}

/// A band about each measured squeal frequency.
fn draw_squeal(
    area: &Area,
    chart: &mut Chart,
    complex: &ComplexResult,
    labels: &mut Labels,
) -> Result<(), Box<dyn Error>> {
    let up = chart.y_range();
    let band = colour(MEASURED);
    for (hz, _) in &complex.measured_squeal_hz {
        let (left, right) = (hz * (1.0 - SQUEAL_TOLERANCE), hz * (1.0 + SQUEAL_TOLERANCE));
        chart.draw_series([Rectangle::new([(left, up.start), (right, up.end)], band.mix(0.13).filled())])?;
        draw_curve(chart, [(*hz, up.start), (*hz, up.end)], Pen { opacity: 0.55, ..pen(MEASURED, 1.0) })?;
        let (x, y) = chart.backend_coord(&(*hz, up.end));
        let y = labels.place(x, y + 6 + LABEL_HEIGHT, 112, LABEL_HEIGHT);
        area.draw_text(
            &format!("squeal {} Hz", given(*hz)),
            &above(bold(12.5, MEASURED)),
            local(area, x, y),
        )?;
    }
    Ok(())
}

/// Modes that die away or are not accurate.
fn draw_stable(chart: &mut Chart, modes: &[ComplexMode]) -> Result<(), Box<dyn Error>> {
    let up = chart.y_range();
    for mode in modes.iter().filter(|m| !m.unstable()) {
        let place = (mode.frequency_hz(), mode.growth_rate());
        if !mode.accurate() {
            let place = (place.0, place.1.max(up.start));
            draw_ring(chart, place, 5.0, (MUTED, 1.0))?;
        } else if place.1 < up.start {
            chart.draw_series([TriangleMarker::new((place.0, up.start), -6, colour(CALM).filled())])?;
        } else {
            draw_dot(chart, place, 4.0, CALM)?;
        }
    }
    Ok(())
}

/// Modes that grow, the strongest with their frequency.
fn draw_unstable(
    area: &Area,
    chart: &mut Chart,
    modes: &[ComplexMode],
    labels: &mut Labels,
) -> Result<(), Box<dyn Error>> {
    let mut unstable: Vec<_> = modes.iter().filter(|m| m.unstable()).collect();
    unstable.sort_by(|a, b| b.growth_rate().total_cmp(&a.growth_rate()));
    for (k, mode) in unstable.iter().enumerate() {
        let place = (mode.frequency_hz(), mode.growth_rate());
        draw_curve(chart, [(place.0, 0.0), place], pen(ALARM, 2.0))?;
        draw_dot(chart, place, 6.0, ALARM)?;
        if k >= LABELS {
            continue;
        }
        let (x, mark) = chart.backend_coord(&place);
        // A label stays on the plot.
        let std::ops::Range { start: left, end: right } = chart.plotting_area().get_x_axis_pixel_range();
        let x = x.clamp(left + 32, right - 32);
        label_unstable(area, labels, (x, mark), &format!("{} Hz", hertz(mode.frequency_hz(), 0)))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::c64;
    use crate::results::sample;

    #[test]
    fn unstable_modes_are_labelled_and_a_deep_one_does_not_flatten_the_picture() {
        let results = sample::rig();
        let svg = picture(&results).unwrap().svg;
        for label in ["942 Hz", "1668 Hz", "2604 Hz", "squeal 936", "squeal 1661", "squeal 2600"] {
            assert!(svg.contains(label), "{label}");
        }
        // The strongest growth is 111.8 1/s; the mode at −642 1/s is off the axis.
        assert!(growth_range(results.get::<ComplexResult>().unwrap()).start > -260.0);
        assert!(!svg.contains("NaN"));
    }

    #[test]
    fn undamped_and_single_modes_draw_too() {
        let mut results = sample::rig();
        let complex = results.get_mut::<ComplexResult>().unwrap();
        complex.modes.modes.truncate(1);
        complex.modes.modes[0].eigenvalue = c64::new(0.0, 1000.0);
        complex.measured_squeal_hz.clear();
        assert!(picture(&results).unwrap().svg.contains("growth rate"));
        results.get_mut::<ComplexResult>().unwrap().modes.modes.clear();
        assert!(picture(&results).is_none());
    }
}
