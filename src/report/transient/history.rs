//! `transient.svg`: motion, friction and penetration over time.

use super::axes::{SIZE, axes, thinned};
use crate::report::chart::{Area, colour, sheet, widened};
use crate::report::colours::{ALARM, SECOND};
use crate::report::format::significant;
use crate::report::html::Picture;
use crate::results::{Channel, RunResults, TransientResult};
use plotters::prelude::*;
use std::error::Error;

/// Motion and forces over time.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let run = results.transient.as_ref().filter(|run| run.len() > 1)?;
    let svg = sheet(SIZE, |area| {
        let shown = panels(run);
        let parts = area.split_evenly((shown.len(), 1));
        for (k, (part, channel)) in parts.iter().zip(&shown).enumerate() {
            let ink = if k == 0 { ALARM } else { SECOND };
            panel(part, channel, run.time_step, ink, k + 1 == shown.len())?;
        }
        Ok(())
    })?;
    let motion = &run.channels[run.shown[0]].about;
    let caption = format!(
        "Motion in time from steady sliding ({}): {motion}; friction; penetration of the point that carries most.",
        run.scheme
    );
    Some(Picture { file: "transient.svg", caption, svg })
}

/// The channels of the picture.
fn panels(run: &TransientResult) -> Vec<&Channel> {
    let named = |name: &str| run.channels.iter().find(|c| c.name == name);
    let varies = |c: &&Channel| c.values.iter().any(|v| *v != c.values[0]);
    let sliding = run.channels.iter().find(|c| c.name.ends_with("_sliding_velocity")).filter(varies);
    let shown = run.shown.iter().map(|k| &run.channels[*k]);
    shown.chain(named("penetration")).chain(sliding).collect()
}

fn panel(area: &Area, channel: &Channel, step: f64, ink: &str, last: bool) -> Result<(), Box<dyn Error>> {
    let values = &channel.values;
    let (low, high) = values
        .iter()
        .filter(|v| v.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
    let end = (values.len() - 1) as f64 * step;
    let below = last.then_some("time [s]");
    let heading = channel.heading();
    let mut chart = axes(area, (0.0..end, widened(low, high, 0.08)), below, &heading, |v| significant(v, 3))?;
    let line = PathElement::new(thinned(values, step), colour(ink).stroke_width(2));
    chart.draw_series([line])?;
    Ok(())
}
