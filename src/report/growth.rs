//! `growth.svg`: growth rate over frequency, unstable modes marked, measured squeal as bands.

use super::chart::{Axis, Chart, ends, wide, widened};
use super::colours::{ALARM, CALM, INK, MEASURED, MUTED};
use super::format::{fixed, given, hertz, signed};
use super::html::described;
use super::section::Picture;
use super::squeal::SQUEAL_TOLERANCE;
use super::svg::{fill, ink, sheer, stroke};
use crate::results::{ComplexResult, RunResults};
use crate::stability::ComplexMode;

/// Stable modes farther below zero than this many times the largest growth are drawn at the lower edge.
const DEEPEST: f64 = 2.0;
/// Unstable modes with a label; the others have their mark only.
const LABELS: usize = 10;

/// The picture, when the run has complex modes.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let complex = results.get::<ComplexResult>().filter(|c| !c.modes.modes.is_empty())?;
    let squeal = match complex.measured_squeal_hz.is_empty() {
        true => String::new(),
        false => {
            format!(" Bands: measured squeal ± {} %.", fixed(100.0 * SQUEAL_TOLERANCE, 0))
        }
    };
    let caption = format!(
        "Growth rate of the complex modes: above zero a mode grows (orange), below it dies away (grey; a triangle where it lies below the axis).{squeal}"
    );
    Some(Picture { file: "growth".into(), caption, svg: described(&drawn(complex), &seen(complex)) })
}

/// How many modes grow, and which grows most.
fn seen(complex: &ComplexResult) -> String {
    let modes = &complex.modes.modes;
    let unstable = modes.iter().filter(|m| m.unstable());
    let strongest = unstable.clone().max_by(|a, b| a.growth_rate().total_cmp(&b.growth_rate()));
    let largest = strongest.map_or(String::new(), |mode| {
        let (rate, hz) = (signed(mode.growth_rate(), 1), hertz(mode.frequency_hz(), 0));
        format!("; the largest growth rate is {rate} 1/s at {hz} Hz")
    });
    format!(
        "Growth rate over frequency: {} of {} modes are unstable{largest}.",
        unstable.count(),
        modes.len()
    )
}

/// Range of the axis of the growth rate.
fn growth_range(complex: &ComplexResult) -> std::ops::Range<f64> {
    let [lowest, highest] = ends(complex.modes.modes.iter().map(|m| m.growth_rate()).chain([0.0]));
    let floor = if highest > 0.0 { lowest.max(-DEEPEST * highest) } else { lowest };
    let length = (highest - floor).max(f64::MIN_POSITIVE);
    // Space above for the labels of modes and bands.
    let range = widened([floor, highest + 0.3 * length], 0.06);
    if range.end - range.start < 1e-9 { -1.0..1.0 } else { range }
}

fn drawn(complex: &ComplexResult) -> String {
    let modes = &complex.modes.modes;
    let squeal = complex.measured_squeal_hz.iter().map(|s| s.0);
    let across = widened(ends(modes.iter().map(|m| m.frequency_hz()).chain(squeal.clone())), 0.05);
    let up = growth_range(complex);
    let [foot, head] = [up.start, up.end];
    let axes = [Axis::new("frequency [Hz]", across), Axis::new("growth rate σ [1/s]", up)];
    let [across, up] = axes;
    let mut chart = Chart::new(wide(16.0, 464.0), across, up);
    for hz in squeal {
        let band = [hz * (1.0 - SQUEAL_TOLERANCE), hz * (1.0 + SQUEAL_TOLERANCE)];
        chart.bar([[band[0], foot], [band[1], head]], &sheer(fill(MEASURED), 0.13));
        let words = format!("squeal {} Hz", given(hz));
        chart.flag(hz, &words, &sheer(stroke(MEASURED, 1.0), 0.55), ink(12.5, MEASURED).bold().middle());
    }
    chart.rule(1, 0.0, &stroke(INK, 2.0));
    for mode in modes.iter().filter(|m| !m.unstable()) {
        // Modes that die away or are not accurate.
        let place = [mode.frequency_hz(), mode.growth_rate()];
        let at_edge = [place[0], place[1].max(foot)];
        match mode.accurate() {
            false => chart.circle(at_edge, 5.0, &stroke(MUTED, 1.0)),
            true if place[1] < foot => {
                chart.corners(at_edge, &[[0.0, 0.0], [5.2, -9.0], [-5.2, -9.0]], &fill(CALM))
            }
            true => chart.dot(place, 4.0, CALM),
        }
    }
    let mut unstable: Vec<&ComplexMode> = modes.iter().filter(|m| m.unstable()).collect();
    unstable.sort_by(|a, b| b.growth_rate().total_cmp(&a.growth_rate()));
    for (k, mode) in unstable.iter().enumerate() {
        let place = [mode.frequency_hz(), mode.growth_rate()];
        chart.line([[place[0], 0.0], place], &stroke(ALARM, 2.0));
        chart.dot(place, 6.0, ALARM);
        if k < LABELS {
            chart.label(place, 9.0, &format!("{} Hz", hertz(place[0], 0)));
        }
    }
    for (k, mode) in modes.iter().enumerate() {
        let (hz, rate) = (hertz(mode.frequency_hz(), 1), signed(mode.growth_rate(), 2));
        let place = [mode.frequency_hz(), mode.growth_rate().max(foot)];
        chart.title(place, &format!("mode {}: {hz} Hz, σ {rate} 1/s", k + 1));
    }
    chart.picture(520.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use crate::linalg::c64;

    #[test]
    fn unstable_modes_are_labelled_and_a_deep_one_does_not_flatten_the_picture() {
        let results = sample::rig();
        let svg = picture(&results).unwrap().svg;
        for label in ["276 Hz", "332 Hz", "569 Hz", "squeal 333", "squeal 936", "squeal 1661"] {
            assert!(svg.contains(label), "{label}");
        }
        // The strongest growth is 13.0 1/s; modes at −40 to −64 1/s are off the axis.
        assert!(growth_range(results.get::<ComplexResult>().unwrap()).start > -31.0);
        assert!(!svg.contains("NaN"));
    }

    #[test]
    fn undamped_and_single_modes_draw_too() {
        let mut results = sample::rig();
        let complex = results.get_mut::<ComplexResult>().unwrap();
        complex.modes.modes.truncate(1);
        complex.modes.modes[0].eigenvalue = c64::new(0.0, 1000.0);
        complex.measured_squeal_hz.clear();
        assert!(picture(&results).unwrap().svg.contains("growth rate"));
        results.get_mut::<ComplexResult>().unwrap().modes.modes.clear();
        assert!(picture(&results).is_none());
    }
}
