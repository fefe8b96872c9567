//! Model of a structure: parts, sections and supports as plain data, before any matrix.

use super::elements::waves::shear_coefficient;
use super::elements::{FlatTriangle, split_face};
use super::material::Material;
use super::section::Section;
use crate::mesh::{Cell, cell_nodes, outward};
use crate::schema::{choices, dotted};

/// A structure: nodes and all that hangs on them. Degrees of freedom are (ux, uy, uz, rx, ry, rz) at every node.
#[derive(Debug, Clone, Default)]
pub struct Model {
    /// Node coordinates \[m\], tilted and moved into place.
    pub nodes: Vec<[f64; 3]>,
    /// What it is made of.
    pub parts: Vec<Part>,
    /// Concentrated masses.
    pub masses: Vec<PointMass>,
    /// Springs, each with its dashpot.
    pub springs: Vec<Spring>,
    /// Rigid links, eliminated exactly.
    pub links: Vec<RigidLink>,
    /// Other constraints, such as those of ties, eliminated exactly.
    pub couplings: Vec<Coupling>,
    /// Held degrees of freedom.
    pub supports: Vec<Support>,
    /// Held directions that are along no axis.
    pub inclined_supports: Vec<InclinedSupport>,
}

choices! {
    /// Plate theory of bending.
    pub enum PlateTheory {
        /// Rigid in transverse shear: thin plates.
        Kirchhoff = "kirchhoff",
        /// Transverse shear and rotary inertia (Mindlin, Reissner): thin and thick plates.
        Mindlin = "mindlin",
    }
}

choices! {
    /// Quadrature of the stiffness of 20-node hexahedra.
    pub enum Integration {
        /// 3 × 3 × 3 points, or more where edges are curved: exact.
        Full = "full",
        /// 2 × 2 × 2 points, as C3D20R of Abaqus and CalculiX: softer in bending, and less stiff where
        /// ν is near ½; a hundredth of the full stiffness holds its hourglass modes.
        Reduced = "reduced",
    }
}

/// A part: cells of one kind of structure.
#[derive(Debug, Clone)]
pub struct Part {
    /// Its region's name.
    pub name: String,
    /// On [`Model::nodes`]: lines of a bar; faces of a shell, all turned the same way; solids.
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

/// A plate of constant thickness.
#[derive(Debug, Clone)]
pub struct Shell {
    /// Material.
    pub material: Material,
    /// h \[m\].
    pub thickness: f64,
    /// Plate theory of bending.
    pub theory: PlateTheory,
    /// κ of Mindlin's theory; `None` for 5/(6−ν), see [`Shell::shear_coefficient`].
    pub shear_coefficient: Option<f64>,
    /// Holds the membrane: displacements in the plate's plane and the rotation about its normal.
    pub bending_only: bool,
    /// Counts the rotary inertia ρh³/12 of the cross-section.
    pub rotary_inertia: bool,
}

/// A bar of constant section.
#[derive(Debug, Clone)]
pub struct Bar {
    /// Material.
    pub material: Material,
    /// Its section.
    pub section: Section,
    /// A vector in the plane of the section's first axis; any that is not along the bar.
    pub orientation: [f64; 3],
}

/// A solid.
#[derive(Debug, Clone)]
pub struct Solid {
    /// Material.
    pub material: Material,
    /// Quadrature of 20-node hexahedra; other cells have one of their own.
    pub integration: Integration,
}

impl Solid {
    /// Of a material, fully integrated.
    pub fn new(material: Material) -> Self {
        Solid { material, integration: Integration::Full }
    }
}

impl Model {
    /// The first shell or solid that has all of `nodes`.
    pub fn part_with(&self, nodes: &[usize]) -> Option<&Part> {
        self.parts.iter().filter(|part| part.kind.dimension() > 1).find(|part| {
            let own = part.nodes();
            nodes.iter().all(|n| own.binary_search(n).is_ok())
        })
    }

    /// The shells among its parts.
    pub fn shells(&self) -> impl Iterator<Item = (&Part, &Shell)> {
        self.parts.iter().filter_map(|part| Some((part, part.as_shell()?)))
    }

    /// The part of this name.
    pub fn part(&self, name: &str) -> Option<&Part> {
        self.parts.iter().find(|part| part.name == name)
    }
}

impl Part {
    /// A part `name` of `cells`.
    pub fn new(name: &str, cells: Vec<Cell>, kind: impl Into<PartKind>) -> Self {
        Part { name: name.into(), cells, kind: kind.into() }
    }

    /// What it is as a shell.
    pub fn as_shell(&self) -> Option<&Shell> {
        match &self.kind {
            PartKind::Shell(shell) => Some(shell),
            PartKind::Bar(_) | PartKind::Solid(_) => None,
        }
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

    /// The dimension of its cells.
    pub fn dimension(&self) -> usize {
        match self {
            PartKind::Shell(_) => 2,
            PartKind::Bar(_) => 1,
            PartKind::Solid(_) => 3,
        }
    }
}

impl Shell {
    /// A thin plate of thickness h \[m\], its membrane free, its rotary inertia counted.
    pub fn new(material: Material, thickness: f64) -> Self {
        Shell {
            material,
            thickness,
            theory: PlateTheory::Kirchhoff,
            shear_coefficient: None,
            bending_only: false,
            rotary_inertia: true,
        }
    }

    /// κ of the transverse shear force κ G h γ by Mindlin's theory.
    ///
    /// 5/(6−ν) unless another is given: with it, bending waves are as slow as those of three-dimensional elasticity to the
    /// order (kh)², the measure by which Kirchhoff's theory is judged ([`super::thickness_error`]).
    pub fn shear_coefficient(&self) -> f64 {
        self.shear_coefficient.unwrap_or_else(|| shear_coefficient(self.material.poissons_ratio))
    }
}

/// A mass at a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointMass {
    /// The node.
    pub node: usize,
    /// m \[kg\], the same along x, y and z.
    pub mass: f64,
    /// Moments of inertia about x, y, z \[kg m²\].
    pub inertia: [f64; 3],
}

/// A spring with a dashpot between two nodes, or a node and the ground: it acts on the difference of their
/// displacement along `direction` (of their rotation about it, when `rotational`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// One end.
    pub node: usize,
    /// The other end; `None` for the ground.
    pub other: Option<usize>,
    /// Its direction, of any length.
    pub direction: [f64; 3],
    /// Whether it acts on rotations.
    pub rotational: bool,
    /// k \[N/m or N m/rad\].
    pub stiffness: f64,
    /// c \[N s/m or N m s/rad\].
    pub damping: f64,
}

/// Nodes that move with a master node as one rigid body.
#[derive(Debug, Clone)]
pub struct RigidLink {
    /// The node that leads.
    pub master: usize,
    /// The nodes that follow.
    pub slaves: Vec<usize>,
}

/// A slave degree of freedom as a sum of others, u_slave = Σ c u.
///
/// A degree of freedom is a node and a component, 0 … 5 for ux … rz. Others that are slaves themselves are replaced by what they are
/// sums of; the forces on a slave act on its masters, F_master = Σ c F_slave.
#[derive(Debug, Clone, PartialEq)]
pub struct Constraint {
    /// The slave.
    pub slave: (usize, usize),
    /// Masters with their coefficients: node, component, c.
    pub terms: Vec<(usize, usize, f64)>,
}

/// Constraints of one origin, as of a tie.
#[derive(Debug, Clone, PartialEq)]
pub struct Coupling {
    /// How messages name it.
    pub name: String,
    /// Its constraints, one for each slave degree of freedom.
    pub constraints: Vec<Constraint>,
}

/// Held directions of one node.
#[derive(Debug, Clone, PartialEq)]
pub struct InclinedSupport {
    /// The node.
    pub node: usize,
    /// Unit vectors of (ux, uy, uz) or of (rx, ry, rz), each across the others.
    pub held: Vec<[f64; 6]>,
    /// How messages name it.
    pub name: String,
}

/// Held degrees of freedom.
#[derive(Debug, Clone)]
pub struct Support {
    /// The nodes.
    pub nodes: Vec<usize>,
    /// Which of (ux, uy, uz, rx, ry, rz) are held.
    pub held: [bool; 6],
}
