//! The flat shell triangle in space: DKT bending and OPT membrane, six degrees of freedom a corner.

use super::{FlatTriangle, bciz, dkt, geometric, mass, opt, to_global};
use crate::structure::Material;
use nalgebra::{Matrix3, SMatrix};

/// Where (w, θ₁, θ₂) of the three corners stand among (u, v, w, θ₁, θ₂, θ₃).
pub(super) const BENDING: [usize; 9] = [2, 3, 4, 8, 9, 10, 14, 15, 16];
/// Where (u, v, θ₃) of the three corners stand.
pub(super) const MEMBRANE: [usize; 9] = [0, 1, 5, 6, 7, 11, 12, 13, 17];

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
        let rigidity = dkt::bending_rigidity(material.youngs_modulus, material.poissons_ratio, thickness);
        let bending = dkt::stiffness(&self.triangle.corners, &rigidity);
        let membrane = (!bending_only).then(|| self.membrane_stiffness(material, thickness));
        self.embedded(Some(&bending), membrane.as_ref())
    }

    /// K of the membrane on (u, v, θ₃) of the corners in local axes, 9 × 9.
    pub fn membrane_stiffness(&self, material: &Material, thickness: f64) -> SMatrix<f64, 9, 9> {
        let nu = material.poissons_ratio;
        let elasticity = dkt::plane_stress(material.youngs_modulus, nu);
        opt::stiffness(&self.triangle.corners, &elasticity, nu, thickness)
    }

    /// The 18 × 18 matrix in global axes of one on (w, θ₁, θ₂) and one on (u, v, θ₃) of the corners in local axes.
    pub fn embedded(
        &self,
        bending: Option<&SMatrix<f64, 9, 9>>,
        membrane: Option<&SMatrix<f64, 9, 9>>,
    ) -> SMatrix<f64, 18, 18> {
        let mut local = SMatrix::zeros();
        for (part, at) in [(bending, &BENDING), (membrane, &MEMBRANE)] {
            if let Some(part) = part {
                place(part, at, &mut local);
            }
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
        let bending = mass::bending(corners, density, thickness, rotary_inertia);
        let membrane = (!bending_only).then(|| mass::membrane(corners, density, thickness));
        self.embedded(Some(&bending), membrane.as_ref())
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
        let corners = &self.triangle.corners;
        let [bending, membrane] =
            [geometric::plate, geometric::membrane].map(|of| of(corners, membrane_forces));
        self.embedded(Some(&bending), Some(&membrane))
    }

    /// (ux, uy, uz, rx, ry, rz) of the mid-surface at barycentric coordinates `at` for a unit of each of the 18 degrees
    /// of freedom, in global axes.
    ///
    /// The deflection is the cubic of [`bciz`] and the rotations in the plane are its slopes; the membrane
    /// displacements and the drilling rotation are linear. Rigid motions are met exactly.
    pub fn displacement_at(&self, at: [f64; 3]) -> Vec<[f64; 6]> {
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
        rows_in_global(&local, &self.triangle.frame)
    }

    /// The directions in which bending alone acts on a corner: along the normal and about two axes in the plane.
    pub fn bending_directions(&self) -> Vec<[f64; 6]> {
        bending_directions(&self.triangle.frame)
    }
}

/// w along e₃, θ₁ about e₁ and θ₂ about e₂ as combinations of (ux, uy, uz, rx, ry, rz); `frame` has the rows e₁, e₂, e₃.
pub(super) fn bending_directions(frame: &Matrix3<f64>) -> Vec<[f64; 6]> {
    let axis = |row: usize, offset: usize| {
        let mut direction = [0.0; 6];
        (0..3).for_each(|k| direction[offset + k] = frame[(row, k)]);
        direction
    };
    vec![axis(2, 0), axis(0, 3), axis(1, 3)]
}

/// Rows and columns of an interpolation of (ux, uy, uz, rx, ry, rz) turned from local into global axes, column by column.
pub(super) fn rows_in_global<const N: usize>(
    local: &SMatrix<f64, 6, N>,
    frame: &Matrix3<f64>,
) -> Vec<[f64; 6]> {
    let mut global = vec![[0.0; 6]; N];
    for i in [0, 3] {
        for j in (0..N).step_by(3) {
            let block = frame.transpose() * local.fixed_view::<3, 3>(i, j) * frame;
            for r in 0..3 {
                for c in 0..3 {
                    global[j + c][i + r] = block[(r, c)];
                }
            }
        }
    }
    global
}

/// Puts a 9 × 9 matrix at `at` of an 18 × 18 one.
fn place(part: &SMatrix<f64, 9, 9>, at: &[usize; 9], whole: &mut SMatrix<f64, 18, 18>) {
    for (i, row) in at.iter().enumerate() {
        for (j, column) in at.iter().enumerate() {
            whole[(*row, *column)] = part[(i, j)];
        }
    }
}
