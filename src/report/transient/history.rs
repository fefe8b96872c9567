//! `transient.svg`: motion, friction and penetration over time.

use crate::report::chart::{Axis, Chart, WIDTH, wide, widened};
use crate::report::colours::{ALARM, SECOND};
use crate::report::format::multiple;
use crate::report::section::Picture;
use crate::report::svg::{Sheet, stroke};
use crate::results::{Channel, RunResults, TransientResult};

/// Motion and forces over time.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let run = results.get::<TransientResult>().filter(|run| run.len() > 1)?;
    let shown = panels(run);
    let mut sheet = Sheet::new(WIDTH, 170.0 * shown.len() as f64 + 22.0);
    for (k, channel) in shown.iter().enumerate() {
        let size = channel.range[0].abs().max(channel.range[1].abs());
        let unit = multiple(size, channel.unit);
        let up = widened(channel.range.map(|v| v / unit.size), 0.08);
        let up = Axis::new(format!("{} [{}]", channel.words(), unit.unit), up);
        let below = if k + 1 == shown.len() { "time [s]" } else { "" };
        let across = Axis::new(below, 0.0..(run.len() - 1) as f64 * run.time_step);
        let top = 10.0 + 170.0 * k as f64;
        let mut chart = Chart::new(wide(top, top + 128.0), across, up);
        let ink = if k == 0 { ALARM } else { SECOND };
        chart.line(channel.line.iter().map(|(t, v)| [*t, v / unit.size]), &stroke(ink, 2.0));
        chart.draw(&mut sheet);
    }
    let abouts: Vec<&str> = shown.iter().map(|channel| channel.about.as_str()).collect();
    let caption = format!("Motion in time ({}): {}.", run.scheme, abouts.join("; "));
    Some(Picture { file: "transient".into(), caption, svg: sheet.finish() })
}

/// The channels of the picture.
fn panels(run: &TransientResult) -> Vec<&Channel> {
    let named = |name: &str| run.channels.iter().find(|c| c.name == name);
    let varies = |c: &&Channel| c.range[0] != c.range[1];
    let sliding = run.channels.iter().find(|c| c.name.ends_with("_sliding_velocity")).filter(varies);
    let shown = run.shown.iter().map(|k| &run.channels[*k]);
    shown.chain(named("penetration")).chain(sliding).collect()
}
