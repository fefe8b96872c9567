//! Where a point stands over a plate: the faces under it, the coordinates on them, the height.

use crate::mesh::Cell;
use crate::structure::elements::{FacePoint, WeightedTriangle, split_face};
use std::collections::HashMap;

pub(super) type Vector = [f64; 3];

/// Relative tolerance, to the size of a triangle: far above round-off, far below what a mesh resolves.
const TOLERANCE: f64 = 1e-9;

/// The faces of a plate, sorted into a grid on its mean plane.
pub(super) struct FaceGrid {
    faces: Vec<Face>,
    /// Mean unit normal, towards the other body.
    pub(super) normal: Vector,
    axes: [Vector; 2],
    origin: Vector,
    cell: f64,
    grid: HashMap<[i64; 2], Vec<usize>>,
}

/// Triangles of one face with the coordinates of their corners: itself, or two for each diagonal of a quadrilateral.
type Face = Vec<(WeightedTriangle, [Vector; 3])>;

/// The foot of a point on the mid-surface.
///
/// The interpolation of a plate has no single slope across a side between two faces. A point over such a side
/// therefore stands on both: the foot is their mean, which depends on no order of faces or corners. A quadrilateral
/// is the mean of its two splittings into triangles.
pub(super) struct Foot {
    pub(super) parts: Vec<FootShare>,
    /// Unit normal, towards the other body.
    pub(super) normal: Vector,
    /// Height over the mid-surface \[m\].
    pub(super) height: f64,
}

/// The part of a foot that is on one triangle of a face.
pub(super) struct FootShare {
    /// Its share of the displacement; the shares of a foot add up to 1.
    pub(super) share: f64,
    /// The face among those of the plate.
    pub(super) face: usize,
    pub(super) at: FacePoint,
}

impl FaceGrid {
    /// The side of a plate that looks `towards` a place, or that from which faces are seen counter-clockwise. `None` when the faces have no
    /// common side (no area, or normals that cancel).
    pub(super) fn new(nodes: &[Vector], faces: &[Cell], towards: Option<Vector>) -> Option<Self> {
        let placed = |t: WeightedTriangle| (t, t.nodes.map(|n| nodes[n]));
        let faces: Vec<Face> =
            faces.iter().map(|f| split_face(f).into_iter().map(placed).collect()).collect();
        let triangles = || faces.iter().flatten();
        let areas: Vec<Vector> = triangles().map(|(t, c)| scale(t.weight, area_vector(c))).collect();
        let total = areas.iter().fold([0.0; 3], |sum, a| add(sum, *a));
        let area: f64 = areas.iter().map(|a| dot(*a, *a).sqrt()).sum();
        let length = dot(total, total).sqrt();
        if length.is_nan() || length <= 0.5 * area {
            return None;
        }
        let count = 3.0 * areas.len() as f64;
        let origin = triangles().flat_map(|(_, c)| c).fold([0.0; 3], |sum, c| add(sum, *c));
        let origin = scale(1.0 / count, origin);
        let turned = |towards| dot(subtract(towards, origin), total) < 0.0;
        let side = if towards.is_some_and(turned) { -1.0 } else { 1.0 };
        let normal = scale(side / length, total);
        let first = axis_across(normal);
        let axes = [first, cross(normal, first)];
        let cell = 2.0 * (area / faces.len() as f64).sqrt();
        let mut plate = FaceGrid { faces, normal, axes, origin, cell, grid: HashMap::new() };
        for f in 0..plate.faces.len() {
            let [i, j] = plate.cells_of(&plate.faces[f]);
            for i in i[0]..=i[1] {
                for j in j[0]..=j[1] {
                    plate.grid.entry([i, j]).or_default().push(f);
                }
            }
        }
        Some(plate)
    }

    /// Lengths that differ by less are equal \[m\].
    pub(super) fn tolerance(&self) -> f64 {
        TOLERANCE * self.cell
    }

    /// Place along the two axes of the mean plane, in cells of the grid.
    fn place(&self, x: Vector) -> [f64; 2] {
        self.axes.map(|axis| dot(subtract(x, self.origin), axis) / self.cell)
    }

    /// The first and the last cell along either axis that a face reaches, with a margin for round-off.
    fn cells_of(&self, face: &Face) -> [[i64; 2]; 2] {
        const MARGIN: f64 = 1e-6;
        let places: Vec<[f64; 2]> = face.iter().flat_map(|(_, c)| c).map(|c| self.place(*c)).collect();
        [0, 1].map(|axis| {
            let low = places.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
            let high = places.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
            [low - MARGIN, high + MARGIN].map(|p| p.floor() as i64)
        })
    }

    /// Height over the mean plane, for points that stand beside the plate.
    pub(super) fn height_over_plane(&self, x: Vector) -> f64 {
        dot(subtract(x, self.origin), self.normal)
    }

    /// The mean over the nearest faces that `x` projects onto along their normals; `None` beside the plate.
    pub(super) fn foot(&self, x: Vector) -> Option<Foot> {
        let faces = self.grid.get(&self.place(x).map(|p| p.floor() as i64))?;
        let feet: Vec<Foot> = faces.iter().filter_map(|f| self.foot_on_face(*f, x)).collect();
        let nearest = feet.iter().map(|f| f.height.abs()).fold(f64::INFINITY, f64::min);
        mean(feet.into_iter().filter(|f| f.height.abs() <= nearest + self.tolerance()))
    }

    /// The mean over the splittings of a face, and over the triangles of each that hold the projection.
    fn foot_on_face(&self, face: usize, x: Vector) -> Option<Foot> {
        let on = |(t, corners): &(WeightedTriangle, _)| self.foot_on(face, t.nodes, corners, x);
        mean(self.faces[face].chunks(2).filter_map(|splitting| mean(splitting.iter().filter_map(on))))
    }

    fn foot_on(&self, face: usize, nodes: [usize; 3], corners: &[Vector; 3], x: Vector) -> Option<Foot> {
        let area = area_vector(corners);
        let square = dot(area, area);
        // Twice the area of the triangle that the projection makes with each opposite side.
        let part = |a: Vector, b: Vector| dot(cross(subtract(a, x), subtract(b, x)), area) / (2.0 * square);
        let barycentric =
            [part(corners[1], corners[2]), part(corners[2], corners[0]), part(corners[0], corners[1])];
        // Written so that NaN is refused too.
        if !barycentric.iter().all(|b| *b >= -TOLERANCE) {
            return None;
        }
        let side = if dot(area, self.normal) < 0.0 { -1.0 } else { 1.0 };
        let normal = scale(side / square.sqrt(), area);
        let height = dot(subtract(x, corners[0]), normal);
        let at = FacePoint { corners: nodes, barycentric };
        Some(Foot { parts: vec![FootShare { share: 1.0, face, at }], normal, height })
    }
}

/// The mean of feet; `None` of none.
fn mean(feet: impl Iterator<Item = Foot>) -> Option<Foot> {
    let feet: Vec<Foot> = feet.collect();
    let share = 1.0 / feet.len() as f64;
    let sum = feet.into_iter().reduce(|mut sum, foot| {
        sum.parts.extend(foot.parts);
        let (normal, height) = (add(sum.normal, foot.normal), sum.height + foot.height);
        Foot { normal, height, ..sum }
    })?;
    let parts = sum.parts.into_iter().map(|part| FootShare { share: share * part.share, ..part }).collect();
    let normal = scale(1.0 / dot(sum.normal, sum.normal).sqrt(), sum.normal);
    Some(Foot { parts, normal, height: share * sum.height })
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
