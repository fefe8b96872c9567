//! `transient_phase.svg`: velocity over displacement, and friction over slip, in the last periods.

use crate::report::axes::{Words, labelled};
use crate::report::chart::{Area, colour, sheet, widened};
use crate::report::colours::{ALARM, MUTED, SECOND};
use crate::report::format::{fixed, given, hertz, multiple};
use crate::report::section::Picture;
use crate::results::{PhaseCurve, RunResults, TransientResult};
use plotters::prelude::*;
use std::error::Error;

const SIZE: (u32, u32) = (980, 440);

/// The orbit of the motion and the one of the friction.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let run = results.get::<TransientResult>()?;
    let orbit = &run.diagnostics.orbit;
    let varies = |curve: &&PhaseCurve| curve.points.iter().any(|p| *p != curve.points[0]);
    let shown: Vec<&PhaseCurve> = orbit.curves.iter().filter(varies).collect();
    if shown.is_empty() {
        return None;
    }
    let svg = sheet(SIZE, |area| {
        for ((part, of), ink) in area.split_evenly((1, shown.len())).iter().zip(&shown).zip([ALARM, SECOND]) {
            curve(part, of, run, ink)?;
        }
        Ok(())
    })?;
    let second = if shown.len() > 1 {
        " Right: friction over the slip of the point that carries most; left of the line it slips backwards."
    } else {
        ""
    };
    let caption = format!(
        "The last {} periods of {} Hz: velocity over displacement.{second}",
        fixed(orbit.periods[0], 0),
        hertz(orbit.periods[1], 0)
    );
    Some(Picture { file: "transient_phase".into(), caption, svg })
}

fn curve(
    area: &Area,
    PhaseCurve { channels, points }: &PhaseCurve,
    run: &TransientResult,
    ink: &str,
) -> Result<(), Box<dyn Error>> {
    let axis = |k: usize| {
        let channel = &run.channels[channels[k]];
        let finite = || points.iter().map(|p| p[k]).filter(|v| v.is_finite());
        let unit = multiple(finite().map(f64::abs).fold(0.0, f64::max), channel.unit);
        let ends = [finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max)];
        let [low, high] = ends.map(|v| v / unit.size);
        (format!("{} [{}]", channel.words(), unit.unit), unit.size, widened(low, high, 0.08))
    };
    let [(below, wide, across), (beside, high, up)] = [axis(0), axis(1)];
    let words = Words {
        below: Some(&below),
        beside: &beside,
        across: &given,
        up: &given,
        labels: 5,
        decades: 0.0,
        grid: true,
    };
    let mut chart = labelled(area, (across.clone(), up.clone()), &words)?;
    if across.contains(&0.0) {
        let line = [(0.0, up.start), (0.0, up.end)];
        chart.draw_series([PathElement::new(line, colour(MUTED).stroke_width(1))])?;
    }
    let path: Vec<(f64, f64)> = points.iter().map(|[x, y]| (x / wide, y / high)).collect();
    chart.draw_series([PathElement::new(path, colour(ink).stroke_width(1))])?;
    Ok(())
}
