//! Lines and points of a chart at fractions of a pixel: plotters' SVG backend rounds to whole ones, which makes stairs of a curve.
//! Both end at the edges of the plot. They are written as the elements of [`super::chart_elements`].

use super::chart::{Area, text};
use super::chart_elements::{ELEMENT, FIELD};
use super::colours::INK;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::error::Error;
use std::fmt::Write;

/// A chart with linear places on both axes.
pub(super) type LinearChart<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Colour, width and dashes of a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pen<'a> {
    pub hex: &'a str,
    /// \[px\].
    pub width: f64,
    pub opacity: f64,
    pub dash: Dash,
}

/// Dashes of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dash {
    Solid,
    Dashed,
    Dotted,
    Chain,
}

impl Dash {
    /// Lengths of dashes and gaps as in SVG.
    pub(super) fn lengths(self) -> &'static str {
        match self {
            Dash::Solid => "none",
            Dash::Dashed => "7 5",
            Dash::Dotted => "2 3",
            Dash::Chain => "9 3 2 3",
        }
    }
}

/// A solid line.
pub(super) fn pen(hex: &str, width: f64) -> Pen<'_> {
    Pen { hex, width, opacity: 1.0, dash: Dash::Solid }
}

/// Segments that end farther away are not drawn \[px\].
const FARTHEST: f64 = 1e9;

/// A pixel of the sheet.
type Pixel = [f64; 2];

/// The part of a chart inside its axes \[px\].
struct Plot {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
    /// Ends of both axes.
    ends: [[f64; 2]; 2],
}

impl Plot {
    fn of(chart: &LinearChart) -> Self {
        let plot = chart.plotting_area();
        let (across, up) = (plot.get_x_axis_pixel_range(), plot.get_y_axis_pixel_range());
        let (wide, high) = (chart.x_range(), chart.y_range());
        Plot {
            left: across.start.into(),
            top: up.start.into(),
            right: across.end.into(),
            bottom: up.end.into(),
            ends: [[wide.start, wide.end], [high.start, high.end]],
        }
    }

    fn pixel(&self, (x, y): (f64, f64)) -> Pixel {
        let part = |v: f64, [from, to]: [f64; 2]| (v - from) / (to - from);
        [
            self.left + part(x, self.ends[0]) * (self.right - self.left),
            self.bottom - part(y, self.ends[1]) * (self.bottom - self.top),
        ]
    }

    /// Whether a pixel is inside, or on the edge but for round-off.
    fn holds(&self, [x, y]: Pixel) -> bool {
        const EDGE: f64 = 1e-6;
        (self.left - EDGE..=self.right + EDGE).contains(&x)
            && (self.top - EDGE..=self.bottom + EDGE).contains(&y)
    }

    /// The part of a segment that is inside (Y.-D. Liang and B. A. Barsky, ACM Trans. Graph. 3 (1984) 1).
    fn inside(&self, [a, b]: [Pixel; 2]) -> Option<[Pixel; 2]> {
        if self.holds(a) && self.holds(b) {
            return Some([a, b]);
        }
        // Not a number, or so far away that the edge is lost in round-off.
        if !a.iter().chain(&b).all(|c| c.abs() < FARTHEST) {
            return None;
        }
        let d = [b[0] - a[0], b[1] - a[1]];
        let (mut from, mut to): (f64, f64) = (0.0, 1.0);
        for (step, distance) in [
            (-d[0], a[0] - self.left),
            (d[0], self.right - a[0]),
            (-d[1], a[1] - self.top),
            (d[1], self.bottom - a[1]),
        ] {
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
}

/// The text that stands for a line through pixels `x,y x,y …`.
fn line_element(Pen { hex, width, opacity, dash }: Pen, pixels: &str) -> String {
    let dash = dash.lengths();
    format!("{ELEMENT}l{hex}{FIELD}{width}{FIELD}{opacity}{FIELD}{dash}{FIELD}{pixels}")
}

/// Draws a line through points of the chart.
pub(super) fn draw_curve(
    chart: &LinearChart,
    points: impl IntoIterator<Item = (f64, f64)>,
    pen: Pen,
) -> Result<(), Box<dyn Error>> {
    let plot = Plot::of(chart);
    let pixels: Vec<Pixel> = points.into_iter().map(|point| plot.pixel(point)).collect();
    let mut pieces: Vec<Vec<Pixel>> = Vec::new();
    for pair in pixels.windows(2) {
        let Some([a, b]) = plot.inside([pair[0], pair[1]]) else { continue };
        match pieces.last_mut() {
            Some(piece) if piece.last() == Some(&a) => piece.push(b),
            _ => pieces.push(vec![a, b]),
        }
    }
    for piece in pieces {
        let mut words: Vec<String> =
            piece.iter().map(|[x, y]| format!("{},{}", hundredths(*x), hundredths(*y))).collect();
        words.dedup();
        place(chart, &line_element(pen, &words.join(" ")))?;
    }
    Ok(())
}

/// A piece of a line for a legend, 30 pixels long, from a pixel of `area`.
pub(super) fn legend_line(area: &Area, (x, y): (i32, i32), pen: Pen) -> Result<(), Box<dyn Error>> {
    let (left, top) = area.get_base_pixel();
    let (x, y) = (x + left, y + top);
    area.draw_text(&line_element(pen, &format!("{x},{y} {},{y}", x + 30)), &text(1.0, INK), (0, 0))?;
    Ok(())
}

/// Draws a filled point.
pub(super) fn draw_dot(
    chart: &LinearChart,
    point: (f64, f64),
    radius: f64,
    hex: &str,
) -> Result<(), Box<dyn Error>> {
    draw_circle(chart, point, radius, [hex, "none", "0"])
}

/// Draws a hollow point with an outline of `width` pixels.
pub(super) fn draw_ring(
    chart: &LinearChart,
    point: (f64, f64),
    radius: f64,
    (hex, width): (&str, f64),
) -> Result<(), Box<dyn Error>> {
    draw_circle(chart, point, radius, ["none", hex, &width.to_string()])
}

fn draw_circle(
    chart: &LinearChart,
    point: (f64, f64),
    radius: f64,
    [fill, stroke, width]: [&str; 3],
) -> Result<(), Box<dyn Error>> {
    let plot = Plot::of(chart);
    let at = plot.pixel(point);
    if !plot.holds(at) {
        return Ok(());
    }
    let [x, y] = at.map(hundredths);
    let mut words = format!("{ELEMENT}c");
    write!(words, "{x}{FIELD}{y}{FIELD}{radius}{FIELD}{fill}{FIELD}{stroke}{FIELD}{width}")?;
    place(chart, &words)
}

/// A pixel to the nearest hundredth.
fn hundredths(pixel: f64) -> f64 {
    (100.0 * pixel).round() / 100.0
}

fn place(chart: &LinearChart, words: &str) -> Result<(), Box<dyn Error>> {
    chart.plotting_area().strip_coord_spec().draw_text(words, &text(1.0, INK), (0, 0))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::axes::axes;
    use crate::report::chart::sheet;

    /// The points of all lines of a chart from 0 to 10 and from −2 to 2 that `draw` draws on.
    fn drawn(draw: impl Fn(&LinearChart) -> Result<(), Box<dyn Error>>) -> (String, Vec<Vec<Pixel>>) {
        let svg = sheet((400, 300), |area| {
            draw(&axes(area, (0.0..10.0, -2.0..2.0), None, "", |v| format!("{v}"))?)
        })
        .unwrap();
        let lines = svg.split("<path d=\"M").skip(1).map(|rest| rest.split('"').next().unwrap());
        let point = |pair: &str| {
            let (x, y) = pair.split_once(',').unwrap();
            [x, y].map(|number| number.parse().unwrap())
        };
        let lines = lines.map(|line| line.split(' ').map(point).collect()).collect();
        (svg, lines)
    }

    #[test]
    fn a_curve_is_at_fractions_of_a_pixel_and_ends_at_the_edges() {
        let sine = |k: u32| (f64::from(k) * 0.01, (f64::from(k) * 0.01).sin());
        let (svg, lines) = drawn(|chart| {
            draw_curve(chart, (0..=1000).map(sine), Pen { dash: Dash::Dashed, ..pen("#0072b2", 2.0) })
        });
        assert!(svg.contains("stroke-dasharray=\"7 5\"") && lines.len() == 1);
        // 120 and 379 px are the ends of the axis across, 10 and 277 of that up.
        for [x, y] in &lines[0] {
            let value = 2.0 - 4.0 * (y - 10.0) / 267.0;
            let exact = (10.0 * (x - 120.0) / 259.0).sin();
            assert!(
                (value - exact).abs() < 4.0 * 0.005 / 267.0 + 10.0 * 0.005 / 259.0,
                "{x} {value} {exact}"
            );
        }
        // Out at the top and in again, then to where no pixel is.
        let points = [(0.0, 0.0), (5.0, 4.0), (10.0, 0.0), (f64::NAN, 0.0), (1e300, 1e300), (5.0, -1.0)];
        let (svg, lines) = drawn(|chart| draw_curve(chart, points, pen("#0072b2", 2.0)));
        assert_eq!(lines.len(), 2, "{svg}");
        assert_eq!(lines[0], [[120.0, 143.5], [184.75, 10.0]]);
        assert_eq!(lines[1], [[314.25, 10.0], [379.0, 143.5]]);
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn points_outside_are_not_drawn() {
        let (svg, _) = drawn(|chart| {
            draw_dot(chart, (1.0, 1.0), 4.0, "#d55e00")?;
            draw_ring(chart, (9.9, -2.0), 4.0, ("#8a949e", 1.5))?;
            draw_dot(chart, (1.0, 2.1), 4.0, "#d55e00")?;
            draw_dot(chart, (f64::NAN, 0.0), 4.0, "#d55e00")
        });
        assert_eq!(svg.matches("<circle").count(), 2, "{svg}");
        assert!(svg.contains("cx=\"145.9\" cy=\"76.75\" r=\"4\" fill=\"#d55e00\""), "{svg}");
    }
}
