//! Polygons in a plane, cut to a convex window.

/// A point of the plane.
pub(super) type Point = [f64; 2];

/// (b − a) × (x − a): positive where `x` is on the left of the way from `a` to `b`.
fn left(a: Point, b: Point, x: Point) -> f64 {
    (b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0])
}

/// The area of a polygon; positive when its corners are counter-clockwise.
pub(super) fn area(polygon: &[Point]) -> f64 {
    triangles(polygon).map(|[a, b, c]| 0.5 * left(a, b, c)).sum()
}

/// The triangles between the first corner of a polygon and each of its other edges. Integrals over them, with the signs of their areas, add up to
/// that over the polygon, convex or not.
pub(super) fn triangles(polygon: &[Point]) -> impl Iterator<Item = [Point; 3]> + '_ {
    (2..polygon.len()).map(|k| [polygon[0], polygon[k - 1], polygon[k]])
}

/// The part of a polygon that is inside of a convex one whose corners are counter-clockwise (I. E. Sutherland & G. W. Hodgman, Comm. ACM 17
/// (1974) 32). Of a polygon that is not convex, pieces stay joined by edges that are run through both ways and have no area between them.
pub(super) fn clip(polygon: &[Point], window: &[Point]) -> Vec<Point> {
    let mut kept = polygon.to_vec();
    for (k, a) in window.iter().enumerate() {
        let b = window[(k + 1) % window.len()];
        let sides: Vec<f64> = kept.iter().map(|x| left(*a, b, *x)).collect();
        if sides.iter().all(|side| *side >= 0.0) {
            continue;
        }
        let mut inside = Vec::with_capacity(kept.len() + 1);
        for (i, x) in kept.iter().enumerate() {
            let j = (i + 1) % kept.len();
            if sides[i] >= 0.0 {
                inside.push(*x);
            }
            if (sides[i] >= 0.0) != (sides[j] >= 0.0) {
                // From the corner inside, so that two polygons that share an edge have the same point on it.
                let (from, to) = if sides[i] >= 0.0 { (i, j) } else { (j, i) };
                let share = sides[from] / (sides[from] - sides[to]);
                inside.push(std::array::from_fn(|c| kept[from][c] + share * (kept[to][c] - kept[from][c])));
            }
        }
        kept = inside;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    const SQUARE: [Point; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    fn near(found: f64, right: f64) -> bool {
        within((found - right).abs(), 1e-14, RoundOff)
    }

    #[test]
    fn parts_inside_have_the_area_that_is_common() {
        for (polygon, right) in [
            (vec![[0.5, 0.5], [1.5, 0.5], [1.5, 1.5], [0.5, 1.5]], 0.25),
            (vec![[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]], 1.0),
            (vec![[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]], 1.0),
            (vec![[0.2, 0.2], [0.4, 0.2], [0.3, 0.6]], 0.04),
            (vec![[2.0, 0.0], [3.0, 0.0], [2.0, 1.0]], 0.0),
            (vec![[1.0, 0.0], [2.0, 0.0], [1.0, 1.0]], 0.0),
            // A notch down to the middle, and a U whose legs alone are inside.
            (vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 0.5], [0.0, 1.0]], 0.75),
            (
                [
                    [0.1, 0.5],
                    [0.1, 2.0],
                    [0.9, 2.0],
                    [0.9, 0.5],
                    [0.8, 0.5],
                    [0.8, 1.5],
                    [0.2, 1.5],
                    [0.2, 0.5],
                ]
                .iter()
                .rev()
                .copied()
                .collect(),
                0.1,
            ),
        ] {
            let part = clip(&polygon, &SQUARE);
            assert!(near(area(&part), right), "{polygon:?} {part:?}");
            assert!(part.iter().flatten().all(|x| within((x - 0.5).abs() - 0.5, 1e-14, RoundOff)));
        }
    }

    /// A grid of unlike cells, turned, that covers the square: its parts add up to the area of the square.
    #[test]
    fn cells_that_share_edges_leave_no_gap() {
        let turned = |x: f64, y: f64| {
            let (sin, cos) = 0.3_f64.sin_cos();
            [0.5 + cos * (x - 0.5) - sin * (y - 0.5), 0.5 + sin * (x - 0.5) + cos * (y - 0.5)]
        };
        let at = |k: usize| -0.5 + 2.0 * (k as f64 / 7.0);
        let mut sum = 0.0;
        for (i, j) in (0..7).flat_map(|i| (0..7).map(move |j| (i, j))) {
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| turned(at(i), at(j)));
            sum += area(&clip(&corners, &SQUARE));
        }
        assert!(near(sum, 1.0), "{sum}");
    }
}
