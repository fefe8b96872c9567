//! `map_<name>.svg`: the largest growth rate over two parameters, with the boundary of stability.

use super::axis::{axis_name, between, place, value};
use crate::report::chart::{Chart, WIDTH};
use crate::report::colours::{INK, MUTED, NO_ANSWER, diverging};
use crate::report::format::given;
use crate::report::section::Picture;
use crate::report::svg::{Sheet, fill, ink, outlined, stroke};
use crate::results::{MapResult, file_name};
use std::ops::Range;

/// At most this many cells along an axis; a finer grid is thinned out in the picture.
const CELLS: usize = 160;

pub(super) fn picture(result: &MapResult) -> Option<Picture> {
    if result.points.is_empty() {
        return None;
    }
    let shades = Shades::of(result);
    let svg = drawn(result, &shades);
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

    fn colour(&self, rate: f64) -> String {
        if rate.is_finite() { diverging(self.place(rate)) } else { NO_ANSWER.into() }
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

/// Edges of the cells about the values as places on the axis, and the index of the value of each cell: halfway to the neighbours, and
/// not beyond what was computed.
fn cells(result: &MapResult, d: usize) -> Vec<(Range<f64>, usize)> {
    let axis = &result.axes[d];
    let step = axis.points.div_ceil(CELLS);
    let chosen: Vec<usize> = (0..axis.points).step_by(step).collect();
    let at: Vec<f64> = chosen.iter().map(|k| place(axis, axis.value(*k))).collect();
    let n = at.len();
    let edge = |k: usize| match k {
        0 => at[0],
        k if k == n => place(axis, axis.to),
        k => 0.5 * (at[k - 1] + at[k]),
    };
    (0..n).map(|k| (edge(k)..edge(k + 1), chosen[k])).collect()
}

fn drawn(result: &MapResult, shades: &Shades) -> String {
    let cells = [0, 1].map(|d| cells(result, d));
    let [across, up] = [0, 1].map(|d| {
        let (a, b) = (cells[d][0].0.start, cells[d][cells[d].len() - 1].0.end);
        let name = axis_name(&result.labels[d], &result.units[d]);
        between(&result.axes[d], &name, a.min(b)..a.max(b)).bare()
    });
    let mut chart = Chart::new([100.0, 16.0, 814.0, 552.0], across, up);
    let n = result.axes[0].points;
    for (high, j) in &cells[1] {
        for (wide, i) in &cells[0] {
            let rate = result.points.get(i + n * j).map_or(f64::NAN, |p| p.growth_rate);
            let corners = [[wide.start, high.start], [wide.end, high.end]];
            chart.bar(
                corners.map(|[x, y]| [value(&result.axes[0], x), value(&result.axes[1], y)]),
                &fill(&shades.colour(rate)),
            );
        }
    }
    for line in &result.boundary.lines {
        chart.line(line.iter().map(|k| result.boundary.points[*k]), &stroke(INK, 3.0));
    }
    chart.circle(result.nominal, 7.0, &outlined("#ffffff", INK, 3.0));
    let mut sheet = Sheet::new(WIDTH, 620.0);
    chart.draw(&mut sheet);
    draw_bar(&mut sheet, shades);
    sheet.finish()
}

/// The colours with their values.
fn draw_bar(sheet: &mut Sheet, shades: &Shades) {
    const TOP: f64 = 72.0;
    const HEIGHT: f64 = 430.0;
    const LEFT: f64 = 840.0;
    sheet.text([LEFT, 28.0], "largest growth", ink(12.5, INK).bold());
    sheet.text([LEFT, 44.0], "rate σ [1/s]", ink(12.5, INK).bold());
    sheet.text([LEFT, 60.0], "square-root scale", ink(11.5, MUTED));
    let [low, high] = shades.ends.map(|rate| shades.place(rate));
    let length = (high - low).max(f64::MIN_POSITIVE);
    let ticks = shades.ticks(24.0 * length / HEIGHT).into_iter().map(|tick| {
        let sign = if tick > 0.0 { "+" } else { "" };
        ((shades.place(tick) - low) / length, format!("{sign}{}", given(tick)))
    });
    sheet.colour_bar([LEFT, TOP], HEIGHT, |part| diverging(low + length * part), ticks);
    if shades.gaps {
        sheet.rectangle([LEFT, TOP + HEIGHT + 22.0], [22.0, 16.0], &fill(NO_ANSWER));
        sheet.text([LEFT + 32.0, TOP + HEIGHT + 34.0], "no answer", ink(12.5, INK));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use crate::sweep::MapPoint;

    #[test]
    fn the_scale_is_named_and_words_are_those_of_the_colours() {
        let results = sample::rig();
        let mut result = results.all::<MapResult>()[0].clone();
        result.points[11] = MapPoint::NONE;
        let drawn = picture(&result).unwrap();
        for words in ["square-root scale", "no answer", "sliding velocity V of rim [m/s]", "+10"] {
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
