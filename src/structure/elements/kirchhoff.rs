//! The thin flat shell: DKT bending and OPT membrane on a triangle, alone or as one of the four of a quadrilateral.

use super::waves::{kirchhoff_wavenumber, thickness_error};
use super::{
    Acting, ElementMatrix, FacePoint, FiniteElement, FlatShell, TheoryError, WeightedTriangle,
    plate_transport,
};
use crate::structure::{Material, RotationAxis, Shell};
use nalgebra::SMatrix;

/// A triangle of a plate by Kirchhoff's theory, 18 freedoms.
pub struct KirchhoffTriangle<'a> {
    plate: &'a Shell,
    coordinates: &'a [[f64; 3]],
    nodes: [usize; 3],
    /// 1, or ½ of the triangles of a quadrilateral.
    weight: f64,
    /// `None` where its corners leave it without an area.
    geometry: Option<FlatShell>,
}

impl<'a> KirchhoffTriangle<'a> {
    /// A triangle of `plate` on nodes with the given coordinates \[m\].
    pub fn new(plate: &'a Shell, coordinates: &'a [[f64; 3]], triangle: &WeightedTriangle) -> Self {
        let WeightedTriangle { nodes, weight } = *triangle;
        let geometry = FlatShell::new(&nodes.map(|n| coordinates[n]));
        KirchhoffTriangle { plate, coordinates, nodes, weight, geometry }
    }

    fn shell(&self) -> &FlatShell {
        self.geometry.as_ref().expect("checked: it has an area")
    }

    fn weighted(&self, matrix: &SMatrix<f64, 18, 18>, to: &mut ElementMatrix) -> bool {
        to.copy(&(matrix * self.weight));
        true
    }
}

impl FiniteElement for KirchhoffTriangle<'_> {
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
        self.geometry.is_none()
    }

    fn material(&self) -> Option<&Material> {
        Some(&self.plate.material)
    }

    fn stiffness(&self, k: &mut ElementMatrix) -> bool {
        let plate = self.plate;
        self.weighted(&self.shell().stiffness(&plate.material, plate.thickness, plate.bending_only), k)
    }

    fn mass(&self, m: &mut ElementMatrix) -> bool {
        let Shell { material, thickness, rotary_inertia, bending_only, .. } = self.plate;
        self.weighted(&self.shell().mass(material.density, *thickness, *rotary_inertia, *bending_only), m)
    }

    fn geometric_stiffness(&self, displacement: &[[f64; 6]], k: &mut ElementMatrix) -> bool {
        if self.plate.bending_only {
            return false;
        }
        let shell = self.shell();
        let u = self.nodes.map(|n| displacement[n]);
        let forces = shell.membrane_forces(&self.plate.material, self.plate.thickness, &u);
        self.weighted(&shell.geometric_stiffness(forces), k)
    }

    fn transport(&self, axis: &RotationAxis, matrices: [&mut ElementMatrix; 2]) -> bool {
        plate_transport(
            self,
            (self.plate, self.coordinates),
            &[WeightedTriangle { nodes: self.nodes, weight: self.weight }],
            axis,
            matrices,
        )
    }

    fn mass_and_center(&self) -> (f64, [f64; 3]) {
        let area = self.geometry.as_ref().map_or(0.0, |shell| shell.triangle().area);
        let mass = self.plate.material.density * self.plate.thickness * area * self.weight;
        (mass, super::mean(&self.nodes, self.coordinates))
    }

    /// The deflection is the cubic of [`super::bciz`], the rotations in the plane are its slopes, the rest is linear.
    fn displacement_at(&self, at: &FacePoint) -> Option<Vec<[f64; 6]>> {
        (at.corners == self.nodes).then(|| self.shell().displacement_at(at.barycentric))
    }

    fn theory_error(&self, frequency_hz: f64) -> Option<TheoryError> {
        let Shell { material, thickness, rotary_inertia, .. } = self.plate;
        let k = kirchhoff_wavenumber(material, *thickness, *rotary_inertia, frequency_hz);
        Some(TheoryError {
            wavenumber_times_thickness: k * thickness,
            relative_error: thickness_error(material, *thickness, *rotary_inertia, frequency_hz),
        })
    }

    fn bending_wavenumber(&self, frequency_hz: f64) -> Option<f64> {
        let Shell { material, thickness, rotary_inertia, .. } = self.plate;
        Some(kirchhoff_wavenumber(material, *thickness, *rotary_inertia, frequency_hz))
    }
}
