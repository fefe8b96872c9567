//! Meshes: nodes, elements and named regions, with no mechanics yet.

/// A mesh in metres.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// Node coordinates \[m\].
    pub nodes: Vec<[f64; 3]>,
    /// Elements of all dimensions.
    pub elements: Vec<Element>,
    /// Physical groups, by name.
    pub regions: Vec<Region>,
}

/// One element; its nodes index [`Mesh::nodes`].
#[derive(Debug, Clone, PartialEq)]
pub enum Element {
    /// A point: a single node.
    Point([usize; 1]),
    /// A straight line.
    Line([usize; 2]),
    /// A triangle.
    Triangle([usize; 3]),
    /// A quadrilateral, nodes in order around it.
    Quadrilateral([usize; 4]),
}

/// A physical group: elements that belong together under a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// The group's name in the mesh file.
    pub name: String,
    /// 0 points, 1 lines, 2 faces.
    pub dimension: usize,
    /// Indices into [`Mesh::elements`], ascending.
    pub elements: Vec<usize>,
}

impl Element {
    /// The nodes of the element.
    pub fn nodes(&self) -> &[usize] {
        match self {
            Element::Point(n) => n,
            Element::Line(n) => n,
            Element::Triangle(n) => n,
            Element::Quadrilateral(n) => n,
        }
    }

    /// 0 for a point, 1 for a line, 2 for a face.
    pub fn dimension(&self) -> usize {
        match self {
            Element::Point(_) => 0,
            Element::Line(_) => 1,
            Element::Triangle(_) | Element::Quadrilateral(_) => 2,
        }
    }
}

impl Mesh {
    /// The region called `name`.
    pub fn region(&self, name: &str) -> Option<&Region> {
        self.regions.iter().find(|region| region.name == name)
    }

    /// The nodes that the elements of `region` use, ascending, each once.
    pub fn region_nodes(&self, region: &Region) -> Vec<usize> {
        let mut nodes: Vec<usize> =
            region.elements.iter().flat_map(|e| self.elements[*e].nodes()).copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}
