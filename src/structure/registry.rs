//! Which element stands for what of a model: the only place that names them all.

use super::elements::{
    BarElement, FacePoint, FiniteElement, KirchhoffTriangle, MassElement, MindlinQuadrilateral,
    MindlinTriangle, SolidElement, SpringElement, split_face,
};
use super::model::{Model, Part, PartKind, PlateTheory, Shell};
use crate::mesh::Cell;

/// An element of any kind.
pub(super) type AnyElement<'a> = Box<dyn FiniteElement + 'a>;
/// Elements in a fixed order.
type Elements<'a> = Vec<AnyElement<'a>>;

/// The elements of `model`: parts, masses, springs.
pub(super) fn elements(model: &Model) -> Elements<'_> {
    let nodes = &model.nodes;
    let mut elements: Elements = Vec::new();
    for part in &model.parts {
        part.cells.iter().for_each(|cell| push_elements(&part.kind, cell, nodes, &mut elements));
    }
    elements.extend(model.masses.iter().map(|point| boxed(MassElement::new(point, nodes))));
    elements.extend(model.springs.iter().map(|spring| boxed(SpringElement::new(spring))));
    elements
}

/// Adds the elements on one cell of a part to `to`; none for a cell of another dimension.
fn push_elements<'a>(kind: &'a PartKind, cell: &'a Cell, nodes: &'a [[f64; 3]], to: &mut Elements<'a>) {
    match kind {
        PartKind::Shell(shell) => push_plates(shell, cell, nodes, to),
        PartKind::Solid(solid) if cell.dimension() == 3 => {
            to.push(boxed(SolidElement::new(solid, nodes, cell)))
        }
        PartKind::Solid(_) => {}
        PartKind::Bar(bar) => to.extend(cell.ends().map(|ends| boxed(BarElement::new(bar, nodes, ends)))),
    }
}

fn push_plates<'a>(plate: &'a Shell, face: &Cell, nodes: &'a [[f64; 3]], to: &mut Elements<'a>) {
    match (plate.theory, face.corners()) {
        (PlateTheory::Kirchhoff, _) => {
            let triangles = split_face(face);
            to.extend(triangles.iter().map(|t| boxed(KirchhoffTriangle::new(plate, nodes, t))));
        }
        (PlateTheory::Mindlin, &[a, b, c]) => {
            to.push(boxed(MindlinTriangle::new(plate, nodes, [a, b, c])));
        }
        (PlateTheory::Mindlin, &[a, b, c, d]) => {
            to.push(boxed(MindlinQuadrilateral::new(plate, nodes, [a, b, c, d])));
        }
        (PlateTheory::Mindlin, _) => {}
    }
}

fn boxed<'a>(element: impl FiniteElement + 'a) -> AnyElement<'a> {
    Box::new(element)
}

impl Part {
    /// The elements on `cell`, one of the part's own, on nodes with the given coordinates.
    pub(super) fn elements_on<'a>(&'a self, cell: &'a Cell, nodes: &'a [[f64; 3]]) -> Elements<'a> {
        let mut elements = Vec::new();
        push_elements(&self.kind, cell, nodes, &mut elements);
        elements
    }

    /// One of its elements, which knows what the theory of the part holds for; `None` of a part without cells.
    pub fn element<'a>(&'a self, nodes: &'a [[f64; 3]]) -> Option<Box<dyn FiniteElement + 'a>> {
        self.elements_on(self.cells.first()?, nodes).into_iter().next()
    }

    /// The displacement of a point of `face`, a cell of a shell or a face of a solid, on nodes with the given coordinates: for each node that
    /// it depends on, the (ux, uy, uz, rx, ry, rz) of the point for a unit of each component of the node's. Of a solid it is linear on the
    /// triangle of the point, which meets rigid motions exactly.
    pub fn displacement_at(
        &self,
        nodes: &[[f64; 3]],
        face: &Cell,
        at: &FacePoint,
    ) -> Vec<(usize, usize, [f64; 6])> {
        if matches!(self.kind, PartKind::Solid(_)) {
            let along = |component: usize, share: f64| {
                std::array::from_fn(|k| if k == component { share } else { 0.0 })
            };
            let shares = at.corners.into_iter().zip(at.barycentric);
            return shares
                .flat_map(|(node, share)| (0..3).map(move |c| (node, c, along(c, share))))
                .collect();
        }
        let elements = self.elements_on(face, nodes);
        let of = |element: &AnyElement| {
            let columns = element.displacement_at(at)?;
            let freedoms = element.nodes().iter().flat_map(|n| element.components().iter().map(|c| (*n, *c)));
            Some(freedoms.zip(columns).map(|((node, component), moved)| (node, component, moved)).collect())
        };
        elements.iter().find_map(of).unwrap_or_default()
    }
}
