//! Parts and their kinds: the only place that names all of these.
//!
//! A new kind is a variant of [`PartKind`], what it answers below, and an element.

use super::elements::{
    BarElement, FacePoint, FiniteElement, FlatTriangle, KirchhoffTriangle, MindlinQuadrilateral,
    MindlinTriangle, SolidElement, on_triangles, split_face,
};
use super::material::Material;
use super::properties::{Bar, PlateTheory, Shell, Solid};
use crate::mesh::{Cell, cell_nodes, outward};
use crate::schema::dotted;

/// An element of any kind.
pub(super) type AnyElement<'a> = Box<dyn FiniteElement + 'a>;
/// A component of a node, and the (ux, uy, uz, rx, ry, rz) that a point has for a unit of it.
pub type Moved = (usize, usize, [f64; 6]);
/// Elements in a fixed order.
pub(super) type Elements<'a> = Vec<AnyElement<'a>>;

/// A part: cells of one kind of structure.
#[derive(Debug, Clone)]
pub struct Part {
    /// Its region's name.
    pub name: String,
    /// On [`super::Model::nodes`]: lines of a bar; faces of a shell, all turned the same way; solids.
    pub cells: Vec<Cell>,
    /// What they are.
    pub kind: PartKind,
}

/// The kinds of parts.
#[derive(Debug, Clone)]
pub enum PartKind {
    /// A plate.
    Shell(Shell),
    /// A bar.
    Bar(Bar),
    /// A solid.
    Solid(Solid),
}

impl From<Shell> for PartKind {
    fn from(shell: Shell) -> Self {
        PartKind::Shell(shell)
    }
}

impl From<Bar> for PartKind {
    fn from(bar: Bar) -> Self {
        PartKind::Bar(bar)
    }
}

impl From<Solid> for PartKind {
    fn from(solid: Solid) -> Self {
        PartKind::Solid(solid)
    }
}

impl PartKind {
    /// The material.
    pub fn material(&self) -> &Material {
        match self {
            PartKind::Shell(shell) => &shell.material,
            PartKind::Bar(bar) => &bar.material,
            PartKind::Solid(solid) => &solid.material,
        }
    }

    /// `shell`, `bar` or `solid`.
    pub fn name(&self) -> &'static str {
        match self {
            PartKind::Shell(_) => "shell",
            PartKind::Bar(_) => "bar",
            PartKind::Solid(_) => "solid",
        }
    }

    /// Its quantities that must be positive: what it is, value and unit.
    pub(super) fn positive(&self) -> Vec<(&'static str, f64, &'static str)> {
        match self {
            PartKind::Shell(shell) => vec![("thickness", shell.thickness, "m")],
            PartKind::Bar(Bar { section, .. }) => vec![
                ("area", section.area, "m²"),
                ("first second moment", section.inertia_1, "m⁴"),
                ("second second moment", section.inertia_2, "m⁴"),
                ("torsion constant", section.torsion, "m⁴"),
            ],
            PartKind::Solid(_) => Vec::new(),
        }
    }

    /// The dimension of its cells.
    pub fn dimension(&self) -> usize {
        match self {
            PartKind::Shell(_) => 2,
            PartKind::Bar(_) => 1,
            PartKind::Solid(_) => 3,
        }
    }
}

impl Part {
    /// A part `name` of `cells`.
    pub fn new(name: &str, cells: Vec<Cell>, kind: impl Into<PartKind>) -> Self {
        Part { name: name.into(), cells, kind: kind.into() }
    }

    /// What it is as a shell.
    pub fn as_shell(&self) -> Option<&Shell> {
        if let PartKind::Shell(shell) = &self.kind { Some(shell) } else { None }
    }

    /// What it is as a solid.
    pub fn as_solid(&self) -> Option<&Solid> {
        if let PartKind::Solid(solid) = &self.kind { Some(solid) } else { None }
    }

    /// h \[m\] of a shell, zero of others.
    pub fn thickness(&self) -> f64 {
        self.as_shell().map_or(0.0, |shell| shell.thickness)
    }

    /// Faces of a solid as seen from outside counter-clockwise; `None` where some are not on its skin. Those of a shell as they are.
    pub fn outward(&self, faces: Vec<Cell>) -> Option<Vec<Cell>> {
        if self.kind.dimension() < 3 { Some(faces) } else { outward(self.cells.iter(), &faces) }
    }

    /// The shortest side of the box about its nodes, along the axes \[m\].
    pub fn smallest_extent(&self, nodes: &[[f64; 3]]) -> f64 {
        let own = self.nodes();
        let side = |k: usize| {
            let along = || own.iter().map(|n| nodes[*n][k]);
            along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
        };
        (0..3).map(side).fold(f64::INFINITY, f64::min)
    }

    /// Its table in a case, in back-ticks: `shell.disc`.
    pub fn place(&self) -> String {
        format!("`{}.{}`", self.kind.name(), dotted(&self.name))
    }

    /// Its nodes, ascending, each once.
    pub fn nodes(&self) -> Vec<usize> {
        cell_nodes(&self.cells)
    }

    /// A \[m²\] of all faces of a shell.
    pub fn area(&self, nodes: &[[f64; 3]]) -> f64 {
        let triangles = self.cells.iter().flat_map(split_face);
        let area = |nodes: [[f64; 3]; 3]| FlatTriangle::new(&nodes).map_or(0.0, |triangle| triangle.area);
        triangles.map(|t| t.weight * area(t.nodes.map(|n| nodes[n]))).sum()
    }

    /// Adds the elements on one of its cells to `to`; none for a cell of another dimension.
    pub(super) fn push_elements<'a>(&'a self, cell: &'a Cell, nodes: &'a [[f64; 3]], to: &mut Elements<'a>) {
        match &self.kind {
            PartKind::Shell(shell) => push_plates(shell, cell, nodes, to),
            PartKind::Solid(solid) if cell.dimension() == 3 => {
                to.push(boxed(SolidElement::new(solid, nodes, cell)))
            }
            PartKind::Solid(_) => {}
            PartKind::Bar(bar) => to.extend(cell.ends().map(|ends| boxed(BarElement::new(bar, nodes, ends)))),
        }
    }

    /// The elements on `cell`, one of the part's own, on nodes with the given coordinates.
    pub(super) fn elements_on<'a>(&'a self, cell: &'a Cell, nodes: &'a [[f64; 3]]) -> Elements<'a> {
        let mut elements = Vec::new();
        self.push_elements(cell, nodes, &mut elements);
        elements
    }

    /// One of its elements, which knows what the theory of the part holds for; `None` of a part without cells.
    pub fn element<'a>(&'a self, nodes: &'a [[f64; 3]]) -> Option<Box<dyn FiniteElement + 'a>> {
        self.elements_on(self.cells.first()?, nodes).into_iter().next()
    }

    /// The displacement of the point of `face`, a cell of a shell or a face of a solid, at the reference coordinates `at`, on nodes with the given
    /// coordinates: for each node that it depends on, the (ux, uy, uz, rx, ry, rz) of the point for a unit of each component of the node's. Of a
    /// solid it is Σ N_k(ξ) u_k, without rotation; of a shell that of its mid-surface, by its elements.
    pub fn displacement_at(&self, nodes: &[[f64; 3]], face: &Cell, at: [f64; 3]) -> Vec<Moved> {
        if self.kind.dimension() == 3 {
            let along = |component: usize, share: f64| {
                std::array::from_fn(|k| if k == component { share } else { 0.0 })
            };
            let shares = face.nodes().iter().zip(face.kind().shape_functions(at));
            return shares
                .flat_map(|(node, share)| (0..3).map(move |c| (*node, c, along(c, share))))
                .collect();
        }
        let places = on_triangles(nodes, face, face.position(nodes, at));
        let shared = |(at, share): (FacePoint, f64)| {
            let moved = self.displacement_on(nodes, face, &at);
            moved.into_iter().map(move |(node, component, by)| (node, component, by.map(|b| share * b)))
        };
        places.into_iter().flat_map(shared).collect()
    }

    /// The same on one of the triangles of a cell of a shell.
    pub fn displacement_on(&self, nodes: &[[f64; 3]], face: &Cell, at: &FacePoint) -> Vec<Moved> {
        let elements = self.elements_on(face, nodes);
        let of = |element: &AnyElement| {
            let columns = element.displacement_at(at)?;
            let freedoms = element.nodes().iter().flat_map(|n| element.components().iter().map(|c| (*n, *c)));
            Some(freedoms.zip(columns).map(|((node, component), moved)| (node, component, moved)).collect())
        };
        elements.iter().find_map(of).unwrap_or_default()
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

pub(super) fn boxed<'a>(element: impl FiniteElement + 'a) -> AnyElement<'a> {
    Box::new(element)
}
