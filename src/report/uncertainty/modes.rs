//! `uncertainty_<name>.svg`: the probability that each mode is unstable, over its frequency.

use super::words::{file, level, percent};
use crate::report::chart::{Axis, Chart, ends, wide, widened};
use crate::report::colours::{ALARM, CALM};
use crate::report::format::hertz;
use crate::report::html::described;
use crate::report::section::Picture;
use crate::report::svg::{sheer, stroke};
use crate::results::{ModeStatistics, UncertaintyResult};

/// Modes with a label, the most probable first.
const LABELS: usize = 10;

pub(super) fn picture(result: &UncertaintyResult) -> Option<Picture> {
    let modes: Vec<&ModeStatistics> = result.modes.iter().filter(|mode| mode.unstable.of > 0).collect();
    if modes.is_empty() {
        return None;
    }
    let caption = format!(
        "Probability that a mode is unstable, over its mean frequency. Upright: the interval of {} confidence; across: 5 to 95 % of its frequencies. Orange: unstable in some samples.",
        level(result)
    );
    let most = modes.iter().max_by(|a, b| a.unstable.share.total_cmp(&b.unstable.share));
    let seen = most.map_or(String::new(), |mode| {
        let (share, hz) = (percent(mode.unstable.share), hertz(mode.mean_hz, 0));
        format!("Probability of instability of {} modes; the largest is {share} at {hz} Hz.", modes.len())
    });
    Some(Picture { file: file(result, ""), caption, svg: described(&drawn(&modes), &seen) })
}

fn drawn(modes: &[&ModeStatistics]) -> String {
    let across = widened(ends(modes.iter().flat_map(|mode| mode.frequency_hz)), 0.05);
    let up = Axis::new("probability of instability [%]", 0.0..118.0);
    let mut chart = Chart::new(wide(10.0, 368.0), Axis::new("frequency [Hz]", across), up);
    let mut order: Vec<usize> = (0..modes.len()).collect();
    order.sort_by(|a, b| modes[*b].unstable.share.total_cmp(&modes[*a].unstable.share));
    for (rank, k) in order.iter().enumerate() {
        let mode = modes[*k];
        let grows = mode.unstable.count > 0;
        let hex = if grows { ALARM } else { CALM };
        let line = sheer(stroke(hex, 1.5), 0.7);
        let place = [mode.mean_hz, 100.0 * mode.unstable.share];
        let [from, to] = mode.unstable.limits.map(|share| 100.0 * share);
        chart.line([[place[0], from], [place[0], to]], &line);
        chart.line([[mode.frequency_hz[0], place[1]], [mode.frequency_hz[2], place[1]]], &line);
        chart.dot(place, if grows { 5.0 } else { 3.5 }, hex);
        if grows && rank < LABELS {
            chart.label([place[0], to], 5.0, &format!("{} Hz", hertz(mode.mean_hz, 0)));
        }
        let (hz, share) = (hertz(mode.mean_hz, 1), percent(mode.unstable.share));
        chart.title(place, &format!("mode {}: {hz} Hz, {share}", k + 1));
    }
    chart.picture(420.0)
}
