//! `calibration_errors.svg` and `calibration_numbers.svg`.

use super::super::colours::{ALARM, CALM, INK, MEASURED, MUTED, SECOND};
use super::super::comparison::{ResponseCurve, ResponsePanel, computed_pen, measured_pen, stacked};
use super::super::curve::{Pen, pen};
use super::super::format::{given, short, signed, significant};
use super::super::section::Picture;
use super::super::svg::{Anchor, Ink, Sheet};
use crate::results::{CalibratedNumber, CalibratedResponse, CalibrationResult};

const WIDTH: f64 = 980.0;
const LABELS: f64 = 230.0;
const BAR: f64 = 15.0;
/// Standard deviations in a band.
const BAND: f64 = 1.96;

fn ink(colour: &str, anchor: Anchor) -> Ink<'_> {
    Ink { size: 13.0, colour, bold: false, anchor }
}

/// The error of each computed frequency before and after, and when it is predicted from the others.
pub(super) fn errors(result: &CalibrationResult) -> Picture {
    let predicted = result.data.iter().any(|d| d.left_out_hz.is_some());
    let bars: &[(&str, &str)] = match predicted {
        true => &[("before", CALM), ("after", ALARM), ("predicted from the others", MEASURED)],
        false => &[("before", CALM), ("after", ALARM)],
    };
    let row = BAR * bars.len() as f64 + 18.0;
    let height = 50.0 + row * result.data.len() as f64 + 44.0;
    let mut sheet = Sheet::new(WIDTH, height);
    let mut x = LABELS;
    for (words, colour) in bars {
        sheet.rectangle([x, 14.0], [14.0, 14.0], &format!("fill=\"{colour}\""));
        sheet.text([x + 20.0, 26.0], words, ink(INK, Anchor::Start));
        x += 40.0 + 8.0 * words.len() as f64;
    }
    sheet.rectangle([x, 14.0], [14.0, 14.0], "fill=\"#dfe8f0\"");
    sheet.text([x + 20.0, 26.0], "95 % of the measurement", ink(INK, Anchor::Start));

    let each: Vec<[Option<f64>; 3]> = result
        .data
        .iter()
        .map(|d| [d.before_hz, d.after_hz, d.left_out_hz].map(|hz| d.error_percent(hz)))
        .collect();
    let errors = each.iter().flatten().flatten().map(|e| e.abs());
    let bands = result.data.iter().map(|d| 100.0 * BAND * d.deviation);
    let largest = errors.chain(bands).filter(|e| e.is_finite()).fold(f64::MIN_POSITIVE, f64::max);
    let zero = 0.5 * (LABELS + WIDTH);
    let reach = 0.5 * (WIDTH - LABELS) - 70.0;
    let mut top = 46.0;
    for (d, errors) in result.data.iter().zip(&each) {
        let half = reach * 100.0 * BAND * d.deviation / largest;
        sheet.rectangle([zero - half, top], [2.0 * half, row - 6.0], "fill=\"#dfe8f0\"");
        let middle = top + 0.5 * (row - 6.0);
        let measured = format!("{} Hz", given(d.measured_hz));
        sheet.text([LABELS - 12.0, middle - 2.0], &measured, Ink { bold: true, ..ink(INK, Anchor::End) });
        sheet.text([LABELS - 12.0, middle + 14.0], &d.level, ink(MUTED, Anchor::End));
        for (k, (_, colour)) in bars.iter().enumerate() {
            let Some(error) = errors[k].filter(|e| e.is_finite()) else { continue };
            let length = reach * error / largest;
            let y = top + 6.0 + BAR * k as f64;
            sheet.rectangle(
                [zero.min(zero + length), y],
                [length.abs(), BAR - 3.0],
                &format!("fill=\"{colour}\""),
            );
            let (place, anchor) = match error < 0.0 {
                true => (zero + length - 6.0, Anchor::End),
                false => (zero + length + 6.0, Anchor::Start),
            };
            sheet.text([place, y + 11.0], &format!("{} %", signed(error, 2)), ink(INK, anchor));
        }
        top += row;
    }
    sheet.lines([&[[zero, 42.0], [zero, top]][..]], &format!("stroke=\"{INK}\" stroke-width=\"1.2\""));
    let foot = "(computed − measured)/measured";
    sheet.text([zero, top + 24.0], foot, ink(MUTED, Anchor::Middle));
    let caption =
        "Errors of the computed frequencies with the values of the case and with those found.".to_string();
    Picture { file: "calibration_errors".into(), caption, svg: sheet.finish() }
}

/// The measured responses over the computed ones before and after; `None` where there are none.
pub(super) fn responses(result: &CalibrationResult) -> Option<Picture> {
    // Calibration is against ln |h|.
    let curve = |words: String, pen: Pen<'static>, sizes: &[f64]| ResponseCurve {
        words,
        pen,
        sizes: sizes.to_vec(),
        phases: Vec::new(),
    };
    let panel = |r: &CalibratedResponse| ResponsePanel {
        frequencies_hz: r.frequencies_hz.clone(),
        quantity: r.quantity,
        curves: [
            Some(curve("before".to_string(), pen(CALM, 1.5), &r.before)),
            r.left_out.as_ref().map(|sizes| curve("from the others".to_string(), pen(SECOND, 1.5), sizes)),
            Some(curve("after".to_string(), computed_pen(), &r.after)),
            Some(curve(format!("measured at {}", r.place.replace('_', " ")), measured_pen(), &r.measured)),
        ]
        .into_iter()
        .flatten()
        .collect(),
    };
    let panels: Vec<ResponsePanel> = result.responses.iter().map(panel).collect();
    let svg = stacked(&panels)?;
    let others = match result.responses.iter().any(|r| r.left_out.is_some()) {
        true => ", and with those found without the response",
        false => "",
    };
    let caption = format!(
        "Measured responses (dashed), and the computed ones with the values of the case, with those found{others}."
    );
    Some(Picture { file: "calibration_responses".into(), caption, svg })
}

/// Each number inside its bounds: what was expected, what was found, and its intervals.
pub(super) fn numbers(result: &CalibrationResult) -> Picture {
    const ROW: f64 = 74.0;
    let mut sheet = Sheet::new(WIDTH, 44.0 + ROW * result.numbers.len() as f64 + 10.0);
    let mut x = LABELS;
    let marks = [
        ("found, 95 % (thin: scaled by the misfit)", ALARM),
        ("the case", CALM),
        ("expected, 95 %", "#bcd7ea"),
    ];
    let shown = if result.numbers.iter().any(|n| n.deviation.is_some()) { 3 } else { 2 };
    for (words, colour) in &marks[..shown] {
        sheet.rectangle([x, 14.0], [14.0, 14.0], &format!("fill=\"{colour}\""));
        sheet.text([x + 20.0, 26.0], words, ink(INK, Anchor::Start));
        x += 44.0 + 7.0 * words.len() as f64;
    }
    for (k, n) in result.numbers.iter().enumerate() {
        draw(&mut sheet, 44.0 + ROW * k as f64, n);
    }
    let caption = "The numbers found, between their bounds, with their 95 % intervals.".to_string();
    Picture { file: "calibration_numbers".into(), caption, svg: sheet.finish() }
}

fn draw(sheet: &mut Sheet, top: f64, n: &CalibratedNumber) {
    let z = |v: f64| if n.log { v.max(f64::MIN_POSITIVE).ln() } else { v };
    let [low, high] = n.between.map(z);
    let (left, right) = (LABELS + 20.0, WIDTH - 40.0);
    let place = |v: f64| left + (right - left) * ((z(v) - low) / (high - low)).clamp(0.0, 1.0);
    let y = top + 26.0;
    sheet.text([LABELS - 12.0, y + 1.0], &n.name, Ink { bold: true, ..ink(INK, Anchor::End) });
    let found = format!("{} {}", significant(n.after, 4), n.unit);
    sheet.text([LABELS - 12.0, y + 18.0], found.trim_end(), ink(INK, Anchor::End));
    // The span of the bounds, and in it what was expected.
    sheet.rectangle([left, y - 12.0], [right - left, 24.0], "fill=\"#f1f3f5\"");
    if let Some(d) = n.deviation {
        let end = |sign: f64| {
            if n.log { n.expected * (sign * BAND * d).exp() } else { n.expected + sign * BAND * d }
        };
        let [a, b] =
            [end(-1.0), end(1.0)].map(|v| if n.log || v > 0.0 || low <= 0.0 { place(v) } else { left });
        sheet.rectangle([a, y - 12.0], [b - a, 24.0], "fill=\"#bcd7ea\"");
    }
    let line = |sheet: &mut Sheet, ends: [f64; 2], width: f64| {
        let ends = ends.map(|v| [place(v), y]);
        sheet.lines([&ends[..]], &format!("stroke=\"{ALARM}\" stroke-width=\"{width}\""));
    };
    if let Some(scaled) = n.scaled_interval {
        line(sheet, scaled, 1.6);
    }
    line(sheet, n.interval, 5.0);
    let before = place(n.before);
    sheet.lines(
        [&[[before, y - 14.0], [before, y + 14.0]][..]],
        &format!("stroke=\"{CALM}\" stroke-width=\"3\""),
    );
    sheet.circle(
        [place(n.after), y],
        6.5,
        &format!("fill=\"{ALARM}\" stroke=\"#ffffff\" stroke-width=\"1.5\""),
    );
    for (v, anchor) in [(n.between[0], Anchor::Start), (n.between[1], Anchor::End)] {
        let words = format!("{} {}", short(v), n.unit);
        sheet.text([place(v), y + 28.0], words.trim_end(), ink(MUTED, anchor));
    }
}
