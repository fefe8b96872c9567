//! A finite-element model as a file of another program describes it.
//!
//! Numbers are in the units of the file, which no file states; places are Cartesian. Nodes and elements are known by their index.

use crate::ledger::Ledger;
pub use crate::place::Place;
use crate::place::place_words;
use std::path::PathBuf;
use stridor_mesh::CellKind;

/// A model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Deck {
    /// The files that it was read from, the first by name, then those it includes in the order of their first lines.
    pub files: Vec<PathBuf>,
    /// Its title; may be empty.
    pub title: String,
    /// Nodes.
    pub nodes: Vec<Node>,
    /// Elements with a shape: solids, shells, beams, faces.
    pub elements: Vec<Element>,
    /// Names of the elements' types as the files have them, such as `C3D20R`: [`Element::type_name`] counts in it.
    pub type_names: Vec<String>,
    /// Named sets of nodes.
    pub node_sets: Vec<Set>,
    /// Named sets of elements.
    pub element_sets: Vec<Set>,
    /// Named surfaces.
    pub surfaces: Vec<Surface>,
    /// Materials.
    pub materials: Vec<Material>,
    /// What elements are made of.
    pub sections: Vec<Section>,
    /// Degrees of freedom that are held.
    pub supports: Vec<Support>,
    /// Linear equations between degrees of freedom.
    pub equations: Vec<Equation>,
    /// Surfaces that are joined.
    pub ties: Vec<Tie>,
    /// Nodes that follow another one as a rigid body, or on average.
    pub couplings: Vec<Coupling>,
    /// Surfaces that touch.
    pub contacts: Vec<Contact>,
    /// Concentrated masses.
    pub masses: Vec<PointMass>,
    /// Springs and dashpots.
    pub springs: Vec<Spring>,
    /// Forces and pressures.
    pub loads: Vec<Load>,
    /// Rotations of sets of nodes, or of elements under centrifugal load.
    pub motions: Vec<Motion>,
    /// The analyses that were meant, in their order.
    pub analyses: Vec<Analysis>,
    /// What was read in part or not at all.
    pub ledger: Ledger,
    /// What the program that wrote the file says in comments that it could not write of its model, and why.
    pub lost: Vec<(String, String)>,
}

/// A node.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// Its number in the file, unique within its instance.
    pub number: u64,
    /// (x, y, z).
    pub position: [f64; 3],
    /// Where it stands.
    pub place: Place,
}

/// An element with a shape.
#[derive(Debug, Clone, PartialEq)]
pub struct Element {
    /// Its number in the file, unique within its instance.
    pub number: u64,
    /// Its kind.
    pub kind: CellKind,
    /// Index in [`Deck::type_names`].
    pub type_name: u32,
    /// Its nodes in the order of the kind.
    pub nodes: Vec<usize>,
    /// Where it stands.
    pub place: Place,
}

/// A named set.
#[derive(Debug, Clone, PartialEq)]
pub struct Set {
    /// Its name as the file spells it; of a set within an instance `INSTANCE.NAME`.
    pub name: String,
    /// Indices of the members, ascending, each once.
    pub members: Vec<usize>,
    /// Whether the program that wrote the file made it for its own use.
    pub internal: bool,
}

/// A named surface.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Surface {
    /// Its name.
    pub name: String,
    /// Faces of solids: element and the number of its side, in the order of [`stridor_mesh::CellTable::sides`]; ascending.
    pub faces: Vec<(usize, usize)>,
    /// Shells whose face it is: element, and whether it is the one that the normal points away from; ascending.
    pub shells: Vec<(usize, ShellFace)>,
    /// Nodes, of a surface of nodes; ascending.
    pub nodes: Vec<usize>,
    /// Whether the program that wrote the file made it for its own use.
    pub internal: bool,
}

impl Surface {
    /// The nodes of its faces and shells, and its own; ascending.
    pub fn all_nodes(&self, elements: &[Element]) -> Vec<usize> {
        let mut nodes = self.nodes.clone();
        for (element, side) in &self.faces {
            let element = &elements[*element];
            let (_, of_side) = element.kind.table().sides[*side];
            nodes.extend(of_side.iter().map(|node| element.nodes[usize::from(*node)]));
        }
        nodes.extend(self.shells.iter().flat_map(|(element, _)| &elements[*element].nodes));
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

/// Which face of a shell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ShellFace {
    /// That which the normal points out of.
    Positive,
    /// The other one.
    Negative,
}

/// A material.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Material {
    /// Its name.
    pub name: String,
    /// Its elastic constants.
    pub elastic: Option<Elastic>,
    /// ρ \[mass/length³\].
    pub density: Option<f64>,
    /// α \[1/time\], β \[time\] of Rayleigh damping.
    pub rayleigh: [f64; 2],
    /// η of K(1 + iη).
    pub loss_factor: f64,
}

/// Elastic constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Elastic {
    /// E and ν.
    Isotropic {
        /// E \[force/length²\].
        youngs_modulus: f64,
        /// ν.
        poissons_ratio: f64,
    },
    /// Engineering constants: E₁ E₂ E₃, ν₁₂ ν₁₃ ν₂₃, G₁₂ G₁₃ G₂₃.
    Orthotropic {
        /// E₁, E₂, E₃ \[force/length²\].
        youngs_moduli: [f64; 3],
        /// ν₁₂, ν₁₃, ν₂₃; νᵢⱼ is the contraction along j under tension along i.
        poissons_ratios: [f64; 3],
        /// G₁₂, G₁₃, G₂₃ \[force/length²\].
        shear_moduli: [f64; 3],
    },
}

/// What elements are made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// The name of its set of elements, or another that the file knows it by.
    pub name: String,
    /// Indices of its elements, ascending.
    pub elements: Vec<usize>,
    /// The name of its material.
    pub material: String,
    /// Directions 1 and 2 of the material, if not those of the coordinates.
    pub axes: Option<[[f64; 3]; 2]>,
    /// Its shape.
    pub shape: SectionShape,
    /// Where it stands.
    pub place: Place,
}

/// The shape of a section.
#[derive(Debug, Clone, PartialEq)]
pub enum SectionShape {
    /// Of solids.
    Solid,
    /// A shell.
    Shell {
        /// h \[length\].
        thickness: f64,
    },
    /// A beam.
    Beam {
        /// Its cross-section.
        profile: Profile,
        /// A direction in the plane of the first axis of the section.
        first_axis: Option<[f64; 3]>,
    },
    /// A bar without bending.
    Truss {
        /// A \[length²\].
        area: f64,
    },
    /// Solids, or shells and beams whose thickness and cross-section the file does not have.
    Unstated,
}

/// The cross-section of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Profile {
    /// A full round.
    Round {
        /// d \[length\].
        diameter: f64,
    },
    /// Any.
    General {
        /// A \[length²\].
        area: f64,
        /// ∫y² dA for bending along the first axis, ∫z² dA along the second \[length⁴\].
        second_moments: [f64; 2],
        /// J \[length⁴\] of St Venant's torsion.
        torsion: f64,
    },
}

impl Profile {
    /// A \[length²\].
    pub fn area(self) -> f64 {
        match self {
            Profile::Round { diameter } => std::f64::consts::PI * diameter * diameter / 4.0,
            Profile::General { area, .. } => area,
        }
    }
}

/// A frame in which degrees of freedom count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Frame {
    /// That of the coordinates.
    Global,
    /// Turned: its unit vectors.
    Turned([[f64; 3]; 3]),
    /// Radial, tangential and axial about an axis: a point and the direction.
    Cylindrical([[f64; 3]; 2]),
}

/// Degrees of freedom that are held.
#[derive(Debug, Clone, PartialEq)]
pub struct Support {
    /// What a comment of the file calls it; may be empty.
    pub title: String,
    /// The name of the set, if it is one.
    pub name: Option<String>,
    /// The nodes.
    pub nodes: Vec<usize>,
    /// Whether ux uy uz rx ry rz are held, in `frame`.
    pub held: [bool; 6],
    /// The frame.
    pub frame: Frame,
    /// Where it stands.
    pub place: Place,
}

/// Σ a u = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Equation {
    /// Node, degree of freedom from 0 (ux) to 5 (rz), a.
    pub terms: Vec<(usize, u8, f64)>,
    /// Where it stands.
    pub place: Place,
}

/// Two surfaces that are joined.
#[derive(Debug, Clone, PartialEq)]
pub struct Tie {
    /// Its name; may be empty.
    pub name: String,
    /// The surface that follows.
    pub slave: String,
    /// The surface that leads.
    pub master: String,
    /// The largest gap that is joined \[length\].
    pub within: Option<f64>,
    /// Where it stands.
    pub place: Place,
}

/// Nodes and one that they move with.
#[derive(Debug, Clone, PartialEq)]
pub struct Coupling {
    /// Its name; may be empty.
    pub name: String,
    /// The one node.
    pub reference: usize,
    /// The others.
    pub nodes: Vec<usize>,
    /// The name of the set or surface that these are, if it is one.
    pub of: Option<String>,
    /// Who follows whom.
    pub kind: CouplingKind,
    /// Where it stands.
    pub place: Place,
}

/// Who follows whom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CouplingKind {
    /// The nodes move as a rigid body with the one.
    Rigid,
    /// The one moves as the nodes do on average.
    Averaging,
}

/// Two surfaces that touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// Its name, if a comment of the file gives it one; else empty.
    pub name: String,
    /// The surface whose points may not enter the other.
    pub slave: String,
    /// The other.
    pub master: String,
    /// μ.
    pub friction: f64,
    /// Normal stiffness for an area \[force/length³\], if the law is linear.
    pub stiffness: Option<f64>,
    /// Tangential stiffness for an area before a point slips \[force/length³\].
    pub stick: Option<f64>,
    /// Whether gaps of the meshes are closed.
    pub closed: bool,
    /// Where it stands.
    pub place: Place,
}

/// A mass at nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct PointMass {
    /// The name of its set; may be empty.
    pub name: String,
    /// The nodes.
    pub nodes: Vec<usize>,
    /// m at each of them.
    pub mass: f64,
    /// Moments of inertia about x, y, z \[mass length²\].
    pub inertia: [f64; 3],
    /// Where it stands.
    pub place: Place,
}

/// Springs with dashpots, all alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    /// The name of its set; may be empty.
    pub name: String,
    /// Each from a node to another, or to the ground.
    pub ends: Vec<(usize, Option<usize>)>,
    /// Degree of freedom from 0 (ux) to 5 (rz) at both ends; none: along the line between them.
    pub dof: Option<u8>,
    /// k of each.
    pub stiffness: f64,
    /// c of each.
    pub damping: f64,
    /// Where it stands.
    pub place: Place,
}

/// A load.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// The name of its set or surface; may be empty.
    pub name: String,
    /// What it acts on.
    pub on: LoadOn,
    /// Where it stands.
    pub place: Place,
}

/// What a load acts on.
#[derive(Debug, Clone, PartialEq)]
pub enum LoadOn {
    /// A force at each node.
    Nodes {
        /// The nodes.
        nodes: Vec<usize>,
        /// The force at each \[force\].
        force: [f64; 3],
    },
    /// A pressure on sides of solids.
    Faces {
        /// As in [`Surface::faces`].
        faces: Vec<(usize, usize)>,
        /// p \[force/length²\], positive where it presses.
        pressure: f64,
    },
    /// A pressure on shells.
    Shells {
        /// The elements.
        shells: Vec<usize>,
        /// p \[force/length²\], positive along the normal: by the right hand about the nodes.
        pressure: f64,
    },
}

/// A steady rotation.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// The set that turns.
    pub set: String,
    /// A point on the axis \[length\].
    pub point: [f64; 3],
    /// The axis.
    pub axis: [f64; 3],
    /// Ω \[rad/time\], by the right hand about the axis.
    pub speed: f64,
    /// Where it stands.
    pub place: Place,
}

/// An analysis that was meant.
#[derive(Debug, Clone, PartialEq)]
pub enum Analysis {
    /// Real modes.
    Modes {
        /// How many.
        count: Option<usize>,
        /// Frequencies \[1/time\].
        band: [Option<f64>; 2],
    },
    /// Complex modes.
    ComplexModes {
        /// How many.
        count: Option<usize>,
        /// Frequencies \[1/time\].
        band: [Option<f64>; 2],
    },
}

impl Deck {
    /// `file.inp:12`.
    pub fn words(&self, place: Place) -> String {
        place_words(&self.files, place)
    }

    /// The set of nodes of this name.
    pub fn node_set(&self, name: &str) -> Option<&Set> {
        self.node_sets.iter().find(|set| set.name.eq_ignore_ascii_case(name))
    }

    /// The set of elements of this name.
    pub fn element_set(&self, name: &str) -> Option<&Set> {
        self.element_sets.iter().find(|set| set.name.eq_ignore_ascii_case(name))
    }

    /// The material of this name.
    pub fn material(&self, name: &str) -> Option<&Material> {
        self.materials.iter().find(|material| material.name.eq_ignore_ascii_case(name))
    }

    /// The surface of this name.
    pub fn surface(&self, name: &str) -> Option<&Surface> {
        self.surfaces.iter().find(|surface| surface.name.eq_ignore_ascii_case(name))
    }
}
