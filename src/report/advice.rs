//! `advice.svg`: where on the plates a gram of mass or a damper calms each chosen mode, and where it does harm.

use super::colours::{INK, MUTED};
use super::format::{hertz, signed, significant};
use super::plate::{PlateView, colour_bar};
use super::section::Picture;
use super::svg::{Sheet, SvgPoint, ink, stroke};
use super::view::PlacedView;
use crate::results::{ModeSensitivity, RunResults, SensitivityResult};
use std::f64::consts::TAU;

/// Modes at most, the strongest growth first.
const MOST_MODES: usize = 6;
/// Plates at most.
const MOST_PLATES: usize = 2;
const CELL: [f64; 2] = [230.0, 236.0];
const LEFT: f64 = 118.0;
const HEAD: f64 = 62.0;
const FOOT: f64 = 56.0;

/// A column: what is mounted, and σ per so much of it at every node.
type Thing = (&'static str, &'static str, fn(&ModeSensitivity) -> Option<Vec<f64>>);

const THINGS: [Thing; 2] = [
    ("1 g of mass", "mass", |mode| Some(mode.advice.as_ref()?.mass.iter().map(|m| 1e-3 * m.re).collect())),
    ("a damper of 1 N s/m across the plate", "damper", |mode| {
        Some(mode.advice.as_ref()?.damping.iter().map(|d| d[3].re).collect())
    }),
];

/// The picture, when there is advice and a plate to show it on.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let mut modes: Vec<&ModeSensitivity> =
        results.get::<SensitivityResult>()?.modes.iter().filter(|mode| mode.advice.is_some()).collect();
    modes.sort_by(|a, b| b.eigenvalue.re.total_cmp(&a.eigenvalue.re));
    modes.truncate(MOST_MODES);
    modes.sort_by(|a, b| a.eigenvalue.im.total_cmp(&b.eigenvalue.im));
    let geometry = &results.geometry;
    let plates: Vec<(usize, PlateView)> = (0..geometry.parts.len())
        .filter_map(|part| Some((part, PlateView::new(geometry, part)?)))
        .take(MOST_PLATES)
        .collect();
    if modes.is_empty() || plates.is_empty() {
        return None;
    }
    let columns = THINGS.len() * plates.len();
    let height = HEAD + CELL[1] * modes.len() as f64;
    let mut sheet = Sheet::new(LEFT + CELL[0] * columns as f64 + 12.0, height + FOOT);
    for (t, (title, ..)) in THINGS.iter().enumerate() {
        let centre = LEFT + CELL[0] * plates.len() as f64 * (t as f64 + 0.5);
        sheet.text([centre, 24.0], title, ink(15.0, INK).bold().middle());
        for (p, (part, _)) in plates.iter().enumerate() {
            let x = LEFT + CELL[0] * ((t * plates.len() + p) as f64 + 0.5);
            sheet.text([x, 46.0], &geometry.parts[*part], ink(13.0, MUTED).middle());
        }
    }
    for (m, mode) in modes.iter().enumerate() {
        let top = HEAD + CELL[1] * m as f64;
        let middle = top + 0.42 * CELL[1];
        let name = format!("{} Hz", hertz(mode.eigenvalue.im / TAU, 0));
        sheet.text([14.0, middle], &name, ink(15.0, INK).bold());
        let rate = format!("σ {} 1/s", signed(mode.eigenvalue.re, 1));
        sheet.text([14.0, middle + 20.0], &rate, ink(13.0, MUTED));
        for (t, (_, kind, field)) in THINGS.iter().enumerate() {
            let Some(values) = field(mode) else { continue };
            for (p, (_, plate)) in plates.iter().enumerate() {
                let corner = [LEFT + CELL[0] * (t * plates.len() + p) as f64, top];
                let best = mode.best.iter().find(|b| b.kind == *kind).map(|b| b.node);
                draw_cell(&mut sheet, corner, plate, &values, best);
            }
        }
    }
    draw_legend(&mut sheet, height + 8.0);
    let caption = "Where a small thing mounted on the structure changes the growth rate, to first order. Each plate has its \
                   own colour scale; cross: the best place on the whole structure."
        .to_string();
    Some(Picture { file: "advice".into(), caption, svg: sheet.finish() })
}

fn draw_cell(sheet: &mut Sheet, [x, y]: SvgPoint, plate: &PlateView, values: &[f64], best: Option<usize>) {
    let own: Vec<f64> = plate.nodes.iter().map(|k| values.get(*k).copied().unwrap_or(0.0)).collect();
    let size = own.iter().map(|v| v.abs()).filter(|v| v.is_finite()).fold(0.0, f64::max);
    let scale = if size > 0.0 { 1.0 / size } else { 0.0 };
    let scaled: Vec<f64> = own.iter().map(|v| if v.is_finite() { v * scale } else { 0.0 }).collect();
    let fit =
        PlacedView::new(plate.points.iter().copied(), [x + 14.0, y + 8.0], [CELL[0] - 28.0, CELL[1] - 52.0]);
    let pixels: Vec<SvgPoint> = plate.points.iter().map(|p| fit.pixel(*p)).collect();
    plate.paint(sheet, &pixels, &scaled);
    if let Some(k) = best.and_then(|node| plate.nodes.binary_search(&node).ok()) {
        let [u, v] = pixels[k];
        let arms = [[[u - 7.0, v - 7.0], [u + 7.0, v + 7.0]], [[u - 7.0, v + 7.0], [u + 7.0, v - 7.0]]];
        for (colour, width) in [("#ffffff", 5.0), (INK, 2.4)] {
            let style = stroke(colour, width) + " stroke-linecap=\"round\"";
            sheet.lines(arms.iter().map(|arm| &arm[..]), &style);
        }
    }
    let low = own.iter().copied().fold(0.0, f64::min);
    let high = own.iter().copied().fold(0.0, f64::max);
    let plus = if high > 0.0 { "+" } else { "" };
    let range = format!("{} … {plus}{} 1/s", significant(low, 3), significant(high, 3));
    sheet.text([x + 0.5 * CELL[0], y + CELL[1] - 22.0], &range, ink(12.5, INK).middle());
}

fn draw_legend(sheet: &mut Sheet, y: f64) {
    let width = colour_bar(sheet, [LEFT + 16.0, y], 14.0, ["stabilises", "destabilises"]);
    let note =
        "change of σ per addition mounted at a place; the range below each plate belongs to its colours";
    sheet.text([LEFT + width + 60.0, y + 12.0], note, ink(12.5, INK));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use crate::results::Geometry;

    #[test]
    fn every_mode_has_its_row_and_the_best_place_a_cross() {
        let results = sample::rig();
        let svg = picture(&results).unwrap().svg;
        for label in ["276 Hz", "332 Hz", "569 Hz", ">1 g of mass<", ">disc<", ">slider<"] {
            assert!(svg.contains(label), "{label}");
        }
        // The best place of a mass and that of a damper, all of them on the disc.
        assert_eq!(svg.matches("stroke-width=\"2.4\"").count(), 6);
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn without_advice_or_plates_there_is_no_picture() {
        let mut results = sample::rig();
        results.geometry = Geometry::default();
        assert!(picture(&results).is_none());
        let mut results = sample::rig();
        results.get_mut::<SensitivityResult>().unwrap().modes.iter_mut().for_each(|mode| mode.advice = None);
        assert!(picture(&results).is_none());
    }
}
