//! Model of a structure: parts, sections and supports as plain data, before any matrix.

use super::elements::{MassElement, SpringElement};
use super::part::{Elements, Part, boxed};
use super::properties::{PointMass, Rotation, Shell, Spring};
use std::collections::BTreeSet;

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
    /// Steady rotations of parts.
    pub rotations: Vec<Rotation>,
}

impl Model {
    /// The elements of it: parts, masses, springs.
    pub(super) fn elements(&self) -> Elements<'_> {
        (0..=self.parts.len()).flat_map(|part| self.elements_of(part)).collect()
    }

    /// Those of the part of this index; beyond the parts, those of masses and springs.
    pub(super) fn elements_of(&self, part: usize) -> Elements<'_> {
        let nodes = &self.nodes;
        let mut elements: Elements = Vec::new();
        match self.parts.get(part) {
            Some(part) => part.cells.iter().for_each(|cell| part.push_elements(cell, nodes, &mut elements)),
            None => {
                elements.extend(self.masses.iter().map(|point| boxed(MassElement::new(point, nodes))));
                elements.extend(self.springs.iter().map(|spring| boxed(SpringElement::new(spring))));
            }
        }
        elements
    }

    /// The first shell or solid that has all of `nodes`.
    pub fn part_with(&self, nodes: &[usize]) -> Option<&Part> {
        self.parts.iter().filter(|part| part.kind.dimension() > 1).find(|part| {
            let own = part.nodes();
            nodes.iter().all(|n| own.binary_search(n).is_ok())
        })
    }

    /// The shell or solid that has all of `nodes`, or the solids that have them together; none where there are no such parts.
    pub fn parts_with(&self, nodes: &[usize]) -> Vec<&Part> {
        if let Some(part) = self.part_with(nodes) {
            return vec![part];
        }
        let own = |part: &&Part| part.nodes().iter().any(|node| nodes.binary_search(node).is_ok());
        let solids: Vec<&Part> =
            self.parts.iter().filter(|part| part.kind.dimension() == 3).filter(own).collect();
        let all: BTreeSet<usize> = solids.iter().flat_map(|part| part.nodes()).collect();
        if nodes.iter().all(|node| all.contains(node)) { solids } else { Vec::new() }
    }

    /// The shells among its parts.
    pub fn shells(&self) -> impl Iterator<Item = (&Part, &Shell)> {
        self.parts.iter().filter_map(|part| Some((part, part.as_shell()?)))
    }

    /// The parts that a rotation turns.
    pub fn turned_by<'a>(&'a self, rotation: &'a Rotation) -> impl Iterator<Item = &'a Part> {
        self.parts.iter().filter(|part| rotation.parts.contains(&part.name))
    }

    /// The part of this name.
    pub fn part(&self, name: &str) -> Option<&Part> {
        self.parts.iter().find(|part| part.name == name)
    }
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
