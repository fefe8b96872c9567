//! `calibration_errors.svg` and `calibration_numbers.svg`.

use super::super::chart::WIDTH;
use super::super::colours::{ALARM, CALM, INK, MEASURED, MUTED, SECOND};
use super::super::comparison::{HEIGHTS, MOST};
use super::super::format::{given, short, signed, significant};
use super::super::magnitude::{ResponseCurve, ResponsePanel, computed_line, measured_line, stacked};
use super::super::section::Picture;
use super::super::svg::{Key, Sheet, Style, fill, ink, outlined, stroke};
use crate::results::{CalibratedNumber, CalibratedResponse, CalibrationResult};

const LABELS: f64 = 230.0;
const BAR: f64 = 15.0;
/// Colours of what is within the deviations: of the measurement, of what was expected.
const WITHIN: [&str; 2] = ["#dfe8f0", "#bcd7ea"];
/// Standard deviations in a band.
const BAND: f64 = 1.96;

/// Words beside their colours, above what they belong to.
fn legend(sheet: &mut Sheet, keys: &[(&str, &str)]) {
    sheet.keys([LABELS, 13.0], keys.iter().map(|(words, hex)| (Key::Box(fill(hex)), words.to_string())));
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
    legend(&mut sheet, &[bars, &[("95 % of the measurement", WITHIN[0])]].concat());
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
        sheet.rectangle([zero - half, top], [2.0 * half, row - 6.0], &fill(WITHIN[0]));
        let middle = top + 0.5 * (row - 6.0);
        let measured = format!("{} Hz", given(d.measured_hz));
        sheet.text([LABELS - 12.0, middle - 2.0], &measured, ink(13.0, INK).bold().end());
        sheet.text([LABELS - 12.0, middle + 14.0], &d.level, ink(13.0, MUTED).end());
        for (k, (_, hex)) in bars.iter().enumerate() {
            let Some(error) = errors[k].filter(|e| e.is_finite()) else { continue };
            let corner = [zero, top + 6.0 + BAR * k as f64];
            sheet.bar(corner, [reach * error / largest, BAR - 3.0], hex, &format!("{} %", signed(error, 2)));
        }
        top += row;
    }
    sheet.line([[zero, 42.0], [zero, top]], &stroke(INK, 1.2));
    let foot = "(computed − measured)/measured";
    sheet.text([zero, top + 24.0], foot, ink(13.0, MUTED).middle());
    let caption =
        "Errors of the computed frequencies with the values of the case and with those found.".to_string();
    Picture { file: "calibration_errors".into(), caption, svg: sheet.finish() }
}

/// The measured responses over the computed ones before and after; `None` where there are none.
pub(super) fn responses(result: &CalibrationResult) -> Option<Picture> {
    // Calibration is against ln |h|.
    let curve = |words: String, style: Style, sizes: &[f64]| ResponseCurve {
        words,
        style,
        sizes: sizes.to_vec(),
        phases: Vec::new(),
    };
    let panel = |r: &CalibratedResponse| ResponsePanel {
        frequencies_hz: r.frequencies_hz.clone(),
        quantity: r.quantity,
        curves: [
            Some(curve("before".to_string(), stroke(CALM, 1.5), &r.before)),
            r.left_out.as_ref().map(|sizes| curve("from the others".to_string(), stroke(SECOND, 1.5), sizes)),
            Some(curve("after".to_string(), computed_line(), &r.after)),
            Some(curve(format!("measured at {}", r.place.replace('_', " ")), measured_line(), &r.measured)),
        ]
        .into_iter()
        .flatten()
        .collect(),
        natural_hz: Vec::new(),
        measured_hz: Vec::new(),
        heights: HEIGHTS,
    };
    let panels: Vec<ResponsePanel> = result.responses.iter().take(MOST).map(panel).collect();
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
    let marks = [
        ("found, 95 % (thin: scaled by the misfit)", ALARM),
        ("the case", CALM),
        ("expected, 95 %", WITHIN[1]),
    ];
    let shown = if result.numbers.iter().any(|n| n.deviation.is_some()) { 3 } else { 2 };
    legend(&mut sheet, &marks[..shown]);
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
    sheet.text([LABELS - 12.0, y + 1.0], &n.name, ink(13.0, INK).bold().end());
    let found = format!("{} {}", significant(n.after, 4), n.unit);
    sheet.text([LABELS - 12.0, y + 18.0], found.trim_end(), ink(13.0, INK).end());
    // The span of the bounds, and in it what was expected.
    sheet.rectangle([left, y - 12.0], [right - left, 24.0], &fill("#f1f3f5"));
    if let Some(d) = n.deviation {
        let end = |sign: f64| {
            if n.log { n.expected * (sign * BAND * d).exp() } else { n.expected + sign * BAND * d }
        };
        let [a, b] =
            [end(-1.0), end(1.0)].map(|v| if n.log || v > 0.0 || low <= 0.0 { place(v) } else { left });
        sheet.rectangle([a, y - 12.0], [b - a, 24.0], &fill(WITHIN[1]));
    }
    let intervals = n.scaled_interval.map(|ends| (ends, 1.6)).into_iter().chain([(n.interval, 5.0)]);
    intervals.for_each(|(ends, width)| sheet.line(ends.map(|v| [place(v), y]), &stroke(ALARM, width)));
    let before = place(n.before);
    sheet.line([[before, y - 14.0], [before, y + 14.0]], &stroke(CALM, 3.0));
    sheet.circle([place(n.after), y], 6.5, &outlined(ALARM, "#ffffff", 1.5));
    let small = ink(13.0, MUTED);
    for (v, ink) in [(n.between[0], small), (n.between[1], small.end())] {
        sheet.text([place(v), y + 28.0], format!("{} {}", short(v), n.unit).trim_end(), ink);
    }
}
