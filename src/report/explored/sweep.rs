//! `sweep_<name>.svg` and `root_locus_<name>.svg`: the branches over the parameter and in the complex plane.

use super::axis::{axis_name, between, places, value};
use super::branches::{draw_lines, draw_nominal};
use super::places::{MOST, SweepPlace};
use crate::linalg::c64;
use crate::report::chart::{Axis, Chart, LABEL, WIDTH, ends, wide, widened};
use crate::report::colours::{ALARM, ALARM_TEXT, CALM, INK, MUTED, NO_ANSWER};
use crate::report::format::{given, hertz, rounded};
use crate::report::section::Picture;
use crate::report::svg::{DOTTED, Sheet, fill, ink, sheer, stroke};
use crate::results::{SweepResult, file_name};
use std::f64::consts::TAU;
use std::ops::Range;

/// Stable modes farther below zero than this many times the largest growth are off the picture.
const DEEPEST: f64 = 1.5;
/// Values with a label above the charts.
const LABELS: usize = 10;
/// Width of such a label \[px\].
const LABEL_WIDTH: f64 = 146.0;
/// Heights of the two charts \[px\].
const HEIGHTS: [f64; 2] = [320.0, 320.0];

/// Every branch over the parameter; the windows of the first of `found` are outlined.
pub(super) fn picture(result: &SweepResult, found: &[SweepPlace]) -> Option<Picture> {
    if result.sweep.branches.is_empty() {
        return None;
    }
    let parameter = axis_name(&result.label, &result.unit);
    let svg = drawn(result, found);
    let without = if result.sweep.unanswered.is_empty() { "" } else { " Grey: values without an answer." };
    let windows = if found.is_empty() { "" } else { " Numbers and frames: the places of the next figure." };
    let caption = format!(
        "Frequency and growth rate of every mode over {parameter}: orange where it grows. Dots: critical values. Dashed: the case \
         itself.{without}{windows}"
    );
    Some(Picture { file: file_name("sweep", &result.name), caption, svg })
}

/// The eigenvalues in the complex plane.
pub(super) fn locus(result: &SweepResult) -> Option<Picture> {
    if result.sweep.branches.is_empty() {
        return None;
    }
    let svg = drawn_locus(result);
    let caption = format!(
        "Eigenvalues in the complex plane as {} goes from {} (circles) to {} (dots); to the right of the line a mode grows.",
        axis_name(&result.label, &result.unit),
        given(result.sweep.answered().next()?),
        given(result.sweep.answered().next_back()?)
    );
    Some(Picture { file: file_name("root_locus", &result.name), caption, svg })
}

/// All eigenvalues of the sweep.
fn eigenvalues(result: &SweepResult) -> impl Iterator<Item = &c64> {
    result.sweep.branches.iter().flat_map(|b| &b.eigenvalues)
}

fn growth_range(result: &SweepResult) -> Range<f64> {
    let [lowest, highest] = ends(eigenvalues(result).map(|z| z.re).chain([0.0]));
    let size = highest.max(-lowest);
    let floor = if highest > 1e-9 * size { lowest.max(-DEEPEST * highest) } else { lowest };
    let range = widened([floor, highest], 0.08);
    if range.end - range.start < 1e-12 { -1.0..1.0 } else { range }
}

fn frequency_range(result: &SweepResult) -> Range<f64> {
    widened(ends(eigenvalues(result).map(|z| z.im / TAU)), 0.04)
}

/// A label above the charts.
struct StripLabel {
    words: String,
    /// Value of the parameter, and ω/2π of the mode there \[Hz\].
    at: [f64; 2],
    /// Its right and lower edges \[px\].
    pixel: [f64; 2],
    /// Where the line to the value leaves it \[px\].
    leader: f64,
    critical: bool,
}

/// Labels of the numbered places and of further critical values in a strip of this height, where no curve is. Each ends at the line
/// to its value, and those farther right stand higher: no line crosses a label.
fn strip(result: &SweepResult, found: &[SweepPlace]) -> (f64, Vec<StripLabel>) {
    let words = |value: f64, hz: f64| format!("{} · {} Hz", given(rounded(value, 4)), hertz(hz, 0));
    let shown = &found[..found.len().min(MOST)];
    let numbered = shown.iter().enumerate().map(|(k, p)| {
        (format!("{}: {}", k + 1, words(p.value, p.frequency_hz)), [p.value, p.frequency_hz], p.critical)
    });
    let others = result.sweep.critical.iter().filter(|c| shown.iter().all(|p| p.value != c.value));
    let others = others.map(|c| {
        let hz = c.eigenvalue.im / TAU;
        (words(c.value, hz), [c.value, hz], true)
    });
    let across = across_axis(result, "");
    let empty = Chart::new(wide(0.0, 1.0), across, Axis::new("", 0.0..1.0));
    let label = |(words, at, critical): (String, [f64; 2], bool)| {
        let [leader, _] = empty.pixel([at[0], 0.0]);
        StripLabel { words, at, pixel: [leader.max(LABEL_WIDTH), 0.0], leader, critical }
    };
    let mut labels: Vec<StripLabel> = numbered.chain(others).take(LABELS).map(label).collect();
    labels.sort_by(|a, b| a.leader.total_cmp(&b.leader));
    let mut lowest = 0.0;
    let mut before: Option<f64> = None;
    for label in &mut labels {
        // Beside the one before where that ends, else above it.
        let free = before.is_none_or(|end| label.pixel[0] - LABEL_WIDTH >= end);
        label.pixel[1] = if free { 0.0 } else { lowest - LABEL };
        (lowest, before) = (label.pixel[1], Some(label.pixel[0]));
    }
    if labels.is_empty() {
        return (0.0, labels);
    }
    let height = LABEL + 10.0 - labels.iter().map(|label| label.pixel[1]).fold(0.0, f64::min);
    labels.iter_mut().for_each(|label| label.pixel[1] += height);
    (height, labels)
}

fn across_axis(result: &SweepResult, name: &str) -> Axis {
    between(&result.axis, name, places(&result.axis))
}

fn drawn(result: &SweepResult, found: &[SweepPlace]) -> String {
    let (strip, labels) = strip(result, found);
    let (first, second) = (strip + 16.0, strip + HEIGHTS[0] + 58.0);
    let mut sheet = Sheet::new(WIDTH, second + HEIGHTS[1] + 52.0);
    let parameter = axis_name(&result.label, &result.unit);
    let up = Axis::new("frequency [Hz]", frequency_range(result));
    let mut top = Chart::new(wide(first, first + HEIGHTS[0]), across_axis(result, ""), up);
    let up = Axis::new("growth rate σ [1/s]", growth_range(result));
    let mut bottom = Chart::new(wide(second, second + HEIGHTS[1]), across_axis(result, &parameter), up);
    let lines = [stroke(CALM, 1.0), stroke(ALARM, 3.0)];
    for chart in [&mut top, &mut bottom] {
        for (k, _) in &result.sweep.unanswered {
            chart.rule(0, result.sweep.values[*k], &stroke(NO_ANSWER, 3.0));
        }
    }
    bottom.rule(1, 0.0, &stroke(INK, 2.0));
    draw_lines(&mut top, result, |x, z| [x, z.im / TAU], (|_| true, &lines));
    draw_lines(&mut bottom, result, |x, z| [x, z.re], (|_| true, &lines));
    draw_nominal(&mut top, result);
    draw_nominal(&mut bottom, result);
    for c in &result.sweep.critical {
        top.dot([c.value, c.eigenvalue.im / TAU], 4.5, ALARM);
        bottom.dot([c.value, 0.0], 4.5, ALARM);
    }
    for p in found.iter().take(MOST) {
        let [a, b] = [p.across.start, p.across.end].map(|place| value(&result.axis, place));
        let [c, d] = [p.frequencies.start, p.frequencies.end];
        top.line([[a, c], [b, c], [b, d], [a, d], [a, c]], &sheer(stroke(INK, 1.0), 0.6));
    }
    for label in labels {
        let (hex, text) = if label.critical { (ALARM, ALARM_TEXT) } else { (MUTED, MUTED) };
        let [x, y] = label.pixel;
        let leader = sheer(stroke(hex, 1.0), 0.55) + DOTTED;
        sheet.line([[label.leader, y - LABEL], top.pixel(label.at)], &leader);
        sheet.text([x - 4.0, y - 4.0], &label.words, ink(12.5, text).bold().end());
    }
    top.draw(&mut sheet);
    bottom.draw(&mut sheet);
    sheet.finish()
}

fn drawn_locus(result: &SweepResult) -> String {
    let across = Axis::new("growth rate σ [1/s]", growth_range(result));
    let up = Axis::new("frequency [Hz]", frequency_range(result));
    let mut chart = Chart::new(wide(16.0, 508.0), across, up);
    chart.rule(0, 0.0, &stroke(INK, 2.0));
    let lines = [stroke(CALM, 2.0), stroke(ALARM, 3.0)];
    draw_lines(&mut chart, result, |_, z| [z.re, z.im / TAU], (|_| true, &lines));
    for branch in &result.sweep.branches {
        let (Some(first), Some(last)) = (branch.eigenvalues.first(), branch.eigenvalues.last()) else {
            continue;
        };
        let hue = |grows: Option<bool>| if grows == Some(true) { ALARM } else { CALM };
        chart.circle([first.re, first.im / TAU], 4.0, &stroke(hue(branch.growing().next()), 1.0));
        chart.circle([last.re, last.im / TAU], 4.0, &fill(hue(branch.growing().next_back())));
    }
    chart.picture(560.0)
}

#[cfg(test)]
mod tests {
    use super::super::places::places_of;
    use super::*;
    use crate::job::sample;

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
            assert!(a.pixel[1] <= height && a.pixel[1] >= LABEL, "{:?} of {height}", a.pixel);
            for b in &labels[k + 1..] {
                let [dx, dy] = [0, 1].map(|c| (a.pixel[c] - b.pixel[c]).abs());
                assert!(dx >= LABEL_WIDTH || dy >= LABEL, "{} {}", a.words, b.words);
                let (high, low) = if a.pixel[1] < b.pixel[1] { (a, b) } else { (b, a) };
                let under = low.pixel[0] - LABEL_WIDTH..low.pixel[0];
                assert!(!under.contains(&high.leader), "a line crosses {}", low.words);
            }
        }
        let svg = picture(&result, &found).unwrap().svg;
        assert!(svg.contains("friction coefficient μ₀ of rim [–]") && !svg.contains("mu0"));
        assert!(!svg.contains("NaN"));
    }
}
