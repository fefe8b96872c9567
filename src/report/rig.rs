//! `rig.svg`: the model as analysed, with its contact points, load and sliding direction.

use super::chart::ends;
use super::colours::{ALARM, ALARM_TEXT, INK, MEASURED, MUTED, PARTS};
use super::format::{given, rounded};
use super::html::{described, whole};
use super::section::{Picture, ReportSection};
use super::svg::{Sheet, SvgPoint, fill, ink, outlined, stroke};
use super::view::{PlacedView, View, ViewVector, along, cross, dot, unit};
use crate::results::{Geometry, RunResults, SteadyResult};
use std::collections::BTreeMap;

const SIZE: [f64; 2] = [960.0, 560.0];
/// Width of the legend \[px\].
const LEGEND: f64 = 200.0;
/// Element edges closer than this [px] would make a grey patch: only outlines are drawn then.
const FINEST_EDGE: f64 = 2.5;

/// The model, before the analyses.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    picture(results).map(|picture| ReportSection::new("The model").pictures([picture])).into_iter().collect()
}

/// The picture, when the model has a mesh.
fn picture(results: &RunResults) -> Option<Picture> {
    let geometry = &results.geometry;
    // Points alone are no picture of a machine: masses on springs, the nodes of imported matrices.
    if geometry.elements.iter().all(|e| e.len() < 2) || size(geometry) == 0.0 {
        return None;
    }
    let view = View::facing([0.68, -0.85, 0.55])?;
    let arrows = results.get::<SteadyResult>().map(|steady| arrows(geometry, steady)).unwrap_or_default();
    let used = geometry.elements.iter().flatten().map(|k| geometry.nodes[*k]);
    let ends = arrows.iter().flat_map(|arrow| [arrow.tail, arrow.head]);
    let places = used.chain(ends).map(|place| view.project(place));
    let fit = PlacedView::new(places, [LEGEND, 40.0], [SIZE[0] - LEGEND - 110.0, SIZE[1] - 80.0]);
    let pixel = |place: ViewVector| fit.pixel(view.project(place));
    let mut sheet = Sheet::new(SIZE[0], SIZE[1]);
    draw_elements(&mut sheet, geometry, &view, &fit);
    if let Some(steady) = results.get::<SteadyResult>() {
        draw_points(&mut sheet, steady, pixel);
    }
    for arrow in &arrows {
        sheet.arrow(pixel(arrow.tail), pixel(arrow.head), arrow.colour, 4.0);
    }
    draw_legend(&mut sheet, geometry, results.get::<SteadyResult>().is_some(), &arrows);
    draw_axes(&mut sheet, &view, &fit);
    let caption = "The model at rest, as the analyses saw it.".to_string();
    let contact = results.get::<SteadyResult>().map_or(String::new(), |steady| {
        let closed = steady.state.points.iter().filter(|point| point.closed()).count();
        format!("; {closed} of {} contact points are closed", steady.points.len())
    });
    let labels = arrows.iter().take(NAMED).map(|arrow| format!("; {}", arrow.label)).collect::<String>();
    let seen = format!("The model: {}{contact}{labels}.", geometry.parts.join(", "));
    Some(Picture { file: "rig".into(), caption, svg: described(&whole(&sheet.finish()), &seen) })
}

/// Faces that meet at more than this angle \[rad\] have an edge.
const SHARP: f64 = 0.6;

/// Elements from the farthest to the nearest (the painter's algorithm); stretches of one part share a path.
fn draw_elements(sheet: &mut Sheet, geometry: &Geometry, view: &View, fit: &PlacedView) {
    let centre = |element: &[usize]| {
        let sum = element.iter().fold([0.0; 3], |sum, k| along(sum, 1.0, geometry.nodes[*k]));
        sum.map(|c| c / element.len().max(1) as f64)
    };
    let solid: Vec<bool> = (0..geometry.parts.len()).map(|part| geometry.is_solid(part)).collect();
    // What looks away from the viewer is behind the rest of its solid.
    let visible = |k: usize| !solid[geometry.part_of[k]] || dot(normal(geometry, k), view.towards) > 0.0;
    let seen: Vec<usize> = (0..geometry.elements.len()).filter(|k| visible(*k)).collect();
    let mut order: Vec<(f64, usize)> =
        seen.iter().map(|k| (view.nearness(centre(&geometry.elements[*k])), *k)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let outline = outlines(geometry, &seen);
    let pixels = |element: &[usize]| -> Vec<SvgPoint> {
        element.iter().map(|k| fit.pixel(view.project(geometry.nodes[*k]))).collect()
    };
    let fine = fineness(geometry) * fit.scale() < FINEST_EDGE;
    let kind = |k: usize| (geometry.part_of[k], geometry.elements[k].len().min(3));
    for stretch in order.chunk_by(|a, b| kind(a.1) == kind(b.1)) {
        let (part, corners) = kind(stretch[0].1);
        let [face, edge] = PARTS[part % PARTS.len()];
        let shapes: Vec<Vec<SvgPoint>> =
            stretch.iter().map(|(_, k)| pixels(&geometry.elements[*k])).collect();
        match corners {
            1 => shapes.iter().for_each(|s| sheet.circle(s[0], 4.0, &fill(edge))),
            2 => {
                let style = stroke(edge, 7.0) + " stroke-linecap=\"round\"";
                sheet.lines(shapes.iter().map(Vec::as_slice), &style);
            }
            _ => {
                // A stroke of the fill's own colour closes the hairlines between neighbours.
                let style = match fine {
                    true => outlined(face, face, 0.7),
                    false => outlined(face, edge, 0.5) + " stroke-opacity=\"0.55\"",
                };
                sheet.polygons(shapes.iter().map(Vec::as_slice), &style);
                let sides: Vec<Vec<SvgPoint>> = stretch
                    .iter()
                    .filter_map(|(_, k)| outline.get(k))
                    .flatten()
                    .map(|side| pixels(side))
                    .collect();
                if !sides.is_empty() {
                    let style = stroke(edge, 1.6) + " stroke-linecap=\"round\"";
                    sheet.lines(sides.iter().map(Vec::as_slice), &style);
                }
            }
        }
    }
}

/// The sum of the normals of the triangles of a face, twice its area long.
fn normal(geometry: &Geometry, element: usize) -> ViewVector {
    let nodes = &geometry.elements[element];
    let at = |k: usize| geometry.nodes[nodes[k]];
    let turned = |k: usize| cross(along(at(k - 1), -1.0, at(0)), along(at(k), -1.0, at(0)));
    (2..nodes.len()).fold([0.0; 3], |sum, k| along(sum, 1.0, turned(k)))
}

/// The sides of each face among those that are `seen` that no other of its part shares, or that are sharp edges.
fn outlines(geometry: &Geometry, seen: &[usize]) -> BTreeMap<usize, Vec<[usize; 2]>> {
    let mut sides: BTreeMap<(usize, usize, usize), Vec<usize>> = BTreeMap::new();
    for k in seen.iter().copied().filter(|k| geometry.elements[*k].len() >= 3) {
        let element = &geometry.elements[k];
        for (i, a) in element.iter().enumerate() {
            let b = element[(i + 1) % element.len()];
            sides.entry((geometry.part_of[k], *a.min(&b), *a.max(&b))).or_default().push(k);
        }
    }
    let sharp = |a: usize, b: usize| {
        let normals = [a, b].map(|k| unit(normal(geometry, k)));
        matches!(normals, [Some(a), Some(b)] if dot(a, b).abs() < SHARP.cos())
    };
    let mut outlines: BTreeMap<usize, Vec<[usize; 2]>> = BTreeMap::new();
    for ((_, a, b), faces) in sides {
        if matches!(faces[..], [_]) || matches!(faces[..], [f, g] if sharp(f, g)) {
            // With the face that is drawn last.
            outlines.entry(faces[faces.len() - 1]).or_default().push([a, b]);
        }
    }
    outlines
}

/// The median length of the faces' first sides \[m\].
fn fineness(geometry: &Geometry) -> f64 {
    let faces = geometry.elements.iter().filter(|e| e.len() >= 3);
    let side = |e: &Vec<usize>| {
        let d = along(geometry.nodes[e[1]], -1.0, geometry.nodes[e[0]]);
        dot(d, d).sqrt()
    };
    let mut sides: Vec<f64> = faces.map(side).collect();
    sides.sort_by(f64::total_cmp);
    sides.get(sides.len() / 2).copied().unwrap_or(f64::INFINITY)
}

/// An arrow in space with its words in the legend, where they cover nothing.
struct Arrow {
    tail: ViewVector,
    head: ViewVector,
    label: String,
    colour: &'static str,
}

/// Arrows in the legend at most.
const NAMED: usize = 6;
/// A load below this is none \[N\].
const LEAST: f64 = 1e-12;

/// Load and sliding velocity of every pair, drawn just outside the model; none of what is zero, or has no one direction.
fn arrows(geometry: &Geometry, steady: &SteadyResult) -> Vec<Arrow> {
    let mut arrows = vec![];
    let size = size(geometry);
    let several = steady.pairs.len() > 1;
    for ((name, load, velocity), [press, slide]) in steady.pairs.iter().zip(&steady.directions) {
        let all: Vec<ViewVector> =
            steady.points.iter().filter(|(pair, _)| pair == name).map(|(_, p)| *p).collect();
        if all.is_empty() {
            continue;
        }
        let centre = all.iter().fold([0.0; 3], |sum, p| along(sum, 1.0 / all.len() as f64, *p));
        let of = if several { format!(" ({name})") } else { String::new() };
        if *load > LEAST && *press != [0.0; 3] {
            let above = extent(geometry, press.map(|c| -c), centre);
            let label = format!("load {} N{of}", given(rounded(*load, 4)));
            let (tail, head) =
                (along(centre, -above - 0.24 * size, *press), along(centre, -above - 0.03 * size, *press));
            arrows.push(Arrow { tail, head, label, colour: ALARM_TEXT });
        }
        if *velocity != 0.0 && *slide != [0.0; 3] {
            let direction = if *velocity < 0.0 { slide.map(|c| -c) } else { *slide };
            let ahead = extent(geometry, direction, centre);
            let label = format!("sliding {} m/s{of}", given(rounded(velocity.abs(), 4)));
            let (tail, head) =
                (along(centre, ahead + 0.03 * size, direction), along(centre, ahead + 0.2 * size, direction));
            arrows.push(Arrow { tail, head, label, colour: MEASURED });
        }
    }
    arrows
}

/// The largest extent of the model along x, y, z \[m\].
fn size(geometry: &Geometry) -> f64 {
    let used = || geometry.elements.iter().flatten().map(|k| geometry.nodes[*k]);
    let span = |c: usize| {
        let [low, high] = ends(used().map(|place| place[c]));
        high - low
    };
    [0, 1, 2].map(span).into_iter().fold(0.0, f64::max)
}

/// How far the elements reach from `from` along `direction` \[m\].
fn extent(geometry: &Geometry, direction: ViewVector, from: ViewVector) -> f64 {
    let plates = geometry.elements.iter().filter(|e| e.len() >= 3);
    let reach = plates.flatten().map(|k| dot(along(geometry.nodes[*k], -1.0, from), direction));
    reach.fold(0.0, f64::max)
}

/// Closed points filled, open ones hollow.
fn draw_points(sheet: &mut Sheet, steady: &SteadyResult, pixel: impl Fn(ViewVector) -> SvgPoint) {
    let states = steady.points.iter().zip(&steady.state.points);
    let (closed, open): (Vec<_>, Vec<_>) = states.partition(|(_, state)| state.closed());
    for ((_, place), _) in open {
        sheet.circle(pixel(*place), 2.0, &outlined("#ffffff", MUTED, 1.0));
    }
    for ((_, place), _) in closed {
        sheet.circle(pixel(*place), 3.2, &outlined(ALARM, "#ffffff", 0.7));
    }
}

fn draw_legend(sheet: &mut Sheet, geometry: &Geometry, contact: bool, arrows: &[Arrow]) {
    let (x, mut y) = (22.0, 26.0);
    for (k, part) in geometry.parts.iter().enumerate() {
        let [fill, edge] = PARTS[k % PARTS.len()];
        sheet.rectangle([x, y - 11.0], [18.0, 13.0], &outlined(fill, edge, 1.4));
        sheet.text([x + 27.0, y], part, ink(14.0, INK));
        y += 23.0;
    }
    if contact {
        let styles = [fill(ALARM), outlined("#ffffff", MUTED, 1.2)];
        for (style, text) in styles.iter().zip(["contact point, closed", "contact point, open"]) {
            sheet.circle([x + 9.0, y - 5.0], 4.0, style);
            sheet.text([x + 27.0, y], text, ink(14.0, INK));
            y += 23.0;
        }
    }
    for arrow in arrows.iter().take(NAMED) {
        sheet.arrow([x, y - 5.0], [x + 20.0, y - 5.0], arrow.colour, 3.0);
        sheet.text([x + 27.0, y], &arrow.label, ink(14.0, arrow.colour).bold());
        y += 23.0;
    }
}

/// The three axes and a scale bar in the lower right corner.
fn draw_axes(sheet: &mut Sheet, view: &View, fit: &PlacedView) {
    let origin = [SIZE[0] - 86.0, SIZE[1] - 92.0];
    for (axis, name) in [([1.0, 0.0, 0.0], "x"), ([0.0, 1.0, 0.0], "y"), ([0.0, 0.0, 1.0], "z")] {
        let [right, up] = view.project(axis);
        let at = |length: f64| [origin[0] + length * right, origin[1] - length * up];
        sheet.arrow(origin, at(42.0), MUTED, 2.2);
        let [x, y] = at(54.0);
        sheet.text([x, y + 5.0], name, ink(14.0, MUTED).bold().middle());
    }
    // The longest of 1, 2, 5 × 10ᵏ m that fits.
    let longest = 110.0 / fit.scale();
    let decade = 10_f64.powf(longest.log10().floor());
    let length = [5.0, 2.0, 1.0].map(|m| m * decade).into_iter().find(|l| *l <= longest).unwrap_or(decade);
    let (x, y, width) = (SIZE[0] - 30.0, SIZE[1] - 34.0, length * fit.scale());
    let bar = [[x - width, y - 4.0], [x - width, y], [x, y], [x, y - 4.0]];
    sheet.lines([&bar[..]], &stroke(INK, 1.4));
    sheet.text([x, y + 17.0], &format!("{} mm", given(1e3 * length)), ink(13.0, INK).end());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use crate::mesh::Cell;

    #[test]
    fn parts_points_and_arrows_are_drawn() {
        let svg = picture(&sample::rig()).unwrap().svg;
        for label in ["disc", "slider", "bar", "load 20 N", "sliding 0.5 m/s", "50 mm"] {
            assert!(svg.contains(&format!(">{label}<")), "{label}");
        }
        let results = sample::rig();
        let steady = results.get::<SteadyResult>().unwrap();
        let closed = steady.state.points.iter().filter(|p| p.closed()).count();
        assert_eq!(svg.matches("r=\"3.2\"").count(), closed);
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        assert!(picture(&RunResults::default()).is_none());
    }

    #[test]
    fn nothing_is_drawn_of_a_model_of_points_and_of_a_load_that_is_none() {
        let mut results = sample::rig();
        results.get_mut::<SteadyResult>().unwrap().pairs[0].1 = 1e-18;
        let svg = picture(&results).unwrap().svg;
        assert!(!svg.contains("load") && svg.contains(">sliding 0.5 m/s<"));
        results.geometry.elements = vec![vec![0], vec![1]];
        results.geometry.part_of = vec![0, 0];
        assert!(picture(&results).is_none(), "points");
        results.geometry.elements = vec![vec![0, 0, 0]];
        results.geometry.part_of = vec![0];
        assert!(picture(&results).is_none(), "without size");
    }

    #[test]
    fn an_outline_is_what_no_neighbour_shares() {
        let faces = vec![Cell::triangle([0, 1, 2]), Cell::triangle([0, 2, 3])];
        let geometry = Geometry::new(vec![[0.0; 3]; 4], vec![("plate".into(), faces)]);
        let sides = outlines(&geometry, &[0, 1]);
        assert_eq!(sides.values().map(Vec::len).sum::<usize>(), 4);
        assert!(!sides.values().flatten().any(|side| *side == [0, 2]));
    }
}
