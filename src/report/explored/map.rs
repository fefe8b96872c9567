//! `map_<name>.svg`: the largest growth rate over two parameters, with the boundary of stability.

use super::axis::{axis_name, label, place, scale};
use crate::report::chart::{Area, bold, colour, sheet, text};
use crate::report::colours::{INK, MUTED, diverging};
use crate::report::curve::{draw_curve, draw_dot, draw_ring, pen};
use crate::report::format::given;
use crate::report::readout::axes_of;
use crate::report::section::Picture;
use crate::results::{MapResult, file_name};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;

/// At most this many cells along an axis; a finer grid is thinned out in the picture.
const CELLS: usize = 160;
/// Colour of points without an answer.
const NONE: &str = "#c3c8ce";

pub(super) fn picture(result: &MapResult) -> Option<Picture> {
    if result.points.is_empty() {
        return None;
    }
    let shades = Shades::of(result);
    let svg = sheet((980, 620), |area| draw(area, result, &shades))?;
    let caption = format!(
        "Largest growth rate of any mode over {} and {}: {}. The colour goes with the square root of the growth rate. Line: the \
         boundary of stability. Ring: the case itself.",
        axis_name(&result.labels[0], &result.units[0]),
        axis_name(&result.labels[1], &result.units[1]),
        shades.words()
    );
    Some(Picture { file: file_name("map", &result.name), caption, svg })
}

/// The colours of growth rates: they go with the square root, which shows both a weak and a strong squeal.
struct Shades {
    /// Least and largest growth rate, with zero between them \[1/s\].
    ends: [f64; 2],
    /// Whether a point has no answer.
    gaps: bool,
}

impl Shades {
    fn of(result: &MapResult) -> Self {
        let finite = result.points.iter().map(|p| p.growth_rate).filter(|s| s.is_finite());
        let ends = finite.fold([0.0, 0.0], |[low, high]: [f64; 2], s| [low.min(s), high.max(s)]);
        Shades { ends, gaps: result.points.iter().any(|p| !p.growth_rate.is_finite()) }
    }

    /// The largest magnitude \[1/s\].
    fn size(&self) -> f64 {
        self.ends[1].max(-self.ends[0]).max(f64::MIN_POSITIVE)
    }

    /// Place on the scale, from −1 to 1.
    fn place(&self, rate: f64) -> f64 {
        rate.signum() * (rate.abs() / self.size()).sqrt()
    }

    fn colour(&self, rate: f64) -> RGBColor {
        if rate.is_finite() { colour(&diverging(self.place(rate))) } else { colour(NONE) }
    }

    /// The colours that are drawn.
    fn words(&self) -> String {
        let grows = match self.place(self.ends[1]) {
            t if t > 0.75 => Some("orange to red where a mode grows"),
            t if t > 0.0 => Some("orange where a mode grows"),
            _ => None,
        };
        let decay = (self.ends[0] < 0.0).then_some("blue where all decay");
        let gaps = self.gaps.then_some("grey where there is no answer");
        let all: Vec<&str> = [grows, decay, gaps].into_iter().flatten().collect();
        if all.is_empty() { "no mode grows or decays".into() } else { all.join(", ") }
    }

    /// Round values at least `apart` from each other on the scale: 0, and ±1, 2, 5 × 10ᵏ.
    fn ticks(&self, apart: f64) -> Vec<f64> {
        let decade = self.size().log10().floor() as i32;
        let steps = (decade - 6..=decade).rev();
        let sizes: Vec<f64> = steps.flat_map(|k| [5.0, 2.0, 1.0].map(|m| m * 10f64.powi(k))).collect();
        let mut ticks = vec![0.0];
        for value in sizes.iter().flat_map(|size| [*size, -size]) {
            let inside = value >= self.ends[0] && value <= self.ends[1];
            let free = |tick: &f64| (self.place(*tick) - self.place(value)).abs() >= apart;
            if inside && ticks.iter().all(free) {
                ticks.push(value);
            }
        }
        ticks
    }
}

/// Edges of the cells about the values, and the index of the value of each cell.
fn cells(result: &MapResult, d: usize) -> Vec<(f64, f64, usize)> {
    let axis = &result.axes[d];
    let step = axis.points.div_ceil(CELLS);
    let chosen: Vec<usize> = (0..axis.points).step_by(step).collect();
    let at: Vec<f64> = chosen.iter().map(|k| place(axis, axis.value(*k))).collect();
    let n = at.len();
    let edge = |k: usize| match k {
        0 => at[0] - 0.5 * (at[1] - at[0]),
        k if k == n => at[n - 1] + 0.5 * (at[n - 1] - at[n - 2]),
        k => 0.5 * (at[k - 1] + at[k]),
    };
    (0..n).map(|k| (edge(k), edge(k + 1), chosen[k])).collect()
}

fn draw(area: &Area, result: &MapResult, shades: &Shades) -> Result<(), Box<dyn Error>> {
    let (main, bar) = area.split_horizontally(830);
    let (across, up) = (cells(result, 0), cells(result, 1));
    let span = |cells: &[(f64, f64, usize)]| {
        let (a, b) = (cells[0].0, cells[cells.len() - 1].1);
        a.min(b)..a.max(b)
    };
    let mut chart = ChartBuilder::on(&main)
        .margin(16)
        .x_label_area_size(52)
        .y_label_area_size(84)
        .build_cartesian_2d(span(&across), span(&up))?;
    let names = [0, 1].map(|d| axis_name(&result.labels[d], &result.units[d]));
    axes_of(&main, &chart, [0, 1].map(|d| scale(&result.axes[d], &names[d])))?;
    let n = result.axes[0].points;
    for (low, high, j) in &up {
        for (left, right, i) in &across {
            let rate = result.points.get(i + n * j).map_or(f64::NAN, |p| p.growth_rate);
            chart.draw_series([Rectangle::new(
                [(*left, *low), (*right, *high)],
                shades.colour(rate).filled(),
            )])?;
        }
    }
    let axes = result.axes;
    chart
        .configure_mesh()
        .disable_mesh()
        .axis_style(colour(MUTED))
        .label_style(text(13.0, INK))
        .axis_desc_style(text(14.0, INK))
        .x_desc(&names[0])
        .y_desc(&names[1])
        .x_label_formatter(&|v| label(&axes[0], *v))
        .y_label_formatter(&|v| label(&axes[1], *v))
        .draw()?;
    let spot = |p: [f64; 2]| (place(&axes[0], p[0]), place(&axes[1], p[1]));
    for line in &result.boundary.lines {
        draw_curve(&chart, line.iter().map(|k| spot(result.boundary.points[*k])), pen(INK, 3.0))?;
    }
    let own = spot(result.nominal);
    draw_dot(&chart, own, 7.0, "#ffffff")?;
    draw_ring(&chart, own, 7.0, (INK, 3.0))?;
    draw_bar(&bar, shades)
}

/// The colours with their values.
fn draw_bar(bar: &Area, shades: &Shades) -> Result<(), Box<dyn Error>> {
    const TOP: f64 = 72.0;
    const HEIGHT: f64 = 430.0;
    const STEPS: usize = 86;
    bar.draw_text("largest growth", &bold(12.5, INK), (10, 16))?;
    bar.draw_text("rate σ [1/s]", &bold(12.5, INK), (10, 32))?;
    bar.draw_text("square-root scale", &text(11.5, MUTED), (10, 49))?;
    let [low, high] = shades.ends.map(|rate| shades.place(rate));
    let length = (high - low).max(f64::MIN_POSITIVE);
    let down = |t: f64| (TOP + HEIGHT * (high - t) / length).round() as i32;
    for k in 0..STEPS {
        let part = |k: f64| high - length * k / STEPS as f64;
        let corners = [(10, down(part(k as f64))), (32, down(part((k + 1) as f64)))];
        let middle = diverging(part(k as f64 + 0.5));
        bar.draw(&Rectangle::new(corners, colour(&middle).filled()))?;
    }
    let outline = [(10, down(high)), (32, down(low))];
    bar.draw(&Rectangle::new(outline, colour(MUTED).stroke_width(1)))?;
    let left = |style: TextStyle<'static>| style.pos(Pos::new(HPos::Left, VPos::Center));
    for tick in shades.ticks(24.0 * length / HEIGHT) {
        let y = down(shades.place(tick));
        bar.draw(&PathElement::new([(32, y), (37, y)], colour(MUTED).stroke_width(1)))?;
        let words = if tick > 0.0 { format!("+{}", given(tick)) } else { given(tick) };
        bar.draw_text(&words, &left(text(12.5, INK)), (42, y))?;
    }
    if shades.gaps {
        let y = (TOP + HEIGHT) as i32 + 30;
        bar.draw(&Rectangle::new([(10, y - 8), (32, y + 8)], colour(NONE).filled()))?;
        bar.draw_text("no answer", &left(text(12.5, INK)), (42, y))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::sample;
    use crate::sweep::MapPoint;

    #[test]
    fn the_scale_is_named_and_words_are_those_of_the_colours() {
        let results = sample::rig();
        let mut result = results.all::<MapResult>()[0].clone();
        let drawn = picture(&result).unwrap();
        for words in ["square-root scale", "no answer", "load ΣN of rim [N]", "+10", "−10"] {
            assert!(drawn.svg.contains(words), "{words}");
        }
        assert!(drawn.caption.contains("orange to red where a mode grows, blue where all decay, grey"));
        // Growth that is weak beside the decay elsewhere is orange.
        let point = |growth_rate: f64| MapPoint { growth_rate, ..result.points[0] };
        result.points = (0..12).map(|k| point(if k == 5 { 10.0 } else { -100.0 })).collect();
        let weak = Shades::of(&result);
        assert_eq!(weak.words(), "orange where a mode grows, blue where all decay");
        assert_eq!((weak.place(-100.0), weak.place(25.0)), (-1.0, 0.5));
        let ticks = weak.ticks(0.05);
        assert!(ticks.contains(&-100.0) && ticks.contains(&10.0) && !ticks.contains(&20.0), "{ticks:?}");
    }
}
