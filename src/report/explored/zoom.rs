//! `sweep_<name>_places.svg`: frequency and growth rate about the critical values and where two frequencies merge or veer, each
//! in a window of its own.

use super::axis::{axis_name, between};
use super::branches::{draw_lines, draw_nominal};
use super::places::{MOST, SweepPlace};
use crate::report::chart::{Axis, Chart};
use crate::report::colours::{ALARM, CALM, INK, MUTED};
use crate::report::format::{given, hertz, rounded};
use crate::report::html::described;
use crate::report::section::Picture;
use crate::report::svg::{Sheet, SvgPoint, ink, sheer, stroke};
use crate::results::{SweepResult, file_name};
use std::f64::consts::TAU;

/// Panels beside each other at most.
const COLUMNS: usize = 3;
/// Widths of a panel among three, and of one or two \[px\].
const WIDTHS: [f64; 2] = [330.0, 490.0];
/// Heights of the title, and of each of the charts of frequency and growth rate \[px\].
const TITLE: f64 = 44.0;
const CHART: f64 = 195.0;
/// Height of the words below all panels \[px\].
const FOOT: f64 = 34.0;

/// The first of the places; `None` where there are none.
pub(super) fn picture(result: &SweepResult, found: &[SweepPlace]) -> Option<Picture> {
    let shown = &found[..found.len().min(MOST)];
    if shown.is_empty() {
        return None;
    }
    let columns = shown.len().min(COLUMNS);
    let rows = shown.len().div_ceil(columns);
    let panel = [WIDTHS[usize::from(columns < COLUMNS)], TITLE + 2.0 * CHART];
    let size = [panel[0] * columns as f64, panel[1] * rows as f64 + FOOT];
    let parameter = axis_name(&result.label, &result.unit);
    let mut sheet = Sheet::new(size[0], size[1]);
    for (k, found) in shown.iter().enumerate() {
        let corner = [panel[0] * (k % columns) as f64, panel[1] * (k / columns) as f64];
        draw_panel(&mut sheet, (corner, panel[0]), result, found, k + 1);
    }
    sheet.text([0.5 * size[0], size[1] - 14.0], &parameter, ink(14.0, INK).middle());
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
    let svg = described(&sheet.finish(), &seen);
    Some(Picture { file: file_name("sweep", &result.name) + "_places", caption, svg })
}

fn draw_panel(
    sheet: &mut Sheet,
    ([left, top], width): (SvgPoint, f64),
    result: &SweepResult,
    found: &SweepPlace,
    number: usize,
) {
    let value = format!("{} {}", given(rounded(found.value, 4)), result.unit);
    let first = format!("{number}: {} Hz at {}", hertz(found.frequency_hz, 0), value.trim_end());
    sheet.text([left + 16.0, top + 20.0], &first, ink(13.5, INK).bold());
    sheet.text([left + 16.0, top + 38.0], &found.what.join("; "), ink(12.5, MUTED));
    let pair = |b: usize| found.branches.contains(&b);
    let others = [CALM, ALARM].map(|hex| sheer(stroke(hex, 1.0), 0.5));
    let own = [stroke(CALM, 2.5), stroke(ALARM, 3.0)];
    let ups = [
        Axis::new("frequency [Hz]", found.frequencies.clone()),
        Axis::new("growth rate σ [1/s]", found.rates.clone()),
    ];
    for (k, up) in ups.into_iter().enumerate() {
        let top = top + TITLE + 6.0 + CHART * k as f64;
        let across =
            between(&result.axis, &axis_name(&result.label, &result.unit), found.across.clone()).untitled();
        let mut chart = Chart::new([left + 78.0, top, left + width - 14.0, top + CHART - 34.0], across, up);
        let point = |x: f64, z: crate::linalg::c64| [x, [z.im / TAU, z.re][k]];
        if k == 1 {
            chart.rule(1, 0.0, &stroke(INK, 1.5));
        }
        draw_lines(&mut chart, result, point, (|b| !pair(b), &others));
        draw_lines(&mut chart, result, point, (pair, &own));
        draw_nominal(&mut chart, result);
        for c in result.sweep.critical.iter().filter(|c| k == 0 || pair(c.branch)) {
            chart.dot([c.value, [c.eigenvalue.im / TAU, 0.0][k]], 4.5, ALARM);
        }
        chart.draw(sheet);
    }
}
