//! Model of a structure: parts, sections and supports as plain data, before any matrix.

use super::elements::waves::shear_coefficient;
use super::elements::{FlatTriangle, split_face};
use super::material::Material;
use super::section::Section;
use crate::mesh::Cell;
use crate::schema::choices;

/// A structure: nodes and all that hangs on them. Degrees of freedom are (ux, uy, uz, rx, ry, rz) at every node.
#[derive(Debug, Clone, Default)]
pub struct Model {
    /// Node coordinates \[m\], tilted and moved into place.
    pub nodes: Vec<[f64; 3]>,
    /// Plates.
    pub shells: Vec<ShellPart>,
    /// Bars.
    pub bars: Vec<BarPart>,
    /// Concentrated masses.
    pub masses: Vec<PointMass>,
    /// Springs, each with its dashpot.
    pub springs: Vec<Spring>,
    /// Rigid links, eliminated exactly.
    pub links: Vec<RigidLink>,
    /// Held degrees of freedom.
    pub supports: Vec<Support>,
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

/// A plate of constant thickness.
#[derive(Debug, Clone)]
pub struct ShellPart {
    /// Its region's name.
    pub name: String,
    /// Triangles and quadrilaterals on [`Model::nodes`], all turned the same way.
    pub faces: Vec<Cell>,
    /// Material.
    pub material: Material,
    /// h \[m\].
    pub thickness: f64,
    /// Plate theory of bending.
    pub theory: PlateTheory,
    /// κ of Mindlin's theory; `None` for 5/(6−ν), see [`ShellPart::shear_coefficient`].
    pub shear_coefficient: Option<f64>,
    /// Holds the membrane: displacements in the plate's plane and the rotation about its normal.
    pub bending_only: bool,
    /// Counts the rotary inertia ρh³/12 of the cross-section.
    pub rotary_inertia: bool,
}

impl Model {
    /// The first shell that has all of `nodes`.
    pub fn shell_with(&self, nodes: &[usize]) -> Option<&ShellPart> {
        self.shells.iter().find(|shell| {
            let mut own: Vec<usize> = shell.faces.iter().flat_map(Cell::nodes).copied().collect();
            own.sort_unstable();
            nodes.iter().all(|n| own.binary_search(n).is_ok())
        })
    }
}

impl ShellPart {
    /// A thin plate of `faces`, its membrane free, its rotary inertia counted; `thickness` h \[m\].
    pub fn new(name: &str, faces: Vec<Cell>, material: Material, thickness: f64) -> Self {
        ShellPart {
            name: name.into(),
            faces,
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

    /// A \[m²\] of all faces.
    pub fn area(&self, nodes: &[[f64; 3]]) -> f64 {
        let triangles = self.faces.iter().flat_map(split_face);
        let area = |nodes: [[f64; 3]; 3]| FlatTriangle::new(&nodes).map_or(0.0, |triangle| triangle.area);
        triangles.map(|t| t.weight * area(t.nodes.map(|n| nodes[n]))).sum()
    }
}

/// A bar of constant section.
#[derive(Debug, Clone)]
pub struct BarPart {
    /// Its region's name.
    pub name: String,
    /// Two-node elements on [`Model::nodes`].
    pub elements: Vec<[usize; 2]>,
    /// Material.
    pub material: Material,
    /// Its section.
    pub section: Section,
    /// A vector in the plane of the section's first axis; any that is not along the bar.
    pub orientation: [f64; 3],
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

/// Held degrees of freedom.
#[derive(Debug, Clone)]
pub struct Support {
    /// The nodes.
    pub nodes: Vec<usize>,
    /// Which of (ux, uy, uz, rx, ry, rz) are held.
    pub held: [bool; 6],
}
