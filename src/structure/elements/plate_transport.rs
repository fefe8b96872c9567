//! The terms of a steady rotation ([`crate::structure::Rotation`]) of any flat plate, from the displacement of its points.
//!
//! On each triangle of a plate the deflection is cubic, and all else of lower degree, so that their values at the ten points of a cubic are
//! all that is needed. With ∂_θ = v·∇, v the velocity e × (x − x₀) in the plane, linear in x,
//!
//! D = ∫ ρh uᵀ∂_θu + ρh³/12 βᵀ∂_θβ dA, T = ∫ ρh (∂_θu)ᵀ∂_θu + ρh³/12 (∂_θβ)ᵀ∂_θβ dA, β the rotation of the section.

use super::{ElementMatrix, FacePoint, FiniteElement, FlatTriangle, WeightedTriangle};
use crate::mesh::CellKind;
use crate::structure::{RotationAxis, Shell};
use nalgebra::{DMatrix, SMatrix, SVector, Vector3};
use std::sync::LazyLock;

/// Exponents of (L₂, L₃) of a cubic, and three times the coordinates of the points that determine it.
const CUBIC: [[i32; 2]; 10] =
    [[0, 0], [1, 0], [2, 0], [3, 0], [0, 1], [1, 1], [2, 1], [0, 2], [1, 2], [0, 3]];
/// The degree of T times the Jacobian of the collapsed square, in one of its coordinates.
const DEGREE: usize = 7;

type Cubic = SVector<f64, 10>;

/// A point of the quadrature of a triangle of unit area.
struct Tabulated {
    barycentric: [f64; 3],
    weight: f64,
    /// The functions that are 1 at one of the ten points, and their derivatives by L₂ and L₃.
    shape: Cubic,
    slopes: [Cubic; 2],
}

static POINTS: LazyLock<Vec<Tabulated>> = LazyLock::new(|| {
    let power = |x: f64, n: i32| if n < 0 { 0.0 } else { x.powi(n) };
    let monomials = |x: f64, y: f64| Cubic::from_fn(|k, _| power(x, CUBIC[k][0]) * power(y, CUBIC[k][1]));
    let lattice = SMatrix::<f64, 10, 10>::from_fn(|point, k| {
        let [x, y] = CUBIC[point].map(|n| f64::from(n) / 3.0);
        monomials(x, y)[k]
    });
    let inverse = lattice.try_inverse().expect("ten points determine a cubic").transpose();
    let square = CellKind::Quadrilateral4.quadrature(DEGREE);
    let point = |x: f64, y: f64, weight: f64| Tabulated {
        barycentric: [1.0 - x - y, x, y],
        weight,
        shape: inverse * monomials(x, y),
        slopes: [
            Cubic::from_fn(|k, _| f64::from(CUBIC[k][0]) * power(x, CUBIC[k][0] - 1) * power(y, CUBIC[k][1])),
            Cubic::from_fn(|k, _| f64::from(CUBIC[k][1]) * power(x, CUBIC[k][0]) * power(y, CUBIC[k][1] - 1)),
        ]
        .map(|slope| inverse * slope),
    };
    let collapsed = square.iter().map(|p| {
        let x = 0.5 * (1.0 + p.at[0]);
        point(x, 0.5 * (1.0 + p.at[1]) * (1.0 - x), 0.5 * p.weight * (1.0 - x))
    });
    collapsed.collect()
});

/// D and T of `element`, of `plate` on nodes with the given coordinates, whose displacement is known on some triangles.
pub fn plate_transport(
    element: &dyn FiniteElement,
    (plate, coordinates): (&Shell, &[[f64; 3]]),
    triangles: &[WeightedTriangle],
    axis: &RotationAxis,
    [convected, transport]: [&mut ElementMatrix; 2],
) -> bool {
    let (n, mass) = (element.n_freedoms(), plate.material.density * plate.thickness);
    let turned = if plate.rotary_inertia { (plate.thickness.powi(2) / 12.0).sqrt() } else { 0.0 };
    let (mut d, mut t) = (DMatrix::<f64>::zeros(n, n), DMatrix::<f64>::zeros(n, n));
    for WeightedTriangle { nodes, weight } in triangles {
        let corners = nodes.map(|node| coordinates[node]);
        let Some(triangle) = FlatTriangle::new(&corners) else { continue };
        let normal = Vector3::from(triangle.normal());
        // (u, β h/√12) at the ten points, six rows for each.
        let mut values = DMatrix::<f64>::zeros(60, n);
        for (k, point) in CUBIC.iter().enumerate() {
            let [x, y] = point.map(|c| f64::from(c) / 3.0);
            let at = FacePoint { corners: *nodes, barycentric: [1.0 - x - y, x, y] };
            let Some(columns) = element.displacement_at(&at) else { return false };
            for (column, u) in columns.iter().enumerate() {
                let (moved, turn) = (Vector3::new(u[0], u[1], u[2]), Vector3::new(u[3], u[4], u[5]));
                let moved = if plate.bending_only { normal * normal.dot(&moved) } else { moved };
                let turn = (turn - normal * normal.dot(&turn)) * turned;
                values.fixed_view_mut::<3, 1>(6 * k, column).copy_from(&moved);
                values.fixed_view_mut::<3, 1>(6 * k + 3, column).copy_from(&turn);
            }
        }
        let velocities = corners.map(|x| triangle.frame * axis.velocity(x));
        let gradients = super::triangle::gradients(&triangle.corners);
        let (mut of_d, mut of_t) = (SMatrix::<f64, 10, 10>::zeros(), SMatrix::<f64, 10, 10>::zeros());
        for point in POINTS.iter() {
            let velocity = velocities.iter().zip(point.barycentric).map(|(v, l)| v * l).sum::<Vector3<f64>>();
            let along = [1, 2].map(|k| gradients[k][0] * velocity[0] + gradients[k][1] * velocity[1]);
            let slope = point.slopes[0] * along[0] + point.slopes[1] * along[1];
            let mass = mass * weight * triangle.area * point.weight;
            of_d += point.shape * slope.transpose() * mass;
            of_t += slope * slope.transpose() * mass;
        }
        for (of, to) in [(&of_d, &mut d), (&of_t, &mut t)] {
            let wide = DMatrix::from_fn(60, 60, |i, j| if i % 6 == j % 6 { of[(i / 6, j / 6)] } else { 0.0 });
            *to += values.transpose() * (wide * &values);
        }
    }
    for j in 0..n {
        for i in 0..n {
            convected.set(i, j, d[(i, j)]);
            transport.set(i, j, 0.5 * (t[(i, j)] + t[(j, i)]));
        }
    }
    true
}
