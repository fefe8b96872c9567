//! The thick flat shell triangle: DKMT bending and OPT membrane.

use super::{PlateSection, Side, corner_shear, corners_among, curvatures, sides, slopes, wavenumber};
use crate::structure::elements::bciz::{self, QUADRATIC_GRAM, deflection_products};
use crate::structure::elements::shell::{BENDING, rows_in_global};
use crate::structure::elements::triangle::{gradients, twice_area};
use crate::structure::elements::{
    Acting, ElementMatrix, FacePoint, FiniteElement, FlatShell, WeightedTriangle, geometric, mass, mean,
    plate_transport, symmetrized,
};
use crate::structure::{Material, RotationAxis, Shell};
use nalgebra::{RowSVector, SMatrix};

/// A triangle of a plate by Mindlin's theory, 18 freedoms.
pub struct MindlinTriangle<'a> {
    plate: &'a Shell,
    coordinates: &'a [[f64; 3]],
    nodes: [usize; 3],
}

/// K of bending and shear on (w, θ₁, θ₂) at the corners, 9 × 9. Curvatures and shear strains are linear, so the three
/// mid-side points integrate exactly.
pub fn triangle_stiffness(corners: &[[f64; 2]; 3], section: &PlateSection) -> SMatrix<f64, 9, 9> {
    let sides = sides::<3, 9>(corners, section);
    let shear = corner_shear(&sides);
    let weight = twice_area(corners) / 6.0;
    let mut k = SMatrix::zeros();
    for at in [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]] {
        let b = curvatures(&rotation_gradient(corners, &sides, at));
        k += b.transpose() * section.rigidity * b * weight;
        let shear_at =
            |d: usize| (0..3).fold(RowSVector::<f64, 9>::zeros(), |sum, i| sum + shear[i][d] * at[i]);
        for g in [shear_at(0), shear_at(1)] {
            k += g.transpose() * g * (weight * section.shear);
        }
    }
    symmetrized(k)
}

/// The x and y derivatives of (β_x, β_y) at barycentric coordinates `at`.
fn rotation_gradient(
    corners: &[[f64; 2]; 3],
    sides: &[Side<9>; 3],
    at: [f64; 3],
) -> [[RowSVector<f64, 9>; 2]; 2] {
    let grad = gradients(corners);
    [0, 1].map(|d| {
        let mut beta = [RowSVector::<f64, 9>::zeros(); 2];
        for i in 0..3 {
            beta[0][3 * i + 2] = grad[i][d];
            beta[1][3 * i + 1] = -grad[i][d];
        }
        for Side { ends: [i, j], tangent, bulge, .. } in sides {
            let slope = 4.0 * (grad[*i][d] * at[*j] + at[*i] * grad[*j][d]);
            beta.iter_mut().zip(tangent).for_each(|(beta, t)| *beta += bulge * (slope * t));
        }
        beta
    })
}

/// ρh³/12 ∫ |β|² dA on (w, θ₁, θ₂) at the corners, 9 × 9.
pub fn triangle_rotary_inertia(
    corners: &[[f64; 2]; 3],
    section: &PlateSection,
    density: f64,
    thickness: f64,
) -> SMatrix<f64, 9, 9> {
    let sides = sides::<3, 9>(corners, section);
    let factor = density * thickness.powi(3) / 12.0 * twice_area(corners) / 2.0;
    let mut m = SMatrix::<f64, 9, 9>::zeros();
    for (component, freedom, sign) in [(0, 2, 1.0), (1, 1, -1.0)] {
        // Bernstein coefficients of degree 2: corners, then sides; 4 L_i L_j = 2 B.
        let mut field = SMatrix::<f64, 6, 9>::zeros();
        for (k, Side { ends, tangent, bulge, .. }) in sides.iter().enumerate() {
            field[(k, 3 * k + freedom)] = sign;
            let mut middle = bulge * (2.0 * tangent[component]);
            ends.iter().for_each(|end| middle[3 * end + freedom] += 0.5 * sign);
            field.set_row(3 + k, &middle);
        }
        m += field.transpose() * *QUADRATIC_GRAM * field * factor;
    }
    symmetrized(m)
}

impl<'a> MindlinTriangle<'a> {
    /// A triangle of `plate` on nodes with the given coordinates \[m\].
    pub fn new(plate: &'a Shell, coordinates: &'a [[f64; 3]], nodes: [usize; 3]) -> Self {
        MindlinTriangle { plate, coordinates, nodes }
    }

    fn geometry(&self) -> Option<FlatShell> {
        FlatShell::new(&self.nodes.map(|n| self.coordinates[n]))
    }

    fn shell(&self) -> FlatShell {
        self.geometry().expect("checked: it has an area")
    }

    /// [`slopes`] of the triangle.
    fn slopes(&self, corners: &[[f64; 2]; 3]) -> SMatrix<f64, 9, 9> {
        slopes(&corner_shear(&sides::<3, 9>(corners, &PlateSection::new(self.plate))))
    }
}

impl FiniteElement for MindlinTriangle<'_> {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn acting(&self) -> Acting {
        if !self.plate.bending_only {
            return Acting::Everywhere;
        }
        Acting::Along(self.shell().bending_directions())
    }

    fn is_degenerate(&self) -> bool {
        self.geometry().is_none()
    }

    fn material(&self) -> Option<&Material> {
        Some(&self.plate.material)
    }

    fn stiffness(&self, k: &mut ElementMatrix) -> bool {
        let (shell, plate) = (self.shell(), self.plate);
        let bending = triangle_stiffness(&shell.triangle().corners, &PlateSection::new(plate));
        let membrane =
            (!plate.bending_only).then(|| shell.membrane_stiffness(&plate.material, plate.thickness));
        k.copy(&shell.embedded(Some(&bending), membrane.as_ref()));
        true
    }

    /// ρh ∫ w² dA with the cubic w of the [`slopes`], and rotary inertia of β.
    fn mass(&self, m: &mut ElementMatrix) -> bool {
        let (shell, plate) = (self.shell(), self.plate);
        let (corners, area) = (&shell.triangle().corners, shell.triangle().area);
        let (density, thickness) = (plate.material.density, plate.thickness);
        let map = self.slopes(corners);
        let mut bending = map.transpose() * deflection_products(corners) * map * (density * thickness * area);
        if plate.rotary_inertia {
            bending += triangle_rotary_inertia(corners, &PlateSection::new(plate), density, thickness);
        }
        let membrane = (!plate.bending_only).then(|| mass::membrane(corners, density, thickness));
        m.copy(&shell.embedded(Some(&symmetrized(bending)), membrane.as_ref()));
        true
    }

    fn geometric_stiffness(&self, displacement: &[[f64; 6]], k: &mut ElementMatrix) -> bool {
        if self.plate.bending_only {
            return false;
        }
        let shell = self.shell();
        let corners = &shell.triangle().corners;
        let u = self.nodes.map(|n| displacement[n]);
        let forces = shell.membrane_forces(&self.plate.material, self.plate.thickness, &u);
        let map = self.slopes(corners);
        let bending = map.transpose() * geometric::plate(corners, forces) * map;
        k.copy(&shell.embedded(Some(&symmetrized(bending)), Some(&geometric::membrane(corners, forces))));
        true
    }

    fn transport(&self, axis: &RotationAxis, matrices: [&mut ElementMatrix; 2]) -> bool {
        plate_transport(
            self,
            (self.plate, self.coordinates),
            &[WeightedTriangle { nodes: self.nodes, weight: 1.0 }],
            axis,
            matrices,
        )
    }

    fn mass_and_center(&self) -> (f64, [f64; 3]) {
        let area = self.geometry().map_or(0.0, |shell| shell.triangle().area);
        (self.plate.material.density * self.plate.thickness * area, mean(&self.nodes, self.coordinates))
    }

    /// The deflection is the cubic of the mass, the rotations in the plane are those of the section, the rest is linear.
    fn displacement_at(&self, at: &FacePoint) -> Option<Vec<[f64; 6]>> {
        let order = corners_among(&self.nodes, at)?;
        let mut l = [0.0; 3];
        order.into_iter().zip(at.barycentric).for_each(|(k, value)| l[k] = value);
        let shell = self.shell();
        let corners = &shell.triangle().corners;
        let sides = sides::<3, 9>(corners, &PlateSection::new(self.plate));
        let mut rows = bciz::interpolate(corners, l) * slopes(&corner_shear(&sides));
        // θ₁ = −β_y, θ₂ = β_x.
        let mut rotation = SMatrix::<f64, 2, 9>::zeros();
        for i in 0..3 {
            rotation[(0, 3 * i + 1)] = l[i];
            rotation[(1, 3 * i + 2)] = l[i];
        }
        for Side { ends: [i, j], tangent: [tx, ty], bulge, .. } in &sides {
            let bubble = bulge * (4.0 * l[*i] * l[*j]);
            rotation.set_row(0, &(rotation.row(0) - bubble * *ty));
            rotation.set_row(1, &(rotation.row(1) + bubble * *tx));
        }
        rows.fixed_rows_mut::<2>(1).copy_from(&rotation);
        let mut local = SMatrix::<f64, 6, 18>::zeros();
        for (k, column) in BENDING.into_iter().enumerate() {
            local.fixed_view_mut::<3, 1>(2, column).copy_from(&rows.column(k));
        }
        for (corner, l) in l.into_iter().enumerate() {
            [0, 1, 5].into_iter().for_each(|row| local[(row, 6 * corner + row)] = l);
        }
        Some(rows_in_global(&local, &shell.triangle().frame))
    }

    fn bending_wavenumber(&self, frequency_hz: f64) -> Option<f64> {
        wavenumber(self.plate, frequency_hz)
    }
}
