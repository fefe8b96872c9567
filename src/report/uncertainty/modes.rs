//! `uncertainty_<name>.svg`: the probability that each mode is unstable, over its frequency.

use super::words::{file, level, percent};
use crate::report::axes::{Words, labelled};
use crate::report::chart::{Area, sheet, widened};
use crate::report::colours::{ALARM, CALM};
use crate::report::curve::{Pen, draw_curve, draw_dot, pen};
use crate::report::format::{given, hertz};
use crate::report::html::described;
use crate::report::labels::{Labels, label_unstable};
use crate::report::readout::title_at;
use crate::report::section::Picture;
use crate::results::{ModeStatistics, UncertaintyResult};
use std::error::Error;

/// Modes with a label, the most probable first.
const LABELS: usize = 10;

pub(super) fn picture(result: &UncertaintyResult) -> Option<Picture> {
    let modes: Vec<&ModeStatistics> = result.modes.iter().filter(|mode| mode.unstable.of > 0).collect();
    if modes.is_empty() {
        return None;
    }
    let svg = sheet((980, 420), |area| draw(area, &modes))?;
    let caption = format!(
        "Probability that a mode is unstable, over its mean frequency. Upright: the interval of {} confidence; across: 5 to 95 % of its frequencies. Orange: unstable in some samples.",
        level(result)
    );
    let most = modes.iter().max_by(|a, b| a.unstable.share.total_cmp(&b.unstable.share));
    let seen = most.map_or(String::new(), |mode| {
        let (share, hz) = (percent(mode.unstable.share), hertz(mode.mean_hz, 0));
        format!("Probability of instability of {} modes; the largest is {share} at {hz} Hz.", modes.len())
    });
    Some(Picture { file: file(result, ""), caption, svg: described(&svg, &seen) })
}

fn draw(area: &Area, modes: &[&ModeStatistics]) -> Result<(), Box<dyn Error>> {
    let ends = modes.iter().flat_map(|mode| mode.frequency_hz);
    let [low, high] =
        ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], hz| [low.min(hz), high.max(hz)]);
    let words = Words {
        below: Some("frequency [Hz]"),
        beside: "probability of instability [%]",
        across: &given,
        up: &given,
        labels: 10,
        decades: 0.0,
        grid: true,
    };
    let chart = labelled(area, (widened(low, high, 0.05), 0.0..118.0), &words)?;
    let mut order: Vec<usize> = (0..modes.len()).collect();
    order.sort_by(|a, b| modes[*b].unstable.share.total_cmp(&modes[*a].unstable.share));
    let mut labels = Labels::default();
    for (rank, k) in order.iter().enumerate() {
        let mode = modes[*k];
        let grows = mode.unstable.count > 0;
        let hex = if grows { ALARM } else { CALM };
        let line = Pen { opacity: 0.7, ..pen(hex, 1.5) };
        let place = (mode.mean_hz, 100.0 * mode.unstable.share);
        let [from, to] = mode.unstable.limits.map(|share| 100.0 * share);
        draw_curve(&chart, [(place.0, from), (place.0, to)], line)?;
        draw_curve(&chart, [(mode.frequency_hz[0], place.1), (mode.frequency_hz[2], place.1)], line)?;
        draw_dot(&chart, place, if grows { 5.0 } else { 3.5 }, hex)?;
        let (x, y) = chart.backend_coord(&place);
        if grows && rank < LABELS {
            let mark = chart.backend_coord(&(place.0, to)).1 + 4;
            label_unstable(area, &mut labels, (x, mark), &format!("{} Hz", hertz(mode.mean_hz, 0)))?;
        }
        let title =
            format!("mode {}: {} Hz, {}", k + 1, hertz(mode.mean_hz, 1), percent(mode.unstable.share));
        title_at(area, (x, y), &title)?;
    }
    Ok(())
}
