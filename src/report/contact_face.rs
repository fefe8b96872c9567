//! Plan view of the contact points on a face: pressure, or normal force where the points stand for no area, as colour and size.

use super::chart::{Axis, Chart, WIDTH, ends, widened};
use super::colours::{CALM, INK, MUTED, sequential};
use super::format::significant;
use super::section::Picture;
use super::svg::{Sheet, fill, ink, outlined, stroke};
use super::view::{ViewVector, cross, dot, unit};
use crate::equilibrium::PointState;
use crate::results::SteadyResult;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Left, upper, right, lower edge of the part between the axes \[px\].
const AREA: [f64; 4] = [94.0, 14.0, 816.0, 496.0];
/// Points whose second extent is less than this part of the first lie on a line.
const LINE: f64 = 0.1;
/// Points on fewer lines across are the edges of a rim.
const LINES: usize = 3;
/// Largest and least radius of a closed point \[px\].
const RADII: [f64; 2] = [13.0, 4.0];

/// More points are squares of their areas, without titles.
const SINGLE: usize = 150;
/// More squares than this are joined.
const MOST: usize = 6000;
/// Steps of the colours of squares, and the factor from one size to the next.
const SHADES: f64 = 24.0;
const SIZES: f64 = 1.15;
/// The colour of an open square.
const OPEN: &str = "#dfe4ea";

/// A contact point on the picture.
struct FacePoint<'a> {
    /// On the two axes \[mm\].
    place: [f64; 2],
    state: &'a PointState,
    /// Pressure \[MPa\] or normal force \[N\].
    value: f64,
    /// \[mm²\].
    area: Option<f64>,
}

/// A contact point at a place, with the area that it stands for \[m²\].
pub(super) type PlacedPoint<'a> = (ViewVector, &'a PointState, Option<f64>);

/// What colours and sizes show.
#[derive(Clone, Copy)]
struct Shown {
    name: &'static str,
    short: &'static str,
    unit: &'static str,
}

const FORCE: Shown = Shown { name: "normal force", short: "N", unit: "N" };
const PRESSURE: Shown = Shown { name: "pressure", short: "p", unit: "MPa" };

/// The normal force of all points, and how many carry it.
pub(super) fn carried(points: &[PlacedPoint]) -> String {
    let total: f64 = points.iter().map(|(_, state, _)| state.forces.normal).sum();
    let closed = points.iter().filter(|(_, state, _)| state.closed()).count();
    format!("ΣN = {} N on {closed} closed points of {}", significant(total, 4), points.len())
}

/// The picture, when these points of the pair lie on a face.
pub(super) fn picture<'a>(steady: &SteadyResult, pair: &str, near: &[PlacedPoint<'a>]) -> Option<Picture> {
    let ((.., velocity), [press, slide]) =
        steady.pairs.iter().zip(&steady.directions).find(|((name, ..), _)| name == pair)?;
    let along = unit(*slide)?;
    let across = unit(cross(*press, along))?;
    // Along an axis of the mesh places are those of the mesh.
    let (names, [along, across], to_the_right) = axes(along, across);
    let at = |place: ViewVector| [1e3 * dot(place, along), 1e3 * dot(place, across)];
    // Pressure, where every point has an area.
    let shown = if near.iter().all(|(.., area)| area.is_some()) { PRESSURE } else { FORCE };
    let point = |(place, state, area): &PlacedPoint<'a>| {
        let area = area.map(|area| 1e6 * area);
        let value = match area {
            Some(area) if shown.unit == PRESSURE.unit => state.forces.normal / area,
            _ => state.forces.normal,
        };
        FacePoint { place: at(*place), state, value, area }
    };
    let points: Vec<FacePoint> = near.iter().map(point).collect();
    let extents = [0, 1].map(|c| {
        let [low, high] = span(&points, c);
        high - low
    });
    let (short, long) = (extents[0].min(extents[1]), extents[0].max(extents[1]));
    let edges = lines(&points, if extents[0] < extents[1] { 0 } else { 1 }) < LINES;
    let finite = points.iter().all(|point| point.place.iter().all(|c| c.is_finite()));
    if !finite || short < LINE * long || edges {
        return None;
    }
    let svg = drawn(&points, extents, &names, shown, &carried(near));
    let slides = match (to_the_right * velocity).total_cmp(&0.0) {
        Ordering::Greater => "The counter-body slides to the right.",
        Ordering::Less => "The counter-body slides to the left.",
        Ordering::Equal => "Nothing slides: closed points stick.",
    };
    let marks = match points.len() > SINGLE {
        true => format!("a square is the area of a point, the darker, the larger its {}", shown.name),
        false => {
            format!("the larger and darker a point, the larger its {}; hollow points are open", shown.name)
        }
    };
    let caption = format!("Contact “{pair}” at steady sliding, seen along the normal: {marks}. {slides}");
    Some(Picture { file: "contact".into(), caption, svg })
}

/// Names of the axes along and across, their directions, and 1 where the first shows along the sliding direction, −1 where against it:
/// directions along an axis of the mesh are turned to its positive side and have its name.
fn axes(along: ViewVector, across: ViewVector) -> ([String; 2], [ViewVector; 2], f64) {
    let named = |direction: ViewVector, what: &str| {
        let axis = (0..3).find(|k| direction[*k].abs() > 1.0 - 1e-9);
        match axis {
            Some(k) => {
                let mut positive = [0.0; 3];
                positive[k] = 1.0;
                (format!("{} [mm], {what}", ["x", "y", "z"][k]), positive, direction[k].signum())
            }
            None => (format!("position {what} [mm]"), direction, 1.0),
        }
    };
    let (first, right, sign) = named(along, "along the sliding direction");
    let (second, up, _) = named(across, "across");
    ([first, second], [right, up], sign)
}

fn span(points: &[FacePoint], c: usize) -> [f64; 2] {
    ends(points.iter().map(|point| point.place[c]))
}

/// The number of different coordinates `c`, which differ by a hundredth of the extent.
fn lines(points: &[FacePoint], c: usize) -> usize {
    let [low, high] = span(points, c);
    let mut at: Vec<f64> = points.iter().map(|point| point.place[c]).collect();
    at.sort_by(f64::total_cmp);
    let mut first = f64::NEG_INFINITY;
    let apart = |x: &&f64| {
        let new = **x - first > 0.01 * (high - low);
        first = if new { **x } else { first };
        new
    };
    at.iter().filter(apart).count()
}

fn drawn(points: &[FacePoint], extents: [f64; 2], names: &[String; 2], shown: Shown, words: &str) -> String {
    // The same scale along both axes.
    let plot = [AREA[2] - AREA[0], AREA[3] - AREA[1]];
    let scale = (1.15 * extents[0] / plot[0]).max(1.15 * extents[1] / plot[1]);
    let [across, up] = [0, 1].map(|c| {
        let [low, high] = span(points, c);
        let (middle, half) = (0.5 * (low + high), 0.5 * scale * plot[c]);
        Axis::new(&names[c], widened([middle - half, middle + half], 0.0))
    });
    let mut chart = Chart::new(AREA, across, up);
    let largest = points.iter().map(|point| point.value).fold(f64::MIN_POSITIVE, f64::max);
    if points.len() > SINGLE {
        squares(&mut chart, points, scale, largest);
    } else {
        points.iter().for_each(|point| single(&mut chart, point, shown, largest));
    }
    let mut sheet = Sheet::new(WIDTH, 560.0);
    chart.draw(&mut sheet);
    sheet.text([106.0, 32.0], words, ink(13.5, INK).bold());
    sheet.text([840.0, 32.0], &format!("{} [{}]", shown.name, shown.unit), ink(12.5, INK).bold());
    let ticks = [0.0, 0.25, 0.5, 0.75, 1.0].map(|part| (part, significant(part * largest, 3)));
    sheet.colour_bar([840.0, 50.0], 400.0, shade, ticks);
    sheet.rectangle(
        [840.0, 466.0],
        [22.0, 14.0],
        &if points.len() > SINGLE { fill(OPEN) } else { stroke(CALM, 1.5) },
    );
    sheet.text([872.0, 478.0], "open", ink(12.5, INK));
    sheet.finish()
}

/// A point by itself, with what it carries under the pointer.
fn single(chart: &mut Chart, point: &FacePoint, shown: Shown, largest: f64) {
    // The area of a closed point goes with its value.
    let part = (point.value / largest).clamp(0.0, 1.0);
    match point.state.closed() {
        true => {
            let radius = (RADII[0] * part.sqrt()).max(RADII[1]);
            chart.circle(point.place, radius, &outlined(&shade(part), MUTED, 0.7));
        }
        false => chart.circle(point.place, RADII[1], &stroke(CALM, 1.5)),
    }
    let [value, depth] = [point.value, 1e6 * point.state.penetration].map(|v| significant(v, 4));
    chart.title(point.place, &format!("{} {value} {}, δ {depth} µm", shown.short, shown.unit));
}

/// Many points as squares of their areas, `scale` mm a pixel: one path for each colour and size. Beyond [`MOST`] those in one cell of a
/// grid are one, with their mean.
fn squares(chart: &mut Chart, points: &[FacePoint], scale: f64, largest: f64) {
    let plot = (AREA[2] - AREA[0]) * (AREA[3] - AREA[1]);
    let grid = scale * (plot / MOST as f64).sqrt();
    // Without areas, all have the same.
    let [wide, high] = [0, 1].map(|c| ends(points.iter().map(|point| point.place[c]))).map(|[a, b]| b - a);
    let each = wide * high / points.len() as f64;
    let mut cells: BTreeMap<[i64; 2], ([f64; 2], f64, f64, bool)> = BTreeMap::new();
    for (k, point) in points.iter().enumerate() {
        let key = match points.len() > MOST {
            true => point.place.map(|x| (x / grid).floor() as i64),
            false => [k as i64, 0],
        };
        let area = point.area.unwrap_or(each);
        let cell = cells.entry(key).or_insert(([0.0; 2], 0.0, 0.0, false));
        cell.0.iter_mut().zip(point.place).for_each(|(sum, x)| *sum += area * x);
        cell.1 += area;
        cell.2 += area * point.value;
        cell.3 |= point.state.closed();
    }
    let mut classes: BTreeMap<(Option<usize>, i64), Vec<[f64; 2]>> = BTreeMap::new();
    for (sum, area, value, closed) in cells.into_values().filter(|cell| cell.1 > 0.0) {
        let part = (value / area / largest).clamp(0.0, 1.0);
        let side = (area.sqrt() / scale).max(1.0);
        let class =
            (closed.then(|| (part * SHADES).round() as usize), (side.ln() / SIZES.ln()).ceil() as i64);
        classes.entry(class).or_default().push(sum.map(|x| x / area));
    }
    for ((level, size), points) in classes {
        let hex = level.map_or(OPEN.to_string(), |level| shade(level as f64 / SHADES));
        chart.squares(points, SIZES.powi(size as i32), &hex);
    }
}

/// Not white for a small force.
fn shade(part: f64) -> String {
    sequential(0.15 + 0.7 * part)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;

    fn placed(steady: &SteadyResult) -> Vec<PlacedPoint<'_>> {
        let places = steady.points.iter().zip(&steady.state.points).zip(&steady.areas);
        places.map(|(((_, place), state), area)| (*place, state, *area)).collect()
    }

    /// 40,000 points in a picture as small as one of a few thousand: their pressures have the colours of their means, the open half is grey.
    #[test]
    fn many_points_are_squares_in_a_small_picture() {
        let results = sample::rig();
        let steady = results.get::<SteadyResult>().unwrap();
        let mut state = steady.state.points[0];
        let mut svgs = Vec::new();
        for side in [20, 200] {
            let states: Vec<PointState> = (0..side * side)
                .map(|k| {
                    // N = p A with p = 2 MPa.
                    state.forces.normal =
                        if k % side < side / 2 { 0.0 } else { 2.0 * 1e4 / (side * side) as f64 };
                    state
                })
                .collect();
            let at = |k: usize| 0.1 / side as f64 * k as f64;
            let points: Vec<PlacedPoint> = (states.iter().enumerate())
                .map(|(k, state)| {
                    ([0.0, at(k % side), at(k / side)], state, Some(0.01 / (side * side) as f64))
                })
                .collect();
            let mut steady = steady.clone();
            steady.directions[0] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
            svgs.push(picture(&steady, "rim", &points).unwrap().svg);
        }
        for (svg, largest) in svgs.iter().zip([20_000, 120_000]) {
            assert!(svg.len() < largest && svg.contains("pressure [MPa]"), "{}", svg.len());
            let colours = [shade(1.0), OPEN.to_string()].map(|hex| format!("stroke=\"{hex}\""));
            assert!(colours.iter().all(|colour| svg.contains(colour)) && svg.contains(">2.00<"), "{svg}");
        }
    }

    #[test]
    fn a_face_is_seen_from_above_and_a_rim_is_not() {
        let mut results = sample::rig();
        let steady = results.get_mut::<SteadyResult>().unwrap();
        let seen = |steady: &SteadyResult| picture(steady, "rim", &placed(steady));
        assert!(seen(steady).is_none(), "two edges");
        for (k, (_, place)) in steady.points.iter_mut().enumerate() {
            *place = [1e-3 * (k % 5) as f64, 1e-3 * (k / 5) as f64, 0.0];
        }
        let svg = seen(steady).unwrap().svg;
        assert!(svg.contains("ΣN = 20.00 N on 6 closed points of 14") && !svg.contains("NaN"));
        // Titles and points.
        assert_eq!(svg.matches("<circle").count(), 14 + 14);
        assert!(svg.contains("normal force [N]") && !svg.contains("MPa"));
    }

    /// Points of one pressure, whatever their areas, have one colour: N = p A.
    #[test]
    fn points_that_stand_for_areas_show_their_pressure() {
        let mut results = sample::rig();
        let steady = results.get_mut::<SteadyResult>().unwrap();
        for (direction, name) in [([0.0, 1.0, 0.0], "y"), ([0.0, -1.0, 0.0], "y"), ([1.0, 0.0, 0.0], "x")] {
            for (k, (_, place)) in steady.points.iter_mut().enumerate() {
                *place = [1e-3 * (k % 5) as f64, 1e-3 * (k / 5) as f64, 0.0];
            }
            steady.directions[0] = [[0.0, 0.0, 1.0], direction];
            steady.areas = (0..14).map(|k| Some(1e-6 * (1.0 + k as f64))).collect();
            for (state, area) in steady.state.points.iter_mut().zip(&steady.areas) {
                state.forces.normal = 0.25e6 * area.unwrap();
            }
            let seen = picture(steady, "rim", &placed(steady)).unwrap();
            assert!(
                seen.svg.contains("pressure [MPa]") && seen.caption.contains("its pressure"),
                "{}",
                seen.caption
            );
            let closed = steady.state.points.iter().filter(|state| state.closed()).count();
            assert_eq!(seen.svg.matches("p 0.2500 MPa").count(), 14, "{closed}");
            assert!(seen.svg.contains(&format!("{name} [mm], along the sliding direction")));
        }
    }
}
