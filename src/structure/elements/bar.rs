//! The bar of a part of the model.

use super::{Beam, ElementMatrix, FiniteElement};
use crate::structure::{Bar, Material};

/// An Euler–Bernoulli bar between two nodes, 12 freedoms.
pub struct BarElement<'a> {
    bar: &'a Bar,
    coordinates: &'a [[f64; 3]],
    nodes: [usize; 2],
}

impl<'a> BarElement<'a> {
    /// A bar with the section of `bar` on nodes with the given coordinates \[m\].
    pub fn new(bar: &'a Bar, coordinates: &'a [[f64; 3]], nodes: [usize; 2]) -> Self {
        BarElement { bar, coordinates, nodes }
    }

    fn geometry(&self) -> Option<Beam> {
        Beam::new(&self.nodes.map(|n| self.coordinates[n]), self.bar.orientation)
    }

    fn beam(&self) -> Beam {
        self.geometry().expect("checked: it has a length and an orientation")
    }
}

impl FiniteElement for BarElement<'_> {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn is_degenerate(&self) -> bool {
        self.geometry().is_none()
    }

    fn material(&self) -> Option<&Material> {
        Some(&self.bar.material)
    }

    fn stiffness(&self, k: &mut ElementMatrix) -> bool {
        k.copy(&self.beam().stiffness(&self.bar.material, &self.bar.section));
        true
    }

    fn mass(&self, m: &mut ElementMatrix) -> bool {
        m.copy(&self.beam().mass(self.bar.material.density, &self.bar.section));
        true
    }

    fn geometric_stiffness(&self, displacement: &[[f64; 6]], k: &mut ElementMatrix) -> bool {
        let beam = self.beam();
        let u = self.nodes.map(|n| displacement[n]);
        k.copy(&beam.geometric_stiffness(beam.axial_force(&self.bar.material, &self.bar.section, &u)));
        true
    }

    fn mass_and_center(&self) -> (f64, [f64; 3]) {
        let length = self.geometry().map_or(0.0, |beam| beam.length());
        let mass = self.bar.material.density * self.bar.section.area * length;
        (mass, super::mean(&self.nodes, self.coordinates))
    }
}
