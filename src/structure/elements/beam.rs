//! The Euler–Bernoulli bar in space: cubic bending in two planes, linear stretch and twist.

use super::{geometric, to_global};
use crate::structure::{Material, Section};
use nalgebra::{Matrix3, SMatrix, Vector3};

/// A straight bar; its matrices are on (ux, uy, uz, rx, ry, rz) of its two ends, in global axes.
///
/// Local axes: e along the bar, a₁ the section's first axis, a₂ = e × a₁ its second. The second moment about a₁
/// resists deflection along a₂, that about a₂ deflection along a₁.
#[derive(Debug, Clone, PartialEq)]
pub struct Beam {
    length: f64,
    /// Rows e, a₁, a₂.
    frame: Matrix3<f64>,
}

/// (w, w′) at both ends for deflection w along a₁: (v, θ₃), v′ = θ₃.
const ALONG_FIRST: [(usize, f64); 4] = [(1, 1.0), (5, 1.0), (7, 1.0), (11, 1.0)];
/// (w, w′) at both ends for deflection w along a₂: (w, −θ₂), w′ = −θ₂.
const ALONG_SECOND: [(usize, f64); 4] = [(2, 1.0), (4, -1.0), (8, 1.0), (10, -1.0)];

impl Beam {
    /// The bar from `ends[0]` to `ends[1]` \[m\]; a₁ lies in the plane of the bar and `orientation`. `None` when the
    /// bar has no length or `orientation` lies along it (within 1e-6 rad).
    pub fn new(ends: &[[f64; 3]; 2], orientation: [f64; 3]) -> Option<Self> {
        let [from, to] = ends.map(Vector3::from);
        let along = to - from;
        let length = along.norm();
        let size = from.norm().max(to.norm());
        if !(length > 1e-12 * size && length.is_finite()) {
            return None;
        }
        let e = along / length;
        let orientation = Vector3::from(orientation);
        let across = orientation - e * e.dot(&orientation);
        if !(across.norm() > 1e-6 * orientation.norm() && across.norm().is_finite()) {
            return None;
        }
        let a1 = across / across.norm();
        let a2 = e.cross(&a1);
        let frame = Matrix3::from_rows(&[e.transpose(), a1.transpose(), a2.transpose()]);
        Some(Beam { length, frame })
    }

    /// l \[m\].
    pub fn length(&self) -> f64 {
        self.length
    }

    /// K, 12 × 12: E A stretch, G J twist with G = E/2(1+ν), E I bending in both planes.
    pub fn stiffness(&self, material: &Material, section: &Section) -> SMatrix<f64, 12, 12> {
        let l = self.length;
        let e = material.youngs_modulus;
        let g = e / (2.0 * (1.0 + material.poissons_ratio));
        let mut local = SMatrix::zeros();
        pair(&mut local, 0, [e * section.area / l, -e * section.area / l]);
        pair(&mut local, 3, [g * section.torsion / l, -g * section.torsion / l]);
        #[rustfmt::skip]
        let bending = SMatrix::<f64, 4, 4>::from_row_slice(&[
            12.0,    6.0 * l,     -12.0,    6.0 * l,
            6.0 * l, 4.0 * l * l, -6.0 * l, 2.0 * l * l,
            -12.0,   -6.0 * l,    12.0,     -6.0 * l,
            6.0 * l, 2.0 * l * l, -6.0 * l, 4.0 * l * l,
        ]) * (e / l.powi(3));
        plane(&mut local, &ALONG_FIRST, &(bending * section.inertia_2));
        plane(&mut local, &ALONG_SECOND, &(bending * section.inertia_1));
        to_global(&local, &self.frame)
    }

    /// M, 12 × 12: ρA of the displacement and ρ(I₁ + I₂) of the twist; no rotary inertia in bending.
    pub fn mass(&self, density: f64, section: &Section) -> SMatrix<f64, 12, 12> {
        let l = self.length;
        let mass = density * section.area * l;
        let twist = density * (section.inertia_1 + section.inertia_2) * l;
        let mut local = SMatrix::zeros();
        pair(&mut local, 0, [mass / 3.0, mass / 6.0]);
        pair(&mut local, 3, [twist / 3.0, twist / 6.0]);
        #[rustfmt::skip]
        let bending = SMatrix::<f64, 4, 4>::from_row_slice(&[
            156.0,     22.0 * l,     54.0,      -13.0 * l,
            22.0 * l,  4.0 * l * l,  13.0 * l,  -3.0 * l * l,
            54.0,      13.0 * l,     156.0,     -22.0 * l,
            -13.0 * l, -3.0 * l * l, -22.0 * l, 4.0 * l * l,
        ]) * (mass / 420.0);
        plane(&mut local, &ALONG_FIRST, &bending);
        plane(&mut local, &ALONG_SECOND, &bending);
        to_global(&local, &self.frame)
    }

    /// N = E A (elongation)/l \[N\], tension positive, from the displacement of the ends in global axes.
    pub fn axial_force(&self, material: &Material, section: &Section, displacement: &[[f64; 6]; 2]) -> f64 {
        let elongation: f64 =
            (0..3).map(|k| self.frame[(0, k)] * (displacement[1][k] - displacement[0][k])).sum();
        material.youngs_modulus * section.area * elongation / self.length
    }

    /// K_σ of an axial force (tension positive), 12 × 12, in both bending planes.
    pub fn geometric_stiffness(&self, axial_force: f64) -> SMatrix<f64, 12, 12> {
        let bending = geometric::bar(self.length, axial_force);
        let mut local = SMatrix::zeros();
        plane(&mut local, &ALONG_FIRST, &bending);
        plane(&mut local, &ALONG_SECOND, &bending);
        to_global(&local, &self.frame)
    }
}

/// [[d, o], [o, d]] on degree of freedom `k` of both ends.
fn pair(local: &mut SMatrix<f64, 12, 12>, k: usize, [diagonal, off]: [f64; 2]) {
    local[(k, k)] = diagonal;
    local[(k + 6, k + 6)] = diagonal;
    local[(k, k + 6)] = off;
    local[(k + 6, k)] = off;
}

/// A matrix on (w, w′) of both ends, put where `at` says with its signs.
fn plane(local: &mut SMatrix<f64, 12, 12>, at: &[(usize, f64); 4], matrix: &SMatrix<f64, 4, 4>) {
    for (i, (row, sign_i)) in at.iter().enumerate() {
        for (j, (column, sign_j)) in at.iter().enumerate() {
            local[(*row, *column)] += sign_i * sign_j * matrix[(i, j)];
        }
    }
}
