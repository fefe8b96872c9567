//! `contact.svg`: normal force and penetration of the contact points along the contact, open and closed.

use super::chart::{Area, bold, colour, sheet, text, widened};
use super::colours::{ALARM, CALM, INK, MEASURED, MUTED};
use super::format::{given, significant};
use super::readout::{axes_of, linear};
use super::section::Picture;
use super::view::{ViewVector, cross, dot, unit};
use crate::results::{RunResults, SteadyResult};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;

const SIZE: (u32, u32) = (980, 560);

/// A contact point on the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Mark {
    /// Place along the contact \[mm\].
    place: f64,
    /// Normal force \[N\].
    force: f64,
    /// δ \[µm\].
    penetration: f64,
    closed: bool,
    /// On the edge that lies ahead in the sliding direction.
    ahead: bool,
}

/// The picture, when the first pair has a closed point.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let steady = results.get::<SteadyResult>()?;
    let (marks, axis) = marks(steady)?;
    let svg = sheet(SIZE, |area| draw(area, &marks, axis))?;
    let (name, ..) = steady.pairs.first()?;
    let edges = if marks.iter().any(|m| m.ahead) {
        " Circles: the edge that lies behind in the sliding direction; squares: the one ahead."
    } else {
        ""
    };
    let caption =
        format!("Contact “{name}” at steady sliding, near the closed points. Hollow marks are open.{edges}");
    Some(Picture { file: "contact".into(), caption, svg })
}

/// The points of the first pair near its closed ones, and the name of the axis they are drawn over.
fn marks(steady: &SteadyResult) -> Option<(Vec<Mark>, String)> {
    let (pair, ..) = steady.pairs.first()?;
    let all = || steady.points.iter().zip(&steady.state.points).filter(|((name, _), _)| name == pair);
    let closed: Vec<ViewVector> =
        all().filter(|(_, state)| state.closed()).map(|((_, place), _)| *place).collect();
    let span = |direction: ViewVector| {
        let along = closed.iter().map(|place| dot(*place, direction));
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| (low.min(s), high.max(s)))
    };
    let width = |direction: ViewVector| span(direction).1 - span(direction).0;
    let axes = [([0.0, 1.0, 0.0], "y"), ([1.0, 0.0, 0.0], "x"), ([0.0, 0.0, 1.0], "z")];
    let (axis, name) =
        axes.into_iter().reduce(|best, a| if width(a.0) > width(best.0) { a } else { best })?;
    // Points farther than this from the closed ones say nothing: the far side of a rim, for one.
    let reach = axes.iter().map(|(direction, _)| width(*direction)).fold(1e-3, f64::max);
    let near = |place: ViewVector| {
        axes.iter().all(|(direction, _)| {
            let (low, high) = span(*direction);
            (low - reach..=high + reach).contains(&dot(place, *direction))
        })
    };
    let edge = edge_divider(steady, all().map(|((_, place), _)| *place).filter(|p| near(*p)).collect(), axis);
    let mark = |place: ViewVector, state: &crate::equilibrium::PointState| Mark {
        place: 1e3 * dot(place, axis),
        force: state.forces.normal,
        penetration: 1e6 * state.penetration,
        closed: state.closed(),
        ahead: edge.is_some_and(|(direction, middle)| dot(place, direction) > middle),
    };
    let marks: Vec<Mark> =
        all().filter(|((_, place), _)| near(*place)).map(|((_, place), state)| mark(*place, state)).collect();
    (!closed.is_empty()).then(|| (marks, name.to_string()))
}

/// The sliding direction and the place on it that parts the two edges of a rim, where the points lie on two edges.
fn edge_divider(
    steady: &SteadyResult,
    places: Vec<ViewVector>,
    axis: ViewVector,
) -> Option<(ViewVector, f64)> {
    let [_, slide] = *steady.directions.first()?;
    let direction = unit(cross(cross(axis, slide), axis))?;
    let along: Vec<f64> = places.iter().map(|place| dot(*place, direction)).collect();
    let (low, high) =
        along.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), s| (l.min(*s), h.max(*s)));
    let width = high - low;
    let at_an_edge = |s: &f64| (s - low).min(high - s) < 0.2 * width;
    (width > 0.0 && along.iter().all(at_an_edge)).then_some((direction, 0.5 * (low + high)))
}

fn draw(area: &Area, marks: &[Mark], axis: String) -> Result<(), Box<dyn Error>> {
    let span = |value: fn(&Mark) -> f64| {
        let values = marks.iter().map(value).filter(|v| v.is_finite());
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    };
    let (left, right) = span(|m| m.place);
    let across = widened(left, right, 0.05);
    let (upper, lower) = area.split_vertically(SIZE.1 * 48 / 100);
    let force_top = span(|m| m.force).1.max(f64::MIN_POSITIVE);
    let deepest = span(|m| m.penetration).1;
    // Open points far away would flatten the closed ones.
    let shallowest = span(|m| m.penetration).0.max(-2.0 * deepest.abs()).min(0.0);
    let panels = [
        (upper, "normal force [N]", 0.0..1.15 * force_top, 34),
        (lower, "penetration δ [µm]", widened(shallowest, deepest.max(0.0), 0.08), 56),
    ];
    for (k, (panel, title, up, foot)) in panels.into_iter().enumerate() {
        let mut chart = ChartBuilder::on(&panel)
            .margin(14)
            .margin_right(22)
            .x_label_area_size(foot)
            .y_label_area_size(78)
            .build_cartesian_2d(across.clone(), up.clone())?;
        let described =
            if k == 1 { format!("position {axis} along the contact [mm]") } else { String::new() };
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(colour("#e6e9ed"))
            .axis_style(colour(MUTED))
            .label_style(text(13.0, INK))
            .axis_desc_style(text(14.0, INK))
            .x_desc(&described)
            .y_desc(title)
            .x_labels(12)
            .y_labels(6)
            .x_label_formatter(&|v| given(*v))
            .y_label_formatter(&|v| given(*v))
            .draw()?;
        axes_of(&panel, &chart, [linear(&described), linear(title)])?;
        let zero = PathElement::new([(across.start, 0.0), (across.end, 0.0)], colour(INK).stroke_width(1));
        chart.draw_series([zero])?;
        for mark in marks {
            let value = if k == 0 { mark.force } else { mark.penetration };
            if value < up.start {
                continue;
            }
            let hex = match (mark.closed, mark.ahead) {
                (false, _) => CALM,
                (true, false) => ALARM,
                (true, true) => MEASURED,
            };
            if k == 0 && mark.closed {
                let stem = PathElement::new(
                    [(mark.place, 0.0), (mark.place, value)],
                    colour(hex).mix(0.6).stroke_width(3),
                );
                chart.draw_series([stem])?;
            }
            let style = if mark.closed { colour(hex).filled() } else { colour(hex).stroke_width(2) };
            if mark.ahead {
                let (x, y) = chart.backend_coord(&(mark.place, value));
                let (x0, y0) = panel.get_base_pixel();
                let (x, y) = (x - x0, y - y0);
                panel.draw(&Rectangle::new([(x - 4, y - 4), (x + 4, y + 4)], style))?;
            } else {
                chart.draw_series([Circle::new((mark.place, value), 5, style)])?;
            }
        }
        if k == 0 {
            let total: f64 = marks.iter().map(|m| m.force).sum();
            let closed = marks.iter().filter(|m| m.closed).count();
            let label =
                format!("ΣN = {} N on {closed} closed points of {}", significant(total, 4), marks.len());
            let style = bold(13.5, INK).pos(Pos::new(HPos::Right, VPos::Top));
            panel.draw_text(&label, &style, (SIZE.0 as i32 - 34, 20))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::sample;

    #[test]
    fn the_marks_carry_the_load_and_know_their_edge() {
        let mut results = sample::rig();
        let steady = results.get_mut::<SteadyResult>().unwrap();
        // The far side of the rim is part of the pair and not of the picture.
        steady.points.push(("rim".into(), [0.0, 0.0, 0.15]));
        let mut far = steady.state.points[0];
        far.penetration = -0.15;
        far.forces.normal = 0.0;
        steady.state.points.push(far);
        let (marks, axis) = marks(steady).unwrap();
        assert_eq!((marks.len(), axis.as_str()), (26, "y"));
        assert!((marks.iter().map(|m| m.force).sum::<f64>() - 20.0).abs() < 1e-12);
        assert_eq!(marks.iter().filter(|m| m.ahead).count(), 13);
        let svg = picture(&results).unwrap().svg;
        assert!(svg.contains("ΣN = 20.00 N on 11 closed points of 26") && !svg.contains("NaN"));
    }

    #[test]
    fn an_open_contact_has_no_picture() {
        let mut results = sample::rig();
        results
            .get_mut::<SteadyResult>()
            .unwrap()
            .state
            .points
            .iter_mut()
            .for_each(|p| p.forces.normal = 0.0);
        assert!(picture(&results).is_none());
    }
}
