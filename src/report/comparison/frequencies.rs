//! `frequencies_<name>.svg`: how far computed frequencies are from the measured ones, beside their scatter.

use super::super::colours::{ALARM, INK, MEASURED, MUTED};
use super::super::format::{fixed, given, signed};
use super::super::svg::{Anchor, Ink, Sheet};
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
    let end = round_up(1.1 * sizes.fold(0.5, f64::max));
    let height = count as f64 * LINE;
    let mut sheet = Sheet::new(LEFT + WIDTH + 90.0, TOP + height + 58.0);
    let at = |percent: f64| LEFT + WIDTH * 0.5 * (1.0 + percent / end);
    let ink = Ink { size: 12.5, colour: INK, bold: false, anchor: Anchor::Middle };
    let title = Ink { bold: true, size: 14.0, anchor: Anchor::Start, ..ink };
    sheet.text([12.0, 24.0], "computed over measured frequency", title);
    for tick in [-1.0, -0.5, 0.0, 0.5, 1.0] {
        let x = at(tick * end);
        let colour = if tick == 0.0 { MUTED } else { "#e6e9ed" };
        sheet.lines([&[[x, TOP], [x, TOP + height]][..]], &format!("stroke=\"{colour}\""));
        sheet.text([x, TOP + height + 18.0], &format!("{} %", signed(tick * end, digits(end))), ink);
    }
    for (k, row) in comparison.rows.iter().enumerate() {
        let y = TOP + (k as f64 + 0.5) * LINE;
        let level = row.mode.and_then(|mode| comparison.level_of(mode));
        let label = level.map_or("none".into(), |at| level_name(set, &comparison.levels[at]));
        let right = Ink { anchor: Anchor::End, ..ink };
        sheet.text(
            [LEFT - 90.0, y + 4.0],
            &format!("{} Hz", given(row.frequency_hz)),
            Ink { colour: MEASURED, ..right },
        );
        sheet.text([LEFT - 14.0, y + 4.0], &label, right);
        if let Some(half) = scatter(k) {
            let (a, b) = (at(-half), at(half));
            sheet.rectangle(
                [a, y - 7.0],
                [b - a, 14.0],
                &format!("fill=\"{MEASURED}\" fill-opacity=\"0.25\""),
            );
        }
        let Some(percent) = percent(k) else { continue };
        let x = at(percent);
        sheet.lines([&[[at(0.0), y], [x, y]][..]], &format!("stroke=\"{ALARM}\" stroke-width=\"2\""));
        sheet.circle([x, y], 4.5, &format!("fill=\"{ALARM}\""));
        let words = format!("{} %", signed(percent, 2));
        sheet.text([LEFT + WIDTH + 80.0, y + 4.0], &words, right);
    }
    let foot = TOP + height + 42.0;
    let note = Ink { colour: MUTED, anchor: Anchor::Start, ..ink };
    let band = if (0..count).any(|k| scatter(k).is_some()) {
        "Blue: twice the standard deviation of the measured frequency to either side. "
    } else {
        ""
    };
    sheet.text([12.0, foot], &format!("{band}Dot: computed."), note);
    let caption = format!("Computed over measured frequencies ({}).", comparison.name);
    Some(Picture { file: file_name("frequencies", &comparison.name), caption, svg: sheet.finish() })
}

/// The next of 1, 2, 5 times a power of ten.
fn round_up(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|step| step * power).find(|step| *step >= value).unwrap_or(value)
}

/// Decimals that half of `end` needs.
fn digits(end: f64) -> usize {
    (0..6).find(|n| fixed(0.5 * end, *n).parse::<f64>() == Ok(0.5 * end)).unwrap_or(2)
}
