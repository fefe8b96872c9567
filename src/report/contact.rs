//! `contact.svg`: normal force and penetration of the contact points, open and closed: over the position along a line of points,
//! in plan view for a face; a table where the points are few.

use super::chart::{Area, bold, colour, sheet, text, widened};
use super::colours::{ALARM, CALM, INK, MEASURED, MUTED};
use super::contact_face;
use super::curve::{Pen, draw_curve, draw_dot, draw_ring, pen};
use super::format::{given, significant};
use super::readout::{axes_of, linear};
use super::section::Picture;
use super::table::ReportTable;
use super::view::{ViewVector, cross, dot, unit};
use crate::equilibrium::PointState;
use crate::results::{RunResults, SteadyResult};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;

const SIZE: (u32, u32) = (980, 560);
/// Fewer points are no curve: they stand in the table.
const FEWEST: usize = 5;

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

/// Pairs with their number of points.
fn counted(steady: &SteadyResult) -> impl Iterator<Item = (&str, usize)> {
    let points = |name: &str| steady.points.iter().filter(|(pair, _)| pair == name).count();
    steady.pairs.iter().map(move |(name, ..)| (name.as_str(), points(name)))
}

/// The picture of the first pair with enough points, when one of them is closed.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let steady = results.get::<SteadyResult>()?;
    let (name, _) = counted(steady).find(|(_, points)| *points >= FEWEST)?;
    let points = near_closed(steady, name);
    if points.is_empty() {
        return None;
    }
    if let Some(picture) = contact_face::picture(steady, name, &points) {
        return Some(picture);
    }
    let of_pair = steady.pairs.iter().zip(&steady.directions).find(|((pair, ..), _)| pair == name);
    let (marks, axis) = marks(&points, of_pair.map(|(_, [_, slide])| *slide));
    let svg = sheet(SIZE, |area| draw(area, &marks, axis))?;
    let edges = if marks.iter().any(|m| m.ahead) {
        " Circles: the edge that lies behind in the sliding direction; squares: the one ahead."
    } else {
        ""
    };
    let caption =
        format!("Contact “{name}” at steady sliding, near the closed points. Hollow marks are open.{edges}");
    Some(Picture { file: "contact".into(), caption, svg })
}

/// The points of all pairs with few; `None` where there are no such pairs.
pub(super) fn table(steady: &SteadyResult) -> Option<ReportTable> {
    let few: Vec<&str> = counted(steady).filter(|(_, n)| *n < FEWEST).map(|(name, _)| name).collect();
    let headings = ["<pair", "x [mm]", "y [mm]", "z [mm]", "N [N]", "F₁ [N]", "F₂ [N]", "δ [µm]", "<state"];
    let mut table = ReportTable::new("Contact points at steady sliding", &headings);
    for ((pair, place), state) in steady.points.iter().zip(&steady.state.points) {
        if !few.contains(&pair.as_str()) {
            continue;
        }
        let mut cells = vec![pair.clone()];
        cells.extend(place.map(|x| significant(1e3 * x, 4)));
        cells.push(significant(state.forces.normal, 4));
        cells.extend(state.forces.friction.map(|f| significant(f, 4)));
        cells.push(significant(1e6 * state.penetration, 4));
        cells.push(if state.closed() { "closed" } else { "open" }.into());
        table.row(cells, false);
    }
    (!table.rows.is_empty()).then(|| table.without_columns(super::table::idle))
}

/// A contact point at a place.
pub(super) type PlacedPoint<'a> = (ViewVector, &'a PointState);

const AXES: [(ViewVector, &str); 3] =
    [([0.0, 1.0, 0.0], "y"), ([1.0, 0.0, 0.0], "x"), ([0.0, 0.0, 1.0], "z")];

/// The largest and least place of the closed points along a direction.
fn span(points: &[PlacedPoint], direction: ViewVector) -> (f64, f64) {
    let along = points.iter().filter(|(_, s)| s.closed()).map(|(place, _)| dot(*place, direction));
    along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| (low.min(s), high.max(s)))
}

fn width(points: &[PlacedPoint], direction: ViewVector) -> f64 {
    let (low, high) = span(points, direction);
    high - low
}

/// The points of a pair near its closed ones: the far side of a rim, for one, says nothing.
fn near_closed<'a>(steady: &'a SteadyResult, pair: &str) -> Vec<PlacedPoint<'a>> {
    let of_pair = steady.points.iter().zip(&steady.state.points).filter(|((name, _), _)| name == pair);
    let all: Vec<PlacedPoint> = of_pair.map(|((_, place), state)| (*place, state)).collect();
    let reach = AXES.iter().map(|(direction, _)| width(&all, *direction)).fold(1e-3, f64::max);
    let near = |place: ViewVector| {
        AXES.iter().all(|(direction, _)| {
            let (low, high) = span(&all, *direction);
            (low - reach..=high + reach).contains(&dot(place, *direction))
        })
    };
    all.iter().copied().filter(|(place, _)| near(*place)).collect()
}

/// Points along a line or a rim, and the name of the axis they are drawn over.
fn marks(points: &[PlacedPoint], slide: Option<ViewVector>) -> (Vec<Mark>, String) {
    let longer = |best: (ViewVector, &'static str), a: (ViewVector, &'static str)| {
        if width(points, a.0) > width(points, best.0) { a } else { best }
    };
    let (axis, name) = AXES.into_iter().reduce(longer).expect("there are three");
    let edge =
        slide.and_then(|slide| edge_divider(slide, points.iter().map(|(place, _)| *place).collect(), axis));
    let mark = |(place, state): &PlacedPoint| Mark {
        place: 1e3 * dot(*place, axis),
        force: state.forces.normal,
        penetration: 1e6 * state.penetration,
        closed: state.closed(),
        ahead: edge.is_some_and(|(direction, middle)| dot(*place, direction) > middle),
    };
    (points.iter().map(mark).collect(), name.to_string())
}

/// The sliding direction and the place on it that parts the two edges of a rim, where the points lie on two edges.
fn edge_divider(slide: ViewVector, places: Vec<ViewVector>, axis: ViewVector) -> Option<(ViewVector, f64)> {
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
        draw_curve(&chart, [(across.start, 0.0), (across.end, 0.0)], pen(INK, 1.0))?;
        for mark in marks {
            let value = if k == 0 { mark.force } else { mark.penetration };
            let hex = match (mark.closed, mark.ahead) {
                (false, _) => CALM,
                (true, false) => ALARM,
                (true, true) => MEASURED,
            };
            let at = (mark.place, value);
            if k == 0 && mark.closed {
                draw_curve(&chart, [(mark.place, 0.0), at], Pen { opacity: 0.6, ..pen(hex, 3.0) })?;
            }
            if mark.ahead && value >= up.start {
                let (x, y) = chart.backend_coord(&at);
                let (x0, y0) = panel.get_base_pixel();
                let (x, y) = (x - x0, y - y0);
                let style = if mark.closed { colour(hex).filled() } else { colour(hex).stroke_width(2) };
                panel.draw(&Rectangle::new([(x - 4, y - 4), (x + 4, y + 4)], style))?;
            } else if mark.closed {
                draw_dot(&chart, at, 5.0, hex)?;
            } else {
                draw_ring(&chart, at, 5.0, (hex, 2.0))?;
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
        let (marks, axis) = marks(&near_closed(steady, "rim"), Some([1.0, 0.0, 0.0]));
        assert_eq!((marks.len(), axis.as_str()), (26, "y"));
        assert!((marks.iter().map(|m| m.force).sum::<f64>() - 20.0).abs() < 1e-12);
        assert_eq!(marks.iter().filter(|m| m.ahead).count(), 13);
        assert!(table(steady).is_none());
        let svg = picture(&results).unwrap().svg;
        assert!(svg.contains("ΣN = 20.00 N on 11 closed points of 26") && !svg.contains("NaN"));
    }

    #[test]
    fn few_points_are_a_table() {
        let mut results = sample::rig();
        let steady = results.get_mut::<SteadyResult>().unwrap();
        steady.points.truncate(3);
        steady.state.points.truncate(3);
        let listed = table(steady).unwrap();
        assert_eq!(listed.rows.len(), 3);
        let state = |k: usize| listed.rows[k].cells.last().unwrap().clone();
        let closed = steady.state.points[1].closed();
        assert_eq!(state(1), if closed { "closed" } else { "open" });
        assert!(picture(&results).is_none());
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
