//! `transient_phase.svg`: velocity over displacement, and friction over slip, in the last periods.

use crate::report::chart::{Axis, Chart, WIDTH, ends, widened};
use crate::report::colours::{ALARM, MUTED, SECOND};
use crate::report::format::{fixed, hertz, multiple};
use crate::report::section::Picture;
use crate::report::svg::{Sheet, stroke};
use crate::results::{PhaseCurve, RunResults, TransientResult};

/// The orbit of the motion and the one of the friction.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let run = results.get::<TransientResult>()?;
    let orbit = &run.diagnostics.orbit;
    let varies = |curve: &&PhaseCurve| curve.points.iter().any(|p| *p != curve.points[0]);
    let shown: Vec<&PhaseCurve> = orbit.curves.iter().filter(varies).collect();
    if shown.is_empty() {
        return None;
    }
    let mut sheet = Sheet::new(WIDTH, 440.0);
    for ((k, curve), ink) in shown.iter().enumerate().zip([ALARM, SECOND]) {
        let width = WIDTH / shown.len() as f64;
        let left = width * k as f64;
        draw(&mut sheet, [left + 104.0, 10.0, left + width - 22.0, 388.0], curve, run, ink);
    }
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
    Some(Picture { file: "transient_phase".into(), caption, svg: sheet.finish() })
}

fn draw(
    sheet: &mut Sheet,
    area: [f64; 4],
    PhaseCurve { channels, points }: &PhaseCurve,
    run: &TransientResult,
    ink: &str,
) {
    let [(across, wide), (up, high)] = [0, 1].map(|k| {
        let channel = &run.channels[channels[k]];
        let [low, high] = ends(points.iter().map(|p| p[k]));
        let unit = multiple(low.abs().max(high.abs()), channel.unit);
        let range = widened([low / unit.size, high / unit.size], 0.08);
        (Axis::new(format!("{} [{}]", channel.words(), unit.unit), range), unit.size)
    });
    let mut chart = Chart::new(area, across, up);
    chart.rule(0, 0.0, &stroke(MUTED, 1.0));
    chart.line(points.iter().map(|[x, y]| [x / wide, y / high]), &stroke(ink, 1.0));
    chart.draw(sheet);
}
