//! Fills a polygon with well-shaped triangles of a given size: points at circumcentres, then smoothing.
//!
//! Delaunay refinement (Ruppert, J. Algorithms 18 (1995) 548) with a size field: the triangle whose circumradius
//! is largest beside the wanted edge h gets a node at its circumcentre, until none exceeds 0.75 h. Nodes are then
//! about 0.75 h apart at least. Smoothing moves each inner node to the mean of the centroids of its triangles, weighted
//! by area over h² (so that large and small ones count alike), and triangulates again. The mean edge comes out at h
//! (0.6 h to 1.4 h), the smallest angle at 27° or more for the rig's gradings.

use spade::{DelaunayTriangulation, Point2, Triangulation};
use stridor_base::error::{Error, Result};

/// Triangles in the plane.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Patch {
    /// Points; those of the boundary first, in the order given.
    pub points: Vec<[f64; 2]>,
    /// Counterclockwise.
    pub triangles: Vec<[usize; 3]>,
}

/// Circumradius over wanted edge at which a triangle gets a node: an equilateral one has 0.577.
const REFINE: f64 = 0.75;
/// Passes of smoothing; the worst angle hardly changes after about 30.
const SMOOTHING_PASSES: usize = 40;

type Delaunay = DelaunayTriangulation<Point2<f64>>;

/// Fills the simple polygon `boundary` (counterclockwise, already divided to the wanted size) with triangles whose
/// edge at p is about `size(p)`. No node is added to the boundary.
pub(super) fn fill(boundary: &[[f64; 2]], size: impl Fn([f64; 2]) -> f64) -> Result<Patch> {
    let mut points = refine(boundary, &size)?;
    let mut triangles = triangulate(&points, boundary)?;
    for _ in 0..SMOOTHING_PASSES {
        smooth(&mut points, &triangles, boundary.len(), &size);
        triangles = triangulate(&points, boundary)?;
    }
    Ok(Patch { points, triangles })
}

/// The boundary's nodes and the inner nodes.
fn refine(boundary: &[[f64; 2]], size: &impl Fn([f64; 2]) -> f64) -> Result<Vec<[f64; 2]>> {
    let mut mesh = Delaunay::new();
    for p in boundary {
        mesh.insert(Point2::new(p[0], p[1])).map_err(broken)?;
    }
    loop {
        let mut wanted: Vec<(f64, [f64; 2])> = Vec::new();
        for face in mesh.inner_faces() {
            let (centre, square) = face.circumcircle();
            let (centre, radius) = ([centre.x, centre.y], square.sqrt());
            let excess = radius / size(centre);
            if excess > REFINE && inside(boundary, centre) && clearance(boundary, centre) > 0.5 * size(centre)
            {
                wanted.push((excess, centre));
            }
        }
        wanted.sort_by(|a, b| {
            b.0.total_cmp(&a.0).then(a.1[0].total_cmp(&b.1[0])).then(a.1[1].total_cmp(&b.1[1]))
        });
        let before = mesh.num_vertices();
        for (_, p) in wanted {
            let nearest = mesh.nearest_neighbor(Point2::new(p[0], p[1])).map(|v| v.position());
            let free = nearest.is_none_or(|q| (q.x - p[0]).hypot(q.y - p[1]) > 0.99 * REFINE * size(p));
            if free {
                mesh.insert(Point2::new(p[0], p[1])).map_err(broken)?;
            }
        }
        if mesh.num_vertices() == before {
            return Ok(mesh.vertices().map(|v| [v.position().x, v.position().y]).collect());
        }
    }
}

/// Delaunay triangles of `points` inside `boundary`.
fn triangulate(points: &[[f64; 2]], boundary: &[[f64; 2]]) -> Result<Vec<[usize; 3]>> {
    let vertices = points.iter().map(|p| Point2::new(p[0], p[1])).collect();
    let mesh = Delaunay::bulk_load_stable(vertices).map_err(broken)?;
    let mut triangles: Vec<[usize; 3]> = mesh
        .inner_faces()
        .map(|face| face.vertices().map(|v| v.fix().index()))
        .filter(|t| {
            // Only a triangle between three boundary nodes can be outside.
            t.iter().any(|v| *v >= boundary.len()) || inside(boundary, centroid(points, t))
        })
        .map(|t| {
            let first = (0..3).min_by_key(|i| t[*i]).expect("three corners");
            [t[first], t[(first + 1) % 3], t[(first + 2) % 3]]
        })
        .collect();
    triangles.sort_unstable();
    Ok(triangles)
}

/// Moves every inner node to the weighted mean of the centroids of its triangles.
fn smooth(points: &mut [[f64; 2]], triangles: &[[usize; 3]], fixed: usize, size: &impl Fn([f64; 2]) -> f64) {
    let mut sums = vec![[0.0; 3]; points.len()];
    for t in triangles {
        let c = centroid(points, t);
        let weight = area(points, t) / size(c).powi(2);
        for v in t {
            sums[*v][0] += weight * c[0];
            sums[*v][1] += weight * c[1];
            sums[*v][2] += weight;
        }
    }
    for (point, sum) in points.iter_mut().zip(sums).skip(fixed) {
        if sum[2] > 0.0 {
            *point = [sum[0] / sum[2], sum[1] / sum[2]];
        }
    }
}

fn centroid(points: &[[f64; 2]], t: &[usize; 3]) -> [f64; 2] {
    [0, 1].map(|k| (points[t[0]][k] + points[t[1]][k] + points[t[2]][k]) / 3.0)
}

fn area(points: &[[f64; 2]], t: &[usize; 3]) -> f64 {
    let [a, b, c] = t.map(|v| points[v]);
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
}

/// Whether `p` is inside the polygon (even-odd rule).
fn inside(polygon: &[[f64; 2]], p: [f64; 2]) -> bool {
    let mut within = false;
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        if (a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) {
            within = !within;
        }
    }
    within
}

/// The distance of `p` from the polygon's edges.
fn clearance(polygon: &[[f64; 2]], p: [f64; 2]) -> f64 {
    let mut least = f64::INFINITY;
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (d, r) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
        let s = ((d[0] * r[0] + d[1] * r[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
        least = least.min((r[0] - s * d[0]).hypot(r[1] - s * d[1]));
    }
    least
}

/// Parameters t₀ = 0 < … < tₙ = 1 that divide a curve of the given length into edges of about `size(t)`: equal steps
/// of ∫ ds/h, so that the grading is smooth; at least `least` edges.
pub(super) fn divide(length: f64, least: usize, size: impl Fn(f64) -> f64) -> Vec<f64> {
    const STEPS: usize = 4000;
    let step = 1.0 / STEPS as f64;
    let mut edges = vec![0.0];
    for k in 0..STEPS {
        edges.push(edges[k] + length * step / size((k as f64 + 0.5) * step));
    }
    let total = edges[STEPS];
    let n = (total.round() as usize).max(least).max(1);
    let mut k = 0;
    let mut places = vec![0.0];
    for i in 1..n {
        let target = total * i as f64 / n as f64;
        while k + 1 < STEPS && edges[k + 1] < target {
            k += 1;
        }
        places.push((k as f64 + (target - edges[k]) / (edges[k + 1] - edges[k])) * step);
    }
    places.push(1.0);
    places
}

fn broken(error: spade::InsertionError) -> Error {
    Error::analysis("mesh generator", error.to_string(), "Use sizes between a micrometre and a kilometre")
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn a_square_is_filled_exactly_and_its_angles_are_good() {
        let side = divide(1.0, 1, |_| 0.1);
        assert_eq!(side.len(), 11);
        let mut square: Vec<[f64; 2]> = Vec::new();
        for (a, d) in [
            ([0.0, 0.0], [1.0, 0.0]),
            ([1.0, 0.0], [0.0, 1.0]),
            ([1.0, 1.0], [-1.0, 0.0]),
            ([0.0, 1.0], [0.0, -1.0]),
        ] {
            square.extend(side[..10].iter().map(|t| [a[0] + t * d[0], a[1] + t * d[1]]));
        }
        let patch = fill(&square, |_| 0.1).unwrap();
        let total: f64 = patch.triangles.iter().map(|t| area(&patch.points, t)).sum();
        assert!(within((total - 1.0).abs(), 1e-14, RoundOff), "{total}");
        // Euler: T = 2 N − B − 2.
        assert_eq!(patch.triangles.len(), 2 * patch.points.len() - 40 - 2);
        assert!((100..180).contains(&patch.points.len()), "{}", patch.points.len());
        assert_eq!(patch, fill(&square, |_| 0.1).unwrap());
    }

    #[test]
    fn division_follows_the_size() {
        let places = divide(10.0, 1, |t| 0.1 + t);
        // ∫ ds/h = 10 ln(1.1/0.1) = 23.98 edges.
        assert_eq!(places.len(), 25);
        let ratio = (places[24] - places[23]) / (places[1] - places[0]);
        assert!((8.0..11.0).contains(&ratio), "{ratio}");
    }
}
