//! A sheet of SVG with the marks of a picture, placed by pixels. [`super::chart`] places them by values.

use super::colours::{INK, MUTED};
use super::html::escape;
use std::fmt::Write;

/// A point on the sheet \[px\], y downwards.
pub type SvgPoint = [f64; 2];

/// SVG attributes of a mark: [`fill`], [`stroke`] and what is added to them.
pub type Style = String;

/// Dashes of a line, added to its [`stroke`].
pub const DASHED: &str = " stroke-dasharray=\"7 5\"";
/// Dots.
pub const DOTTED: &str = " stroke-dasharray=\"2 3\"";
/// Dashes and dots in turn.
pub const CHAIN: &str = " stroke-dasharray=\"9 3 2 3\"";

/// The inside of a mark.
pub fn fill(hex: &str) -> Style {
    format!("fill=\"{hex}\"")
}

/// A line, or the outline of a mark that is not filled.
pub fn stroke(hex: &str, width: f64) -> Style {
    format!("fill=\"none\" stroke=\"{hex}\" stroke-width=\"{width}\"")
}

/// A filled mark with an outline.
pub fn outlined(hex: &str, outline: &str, width: f64) -> Style {
    format!("fill=\"{hex}\" stroke=\"{outline}\" stroke-width=\"{width}\"")
}

/// A mark through which others are seen.
pub fn sheer(style: Style, opacity: f64) -> Style {
    format!("{style} opacity=\"{opacity}\"")
}

/// How a text looks.
#[derive(Clone, Copy)]
pub struct Ink<'a> {
    size: f64,
    colour: &'a str,
    weight: &'static str,
    anchor: &'static str,
}

/// Text of a height \[px\] that begins at its point.
pub fn ink(size: f64, colour: &str) -> Ink<'_> {
    Ink { size, colour, weight: "", anchor: "start" }
}

impl Ink<'_> {
    /// The same in bold.
    pub fn bold(self) -> Self {
        Ink { weight: " font-weight=\"600\"", ..self }
    }

    /// Whether it begins at its point.
    pub fn begins(self) -> bool {
        self.anchor == "start"
    }

    /// Its middle is at its point.
    pub fn middle(self) -> Self {
        Ink { anchor: "middle", ..self }
    }

    /// It ends at its point.
    pub fn end(self) -> Self {
        Ink { anchor: "end", ..self }
    }
}

/// A piece of a mark beside its words.
pub enum Key {
    /// A line.
    Line(Style),
    /// A filled box.
    Box(Style),
}

/// A sheet that is being drawn on.
pub struct Sheet {
    width: f64,
    /// Its height \[px\].
    pub height: f64,
    body: String,
}

impl Sheet {
    /// A white sheet.
    pub fn new(width: f64, height: f64) -> Self {
        Sheet { width, height, body: String::new() }
    }

    /// A rectangle by its upper left corner and its size.
    pub fn rectangle(&mut self, corner: SvgPoint, size: [f64; 2], style: &str) {
        let ([x, y], [w, h]) = (corner.map(px), size.map(px));
        self.put(format_args!("<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" {style}/>"));
    }

    /// A circle.
    pub fn circle(&mut self, at: SvgPoint, radius: f64, style: &str) {
        let ([x, y], radius) = (at.map(px), px(radius));
        self.put(format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" {style}/>"));
    }

    /// Closed polygons as one path; a point inside an even number of them is outside.
    pub fn polygons<'a>(&mut self, polygons: impl IntoIterator<Item = &'a [SvgPoint]>, style: &str) {
        let path: String = polygons.into_iter().map(|polygon| trace(polygon) + "z").collect();
        self.put(format_args!("<path d=\"{path}\" fill-rule=\"evenodd\" {style}/>"));
    }

    /// Open lines as one path.
    pub fn lines<'a>(&mut self, lines: impl IntoIterator<Item = &'a [SvgPoint]>, style: &str) {
        let path: String = lines.into_iter().map(trace).collect();
        self.put(format_args!("<path d=\"{path}\" {style}/>"));
    }

    /// A straight line.
    pub fn line(&mut self, ends: [SvgPoint; 2], style: &str) {
        self.lines([&ends[..]], style);
    }

    /// An arrow with a filled head.
    pub fn arrow(&mut self, tail: SvgPoint, head: SvgPoint, colour: &str, width: f64) {
        let d = [head[0] - tail[0], head[1] - tail[1]];
        let length = d[0].hypot(d[1]);
        if length < 1e-9 {
            return;
        }
        let (along, across) = ([d[0] / length, d[1] / length], [-d[1] / length, d[0] / length]);
        let size = (3.2 * width).min(length);
        let neck = [head[0] - size * along[0], head[1] - size * along[1]];
        let side = |s: f64| [neck[0] + 0.45 * s * size * across[0], neck[1] + 0.45 * s * size * across[1]];
        self.line([tail, neck], &stroke(colour, width));
        self.polygons([&[head, side(1.0), side(-1.0)][..]], &fill(colour));
    }

    /// A text on its baseline.
    pub fn text(&mut self, at: SvgPoint, text: &str, ink: Ink) {
        self.text_with(at, text, ink, "");
    }

    /// A text that is read upwards.
    pub fn upright(&mut self, at: SvgPoint, text: &str, ink: Ink) {
        let [x, y] = at.map(px);
        self.text_with(at, text, ink, &format!(" transform=\"rotate(-90 {x} {y})\""));
    }

    fn text_with(&mut self, at: SvgPoint, text: &str, ink: Ink, more: &str) {
        if !at.iter().all(|c| c.is_finite()) {
            return;
        }
        let ([x, y], text, Ink { size, colour, weight, anchor }) = (at.map(px), escape(text), ink);
        self.put(format_args!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" fill=\"{colour}\" text-anchor=\"{anchor}\"{weight}{more}>{text}</text>"
        ));
    }

    /// Marks with their words in a line from a point on, and in lines below where it is full; gives the lower end.
    pub fn keys(&mut self, [left, top]: SvgPoint, keys: impl IntoIterator<Item = (Key, String)>) -> f64 {
        let (mut x, mut y) = (left, top);
        for (key, words) in keys {
            let mark = if matches!(key, Key::Line(_)) { 36.0 } else { 22.0 };
            let length = mark + 7.2 * words.chars().count() as f64;
            if x > left && x + length > self.width {
                (x, y) = (left, y + 20.0);
            }
            match key {
                Key::Line(style) => self.line([[x, y + 8.0], [x + 30.0, y + 8.0]], &style),
                Key::Box(style) => self.rectangle([x, y + 1.0], [15.0, 14.0], &style),
            }
            self.text([x + mark, y + 12.5], &words, ink(13.0, INK));
            x += length + 24.0;
        }
        y + 20.0
    }

    /// A bar from `zero` on, to the left where `length` is negative, with its words at the other end.
    pub fn bar(&mut self, zero: SvgPoint, [length, height]: [f64; 2], hex: &str, words: &str) {
        let end = zero[0] + length;
        self.rectangle([zero[0].min(end), zero[1]], [length.abs(), height], &fill(hex));
        let size = if height < 10.0 { ink(10.5, MUTED) } else { ink(13.0, INK) };
        let y = zero[1] + 0.5 * height + 4.5;
        match length < 0.0 {
            true => self.text([end - 6.0, y], words, size.end()),
            false => self.text([end + 6.0, y], words, size),
        }
    }

    /// The colours of a scale from 0 below to 1 above, with words at places on it.
    pub fn colour_bar(
        &mut self,
        [x, top]: SvgPoint,
        height: f64,
        shade: impl Fn(f64) -> String,
        ticks: impl IntoIterator<Item = (f64, String)>,
    ) {
        const STEPS: usize = 86;
        let step = height / STEPS as f64;
        for k in 0..STEPS {
            let middle = 1.0 - (k as f64 + 0.5) / STEPS as f64;
            let from = step * k as f64;
            // One pixel into the next, so that no seam shows.
            self.rectangle([x, top + from], [22.0, (step + 1.0).min(height - from)], &fill(&shade(middle)));
        }
        self.rectangle([x, top], [22.0, height], &stroke(MUTED, 1.0));
        for (place, words) in ticks {
            let y = top + height * (1.0 - place);
            self.line([[x + 22.0, y], [x + 27.0, y]], &stroke(MUTED, 1.0));
            self.text([x + 32.0, y + 4.0], &words, ink(12.5, INK));
        }
    }

    /// SVG as it is.
    pub fn put(&mut self, mark: std::fmt::Arguments) {
        writeln!(self.body, "{mark}").expect("writing to a string");
    }

    /// What is drawn, without the sheet.
    pub fn body(self) -> String {
        self.body
    }

    /// The finished picture.
    pub fn finish(self) -> String {
        let Sheet { width: w, height: h, body } = self;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w:.0}\" height=\"{h:.0}\" viewBox=\"0 0 {w:.0} {h:.0}\" \
             font-family=\"system-ui, 'Segoe UI', Helvetica, Arial, sans-serif\" stroke-linejoin=\"round\">\n\
             <rect x=\"0\" y=\"0\" width=\"{w:.0}\" height=\"{h:.0}\" fill=\"#ffffff\"/>\n{body}</svg>\n"
        )
    }
}

/// A pixel to the nearest hundredth.
pub fn px(pixel: f64) -> f64 {
    (100.0 * pixel).round() / 100.0
}

/// `M x y l dx dy …` in whole hundredths of a pixel, so that rounding does not add up along the way.
fn trace(points: &[SvgPoint]) -> String {
    let mut path = String::new();
    let mut last = [0_i64; 2];
    for (k, point) in points.iter().enumerate() {
        let here = point.map(|c| (100.0 * c).round() as i64);
        let step = [here[0] - last[0], here[1] - last[1]].map(|c| c as f64 / 100.0);
        let letter = if k == 0 { 'M' } else { 'l' };
        if k == 0 || here != last {
            write!(path, "{letter}{} {}", step[0], step[1]).expect("writing to a string");
        }
        last = here;
    }
    path
}
