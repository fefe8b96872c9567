//! Where a field on a triangle mesh lies above a level, as closed outlines.
//!
//! In each triangle the field is linear, and the part of it above the level is a polygon. Sides that two polygons
//! share cancel; what is left, joined end to end, is the outline. Painting the regions of ascending levels over
//! each other gives a smooth picture with no seams, whose size grows with the outlines and not with the mesh.

use std::collections::BTreeMap;

/// The region where a field is at or above a level.
#[derive(Debug, Default)]
pub(super) struct FilledContour {
    /// Its outlines, holes included.
    pub loops: Vec<Vec<[f64; 2]>>,
    /// The stretches of the outline on which the field equals the level, one a triangle.
    pub level_lines: Vec<[[f64; 2]; 2]>,
}

/// A corner of the region: a node (k, k), or the crossing of the level with the edge between two nodes.
type Corner = (usize, usize);

/// The region where the field `values`, given at `points`, is at least `level`; triangles are of either turn.
pub(super) fn at_least(
    points: &[[f64; 2]],
    triangles: &[[usize; 3]],
    values: &[f64],
    level: f64,
) -> FilledContour {
    let mut region = FilledContour::default();
    // Directed sides, region on the left; a list for each start, since regions may touch at a corner.
    let mut sides: BTreeMap<Corner, Vec<Corner>> = BTreeMap::new();
    let place = |(a, b): Corner| {
        if a == b {
            return points[a];
        }
        let t = (level - values[a]) / (values[b] - values[a]);
        [0, 1].map(|c| points[a][c] + t * (points[b][c] - points[a][c]))
    };
    for triangle in triangles {
        let [mut a, b, mut c] = *triangle;
        if turns_right(points[a], points[b], points[c]) {
            std::mem::swap(&mut a, &mut c);
        }
        let mut polygon: Vec<Corner> = vec![];
        let mut crossings: Vec<Corner> = vec![];
        for (from, to) in [(a, b), (b, c), (c, a)] {
            if values[from] >= level {
                polygon.push((from, from));
            }
            if (values[from] >= level) != (values[to] >= level) {
                let corner = (from.min(to), from.max(to));
                polygon.push(corner);
                crossings.push(corner);
            }
        }
        if let [first, second] = crossings[..] {
            let line = [place(first), place(second)];
            // A triangle may touch the level with a corner only.
            if line[0] != line[1] {
                region.level_lines.push(line);
            }
        }
        for (k, from) in polygon.iter().enumerate() {
            add_side(&mut sides, *from, polygon[(k + 1) % polygon.len()]);
        }
    }
    while let Some((&start, _)) = sides.first_key_value() {
        let mut outline = vec![];
        let mut here = start;
        while let Some(next) = take_side(&mut sides, here) {
            outline.push(place(here));
            here = next;
        }
        region.loops.push(outline);
    }
    region
}

/// Adds a directed side, or cancels it with the same side of the neighbour.
fn add_side(sides: &mut BTreeMap<Corner, Vec<Corner>>, from: Corner, to: Corner) {
    if let Some(back) = sides.get_mut(&to)
        && let Some(k) = back.iter().position(|end| *end == from)
    {
        back.swap_remove(k);
        if back.is_empty() {
            sides.remove(&to);
        }
    } else {
        sides.entry(from).or_default().push(to);
    }
}

/// Takes a side that begins at `from`.
fn take_side(sides: &mut BTreeMap<Corner, Vec<Corner>>, from: Corner) -> Option<Corner> {
    let ends = sides.get_mut(&from)?;
    let end = ends.pop();
    if ends.is_empty() {
        sides.remove(&from);
    }
    end
}

fn turns_right(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> bool {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    /// The unit square in 2 n² triangles.
    fn square(n: usize) -> (Vec<[f64; 2]>, Vec<[usize; 3]>) {
        let h = 1.0 / n as f64;
        let points =
            (0..(n + 1) * (n + 1)).map(|k| [(k % (n + 1)) as f64 * h, (k / (n + 1)) as f64 * h]).collect();
        let mut triangles = vec![];
        for k in (0..n * (n + 1)).filter(|k| k % (n + 1) < n) {
            triangles.push([k, k + 1, k + n + 2]);
            triangles.push([k, k + n + 1, k + n + 2]);
        }
        (points, triangles)
    }

    /// Signed area: holes count as negative.
    fn area(region: &FilledContour) -> f64 {
        let one = |l: &Vec<[f64; 2]>| -> f64 {
            (0..l.len()).map(|k| (l[k], l[(k + 1) % l.len()])).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
        };
        0.5 * region.loops.iter().map(one).sum::<f64>()
    }

    #[test]
    fn the_area_above_a_plane_is_exact() {
        let (points, triangles) = square(7);
        let values: Vec<f64> = points.iter().map(|p| p[0] + 0.3 * p[1]).collect();
        // x ≥ 0.5 − 0.3 y on the unit square: 1 − ∫(0.5 − 0.3 y) dy = 0.65.
        let region = at_least(&points, &triangles, &values, 0.5);
        assert_eq!(region.loops.len(), 1);
        assert!(within((area(&region) - 0.65).abs(), 1e-12, RoundOff));
        let length: f64 = region.level_lines.iter().map(|[a, b]| (a[0] - b[0]).hypot(a[1] - b[1])).sum();
        assert!(within((length - 1.09_f64.sqrt()).abs(), 1e-12, RoundOff));
    }

    #[test]
    fn a_ring_has_a_hole_and_the_circle_is_met() {
        let (points, triangles) = square(60);
        let values: Vec<f64> = points.iter().map(|p| (p[0] - 0.5).hypot(p[1] - 0.5)).collect();
        let region = at_least(&points, &triangles, &values, 0.3);
        assert_eq!(region.loops.len(), 2);
        let exact = 1.0 - std::f64::consts::PI * 0.09;
        // The chords of a circle cut off about h²/8 of its length: (1/60)² · 2π · 0.3 / 8 = 6.5e-5 at most.
        assert!(within((area(&region) - exact).abs(), 2e-4, Discretisation));
        assert!(at_least(&points, &triangles, &values, 2.0).loops.is_empty());
        assert!(within(
            (area(&at_least(&points, &triangles, &values, f64::NEG_INFINITY)) - 1.0).abs(),
            1e-12,
            RoundOff
        ));
    }
}
