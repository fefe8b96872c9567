//! `map_<name>.svg`: the largest growth rate over two parameters, with the boundary of stability.

use super::axis::{axis_name, place, round, scale, value_at};
use crate::report::chart::{Area, colour, sheet, text};
use crate::report::colours::{INK, MUTED, diverging};
use crate::report::format::{given, signed};
use crate::report::readout::axes_of;
use crate::report::section::Picture;
use crate::results::{MapResult, file_name};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;

/// At most this many cells along an axis; a finer grid is thinned out in the picture.
const CELLS: usize = 160;

pub(super) fn picture(result: &MapResult) -> Option<Picture> {
    if result.points.is_empty() {
        return None;
    }
    let svg = sheet((980, 620), |area| draw(area, result))?;
    let caption = format!(
        "Largest growth rate of any mode over {} and {}: red where a mode grows, blue where all decay, grey where there is no answer; the colour goes with the root of the growth rate. Line: the boundary of stability. Ring: the case itself.",
        result.parameters[0], result.parameters[1]
    );
    Some(Picture { file: file_name("map", &result.name), caption, svg })
}

/// Edges of the cells about the values, and the index of the value of each cell.
fn cells(result: &MapResult, d: usize) -> Vec<(f64, f64, usize)> {
    let axis = &result.axes[d];
    let step = axis.points.div_ceil(CELLS);
    let chosen: Vec<usize> = (0..axis.points).step_by(step).collect();
    let at: Vec<f64> = chosen.iter().map(|k| place(axis, axis.value(*k))).collect();
    let n = at.len();
    let edge = |k: usize| match k {
        0 => at[0] - 0.5 * (at[1] - at[0]),
        k if k == n => at[n - 1] + 0.5 * (at[n - 1] - at[n - 2]),
        k => 0.5 * (at[k - 1] + at[k]),
    };
    (0..n).map(|k| (edge(k), edge(k + 1), chosen[k])).collect()
}

fn draw(area: &Area, result: &MapResult) -> Result<(), Box<dyn Error>> {
    let (main, bar) = area.split_horizontally(860);
    let (across, up) = (cells(result, 0), cells(result, 1));
    let span = |cells: &[(f64, f64, usize)]| {
        let (a, b) = (cells[0].0, cells[cells.len() - 1].1);
        a.min(b)..a.max(b)
    };
    let finite = || result.points.iter().map(|p| p.growth_rate).filter(|s| s.is_finite());
    let size = finite().map(f64::abs).fold(f64::MIN_POSITIVE, f64::max);
    // The root of the growth rate shows both a weak and a strong squeal.
    let shade = |rate: f64| {
        if rate.is_finite() {
            colour(&diverging(rate.signum() * (rate.abs() / size).sqrt()))
        } else {
            colour("#c3c8ce")
        }
    };
    let mut chart = ChartBuilder::on(&main)
        .margin(16)
        .x_label_area_size(52)
        .y_label_area_size(84)
        .build_cartesian_2d(span(&across), span(&up))?;
    let names = [0, 1].map(|d| axis_name(&result.parameters[d], &result.units[d]));
    axes_of(&main, &chart, [0, 1].map(|d| scale(&result.axes[d], &names[d])))?;
    let n = result.axes[0].points;
    for (low, high, j) in &up {
        for (left, right, i) in &across {
            let rate = result.points.get(i + n * j).map_or(f64::NAN, |p| p.growth_rate);
            chart.draw_series([Rectangle::new([(*left, *low), (*right, *high)], shade(rate).filled())])?;
        }
    }
    let axes = result.axes;
    let label = |d: usize, v: f64| given(if axes[d].log { round(value_at(&axes[d], v)) } else { v });
    chart
        .configure_mesh()
        .disable_mesh()
        .axis_style(colour(MUTED))
        .label_style(text(13.0, INK))
        .axis_desc_style(text(14.0, INK))
        .x_desc(&names[0])
        .y_desc(&names[1])
        .x_label_formatter(&|v| label(0, *v))
        .y_label_formatter(&|v| label(1, *v))
        .draw()?;
    let spot = |p: [f64; 2]| (place(&axes[0], p[0]), place(&axes[1], p[1]));
    for line in &result.boundary.lines {
        let path: Vec<(f64, f64)> = line.iter().map(|k| spot(result.boundary.points[*k])).collect();
        chart.draw_series([PathElement::new(path, colour(INK).stroke_width(3))])?;
    }
    let own = spot(result.nominal);
    if span(&across).contains(&own.0) && span(&up).contains(&own.1) {
        chart.draw_series([Circle::new(own, 7, WHITE.filled())])?;
        chart.draw_series([Circle::new(own, 7, colour(INK).stroke_width(3))])?;
    }
    let (top, height, steps) = (40, 500, 50);
    for k in 0..steps {
        let t = 1.0 - 2.0 * k as f64 / (steps - 1) as f64;
        let y = top + height * k / steps;
        let corner = [(10, y), (32, top + height * (k + 1) / steps)];
        bar.draw(&Rectangle::new(corner, colour(&diverging(t)).filled()))?;
    }
    let left = text(12.5, INK).pos(Pos::new(HPos::Left, VPos::Center));
    for t in [1.0f64, 0.5, 0.0, -0.5, -1.0] {
        let y = top + (0.5 * (1.0 - t) * height as f64) as i32;
        bar.draw_text(&signed(t.signum() * t * t * size, if size < 10.0 { 2 } else { 0 }), &left, (38, y))?;
    }
    bar.draw_text("σ [1/s]", &left, (10, 18))?;
    Ok(())
}
