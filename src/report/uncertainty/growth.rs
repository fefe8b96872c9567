//! `uncertainty_<name>_growth.svg`: how the largest growth rate is distributed, and how the probability of instability settles.

use super::words::{file, level, percent};
use crate::report::chart::{Axis, Chart, WIDTH, wide};
use crate::report::colours::{ALARM, CALM, INK};
use crate::report::html::described;
use crate::report::section::Picture;
use crate::report::svg::{Sheet, fill, outlined, sheer, stroke};
use crate::results::UncertaintyResult;
use crate::sweep::MapPoint;
use crate::uncertainty::proportion;

/// Bars of the histogram at most, on either side of zero.
const BARS: usize = 24;
/// Places at which the settling probability is drawn.
const STEPS: usize = 200;

pub(super) fn picture(result: &UncertaintyResult) -> Option<Picture> {
    let rates = result.growth_rates();
    if rates.is_empty() {
        return None;
    }
    let mut sheet = Sheet::new(WIDTH, 560.0);
    histogram(&rates, result).draw(&mut sheet);
    settling(result).draw(&mut sheet);
    let caption = format!(
        "Above: samples by their largest growth rate, orange where a mode grows. Below: the probability of instability after so many samples, with its interval of {} confidence.",
        level(result)
    );
    let seen = format!(
        "Histogram of the largest growth rate of {} samples; below, the probability of instability settles at {}.",
        rates.len(),
        percent(result.unstable.share)
    );
    Some(Picture { file: file(result, "_growth"), caption, svg: described(&sheet.finish(), &seen) })
}

/// The width of the bars, and how many lie below and above zero.
fn bars(ascending: &[f64]) -> (f64, [usize; 2]) {
    let low = ascending.first().copied().unwrap_or(0.0).min(0.0);
    let high = ascending.last().copied().unwrap_or(0.0).max(0.0);
    let wanted = (ascending.len() as f64).sqrt().clamp(8.0, BARS as f64);
    let width = ((high - low) / wanted).max(f64::MIN_POSITIVE);
    // One more, for a value at the end.
    (width, [-low, high].map(|end| (end / width).floor() as usize + 1))
}

/// How many samples are in each bar: those in which no mode grows, and those in which one does. Without damping the rates of the former
/// are zero but for rounding, in the first bar above zero.
fn counts(points: &[Option<MapPoint>], width: f64, [below, above]: [usize; 2]) -> Vec<[usize; 2]> {
    let mut counts = vec![[0; 2]; below + above];
    for point in points.iter().flatten().filter(|point| point.growth_rate.is_finite()) {
        let bar = (point.growth_rate / width).floor() as i64 + below as i64;
        counts[(bar.max(0) as usize).min(below + above - 1)][usize::from(point.unstable > 0)] += 1;
    }
    counts
}

fn histogram(rates: &[f64], result: &UncertaintyResult) -> Chart {
    let (width, sides @ [below, above]) = bars(rates);
    let counts = counts(&result.points, width, sides);
    let most = counts.iter().map(|[stable, unstable]| stable + unstable).max().unwrap_or(1) as f64;
    let edge = |bar: usize| (bar as f64 - below as f64) * width;
    let across = Axis::new("largest growth rate σ [1/s]", edge(0)..edge(below + above));
    let mut chart = Chart::new(wide(14.0, 258.0), across, Axis::new("samples", 0.0..1.08 * most));
    for (bar, [stable, unstable]) in counts.into_iter().enumerate() {
        // One above the other.
        for (from, count, hex) in [(0, stable, CALM), (stable, unstable, ALARM)] {
            if count > 0 {
                let corners = [[edge(bar), from as f64], [edge(bar + 1), (from + count) as f64]];
                chart.bar(corners, &sheer(outlined(hex, "#ffffff", 1.0), 0.85));
            }
        }
    }
    chart.rule(0, 0.0, &stroke(INK, 1.5));
    chart
}

fn settling(result: &UncertaintyResult) -> Chart {
    let verdicts: Vec<bool> = result.points.iter().flatten().map(|point| point.unstable > 0).collect();
    let all = verdicts.len();
    let steps = STEPS.min(all);
    let (mut count, mut done) = (0, 0);
    let mut along = Vec::new();
    for step in 1..=steps {
        let until = all * step / steps;
        count += verdicts[done..until].iter().filter(|grows| **grows).count();
        done = until;
        let found = proportion(count, done, result.study.confidence);
        along.push((done as f64, 100.0 * found.share, found.limits.map(|share| 100.0 * share)));
    }
    let highest = along.iter().map(|(.., [_, high])| *high).fold(0.0, f64::max);
    let lowest = along.iter().map(|(.., [low, _])| *low).fold(100.0, f64::min);
    let up = Axis::new("probability [%]", (lowest - 3.0).max(0.0)..(highest + 3.0).min(103.0));
    let mut chart = Chart::new(wide(322.0, 508.0), Axis::new("samples", 0.0..all as f64 * 1.02), up);
    let band = along.iter().map(|(n, _, [low, _])| [*n, *low]);
    let band = band.chain(along.iter().rev().map(|(n, _, [_, high])| [*n, *high]));
    chart.polygon(band, &sheer(fill(ALARM), 0.18));
    chart.line(along.iter().map(|(n, share, _)| [*n, *share]), &stroke(ALARM, 2.0));
    chart
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_begin_at_zero() {
        let (width, [below, above]) = bars(&[-1.0, -0.5, 0.0, 3.0]);
        assert_eq!((width, below, above), (0.5, 3, 7));
        let (width, sides) = bars(&[2.0, 4.0]);
        assert_eq!((width, sides), (0.5, [1, 9]));
        assert!(bars(&[0.0]).0 > 0.0);
    }

    #[test]
    fn samples_without_growth_are_counted_apart_where_they_are_zero_but_for_rounding() {
        let point =
            |growth_rate: f64, unstable: u32| Some(MapPoint { growth_rate, unstable, ..MapPoint::NONE });
        let points = [point(1e-17, 0), point(-1e-17, 0), point(0.2, 1), point(1.0, 2), None];
        assert_eq!(counts(&points, 0.5, [1, 3]), [[1, 0], [1, 1], [0, 0], [0, 1]]);
    }
}
