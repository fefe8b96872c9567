//! Meshes: nodes, elements and named regions, with no mechanics yet.
//!
//! * [`gmsh`]: reads Gmsh files (MSH 4.1 and 2.2, ASCII and binary); physical groups become regions by name.
//! * [`write()`]: writes MSH 4.1.
//! * [`check`]: what is wrong with a mesh, all at once, in the numbers of its file.
//! * [`generate`]: discs, plates and the whole rig without Gmsh, graded towards the contact.
//! * [`quality`]: angles, areas and lengths of elements.
//! * [`info`]: what a mesh holds, in a few lines.
//!
//! ```
//! use stridor_mesh::{self as mesh, generate};
//! let rig = generate::rig(&generate::RigSpec::small())?;
//! let file = std::env::temp_dir().join(format!("stridor-doc-{}.msh", std::process::id()));
//! mesh::write(&file, &rig, 0.001)?; // coordinates in millimetres
//! let back = mesh::read(&file, 0.001)?;
//! assert_eq!(back.elements, rig.elements);
//! assert_eq!(back.require("rim", 1)?.elements, rig.require("rim", 1)?.elements);
//! # std::fs::remove_file(&file).ok();
//! # Ok::<(), stridor_base::error::Error>(())
//! ```

mod cell;
pub mod check;
mod coincident;
pub mod generate;
pub mod gmsh;
mod hanging;
pub mod info;
mod jacobian;
mod kind;
mod locate;
mod orient;
mod quadrature;
pub mod quality;
mod shape;
mod skin;
mod write;

pub use cell::{Cell, cell_nodes};
pub use check::{Diagnosis, diagnose, diagnose_apart};
pub use coincident::coincident;
pub use gmsh::read;
pub use info::Info;
pub use kind::{CellKind, CellShape, CellTable, NamedKind, NumberedKind, Order, Program};
pub use locate::{FaceTree, LocatedPoint};
pub use orient::turn_alike;
pub use quadrature::QuadraturePoint;
pub use skin::{Side, outer_faces, outward};
pub use write::{to_msh, to_msh_exactly, write};

use stridor_base::error::{Error, Fault, Result, nearest};

/// A mesh in metres.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Node coordinates \[m\].
    pub nodes: Vec<[f64; 3]>,
    /// Elements of all dimensions.
    pub elements: Vec<Cell>,
    /// Physical groups, by name.
    pub regions: Vec<Region>,
    /// How the file it came from numbers things; empty for a generated mesh.
    pub origin: Origin,
}

/// The numbers a mesh file gives to nodes and elements, so that messages use them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Origin {
    /// Tag of each node, or empty: numbered from 1.
    pub node_tags: Vec<u64>,
    /// Tag of each element, or empty: numbered from 1.
    pub element_tags: Vec<u64>,
    /// Line of each node in a text file, or empty.
    pub node_lines: Vec<usize>,
    /// Line of each element in a text file, or empty.
    pub element_lines: Vec<usize>,
    /// Tags of nodes in the file that were left out because no element of a physical group uses them.
    pub unused_nodes: Vec<u64>,
}

/// A physical group: elements that belong together under a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// The group's name in the mesh file.
    pub name: String,
    /// 0 points, 1 lines, 2 faces, 3 solids.
    pub dimension: usize,
    /// Indices into [`Mesh::elements`], ascending.
    pub elements: Vec<usize>,
}

/// The length of the unit `m`, `cm`, `mm` or `in` \[m\]; metres for any other word.
pub fn unit_in_metres(unit: &str) -> f64 {
    match unit {
        "mm" => 1e-3,
        "cm" => 1e-2,
        "in" => 0.0254,
        _ => 1.0,
    }
}

impl Mesh {
    /// The region called `name`.
    pub fn region(&self, name: &str) -> Option<&Region> {
        self.regions.iter().find(|region| region.name == name)
    }

    /// The region called `name`, of points (`dimension` 0), lines (1) or faces (2).
    ///
    /// # Errors
    /// When there is none: the fault lists those there are and offers the nearest name.
    pub fn require(&self, name: &str, dimension: usize) -> Result<&Region> {
        if let Some(region) = self.regions.iter().find(|r| r.name == name && r.dimension == dimension) {
            return Ok(region);
        }
        let kind = made_of;
        let known: Vec<String> =
            self.regions.iter().map(|r| format!("`{}` ({})", r.name, kind(r.dimension))).collect();
        let found = match self.region(name) {
            Some(other) => format!("`{name}` made of {}", kind(other.dimension)),
            None => format!("no region `{name}`"),
        };
        let same_kind = self.regions.iter().filter(|r| r.dimension == dimension && r.name != name);
        let near = nearest(name, same_kind.map(|r| r.name.as_str()));
        let mut fault = Fault::new(
            "mesh",
            format!(
                "{found} among its regions {}",
                if known.is_empty() { "(none)".into() } else { known.join(", ") }
            ),
            format!("a region `{name}` made of {}", kind(dimension)),
        );
        if let Some(near) = near {
            fault = fault.with_help(format!("Did you mean `{near}`?"));
        }
        Err(Error::input(fault))
    }

    /// The faces of the region called `name`.
    ///
    /// # Errors
    /// Those of [`Mesh::require`].
    pub fn faces(&self, name: &str) -> Result<Vec<Cell>> {
        Ok(self.require(name, 2)?.elements.iter().map(|k| self.elements[*k].clone()).collect())
    }

    /// The nodes that the elements of `region` use, ascending, each once.
    pub fn region_nodes(&self, region: &Region) -> Vec<usize> {
        cell_nodes(region.elements.iter().map(|e| &self.elements[*e]))
    }

    /// The file's number of node `node`.
    pub fn node_tag(&self, node: usize) -> u64 {
        self.origin.node_tags.get(node).copied().unwrap_or(node as u64 + 1)
    }

    /// The file's number of element `element`.
    pub fn element_tag(&self, element: usize) -> u64 {
        self.origin.element_tags.get(element).copied().unwrap_or(element as u64 + 1)
    }

    /// The number of a node and its line in the file, if it has one: `12 (line 34)`.
    pub fn node_place(&self, node: usize) -> String {
        with_line(self.node_tag(node), self.origin.node_lines.get(node))
    }

    /// The number of an element and its line in the file, if it has one.
    pub fn element_place(&self, element: usize) -> String {
        with_line(self.element_tag(element), self.origin.element_lines.get(element))
    }

    /// Adds `elements` as a new region.
    pub fn add_region(&mut self, name: &str, dimension: usize, elements: impl IntoIterator<Item = Cell>) {
        let first = self.elements.len();
        self.elements.extend(elements);
        let elements = (first..self.elements.len()).collect();
        self.regions.push(Region { name: name.into(), dimension, elements });
    }

    /// Adds another mesh beside this one; regions of the same name are not joined.
    pub fn append(&mut self, other: Mesh) {
        let (node, element) = (self.nodes.len(), self.elements.len());
        self.nodes.extend(other.nodes);
        self.elements.extend(other.elements.iter().map(|e| e.renumbered(|n| n + node)));
        self.regions.extend(other.regions.into_iter().map(|mut region| {
            region.elements.iter_mut().for_each(|e| *e += element);
            region
        }));
        self.origin = Origin::default();
    }
}

/// What regions of a dimension are made of, in words.
pub fn made_of(dimension: usize) -> &'static str {
    ["points", "lines", "faces", "solids"][dimension.min(3)]
}

fn with_line(tag: u64, line: Option<&usize>) -> String {
    line.map_or(tag.to_string(), |line| format!("{tag} (line {line})"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_region_is_answered_with_those_there_are_and_the_nearest() {
        let mut mesh = Mesh { nodes: vec![[0.0; 3], [1.0, 0.0, 0.0]], ..Default::default() };
        mesh.add_region("rim", 1, [Cell::line([0, 1])]);
        mesh.add_region("tip", 0, [Cell::point(1)]);
        assert_eq!(mesh.require("rim", 1).unwrap().elements, [0]);
        let text = mesh.require("rmi", 1).unwrap_err().to_string();
        assert!(text.contains("`rim` (lines)") && text.contains("Did you mean `rim`"), "{text}");
        let text = mesh.require("rim", 2).unwrap_err().to_string();
        assert!(text.contains("made of lines") && text.contains("made of faces"), "{text}");
    }

    #[test]
    fn appended_meshes_keep_their_regions() {
        let mut a = Mesh { nodes: vec![[0.0; 3], [1.0, 0.0, 0.0]], ..Default::default() };
        a.add_region("a", 1, [Cell::line([0, 1])]);
        let mut b = a.clone();
        b.regions[0].name = "b".into();
        a.append(b);
        assert_eq!(a.elements[a.region("b").unwrap().elements[0]], Cell::line([2, 3]));
    }
}
