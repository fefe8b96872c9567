//! Plan view of the contact points on a face: normal force as colour and size.

use super::chart::{Area, bold, colour, sheet, text, widened};
use super::colours::{CALM, INK, MUTED, sequential};
use super::curve::{LinearChart, draw_dot, draw_ring};
use super::format::{given, significant};
use super::readout::{axes_of, linear, title_at};
use super::section::Picture;
use super::view::{ViewVector, cross, dot, unit};
use crate::equilibrium::PointState;
use crate::results::SteadyResult;
use plotters::prelude::*;
use std::cmp::Ordering;
use std::error::Error;

const SIZE: (u32, u32) = (980, 560);
/// Points whose second extent is less than this part of the first lie on a line.
const LINE: f64 = 0.1;
/// Points on fewer lines across are the edges of a rim.
const LINES: usize = 3;
/// Largest and least radius of a closed point \[px\].
const RADII: [f64; 2] = [13.0, 4.0];

/// A contact point: place along and across the sliding direction \[mm\], and its state.
type FacePoint<'a> = ([f64; 2], &'a PointState);

/// The picture, when these points of the pair lie on a face.
pub(super) fn picture(
    steady: &SteadyResult,
    pair: &str,
    near: &[(ViewVector, &PointState)],
) -> Option<Picture> {
    let ((.., velocity), [press, slide]) =
        steady.pairs.iter().zip(&steady.directions).find(|((name, ..), _)| name == pair)?;
    let along = unit(*slide)?;
    let across = unit(cross(*press, along))?;
    let at = |place: ViewVector| [1e3 * dot(place, along), 1e3 * dot(place, across)];
    let points: Vec<FacePoint> = near.iter().map(|(place, state)| (at(*place), *state)).collect();
    let extents = [0, 1].map(|c| {
        let (low, high) = span(&points, c);
        high - low
    });
    let (short, long) = (extents[0].min(extents[1]), extents[0].max(extents[1]));
    let edges = lines(&points, if extents[0] < extents[1] { 0 } else { 1 }) < LINES;
    let finite = points.iter().all(|(place, _)| place.iter().all(|c| c.is_finite()));
    if !finite || short < LINE * long || edges {
        return None;
    }
    let svg = sheet(SIZE, |area| draw(area, &points, extents))?;
    let slides = match velocity.total_cmp(&0.0) {
        Ordering::Greater => " The counter-body slides to the right.",
        Ordering::Less => " The counter-body slides to the left.",
        Ordering::Equal => "",
    };
    let caption = format!(
        "Contact “{pair}” at steady sliding, seen along the normal: the larger and darker a point, the larger its normal force; \
         hollow points are open.{slides}"
    );
    Some(Picture { file: "contact".into(), caption, svg })
}

fn span(points: &[FacePoint], c: usize) -> (f64, f64) {
    points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), (p, _)| (l.min(p[c]), h.max(p[c])))
}

/// The number of different coordinates `c`, which differ by a hundredth of the extent.
fn lines(points: &[FacePoint], c: usize) -> usize {
    let (low, high) = span(points, c);
    let mut at: Vec<f64> = points.iter().map(|(p, _)| p[c]).collect();
    at.sort_by(f64::total_cmp);
    1 + at.windows(2).filter(|pair| pair[1] - pair[0] > 0.01 * (high - low)).count()
}

fn draw(area: &Area, points: &[FacePoint], extents: [f64; 2]) -> Result<(), Box<dyn Error>> {
    let (main, bar) = area.split_horizontally(SIZE.0 - 150);
    // The same scale along both axes.
    let plot = [f64::from(SIZE.0) - 150.0 - 108.0, f64::from(SIZE.1) - 82.0];
    let scale = (1.15 * extents[0] / plot[0]).max(1.15 * extents[1] / plot[1]);
    let range = |c: usize| {
        let (low, high) = span(points, c);
        let middle = 0.5 * (low + high);
        widened(middle - 0.5 * scale * plot[c], middle + 0.5 * scale * plot[c], 0.0)
    };
    let mut chart = ChartBuilder::on(&main)
        .margin(14)
        .x_label_area_size(50)
        .y_label_area_size(74)
        .build_cartesian_2d(range(0), range(1))?;
    let names = ["position along the sliding direction [mm]", "position across [mm]"];
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(colour("#e6e9ed"))
        .axis_style(colour(MUTED))
        .label_style(text(13.0, INK))
        .axis_desc_style(text(14.0, INK))
        .x_desc(names[0])
        .y_desc(names[1])
        .x_label_formatter(&|v| given(*v))
        .y_label_formatter(&|v| given(*v))
        .draw()?;
    axes_of(&main, &chart, names.map(linear))?;
    let largest = points.iter().map(|(_, s)| s.forces.normal).fold(f64::MIN_POSITIVE, f64::max);
    for (place, state) in points {
        draw_point(&chart, *place, state, largest)?;
        let words = format!(
            "N {} N, δ {} µm",
            significant(state.forces.normal, 4),
            significant(1e6 * state.penetration, 4)
        );
        title_at(&main, chart.backend_coord(&(place[0], place[1])), &words)?;
    }
    let total: f64 = points.iter().map(|(_, s)| s.forces.normal).sum();
    let closed = points.iter().filter(|(_, s)| s.closed()).count();
    let sum = format!("ΣN = {} N on {closed} closed points of {}", significant(total, 4), points.len());
    main.draw_text(&sum, &bold(13.5, INK), (100, 18))?;
    draw_bar(&bar, largest)
}

/// The area of a closed point goes with its force.
fn draw_point(
    chart: &LinearChart,
    [x, y]: [f64; 2],
    state: &PointState,
    largest: f64,
) -> Result<(), Box<dyn Error>> {
    if !state.closed() {
        return draw_ring(chart, (x, y), RADII[1], (CALM, 1.5));
    }
    let part = (state.forces.normal / largest).clamp(0.0, 1.0);
    let radius = (RADII[0] * part.sqrt()).max(RADII[1]);
    draw_dot(chart, (x, y), radius, &shade(part))?;
    draw_ring(chart, (x, y), radius, (MUTED, 0.7))
}

/// Not white for a small force.
fn shade(part: f64) -> String {
    sequential(0.15 + 0.7 * part)
}

/// The colours with their values.
fn draw_bar(bar: &Area, largest: f64) -> Result<(), Box<dyn Error>> {
    const TOP: i32 = 50;
    const HEIGHT: i32 = 400;
    const STEPS: i32 = 80;
    bar.draw_text("normal force [N]", &bold(12.5, INK), (10, 20))?;
    for k in 0..STEPS {
        let part = 1.0 - (f64::from(k) + 0.5) / f64::from(STEPS);
        let corners = [(10, TOP + HEIGHT * k / STEPS), (32, TOP + HEIGHT * (k + 1) / STEPS)];
        bar.draw(&Rectangle::new(corners, colour(&shade(part)).filled()))?;
    }
    for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let y = TOP + (f64::from(HEIGHT) * (1.0 - part)) as i32;
        bar.draw_text(&significant(part * largest, 3), &text(12.5, INK), (40, y - 7))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::sample;

    #[test]
    fn a_face_is_seen_from_above_and_a_rim_is_not() {
        let mut results = sample::rig();
        let steady = results.get_mut::<SteadyResult>().unwrap();
        let seen = |steady: &SteadyResult| {
            let places = steady.points.iter().zip(&steady.state.points);
            picture(steady, "rim", &places.map(|((_, place), state)| (*place, state)).collect::<Vec<_>>())
        };
        assert!(seen(steady).is_none(), "two edges");
        for (k, (_, place)) in steady.points.iter_mut().enumerate() {
            *place = [1e-3 * (k % 5) as f64, 1e-3 * (k / 5) as f64, 0.0];
        }
        let svg = seen(steady).unwrap().svg;
        let closed = steady.state.points.iter().filter(|p| p.closed()).count();
        assert!(svg.contains("ΣN = 20.00 N on 11 closed points of 26") && !svg.contains("NaN"));
        // Titles, closed points with an outline each, open ones.
        assert_eq!(svg.matches("<circle").count(), 26 + 26 + closed);
    }
}
