//! Where a point stands over a plate: the triangle under it, the coordinates on it, the height.

use crate::mesh::Element;
use std::collections::HashMap;

pub(super) type Vector = [f64; 3];

/// The faces of a plate as triangles (a quadrilateral gives two), sorted into a grid on its mean plane.
pub(super) struct Plate {
    triangles: Vec<[usize; 3]>,
    corners: Vec<[Vector; 3]>,
    /// Mean unit normal, towards the other body.
    pub(super) normal: Vector,
    axes: [Vector; 2],
    origin: Vector,
    cell: f64,
    grid: HashMap<[i64; 2], Vec<usize>>,
}

/// The foot of a point on the mid-surface.
pub(super) struct Foot {
    pub(super) nodes: [usize; 3],
    pub(super) corners: [Vector; 3],
    pub(super) barycentric: [f64; 3],
    /// Unit normal of the triangle, towards the other body.
    pub(super) normal: Vector,
    /// Height over the mid-surface \[m\].
    pub(super) height: f64,
}

impl Plate {
    /// `None` when the faces have no common side (no area, or normals that cancel).
    pub(super) fn new(nodes: &[Vector], faces: &[Element], towards: Vector) -> Option<Self> {
        let triangles = split(faces);
        let corners: Vec<[Vector; 3]> = triangles.iter().map(|t| t.map(|n| nodes[n])).collect();
        let areas: Vec<Vector> = corners.iter().map(area_vector).collect();
        let total = areas.iter().fold([0.0; 3], |sum, a| add(sum, *a));
        let area: f64 = areas.iter().map(|a| dot(*a, *a).sqrt()).sum();
        let length = dot(total, total).sqrt();
        if length.is_nan() || length <= 0.5 * area {
            return None;
        }
        let count = 3.0 * corners.len() as f64;
        let origin = scale(1.0 / count, corners.iter().flatten().fold([0.0; 3], |sum, c| add(sum, *c)));
        let side = if dot(subtract(towards, origin), total) < 0.0 { -1.0 } else { 1.0 };
        let normal = scale(side / length, total);
        let first = axis_across(normal);
        let axes = [first, cross(normal, first)];
        let cell = 2.0 * (area / corners.len() as f64).sqrt();
        let mut plate = Plate { triangles, corners, normal, axes, origin, cell, grid: HashMap::new() };
        for t in 0..plate.corners.len() {
            let cells = plate.corners[t].map(|c| plate.cell_of(c));
            let bound =
                |a: usize, pick: fn(i64, i64) -> i64| pick(pick(cells[0][a], cells[1][a]), cells[2][a]);
            for i in bound(0, i64::min)..=bound(0, i64::max) {
                for j in bound(1, i64::min)..=bound(1, i64::max) {
                    plate.grid.entry([i, j]).or_default().push(t);
                }
            }
        }
        Some(plate)
    }

    fn cell_of(&self, x: Vector) -> [i64; 2] {
        self.axes.map(|axis| (dot(subtract(x, self.origin), axis) / self.cell).floor() as i64)
    }

    /// Height over the mean plane, for points that stand beside the plate.
    pub(super) fn height_over_plane(&self, x: Vector) -> f64 {
        dot(subtract(x, self.origin), self.normal)
    }

    /// The nearest triangle that `x` projects onto along its normal; `None` beside the plate.
    pub(super) fn foot(&self, x: Vector) -> Option<Foot> {
        let candidates = self.grid.get(&self.cell_of(x))?;
        let feet = candidates.iter().filter_map(|t| self.foot_on(*t, x));
        feet.min_by(|a, b| a.height.abs().total_cmp(&b.height.abs()))
    }

    fn foot_on(&self, t: usize, x: Vector) -> Option<Foot> {
        const ON_EDGE: f64 = 1e-9;
        let corners = self.corners[t];
        let area = area_vector(&corners);
        let square = dot(area, area);
        if square == 0.0 {
            return None;
        }
        // Twice the area of the triangle that the projection makes with each opposite side.
        let part = |a: Vector, b: Vector| dot(cross(subtract(a, x), subtract(b, x)), area) / (2.0 * square);
        let barycentric =
            [part(corners[1], corners[2]), part(corners[2], corners[0]), part(corners[0], corners[1])];
        if barycentric.iter().any(|b| *b < -ON_EDGE) {
            return None;
        }
        let side = if dot(area, self.normal) < 0.0 { -1.0 } else { 1.0 };
        let normal = scale(side / square.sqrt(), area);
        let height = dot(subtract(x, corners[0]), normal);
        Some(Foot { nodes: self.triangles[t], corners, barycentric, normal, height })
    }
}

/// Triangles of faces; a quadrilateral is cut along its first diagonal.
pub(super) fn split(faces: &[Element]) -> Vec<[usize; 3]> {
    let mut triangles = Vec::new();
    for face in faces {
        match face {
            Element::Triangle(n) => triangles.push(*n),
            Element::Quadrilateral([a, b, c, d]) => triangles.extend([[*a, *b, *c], [*a, *c, *d]]),
            Element::Point(_) | Element::Line(_) => {}
        }
    }
    triangles
}

/// Half the cross product of two sides: the area, along the normal.
pub(super) fn area_vector(c: &[Vector; 3]) -> Vector {
    scale(0.5, cross(subtract(c[1], c[0]), subtract(c[2], c[0])))
}

/// A unit vector across `n`, in the plane of `n` and the coordinate axis that is most nearly across it.
fn axis_across(n: Vector) -> Vector {
    let k = (0..3).min_by(|a, b| n[*a].abs().total_cmp(&n[*b].abs())).unwrap_or(0);
    let mut e = [0.0; 3];
    e[k] = 1.0;
    let across = subtract(e, scale(n[k], n));
    scale(1.0 / dot(across, across).sqrt(), across)
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
