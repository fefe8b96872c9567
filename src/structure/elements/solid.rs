//! Solids: isoparametric elements of every kind, three freedoms a node.
//!
//! x(ξ) = Σ N_k(ξ) x_k and u(ξ) = Σ N_k(ξ) u_k with the shape functions of the kind of cell. With the strain
//! ε = (ε_xx, ε_yy, ε_zz, γ_xy, γ_yz, γ_zx) = Σ B_k u_k and σ = D ε,
//!
//! * K = ∫ Bᵀ D B dV, M = ∫ ρ NᵀN dV;
//! * K_σ = ∫ (∇N_i · σ ∇N_j) dV on each of ux, uy, uz, linear in the stress σ of a static displacement.
//!
//! The 8-node hexahedron has nine more displacements inside, (1 − ξ²) a + (1 − η²) b + (1 − ζ²) c, without which it is too stiff in
//! bending. Their gradients are taken by the Jacobian J₀ of the middle, ∇P = (|J₀|/|J|) J₀⁻ᵀ ∂P/∂ξ, so that they do no work under constant
//! stress on any mesh (R. L. Taylor, P. J. Beresford & E. L. Wilson, Int. J. Numer. Meth. Eng. 10 (1976) 1211); they are
//! eliminated in the element: K = K_uu − K_uα K_αα⁻¹ K_αu.
//!
//! The 20-node hexahedron may be integrated at 2 × 2 × 2 points ([`Integration::Reduced`]). There six motions of it have no strain;
//! a small part θ of the exact stiffness keeps them: K = (1 − θ) K₈ + θ K₂₇, which leaves constant stress as it is.

use super::{ElementMatrix, FiniteElement};
use crate::mesh::{Cell, CellKind};
use crate::structure::{Integration, Material, RotationAxis, Solid};
use nalgebra::{Matrix3, SMatrix, Vector3};
use std::sync::OnceLock;

/// Rows of B: (ε_xx, ε_yy, ε_zz, γ_xy, γ_yz, γ_zx).
type Strain = SMatrix<f64, 6, 3>;

/// How far a middle may be off, as a part of an edge: rounding of coordinates in files.
const STRAIGHT: f64 = 1e-6;

/// θ: the part of the exact stiffness in that of reduced integration.
const STABILISATION: f64 = 1e-3;

/// An element on one cell, 3 freedoms a node.
pub struct SolidElement<'a> {
    solid: &'a Solid,
    coordinates: &'a [[f64; 3]],
    cell: &'a Cell,
}

/// Shape functions and their gradients at the points of a quadrature.
struct Tabulated {
    at: [f64; 3],
    weight: f64,
    shape: Vec<f64>,
    gradients: Vec<[f64; 3]>,
}

/// The quadratures of a kind.
struct Rules {
    /// Of K where the cell has straight edges; the other one serves the rest.
    straight: Vec<Tabulated>,
    /// Of K of a reduced integration; none where there is not any.
    reduced: Option<Vec<Tabulated>>,
    /// Of M.
    mass: Vec<Tabulated>,
    /// Gradients in the middle.
    middle: Vec<[f64; 3]>,
}

impl Rules {
    fn of(kind: CellKind) -> &'static Rules {
        static ALL: OnceLock<Vec<Rules>> = OnceLock::new();
        let rules = |kind: CellKind| {
            let table = |degree: usize| {
                let points = kind.quadrature(degree).into_iter();
                let tabulated = points.map(|p| Tabulated {
                    at: p.at,
                    weight: p.weight,
                    shape: kind.shape_functions(p.at),
                    gradients: kind.shape_gradients(p.at),
                });
                tabulated.collect()
            };
            let (straight, mass) = match kind {
                CellKind::Tetrahedron4 => (1, 2),
                CellKind::Tetrahedron10 => (2, 5),
                _ if kind.is_first_order() => (3, 3),
                _ => (5, 5),
            };
            let corners = kind.corners();
            let middle =
                std::array::from_fn(|k| corners.iter().map(|c| c[k]).sum::<f64>() / corners.len() as f64);
            let reduced = (kind == CellKind::Hexahedron20).then(|| table(3));
            Rules {
                straight: table(straight),
                reduced,
                mass: table(mass),
                middle: kind.shape_gradients(middle),
            }
        };
        &ALL.get_or_init(|| CellKind::all().map(rules).collect())[kind as usize]
    }
}

/// B of one node from the gradient of its shape function.
fn strain([a, b, c]: [f64; 3]) -> Strain {
    #[rustfmt::skip]
    let rows = [
        a, 0.0, 0.0,
        0.0, b, 0.0,
        0.0, 0.0, c,
        b, a, 0.0,
        0.0, c, b,
        c, 0.0, a,
    ];
    Strain::from_row_slice(&rows)
}

/// Bᵀ S of one node, whose B has nine entries.
fn forces([a, b, c]: [f64; 3], s: &Strain) -> Matrix3<f64> {
    Matrix3::from_fn(|row, j| match row {
        0 => a * s[(0, j)] + b * s[(3, j)] + c * s[(5, j)],
        1 => b * s[(1, j)] + a * s[(3, j)] + c * s[(4, j)],
        _ => c * s[(2, j)] + b * s[(4, j)] + a * s[(5, j)],
    })
}

fn symmetric_stress(s: &SMatrix<f64, 6, 1>) -> Matrix3<f64> {
    Matrix3::new(s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2])
}

impl<'a> SolidElement<'a> {
    /// The element of `solid` on a cell of nodes with the given coordinates \[m\].
    pub fn new(solid: &'a Solid, coordinates: &'a [[f64; 3]], cell: &'a Cell) -> Self {
        SolidElement { solid, coordinates, cell }
    }

    /// ∂x/∂ξ, whose columns are the tangents.
    fn jacobian(&self, gradients: &[[f64; 3]]) -> Matrix3<f64> {
        let mut j = Matrix3::zeros();
        for (node, g) in self.cell.nodes().iter().zip(gradients) {
            let x = self.coordinates[*node];
            for (r, x) in x.iter().enumerate() {
                (0..3).for_each(|c| j[(r, c)] += x * g[c]);
            }
        }
        j
    }

    /// The gradients of the shape functions by x, y, z, and dV of a point.
    fn gradients(&self, point: &Tabulated, to: &mut Vec<[f64; 3]>) -> f64 {
        let j = self.jacobian(&point.gradients);
        let inverse = j.try_inverse().unwrap_or_default();
        to.clear();
        to.extend(point.gradients.iter().map(|g| -> [f64; 3] {
            std::array::from_fn(|k| g[0] * inverse[(0, k)] + g[1] * inverse[(1, k)] + g[2] * inverse[(2, k)])
        }));
        point.weight * j.determinant()
    }

    /// Adds the gradients of the displacements inside of a hexahedron, as nodes of their own.
    fn add_bubbles(&self, point: &Tabulated, middle: &Matrix3<f64>, to: &mut Vec<[f64; 3]>) {
        let ratio = middle.determinant() / self.jacobian(&point.gradients).determinant();
        let inverse = middle.try_inverse().unwrap_or_default();
        for (k, at) in point.at.iter().enumerate() {
            let slope = -2.0 * at * ratio;
            to.push(std::array::from_fn(|c| slope * inverse[(k, c)]));
        }
    }

    /// The quadratures of K, each with its share.
    fn stiffness_rules(&self) -> Vec<(f64, &'static [Tabulated])> {
        let rules = Rules::of(self.cell.kind());
        let exact: &[Tabulated] = if self.is_straight() { &rules.straight } else { &rules.mass };
        match &rules.reduced {
            Some(reduced) if self.solid.integration == Integration::Reduced => {
                vec![(1.0 - STABILISATION, reduced), (STABILISATION, exact)]
            }
            _ => vec![(1.0, exact)],
        }
    }

    /// The points of all of them, with their shares.
    fn stiffness_points(&self) -> impl Iterator<Item = (f64, &'static Tabulated)> {
        let of_rule = |(share, points): (f64, &'static [Tabulated])| points.iter().map(move |p| (share, p));
        self.stiffness_rules().into_iter().flat_map(of_rule)
    }

    /// Whether the nodes in the middle of edges and faces are the means of their corners.
    fn is_straight(&self) -> bool {
        let (kind, nodes) = (self.cell.kind(), self.cell.nodes());
        let at = |k: usize| Vector3::from(self.coordinates[nodes[k]]);
        let size = (at(0) - at(1)).norm();
        kind.is_first_order()
            || kind.table().middles.iter().enumerate().skip(kind.n_corners()).all(|(k, of)| {
                let mean = of.iter().map(|c| at(usize::from(*c))).sum::<Vector3<f64>>() / of.len() as f64;
                (at(k) - mean).norm() < STRAIGHT * size
            })
    }

    fn has_bubbles(&self) -> bool {
        self.cell.kind() == CellKind::Hexahedron8
    }

    /// ∂x/∂ξ in the middle.
    fn middle(&self) -> Matrix3<f64> {
        self.jacobian(&Rules::of(self.cell.kind()).middle)
    }

    /// The displacements inside of a hexahedron that those of its nodes bring, α = −K_αα⁻¹ K_αu u.
    fn bubbles(&self, whole: &ElementMatrix) -> Option<SMatrix<f64, 9, 24>> {
        let inner = SMatrix::<f64, 9, 9>::from_fn(|i, j| whole.get(24 + i, 24 + j));
        let outer = SMatrix::<f64, 9, 24>::from_fn(|i, j| whole.get(24 + i, j));
        Some(-(inner.cholesky()?.solve(&outer)))
    }

    /// ∫ Bᵀ D B dV on the nodes and, of a hexahedron, the displacements inside.
    fn whole_stiffness(&self, k: &mut ElementMatrix) {
        let d = self.solid.material.elasticity();
        let middle = self.has_bubbles().then(|| self.middle());
        let mut gradients = Vec::with_capacity(30);
        for (share, point) in self.stiffness_points() {
            let volume = share * self.gradients(point, &mut gradients);
            if let Some(middle) = &middle {
                self.add_bubbles(point, middle, &mut gradients);
            }
            for (j, g) in gradients.iter().enumerate() {
                let stress = d * strain(*g) * volume;
                for (i, g) in gradients[..=j].iter().enumerate() {
                    k.add_block(i, j, &forces(*g, &stress));
                }
            }
        }
        k.mirror();
    }
}

impl FiniteElement for SolidElement<'_> {
    fn nodes(&self) -> &[usize] {
        self.cell.nodes()
    }

    fn components(&self) -> &'static [usize] {
        &[0, 1, 2]
    }

    fn is_degenerate(&self) -> bool {
        let Rules { straight, mass, .. } = Rules::of(self.cell.kind());
        // NaN is not sound either.
        let keeps_sign = |jacobian: Matrix3<f64>| jacobian.determinant() > 0.0;
        let sound = |point: &Tabulated| keeps_sign(self.jacobian(&point.gradients));
        !straight.iter().chain(mass).all(sound) || !keeps_sign(self.middle())
    }

    fn material(&self) -> Option<&Material> {
        Some(&self.solid.material)
    }

    fn stiffness(&self, k: &mut ElementMatrix) -> bool {
        if !self.has_bubbles() {
            self.whole_stiffness(k);
            return true;
        }
        let mut whole = ElementMatrix::default();
        whole.reset(33);
        self.whole_stiffness(&mut whole);
        let Some(bubbles) = self.bubbles(&whole) else { return false };
        let outer = SMatrix::<f64, 24, 9>::from_fn(|i, j| whole.get(i, 24 + j));
        let less = outer * bubbles;
        for j in 0..24 {
            (0..=j).for_each(|i| k.set(i, j, whole.get(i, j) + 0.5 * (less[(i, j)] + less[(j, i)])));
        }
        k.mirror();
        true
    }

    fn mass(&self, m: &mut ElementMatrix) -> bool {
        for point in &Rules::of(self.cell.kind()).mass {
            let mass =
                self.solid.material.density * point.weight * self.jacobian(&point.gradients).determinant();
            for (j, b) in point.shape.iter().enumerate() {
                for (i, a) in point.shape[..=j].iter().enumerate() {
                    let share = mass * a * b;
                    (0..3).for_each(|k| m.set(3 * i + k, 3 * j + k, m.get(3 * i + k, 3 * j + k) + share));
                }
            }
        }
        m.mirror();
        true
    }

    fn geometric_stiffness(&self, displacement: &[[f64; 6]], k: &mut ElementMatrix) -> bool {
        let d = self.solid.material.elasticity();
        let nodes = self.cell.nodes();
        let mut u: Vec<Vector3<f64>> =
            nodes.iter().map(|n| Vector3::from_column_slice(&displacement[*n][..3])).collect();
        let middle = self.has_bubbles().then(|| self.middle());
        if middle.is_some() {
            let mut whole = ElementMatrix::default();
            whole.reset(33);
            self.whole_stiffness(&mut whole);
            let Some(bubbles) = self.bubbles(&whole) else { return false };
            let flat = SMatrix::<f64, 24, 1>::from_fn(|i, _| u[i / 3][i % 3]);
            let inside = bubbles * flat;
            u.extend((0..3).map(|b| Vector3::new(inside[3 * b], inside[3 * b + 1], inside[3 * b + 2])));
        }
        let mut gradients = Vec::with_capacity(30);
        for (share, point) in self.stiffness_points() {
            let volume = share * self.gradients(point, &mut gradients);
            if let Some(middle) = &middle {
                self.add_bubbles(point, middle, &mut gradients);
            }
            let strains = gradients
                .iter()
                .zip(&u)
                .fold(SMatrix::<f64, 6, 1>::zeros(), |sum, (g, u)| sum + strain(*g) * u);
            let stress = symmetric_stress(&(d * strains)) * volume;
            for (j, b) in gradients[..nodes.len()].iter().enumerate() {
                let force = stress * Vector3::from(*b);
                for (i, a) in gradients[..=j].iter().enumerate() {
                    let share = Vector3::from(*a).dot(&force);
                    (0..3).for_each(|c| k.set(3 * i + c, 3 * j + c, k.get(3 * i + c, 3 * j + c) + share));
                }
            }
        }
        k.mirror();
        true
    }

    fn transport(&self, axis: &RotationAxis, [convected, transport]: [&mut ElementMatrix; 2]) -> bool {
        let mut gradients = Vec::with_capacity(30);
        for point in &Rules::of(self.cell.kind()).mass {
            let mass = self.solid.material.density * self.gradients(point, &mut gradients);
            let at = std::array::from_fn(|k| {
                self.cell.nodes().iter().zip(&point.shape).map(|(n, s)| s * self.coordinates[*n][k]).sum()
            });
            let velocity = axis.velocity(at);
            let along: Vec<f64> = gradients.iter().map(|g| velocity.dot(&Vector3::from(*g))).collect();
            for (j, b) in along.iter().enumerate() {
                for (i, (shape, a)) in point.shape.iter().zip(&along).enumerate() {
                    for (matrix, share) in
                        [(&mut *convected, mass * shape * b), (&mut *transport, mass * a * b)]
                    {
                        (0..3).for_each(|k| {
                            matrix.set(3 * i + k, 3 * j + k, matrix.get(3 * i + k, 3 * j + k) + share)
                        });
                    }
                }
            }
        }
        true
    }

    fn mass_and_center(&self) -> (f64, [f64; 3]) {
        let (mut mass, mut moment) = (0.0, [0.0; 3]);
        for point in &Rules::of(self.cell.kind()).mass {
            let own =
                self.solid.material.density * point.weight * self.jacobian(&point.gradients).determinant();
            mass += own;
            for (node, shape) in self.cell.nodes().iter().zip(&point.shape) {
                (0..3).for_each(|k| moment[k] += own * shape * self.coordinates[*node][k]);
            }
        }
        (
            mass,
            if mass > 0.0 {
                moment.map(|m| m / mass)
            } else {
                super::mean(self.cell.nodes(), self.coordinates)
            },
        )
    }
}
