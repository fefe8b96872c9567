//! Which element stands for what of a model: the only place that names them all.

use super::elements::{
    BarElement, FacePoint, FiniteElement, KirchhoffTriangle, MassElement, MindlinQuadrilateral,
    MindlinTriangle, SpringElement, split_face,
};
use super::model::{Model, PlateTheory, ShellPart};
use crate::mesh::Cell;

/// An element of any kind.
pub(super) type AnyElement<'a> = Box<dyn FiniteElement + 'a>;
/// Elements in a fixed order.
type Elements<'a> = Vec<AnyElement<'a>>;

/// The elements of `model`: shells, bars, masses, springs.
pub(super) fn elements(model: &Model) -> Elements<'_> {
    let nodes = &model.nodes;
    let mut elements: Elements = Vec::new();
    for part in &model.shells {
        part.faces.iter().for_each(|face| push_elements(part, face, nodes, &mut elements));
    }
    for part in &model.bars {
        elements.extend(part.elements.iter().map(|ends| boxed(BarElement::new(part, nodes, *ends))));
    }
    elements.extend(model.masses.iter().map(|point| boxed(MassElement::new(point, nodes))));
    elements.extend(model.springs.iter().map(|spring| boxed(SpringElement::new(spring))));
    elements
}

/// Adds the elements on one face of a plate to `to`; none for points and lines.
fn push_elements<'a>(part: &'a ShellPart, face: &Cell, nodes: &'a [[f64; 3]], to: &mut Elements<'a>) {
    match (part.theory, face.corners()) {
        (PlateTheory::Kirchhoff, _) => {
            let triangles = split_face(face);
            to.extend(triangles.iter().map(|t| boxed(KirchhoffTriangle::new(part, nodes, t))));
        }
        (PlateTheory::Mindlin, &[a, b, c]) => {
            to.push(boxed(MindlinTriangle::new(part, nodes, [a, b, c])));
        }
        (PlateTheory::Mindlin, &[a, b, c, d]) => {
            to.push(boxed(MindlinQuadrilateral::new(part, nodes, [a, b, c, d])));
        }
        (PlateTheory::Mindlin, _) => {}
    }
}

fn boxed<'a>(element: impl FiniteElement + 'a) -> AnyElement<'a> {
    Box::new(element)
}

impl ShellPart {
    /// The elements on face `face` of the part, on nodes with the given coordinates.
    pub(super) fn elements_on<'a>(&'a self, face: &Cell, nodes: &'a [[f64; 3]]) -> Elements<'a> {
        let mut elements = Vec::new();
        push_elements(self, face, nodes, &mut elements);
        elements
    }

    /// One of its elements, which knows what the theory of the part holds for; `None` of a part without faces.
    pub fn element<'a>(&'a self, nodes: &'a [[f64; 3]]) -> Option<Box<dyn FiniteElement + 'a>> {
        self.elements_on(self.faces.first()?, nodes).into_iter().next()
    }

    /// The displacement of a point of its face `face`, on nodes with the given coordinates: for each node that it depends on, the
    /// (ux, uy, uz, rx, ry, rz) of the point for a unit of each component of the node's.
    pub fn displacement_at(
        &self,
        nodes: &[[f64; 3]],
        face: usize,
        at: &FacePoint,
    ) -> Vec<(usize, usize, [f64; 6])> {
        let elements = self.elements_on(&self.faces[face], nodes);
        let of = |element: &AnyElement| {
            let columns = element.displacement_at(at)?;
            let freedoms = element.nodes().iter().flat_map(|n| element.components().iter().map(|c| (*n, *c)));
            Some(freedoms.zip(columns).map(|((node, component), moved)| (node, component, moved)).collect())
        };
        elements.iter().find_map(of).unwrap_or_default()
    }
}
