//! Where a point stands over the counter-faces: its foot, the normal there, the height.

use crate::mesh::{Cell, FaceTree, LocatedPoint};
use std::collections::{BTreeMap, BTreeSet};

pub(super) type Vector = [f64; 3];

/// Lengths that differ by less than this share of the size of a face are equal: far above round-off, far below what a mesh resolves.
const TOLERANCE: f64 = 1e-9;
/// Reference coordinates nearer to an edge than this are on it.
const ON_EDGE: f64 = 1e-6;

/// The counter-faces.
pub(super) struct CounterSurface<'a> {
    faces: &'a [Cell],
    tree: FaceTree<'a>,
    /// Edges that one face alone has, by the corners at their ends, ascending.
    border: BTreeSet<[usize; 2]>,
    /// 1 for the side from which faces are seen counter-clockwise, −1 for the other one.
    side: f64,
    /// The mean size of a face \[m\].
    size: f64,
}

/// The foot of a point: the nearest point of the faces.
///
/// Where faces meet, it is on each of them: the displacement there is the mean of theirs, and so is the normal, which depends on no order of
/// faces.
pub(super) struct Foot {
    /// Where it is on each of its faces.
    pub(super) places: Vec<LocatedPoint>,
    /// n: the unit normal, towards the other body.
    pub(super) normal: Vector,
    /// Height of the point over the faces along the normal \[m\].
    pub(super) height: f64,
    /// Whether the point stands over the faces: not beyond an edge where they end.
    pub(super) over: bool,
}

impl<'a> CounterSurface<'a> {
    /// The side of `faces` from which they are seen counter-clockwise.
    pub(super) fn new(nodes: &'a [Vector], faces: &'a [Cell]) -> Self {
        let tree = FaceTree::new(nodes, faces);
        let mut count: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        for edge in faces.iter().flat_map(|face| (0..face.corners().len()).map(|k| edge(face, k))) {
            *count.entry(edge).or_default() += 1;
        }
        let border = count.into_iter().filter(|(_, n)| *n == 1).map(|(edge, _)| edge).collect();
        let size = (0..faces.len()).map(|face| tree.size(face)).sum::<f64>() / faces.len().max(1) as f64;
        CounterSurface { faces, tree, border, side: 1.0, size }
    }

    /// The side that looks towards places: that on which they stand in the mean.
    pub(super) fn towards(mut self, places: &[Vector]) -> Self {
        let feet = || places.iter().filter_map(|x| self.foot(*x));
        let sum: f64 = feet().map(|foot| foot.height).sum();
        let over: f64 = feet().filter(|foot| foot.over).map(|foot| foot.height).sum();
        if over < 0.0 || over == 0.0 && sum < 0.0 {
            self.side = -1.0;
        }
        self
    }

    /// Lengths that differ by less are equal \[m\].
    pub(super) fn tolerance(&self) -> f64 {
        TOLERANCE * self.size
    }

    /// The foot of `x`; `None` where there are no faces.
    pub(super) fn foot(&self, x: Vector) -> Option<Foot> {
        let places = self.tree.nearest(x);
        let normal = places.iter().fold([0.0; 3], |sum, place| add(sum, self.normal(place)));
        let normal = unit(normal)?;
        // All are as near; the mean is the same whichever is the first.
        let share = 1.0 / places.len() as f64;
        let height = places.iter().map(|place| share * dot(subtract(x, place.position), normal)).sum();
        let over = !places.iter().any(|place| self.overhangs(place, x));
        Some(Foot { places, normal, height, over })
    }

    /// The nearest point to `x` of one of the faces.
    pub(super) fn foot_on(&self, face: usize, x: Vector) -> Foot {
        let place = self.tree.nearest_on(face, x);
        let normal = self.normal(&place);
        Foot { places: vec![place], normal, height: dot(subtract(x, place.position), normal), over: true }
    }

    /// The faces that may reach into a box.
    pub(super) fn faces_in(&self, low: Vector, high: Vector) -> Vec<usize> {
        self.tree.faces_in(low, high)
    }

    /// How far the nearest of the faces is from `x` \[m\].
    pub(super) fn distance(&self, x: Vector) -> f64 {
        self.tree.nearest(x).first().map_or(f64::INFINITY, |place| place.distance)
    }

    /// The unit normal of a face; zero where it has none.
    fn normal(&self, place: &LocatedPoint) -> Vector {
        let [a, b] = self.tree.tangents(place.face, place.at);
        scale(self.side, unit(cross(a, b)).unwrap_or_default())
    }

    /// Whether `x`, the nearest point to which is at the edge where the faces end, is beyond it.
    fn overhangs(&self, place: &LocatedPoint, x: Vector) -> bool {
        let face = &self.faces[place.face];
        let corners = face.kind().corners();
        let way = subtract(x, place.position);
        let [a, b] = self.tree.tangents(place.face, place.at);
        let normal = cross(a, b);
        (0..corners.len()).any(|k| {
            let from = corners[k];
            let along = subtract(corners[(k + 1) % corners.len()], from);
            let off = subtract(place.at, from);
            if (along[0] * off[1] - along[1] * off[0]).abs() > ON_EDGE
                || !self.border.contains(&edge(face, k))
            {
                return false;
            }
            // Faces are seen counter-clockwise from the side of a × b.
            let outwards = cross(add(scale(along[0], a), scale(along[1], b)), normal);
            unit(outwards).is_some_and(|outwards| dot(way, outwards) > TOLERANCE * self.tree.size(place.face))
        })
    }
}

/// The ends of an edge of a face, ascending.
fn edge(face: &Cell, k: usize) -> [usize; 2] {
    let corners = face.corners();
    let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
    [a.min(b), a.max(b)]
}

/// Half the cross product of two sides: the area, along the normal.
pub(super) fn area_vector(c: &[Vector; 3]) -> Vector {
    scale(0.5, cross(subtract(c[1], c[0]), subtract(c[2], c[0])))
}

/// The unit vector along `a`; `None` of one without length.
pub(super) fn unit(a: Vector) -> Option<Vector> {
    let length = dot(a, a).sqrt();
    (length > 0.0 && length.is_finite()).then(|| scale(1.0 / length, a))
}

pub(super) fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(super) fn subtract(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn scale(s: f64, a: Vector) -> Vector {
    a.map(|v| s * v)
}

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
