//! `frequencies_<name>.svg`: how far computed frequencies are from the measured ones, beside their scatter.

use super::super::chart::{Axis, Chart};
use super::super::colours::{ALARM, INK, MEASURED, MUTED};
use super::super::format::{given, signed};
use super::super::svg::{Sheet, fill, ink, sheer, stroke};
use super::level::level_name;
use crate::report::section::Picture;
use crate::results::{MeasuredComparison, NamedModes, file_name};

const LINE: f64 = 30.0;
const LEFT: f64 = 210.0;
const WIDTH: f64 = 560.0;
const TOP: f64 = 44.0;

pub(super) fn picture(comparison: &MeasuredComparison, set: &NamedModes) -> Option<Picture> {
    if comparison.rows.is_empty() {
        return None;
    }
    let percent = |k: usize| {
        let row = &comparison.rows[k];
        let mode = row.mode?;
        Some(100.0 * (comparison.frequency_scale * set.modes.frequency_hz(mode) / row.frequency_hz - 1.0))
    };
    let count = comparison.rows.len();
    // Twice the standard deviation to either side.
    let scatter = |k: usize| comparison.rows[k].deviation.map(|d| 200.0 * d);
    let sizes = (0..count).flat_map(|k| [percent(k).map(f64::abs), scatter(k)]).flatten();
    let end = 1.1 * sizes.fold(0.5, f64::max);
    let height = count as f64 * LINE;
    let mut sheet = Sheet::new(LEFT + WIDTH + 90.0, TOP + height + 68.0);
    sheet.text([12.0, 24.0], "computed over measured frequency", ink(14.0, INK).bold());
    let across = Axis::new("difference [%]", -end..end);
    let levels = comparison.rows.iter().map(|row| {
        let level = row.mode.and_then(|mode| comparison.level_of(mode));
        level.map_or("none".into(), |at| level_name(set, &comparison.levels[at]))
    });
    let mut chart = Chart::new([LEFT, TOP, LEFT + WIDTH, TOP + height], across, Axis::rows(levels));
    chart.rule(0, 0.0, &stroke(MUTED, 1.0));
    for (k, row) in comparison.rows.iter().enumerate() {
        let y = k as f64 + 0.5;
        let measured = format!("{} Hz", given(row.frequency_hz));
        chart.text([-end, y], [-90.0, 4.0], &measured, ink(12.5, MEASURED).end());
        if let Some(half) = scatter(k) {
            chart.bar([[-half, y - 0.23], [half, y + 0.23]], &sheer(fill(MEASURED), 0.25));
        }
        let Some(percent) = percent(k) else { continue };
        chart.line([[0.0, y], [percent, y]], &stroke(ALARM, 2.0));
        chart.dot([percent, y], 4.5, ALARM);
        chart.text([end, y], [80.0, 4.0], &format!("{} %", signed(percent, 2)), ink(12.5, INK).end());
    }
    chart.draw(&mut sheet);
    let band = if (0..count).any(|k| scatter(k).is_some()) {
        "Blue: twice the standard deviation of the measured frequency to either side. "
    } else {
        ""
    };
    sheet.text([12.0, TOP + height + 58.0], &format!("{band}Dot: computed."), ink(12.5, MUTED));
    let caption = format!("Computed over measured frequencies ({}).", comparison.name);
    Some(Picture { file: file_name("frequencies", &comparison.name), caption, svg: sheet.finish() })
}
