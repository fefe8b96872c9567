//! The thick flat shell quadrilateral: DKMQ bending, and the membrane of its two splittings into OPT triangles.

use super::{PlateSection, Side, corner_shear, corners_among, curvatures, sides, slopes, wavenumber};
use crate::structure::elements::bciz::{self, deflection_products};
use crate::structure::elements::shell::{bending_directions, rows_in_global};
use crate::structure::elements::triangle::twice_area;
use crate::structure::elements::{
    Acting, ElementMatrix, FacePoint, FiniteElement, FlatShell, WeightedTriangle, geometric, mass, mean,
    plate_transport, symmetrized, to_global,
};
use crate::structure::{Material, RotationAxis, Shell};
use nalgebra::{Matrix2, Matrix3, RowSVector, SMatrix, Vector3};

/// The triangles of both splittings.
const TRIANGLES: [[usize; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]];
/// ξ and η of the corners.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
/// All rows, in order.
const ROWS: [usize; 24] = {
    let mut rows = [0; 24];
    let mut k = 0;
    while k < 24 {
        rows[k] = k;
        k += 1;
    }
    rows
};

/// A quadrilateral of a plate by Mindlin's theory, 24 freedoms.
///
/// Bending and shear are those of its projection onto its mean plane, across the cross product of the diagonals. The
/// deflection and the membrane displacement are the means over the two splittings into triangles, each triangle of the membrane stiffness in
/// its own plane, so that a warped quadrilateral is free of strain in rigid motions, too.
pub struct MindlinQuadrilateral<'a> {
    plate: &'a Shell,
    coordinates: &'a [[f64; 3]],
    nodes: [usize; 4],
}

/// The projection onto the mean plane.
struct MeanPlane {
    /// Rows e₁, e₂, e₃ in global axes; e₁ joins the middles of two opposite sides.
    frame: Matrix3<f64>,
    /// Corners in (e₁, e₂) \[m\].
    corners: [[f64; 2]; 4],
}

impl MeanPlane {
    /// `None` when a corner has no area or the projection is not convex.
    fn new(nodes: &[[f64; 3]; 4]) -> Option<Self> {
        let p = nodes.map(Vector3::from);
        let (d1, d2) = (p[2] - p[0], p[3] - p[1]);
        let normal = d1.cross(&d2);
        let longest = d1.norm_squared().max(d2.norm_squared());
        // Written so that NaN is refused too.
        if !(normal.norm() > 2e-10 * longest && normal.norm().is_finite()) {
            return None;
        }
        let (e1, e3) = ((d1 - d2).normalize(), normal.normalize());
        let e2 = e3.cross(&e1);
        let corners = p.map(|x| [(x - p[0]).dot(&e1), (x - p[0]).dot(&e2)]);
        let convex = TRIANGLES.iter().all(|t| twice_area(&t.map(|k| corners[k])) > 2e-10 * longest);
        let frame = Matrix3::from_rows(&[e1.transpose(), e2.transpose(), e3.transpose()]);
        convex.then_some(MeanPlane { frame, corners })
    }

    /// ∂(x, y)/∂(ξ, η): row ξ, row η.
    fn jacobian(&self, at: [f64; 2]) -> Matrix2<f64> {
        let slopes = shape_slopes(at);
        Matrix2::from_fn(|d, a| (0..4).map(|i| slopes[i][d] * self.corners[i][a]).sum())
    }

    /// ξ and η of the point with barycentric coordinates `l` on the triangle of three corners, by Newton's method.
    fn coordinates(&self, triangle: [usize; 3], l: [f64; 3]) -> [f64; 2] {
        let mean = |of: &dyn Fn(usize, usize) -> f64| {
            [0, 1].map(|a| (0..3).map(|k| l[k] * of(triangle[k], a)).sum::<f64>())
        };
        let goal = mean(&|i, a| self.corners[i][a]);
        let mut at = mean(&|i, a| CORNERS[i][a]);
        for _ in 0..20 {
            let shapes = shapes(at);
            let off = nalgebra::RowVector2::from_fn(|_, a| {
                goal[a] - (0..4).map(|i| shapes[i] * self.corners[i][a]).sum::<f64>()
            });
            let Some(inverse) = self.jacobian(at).try_inverse() else { break };
            let step = off * inverse;
            at = [at[0] + step[0], at[1] + step[1]];
            if step.norm() < 1e-15 {
                break;
            }
        }
        at
    }
}

/// The bilinear shape functions.
fn shapes([x, y]: [f64; 2]) -> [f64; 4] {
    CORNERS.map(|[a, b]| 0.25 * (1.0 + a * x) * (1.0 + b * y))
}

/// Their derivatives along ξ and η.
fn shape_slopes([x, y]: [f64; 2]) -> [[f64; 2]; 4] {
    CORNERS.map(|[a, b]| [0.25 * a * (1.0 + b * y), 0.25 * b * (1.0 + a * x)])
}

/// The functions that are 1 at the middle of each side and 0 on the others.
fn bubbles([x, y]: [f64; 2]) -> [f64; 4] {
    let (u, v) = (1.0 - x * x, 1.0 - y * y);
    [0.5 * u * (1.0 - y), 0.5 * v * (1.0 + x), 0.5 * u * (1.0 + y), 0.5 * v * (1.0 - x)]
}

/// Their derivatives along ξ and η.
fn bubble_slopes([x, y]: [f64; 2]) -> [[f64; 2]; 4] {
    let (u, v) = (0.5 * (1.0 - x * x), 0.5 * (1.0 - y * y));
    [[-x * (1.0 - y), -u], [v, -y * (1.0 + x)], [-x * (1.0 + y), u], [-v, -y * (1.0 - x)]]
}

/// Gauss points and weights on the square \[−1, 1\]².
fn gauss<const N: usize>(points: [(f64, f64); N]) -> impl Iterator<Item = ([f64; 2], f64)> {
    points.into_iter().flat_map(move |(x, a)| points.into_iter().map(move |(y, b)| ([x, y], a * b)))
}

const TWO: [(f64, f64); 2] = [(-0.577_350_269_189_625_8, 1.0), (0.577_350_269_189_625_8, 1.0)];
const THREE: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// (β_x, β_y) at (ξ, η): bilinear, and the bulges of the sides.
fn rotation(sides: &[Side<12>; 4], at: [f64; 2]) -> [RowSVector<f64, 12>; 2] {
    combined(sides, shapes(at), bubbles(at))
}

/// Σ linear_i β_i + Σ bulging_k Δ_k t_k.
fn combined(sides: &[Side<12>; 4], linear: [f64; 4], bulging: [f64; 4]) -> [RowSVector<f64, 12>; 2] {
    let mut beta = [RowSVector::<f64, 12>::zeros(); 2];
    for (i, value) in linear.into_iter().enumerate() {
        beta[0][3 * i + 2] = value;
        beta[1][3 * i + 1] = -value;
    }
    for (side, value) in sides.iter().zip(bulging) {
        beta.iter_mut().zip(side.tangent).for_each(|(beta, t)| *beta += side.bulge * (value * t));
    }
    beta
}

/// K of bending and shear on (w, θ₁, θ₂) at the corners, 12 × 12, with 2 × 2 Gauss points, which integrate the constant moments exactly.
///
/// The covariant shear strains γ_ξ = γ·∂x/∂ξ and γ_η go linearly from the γ̄ of one side to that of the opposite one.
fn stiffness(plane: &MeanPlane, section: &PlateSection) -> SMatrix<f64, 12, 12> {
    let sides = sides::<4, 12>(&plane.corners, section);
    let along = |k: usize, sign: f64| sides[k].shear * (sign * 0.5 * sides[k].length);
    let covariant = [along(0, 1.0), along(1, 1.0), along(2, -1.0), along(3, -1.0)];
    let mut k = SMatrix::zeros();
    for (at, weight) in gauss(TWO) {
        let jacobian = plane.jacobian(at);
        let inverse = jacobian.try_inverse().unwrap_or_else(Matrix2::zeros);
        let weight = weight * jacobian.determinant();
        let (linear, bulging) = (shape_slopes(at), bubble_slopes(at));
        let natural = [0, 1].map(|d| combined(&sides, linear.map(|s| s[d]), bulging.map(|s| s[d])));
        let gradient =
            [0, 1].map(|d| [0, 1].map(|a| natural[0][a] * inverse[(d, 0)] + natural[1][a] * inverse[(d, 1)]));
        let b = curvatures(&gradient);
        k += b.transpose() * section.rigidity * b * weight;
        let [x, y] = at;
        let xi = (covariant[0] * (1.0 - y) + covariant[2] * (1.0 + y)) * 0.5;
        let eta = (covariant[1] * (1.0 + x) + covariant[3] * (1.0 - x)) * 0.5;
        for d in 0..2 {
            let g = xi * inverse[(d, 0)] + eta * inverse[(d, 1)];
            k += g.transpose() * g * (weight * section.shear);
        }
    }
    symmetrized(k)
}

/// ρh³/12 ∫ |β|² dA, 12 × 12.
fn rotary_inertia(
    plane: &MeanPlane,
    sides: &[Side<12>; 4],
    density: f64,
    thickness: f64,
) -> SMatrix<f64, 12, 12> {
    let factor = density * thickness.powi(3) / 12.0;
    let mut m = SMatrix::zeros();
    for (at, weight) in gauss(THREE) {
        let weight = factor * weight * plane.jacobian(at).determinant();
        for beta in rotation(sides, at) {
            m += beta.transpose() * beta * weight;
        }
    }
    m
}

/// Mapᵀ A Map of a matrix A on (w, ∂w/∂y, −∂w/∂x) at three corners.
fn on_slopes(
    map: &SMatrix<f64, 12, 12>,
    triangle: &[usize; 3],
    a: &SMatrix<f64, 9, 9>,
) -> SMatrix<f64, 12, 12> {
    let rows = SMatrix::<f64, 9, 12>::from_fn(|r, c| map[(3 * triangle[r / 3] + r % 3, c)]);
    rows.transpose() * a * rows
}

/// A matrix on (w, θ₁, θ₂) of the corners put among (u, v, w, θ₁, θ₂, θ₃).
fn with_bending(bending: &SMatrix<f64, 12, 12>) -> SMatrix<f64, 24, 24> {
    let at = |k: usize| 6 * (k / 3) + 2 + k % 3;
    let mut whole = SMatrix::zeros();
    for i in 0..12 {
        for j in 0..12 {
            whole[(at(i), at(j))] = bending[(i, j)];
        }
    }
    whole
}

/// Adds a matrix on (u, v, θ₃) at three corners.
fn add_membrane(triangle: &[usize; 3], a: &SMatrix<f64, 9, 9>, to: &mut SMatrix<f64, 24, 24>) {
    let at = |k: usize| 6 * triangle[k / 3] + [0, 1, 5][k % 3];
    for i in 0..9 {
        for j in 0..9 {
            to[(at(i), at(j))] += a[(i, j)];
        }
    }
}

/// The six rows of each corner of a triangle among those of the quadrilateral.
fn rows_of(triangle: &[usize; 3]) -> [usize; 18] {
    std::array::from_fn(|k| 6 * triangle[k / 6] + k % 6)
}

impl<'a> MindlinQuadrilateral<'a> {
    /// A quadrilateral of `plate` on nodes with the given coordinates \[m\].
    pub fn new(plate: &'a Shell, coordinates: &'a [[f64; 3]], nodes: [usize; 4]) -> Self {
        MindlinQuadrilateral { plate, coordinates, nodes }
    }

    fn points(&self) -> [[f64; 3]; 4] {
        self.nodes.map(|n| self.coordinates[n])
    }

    fn plane(&self) -> MeanPlane {
        MeanPlane::new(&self.points()).expect("checked: it is convex")
    }

    fn sides(&self, plane: &MeanPlane) -> [Side<12>; 4] {
        sides(&plane.corners, &PlateSection::new(self.plate))
    }

    /// The triangles of both splittings in space.
    fn triangles(&self) -> impl Iterator<Item = ([usize; 3], FlatShell)> {
        let points = self.points();
        let shell = move |t: [usize; 3]| FlatShell::new(&t.map(|k| points[k])).map(|shell| (t, shell));
        TRIANGLES.into_iter().filter_map(shell)
    }
}

impl FiniteElement for MindlinQuadrilateral<'_> {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn acting(&self) -> Acting {
        if !self.plate.bending_only {
            return Acting::Everywhere;
        }
        Acting::Along(bending_directions(&self.plane().frame))
    }

    fn is_degenerate(&self) -> bool {
        MeanPlane::new(&self.points()).is_none() || self.triangles().count() < 4
    }

    fn material(&self) -> Option<&Material> {
        Some(&self.plate.material)
    }

    fn stiffness(&self, k: &mut ElementMatrix) -> bool {
        let (plane, plate) = (self.plane(), self.plate);
        let bending = stiffness(&plane, &PlateSection::new(plate));
        k.add(&to_global(&with_bending(&bending), &plane.frame), &ROWS, 1.0);
        if !plate.bending_only {
            for (triangle, shell) in self.triangles() {
                let membrane = shell.membrane_stiffness(&plate.material, plate.thickness);
                k.add(&shell.embedded(None, Some(&membrane)), &rows_of(&triangle), 0.5);
            }
        }
        true
    }

    /// ρh ∫ w² dA, the mean over both splittings, with the cubics w of the [`slopes`], and rotary inertia of β.
    fn mass(&self, m: &mut ElementMatrix) -> bool {
        let (plane, plate) = (self.plane(), self.plate);
        let (density, thickness) = (plate.material.density, plate.thickness);
        let sides = self.sides(&plane);
        let map = slopes(&corner_shear(&sides));
        let mut bending = SMatrix::<f64, 12, 12>::zeros();
        let mut local = SMatrix::<f64, 24, 24>::zeros();
        for (triangle, shell) in self.triangles() {
            let (corners, area) = (triangle.map(|k| plane.corners[k]), shell.triangle().area);
            let products = deflection_products(&corners) * (0.5 * density * thickness * area);
            bending += on_slopes(&map, &triangle, &products);
            if plate.bending_only {
                continue;
            }
            // The mass of the triangle as it is, the shape of its projection.
            let projected = 0.5 * twice_area(&corners);
            let membrane = mass::membrane(&corners, 0.5 * density * area / projected, thickness);
            add_membrane(&triangle, &membrane, &mut local);
        }
        if plate.rotary_inertia {
            bending += rotary_inertia(&plane, &sides, density, thickness);
        }
        m.copy(&to_global(&(local + with_bending(&symmetrized(bending))), &plane.frame));
        true
    }

    /// The mean over both splittings; the membrane forces of each triangle in its own plane.
    fn geometric_stiffness(&self, displacement: &[[f64; 6]], k: &mut ElementMatrix) -> bool {
        let plate = self.plate;
        if plate.bending_only {
            return false;
        }
        let plane = self.plane();
        let map = slopes(&corner_shear(&self.sides(&plane)));
        let mut bending = SMatrix::<f64, 12, 12>::zeros();
        let mut local = SMatrix::<f64, 24, 24>::zeros();
        for (triangle, shell) in self.triangles() {
            let u = triangle.map(|k| displacement[self.nodes[k]]);
            let [nx, ny, nxy] = shell.membrane_forces(&plate.material, plate.thickness, &u);
            // From the axes of the triangle to those of the mean plane.
            let turn =
                (plane.frame * shell.triangle().frame.transpose()).fixed_view::<2, 2>(0, 0).into_owned();
            let n = turn * Matrix2::new(nx, nxy, nxy, ny) * turn.transpose();
            let corners = triangle.map(|k| plane.corners[k]);
            let forces = [n[(0, 0)], n[(1, 1)], n[(0, 1)]].map(|n| 0.5 * n);
            bending += on_slopes(&map, &triangle, &geometric::plate(&corners, forces));
            add_membrane(&triangle, &geometric::membrane(&corners, forces), &mut local);
        }
        k.copy(&to_global(&(local + with_bending(&symmetrized(bending))), &plane.frame));
        true
    }

    fn transport(&self, axis: &RotationAxis, matrices: [&mut ElementMatrix; 2]) -> bool {
        plate_transport(
            self,
            (self.plate, self.coordinates),
            &TRIANGLES.map(|t| WeightedTriangle { nodes: t.map(|k| self.nodes[k]), weight: 0.5 }),
            axis,
            matrices,
        )
    }

    fn mass_and_center(&self) -> (f64, [f64; 3]) {
        let area: f64 = self.triangles().map(|(_, shell)| 0.5 * shell.triangle().area).sum();
        (self.plate.material.density * self.plate.thickness * area, mean(&self.nodes, self.coordinates))
    }

    /// The deflection is the cubic of the mass on the triangle, the rotations in the plane are those of the section, the rest is
    /// linear on the triangle.
    fn displacement_at(&self, at: &FacePoint) -> Option<Vec<[f64; 6]>> {
        let triangle = corners_among(&self.nodes, at)?;
        let plane = self.plane();
        let sides = self.sides(&plane);
        let map = slopes(&corner_shear(&sides));
        let rows = SMatrix::<f64, 9, 12>::from_fn(|r, c| map[(3 * triangle[r / 3] + r % 3, c)]);
        let corners = triangle.map(|k| plane.corners[k]);
        let deflection = bciz::interpolate(&corners, at.barycentric).row(0) * rows;
        let [beta_x, beta_y] = rotation(&sides, plane.coordinates(triangle, at.barycentric));
        let mut local = SMatrix::<f64, 6, 24>::zeros();
        for k in 0..12 {
            let column = 6 * (k / 3) + 2 + k % 3;
            local[(2, column)] = deflection[k];
            local[(3, column)] = -beta_y[k];
            local[(4, column)] = beta_x[k];
        }
        for (corner, l) in triangle.into_iter().zip(at.barycentric) {
            [0, 1, 5].into_iter().for_each(|row| local[(row, 6 * corner + row)] = l);
        }
        Some(rows_in_global(&local, &plane.frame))
    }

    fn bending_wavenumber(&self, frequency_hz: f64) -> Option<f64> {
        wavenumber(self.plate, frequency_hz)
    }
}
