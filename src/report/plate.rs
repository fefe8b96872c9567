//! A plate of the model seen face-on, and a field painted on it in colour steps.

use super::colours::{INK, MUTED, diverging};
use super::contours::at_least;
use super::svg::{Sheet, SvgPoint, fill, ink, outlined, stroke};
use super::view::{View, ViewVector, along, cross, dot};
use crate::results::Geometry;

/// Half the number of colour steps.
pub(super) const STEPS: i32 = 6;

/// A plate seen along its mean normal.
pub(super) struct PlateView {
    /// Its nodes, ascending.
    pub nodes: Vec<usize>,
    /// Where each is on the picture \[m\].
    pub points: Vec<[f64; 2]>,
    /// Triangles of indices into `nodes`.
    pub triangles: Vec<[usize; 3]>,
    /// Towards the viewer.
    pub normal: ViewVector,
}

impl PlateView {
    /// The faces of `part`; `None` when it has none, they face no common side, or are those of a solid.
    pub(super) fn new(geometry: &Geometry, part: usize) -> Option<Self> {
        if geometry.is_solid(part) {
            return None;
        }
        let faces =
            geometry.elements.iter().zip(&geometry.part_of).filter(|(e, p)| **p == part && e.len() >= 3);
        let corners: Vec<[usize; 3]> =
            faces.flat_map(|(e, _)| (2..e.len()).map(|k| [e[0], e[k - 1], e[k]])).collect();
        let mut nodes: Vec<usize> = corners.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let local = |node: &usize| nodes.binary_search(node).expect("collected from the same corners");
        let triangles: Vec<[usize; 3]> =
            corners.iter().map(|c| [local(&c[0]), local(&c[1]), local(&c[2])]).collect();
        let area = |[a, b, c]: &[usize; 3]| {
            let [a, b, c] = [*a, *b, *c].map(|k| geometry.nodes[k]);
            cross(along(b, -1.0, a), along(c, -1.0, a))
        };
        // The faces may be turned either way; the first decides.
        let first = area(corners.first()?);
        let sum = corners.iter().map(area).fold([0.0; 3], |sum, n| along(sum, dot(n, first).signum(), n));
        // Seen from +x, or from above when the plate lies flat.
        let toward_eye = if sum[0].abs() > 1e-6 * dot(sum, sum).sqrt() { sum[0] } else { sum[2] };
        let viewer = if toward_eye < 0.0 { sum.map(|c| -c) } else { sum };
        let view = View::facing(viewer)?;
        let points = nodes.iter().map(|k| view.project(geometry.nodes[*k])).collect();
        Some(PlateView { nodes, points, triangles, normal: view.towards })
    }

    /// Paints `values` in [−1, 1], one a node of the plate, at the places `pixels`.
    pub(super) fn paint(&self, sheet: &mut Sheet, pixels: &[SvgPoint], values: &[f64]) {
        for step in -STEPS..STEPS {
            let level = if step == -STEPS { f64::NEG_INFINITY } else { f64::from(step) / f64::from(STEPS) };
            let region = at_least(pixels, &self.triangles, values, level);
            let colour = diverging((f64::from(step) + 0.5) / f64::from(STEPS));
            let style = if step == -STEPS { outlined(&colour, MUTED, 1.6) } else { fill(&colour) };
            if !region.loops.is_empty() {
                sheet.polygons(region.loops.iter().map(Vec::as_slice), &style);
            }
        }
    }
}

/// The colour steps beside each other, `step` pixels a step, with words at both ends and in the middle; returns the width of them all.
pub(super) fn colour_bar(sheet: &mut Sheet, [left, y]: SvgPoint, step: f64, [low, high]: [&str; 2]) -> f64 {
    for k in -STEPS..STEPS {
        let x = left + step * f64::from(k + STEPS);
        let colour = diverging((f64::from(k) + 0.5) / f64::from(STEPS));
        sheet.rectangle([x, y], [step + 0.3, 14.0], &fill(&colour));
    }
    let width = 2.0 * f64::from(STEPS) * step;
    sheet.rectangle([left, y], [width, 14.0], &stroke(MUTED, 0.8));
    for (place, words) in [(0.0, low), (0.5, "0"), (1.0, high)] {
        sheet.text([left + place * width, y + 29.0], words, ink(12.5, INK).middle());
    }
    width
}
