//! `transient.svg`: motion, friction and penetration over time.

use crate::report::axes::{WIDTH, axes};
use crate::report::chart::{Area, colour, sheet, widened};
use crate::report::colours::{ALARM, SECOND};
use crate::report::format::{given, multiple};
use crate::report::section::Picture;
use crate::results::{Channel, RunResults, TransientResult};
use plotters::prelude::*;
use std::error::Error;

/// Motion and forces over time.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let run = results.get::<TransientResult>().filter(|run| run.len() > 1)?;
    let shown = panels(run);
    let svg = sheet((WIDTH, 180 * shown.len() as u32), |area| {
        let parts = area.split_evenly((shown.len(), 1));
        for (k, (part, channel)) in parts.iter().zip(&shown).enumerate() {
            let ink = if k == 0 { ALARM } else { SECOND };
            panel(part, channel, (run.len() - 1) as f64 * run.time_step, ink, k + 1 == shown.len())?;
        }
        Ok(())
    })?;
    let abouts: Vec<&str> = shown.iter().map(|channel| channel.about.as_str()).collect();
    let caption = format!("Motion in time ({}): {}.", run.scheme, abouts.join("; "));
    Some(Picture { file: "transient".into(), caption, svg })
}

/// The channels of the picture.
fn panels(run: &TransientResult) -> Vec<&Channel> {
    let named = |name: &str| run.channels.iter().find(|c| c.name == name);
    let varies = |c: &&Channel| c.range[0] != c.range[1];
    let sliding = run.channels.iter().find(|c| c.name.ends_with("_sliding_velocity")).filter(varies);
    let shown = run.shown.iter().map(|k| &run.channels[*k]);
    shown.chain(named("penetration")).chain(sliding).collect()
}

fn panel(area: &Area, channel: &Channel, end: f64, ink: &str, last: bool) -> Result<(), Box<dyn Error>> {
    let unit = multiple(channel.range[0].abs().max(channel.range[1].abs()), channel.unit);
    let [low, high] = channel.range.map(|v| v / unit.size);
    let below = last.then_some("time [s]");
    let ranges = (0.0..end, widened(low, high, 0.08));
    let mut chart = axes(area, ranges, below, &format!("{} [{}]", channel.words(), unit.unit), given)?;
    let points: Vec<(f64, f64)> = channel.line.iter().map(|(t, v)| (*t, v / unit.size)).collect();
    let line = PathElement::new(points, colour(ink).stroke_width(2));
    chart.draw_series([line])?;
    Ok(())
}
