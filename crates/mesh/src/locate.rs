//! The nearest point of a set of faces, by a tree of boxes.

use super::Cell;
use super::quality::{dot, minus, norm};

/// Points of faces whose distances differ by less than this share of the size of a face are equally near.
const EQUAL: f64 = 1e-9;
/// Curved faces bulge over the box of their nodes by less than this share of its diagonal.
const BULGE: f64 = 0.15;
/// Faces in a leaf of the tree.
const LEAF: usize = 4;
/// Steps of Newton's method.
const STEPS: usize = 40;
/// Steps of reference coordinates below this are round-off.
const STEP: f64 = 1e-13;

/// A point of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocatedPoint {
    /// The face, an index into those searched.
    pub face: usize,
    /// Its reference coordinates (ξ, η, 0).
    pub at: [f64; 3],
    /// Where it is \[m\].
    pub position: [f64; 3],
    /// How far it is from the place asked for \[m\].
    pub distance: f64,
}

/// Faces of any kind in which nearest points are looked for.
#[derive(Debug)]
pub struct FaceTree<'a> {
    nodes: &'a [[f64; 3]],
    faces: &'a [Cell],
    /// Numbers of faces in the order of the leaves.
    order: Vec<usize>,
    branches: Vec<Branch>,
}

/// The box of some faces; the first branch is that of all.
#[derive(Debug)]
struct Branch {
    low: [f64; 3],
    high: [f64; 3],
    /// The faces `order[range]`.
    range: std::ops::Range<usize>,
    /// The two halves of a branch that is no leaf.
    halves: Option<[usize; 2]>,
}

impl Branch {
    /// Its distance from a place; zero inside.
    fn distance(&self, x: [f64; 3]) -> f64 {
        norm(std::array::from_fn(|k| (self.low[k] - x[k]).max(x[k] - self.high[k]).max(0.0)))
    }
}

impl<'a> FaceTree<'a> {
    /// The tree of `faces` on nodes with the given coordinates \[m\].
    pub fn new(nodes: &'a [[f64; 3]], faces: &'a [Cell]) -> Self {
        let mut tree = FaceTree { nodes, faces, order: (0..faces.len()).collect(), branches: Vec::new() };
        let boxes: Vec<[[f64; 3]; 2]> = faces.iter().map(|face| tree.bounds(face)).collect();
        tree.grow(0..faces.len(), &boxes);
        tree
    }

    /// The box of a face, widened for its curvature.
    fn bounds(&self, face: &Cell) -> [[f64; 3]; 2] {
        let at = |k: usize| face.nodes().iter().map(move |node| self.nodes[*node][k]);
        let low: [f64; 3] = std::array::from_fn(|k| at(k).fold(f64::INFINITY, f64::min));
        let high: [f64; 3] = std::array::from_fn(|k| at(k).fold(f64::NEG_INFINITY, f64::max));
        let margin = if face.kind().is_first_order() { 0.0 } else { BULGE * norm(minus(high, low)) };
        [low.map(|x| x - margin), high.map(|x| x + margin)]
    }

    fn grow(&mut self, range: std::ops::Range<usize>, boxes: &[[[f64; 3]; 2]]) -> usize {
        let of = |pick: fn(f64, f64) -> f64, side: usize, start: f64| -> [f64; 3] {
            let own = &self.order[range.clone()];
            std::array::from_fn(|k| own.iter().map(|face| boxes[*face][side][k]).fold(start, pick))
        };
        let (low, high) = (of(f64::min, 0, f64::INFINITY), of(f64::max, 1, f64::NEG_INFINITY));
        let number = self.branches.len();
        self.branches.push(Branch { low, high, range: range.clone(), halves: None });
        if range.len() > LEAF {
            let longest = (1..3).fold(0, |b, k| if high[k] - low[k] > high[b] - low[b] { k } else { b });
            let middle = |face: &usize| boxes[*face][0][longest] + boxes[*face][1][longest];
            self.order[range.clone()].sort_by(|a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
            let half = range.start + range.len() / 2;
            let halves = [self.grow(range.start..half, boxes), self.grow(half..range.end, boxes)];
            self.branches[number].halves = Some(halves);
        }
        number
    }

    /// The nearest points of the faces to `x`: one, or one on each of the faces that are equally near, as where they meet; in the order of the
    /// faces. None where there are no faces.
    pub fn nearest(&self, x: [f64; 3]) -> Vec<LocatedPoint> {
        let mut found: Vec<LocatedPoint> = Vec::new();
        let (mut best, mut tolerance) = (f64::INFINITY, 0.0);
        let mut left = if self.faces.is_empty() { Vec::new() } else { vec![0] };
        while let Some(number) = left.pop() {
            let branch = &self.branches[number];
            if branch.distance(x) > best + tolerance {
                continue;
            }
            match branch.halves {
                // The nearer one first.
                Some([a, b]) => {
                    let near = self.branches[a].distance(x) <= self.branches[b].distance(x);
                    left.extend(if near { [b, a] } else { [a, b] });
                }
                None => {
                    for face in &self.order[branch.range.clone()] {
                        let point = self.nearest_on(*face, x);
                        if point.distance < best {
                            best = point.distance;
                            tolerance = EQUAL * self.size(*face);
                        }
                        found.push(point);
                    }
                }
            }
        }
        found.retain(|point| point.distance <= best + tolerance);
        found.sort_by_key(|point| point.face);
        found
    }

    /// The faces that may reach into a box, ascending: those in leaves whose boxes do.
    pub fn faces_in(&self, low: [f64; 3], high: [f64; 3]) -> Vec<usize> {
        let mut found = Vec::new();
        let mut left = if self.faces.is_empty() { Vec::new() } else { vec![0] };
        while let Some(number) = left.pop() {
            let branch = &self.branches[number];
            if (0..3).any(|k| branch.low[k] > high[k] || branch.high[k] < low[k]) {
                continue;
            }
            match branch.halves {
                Some(halves) => left.extend(halves),
                None => found.extend_from_slice(&self.order[branch.range.clone()]),
            }
        }
        found.sort_unstable();
        found
    }

    /// The longest way between a corner of a face and its first one \[m\].
    pub fn size(&self, face: usize) -> f64 {
        let corners = self.faces[face].corners();
        corners.iter().map(|c| norm(minus(self.nodes[*c], self.nodes[corners[0]]))).fold(0.0, f64::max)
    }

    /// The point of a face at reference coordinates.
    fn point(&self, face: usize, at: [f64; 3], x: [f64; 3]) -> LocatedPoint {
        let position = self.faces[face].position(self.nodes, at);
        LocatedPoint { face, at, position, distance: norm(minus(x, position)) }
    }

    /// ∂x/∂ξ and ∂x/∂η of a face.
    pub fn tangents(&self, face: usize, at: [f64; 3]) -> [[f64; 3]; 2] {
        let [a, b, _] = self.faces[face].tangents(self.nodes, at);
        [a, b]
    }

    /// The nearest point of one face: that of its flat pieces, then by Newton's method inside of it and along its edges.
    pub fn nearest_on(&self, face: usize, x: [f64; 3]) -> LocatedPoint {
        let cell = &self.faces[face];
        let kind = cell.kind();
        let places = kind.reference_coordinates();
        let mut best: Option<LocatedPoint> = None;
        let take = |best: &mut Option<LocatedPoint>, at: [f64; 3]| {
            let point = self.point(face, at, x);
            if best.is_none_or(|best| point.distance < best.distance) {
                *best = Some(point);
            }
        };
        let on_triangle = |best: &mut Option<LocatedPoint>, of: [u8; 3]| {
            let of = of.map(usize::from);
            let share = on_triangle(of.map(|k| self.nodes[cell.nodes()[k]]), x);
            take(best, std::array::from_fn(|c| (0..3).map(|i| share[i] * places[of[i]][c]).sum()));
        };
        for piece in kind.table().pieces {
            match **piece {
                [a, b, c] => on_triangle(&mut best, [a, b, c]),
                [a, b, c, d] => {
                    on_triangle(&mut best, [a, b, c]);
                    on_triangle(&mut best, [a, c, d]);
                }
                _ => {}
            }
        }
        let start = best.map_or([0.0; 3], |point| point.at);
        if kind.n_nodes() > 3 {
            if let Some(at) = self.refined(face, start, x, &[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
                && inside(kind.n_corners(), at)
            {
                take(&mut best, at);
            }
            let corners = kind.corners();
            for (i, a) in corners.iter().enumerate() {
                let b = corners[(i + 1) % corners.len()];
                let way: [f64; 3] = std::array::from_fn(|k| b[k] - a[k]);
                let along = |at: [f64; 3]| dot(minus(at, *a), way) / dot(way, way);
                let on = |t: f64| std::array::from_fn(|k| a[k] + t.clamp(0.0, 1.0) * way[k]);
                let from = on(along(start));
                take(&mut best, self.refined(face, from, x, &[way]).map_or(from, |at| on(along(at))));
            }
        }
        best.unwrap_or_else(|| self.point(face, start, x))
    }

    /// Where (x − x(ξ)) · ∂x/∂ξ = 0 along the given ways of the reference coordinates, by Newton; `None` where that does not converge.
    fn refined(&self, face: usize, start: [f64; 3], x: [f64; 3], ways: &[[f64; 3]]) -> Option<[f64; 3]> {
        let along = |at: [f64; 3]| -> Vec<[f64; 3]> {
            let [a, b] = self.tangents(face, at);
            ways.iter().map(|way| std::array::from_fn(|k| way[0] * a[k] + way[1] * b[k])).collect()
        };
        let mut at = start;
        for _ in 0..STEPS {
            let rest = minus(x, self.point(face, at, x).position);
            let tangents = along(at);
            // (x − x(ξ)) · ∂²x/∂ξ², whose differences are exact: no coordinate has a power above two.
            let bend: Vec<Vec<f64>> = ways
                .iter()
                .map(|way| {
                    let [ahead, back] =
                        [0.5, -0.5].map(|h| along(std::array::from_fn(|k| at[k] + h * way[k])));
                    ahead.iter().zip(back).map(|(a, b)| dot(rest, minus(*a, b))).collect()
                })
                .collect();
            let entry = |i: usize, j: usize| dot(tangents[i], tangents[j]) - bend[i][j];
            let step = match tangents[..] {
                [a] => {
                    let size = if entry(0, 0) > 0.0 { entry(0, 0) } else { dot(a, a) };
                    [dot(a, rest) / size, 0.0]
                }
                [a, b] => {
                    let (mut aa, mut ab, mut bb) = (entry(0, 0), entry(0, 1), entry(1, 1));
                    if aa <= 0.0 || aa * bb <= ab * ab {
                        (aa, ab, bb) = (dot(a, a), dot(a, b), dot(b, b));
                    }
                    let (ra, rb, det) = (dot(a, rest), dot(b, rest), aa * bb - ab * ab);
                    [(ra * bb - rb * ab) / det, (rb * aa - ra * ab) / det]
                }
                _ => return None,
            };
            if !step.iter().all(|s| s.is_finite() && s.abs() < 10.0) {
                return None;
            }
            for (way, step) in ways.iter().zip(step) {
                (0..3).for_each(|k| at[k] += step * way[k]);
            }
            if step.iter().all(|s| s.abs() < STEP) {
                return Some(at);
            }
        }
        Some(at)
    }
}

/// Whether reference coordinates are in a triangle, or in a square of four corners.
fn inside(corners: usize, [a, b, _]: [f64; 3]) -> bool {
    if corners == 3 { a >= 0.0 && b >= 0.0 && a + b <= 1.0 } else { a.abs() <= 1.0 && b.abs() <= 1.0 }
}

/// The nearest point of a flat triangle, as shares of its corners (C. Ericson, Real-Time Collision Detection (2005), 5.1.5).
fn on_triangle([a, b, c]: [[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    let (ab, ac) = (minus(b, a), minus(c, a));
    let products = |p: [f64; 3]| [dot(ab, p), dot(ac, p)];
    let ([d1, d2], [d3, d4], [d5, d6]) =
        (products(minus(x, a)), products(minus(x, b)), products(minus(x, c)));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = d1 / (d1 - d3);
        return [1.0 - t, t, 0.0];
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = d2 / (d2 - d6);
        return [1.0 - t, 0.0, t];
    }
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - t, t];
    }
    let all = va + vb + vc;
    [1.0 - vb / all - vc / all, vb / all, vc / all]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CellKind;
    use crate::generate::structured_box;
    use crate::skin::outer_faces;
    use stridor_base::bounds::{Origin::*, within};

    /// Numbers from 0 to 1.
    fn random(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Places about the skin of a ball made of a box of every kind of solid: no sample of any face is nearer, and the way to the point found is
    /// across the face where it is inside of one.
    #[test]
    fn no_point_of_the_faces_is_nearer() {
        let mut seed = 5;
        for kind in CellKind::all().filter(|kind| kind.dimension() == 3) {
            let mut mesh = structured_box(kind, [2.0; 3], [3; 3]).unwrap();
            let middle: [f64; 3] = std::array::from_fn(|k| {
                mesh.nodes.iter().map(|x| x[k]).sum::<f64>() / mesh.nodes.len() as f64
            });
            // From the box to a ball, layer by layer, that of the middles of edges as well.
            for x in &mut mesh.nodes {
                let way = minus(*x, middle);
                let layer = way.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
                let length = norm(way);
                if length > 0.0 {
                    *x = std::array::from_fn(|k| middle[k] + way[k] * layer / length);
                }
            }
            let faces = outer_faces(mesh.elements.iter().filter(|cell| cell.dimension() == 3));
            let tree = FaceTree::new(&mesh.nodes, &faces);
            for _ in 0..12 {
                let x: [f64; 3] = std::array::from_fn(|k| middle[k] + 3.0 * (random(&mut seed) - 0.5));
                let found = tree.nearest(x);
                let best = found[0];
                for (face, own) in faces.iter().enumerate() {
                    for (i, j) in (0..=6).flat_map(|i| (0..=6).map(move |j| (i, j))) {
                        let (a, b) = (f64::from(i) / 6.0, f64::from(j) / 6.0);
                        let at = if own.corners().len() == 3 {
                            [a, (1.0 - a) * b, 0.0]
                        } else {
                            [2.0 * a - 1.0, 2.0 * b - 1.0, 0.0]
                        };
                        let sample = tree.point(face, at, x).distance;
                        assert!(
                            within(best.distance - sample, 1e-12, RoundOff),
                            "{kind:?} {sample} {best:?}"
                        );
                    }
                }
                let [a, b, _] = best.at;
                let well_inside = if faces[best.face].corners().len() == 3 {
                    a > 0.01 && b > 0.01 && a + b < 0.99
                } else {
                    a.abs() < 0.99 && b.abs() < 0.99
                };
                if well_inside {
                    let rest = minus(x, best.position);
                    for tangent in tree.tangents(best.face, best.at) {
                        // Where Newton's method stops, and rounding.
                        assert!(within(dot(tangent, rest).abs(), 1e-9, Tolerance), "{kind:?} {best:?}");
                    }
                }
            }
        }
    }

    /// Points on common edges are found on every face that has them; a node is at itself.
    #[test]
    fn where_faces_meet_each_of_them_is_found() {
        let mesh = structured_box(CellKind::Hexahedron20, [1.0; 3], [2; 3]).unwrap();
        let faces = outer_faces(mesh.elements.iter().filter(|cell| cell.dimension() == 3));
        let tree = FaceTree::new(&mesh.nodes, &faces);
        for (node, x) in mesh.nodes.iter().enumerate() {
            let having = faces.iter().filter(|face| face.nodes().contains(&node)).count();
            if having > 0 {
                let found = tree.nearest(*x);
                assert_eq!(found.len(), having, "{x:?}");
                assert!(found.iter().all(|point| within(point.distance, 1e-14, RoundOff)));
            }
        }
        assert!(FaceTree::new(&mesh.nodes, &[]).nearest([0.0; 3]).is_empty());
    }
}
