//! `sweep_<name>.svg` and `root_locus_<name>.svg`: the branches over the parameter and in the complex plane.

use super::axis::{axis_name, place, round, scale, value_at};
use crate::linalg::c64;
use crate::report::chart::{Area, above, bold, colour, sheet, text, widened};
use crate::report::colours::{ALARM, CALM, INK, MEASURED, MUTED};
use crate::report::format::{given, hertz, significant};
use crate::report::readout::{axes_of, linear};
use crate::report::section::Picture;
use crate::results::{SweepResult, file_name};
use crate::stability::unstable;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::error::Error;
use std::f64::consts::TAU;
use std::ops::Range;

type Drawing = Result<(), Box<dyn Error>>;
type Plot<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Stable modes farther below zero than this many times the largest growth are off the picture.
const DEEPEST: f64 = 1.5;
/// Critical values with a label.
const LABELS: usize = 8;

/// `name` is the part of the file names that is the sweep's.
pub(super) fn pictures(result: &SweepResult) -> Vec<Picture> {
    let parameter = axis_name(&result.parameter, &result.unit);
    let branches = sheet((980, 820), |area| draw_branches(area, result)).map(|svg| Picture {
        file: file_name("sweep", &result.name),
        caption: format!(
            "Frequency and growth rate of every mode over {parameter}: orange where it grows. Dots: critical values. Dashed: the case itself."
        ),
        svg,
    });
    let locus = sheet((980, 560), |area| draw_locus(area, result)).map(|svg| Picture {
        file: file_name("root_locus", &result.name),
        caption: format!(
            "Eigenvalues in the complex plane as {parameter} goes from {} (circles) to {} (dots); to the right of the line a mode grows.",
            given(result.axis.from),
            given(result.axis.to)
        ),
        svg,
    });
    let any = !result.sweep.branches.is_empty();
    [branches, locus].into_iter().flatten().filter(|_| any).collect()
}

/// A branch as points (place on the axis, λ), its critical points among them, and which stretches grow.
fn trace(result: &SweepResult, b: usize) -> Vec<(f64, c64, bool)> {
    let sweep = &result.sweep;
    let branch = &sweep.branches[b];
    let mut points: Vec<(f64, c64, bool)> = Vec::new();
    let own = sweep.critical.iter().filter(|c| c.branch == b);
    let own: Vec<(f64, c64)> = own.map(|c| (c.value, c64::new(0.0, c.eigenvalue.im))).collect();
    for (k, z) in branch.eigenvalues.iter().enumerate() {
        let value = sweep.values[branch.first + k];
        if k > 0 {
            let before = sweep.values[branch.first + k - 1];
            let (low, high) = (before.min(value), before.max(value));
            let between = own.iter().filter(|(v, _)| *v > low && *v < high);
            points.extend(between.map(|(v, z)| (place(&result.axis, *v), *z, true)));
        }
        points.push((place(&result.axis, value), *z, unstable(*z)));
    }
    points
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

fn draw_branches(area: &Area, result: &SweepResult) -> Drawing {
    let (upper, lower) = area.split_vertically(400);
    let axis = &result.axis;
    let ends = [place(axis, axis.from), place(axis, axis.to)];
    let across = widened(ends[0].min(ends[1]), ends[0].max(ends[1]), 0.02);
    let frequency = |z: c64| z.im / TAU;
    let growth = |z: c64| z.re;
    let mut top = plot(&upper, across.clone(), frequency_range(result))?;
    label_axes(&mut top, result, "", "frequency [Hz]")?;
    draw_lines(&mut top, result, frequency)?;
    let below = axis_name(&result.parameter, &result.unit);
    axes_of(&upper, &top, [scale(axis, ""), linear("frequency [Hz]")])?;
    let up = growth_range(result);
    let mut bottom = plot(&lower, across.clone(), up.clone())?;
    label_axes(&mut bottom, result, &below, "growth rate σ [1/s]")?;
    axes_of(&lower, &bottom, [scale(axis, &below), linear("growth rate σ [1/s]")])?;
    let zero = [(across.start, 0.0), (across.end, 0.0)];
    bottom.draw_series([PathElement::new(zero, colour(INK).stroke_width(2))])?;
    draw_lines(&mut bottom, result, growth)?;
    let own = place(axis, result.nominal);
    if across.contains(&own) {
        for chart in [&mut top, &mut bottom] {
            let range = chart.y_range();
            let dash = [(own, range.start), (own, range.end)];
            chart.draw_series(DashedLineSeries::new(dash, 6, 5, colour(MEASURED).stroke_width(1)))?;
        }
    }
    let mut taken: Vec<(i32, i32)> = Vec::new();
    for (k, c) in result.sweep.critical.iter().enumerate() {
        let x = place(axis, c.value);
        top.draw_series([Circle::new((x, frequency(c.eigenvalue)), 5, colour(ALARM).filled())])?;
        bottom.draw_series([Circle::new((x, 0.0), 5, colour(ALARM).filled())])?;
        if k >= LABELS {
            continue;
        }
        let (px, mut py) = bottom.backend_coord(&(x, 0.0));
        let Range { start: left, end: right } = bottom.plotting_area().get_x_axis_pixel_range();
        let px = px.clamp(left + 70, right - 70);
        py -= 10;
        while taken.iter().any(|(u, v)| (u - px).abs() < 130 && (v - py).abs() < 18) {
            py -= 18;
        }
        taken.push((px, py));
        let words = format!("{} · {} Hz", significant(c.value, 4), hertz(frequency(c.eigenvalue), 0));
        let (base_x, base_y) = lower.get_base_pixel();
        lower.draw_text(&words, &above(bold(12.0, INK)), (px - base_x, py - base_y))?;
    }
    Ok(())
}

fn draw_locus(area: &Area, result: &SweepResult) -> Drawing {
    let across = growth_range(result);
    let up = frequency_range(result);
    let mut chart = plot(area, across.clone(), up.clone())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(colour("#e6e9ed"))
        .axis_style(colour(MUTED))
        .label_style(text(13.0, INK))
        .axis_desc_style(text(14.0, INK))
        .x_desc("growth rate σ [1/s]")
        .y_desc("frequency [Hz]")
        .x_label_formatter(&|v| given(*v))
        .y_label_formatter(&|v| given(*v))
        .draw()?;
    axes_of(area, &chart, ["growth rate σ [1/s]", "frequency [Hz]"].map(linear))?;
    chart.draw_series([PathElement::new([(0.0, up.start), (0.0, up.end)], colour(INK).stroke_width(2))])?;
    let inside = |z: &c64| across.contains(&z.re);
    for b in 0..result.sweep.branches.len() {
        let points = trace(result, b);
        for pair in points.windows(2).filter(|p| inside(&p[0].1) && inside(&p[1].1)) {
            let grows = pair[0].2 && pair[1].2;
            let style = if grows { colour(ALARM).stroke_width(3) } else { colour(CALM).stroke_width(2) };
            let ends = [0, 1].map(|k: usize| (pair[k].1.re, pair[k].1.im / TAU));
            chart.draw_series([PathElement::new(ends, style)])?;
        }
        let (Some(first), Some(last)) = (points.first(), points.last()) else { continue };
        let hue = |grows: bool| colour(if grows { ALARM } else { CALM });
        if inside(&first.1) {
            let at = (first.1.re, first.1.im / TAU);
            chart.draw_series([Circle::new(at, 4, hue(first.2).stroke_width(1))])?;
        }
        if inside(&last.1) {
            let at = (last.1.re, last.1.im / TAU);
            chart.draw_series([Circle::new(at, 4, hue(last.2).filled())])?;
        }
    }
    Ok(())
}

fn plot<'a, 'b>(area: &Area<'b>, across: Range<f64>, up: Range<f64>) -> Result<Plot<'a, 'b>, Box<dyn Error>> {
    let mut builder = ChartBuilder::on(area);
    builder.margin(16).x_label_area_size(46).y_label_area_size(78);
    Ok(builder.build_cartesian_2d(across, up)?)
}

fn label_axes(chart: &mut Plot, result: &SweepResult, x: &str, y: &str) -> Drawing {
    let axis = result.axis;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(colour("#e6e9ed"))
        .axis_style(colour(MUTED))
        .label_style(text(13.0, INK))
        .axis_desc_style(text(14.0, INK))
        .x_desc(x)
        .y_desc(y)
        .x_labels(10)
        .x_label_formatter(&|v| given(if axis.log { round(value_at(&axis, *v)) } else { *v }))
        .y_label_formatter(&|v| given(*v))
        .draw()?;
    Ok(())
}

/// Every branch: calm lines first, those that grow on top.
fn draw_lines(chart: &mut Plot, result: &SweepResult, height: impl Fn(c64) -> f64) -> Drawing {
    let range = chart.y_range();
    for growing in [false, true] {
        for b in 0..result.sweep.branches.len() {
            for pair in trace(result, b).windows(2) {
                let ends = [0, 1].map(|k: usize| (pair[k].0, height(pair[k].1)));
                let shown = ends.iter().all(|(_, y)| *y >= range.start && *y <= range.end);
                if shown && (pair[0].2 && pair[1].2) == growing {
                    let style =
                        if growing { colour(ALARM).stroke_width(3) } else { colour(CALM).stroke_width(1) };
                    chart.draw_series([PathElement::new(ends, style)])?;
                }
            }
        }
    }
    Ok(())
}
