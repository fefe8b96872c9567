//! `sweep_<name>.svg` and `root_locus_<name>.svg`: the branches over the parameter and in the complex plane.

use super::axis::{axis_name, label, place, places, scale};
use super::branches::{draw_lines, draw_nominal};
use super::places::{MOST, SweepPlace};
use crate::linalg::c64;
use crate::report::axes::clean;
use crate::report::chart::{Area, bold, colour, sheet, text, widened};
use crate::report::colours::{ALARM, ALARM_TEXT, CALM, INK, MUTED};
use crate::report::curve::{Dash, LinearChart, Pen, draw_curve, draw_dot, draw_ring, pen};
use crate::report::format::{given, hertz, rounded};
use crate::report::labels::{LABEL_HEIGHT, local};
use crate::report::readout::{axes_of, linear};
use crate::report::section::Picture;
use crate::results::{SweepResult, file_name};
use crate::stability::unstable;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;
use std::f64::consts::TAU;
use std::ops::Range;

type Drawing = Result<(), Box<dyn Error>>;

/// Stable modes farther below zero than this many times the largest growth are off the picture.
const DEEPEST: f64 = 1.5;
/// Values with a label above the charts.
const LABELS: usize = 10;
/// Width of such a label \[px\].
const LABEL_WIDTH: i32 = 140;
/// Heights of the two charts, the lower one with the words under its axis.
const HEIGHTS: [u32; 2] = [380, 400];
/// Where the axis across begins and how far from the right edge it ends \[px\].
const ENDS: [i32; 2] = [94, 16];
const WIDTH: u32 = 980;

/// Every branch over the parameter; the windows of the first of `found` are outlined.
pub(super) fn picture(result: &SweepResult, found: &[SweepPlace]) -> Option<Picture> {
    if result.sweep.branches.is_empty() {
        return None;
    }
    let parameter = axis_name(&result.label, &result.unit);
    let (height, labels) = strip(result, found);
    let size = (WIDTH, height + HEIGHTS[0] + HEIGHTS[1]);
    let svg = sheet(size, |area| draw_branches(area, result, found, (height, &labels)))?;
    let windows = if found.is_empty() { "" } else { " Numbers and frames: the places of the next figure." };
    let caption = format!(
        "Frequency and growth rate of every mode over {parameter}: orange where it grows. Dots: critical values. Dashed: the case \
         itself.{windows}"
    );
    Some(Picture { file: file_name("sweep", &result.name), caption, svg })
}

/// The eigenvalues in the complex plane.
pub(super) fn locus(result: &SweepResult) -> Option<Picture> {
    if result.sweep.branches.is_empty() {
        return None;
    }
    let svg = sheet((WIDTH, 560), |area| draw_locus(area, result))?;
    let caption = format!(
        "Eigenvalues in the complex plane as {} goes from {} (circles) to {} (dots); to the right of the line a mode grows.",
        axis_name(&result.label, &result.unit),
        given(result.axis.from),
        given(result.axis.to)
    );
    Some(Picture { file: file_name("root_locus", &result.name), caption, svg })
}

fn growth_range(result: &SweepResult) -> Range<f64> {
    let rates = || result.sweep.branches.iter().flat_map(|b| &b.eigenvalues).map(|z| z.re);
    let highest = rates().fold(0.0, f64::max);
    let lowest = rates().fold(0.0, f64::min);
    let size = rates().map(f64::abs).fold(0.0, f64::max);
    let floor = if highest > 1e-9 * size { lowest.max(-DEEPEST * highest) } else { lowest };
    let range = widened(floor, highest, 0.08);
    if range.end - range.start < 1e-12 { -1.0..1.0 } else { range }
}

fn frequency_range(result: &SweepResult) -> Range<f64> {
    let all = || result.sweep.branches.iter().flat_map(|b| &b.eigenvalues).map(|z| z.im / TAU);
    widened(all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max), 0.04)
}

/// A label above the charts.
struct StripLabel {
    words: String,
    /// Value of the parameter, and ω/2π of the mode there \[Hz\].
    at: (f64, f64),
    /// Its right and lower edges \[px\].
    pixel: (i32, i32),
    /// Where the line to the value leaves it \[px\].
    leader: i32,
    critical: bool,
}

/// Labels of the numbered places and of further critical values in a strip of this height, where no curve is. Each ends at the line
/// to its value, and those farther right stand higher: no line crosses a label.
fn strip(result: &SweepResult, found: &[SweepPlace]) -> (u32, Vec<StripLabel>) {
    let words = |value: f64, hz: f64| format!("{} · {} Hz", given(rounded(value, 4)), hertz(hz, 0));
    let shown = &found[..found.len().min(MOST)];
    let numbered = shown.iter().enumerate().map(|(k, p)| {
        (format!("{}: {}", k + 1, words(p.value, p.frequency_hz)), (p.value, p.frequency_hz), p.critical)
    });
    let others = result.sweep.critical.iter().filter(|c| shown.iter().all(|p| p.value != c.value));
    let others = others.map(|c| {
        let hz = c.eigenvalue.im / TAU;
        (words(c.value, hz), (c.value, hz), true)
    });
    let across = places(&result.axis);
    let (left, right) = (ENDS[0], WIDTH as i32 - ENDS[1]);
    let label = |(words, at, critical): (String, (f64, f64), bool)| {
        let part = (place(&result.axis, at.0) - across.start) / (across.end - across.start);
        let leader = left + (part * f64::from(right - left)) as i32;
        StripLabel { words, at, pixel: (leader.max(LABEL_WIDTH), 0), leader, critical }
    };
    let mut labels: Vec<StripLabel> = numbered.chain(others).take(LABELS).map(label).collect();
    labels.sort_by_key(|label| label.leader);
    let mut lowest = i32::MAX;
    let mut before: Option<i32> = None;
    for label in &mut labels {
        // Beside the one before where that ends, else above it.
        let free = before.is_none_or(|end| label.pixel.0 - LABEL_WIDTH >= end);
        let y = if free { 0 } else { lowest - LABEL_HEIGHT };
        label.pixel.1 = y;
        lowest = y;
        before = Some(label.pixel.0);
    }
    let highest = labels.iter().map(|label| label.pixel.1).min().unwrap_or(LABEL_HEIGHT) - LABEL_HEIGHT;
    let height = -highest + if labels.is_empty() { 0 } else { 10 };
    labels.iter_mut().for_each(|label| label.pixel.1 += height);
    (height.unsigned_abs(), labels)
}

fn draw_branches(
    area: &Area,
    result: &SweepResult,
    found: &[SweepPlace],
    (strip, labels): (u32, &[StripLabel]),
) -> Drawing {
    let (_, main) = area.split_vertically(strip);
    let (upper, lower) = main.split_vertically(HEIGHTS[0]);
    let axis = &result.axis;
    let across = places(axis);
    let below = axis_name(&result.label, &result.unit);
    let top = plot(&upper, (across.clone(), frequency_range(result)), axis, ["", "frequency [Hz]"])?;
    axes_of(&upper, &top, [scale(axis, ""), linear("frequency [Hz]")])?;
    let words = [below.as_str(), "growth rate σ [1/s]"];
    let bottom = plot(&lower, (across.clone(), growth_range(result)), axis, words)?;
    axes_of(&lower, &bottom, [scale(axis, &below), linear("growth rate σ [1/s]")])?;
    draw_curve(&bottom, [(across.start, 0.0), (across.end, 0.0)], pen(INK, 2.0))?;
    draw_lines(&top, result, |x, z| (x, z.im / TAU), (|_| true, [pen(CALM, 1.0), pen(ALARM, 3.0)]))?;
    draw_lines(&bottom, result, |x, z| (x, z.re), (|_| true, [pen(CALM, 1.0), pen(ALARM, 3.0)]))?;
    draw_nominal(&top, result)?;
    draw_nominal(&bottom, result)?;
    for c in &result.sweep.critical {
        let x = place(axis, c.value);
        draw_dot(&top, (x, c.eigenvalue.im / TAU), 4.5, ALARM)?;
        draw_dot(&bottom, (x, 0.0), 4.5, ALARM)?;
    }
    for p in found.iter().take(MOST) {
        let [a, b] = [p.across.start, p.across.end];
        let [c, d] = [p.frequencies.start, p.frequencies.end];
        draw_curve(&top, [(a, c), (b, c), (b, d), (a, d), (a, c)], Pen { opacity: 0.6, ..pen(INK, 1.0) })?;
    }
    for label in labels {
        let hex = if label.critical { ALARM } else { MUTED };
        let (x, y) = label.pixel;
        let at = (place(axis, label.at.0), label.at.1);
        let leader = Pen { opacity: 0.55, dash: Dash::Dotted, ..pen(hex, 1.0) };
        let (px, _) = top.backend_coord(&at);
        let ends = [local(area, px, y - LABEL_HEIGHT), local(area, px, strip as i32 + 16)];
        area.draw(&PathElement::new(ends, colour(hex).mix(leader.opacity).stroke_width(1)))?;
        draw_curve(&top, [(at.0, at.1), (at.0, top.y_range().end)], leader)?;
        let ink = if label.critical { ALARM_TEXT } else { MUTED };
        let beside = Pos::new(HPos::Right, VPos::Bottom);
        area.draw_text(&label.words, &bold(12.5, ink).pos(beside), local(area, x - 4, y))?;
    }
    Ok(())
}

fn draw_locus(area: &Area, result: &SweepResult) -> Drawing {
    let (across, up) = (growth_range(result), frequency_range(result));
    let mut chart = ChartBuilder::on(area)
        .margin(16)
        .x_label_area_size(46)
        .y_label_area_size(78)
        .build_cartesian_2d(across.clone(), up.clone())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(colour("#e6e9ed"))
        .axis_style(colour(MUTED))
        .label_style(text(13.0, INK))
        .axis_desc_style(text(14.0, INK))
        .x_desc("growth rate σ [1/s]")
        .y_desc("frequency [Hz]")
        .x_label_formatter(&|v| given(clean(*v, &across)))
        .y_label_formatter(&|v| given(*v))
        .draw()?;
    axes_of(area, &chart, ["growth rate σ [1/s]", "frequency [Hz]"].map(linear))?;
    draw_curve(&chart, [(0.0, up.start), (0.0, up.end)], pen(INK, 2.0))?;
    draw_lines(&chart, result, |_, z| (z.re, z.im / TAU), (|_| true, [pen(CALM, 2.0), pen(ALARM, 3.0)]))?;
    for branch in &result.sweep.branches {
        let (Some(first), Some(last)) = (branch.eigenvalues.first(), branch.eigenvalues.last()) else {
            continue;
        };
        let hue = |z: &c64| if unstable(*z) { ALARM } else { CALM };
        draw_ring(&chart, (first.re, first.im / TAU), 4.0, (hue(first), 1.0))?;
        draw_dot(&chart, (last.re, last.im / TAU), 4.0, hue(last))?;
    }
    Ok(())
}

/// Axes over the parameter, with words below and beside.
fn plot<'a, 'b>(
    area: &Area<'b>,
    (across, up): (Range<f64>, Range<f64>),
    axis: &crate::sweep::Axis,
    [below, beside]: [&str; 2],
) -> Result<LinearChart<'a, 'b>, Box<dyn Error>> {
    let high = up.clone();
    let mut chart = ChartBuilder::on(area)
        .margin(ENDS[1])
        .x_label_area_size(46)
        .y_label_area_size(ENDS[0] - ENDS[1])
        .build_cartesian_2d(across, up)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(colour("#e6e9ed"))
        .axis_style(colour(MUTED))
        .label_style(text(13.0, INK))
        .axis_desc_style(text(14.0, INK))
        .x_desc(below)
        .y_desc(beside)
        .x_labels(10)
        .x_label_formatter(&|v| label(axis, *v))
        .y_label_formatter(&|v| given(clean(*v, &high)))
        .draw()?;
    Ok(chart)
}

#[cfg(test)]
mod tests {
    use super::super::places::places_of;
    use super::*;
    use crate::results::sample;

    #[test]
    fn labels_stand_above_the_curves_and_apart() {
        let results = sample::rig();
        let mut result = results.all::<SweepResult>()[0].clone();
        let one = result.sweep.critical[0];
        result.sweep.critical =
            (0..14).map(|k| crate::sweep::Critical { value: 0.3 + 2e-3 * f64::from(k), ..one }).collect();
        let found = places_of(&result);
        let (height, labels) = strip(&result, &found);
        assert_eq!(labels.len(), LABELS);
        for (k, a) in labels.iter().enumerate() {
            assert!(a.pixel.1 <= height as i32 && a.pixel.1 >= LABEL_HEIGHT, "{:?} of {height}", a.pixel);
            for b in &labels[k + 1..] {
                let (dx, dy) = ((a.pixel.0 - b.pixel.0).abs(), (a.pixel.1 - b.pixel.1).abs());
                assert!(dx >= LABEL_WIDTH || dy >= LABEL_HEIGHT, "{} {}", a.words, b.words);
                let (high, low) = if a.pixel.1 < b.pixel.1 { (a, b) } else { (b, a) };
                let under = low.pixel.0 - LABEL_WIDTH..low.pixel.0;
                assert!(!under.contains(&high.leader), "a line crosses {}", low.words);
            }
        }
        let svg = picture(&result, &found).unwrap().svg;
        assert!(svg.contains("friction coefficient μ₀ of rim [–]") && !svg.contains("mu0"));
        assert!(!svg.contains("NaN"));
    }
}
