//! The surfaces of a pair in contact side by side: pressure, or normal force where the points stand for no area, as the colour of the part of its
//! face that is nearest to each contact point, and the status of the points.

use super::chart::{Axis, Chart, WIDTH, ends};
use super::colours::{INK, MEASURED, MUTED, sequential};
use super::contact_plane::{PlaneSurface, in_plane};
use super::format::significant;
use super::section::Picture;
use super::svg::{Sheet, fill, ink, outlined, sheer, stroke};
use super::view::ViewVector;
use crate::results::SteadyResult;
use std::collections::BTreeMap;

/// Surfaces that are drawn, those with the largest normal forces.
const SURFACES: usize = 12;
/// Panels beside each other at most, and where they end \[px\].
const COLUMNS: usize = 3;
const RIGHT: f64 = 824.0;
/// Left of, right of, above and below the part between the axes of a panel \[px\].
const MARGINS: [f64; 4] = [84.0, 16.0, 84.0, 52.0];
/// The height of a row of as many panels \[px\].
const HEIGHT: f64 = 480.0;
/// Part of the axes that a surface fills at most.
const FILLED: f64 = 0.94;
/// Points of more are without titles and edges of faces.
const SINGLE: usize = 150;
/// More parts of faces than this are squares, and more squares than this are joined.
const MOST: usize = 3000;
/// Steps of the colours, and the factor from one size of squares to the next.
const SHADES: f64 = 24.0;
const SIZES: f64 = 1.15;
/// The colour where the contact is open.
const OPEN: &str = "#dfe4ea";

/// What the colours show.
#[derive(Clone, Copy)]
struct Shown {
    name: &'static str,
    unit: &'static str,
}

const FORCE: Shown = Shown { name: "normal force", unit: "N" };
const PRESSURE: Shown = Shown { name: "pressure", unit: "MPa" };

/// A part of a face, or a square, around a contact point.
struct Patch {
    point: usize,
    at: [f64; 2],
    outline: Vec<[f64; 2]>,
}

/// A surface with its parts.
struct Panel {
    name: String,
    plane: PlaneSurface,
    patches: Vec<Patch>,
    points: Vec<usize>,
    /// Whether faces far from closed points are left out.
    cropped: bool,
}

/// The normal force of points, and how many carry it.
fn carried(steady: &SteadyResult, points: &[usize]) -> (f64, usize) {
    let states = || points.iter().map(|p| &steady.state.points[*p]);
    (states().map(|state| state.forces.normal).sum(), states().filter(|state| state.closed()).count())
}

/// The picture of a pair whose body touches with faces on `nodes`.
pub(super) fn picture(steady: &SteadyResult, pair: &str, nodes: &[ViewVector]) -> Option<Picture> {
    let surfaces = steady.surfaces.iter().filter(|surface| surface.pair == pair);
    let mut panels: Vec<Panel> = surfaces
        .map(|surface| {
            let mut points: Vec<usize> =
                surface.faces.iter().flat_map(|face| &face.points).copied().collect();
            points.sort_unstable();
            points.dedup();
            let plane = in_plane(surface, nodes, &|p| steady.points[p].1);
            Panel { name: surface.name.clone(), plane, patches: Vec::new(), points, cropped: false }
        })
        .collect();
    if panels.is_empty() {
        return None;
    }
    let all = panels.len();
    panels.sort_by(|a, b| carried(steady, &b.points).0.total_cmp(&carried(steady, &a.points).0));
    panels.truncate(SURFACES);
    panels.sort_by(|a, b| a.name.cmp(&b.name));
    panels.iter_mut().for_each(|panel| panel.divide(steady));
    let areas = panels
        .iter()
        .flat_map(|panel| &panel.points)
        .all(|p| steady.areas[*p].is_some_and(|area| area > 0.0));
    let shown = if areas { PRESSURE } else { FORCE };
    let picture = Drawing::new(steady, shown, &panels);
    let svg = picture.drawn(&panels);
    let mut caption = format!(
        "Contact “{pair}” at steady sliding: {} on the faces of the body, each point with the part of its face that is nearest to it; grey where \
         the contact is open.",
        shown.name
    );
    let slide = panels.iter().map(|panel| panel.plane.slides).fold(0.0, |a: f64, b| a + b.abs());
    caption += match slide {
        0.0 => " Nothing slides: closed points without a dot are at their friction limit.",
        _ => " An arrow shows where the counter-body slides; closed points slide.",
    };
    if panels.iter().any(|panel| panel.cropped) {
        caption += " Faces far from closed points are left out.";
    }
    if all > panels.len() {
        caption += &format!(" The {} of {all} surfaces with the largest forces.", panels.len());
    }
    Some(Picture { file: "contact".into(), caption, svg })
}

impl Panel {
    /// Leaves out faces that are farther from the closed points than these are wide, and parts the others among their points.
    fn divide(&mut self, steady: &SteadyResult) {
        let closed = |p: usize| steady.state.points[p].closed();
        let places = || self.plane.faces.iter().flat_map(|face| &face.points).filter(|(p, _)| closed(*p));
        let spans = [0, 1].map(|c| ends(places().map(|(_, at)| at[c])));
        let reach = spans.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
        if reach > 0.0 {
            let before = self.plane.faces.len();
            let near =
                |x: &[f64; 2]| (0..2).all(|c| (spans[c][0] - reach..=spans[c][1] + reach).contains(&x[c]));
            self.plane.faces.retain(|face| face.outline.iter().any(near));
            self.cropped = self.plane.faces.len() < before;
        }
        for face in &self.plane.faces {
            for (point, at) in &face.points {
                let others = face.points.iter().filter(|(other, _)| other != point);
                let outline =
                    others.fold(face.outline.clone(), |part, (_, other)| nearer(&part, *at, *other));
                self.patches.push(Patch { point: *point, at: *at, outline });
            }
        }
    }

    fn span(&self, c: usize) -> [f64; 2] {
        ends(self.plane.faces.iter().flat_map(|face| &face.outline).map(|x| x[c]))
    }
}

/// The part of a convex polygon that is nearer to `a` than to `b`.
fn nearer(polygon: &[[f64; 2]], a: [f64; 2], b: [f64; 2]) -> Vec<[f64; 2]> {
    let way = [b[0] - a[0], b[1] - a[1]];
    let side = |x: &[f64; 2]| (0..2).map(|c| way[c] * (x[c] - 0.5 * (a[c] + b[c]))).sum::<f64>();
    let mut part = Vec::with_capacity(polygon.len() + 1);
    for (k, x) in polygon.iter().enumerate() {
        let next = &polygon[(k + 1) % polygon.len()];
        let [here, there] = [side(x), side(next)];
        if here <= 0.0 {
            part.push(*x);
        }
        if (here <= 0.0) != (there <= 0.0) {
            let share = here / (here - there);
            part.push([0, 1].map(|c| x[c] + share * (next[c] - x[c])));
        }
    }
    part
}

/// The scales of a picture.
struct Drawing<'a> {
    steady: &'a SteadyResult,
    states: Vec<&'static str>,
    shown: Shown,
    largest: f64,
    /// Parts of faces in all panels.
    total: usize,
    /// \[mm/px\].
    scale: f64,
    columns: usize,
    /// The part between the axes of a panel \[px\].
    size: [f64; 2],
}

impl<'a> Drawing<'a> {
    /// The columns with the largest scale.
    fn new(steady: &'a SteadyResult, shown: Shown, panels: &[Panel]) -> Self {
        let extent = |c: usize| {
            let of = |panel: &Panel| panel.span(c)[1] - panel.span(c)[0];
            panels.iter().map(of).fold(0.0, f64::max).max(1e-9) / FILLED
        };
        let extents = [extent(0), extent(1)];
        let of = |columns: usize| {
            let rows = panels.len().div_ceil(columns) as f64;
            let wide = RIGHT / columns as f64 - MARGINS[0] - MARGINS[1];
            let all = HEIGHT * panels.len().div_ceil(COLUMNS) as f64;
            let high = (all / rows - MARGINS[2] - MARGINS[3]).max(60.0);
            let scale = (extents[0] / wide).max(extents[1] / high);
            (scale, columns, [wide, high.min((extents[1] / scale).max(40.0))])
        };
        let all = (1..=COLUMNS.min(panels.len())).map(of);
        let (scale, columns, size) = all.min_by(|a, b| a.0.total_cmp(&b.0)).expect("there are panels");
        let total = panels.iter().map(|panel| panel.patches.len()).sum();
        let mut drawing = Drawing {
            steady,
            states: steady.states().collect(),
            shown,
            largest: 0.0,
            total,
            scale,
            columns,
            size,
        };
        let values = panels.iter().flat_map(|panel| &panel.points).map(|p| drawing.value(*p));
        drawing.largest = values.fold(f64::MIN_POSITIVE, f64::max);
        drawing
    }

    /// Pressure \[MPa\] or normal force \[N\] of a point.
    fn value(&self, point: usize) -> f64 {
        let force = self.steady.state.points[point].forces.normal;
        match self.steady.areas[point] {
            Some(area) if self.shown.unit == PRESSURE.unit => 1e-6 * force / area,
            _ => force,
        }
    }

    fn drawn(&self, panels: &[Panel]) -> String {
        let slot = [self.size[0] + MARGINS[0] + MARGINS[1], self.size[1] + MARGINS[2] + MARGINS[3]];
        let rows = panels.len().div_ceil(self.columns) as f64;
        let mut sheet = Sheet::new(WIDTH, (rows * slot[1]).max(270.0));
        for (k, panel) in panels.iter().enumerate() {
            let corner = [(k % self.columns) as f64 * slot[0], (k / self.columns) as f64 * slot[1]];
            self.panel(&mut sheet, panel, corner);
        }
        let x = RIGHT + 16.0;
        sheet.text([x, 22.0], &format!("{} [{}]", self.shown.name, self.shown.unit), ink(12.5, INK).bold());
        let height = (sheet.height - 128.0).min(400.0);
        let ticks = [0.0, 0.25, 0.5, 0.75, 1.0].map(|part| (part, significant(part * self.largest, 3)));
        sheet.colour_bar([x, 38.0], height, shade, ticks);
        sheet.rectangle([x, height + 56.0], [22.0, 14.0], &fill(OPEN));
        sheet.text([x + 32.0, height + 68.0], "open", ink(12.5, INK));
        if self.states.contains(&"sticking") {
            sheet.rectangle([x, height + 80.0], [22.0, 14.0], &fill(&shade(0.3)));
            sheet.circle([x + 11.0, height + 87.0], 3.0, &dot_style());
            sheet.text([x + 32.0, height + 92.0], "sticking", ink(12.5, INK));
        }
        sheet.finish()
    }

    fn panel(&self, sheet: &mut Sheet, panel: &Panel, [left, top]: [f64; 2]) {
        let area = [
            left + MARGINS[0],
            top + MARGINS[2],
            left + MARGINS[0] + self.size[0],
            top + MARGINS[2] + self.size[1],
        ];
        let axes = [0, 1].map(|c| {
            let [low, high] = panel.span(c);
            let (middle, half) = (0.5 * (low + high), 0.5 * self.scale * self.size[c]);
            Axis::new(&panel.plane.axes[c], middle - half..middle + half).bare()
        });
        let [across, up] = axes;
        let mut chart = Chart::new(area, across, up);
        if self.total > MOST {
            self.squares(&mut chart, panel)
        } else {
            self.patches(&mut chart, panel)
        }
        chart.draw(sheet);
        let (force, closed) = carried(self.steady, &panel.points);
        let most = panel.points.iter().map(|p| self.value(*p)).fold(0.0, f64::max);
        let words = [
            format!("ΣN = {} N on {closed} of {} points", significant(force, 4), panel.points.len()),
            format!("largest {} {} {}", self.shown.name, significant(most, 3), self.shown.unit),
            panel.plane.seen.clone(),
        ];
        sheet.text([area[0], top + 20.0], &panel.name, ink(13.5, INK).bold());
        for (k, words) in words.iter().enumerate() {
            sheet.text([area[0], top + 37.0 + 17.0 * k as f64], words, ink(12.0, MUTED));
        }
        if panel.plane.slides != 0.0 {
            let (middle, y) = (area[2] - 30.0, top + 15.0);
            let half = 22.0 * panel.plane.slides;
            sheet.arrow([middle - half, y], [middle + half, y], MEASURED, 2.5);
        }
    }

    /// Every point with its part of a face: one path for each colour.
    fn patches(&self, chart: &mut Chart, panel: &Panel) {
        let mut classes: BTreeMap<Option<usize>, Vec<&Patch>> = BTreeMap::new();
        for patch in &panel.patches {
            classes.entry(self.level(self.value(patch.point), patch.point)).or_default().push(patch);
        }
        for (level, patches) in classes {
            // An outline of the colour itself leaves no seam.
            let hex = colour(level);
            chart.polygons(patches.iter().map(|patch| patch.outline.clone()), &outlined(&hex, &hex, 0.5));
        }
        if self.total <= 10 * SINGLE {
            let outlines = panel.plane.faces.iter().map(|face| face.outline.clone());
            chart.polygons(outlines, &sheer(stroke(MUTED, 0.6), 0.7));
        }
        for patch in panel.patches.iter().filter(|patch| self.states[patch.point] == "sticking") {
            let width =
                [0, 1].map(|c| ends(patch.outline.iter().map(|x| x[c]))).map(|[a, b]| (b - a) / self.scale);
            let radius = (0.16 * width[0].min(width[1])).clamp(0.6, 3.0);
            match self.total <= SINGLE {
                true => chart.circle(patch.at, radius, &dot_style()),
                false => chart.squares([patch.at], 1.5 * radius, MEASURED),
            }
        }
        if self.total <= SINGLE {
            for patch in &panel.patches {
                let depth = significant(1e6 * self.steady.state.points[patch.point].penetration, 4);
                let value = significant(self.value(patch.point), 4);
                let words = format!(
                    "{} {value} {}, δ {depth} µm, {}",
                    self.shown.name, self.shown.unit, self.states[patch.point]
                );
                chart.title(patch.at, &words);
            }
        }
    }

    /// Very many points as squares of their areas, those in one cell of a grid as one with their mean.
    fn squares(&self, chart: &mut Chart, panel: &Panel) {
        let grid = self.scale
            * (self.size[0] * self.size[1] * self.total as f64 / (MOST * panel.patches.len()) as f64).sqrt();
        let mut cells: BTreeMap<[i64; 2], ([f64; 2], f64, f64, usize)> = BTreeMap::new();
        for patch in &panel.patches {
            let area = polygon_area(&patch.outline);
            let cell = cells.entry(patch.at.map(|x| (x / grid).floor() as i64)).or_insert((
                [0.0; 2],
                0.0,
                0.0,
                patch.point,
            ));
            cell.0.iter_mut().zip(patch.at).for_each(|(sum, x)| *sum += area * x);
            cell.1 += area;
            cell.2 += area * self.value(patch.point);
            if self.steady.state.points[patch.point].closed() {
                cell.3 = patch.point;
            }
        }
        let mut classes: BTreeMap<(Option<usize>, i64), Vec<[f64; 2]>> = BTreeMap::new();
        for (sum, area, value, point) in cells.into_values().filter(|cell| cell.1 > 0.0) {
            let side = (area.sqrt() / self.scale).max(1.0);
            let class = (self.level(value / area, point), (side.ln() / SIZES.ln()).ceil() as i64);
            classes.entry(class).or_default().push(sum.map(|x| x / area));
        }
        for ((level, size), points) in classes {
            chart.squares(points, SIZES.powi(size as i32), &colour(level));
        }
    }

    /// The step of colours of a value; `None` where the point is open.
    fn level(&self, value: f64, point: usize) -> Option<usize> {
        let part = (value / self.largest).clamp(0.0, 1.0);
        self.steady.state.points[point].closed().then(|| (part * SHADES).round() as usize)
    }
}

fn polygon_area(polygon: &[[f64; 2]]) -> f64 {
    let cross = |k: usize| {
        let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        a[0] * b[1] - a[1] * b[0]
    };
    (0.5 * (0..polygon.len()).map(cross).sum::<f64>()).abs()
}

fn dot_style() -> String {
    outlined(MEASURED, "#ffffff", 0.8)
}

fn colour(level: Option<usize>) -> String {
    level.map_or(OPEN.to_string(), |level| shade(level as f64 / SHADES))
}

/// Not white for a small force.
fn shade(part: f64) -> String {
    sequential(0.15 + 0.7 * part)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::job::sample;
    use crate::linalg::random::Random;
    use crate::mesh::Cell;
    use crate::results::{ContactFace, ContactSurface};

    /// Two square pads of `side` × `side` faces of one point each, one on each side of a plate, the left half of both open; p = 2 MPa on the first, 1 MPa on
    /// the second.
    fn pads(side: usize) -> (SteadyResult, Vec<ViewVector>) {
        let mut results = sample::rig();
        let mut steady = results.take::<SteadyResult>().unwrap();
        let state = steady.state.points[0];
        let (mut nodes, mut surfaces) = (Vec::new(), Vec::new());
        (steady.points, steady.state.points, steady.areas) = (Vec::new(), Vec::new(), Vec::new());
        let at = |k: usize| 0.1 / side as f64 * k as f64;
        for pad in 0..2 {
            let first = nodes.len();
            let z = [0.01, -0.01][pad];
            nodes.extend((0..=side).flat_map(|j| (0..=side).map(move |i| [at(i), at(j), z])));
            let mut faces = Vec::new();
            for (j, i) in (0..side).flat_map(|j| (0..side).map(move |i| (j, i))) {
                let node = |i: usize, j: usize| first + i + (side + 1) * j;
                let mut of = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
                if pad == 1 {
                    of.reverse();
                }
                faces.push(ContactFace {
                    cell: Cell::quadrilateral(of),
                    points: vec![steady.points.len()],
                    slides: [3.0, 0.0, 0.0],
                });
                steady.points.push(("rim".into(), [at(i) + 0.5 * at(1), at(j) + 0.5 * at(1), z]));
                let mut state = state;
                let area = at(1) * at(1);
                state.forces.normal = if i < side / 2 { 0.0 } else { [2e6, 1e6][pad] * area };
                steady.state.points.push(state);
                steady.areas.push(Some(area));
            }
            surfaces.push(ContactSurface { pair: "rim".into(), name: format!("pad {}", pad + 1), faces });
        }
        steady.surfaces = surfaces;
        (steady, nodes)
    }

    /// Both pads have a panel, one scale, and the colours of their pressures; 40,000 points make a picture about as small as some hundred.
    #[test]
    fn two_pads_stand_side_by_side_on_one_scale() {
        for (side, largest) in [(4, 40_000), (20, 130_000), (141, 200_000)] {
            let (steady, nodes) = pads(side);
            let Picture { svg, caption, .. } = picture(&steady, "rim", &nodes).unwrap();
            assert!(svg.len() < largest && !svg.contains("NaN"), "{side}: {}", svg.len());
            for words in [
                "pad 1",
                "pad 2",
                "pressure [MPa]",
                ">2.00<",
                "seen along −z, about (",
                "x [mm], along the sliding direction",
            ] {
                assert!(svg.contains(words), "{side}: {words}");
            }
            let closed = side * (side - side / 2);
            let total = format!(
                "ΣN = {} N on {closed} of",
                significant(2e6 * 0.01 * closed as f64 / (side * side) as f64, 4)
            );
            assert!(svg.contains(&total), "{total}");
            for hex in [shade(1.0), shade(0.5), OPEN.to_string()] {
                assert!(svg.matches(&hex).count() > 0, "{side}: {hex}");
            }
            assert!(caption.contains("An arrow") && svg.matches("class=\"axes\"").count() == 2);
        }
    }

    #[test]
    fn points_that_stick_have_dots_and_those_at_their_limit_none() {
        let (mut steady, nodes) = pads(6);
        steady.pairs[0].2 = 0.0;
        steady
            .surfaces
            .iter_mut()
            .flat_map(|surface| &mut surface.faces)
            .for_each(|face| face.slides = [0.0; 3]);
        let dots = |steady: &SteadyResult| {
            let svg = picture(steady, "rim", &nodes).unwrap().svg;
            svg.matches("stroke=\"#ffffff\" stroke-width=\"0.8\"").count()
        };
        assert_eq!(dots(&steady), 36 + 1);
        let closed: Vec<usize> = (0..72).filter(|p| steady.state.points[*p].closed()).collect();
        closed[..10].iter().for_each(|p| steady.state.points[*p].slips = true);
        assert_eq!(dots(&steady), 26 + 1);
        let status = |steady: &SteadyResult| {
            let (coordinates, parts, values) = steady.pressed_faces(&nodes);
            assert_eq!((coordinates.len(), parts.len()), (98, 2));
            [0, 1, 2].map(|status| values.iter().filter(|value| value.1 == status).count())
        };
        assert_eq!(status(&steady), [36, 26, 10]);
    }

    /// Random points in random convex polygons: their parts add up to the polygon, and each has its own point.
    #[test]
    fn parts_of_a_face_add_up() {
        let mut random = Random::seeded(5);
        for _ in 0..200 {
            let polygon: Vec<[f64; 2]> = (0..3 + random.below(4))
                .map(|k| 0.7 * k as f64 + 0.2 * random.next())
                .map(|angle| [3.0 * angle.cos(), 2.0 * angle.sin()])
                .collect();
            let points: Vec<[f64; 2]> =
                (0..1 + random.below(5)).map(|_| [random.next(), random.next()]).collect();
            let part = |a: &[f64; 2]| {
                points.iter().filter(|b| *b != a).fold(polygon.clone(), |part, b| nearer(&part, *a, *b))
            };
            let sum: f64 = points.iter().map(|a| polygon_area(&part(a))).sum();
            let whole = polygon_area(&polygon);
            assert!(within(sum / whole - 1.0, 1e-12, RoundOff), "{sum} {whole}");
        }
    }
}
