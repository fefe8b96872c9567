//! Axes of the charts over time and frequency.

use crate::report::chart::{Area, colour, text};
use crate::report::colours::{INK, MUTED};
use crate::report::format::given;
use crate::report::readout::{AxisScale, axes_of};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::error::Error;
use std::ops::Range;

pub(super) const WIDTH: u32 = 980;

pub(super) type Chart<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// The axes of one of several panels above each other; the words below stand under the last only.
pub(super) fn axes<'a>(
    area: &Area<'a>,
    ranges: (Range<f64>, Range<f64>),
    below: Option<&str>,
    beside: &str,
    label: impl Fn(f64) -> String,
) -> Result<Chart<'a>, Box<dyn Error>> {
    let words = Words { below, beside, across: &given, up: &label, labels: 10, decades: 0.0, grid: true };
    labelled(area, ranges, &words)
}

/// Labels of the axes.
pub(super) struct Words<'a> {
    /// Under the axis across; the labels only when absent.
    pub below: Option<&'a str>,
    /// Beside the axis up.
    pub beside: &'a str,
    /// Labels of either axis.
    pub across: &'a dyn Fn(f64) -> String,
    /// See `across`.
    pub up: &'a dyn Fn(f64) -> String,
    /// About how many labels the axis across has.
    pub labels: usize,
    /// 0 where the axis up is linear, 1 where its places are decimal logarithms of the values.
    pub decades: f64,
    /// Whether there are lines at the labels.
    pub grid: bool,
}

/// The value of a tick of an axis, zero where it is that but for round-off.
pub(super) fn clean(tick: f64, axis: &Range<f64>) -> f64 {
    if tick.abs() < 1e-9 * (axis.end - axis.start) { 0.0 } else { tick }
}

/// Axes with words of one's own.
pub(super) fn labelled<'a>(
    area: &Area<'a>,
    (across, up): (Range<f64>, Range<f64>),
    words: &Words,
) -> Result<Chart<'a>, Box<dyn Error>> {
    let (wide, high) = (across.clone(), up.clone());
    let mut chart = ChartBuilder::on(area)
        .margin_left(16)
        .margin_right(20)
        .margin_top(10)
        .x_label_area_size(if words.below.is_some() { 46 } else { 22 })
        .y_label_area_size(104)
        .build_cartesian_2d(across, up)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(colour("#e6e9ed").mix(if words.grid { 1.0 } else { 0.0 }))
        .axis_style(colour(MUTED))
        .label_style(text(12.0, INK))
        .axis_desc_style(text(13.0, INK))
        .x_desc(words.below.unwrap_or_default())
        .y_desc(words.beside)
        .x_labels(words.labels)
        .y_labels(5)
        .x_label_formatter(&|x| (words.across)(clean(*x, &wide)))
        .y_label_formatter(&|y| (words.up)(clean(*y, &high)))
        .draw()?;
    let scale = |name, decades| AxisScale { name, decades };
    let scales = [scale(words.below.unwrap_or_default(), 0.0), scale(words.beside, words.decades)];
    axes_of(area, &chart, scales)?;
    Ok(chart)
}
