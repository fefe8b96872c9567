//! A sheet of SVG: just the few marks that the hand-drawn pictures need.

use super::html::escape;
use std::fmt::Write;

/// A point on the sheet \[px\], y downwards.
pub(super) type SvgPoint = [f64; 2];

/// A sheet that is being drawn on.
pub(super) struct Sheet {
    width: f64,
    height: f64,
    body: String,
}

/// Where a text hangs from its point.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text looks.
#[derive(Clone, Copy)]
pub(super) struct Ink<'a> {
    pub size: f64,
    pub colour: &'a str,
    pub bold: bool,
    pub anchor: Anchor,
}

impl Sheet {
    /// A white sheet.
    pub(super) fn new(width: f64, height: f64) -> Self {
        let mut sheet = Sheet { width, height, body: String::new() };
        sheet.rectangle([0.0, 0.0], [width, height], "fill=\"#ffffff\"");
        sheet
    }

    /// A rectangle by its upper left corner and its size; `style` holds SVG attributes, here and below.
    pub(super) fn rectangle(&mut self, [x, y]: SvgPoint, [w, h]: [f64; 2], style: &str) {
        self.put(format_args!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{w:.1}\" height=\"{h:.1}\" {style}/>"
        ));
    }

    /// A circle.
    pub(super) fn circle(&mut self, [x, y]: SvgPoint, radius: f64, style: &str) {
        self.put(format_args!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" {style}/>"));
    }

    /// Closed polygons as one path; a point inside an even number of them is outside.
    pub(super) fn polygons<'a>(&mut self, polygons: impl IntoIterator<Item = &'a [SvgPoint]>, style: &str) {
        let path: String = polygons.into_iter().map(|polygon| trace(polygon) + "z").collect();
        self.put(format_args!("<path d=\"{path}\" fill-rule=\"evenodd\" {style}/>"));
    }

    /// Open lines as one path.
    pub(super) fn lines<'a>(&mut self, lines: impl IntoIterator<Item = &'a [SvgPoint]>, style: &str) {
        let path: String = lines.into_iter().map(trace).collect();
        self.put(format_args!("<path d=\"{path}\" fill=\"none\" {style}/>"));
    }

    /// An arrow with a filled head.
    pub(super) fn arrow(&mut self, tail: SvgPoint, head: SvgPoint, colour: &str, width: f64) {
        let d = [head[0] - tail[0], head[1] - tail[1]];
        let length = d[0].hypot(d[1]);
        if length < 1e-9 {
            return;
        }
        let (along, across) = ([d[0] / length, d[1] / length], [-d[1] / length, d[0] / length]);
        let size = (3.2 * width).min(length);
        let neck = [head[0] - size * along[0], head[1] - size * along[1]];
        let side = |s: f64| [neck[0] + 0.45 * s * size * across[0], neck[1] + 0.45 * s * size * across[1]];
        self.lines([&[tail, neck][..]], &format!("stroke=\"{colour}\" stroke-width=\"{width:.1}\""));
        self.polygons([&[head, side(1.0), side(-1.0)][..]], &format!("fill=\"{colour}\""));
    }

    /// A text on its baseline.
    pub(super) fn text(&mut self, [x, y]: SvgPoint, text: &str, ink: Ink) {
        let anchor = match ink.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let weight = if ink.bold { " font-weight=\"600\"" } else { "" };
        let (size, colour, text) = (ink.size, ink.colour, escape(text));
        self.put(format_args!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" fill=\"{colour}\" text-anchor=\"{anchor}\"{weight}>{text}</text>"
        ));
    }

    /// The finished picture.
    pub(super) fn finish(self) -> String {
        let Sheet { width: w, height: h, body } = self;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w:.0}\" height=\"{h:.0}\" viewBox=\"0 0 {w:.0} {h:.0}\" \
             font-family=\"system-ui, 'Segoe UI', Helvetica, Arial, sans-serif\" stroke-linejoin=\"round\">\n{body}</svg>\n"
        )
    }

    fn put(&mut self, mark: std::fmt::Arguments) {
        writeln!(self.body, "{mark}").expect("writing to a string");
    }
}

/// `M x y l dx dy …` with a tenth of a pixel, in whole tenths so that rounding does not add up along the way.
fn trace(points: &[SvgPoint]) -> String {
    let mut path = String::new();
    let mut last = [0_i64; 2];
    for (k, point) in points.iter().enumerate() {
        let here = point.map(|c| (10.0 * c).round() as i64);
        if k == 0 {
            write!(path, "M{} {}", here[0] as f64 / 10.0, here[1] as f64 / 10.0)
                .expect("writing to a string");
        } else if here != last {
            let step = [here[0] - last[0], here[1] - last[1]].map(|c| c as f64 / 10.0);
            write!(path, "l{} {}", step[0], step[1]).expect("writing to a string");
        }
        last = here;
    }
    path
}
