//! `sweep_<name>_places.svg`: frequency and growth rate about the critical values and where two frequencies merge or veer, each
//! in a window of its own.

use super::axis::{axis_name, label, place, scale};
use super::branches::{draw_lines, draw_nominal};
use super::places::{MOST, SweepPlace};
use crate::report::axes::clean;
use crate::report::chart::{Area, below, bold, colour, sheet, text};
use crate::report::colours::{ALARM, CALM, INK, MUTED};
use crate::report::curve::{LinearChart, Pen, draw_curve, draw_dot, pen};
use crate::report::format::{given, hertz, rounded};
use crate::report::html::described;
use crate::report::readout::{axes_of, linear};
use crate::report::section::Picture;
use crate::results::{SweepResult, file_name};
use plotters::prelude::*;
use std::error::Error;
use std::f64::consts::TAU;
use std::ops::Range;

/// Panels beside each other at most.
const COLUMNS: usize = 3;
/// Widths of a panel among three, and of one or two \[px\].
const WIDTHS: [u32; 2] = [330, 490];
/// Heights of the title, and of the charts of frequency and growth rate \[px\].
const TITLE: u32 = 44;
const CHARTS: [u32; 2] = [190, 200];
/// Height of the words below all panels \[px\].
const FOOT: u32 = 34;

/// The first of the places; `None` where there are none.
pub(super) fn picture(result: &SweepResult, found: &[SweepPlace]) -> Option<Picture> {
    let shown = &found[..found.len().min(MOST)];
    if shown.is_empty() {
        return None;
    }
    let columns = shown.len().min(COLUMNS);
    let rows = shown.len().div_ceil(columns);
    let panel = (WIDTHS[usize::from(columns < COLUMNS)], TITLE + CHARTS[0] + CHARTS[1]);
    let size = (panel.0 * columns as u32, panel.1 * rows as u32 + FOOT);
    let parameter = axis_name(&result.label, &result.unit);
    let svg = sheet(size, |area| {
        let (main, foot) = area.split_vertically(size.1 - FOOT);
        for (k, (panel, found)) in main.split_evenly((rows, columns)).iter().zip(shown).enumerate() {
            draw_panel(panel, result, found, k + 1)?;
        }
        foot.draw_text(&parameter, &below(text(14.0, INK)), (size.0 as i32 / 2, 6))?;
        Ok(())
    })?;
    let more = match found.len() - shown.len() {
        0 => String::new(),
        more => format!(" {more} more places are not drawn: see the words and tables below."),
    };
    let caption = format!(
        "Closer looks at the numbered places, over {parameter}: frequencies above, growth rates below, in windows of their own. \
         Strong lines: the modes in question, orange where they grow; dots: critical values.{more}"
    );
    let each = shown.iter().map(|p| {
        let value = format!("{} {}", given(rounded(p.value, 4)), result.unit);
        format!("at {}, {} Hz, {}", value.trim_end(), hertz(p.frequency_hz, 0), p.what.join(", "))
    });
    let seen = format!("Places of the sweep: {}.", each.collect::<Vec<_>>().join("; "));
    let svg = described(&svg, &seen);
    Some(Picture { file: file_name("sweep", &result.name) + "_places", caption, svg })
}

fn draw_panel(
    area: &Area,
    result: &SweepResult,
    found: &SweepPlace,
    number: usize,
) -> Result<(), Box<dyn Error>> {
    let (title, charts) = area.split_vertically(TITLE);
    let value = format!("{} {}", given(rounded(found.value, 4)), result.unit);
    let first = format!("{number}: {} Hz at {}", hertz(found.frequency_hz, 0), value.trim_end());
    title.draw_text(&first, &bold(13.5, INK), (16, 8))?;
    title.draw_text(&found.what.join("; "), &text(12.5, MUTED), (16, 27))?;
    let (upper, lower) = charts.split_vertically(CHARTS[0]);
    let pair = |b: usize| found.branches.contains(&b);
    let axis = &result.axis;
    let name = axis_name(&result.label, &result.unit);
    let high = (found.across.clone(), found.frequencies.clone());
    let chart = plot(&upper, high, result, "frequency [Hz]")?;
    axes_of(&upper, &chart, [scale(axis, &name), linear("frequency [Hz]")])?;
    let others = [CALM, ALARM].map(|hex| Pen { opacity: 0.5, ..pen(hex, 1.0) });
    let own = [pen(CALM, 2.5), pen(ALARM, 3.0)];
    draw_lines(&chart, result, |x, z| (x, z.im / TAU), (|b| !pair(b), others))?;
    draw_lines(&chart, result, |x, z| (x, z.im / TAU), (pair, own))?;
    draw_nominal(&chart, result)?;
    for c in &result.sweep.critical {
        draw_dot(&chart, (place(axis, c.value), c.eigenvalue.im / TAU), 4.5, ALARM)?;
    }
    let chart = plot(&lower, (found.across.clone(), found.rates.clone()), result, "growth rate σ [1/s]")?;
    axes_of(&lower, &chart, [scale(axis, &name), linear("growth rate σ [1/s]")])?;
    draw_curve(&chart, [(found.across.start, 0.0), (found.across.end, 0.0)], pen(INK, 1.5))?;
    draw_lines(&chart, result, |x, z| (x, z.re), (|b| !pair(b), others))?;
    draw_lines(&chart, result, |x, z| (x, z.re), (pair, own))?;
    draw_nominal(&chart, result)?;
    for c in result.sweep.critical.iter().filter(|c| pair(c.branch)) {
        draw_dot(&chart, (place(axis, c.value), 0.0), 4.5, ALARM)?;
    }
    Ok(())
}

/// Axes of one chart of a panel.
fn plot<'a, 'b>(
    area: &Area<'b>,
    (across, up): (Range<f64>, Range<f64>),
    result: &SweepResult,
    beside: &str,
) -> Result<LinearChart<'a, 'b>, Box<dyn Error>> {
    let high = up.clone();
    let mut chart = ChartBuilder::on(area)
        .margin(8)
        .margin_right(14)
        .x_label_area_size(22)
        .y_label_area_size(70)
        .build_cartesian_2d(across, up)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(colour("#e6e9ed"))
        .axis_style(colour(MUTED))
        .label_style(text(11.5, INK))
        .axis_desc_style(text(12.0, INK))
        .y_desc(beside)
        .x_labels(5)
        .y_labels(5)
        .x_label_formatter(&|v| label(&result.axis, *v))
        .y_label_formatter(&|v| given(clean(*v, &high)))
        .draw()?;
    Ok(chart)
}
