//! A solid as the plate that it may be: for estimates of its waves.

use super::elements::{WeightedTriangle, split_face};
use super::material::Material;
use super::part::Part;
use super::properties::{PlateTheory, Shell};
use crate::mesh::outer_faces;
use nalgebra::Vector3;

/// The skin S of a solid as a plate by Mindlin's theory, 2V/S thick: twice the area of a thin body, at its thickness.
pub fn as_plate(solid: &Part, material: Material, nodes: &[[f64; 3]]) -> Part {
    let skin = outer_faces(solid.cells.iter());
    let at = |node: usize| Vector3::from(nodes[node]);
    // V = ⅓ ∫ x·n dA.
    let share = |t: WeightedTriangle| {
        let [a, b, c] = t.nodes.map(at);
        t.weight * a.dot(&b.cross(&c)) / 6.0
    };
    let volume: f64 = skin.iter().flat_map(split_face).map(share).sum();
    let plate = |thickness: f64| Shell { theory: PlateTheory::Mindlin, ..Shell::new(material, thickness) };
    let mut part = Part::new(&solid.name, skin, plate(0.0));
    let area = part.area(nodes);
    part.kind = plate(if area > 0.0 { 2.0 * volume / area } else { 0.0 }).into();
    part
}
