//! `contact.svg`: normal force and penetration of the contact points, open and closed: over the position along a line of points,
//! on the faces of a body that touches with faces; a table where the points are few.

use super::chart::{Axis, Chart, WIDTH, ends, wide, widened};
use super::colours::{ALARM, CALM, INK, MEASURED};
use super::contact_face;
use super::format::significant;
use super::section::Picture;
use super::svg::{Sheet, fill, ink, sheer, stroke};
use super::table::ReportTable;
use super::view::{ViewVector, cross, dot, unit};
use crate::equilibrium::PointState;
use crate::results::{SteadyResult, file_name};

/// Fewer points are no curve: they stand in the table.
const FEWEST: usize = 5;

/// A contact point at a place.
type PlacedPoint<'a> = (ViewVector, &'a PointState);

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

/// A picture of every pair with enough points of which one is closed.
pub(super) fn pictures(steady: &SteadyResult, nodes: &[ViewVector]) -> Vec<Picture> {
    let enough = counted(steady).filter(|(_, points)| *points >= FEWEST);
    let mut pictures: Vec<(&str, Picture)> =
        enough.filter_map(|(name, _)| Some((name, picture(steady, name, nodes)?))).collect();
    if pictures.len() > 1 {
        pictures.iter_mut().for_each(|(name, picture)| picture.file = file_name("contact", name));
    }
    pictures.into_iter().map(|(_, picture)| picture).collect()
}

fn picture(steady: &SteadyResult, name: &str, nodes: &[ViewVector]) -> Option<Picture> {
    let points = near_closed(steady, name);
    if points.is_empty() {
        return None;
    }
    if let Some(picture) = contact_face::picture(steady, name, nodes) {
        return Some(picture);
    }
    let of_pair = steady.pairs.iter().zip(&steady.directions).find(|((pair, ..), _)| pair == name);
    let (marks, axis) = marks(&points, of_pair.map(|(_, [_, slide])| *slide));
    let svg = drawn(&marks, axis, &carried(&points));
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
    let states = steady.states();
    for (((pair, place), state), word) in steady.points.iter().zip(&steady.state.points).zip(states) {
        if !few.contains(&pair.as_str()) {
            continue;
        }
        let mut cells = vec![pair.clone()];
        cells.extend(place.map(|x| significant(1e3 * x, 4)));
        cells.push(significant(state.forces.normal, 4));
        cells.extend(state.forces.friction.map(|f| significant(f, 4)));
        cells.push(significant(1e6 * state.penetration, 4));
        cells.push(word.into());
        table.row(cells, false);
    }
    (!table.rows.is_empty()).then(|| table.without_columns(super::table::idle))
}

const AXES: [(ViewVector, &str); 3] =
    [([0.0, 1.0, 0.0], "y"), ([1.0, 0.0, 0.0], "x"), ([0.0, 0.0, 1.0], "z")];

/// The least and largest place of the closed points along a direction.
fn span(points: &[PlacedPoint], direction: ViewVector) -> [f64; 2] {
    ends(points.iter().filter(|(_, s)| s.closed()).map(|(place, _)| dot(*place, direction)))
}

fn width(points: &[PlacedPoint], direction: ViewVector) -> f64 {
    let [low, high] = span(points, direction);
    high - low
}

/// The points of a pair near its closed ones: the far side of a rim, for one, says nothing.
fn near_closed<'a>(steady: &'a SteadyResult, pair: &str) -> Vec<PlacedPoint<'a>> {
    let all = steady.points.iter().zip(&steady.state.points).filter(|((name, _), _)| name == pair);
    let all: Vec<PlacedPoint> = all.map(|((_, place), state)| (*place, state)).collect();
    let reach = AXES.iter().map(|(direction, _)| width(&all, *direction)).fold(1e-3, f64::max);
    let spans = AXES.map(|(direction, _)| (direction, span(&all, direction)));
    let near = |place: ViewVector| {
        spans
            .iter()
            .all(|(direction, [low, high])| (low - reach..=high + reach).contains(&dot(place, *direction)))
    };
    all.iter().copied().filter(|(place, _)| near(*place)).collect()
}

/// Points along a line or a rim, and the name of the axis they are drawn over.
fn marks(points: &[PlacedPoint], slide: Option<ViewVector>) -> (Vec<Mark>, &'static str) {
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
    (points.iter().map(mark).collect(), name)
}

/// The sliding direction and the place on it that parts the two edges of a rim, where the points lie on two edges.
fn edge_divider(slide: ViewVector, places: Vec<ViewVector>, axis: ViewVector) -> Option<(ViewVector, f64)> {
    let direction = unit(cross(cross(axis, slide), axis))?;
    let along: Vec<f64> = places.iter().map(|place| dot(*place, direction)).collect();
    let [low, high] = ends(along.iter().copied());
    let width = high - low;
    let at_an_edge = |s: &f64| (s - low).min(high - s) < 0.2 * width;
    (width > 0.0 && along.iter().all(at_an_edge)).then_some((direction, 0.5 * (low + high)))
}

/// The normal force of all points, and how many carry it.
fn carried(points: &[PlacedPoint]) -> String {
    let total: f64 = points.iter().map(|(_, state)| state.forces.normal).sum();
    let closed = points.iter().filter(|(_, state)| state.closed()).count();
    format!("ΣN = {} N on {closed} closed points of {}", significant(total, 4), points.len())
}

fn drawn(marks: &[Mark], axis: &str, words: &str) -> String {
    let span = |value: fn(&Mark) -> f64| ends(marks.iter().map(value));
    let across = |name: &str| Axis::new(name, widened(span(|m| m.place), 0.05));
    let force_top = span(|m| m.force)[1].max(f64::MIN_POSITIVE);
    let [shallowest, deepest] = span(|m| m.penetration);
    // Open points far away would flatten the closed ones.
    let shallowest = shallowest.max(-2.0 * deepest.abs()).min(0.0);
    let up = Axis::new("normal force [N]", 0.0..1.15 * force_top);
    let mut forces = Chart::new(wide(16.0, 222.0), across(""), up);
    let up = Axis::new("penetration δ [µm]", widened([shallowest, deepest.max(0.0)], 0.08));
    let below = format!("position {axis} along the contact [mm]");
    let mut depths = Chart::new(wide(264.0, 506.0), across(&below), up);
    for (k, chart) in [&mut forces, &mut depths].into_iter().enumerate() {
        chart.rule(1, 0.0, &stroke(INK, 1.0));
        for mark in marks {
            let hex = match (mark.closed, mark.ahead) {
                (false, _) => CALM,
                (true, false) => ALARM,
                (true, true) => MEASURED,
            };
            let at = [mark.place, [mark.force, mark.penetration][k]];
            if k == 0 && mark.closed {
                chart.line([[mark.place, 0.0], at], &sheer(stroke(hex, 3.0), 0.6));
            }
            let style = if mark.closed { fill(hex) } else { stroke(hex, 2.0) };
            match mark.ahead {
                true => chart.corners(at, &[[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]], &style),
                false => chart.circle(at, 5.0, &style),
            }
        }
    }
    let mut sheet = Sheet::new(WIDTH, 560.0);
    forces.draw(&mut sheet);
    depths.draw(&mut sheet);
    sheet.text([WIDTH - 34.0, 32.0], words, ink(13.5, INK).bold().end());
    sheet.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::job::sample;

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
        assert_eq!((marks.len(), axis), (14, "y"));
        assert!(within((marks.iter().map(|m| m.force).sum::<f64>() - 20.0).abs(), 1e-9, RoundOff));
        assert_eq!(marks.iter().filter(|m| m.ahead).count(), 7);
        assert!(table(steady).is_none());
        let svg = pictures(steady, &[])[0].svg.clone();
        assert!(svg.contains("ΣN = 20.00 N on 6 closed points of 14") && !svg.contains("NaN"));
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
        assert_eq!(state(1), if closed { "sliding" } else { "open" });
        assert!(pictures(steady, &[]).is_empty());
        steady.pairs[0].2 = 0.0;
        assert!(steady.states().all(|word| word != "sliding"));
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
        assert!(pictures(results.get::<SteadyResult>().unwrap(), &[]).is_empty());
    }
}
