//! The flat shell triangle in space: DKT bending and OPT membrane, six degrees of freedom a corner.

use super::{FlatTriangle, bciz, dkt, geometric, mass, opt, to_global};
use crate::structure::Material;
use nalgebra::SMatrix;

/// Where (w, θ₁, θ₂) of the three corners stand among (u, v, w, θ₁, θ₂, θ₃).
const BENDING: [usize; 9] = [2, 3, 4, 8, 9, 10, 14, 15, 16];
/// Where (u, v, θ₃) of the three corners stand.
const MEMBRANE: [usize; 9] = [0, 1, 5, 6, 7, 11, 12, 13, 17];

/// A flat shell triangle; its matrices are on (ux, uy, uz, rx, ry, rz) of its corners, in global axes.
#[derive(Debug, Clone, PartialEq)]
pub struct FlatShell {
    triangle: FlatTriangle,
}

impl FlatShell {
    /// The triangle with corners `nodes` \[m\]; `None` when it has no area.
    pub fn new(nodes: &[[f64; 3]; 3]) -> Option<Self> {
        FlatTriangle::new(nodes).map(|triangle| FlatShell { triangle })
    }

    /// The triangle in its plane.
    pub fn triangle(&self) -> &FlatTriangle {
        &self.triangle
    }

    /// K, 18 × 18; with `bending_only` the bending part alone.
    pub fn stiffness(&self, material: &Material, thickness: f64, bending_only: bool) -> SMatrix<f64, 18, 18> {
        let (e, nu) = (material.youngs_modulus, material.poissons_ratio);
        let corners = &self.triangle.corners;
        let mut local = SMatrix::zeros();
        place(&dkt::stiffness(corners, &dkt::bending_rigidity(e, nu, thickness)), &BENDING, &mut local);
        if !bending_only {
            place(&opt::stiffness(corners, &dkt::plane_stress(e, nu), nu, thickness), &MEMBRANE, &mut local);
        }
        to_global(&local, &self.triangle.frame)
    }

    /// M, 18 × 18; with `bending_only` that of the deflection alone.
    pub fn mass(
        &self,
        density: f64,
        thickness: f64,
        rotary_inertia: bool,
        bending_only: bool,
    ) -> SMatrix<f64, 18, 18> {
        let corners = &self.triangle.corners;
        let mut local = SMatrix::zeros();
        place(&mass::bending(corners, density, thickness, rotary_inertia), &BENDING, &mut local);
        if !bending_only {
            place(&mass::membrane(corners, density, thickness), &MEMBRANE, &mut local);
        }
        to_global(&local, &self.triangle.frame)
    }

    /// Mean membrane forces (N_x, N_y, N_xy) in the local axes \[N/m\], tension positive, from the displacement of the
    /// corners in global axes: N = h E ε with ε the mean strain of the optimal triangle.
    pub fn membrane_forces(
        &self,
        material: &Material,
        thickness: f64,
        displacement: &[[f64; 6]; 3],
    ) -> [f64; 3] {
        let frame = &self.triangle.frame;
        let mut local = nalgebra::SVector::<f64, 9>::zeros();
        for (corner, u) in displacement.iter().enumerate() {
            let translation = frame * nalgebra::Vector3::new(u[0], u[1], u[2]);
            let rotation = frame * nalgebra::Vector3::new(u[3], u[4], u[5]);
            local[3 * corner] = translation[0];
            local[3 * corner + 1] = translation[1];
            local[3 * corner + 2] = rotation[2];
        }
        let elasticity = dkt::plane_stress(material.youngs_modulus, material.poissons_ratio);
        (elasticity * opt::mean_strain(&self.triangle.corners) * local * thickness).into()
    }

    /// K_σ of membrane forces in the local axes (see [`FlatShell::membrane_forces`]), 18 × 18.
    pub fn geometric_stiffness(&self, membrane_forces: [f64; 3]) -> SMatrix<f64, 18, 18> {
        let mut local = SMatrix::zeros();
        place(&geometric::plate(&self.triangle.corners, membrane_forces), &BENDING, &mut local);
        to_global(&local, &self.triangle.frame)
    }

    /// (ux, uy, uz, rx, ry, rz) of the mid-surface at barycentric coordinates `at`, as combinations of the 18 degrees
    /// of freedom: rows and columns in global axes.
    ///
    /// The deflection is the cubic of [`bciz`] and the rotations in the plane are its slopes; the membrane
    /// displacements and the drilling rotation are linear. Rigid motions are met exactly.
    pub fn displacement_at(&self, at: [f64; 3]) -> [[f64; 18]; 6] {
        let mut local = SMatrix::<f64, 6, 18>::zeros();
        let bending = bciz::interpolate(&self.triangle.corners, at);
        for (k, column) in BENDING.into_iter().enumerate() {
            for row in 0..3 {
                local[(2 + row, column)] = bending[(row, k)];
            }
        }
        for (corner, l) in at.into_iter().enumerate() {
            for row in [0, 1, 5] {
                local[(row, 6 * corner + row)] = l;
            }
        }
        let frame = &self.triangle.frame;
        let mut global = [[0.0; 18]; 6];
        for i in [0, 3] {
            for j in (0..18).step_by(3) {
                let block = frame.transpose() * local.fixed_view::<3, 3>(i, j) * frame;
                for r in 0..3 {
                    for c in 0..3 {
                        global[i + r][j + c] = block[(r, c)];
                    }
                }
            }
        }
        global
    }
}

/// Puts a 9 × 9 matrix at `at` of an 18 × 18 one.
fn place(part: &SMatrix<f64, 9, 9>, at: &[usize; 9], whole: &mut SMatrix<f64, 18, 18>) {
    for (i, row) in at.iter().enumerate() {
        for (j, column) in at.iter().enumerate() {
            whole[(*row, *column)] = part[(i, j)];
        }
    }
}
