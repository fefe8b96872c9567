//! One chart under all pictures: axes as data, and marks placed by values. Its SVG has coordinates of a hundredth of a pixel, and
//! its axes and the titles of points as `charts.js` of the page reads them.

pub use super::axis::{Axis, ends, widened};

use super::colours::{ALARM, ALARM_TEXT, INK, MUTED};
use super::html::escape;
use super::svg::{Ink, Sheet, SvgPoint, fill, ink, px, sheer, stroke};

/// Width of most pictures \[px\].
pub const WIDTH: f64 = 980.0;
/// Lines at the labels of axes.
pub const GRID: &str = "#e6e9ed";
/// Height of a label \[px\].
pub const LABEL: f64 = 17.0;
/// Radius within which a point shows its title \[px\].
const REACH: f64 = 9.0;
/// Least distances of the labels of both axes \[px\].
const APART: [f64; 2] = [72.0, 30.0];
/// Segments that end farther away are not drawn \[px\].
const FARTHEST: f64 = 1e9;

/// The part of the sheet between the axes of a chart as wide as the sheet: left, upper, right, lower edge \[px\].
pub fn wide(top: f64, bottom: f64) -> [f64; 4] {
    [112.0, top, WIDTH - 22.0, bottom]
}

/// Two axes and the marks on them.
pub struct Chart {
    /// Left, upper, right, lower edge of the part between the axes \[px\].
    area: [f64; 4],
    axes: [Axis; 2],
    marks: Sheet,
    /// Left, upper, right, lower edges of the labels of marks \[px\].
    labels: Vec<[f64; 4]>,
}

impl Chart {
    /// A chart without marks on a part of the sheet (left, upper, right, lower edge): an axis across, and one up.
    pub fn new(area: [f64; 4], across: Axis, up: Axis) -> Self {
        let mut chart = Chart { area, axes: [across, up], marks: Sheet::new(0.0, 0.0), labels: Vec::new() };
        for d in 0..2 {
            for (at, _) in chart.axes[d].grid.then(|| chart.ticks(d)).into_iter().flatten() {
                chart.marks.line(chart.across_at(d, at), &stroke(GRID, 1.0));
            }
        }
        chart
    }

    /// Pixels of the labels of an axis along it, with the labels.
    fn ticks(&self, d: usize) -> Vec<(f64, String)> {
        let [left, top, right, bottom] = self.area;
        let (begin, length) = [(left, right - left), (bottom, top - bottom)][d];
        let axis = &self.axes[d];
        let all = axis.labelled(length.abs() / APART[d]).into_iter();
        all.map(|(value, words)| (begin + axis.part(value) * length, words)).collect()
    }

    /// A line over the whole chart across axis `d` at a pixel of it.
    fn across_at(&self, d: usize, at: f64) -> [SvgPoint; 2] {
        let [left, top, right, bottom] = self.area;
        [[[at, bottom], [at, top]], [[left, at], [right, at]]][d]
    }

    /// The pixel of two values.
    pub fn pixel(&self, [x, y]: [f64; 2]) -> SvgPoint {
        let [left, top, right, bottom] = self.area;
        let parts = [self.axes[0].part(x), self.axes[1].part(y)];
        [left + parts[0] * (right - left), bottom - parts[1] * (bottom - top)]
    }

    /// Whether a pixel is inside, or on the edge but for round-off.
    fn holds(&self, [x, y]: SvgPoint) -> bool {
        const EDGE: f64 = 1e-6;
        let [left, top, right, bottom] = self.area;
        (left - EDGE..=right + EDGE).contains(&x) && (top - EDGE..=bottom + EDGE).contains(&y)
    }

    /// The part of a segment that is inside (Y.-D. Liang and B. A. Barsky, ACM Trans. Graph. 3 (1984) 1).
    fn inside(&self, [a, b]: [SvgPoint; 2]) -> Option<[SvgPoint; 2]> {
        if self.holds(a) && self.holds(b) {
            return Some([a, b]);
        }
        // Not a number, or so far away that the edge is lost in round-off.
        if !a.iter().chain(&b).all(|c| c.abs() < FARTHEST) {
            return None;
        }
        let d = [b[0] - a[0], b[1] - a[1]];
        let (mut from, mut to): (f64, f64) = (0.0, 1.0);
        let [left, top, right, bottom] = self.area;
        for (step, distance) in
            [(-d[0], a[0] - left), (d[0], right - a[0]), (-d[1], a[1] - top), (d[1], bottom - a[1])]
        {
            if step < 0.0 {
                from = from.max(distance / step);
            } else if step > 0.0 {
                to = to.min(distance / step);
            } else if distance < 0.0 {
                return None;
            }
        }
        let at = |t: f64| [a[0] + t * d[0], a[1] + t * d[1]];
        (from < to).then(|| [if from > 0.0 { at(from) } else { a }, if to < 1.0 { at(to) } else { b }])
    }

    /// A line through points, as far as it is inside.
    pub fn line(&mut self, points: impl IntoIterator<Item = [f64; 2]>, style: &str) {
        let pixels: Vec<SvgPoint> = points.into_iter().map(|point| self.pixel(point)).collect();
        let mut pieces: Vec<Vec<SvgPoint>> = Vec::new();
        for pair in pixels.windows(2) {
            let Some([a, b]) = self.inside([pair[0], pair[1]]) else { continue };
            match pieces.last_mut() {
                Some(piece) if piece.last() == Some(&a) => piece.push(b),
                _ => pieces.push(vec![a, b]),
            }
        }
        if !pieces.is_empty() {
            self.marks.lines(pieces.iter().map(Vec::as_slice), style);
        }
    }

    /// A line over the whole chart at a value of the axis `d`: 0 across, 1 up.
    pub fn rule(&mut self, d: usize, value: f64, style: &str) {
        let [left, top, right, bottom] = self.area;
        let (begin, length) = [(left, right - left), (bottom, top - bottom)][d];
        let ends = self.across_at(d, begin + self.axes[d].part(value) * length);
        if ends.iter().all(|end| self.holds(*end)) {
            self.marks.line(ends, style);
        }
    }

    /// A circle at a point, where that is inside.
    pub fn circle(&mut self, at: [f64; 2], radius: f64, style: &str) {
        let at = self.pixel(at);
        if self.holds(at) {
            self.marks.circle(at, radius, style);
        }
    }

    /// Filled squares about points, `side` pixels wide, in a path of a few bytes each.
    pub fn squares(&mut self, points: impl IntoIterator<Item = [f64; 2]>, side: f64, hex: &str) {
        let tenths = |pixel: f64| (10.0 * pixel).round() / 10.0;
        let pixels = points.into_iter().map(|point| self.pixel(point)).filter(|at| self.holds(*at));
        let path: String = pixels.map(|[x, y]| format!("M{} {}h0", tenths(x), tenths(y))).collect();
        let side = px(side);
        self.marks.put(format_args!(
            "<path d=\"{path}\" fill=\"none\" stroke=\"{hex}\" stroke-width=\"{side}\" stroke-linecap=\"square\"/>"
        ));
    }

    /// A filled point.
    pub fn dot(&mut self, at: [f64; 2], radius: f64, hex: &str) {
        self.circle(at, radius, &fill(hex));
    }

    /// A polygon by its corners about a point \[px\], where that is inside.
    pub fn corners(&mut self, at: [f64; 2], corners: &[SvgPoint], style: &str) {
        let [x, y] = self.pixel(at);
        if self.holds([x, y]) {
            let corners: Vec<SvgPoint> = corners.iter().map(|[dx, dy]| [x + dx, y + dy]).collect();
            self.marks.polygons([&corners[..]], style);
        }
    }

    /// A rectangle between two opposite corners, as far as it is inside.
    pub fn bar(&mut self, ends: [[f64; 2]; 2], style: &str) {
        let [left, top, right, bottom] = self.area;
        let [a, b] =
            ends.map(|end| self.pixel(end)).map(|[x, y]| [x.clamp(left, right), y.clamp(top, bottom)]);
        if a.iter().chain(&b).all(|c| c.is_finite()) {
            let size = [(a[0] - b[0]).abs(), (a[1] - b[1]).abs()];
            self.marks.rectangle([a[0].min(b[0]), a[1].min(b[1])], size, style);
        }
    }

    /// A polygon.
    pub fn polygon(&mut self, points: impl IntoIterator<Item = [f64; 2]>, style: &str) {
        self.polygons([points.into_iter().collect()], style);
    }

    /// Polygons as one path.
    pub fn polygons(&mut self, polygons: impl IntoIterator<Item = Vec<[f64; 2]>>, style: &str) {
        let pixels = |polygon: Vec<[f64; 2]>| polygon.into_iter().map(|point| self.pixel(point)).collect();
        let corners: Vec<Vec<SvgPoint>> = polygons.into_iter().map(pixels).collect();
        self.marks.polygons(corners.iter().map(Vec::as_slice), style);
    }

    /// Words on a baseline `off` a point \[px\].
    pub fn text(&mut self, at: [f64; 2], off: [f64; 2], words: &str, ink: Ink) {
        let [x, y] = self.pixel(at);
        self.marks.text([x + off[0], y + off[1]], words, ink);
    }

    /// A title of a point, shown while the pointer is there.
    pub fn title(&mut self, at: [f64; 2], words: &str) {
        let ([x, y], words) = (self.pixel(at).map(px), escape(words));
        if x.is_finite() && y.is_finite() {
            self.marks.put(format_args!(
                "<circle cx=\"{x}\" cy=\"{y}\" r=\"{REACH}\" fill-opacity=\"0\"><title>{words}</title></circle>"
            ));
        }
    }

    /// SVG between two opposite corners: left, upper edge, width and height.
    pub fn put(&mut self, ends: [[f64; 2]; 2], svg: impl Fn([f64; 4]) -> String) {
        let [a, b] = ends.map(|end| self.pixel(end));
        self.marks.put(format_args!("{}", svg([a[0], a[1], b[0] - a[0], b[1] - a[1]])));
    }

    /// The rectangle of a label that ends at a lower edge and is `step` pixels farther on as often as needed to cover no other.
    fn free(&self, [x, y]: SvgPoint, words: &str, step: f64) -> [f64; 4] {
        let half = 3.8 * words.chars().count() as f64 + 2.0;
        let mut place = [x - half, y - LABEL, x + half, y];
        let covers = |[l, t, r, b]: [f64; 4], o: &[f64; 4]| l < o[2] && r > o[0] && t < o[3] && b > o[1];
        while step != 0.0 && self.labels.iter().any(|other| covers(place, other)) {
            place = [place[0], place[1] + step, place[2], place[3] + step];
        }
        place
    }

    /// Words above a mark `above` pixels high, where they cover no others; a line joins them to a mark that they are moved away from.
    pub fn label(&mut self, at: [f64; 2], above: f64, words: &str) {
        let [x, mark] = self.pixel(at);
        // A label stays on the chart.
        let x = x.clamp(self.area[0] + 32.0, self.area[2] - 32.0);
        let place = self.free([x, mark - above], words, -4.0);
        if place[3] < mark - above {
            self.marks.line([[x, place[3]], [x, mark - above + 2.0]], &sheer(stroke(ALARM, 1.0), 0.5));
        }
        self.marks.text([x, place[3] - 4.0], words, ink(13.5, ALARM_TEXT).bold().middle());
        self.labels.push(place);
    }

    /// Words above a point, where they cover no others.
    pub fn label_if_free(&mut self, at: [f64; 2], words: &str) {
        let at = self.pixel(at);
        let place = self.free(at, words, 0.0);
        if self.labels.iter().all(|[l, _, r, _]| place[2] <= *l || place[0] >= *r) {
            self.marks.text([at[0], at[1] - 6.0], words, ink(12.0, INK).bold().middle());
            self.labels.push(place);
        }
    }

    /// A line over the whole chart at a value of the axis across, with words at its head, lower where they would cover others.
    pub fn flag(&mut self, value: f64, words: &str, style: &str, ink: Ink) {
        self.rule(0, value, style);
        let x = self.area[0] + self.axes[0].part(value) * (self.area[2] - self.area[0]);
        let place = self.free([x, self.area[1] + LABEL + 2.0], words, LABEL);
        self.marks.text([if ink.begins() { x + 4.0 } else { x }, place[3] - 4.0], words, ink);
        self.labels.push(place);
    }

    /// Whether no label covers another.
    #[cfg(test)]
    fn apart(&self) -> bool {
        self.labels.iter().enumerate().all(|(k, [left, top, right, low])| {
            let free = |[l, t, r, b]: &[f64; 4]| right <= l || left >= r || low <= t || top >= b;
            self.labels[k + 1..].iter().all(free)
        })
    }

    /// The chart alone, on a sheet as high as this.
    pub fn picture(self, height: f64) -> String {
        let mut sheet = Sheet::new(WIDTH, height);
        self.draw(&mut sheet);
        sheet.finish()
    }

    /// Draws the marks, and the axes over them.
    pub fn draw(mut self, sheet: &mut Sheet) {
        let [left, top, right, bottom] = self.area;
        let (line, words) = (stroke(MUTED, 1.0), ink(12.0, INK));
        let mut widest = 0;
        for (x, label) in self.ticks(0) {
            self.marks.line([[x, bottom], [x, bottom + 5.0]], &line);
            self.marks.text([x, bottom + 18.0], &label, words.middle());
        }
        for (y, label) in self.ticks(1) {
            self.marks.line([[left - 5.0, y], [left, y]], &line);
            self.marks.text([left - 9.0, y + 4.0], &label, words.end());
            widest = widest.max(label.chars().count());
        }
        self.marks.lines([&[[left, top], [left, bottom], [right, bottom]][..]], &line);
        let [x, y] = &self.axes;
        let (name, middle) = (ink(13.0, INK).middle(), [0.5 * (left + right), 0.5 * (top + bottom)]);
        if x.titled && !x.name.is_empty() {
            self.marks.text([middle[0], bottom + 38.0], &x.name, name);
        }
        if y.titled && !y.name.is_empty() {
            self.marks.upright([left - 22.0 - 7.0 * widest as f64, middle[1]], &y.name, name);
        }
        if x.readable() && y.readable() {
            let of = |axis: &Axis| format!("{} {} {}", axis.ends[0], axis.ends[1], axis.decades);
            let [w, h] = [px(right - left), px(bottom - top)];
            self.marks.put(format_args!(
                "<rect class=\"axes\" x=\"{left}\" y=\"{top}\" width=\"{w}\" height=\"{h}\" fill=\"none\" \
                 data-x=\"{}\" data-y=\"{}\" data-names=\"{}|{}\"/>",
                of(x),
                of(y),
                escape(&x.name),
                escape(&y.name)
            ));
        }
        sheet.put(format_args!("{}", self.marks.body()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::report::svg::DASHED;

    /// A chart from 0 to 10 and from −2 to 2, with its SVG and the points of all its lines that do not belong to the axes.
    fn drawn(draw: impl Fn(&mut Chart)) -> (String, Vec<Vec<SvgPoint>>) {
        let axes = [Axis::new("time \"t\" [s]", 0.0..10.0), Axis::new("force [N]", -2.0..2.0)];
        let [across, up] = axes.map(Axis::bare);
        let mut chart = Chart::new([120.0, 10.0, 379.0, 277.0], across, up);
        draw(&mut chart);
        let mut sheet = Sheet::new(400.0, 300.0);
        let marks = Sheet::new(0.0, 0.0);
        let lines = std::mem::replace(&mut chart.marks, marks).body();
        let number = |word: &str| word.parse::<f64>().unwrap();
        let path = |path: &str| {
            let steps = path.split('l').map(|step| step.split_once(' ').unwrap());
            let steps = steps.map(|(x, y)| [number(x), number(y)]);
            let along = steps.scan([0.0; 2], |at, [dx, dy]| {
                *at = [at[0] + dx, at[1] + dy].map(px);
                Some(*at)
            });
            along.collect()
        };
        let paths =
            lines.split("<path d=\"M").skip(1).flat_map(|rest| rest.split('"').next().unwrap().split('M'));
        let paths = paths.map(path).collect();
        chart.marks.put(format_args!("{lines}"));
        chart.draw(&mut sheet);
        (sheet.finish(), paths)
    }

    #[test]
    fn a_curve_is_at_fractions_of_a_pixel_and_ends_at_the_edges() {
        let sine = |k: u32| [f64::from(k) * 0.01, (f64::from(k) * 0.01).sin()];
        let dashed = stroke("#0072b2", 2.0) + DASHED;
        let (svg, lines) = drawn(|chart| chart.line((0..=1000).map(sine), &dashed));
        assert!(svg.contains("stroke-dasharray=\"7 5\"") && lines.len() == 1);
        for [x, y] in &lines[0] {
            let value = 2.0 - 4.0 * (y - 10.0) / 267.0;
            let exact = (10.0 * (x - 120.0) / 259.0).sin();
            let rounding = 4.0 * 0.005 / 267.0 + 10.0 * 0.005 / 259.0;
            assert!(within((value - exact).abs(), 1.001 * rounding, Reference), "{x} {value} {exact}");
        }
        // Out at the top and in again, then to where no pixel is.
        let points = [[0.0, 0.0], [5.0, 4.0], [10.0, 0.0], [f64::NAN, 0.0], [1e300, 1e300], [5.0, -1.0]];
        let (svg, lines) = drawn(|chart| chart.line(points, &stroke("#0072b2", 2.0)));
        assert_eq!(lines.len(), 2, "{svg}");
        assert_eq!(lines[0], [[120.0, 143.5], [184.75, 10.0]]);
        assert_eq!(lines[1], [[314.25, 10.0], [379.0, 143.5]]);
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn points_outside_are_not_drawn() {
        let (svg, _) = drawn(|chart| {
            chart.dot([1.0, 1.0], 4.0, "#d55e00");
            chart.circle([9.9, -2.0], 4.0, &stroke("#8a949e", 1.5));
            chart.dot([1.0, 2.1], 4.0, "#d55e00");
            chart.dot([f64::NAN, 0.0], 4.0, "#d55e00");
            chart.bar([[f64::NAN, 0.0], [1.0, 1.0]], "");
        });
        assert_eq!(svg.matches("<circle").count(), 2, "{svg}");
        assert!(svg.contains("cx=\"145.9\" cy=\"76.75\" r=\"4\" fill=\"#d55e00\""), "{svg}");
    }

    #[test]
    fn a_chart_carries_its_axes_and_titles() {
        let (svg, _) = drawn(|chart| chart.title([5.0, 0.0], "mode <1>\u{1b}"));
        assert!(
            svg.contains("<rect class=\"axes\" x=\"120\" y=\"10\" width=\"259\" height=\"267\""),
            "{svg}"
        );
        let names = "data-x=\"0 10 0\" data-y=\"-2 2 0\" data-names=\"time &quot;t&quot; [s]|force [N]\"/>";
        assert!(svg.contains(names), "{svg}");
        assert!(
            svg.contains("cx=\"249.5\" cy=\"143.5\"") && svg.contains("<title>mode &lt;1&gt;\\u{1b}</title>")
        );
    }

    #[test]
    fn labels_do_not_cover_each_other() {
        let mut chart = Chart::new(wide(0.0, 300.0), Axis::new("", 0.0..1.0), Axis::new("", 0.0..1.0));
        for x in [0.2, 0.21, 0.22, 0.2, 0.7] {
            chart.label([x, 0.5], 9.0, "1668 Hz");
            chart.flag(x, "936", &stroke(MUTED, 1.0), ink(12.0, INK));
        }
        assert!(chart.apart() && chart.labels[8][3] == 141.0, "{:?}", chart.labels);
    }
}
